#pragma once
/// Variational integrator: the midpoint rule on the group as a discrete Lagrangian, constraints as in SHAKE and RATTLE.
///   L_d = h L(H_n exp(D/2), D/h),  D = log(H_n^-1 H_{n+1}) node by node
///   p_n - (h/2) G_n^T lambda = -D_1 L_d,   Phi(q_{n+1}, t_{n+1}) = 0
///   p_{n+1} = D_2 L_d - G_{n+1}^T mu,      d/dt Phi(q_{n+1}, v_{n+1}, t_{n+1}) = 0,   p = dL/dv
/// Elements see relative motions only, so linear and angular momentum of what floats freely are kept to round-off,
/// whatever the step and the tolerance. Where h is constant and resolves the fastest vibration, energy keeps within a
/// bound that falls with h^2. Nothing is damped: not for stiff scenes with vibrations that the step does not resolve,
/// which ring or grow. Second order in positions, velocities, multipliers. Sources: Marsden, West 2001; Leyendecker,
/// Marsden, Ortiz 2008 (constraints); Andersen 1983 (RATTLE).
#include <memory>

#include "bough/step/integrator.hpp"

namespace bough::step {

/// The integrator with its buffers, and a second linear solver, of [M G^T; G 0], for velocities and accelerations;
/// both factors serve over many steps. Velocities after a step are those of the momenta and satisfy the constraints;
/// accelerations and multipliers are those of the equations of motion there (left limit). `unresolved` is the largest
/// |v_{n+1} - v_n - h (a_n + a_{n+1})/2| over |h a| of the last step, lengths by the scene's size: small where the
/// step resolves the motion, near 1 where it contains vibrations faster than the step. On the group of the system's
/// scene. `newmark_beta`: see StepOptions; (beta - 1/4) h^2 is the elastic inertia of elements/momentum.hpp.
std::unique_ptr<Integrator> make_variational(System& system, const scene::Solver& solver, double newmark_beta);

}  // namespace bough::step
