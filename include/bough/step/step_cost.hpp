#pragma once
/// What the parts of a step cost, by a model with costs of one machine: for decisions and outlooks, in which ratios
/// count.
#include "bough/step/system.hpp"

namespace bough::step {

/// Seconds on one thread, each part once.
struct StepCost {
  double residual = 0.0;  ///< all elements and their sums
  double tangent = 0.0;   ///< the same with tangents
  double factor = 0.0;
  double solve = 0.0;   ///< with the check of the solution
  double update = 0.0;  ///< nodes moved, with their velocities and accelerations

  /// Solutions that a tangent and its factor cost.
  double renewal() const { return (tangent - residual + factor) / (residual + solve + update); }
};

/// No allocation.
StepCost estimate_step_cost(const System& system);

}  // namespace bough::step
