#pragma once
/// What a visit costs, learnt from the visits of a run, and what other trees of the same scene would cost. Internal
/// to study.
#include <span>
#include <vector>

#include "bough/blocks/block_graph.hpp"
#include "bough/records/profile.hpp"
#include "bough/scene/scene.hpp"
#include "bough/solve/visits.hpp"

namespace bough::study {

/// Non-negative fits of the seconds of visits, those in lanes and those on the scalar path apart: fronts, flops and
/// bytes with the least sum of squares of relative errors. A kind that does not occur takes over the costs of the
/// other.
std::vector<records::CostFit> fit_costs(std::span<const solve::VisitShape> visits, const std::vector<double>& seconds);

/// By visit [s].
std::vector<double> predict(std::span<const solve::VisitShape> visits, const std::vector<records::CostFit>& costs);

/// Trees around the present one (and the automatic one), each different from all others; the present first, the rest
/// by predicted time.
std::vector<records::Alternative> try_alternatives(const blocks::BlockGraph& graph, const tree::Tree& present,
                                                   const scene::Solver& solver, int threads, double grain_flops,
                                                   const std::vector<records::CostFit>& costs,
                                                   const solve::SolveOptions& options);

}  // namespace bough::study
