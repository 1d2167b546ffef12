#pragma once
/// The linear solver that a scene asks for. Internal to step.
#include <memory>

#include "bough/plan/plan.hpp"
#include "bough/solve/any_solver.hpp"
#include "bough/tree/tree.hpp"

namespace bough::step {

std::unique_ptr<solve::AnySolver> make_solver(const plan::Plan& plan, const tree::Tree& tree,
                                              const scene::Solver& given);

/// What to tell when factor() answers that the chosen solver does not serve; null for other outcomes.
const char* explain_backend(solve::FactorOutcome outcome);

}  // namespace bough::step
