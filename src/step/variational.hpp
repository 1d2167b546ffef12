#pragma once
/// Variational integrator: the midpoint rule on the group as a discrete Lagrangian, constraints as in SHAKE and RATTLE.
///   L_d = h L(H_n exp(D/2), D/h),  D = log(H_n^-1 H_{n+1}) node by node
///   p_n - (h/2) G_n^T lambda = -D_1 L_d,   Phi(q_{n+1}, t_{n+1}) = 0
///   p_{n+1} = D_2 L_d - G_{n+1}^T mu,      d/dt Phi(q_{n+1}, v_{n+1}, t_{n+1}) = 0,   p = dL/dv
/// Elements depend on relative motions only, so the linear and angular momenta of freely floating parts are conserved
/// to round-off, whatever the step and the tolerance. If h is constant and resolves the fastest vibration, the energy
/// error stays within a bound of order h^2. Nothing is damped. The integrator is therefore not suited to stiff scenes
/// with vibrations that the step does not resolve: these ring or grow. It is of second order in positions, velocities
/// and multipliers. Sources: Marsden, West 2001; Leyendecker, Marsden, Ortiz 2008 (constraints); Andersen 1983
/// (RATTLE).
#include <memory>

#include "bough/step/integrator.hpp"

namespace bough::step {

/// Makes the integrator on the group of the system's scene, with its buffers and a second linear solver, of [M G^T; G
/// 0], for velocities and accelerations. Both factorizations are reused over many steps. The velocities after a step
/// follow from the momenta and satisfy the constraints. Accelerations and multipliers are those of the equations of
/// motion there (left limit). `unresolved` is the largest |v_{n+1} - v_n - h (a_n + a_{n+1})/2| relative to |h a| of
/// the last step, lengths relative to the size of the structure: small if the step resolves the motion, near 1 if the
/// motion contains vibrations faster than the step. `newmark_beta`: see StepOptions; (beta - 1/4) h^2 is the elastic
/// inertia of elements/momentum.hpp.
std::unique_ptr<Integrator> make_variational(System& system, const scene::Solver& solver, double newmark_beta);

}  // namespace bough::step
