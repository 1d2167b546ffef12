/// Residual, and residual with exact tangent, of the elements: one call each.
#include <benchmark/benchmark.h>

#include "bough/elements/evaluate.hpp"

namespace {

using namespace bough::elements;

/// A bent and twisted element of N nodes in motion.
template <int N>
struct BeamCase {
  Beam<N> beam;
  NodeMotion nodes[N];
  BeamCase() {
    beam.length = 0.25;
    beam.stiffness = beam.damping = beam.mass = Mat6<double>::zero();
    const double stiffness[6] = {8.4e7, 2.7e7, 2.7e7, 1.8e3, 2.8e3, 2.8e3};
    for (int i = 0; i < 6; ++i) {
      beam.stiffness(i, i) = stiffness[i];
      beam.mass(i, i) = i < 3 ? 3.14 : 1e-4;
    }
    beam.has_mass = true;
    for (auto& strain : beam.reference_strain) strain = {{1, 0, 0, 0, 0, 0}};
    for (int k = 0; k < N; ++k) {
      const double s = static_cast<double>(k) / (N - 1);
      beam.ports[k].node = k;
      nodes[k].R = bough::motion::exp_so3(Vec3<double>{{0.01 * s, 0.02 * s, 0.03 * s}});
      nodes[k].x = bough::motion::Vec3Pair::from({{0.25 * s, 0.001 * s, 0.002 * s}});
      nodes[k].v = {{1, 2, 3, 0.1, 0.2, 0.3}};
      nodes[k].a = {{3, 2, 1, 0.3, 0.1, 0.2}};
      nodes[k].dq = {{1e-3, 2e-3, 3e-3, 1e-4, 2e-4, 1e-4}};
    }
  }
};

template <int N>
void beam(benchmark::State& state) {
  const BeamCase<N> c;
  const bool is_dynamic = state.range(0) != 0, with_tangent = state.range(1) != 0;
  Field field;
  field.nodes = c.nodes;
  field.around = {{{0, 0, -9.81}}, nullptr, is_dynamic};
  field.slopes = {2e3, 4e6, false};
  double residual[6 * N], tangent[36 * N * N];
  for (auto _ : state) {
    evaluate(c.beam, field, nullptr, 0.0, residual, with_tangent ? tangent : nullptr);
    benchmark::DoNotOptimize(residual);
    benchmark::DoNotOptimize(tangent);
  }
}

}  // namespace

BENCHMARK(beam<2>)->ArgNames({"dynamic", "tangent"})->ArgsProduct({{0, 1}, {0, 1}});
BENCHMARK(beam<3>)->ArgNames({"dynamic", "tangent"})->ArgsProduct({{0, 1}, {0, 1}});
BENCHMARK(beam<4>)->ArgNames({"dynamic", "tangent"})->ArgsProduct({{0, 1}, {0, 1}});
