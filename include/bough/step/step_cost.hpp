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
  double solve = 0.0;   ///< a right-hand side condensed and substituted
  double check = 0.0;   ///< of the backward error of a solution
  double update = 0.0;  ///< nodes moved, with their velocities and accelerations
  double end = 0.0;     ///< once a step: predictors, limits of shapes, what the next step needs

  /// Solutions that a tangent and its factor cost.
  double renewal() const { return (tangent - residual + factor) / (residual + solve + update); }
};

StepCost estimate_step_cost(const System& system);

}  // namespace bough::step
