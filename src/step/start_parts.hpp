#pragma once
/// Parts of the consistent start that several integrators share.
#include "bough/step/system.hpp"

namespace bough::step {

/// Projects velocities, in the mass metric, to those with constraint rates G d, where d is a motion as a vector of
/// unknowns (null: rates of zero). Factors [M G^T; G 0] at this state. The laws must be set to its time.
[[nodiscard]] std::optional<Trouble> set_normal_velocities(System& system, State& state, const std::vector<double>* d);

/// Solves the equations of motion at the given positions and velocities for dv/dt and multipliers, with the matrix [M
/// G^T; G 0] already factored.
[[nodiscard]] std::optional<Trouble> solve_accelerations(System& system, State& state);

}  // namespace bough::step
