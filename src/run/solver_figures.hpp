#pragma once
#include "bough/records/run.hpp"
#include "bough/step/system.hpp"

namespace bough::run {

/// Figures of the tree and the linear solver for the summary of a run, with condition numbers of interfaces if these
/// are narrow.
decltype(records::Summary::solver) solver_figures(step::System& system, int dependent_rows);

/// Examines the last factorization of a run with a right-hand side of signs. Computes backward errors and condition
/// numbers by level of the tree, and estimates the condition number of the scaled tangent as |A| times the largest
/// growth in a few inverse iterations (a lower bound, as a rule within a small factor). Adds `levels` and the figures
/// `condition_estimate`, `digits_lost`. Hierarchical solver only; allocates.
void look_at_last_factor(step::System& system, records::Summary& summary);

}  // namespace bough::run
