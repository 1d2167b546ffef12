#pragma once
/// What a variational integrator asks of an element: the momenta and forces of its Lagrangian
///   L(q, v) = kinetic energy - strain energy - potential of gravity,
/// at a pose q and a twist v of its ports. Sources: Marsden, West 2001; Bou-Rabee, Marsden 2009 (Lie groups).
#include "bough/elements/evaluate.hpp"

namespace bough::elements {

/// Momentum of each port, P = dL/dv, and force F = -dL/dq - loads + damping, by right increments of the ports, in their own axes; the
/// forces resist the motion, as residuals do. d/dt P - ad(v)^T P + F is the residual of the equations of motion. force == nullptr: P only.
/// `elastic_inertia` tau [s^2] adds tau/2 times the strain energy with rates of strain for strains, of beams and bushings, to L: no rigid
/// motion has any of it. For linear elasticity tau = (beta - 1/4) h^2 makes the midpoint rule that of Newmark
/// with beta (Kane, Marsden, Ortiz, West 2000). Surroundings of dynamics; accelerations are not looked at.
/// Here: elements without inertia, whose force is their residual.
template <class E, class S>
void eval_momentum(const E& e, const PortMotion<S>* p, const Surroundings<S>& around, double /*elastic_inertia*/,
                   S* momentum, S* force) {
  for (int k = 0; k < 6 * E::num_ports; ++k) momentum[k] = S(0.0);
  if (force != nullptr) eval_residual(e, p, static_cast<const S*>(nullptr), around, force);
}

/// The efforts of a joint; its constraints are the integrator's (evaluate_rows).
template <class S, class C>
void eval_momentum(const JointOf<C>& joint, const PortMotion<S>* p, const Surroundings<S>& around, double turns,
                   S* momentum, S* force) {
  for (int k = 0; k < 12; ++k) momentum[k] = S(0.0);
  if (force == nullptr) return;
  const Frame<S> H = motion::relative(p[0].H, p[1].H);
  Vec6<S> f = Vec6<S>::zero();
  add_efforts(joint, H, p, around, C(turns), f);
  const Vec6<S> first = motion::inverse_adjoint_transpose_times(H, f);
  for (int k = 0; k < 6; ++k) {
    force[k] = -first[k];
    force[6 + k] = f[k];
  }
}

/// P = M v, F = -M (R^T g; 0).
template <class S, class C>
void eval_momentum(const RigidBodyOf<C>& body, const PortMotion<S>* p, const Surroundings<S>& around,
                   double /*elastic_inertia*/, S* momentum, S* force) {
  const Vec6<S> P = body.mass * p[0].v;
  for (int k = 0; k < 6; ++k) momentum[k] = P[k];
  if (force == nullptr) return;
  const Vec3<S> weight = lanes::transpose_times(p[0].H.R, around.gravity);
  const Vec6<S> F = body.mass * lanes::join<S>(-weight, Vec3<S>::zero());
  for (int k = 0; k < 6; ++k) force[k] = F[k];
}

/// Momenta of relative motions d_i = log(H_r^-1 H_i) and of the twists that they blend (see BeamRates).
template <class S, int N>
struct RateMomenta {
  DualVec<S> by_rate[N];  ///< dL/d(d_i')
  DualVec<S> by_z[N];     ///< dL/dz_i at fixed d_i', v_r
  DualVec<S> by_r;        ///< dL/dv_r at fixed d_i', z_i
  RateMomenta() : by_r(DualVec<S>::zero()) {
    for (int i = 0; i < N; ++i) by_rate[i] = by_z[i] = DualVec<S>::zero();
  }
};

/// Momenta of the ports,  P_i = U_i^T (by_z_i + by_rate_i),  P_r = by_r + sum_i ad(d_i)^T by_rate_i - sum_i P_i,  and what z_i = U_i(d_i) (v_i - v_r),
/// d_i' = z_i + ad(d_i) v_r do at fixed twists to the forces p_i conjugate to d_i (if any):
///   p_i -= J_i^T (by_z_i + by_rate_i) - ad(v_r)^T by_rate_i,   J_i = d(U_i (v_i - v_r))/dd_i.
template <class S, int N>
void eval_port_momenta(const BeamRates<S, N>& b, const RateMomenta<S, N>& m, S* momentum, DualVec<S>* p) {
  DualVec<S> q[N], sum = m.by_r;
  for (int i = 0; i < N; ++i) {
    if (i == Beam<N>::reference) continue;
    q[i] = m.by_z[i] + m.by_rate[i];
    sum = add_cross(sum, m.by_rate[i], b.d[i]);
    if (p != nullptr) p[i] = add_cross(p[i], m.by_rate[i], b.v) - transpose_times(jacobian(b.inverse[i], b.w[i]), q[i]);
  }
  eval_nodal_wrenches<S, N>(b, q, sum, momentum);
}

/// Forces on the ports from those conjugate to d_i alone: together they bear sum_i ad(d_i)^T p_i.
template <class S, int N>
DualVec<S> sum_relative_forces(const BeamRates<S, N>& b, const DualVec<S>* p) {
  DualVec<S> sum = DualVec<S>::zero();
  for (int i = 0; i < N; ++i)
    if (i != Beam<N>::reference) sum = add_cross(sum, p[i], b.d[i]);
  return sum;
}

/// With the elastic inertia's momentum tau K d', d = log(H_a^-1 H_b).
template <class S, class C>
void eval_momentum(const BushingOf<C>& bushing, const PortMotion<S>* ports, const Surroundings<S>& around,
                   double elastic_inertia, S* momentum, S* force) {
  BeamRates<S, 2> b;
  eval_beam_rates<S, 2>(ports, around, false, true, b);
  RateMomenta<S, 2> m;
  m.by_rate[1] = motion::wrench_dual(Vec6<S>(elastic_inertia * (bushing.stiffness * motion::motion_vector(b.rate[1]))));
  DualVec<S> p[2] = {DualVec<S>::zero(), DualVec<S>::zero()};
  eval_port_momenta<S, 2>(b, m, momentum, p);
  if (force == nullptr) return;
  S inertial[12];
  eval_nodal_wrenches<S, 2>(b, p, sum_relative_forces<S, 2>(b, p), inertial);
  eval_residual(bushing, ports, static_cast<const S*>(nullptr), around, force);
  for (int k = 0; k < 12; ++k) force[k] = force[k] + inertial[k];
}

/// The elastic inertia tau/2 e'^T C e' of the strain rates e' = (T y' + A d')/L, y = dd/ds, A = d(T y)/dd: momenta by d_i', and, with
/// m = tau w C e', what it does to the forces p_i (if any):
///   by_rate_i += N_i' T^T m + N_i A^T m,   p_i -= (N_i d(T y' + T' y)/dd + N_i' T')^T m,   T' the derivative of T along d'.
template <class S, int N, class C>
void add_elastic_momentum(const Beam<N, C>& beam, const BeamRates<S, N>& b, double elastic_inertia, DualVec<S>* by_rate,
                          DualVec<S>* p) {
  constexpr int r = Beam<N>::reference;
  const C inverse = 1.0 / beam.length;
  if constexpr (N == 2) {
    const Vec6<S> m = beam.stiffness * motion::motion_vector(b.rate[1]);
    by_rate[1] = add_scaled(by_rate[1], elastic_inertia * inverse, motion::wrench_dual(m));
  } else {
    const auto& rule = strain_rule<N>();
    for (int g = 0; g < Beam<N>::num_strain_points; ++g) {
      const double *shape = rule.shape[g], *slope = rule.slope[g];
      const DualVec<S> y = blend<S, N>(slope, b.d), d1 = blend<S, N>(shape, b.rate), y1 = blend<S, N>(slope, b.rate);
      const DualSeries<S> T = motion::dual_tangent(blend<S, N>(shape, b.d));
      const DualMat<S> A = jacobian(T, y);
      const Vec6<S> strain_rate = inverse * motion::motion_vector(times(T, y1) + times(A, d1));
      const DualVec<S> m =
          motion::wrench_dual(Vec6<S>((elastic_inertia * rule.weight[g]) * (beam.stiffness * strain_rate)));
      const DualVec<S> by_slope = transpose_times(T, m), by_shape = transpose_times(A, m);
      for (int i = 0; i < N; ++i)
        if (i != r) by_rate[i] = add_scaled(add_scaled(by_rate[i], slope[i], by_slope), shape[i], by_shape);
      if (p == nullptr) continue;
      const DualVec<S> from_d = transpose_times(jacobian(T, y1) + second_jacobian(T, d1, y), m),
                       from_y = transpose_times(slope_matrix(T, d1), m);
      for (int i = 0; i < N; ++i)
        if (i != r) p[i] = add_scaled(add_scaled(p[i], -shape[i], from_d), -slope[i], from_y);
    }
  }
}

/// With pi = w L m v at a mass point, v = v_r + T z:  by_z_i = sum N_i T^T pi,  by_r = sum pi,  dK/dd_i = sum N_i (d(T z)/dd)^T pi. The weight
/// acts on the section's own virtual motions, as in the residual.
template <class S, int N, class C>
void eval_momentum(const Beam<N, C>& beam, const PortMotion<S>* ports, const Surroundings<S>& around,
                   double elastic_inertia, S* momentum, S* force) {
  constexpr int r = Beam<N>::reference;
  BeamRates<S, N> b;
  eval_beam_rates<S, N>(ports, around, false, true, b);
  RateMomenta<S, N> m;
  DualVec<S> p[N], pull[N], pulls = DualVec<S>::zero();
  for (int i = 0; i < N; ++i) p[i] = pull[i] = DualVec<S>::zero();
  if (force != nullptr) eval_internal_forces<S, N>(beam, b, beam.has_damping, p);
  if (elastic_inertia != 0.0)
    add_elastic_momentum<S, N>(beam, b, elastic_inertia, m.by_rate, force != nullptr ? p : nullptr);
  if (beam.has_mass) {
    const auto& rule = mass_rule<N>();
    Surroundings<S> at_rest = around;
    at_rest.has_inertia = false;
    DualVec<S> z[N], weight = eval_weighed_acceleration(ports[r], at_rest);
    for (int i = 0; i < N && force != nullptr; ++i)
      if (i != r) z[i] = times(b.inverse[i], eval_weighed_acceleration(ports[i], at_rest) - weight);
    for (int g = 0; g < Beam<N>::num_mass_points; ++g) {
      const double* shape = rule.shape[g];
      const C w = rule.weight[g] * beam.length;
      const DualSeries<S> T = motion::dual_tangent(blend<S, N>(shape, b.d));
      const DualVec<S> z_g = blend<S, N>(shape, b.z), v = b.v + times(T, z_g);
      const DualVec<S> pi = motion::wrench_dual(Vec6<S>(w * (beam.mass * motion::motion_vector(v))));
      const DualVec<S> by_z = transpose_times(T, pi);
      for (int i = 0; i < N; ++i)
        if (i != r) m.by_z[i] = add_scaled(m.by_z[i], shape[i], by_z);
      m.by_r = m.by_r + pi;
      if (force == nullptr) continue;
      const DualVec<S> by_d = transpose_times(jacobian(T, z_g), pi);
      const DualVec<S> fall = weight + times(T, blend<S, N>(shape, z));
      const DualVec<S> f = motion::wrench_dual(Vec6<S>(w * (beam.mass * motion::motion_vector(fall))));
      const DualVec<S> q = transpose_times(T, f);
      for (int i = 0; i < N; ++i) {
        if (i == r) continue;
        p[i] = add_scaled(p[i], -shape[i], by_d);
        pull[i] = add_scaled(pull[i], shape[i], q);
      }
      pulls = pulls + f;
    }
  }
  eval_port_momenta<S, N>(b, m, momentum, force != nullptr ? p : nullptr);
  if (force == nullptr) return;
  const DualVec<S> sum = pulls + sum_relative_forces<S, N>(b, p);
  for (int i = 0; i < N; ++i) p[i] = p[i] + pull[i];
  eval_nodal_wrenches<S, N>(b, p, sum, force);
}

/// The step of the midpoint rule on the group, H_{n+1} = H_n exp(D), with P and F at the pose H_n exp(D/2) and the twist D/h: momenta at
/// both ends, in the axes there, from the discrete Lagrangian L_d = h L(H_n exp(D/2), D/h):
///   p_n = -D_1 L_d = T(-D)^-T (P + (h/2) T(-D/2)^T F),   p_{n+1} = D_2 L_d = T(D)^-T (P - (h/2) T(D/2)^T F).
template <class S>
Vec6<S> eval_momentum_before(const Vec6<S>& D, double h, const Vec6<S>& P, const Vec6<S>& F) {
  return motion::inverse_tangent_transpose_times(
      Vec6<S>(-D), Vec6<S>(P + (0.5 * h) * motion::tangent_transpose_times(Vec6<S>(-0.5 * D), F)));
}
template <class S>
Vec6<S> eval_momentum_after(const Vec6<S>& D, double h, const Vec6<S>& P, const Vec6<S>& F) {
  return motion::inverse_tangent_transpose_times(
      D, Vec6<S>(P - (0.5 * h) * motion::tangent_transpose_times(Vec6<S>(0.5 * D), F)));
}

/// Momentum and force of an element in the axes of its nodes, 6 each per port off the ground; accelerations are not looked at.
template <class E>
void evaluate_momentum(const E& e, const Field& field, double turns, double elastic_inertia, double* momentum,
                       double* force);

/// matrix += factor / tau times the elastic inertia's part of dP/dv, in the unknowns of the nodes, row-major.
template <class E>
void add_elastic_mass(const E& e, const Field& field, double factor, double* matrix);

/// matrix += factor ad(v)^T M on the diagonal blocks of the nodes, M that of a body, or of a beam's mass shared out among its nodes.
template <class E>
void add_gyroscopic(const E& e, const Field& field, double factor, double* matrix);

/// Values of a joint's rows, and their gradients by right increments of its nodes off the ground, row-major, num_rows x 6 (nodes).
void evaluate_rows(const Joint& joint, const Field& field, double turns, double* rows, double* gradient);

}  // namespace bough::elements
