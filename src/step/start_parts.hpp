#pragma once
/// Parts of a consistent start that several integrators use.
#include "bough/step/system.hpp"

namespace bough::step {

/// Velocities that meet the constraints up to G d by row (d a motion in the unknowns; null: exactly), nearest in the
/// mass metric. The matrix [M G^T; G 0] is factored at this state. Laws of its time are set.
[[nodiscard]] std::optional<Trouble> set_normal_velocities(System& system, State& state, const std::vector<double>* d);

/// dv/dt and multipliers of the equations of motion at positions and velocities, with that matrix factored.
[[nodiscard]] std::optional<Trouble> solve_accelerations(System& system, State& state);

}  // namespace bough::step
