#pragma once
#include "bough/records/run.hpp"
#include "bough/step/system.hpp"

namespace bough::run {

/// Figures of the tree and the linear solver for the summary of a run; conditions of interfaces where these are narrow.
decltype(records::Summary::solver) solver_figures(step::System& system, int dependent_rows);

/// The last factorization of a run under a right-hand side of signs: backward errors and conditions by level of the
/// tree, and an estimate of the condition number of the scaled tangent, |A| times the largest growth that a few
/// inverse iterations meet (a lower bound: within a small factor of it as a rule). Adds `levels` and the figures
/// `condition_estimate`, `digits_lost`. Hierarchical solver only; allocates.
void look_at_last_factor(step::System& system, records::Summary& summary);

}  // namespace bough::run
