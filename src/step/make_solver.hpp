#pragma once
/// Construction of the linear solver that a scene selects. Internal to step.
#include <memory>

#include "bough/plan/plan.hpp"
#include "bough/solve/any_solver.hpp"
#include "bough/tree/tree.hpp"

namespace bough::step {

std::unique_ptr<solve::AnySolver> make_solver(const plan::Plan& plan, const tree::Tree& tree,
                                              const scene::Solver& given);

/// Message if factor() reports that the chosen solver cannot be used; null for other outcomes.
const char* explain_backend(solve::FactorOutcome outcome);

}  // namespace bough::step
