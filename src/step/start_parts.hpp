#pragma once
/// Parts of the consistent start that several integrators share.
#include "bough/step/system.hpp"

namespace bough::step {

/// The matrix of a start: that of the masses [M G^T; G 0]. Where rotations have no mass (Plan::has_massless_rotations)
///   [K + C/h + M/tau^2  G^T; G 0],   tau = 1e-3 h,
/// in which masses prevail over stiffness by 1e6 (h omega)^-2 and stiffness determines what has none.
elements::Slopes start_slopes(const System& system, double step_size);

/// Massless rotations at the start, as statics determine them under the forces and motions of everything else:
///   f_w(q) = 0,   (f_w)' = K v + f_t = 0
/// by Newton steps with the matrix above, in which masses stay where they are, up to tau^2 times their accelerations.
/// Nothing happens where all has mass.
[[nodiscard]] std::optional<Trouble> place_massless(System& system, State& state, double step_size);
[[nodiscard]] std::optional<Trouble> turn_massless(System& system, State& state, double step_size);

/// Projects velocities, in the mass metric, to those with constraint rates G d, where d is a motion as a vector of
/// unknowns (null: rates of zero). Factors the matrix of a start at this state. The laws must be set to its time.
[[nodiscard]] std::optional<Trouble> set_normal_velocities(System& system, State& state, const std::vector<double>* d,
                                                           double step_size);

/// Solves the equations of motion at the given positions and velocities for dv/dt and multipliers, with the matrix of a
/// start already factored. Where rotations have no mass they are solved with M + h^2 K/4, in which modes faster than the
/// step are filtered as in all jerks of a start, and massless rotations follow: K_ww w' = -K_wu u'.
[[nodiscard]] std::optional<Trouble> solve_accelerations(System& system, State& state, double step_size);

}  // namespace bough::step
