#pragma once
#include <vector>

#include "bough/records/run.hpp"
#include "bough/step/system.hpp"

namespace bough::run {

/// Interfaces of the tree with their condition numbers, after the last factorization. Empty if they are wide or many,
/// without a factorization, and for other than the hierarchical solver.
std::vector<solve::InterfaceReport> examine_interfaces(step::System& system);

/// Figures of the tree and the linear solver for the summary of a run.
decltype(records::Summary::solver) solver_figures(step::System& system,
                                                  const std::vector<solve::InterfaceReport>& interfaces,
                                                  int dependent_rows);

/// Examines the last factorization of a run with a right-hand side of signs. Computes backward errors and condition
/// numbers by level of the tree, and estimates the condition number of the scaled tangent as |A| times the largest
/// growth in a few inverse iterations (a lower bound, as a rule within a small factor). Adds `levels` and the figures
/// `condition_estimate`, `digits_lost`. Hierarchical solver only; allocates.
void look_at_last_factor(step::System& system, const std::vector<solve::InterfaceReport>& interfaces,
                         records::Summary& summary);

}  // namespace bough::run
