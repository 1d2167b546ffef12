#pragma once
/// The equilibrium in which a dynamic system comes to rest under the loads of one time.
#include <string>

#include "bough/step/advance.hpp"

namespace bough::step {

struct EquilibriumReport {
  bool found = false;
  std::string cause;   ///< why there is none
  int steps = 0;       ///< of pseudo-time, accepted
  int iterations = 0;  ///< of Newton's method
  /// Sum of the largest motions of a node in these steps: lengths over the size of the structure [-], rotations [rad].
  double moved = 0.0;
};

/// Moves the nodes of `state` to an equilibrium at State::time, where laws have their values behind that time, drives
/// keep their positions, and velocities are those of rest in the observer's frame. Each step of pseudo-time starts from
/// rest and solves
///   (c / h^2) M dq + (c' / h) C dq + f(q exp(dq), multipliers) = 0
/// (generalized-alpha with spectral radius 0), which for conservative loads decreases the potential energy; h grows
/// from step to step, so that the steps become those of Newton's method for f = 0. Inertia keeps motions that nothing
/// resists where they are, and an equilibrium is reached from poses that are far from it. first_size: h of the first
/// step [s]. Afterwards the nodes have the velocities that they had before, with the same components in the ground's
/// axes.
EquilibriumReport find_equilibrium(System& system, State& state, const StepOptions& options, double first_size);

}  // namespace bough::step
