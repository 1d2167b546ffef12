#pragma once
/// What a variational integrator asks of an element: the momenta and forces of its Lagrangian
///   L(q, v) = kinetic energy - strain energy - potential of gravity,
/// at a pose q and a twist v of its ports. Sources: Marsden, West 2001; Bou-Rabee, Marsden 2009 (Lie groups).
#include "bough/elements/evaluate.hpp"
#include "bough/motion/second_slopes.hpp"

namespace bough::elements {

/// Momentum of each port, P = dL/dv, and force F = -dL/dq - loads + damping, by right increments of the ports, in their own axes; the
/// forces resist the motion, as residuals do. d/dt P - ad(v)^T P + F is the residual of the equations of motion. force == nullptr: P only.
/// `elastic_inertia` tau [s^2] adds tau/2 times the strain energy with rates of strain for strains, of beams and bushings, to L: no rigid
/// motion has any of it. For linear elasticity tau = (beta - 1/4) h^2 makes the midpoint rule that of Newmark
/// with beta (Kane, Marsden, Ortiz, West 2000).
/// Here: elements without inertia, whose force is their residual.
template <class E, class S>
void eval_momentum(const E& e, const PortMotion<S>* p, const Surroundings<S>& around, double /*elastic_inertia*/,
                   S* momentum, S* force) {
  for (int k = 0; k < 6 * E::num_ports; ++k) momentum[k] = S(0.0);
  if (force != nullptr) eval_residual(e, p, static_cast<const S*>(nullptr), around, force);
}

/// The efforts of a joint; its constraints are the integrator's (evaluate_rows).
template <class S>
void eval_momentum(const Joint& joint, const PortMotion<S>* p, const Surroundings<S>& around, double turns, S* momentum,
                   S* force) {
  for (int k = 0; k < 12; ++k) momentum[k] = S(0.0);
  if (force == nullptr) return;
  const Frame<S> H = motion::relative(p[0].H, p[1].H);
  const Vec6<S> f = eval_efforts(joint, H, p, around, turns);
  const Vec6<S> first = motion::inverse_adjoint_transpose_times(H, f);
  for (int k = 0; k < 6; ++k) {
    force[k] = -first[k];
    force[6 + k] = f[k];
  }
}

/// P = M v, F = -M (R^T g; 0).
template <class S>
void eval_momentum(const RigidBody& body, const PortMotion<S>* p, const Surroundings<S>& around,
                   double /*elastic_inertia*/, S* momentum, S* force) {
  const Vec6<S> P = body.mass * p[0].v;
  for (int k = 0; k < 6; ++k) momentum[k] = P[k];
  if (force == nullptr) return;
  const Vec3<S> weight = lanes::transpose_times(p[0].H.R, around.gravity);
  const Vec6<S> F = body.mass * lanes::join<S>(-weight, Vec3<S>::zero());
  for (int k = 0; k < 6; ++k) force[k] = F[k];
}

/// Carries momenta q conjugate to the rate of a relative motion d = log(H_r^-1 H_i) to both ports,
///   P_i = T(d)^-T q,   P_r = -Ad(H_ri)^-T P_i,
/// and what their kinetic energy does at fixed twists to the forces (if any), from d d' = -T(d)^-1 (ad(c) + A(d') T(d)^-1) zeta,
/// c = Ad(H_ri)^-1 v_r, A(y) = d(T(d) y)/dd.
template <class S>
void carry_momentum(const Frame<S>& relative, const Vec6<S>& d, const motion::MotionOperator<S>& inverse,
                    const Vec6<S>& rate, const Vec6<S>& v_r, const Vec6<S>& q, Vec6<S>& P_i, Vec6<S>& P_r, Vec6<S>* F_i,
                    Vec6<S>* F_r) {
  const Vec6<S> P = inverse.transpose_times(q);
  P_i += P;
  P_r -= motion::inverse_adjoint_transpose_times(relative, P);
  if (F_i == nullptr) return;
  const Vec6<S> carried = motion::inverse_adjoint_times(relative, v_r);
  const Mat6<S> A = motion::tangent_operator(d).derivative(rate);
  const Vec6<S> x =
      motion::cross6_transpose_times(carried, P) + inverse.transpose_times(Vec6<S>(lanes::transpose_times(A, P)));
  *F_i += x;
  *F_r -= motion::inverse_adjoint_transpose_times(relative, x);
}

/// With the elastic inertia's q = tau K d'.
template <class S>
void eval_momentum(const Bushing& bushing, const PortMotion<S>* p, const Surroundings<S>& around,
                   double elastic_inertia, S* momentum, S* force) {
  if (force != nullptr) eval_residual(bushing, p, static_cast<const S*>(nullptr), around, force);
  Vec6<S> P[2] = {Vec6<S>::zero(), Vec6<S>::zero()}, F[2] = {P[0], P[0]};
  const Frame<S> relative = motion::relative(p[0].H, p[1].H);
  const Vec6<S> d = motion::Se3::log(relative);
  const auto inverse = motion::inverse_tangent_operator(d);
  const Vec6<S> rate = inverse.times(Vec6<S>(p[1].v - motion::inverse_adjoint_times(relative, p[0].v)));
  carry_momentum(relative, d, inverse, rate, p[0].v, Vec6<S>(elastic_inertia * (bushing.stiffness * rate)), P[1], P[0],
                 force != nullptr ? &F[1] : nullptr, &F[0]);
  for (int k = 0; k < 6; ++k) {
    momentum[k] = P[0][k];
    momentum[6 + k] = P[1][k];
    if (force == nullptr) continue;
    force[k] = force[k] + F[0][k];
    force[6 + k] = force[6 + k] + F[1][k];
  }
}

/// The elastic inertia tau/2 e.^T C e. of the strain rates e. = (T y. + A(y) d.)/L, y = d' along the axis: momenta q_i conjugate to d_i., and
/// what it does to the forces p_i (if any), with m = tau w C e.:
///   q_i += N_i' T^T m + N_i A^T m,   p_i -= (N_i (A(y.) + d(A(y) d.)/dd) + N_i' (A(d.) - ad(T d.) T))^T m.
template <class S, int N>
void add_elastic_momentum(const Beam<N>& beam, const BeamShape<S, N>& b, const Vec6<S>* rate, double elastic_inertia,
                          Vec6<S>* q, Vec6<S>* p) {
  if constexpr (N == 2) {
    q[1] += (elastic_inertia / beam.length) * (beam.stiffness * rate[1]);
  } else {
    const auto& rule = strain_rule<N>();
    for (int g = 0; g < Beam<N>::num_strain_points; ++g) {
      const double *shape = rule.shape[g], *slope = rule.slope[g];
      const Vec6<S> y = blend<S, N>(slope, b.d), d1 = blend<S, N>(shape, rate), y1 = blend<S, N>(slope, rate);
      const motion::TangentSlopes<S> slopes(blend<S, N>(shape, b.d));
      const auto& op = slopes.T();
      const Mat6<S> A = op.derivative(y);
      const Vec6<S> m = (elastic_inertia * rule.weight[g] / beam.length) * (beam.stiffness * (op.times(y1) + A * d1));
      const Vec6<S> by_slope = op.transpose_times(m), by_shape = lanes::transpose_times(A, m);
      for (int i = 0; i < N; ++i)
        if (i != Beam<N>::reference) q[i] += slope[i] * by_slope + shape[i] * by_shape;
      if (p == nullptr) continue;
      const Vec6<S> from_d = lanes::transpose_times(op.derivative(y1) + slopes.second(d1, y), m);
      const Vec6<S> from_y = lanes::transpose_times(op.derivative(d1), m) -
                             op.transpose_times(motion::cross6_transpose_times(op.times(d1), m));
      for (int i = 0; i < N; ++i)
        if (i != Beam<N>::reference) p[i] -= shape[i] * from_d + slope[i] * from_y;
    }
  }
}

/// With pi = w L m v at a mass point, c = Ad(exp d)^-1 v_r, q_i conjugate to d_i':
///   q_i = sum N_i T^T pi,   P_r = sum Ad(exp d)^-T pi - ...,   dK/dd_i = sum N_i (ad(c) T + A(d'))^T pi.
template <class S, int N>
void eval_momentum(const Beam<N>& beam, const PortMotion<S>* ports, const Surroundings<S>& around,
                   double elastic_inertia, S* momentum, S* force) {
  constexpr int r = Beam<N>::reference;
  const BeamShape<S, N> b = eval_shape<S, N>(ports);
  Vec6<S> rate[N], p[N], q[N], F[N], P[N];
  for (int i = 0; i < N; ++i) p[i] = q[i] = F[i] = P[i] = Vec6<S>::zero();
  eval_shape_rates<S, N>(b, ports, rate);
  if (force != nullptr) add_internal_forces<S, N>(beam, b, rate, p);
  if (elastic_inertia != 0.0)
    add_elastic_momentum<S, N>(beam, b, rate, elastic_inertia, q, force != nullptr ? p : nullptr);
  if (beam.has_mass) {
    const auto& rule = mass_rule<N>();
    const Vec6<S> weight = lanes::join<S>(lanes::transpose_times(ports[r].H.R, around.gravity), Vec3<S>::zero());
    for (int g = 0; g < Beam<N>::num_mass_points; ++g) {
      const double* shape = rule.shape[g];
      const double w = rule.weight[g] * beam.length;
      const SectionMotion<S> m = eval_section<S, N>(shape, b, rate, nullptr, ports[r]);
      const Vec6<S> pi = w * (beam.mass * m.v);
      const Vec6<S> by_rate = m.T.transpose_times(pi);
      for (int i = 0; i < N; ++i)
        if (i != r) q[i] += shape[i] * by_rate;
      P[r] += motion::inverse_adjoint_transpose_times(m.relative, pi);
      if (force == nullptr) continue;
      const Vec6<S> carried = motion::inverse_adjoint_times(m.relative, ports[r].v);
      const Vec6<S> by_shape = m.T.transpose_times(motion::cross6_transpose_times(carried, pi)) +
                               lanes::transpose_times(m.T.derivative(blend<S, N>(shape, rate)), pi);
      for (int i = 0; i < N; ++i)
        if (i != r) p[i] -= shape[i] * by_shape;
      const Vec6<S> pull = (-w) * (beam.mass * motion::inverse_adjoint_times(m.relative, weight));
      add_section_wrench<S, N>(shape, m, pull, p, F);
    }
  }
  if (force != nullptr) add_nodal_wrenches<S, N>(b, p, F);
  for (int i = 0; i < N; ++i)
    if (i != r)
      carry_momentum(b.relative[i], b.d[i], b.inverse[i], rate[i], ports[r].v, q[i], P[i], P[r],
                     force != nullptr ? &F[i] : nullptr, &F[r]);
  for (int i = 0; i < N; ++i)
    for (int k = 0; k < 6; ++k) {
      momentum[6 * i + k] = P[i][k];
      if (force != nullptr) force[6 * i + k] = F[i][k];
    }
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
