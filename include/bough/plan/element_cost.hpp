#pragma once
/// Cost of evaluating elements, for decisions and predictions of run times: measured by bench_elements on the machine
/// of src/elements/README.md. Only ratios matter, not the seconds themselves.
#include "bough/elements/evaluate.hpp"

namespace bough::plan {

/// Seconds of one element, alone and as one of eight lanes: residual, and residual with tangent (bench_elements).
struct ElementCost {
  double alone, alone_tangent, lane, lane_tangent;
};
template <class E>
constexpr ElementCost cost{60e-9, 200e-9, 15e-9, 60e-9};
template <int N>
inline constexpr ElementCost cost<elements::Beam<N>> = N == 2   ? ElementCost{400e-9, 1790e-9, 59e-9, 535e-9}
                                                       : N == 3 ? ElementCost{1180e-9, 5430e-9, 190e-9, 1610e-9}
                                                                : ElementCost{1800e-9, 8800e-9, 290e-9, 2850e-9};
template <>
inline constexpr ElementCost cost<elements::Bushing>{240e-9, 870e-9, 33e-9, 184e-9};
template <>
inline constexpr ElementCost cost<elements::Joint>{250e-9, 900e-9, 40e-9, 190e-9};
template <int N>
inline constexpr ElementCost cost<elements::LineLoad<N>>{200e-9 * N, 800e-9 * N, 30e-9 * N, 250e-9 * N};

/// Cost of a residual in a plane relative to one in space, fitted by hand to steps of chains and lattices (bench_step,
/// bench_lean).
inline constexpr double planar_residual = 0.37;

}  // namespace bough::plan
