#pragma once
/// The terms that a variational integrator needs of an element: momenta and forces of its Lagrangian
///   L(q, v) = kinetic energy - strain energy - potential of gravity,
/// at a pose q and a twist v of its ports. Sources: Marsden, West 2001; Bou-Rabee, Marsden 2009 (Lie groups).
#include "bough/elements/evaluate.hpp"
#include "bough/motion/vectors_on.hpp"

namespace bough::elements {

/// Momentum of each port, P = dL/dv, and force F = -dL/dq - loads + damping, by right increments of the ports, in
/// their own axes; the forces resist the motion, as residuals do. d/dt P - ad(v)^T P + F is the residual of the
/// equations of motion. force == nullptr: P only. `elastic_inertia` tau [s^2] adds tau/2 times the strain energy with
/// rates of strain for strains, of elements that have a stiffness matrix, to L: no rigid motion has any of it. For linear elasticity tau
/// tau = (beta - 1/4) h^2 makes the midpoint rule that of Newmark with beta (Kane, Marsden, Ortiz, West 2000).
/// Surroundings are those of dynamics; accelerations are not used. This overload: elements without inertia, whose force
/// is their residual.
template <class E, class G, class S>
void eval_momentum(const E& e, const PortMotionOn<G, S>* p, const SurroundingsOn<G, S>& around,
                   double /*elastic_inertia*/, S* momentum, S* force) {
  for (int k = 0; k < G::dof * E::num_ports; ++k) momentum[k] = S(0.0);
  if (force != nullptr) eval_residual(e, p, around, force);
}

/// The efforts of a joint; the integrator treats its constraints itself (evaluate_rows).
template <class G, class S, class C>
void eval_momentum(const JointOn<G, C>& joint, const PortMotionOn<G, S>* p, const SurroundingsOn<G, S>& around,
                   double turns, S* momentum, S* force) {
  for (int k = 0; k < 2 * G::dof; ++k) momentum[k] = S(0.0);
  if (force == nullptr) return;
  const typename G::template Pose<S> H = G::relative(p[0].H, p[1].H);
  auto f = G::wrench(G::template Vector<S>::zero());
  add_efforts<G, S, C>(joint, H, p, around, C(turns), f);
  put_relative_wrench<G, S>(H, f, force);
}

/// P = M v, F = -M (R^T g; 0).
template <class G, class S, class C>
void eval_momentum(const RigidBodyOn<G, C>& body, const PortMotionOn<G, S>* p, const SurroundingsOn<G, S>& around,
                   double /*elastic_inertia*/, S* momentum, S* force) {
  G::put(G::matrix_times(body.mass, G::motion(p[0].v)), momentum);
  if (force == nullptr) return;
  const typename G::template Translation<S> lift = -G::turned_back(p[0].H, around.gravity);
  G::put(G::matrix_times(body.mass, G::translation(lift)), force);
}

/// Momenta of relative motions d_i = log(H_r^-1 H_i) and of the twists that they blend (see BeamRates).
template <class G, class S, int N>
struct RateMomenta {
  using Wrench = typename G::template Wrench<S>;
  Wrench by_rate[N];  ///< dL/d(d_i')
  Wrench by_z[N];     ///< dL/dz_i at fixed d_i', v_r
  Wrench by_r;        ///< dL/dv_r at fixed d_i', z_i
  RateMomenta() : by_r(G::wrench(G::template Vector<S>::zero())) {
    for (int i = 0; i < N; ++i) by_rate[i] = by_z[i] = by_r;
  }
};

/// Momenta of the ports,  P_i = U_i^T (by_z_i + by_rate_i),  P_r = by_r + sum_i ad(d_i)^T by_rate_i - sum_i P_i,  and
/// what z_i = U_i(d_i) (v_i - v_r), d_i' = z_i + ad(d_i) v_r do at fixed twists to the forces p_i conjugate to d_i
/// (if any):
///   p_i -= J_i^T (by_z_i + by_rate_i) - ad(v_r)^T by_rate_i,   J_i = d(U_i (v_i - v_r))/dd_i.
template <class G, class S, int N>
void eval_port_momenta(const BeamRates<G, S, N>& b, const RateMomenta<G, S, N>& m, S* momentum,
                       typename G::template Wrench<S>* p) {
  typename G::template Wrench<S> q[N], sum = m.by_r;
  for (int i = 0; i < N; ++i) {
    if (i == beam_reference<N>) continue;
    q[i] = m.by_z[i] + m.by_rate[i];
    sum = G::add_dual_bracket(sum, b.d[i], m.by_rate[i]);
    if (p != nullptr)
      p[i] = G::add_dual_bracket(p[i], b.v, m.by_rate[i]) - G::transpose_times(jacobian(b.inverse[i], b.w[i]), q[i]);
  }
  eval_nodal_wrenches<G, S, N>(b, q, sum, momentum);
}

/// Includes the momentum tau K d' of the elastic inertia, d = log(H_a^-1 H_b), K the stiffness without its factor: what
/// a law changes at will has no part in momenta.
template <IsCatalogued E, class G, class S>
requires(E::has_stiffness_matrix) void eval_momentum(const E& e, const PortMotionOn<G, S>* ports,
                                                     const SurroundingsOn<G, S>& around, double elastic_inertia,
                                                     S* momentum, S* force) {
  BeamRates<G, S, 2> b;
  eval_beam_rates<G, S, 2>(ports, around, false, true, b);
  RateMomenta<G, S, 2> m;
  m.by_rate[1] = G::scaled(elastic_inertia, G::matrix_times(e.stiffness, b.rate[1]));
  const auto zero = G::wrench(G::template Vector<S>::zero());
  typename G::template Wrench<S> p[2] = {zero, zero};
  eval_port_momenta<G, S, 2>(b, m, momentum, p);
  if (force == nullptr) return;
  S inertial[2 * G::dof];
  eval_nodal_wrenches<G, S, 2>(b, p, sum_relative_forces<G, S, 2>(b, p), inertial);
  eval_residual(e, ports, around, force);
  for (int k = 0; k < 2 * G::dof; ++k) force[k] = force[k] + inertial[k];
}

/// The elastic inertia tau/2 e'^T C e' of the strain rates e' = (T y' + A d')/L, y = dd/ds, A = d(T y)/dd: momenta by
/// d_i', and, with m = tau w C e', what it does to the forces p_i (if any):
///   by_rate_i += N_i' T^T m + N_i A^T m,   p_i -= (N_i d(T y' + T' y)/dd + N_i' T')^T m,   T' the derivative of T
///     along d'.
template <class G, class S, int N, class C>
void add_elastic_momentum(const BeamOn<G, N, C>& beam, const BeamRates<G, S, N>& b, double elastic_inertia,
                          typename G::template Wrench<S>* by_rate, typename G::template Wrench<S>* p) {
  constexpr int r = beam_reference<N>;
  const C inverse = 1.0 / beam.length;
  if constexpr (N == 2) {
    by_rate[1] = G::add(by_rate[1], elastic_inertia * inverse, G::matrix_times(beam.stiffness, b.rate[1]));
  } else {
    const auto& rule = strain_rule<N>();
    for (int g = 0; g < N - 1; ++g) {
      const double *shape = rule.shape[g], *slope = rule.slope[g];
      const auto y = blend<G, S, N>(slope, b.d), d1 = blend<G, S, N>(shape, b.rate), y1 = blend<G, S, N>(slope, b.rate);
      const auto T = motion::eval_tangent_operator<G, S>(blend<G, S, N>(shape, b.d));
      const auto A = jacobian(T, y);
      const auto rate = G::scaled(inverse, G::add(times(T, y1), 1.0, G::times(A, d1)));
      const auto m = G::scaled(elastic_inertia * rule.weight[g], G::matrix_times(beam.stiffness, rate));
      const auto by_slope = transpose_times(T, m), by_shape = G::transpose_times(A, m);
      for (int i = 0; i < N; ++i)
        if (i != r) by_rate[i] = G::add(G::add(by_rate[i], slope[i], by_slope), shape[i], by_shape);
      if (p == nullptr) continue;
      const auto from_d = G::transpose_times(G::plus(jacobian(T, y1), second_jacobian(T, d1, y)), m),
                 from_y = G::transpose_times(slope_matrix(T, d1), m);
      for (int i = 0; i < N; ++i)
        if (i != r) p[i] = G::add(G::add(p[i], -shape[i], from_d), -slope[i], from_y);
    }
  }
}

/// With pi = w L m v at a mass point, v = v_r + T z:  by_z_i = sum N_i T^T pi,  by_r = sum pi,  dK/dd_i = sum N_i
/// (d(T z)/dd)^T pi. The weight acts on the section's own virtual motions, as in the residual.
template <class G, class S, int N, class C>
void eval_momentum(const BeamOn<G, N, C>& beam, const PortMotionOn<G, S>* ports, const SurroundingsOn<G, S>& around,
                   double elastic_inertia, S* momentum, S* force) {
  using Wrench = typename G::template Wrench<S>;
  constexpr int r = beam_reference<N>;
  BeamRates<G, S, N> b;
  eval_beam_rates<G, S, N>(ports, around, false, true, b);
  RateMomenta<G, S, N> m;
  Wrench p[N], pull[N], pulls = G::wrench(G::template Vector<S>::zero());
  for (int i = 0; i < N; ++i) p[i] = pull[i] = pulls;
  if (force != nullptr) eval_internal_forces<G, S, N, C>(beam, b, beam.has_damping, p);
  if (elastic_inertia != 0.0)
    add_elastic_momentum<G, S, N, C>(beam, b, elastic_inertia, m.by_rate, force != nullptr ? p : nullptr);
  if (beam.has_mass) {
    const auto& rule = mass_rule<N>();
    SurroundingsOn<G, S> at_rest = around;
    at_rest.has_inertia = false;
    typename G::template Motion<S> z[N], weight = eval_weighed_acceleration(ports[r], at_rest);
    for (int i = 0; i < N && force != nullptr; ++i)
      if (i != r) z[i] = times(b.inverse[i], eval_weighed_acceleration(ports[i], at_rest) - weight);
    for (int g = 0; g < N; ++g) {
      const double* shape = rule.shape[g];
      const C w = rule.weight[g] * beam.length;
      const auto T = motion::eval_tangent_operator<G, S>(blend<G, S, N>(shape, b.d));
      const auto z_g = blend<G, S, N>(shape, b.z), v = b.v + times(T, z_g);
      const Wrench pi = G::scaled(w, G::matrix_times(beam.mass, v)), by_z = transpose_times(T, pi);
      for (int i = 0; i < N; ++i)
        if (i != r) m.by_z[i] = G::add(m.by_z[i], shape[i], by_z);
      m.by_r = m.by_r + pi;
      if (force == nullptr) continue;
      const Wrench by_d = G::transpose_times(jacobian(T, z_g), pi);
      const auto fall = weight + times(T, blend<G, S, N>(shape, z));
      const Wrench f = G::scaled(w, G::matrix_times(beam.mass, fall)), q = transpose_times(T, f);
      for (int i = 0; i < N; ++i) {
        if (i == r) continue;
        p[i] = G::add(p[i], -shape[i], by_d);
        pull[i] = G::add(pull[i], shape[i], q);
      }
      pulls = pulls + f;
    }
  }
  eval_port_momenta<G, S, N>(b, m, momentum, force != nullptr ? p : nullptr);
  if (force == nullptr) return;
  const Wrench sum = pulls + sum_relative_forces<G, S, N>(b, p);
  for (int i = 0; i < N; ++i) p[i] = p[i] + pull[i];
  eval_nodal_wrenches<G, S, N>(b, p, sum, force);
}

/// The step of the midpoint rule on the group, H_{n+1} = H_n exp(D), with P and F at the pose H_n exp(D/2) and the
/// twist D/h: momenta at both ends, in the axes there, from the discrete Lagrangian L_d = h L(H_n exp(D/2), D/h):
///   p_n = -D_1 L_d = T(-D)^-T (P + (h/2) T(-D/2)^T F),   p_{n+1} = D_2 L_d = T(D)^-T (P - (h/2) T(D/2)^T F).
/// This is the latter; the former is the same backwards, at -D and -h.
template <class G, class S>
typename G::template Vector<S> eval_momentum_after(const typename G::template Vector<S>& D, double h,
                                                   const typename G::template Vector<S>& P,
                                                   const typename G::template Vector<S>& F) {
  using On = motion::VectorsOn<G>;
  using V = typename G::template Vector<S>;
  const V forces = On::template tangent_transpose_times<S>(V(0.5 * D), F);
  return On::template inverse_tangent_transpose_times<S>(D, V(P - (0.5 * h) * forces));
}

/// The members of a field that an element of a group uses.
template <class E>
using FieldFor = FieldOn<typename E::Group, double>;

/// Momentum and force of an element in the axes of its nodes, G::dof entries for each port that is not on the ground;
/// accelerations are not used.
template <class E>
void evaluate_momentum(const E& e, const FieldFor<E>& field, double turns, double elastic_inertia, double* momentum,
                       double* force);

/// matrix += factor / tau times the elastic inertia's part of dP/dv, in the unknowns of the nodes, row-major.
template <class E>
void add_elastic_mass(const E& e, const FieldFor<E>& field, double factor, double* matrix);

/// matrix += factor ad(v)^T M on the diagonal blocks of the nodes, M that of a body, or of a beam's mass shared out
/// among its nodes.
template <class E>
void add_gyroscopic(const E& e, const FieldFor<E>& field, double factor, double* matrix);

/// Values of a joint's rows, and their gradients by right increments of its nodes off the ground, row-major, num_rows
/// x dof (nodes).
template <class G>
void evaluate_rows(const JointOn<G>& joint, const FieldOn<G, double>& field, double turns, double* rows,
                   double* gradient);

}  // namespace bough::elements
