#pragma once
/// A cost model of visits, fitted to the visits of a run, and its predictions for other trees of the same scene.
/// Internal to study.
#include <span>
#include <vector>

#include "bough/blocks/block_graph.hpp"
#include "bough/records/profile.hpp"
#include "bough/scene/scene.hpp"
#include "bough/solve/visits.hpp"

namespace bough::study {

/// Non-negative fits of the seconds of visits, separately for visits in lanes and on the scalar path: coefficients of
/// fronts, flops and bytes with the least sum of squares of relative errors. If one kind does not occur, it gets the
/// coefficients of the other.
std::vector<records::CostFit> fit_costs(std::span<const solve::VisitShape> visits, const std::vector<double>& seconds);

/// Predicted seconds of each visit.
std::vector<double> predict(std::span<const solve::VisitShape> visits, const std::vector<records::CostFit>& costs);

/// Trees similar to the present one (and to the automatic one), all different; the present one first, the rest by
/// predicted time.
std::vector<records::Alternative> try_alternatives(const blocks::BlockGraph& graph, const tree::Tree& present,
                                                   const scene::Solver& solver, int threads, double grain_flops,
                                                   const std::vector<records::CostFit>& costs,
                                                   const solve::SolveOptions& options);

}  // namespace bough::study
