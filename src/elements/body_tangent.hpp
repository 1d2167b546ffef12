#pragma once
/// Tangents of rigid bodies, point loads, springs and bushings, as put(i, j, block) of the ports' increments.
#include "bough/elements/body.hpp"
#include "relative_force.hpp"

namespace bough::elements {

/// dF = M (da - d(R^T g)) - (ad(v)^T M + hat(M v)) dv; of a point df = m (du' - d(R^T g)) + m (w x du + dw x u)
/// without moments.
template <class G, class S, class C, class Put>
BOUGH_INLINE void eval_tangent(const RigidBodyOn<G, C>& body, const PortMotionOn<G, S>* p,
                               const PortSlopesOn<G, S>* ports, const SurroundingsOn<G, S>& around, S* residual,
                               const Put& put) {
  using Block = typename G::template Matrix<S>;
  eval_residual(body, p, around, residual);
  const auto a = weighed_slope(p[0], ports[0], around);
  const bool rates = around.has_inertia && ports[0].moves;
  if (is_seen_as_point(body)) {
    auto rows = G::linear_rows(a);
    if (rates && G::turns) G::add_spin_rows(rows, p[0].v, ports[0].velocity);
    Block block = Block::zero();
    for (int i = 0; i < G::translations; ++i)
      for (int j = 0; j < G::dof; ++j) block(i, j) = body.mass(0, 0) * rows(i, j);
    return put(0, 0, block);
  }
  Block block = G::block_product(body.mass, a);
  if (rates) G::add_block_product(block, G::gyroscopic(body.mass, G::motion(p[0].v)), ports[0].velocity);
  put(0, 0, block);
}

/// The components of a dead load in the axes of the port turn against the port's rotation.
template <class G, class S, class C, class Put>
BOUGH_INLINE void eval_tangent(const PointLoadOn<G, C>& load, const PortMotionOn<G, S>* p,
                               const PortSlopesOn<G, S>* ports, const SurroundingsOn<G, S>& around, S* residual,
                               const Put& put) {
  eval_residual(load, p, around, residual);
  auto block = G::template Matrix<S>::zero();
  if (!load.follows && ports[0].moves) G::add_turning(block, wrench_at<G>(residual));
  put(0, 0, block);
}

/// Force t n on the second port in inertial axes, t = k (l - l0) + c n . w:
///   d(t n) = (t/l) (1 - n n^T) dr + n dt,   dt = (k n + (c/l) (w - n n . w)) . dr + c n . dw,
///   dr = R_b eta_b - R_a eta_a (linear parts),   dw = R_b (dv_b + theta_b x v_b) - R_a (dv_a + theta_a x v_a).
/// So the block of ports k and q is, but for the sign, (t/l) R_k^T R_q + (R_k^T n) (what R_q^T (gradient - (t/l) n)
/// and the damping do)^T.
template <class G, class S, class C, class Put>
BOUGH_INLINE void eval_tangent(const SpringOn<G, C>& spring, const PortMotionOn<G, S>* p,
                               const PortSlopesOn<G, S>* ports, const SurroundingsOn<G, S>& around, S* residual,
                               const Put& put) {
  using Vector = typename G::template Translation<S>;
  using Wrench = typename G::template Wrench<S>;
  const bool damps = around.has_inertia && is_present(spring.damping), moves = ports[0].moves;
  const auto line = eval_spring_line<G, S, C>(spring, p, damps);
  const Vector f = line.tension * line.n;
  const Vector force[2] = {G::turned_back(p[0].H, -f), G::turned_back(p[1].H, f)};
  const S lateral = line.tension * line.inverse;
  Vector gradient = spring.stiffness * line.n - lateral * line.n;
  if (damps) gradient += (spring.damping * line.inverse) * (line.w - line.along * line.n);
  Vector along[2];  // n in the axes of either port
  Wrench by[2];     // dt and the lateral part, by the increment of either port
  for (int q = 0; q < 2; ++q) {
    along[q] = G::turned_back(p[q].H, line.n);
    by[q] = G::force(Vector::zero());
    if (moves) by[q] = G::force(G::turned_back(p[q].H, gradient));
    if (damps) {
      const Wrench pull = G::force(spring.damping * along[q]);
      by[q] = by[q] + G::transpose_times(ports[q].velocity, pull);
      if (moves) by[q] = G::subtract_dual_bracket(by[q], G::translation(G::linear(p[q].v)), pull);
    }
  }
  for (int k = 0; k < 2; ++k) {
    G::put_force(force[k], residual + G::dof * k);
    for (int q = 0; q < 2; ++q) {
      const double sign = k == q ? 1.0 : -1.0;
      auto block = G::template Matrix<S>::zero();
      G::add_force_outer(block, Vector(sign * along[k]), by[q]);
      if (moves) G::add_rotation(block, S(sign * lateral), p[k].H, p[q].H);
      if (moves && k == q) G::add_turning(block, G::force(force[k]));
      put(k, q, block);
    }
  }
}

/// f = U^T n,  n = k K (d - d0) + D U xi,  U = T(d)^-1,  dd = U zeta (see relative_force.hpp).
template <class G, class S, class C, class Put>
BOUGH_INLINE void eval_tangent(const BushingOn<G, C>& bushing, const PortMotionOn<G, S>* p,
                               const PortSlopesOn<G, S>* ports, const SurroundingsOn<G, S>& around, S* residual,
                               const Put& put) {
  const bool viscous = around.has_inertia && bushing.has_damping;
  ScrewRates<G, S> r;
  eval_screw_rates<G, S>(p, around, false, viscous, r);
  const auto n = eval_resultant<G, S>(bushing, r, around, viscous);
  RelativeForce<G, S> e;
  e.Q = G::inverse_adjoint_map(G::relative(p[0].H, p[1].H));
  e.f = put_screw_wrenches<G, S>(r, n, residual);
  const auto U = matrix(r.inverse);
  auto n_d = lanes::cast<S>(bushing.stiffness);
  if (bushing.factor >= 0) n_d = around.laws[bushing.factor] * n_d;
  if (viscous) {
    e.has_twist = true;
    const auto xi = G::motion(p[1].v) - G::times(e.Q, G::motion(p[0].v));
    G::add_block_product(n_d, bushing.damping, jacobian(r.inverse, xi));
    e.by_twist = G::transposed_product(U, G::block_product(bushing.damping, U));
  }
  auto f_d = G::transposed_product(U, n_d);
  G::add_wrench_map(f_d, transpose_jacobian(r.inverse, n));
  e.by_pose = G::block_product(f_d, U);
  carry_to_ports<G, S>(e, p, ports, put);
}

}  // namespace bough::elements
