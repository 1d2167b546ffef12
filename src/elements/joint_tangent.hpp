#pragma once
/// Tangent of joints.
#include "bough/elements/joint.hpp"
#include "bough/elements/relative_force.hpp"

namespace bough::elements {

using motion::eval_gradient_slope;
using motion::GradientSlope;

/// Where nothing turns, the gradients of displacements are constant.
template <class G>
constexpr bool has_gradient_slope(RowKind kind) {
  return G::turns || motion::traits_of(kind).is_between_points;
}
/// g: the gradient itself.
template <class G, class S>
void add_gradient_slope(const S& factor, const GradientSlope<G, S>& r, const typename G::template Wrench<S>& g,
                        RelativeForce<G, S>& e) {
  if constexpr (G::turns) {
    if (r.has_force) G::add_force_slope(e.by_pose, factor, r.force);
    if (r.has_moment) G::add_moment_slope(e.by_pose, factor, r.moment);
  }
  if (!r.has_lateral) return;
  const auto unit = G::template Pose<S>::identity();
  G::add_rotation(e.by_pose, S(factor * r.lateral), unit, unit);
  G::add_outer(e.by_pose, G::scaled(S(-factor * r.lateral), g), g);
}

/// Of an effort along a coordinate with gradient g: stiffness k g g^T, damping c (g . xi) g, and the gradient's own
/// change.
template <class G, class S, class C>
void add_effort_slopes(const EffortOn<G, C>& effort, const typename G::template Pose<S>& H,
                       const typename G::template Motion<S>& xi, const SurroundingsOn<G, S>& around, const C& turns,
                       RelativeForce<G, S>& e) {
  typename G::template Wrench<S> g;
  const S value = eval_coordinate<G, S, C>(effort, H, turns, g);
  const bool damps = e.has_twist && is_present(effort.damping);
  S rate(0.0);
  if (damps) rate = G::real_power(g, xi);
  GradientSlope<G, S> slope;
  if (has_gradient_slope<G>(effort.coordinate)) {
    slope = eval_gradient_slope<G, S, C>(effort.coordinate, effort.direction, C(0.0), H);
    add_gradient_slope<G, S>(eval_effort<G, S, C>(effort, value, damps ? &rate : nullptr, around.laws), slope, g, e);
  }
  G::add_outer(e.by_pose, G::scaled(effort.stiffness, g), g);
  if (!damps) return;
  const auto damped = G::scaled(effort.damping, g);
  if constexpr (G::turns) {
    if (slope.has_force) G::add_outer(e.by_pose, damped, G::moment(G::force_slope_transpose_times(slope.force, xi)));
    if (slope.has_moment) G::add_outer(e.by_pose, damped, G::moment(G::moment_slope_transpose_times(slope.moment, xi)));
  }
  if (slope.has_lateral) {
    const auto across = G::add(G::force(G::linear(G::vector_of_motion(xi))), S(-rate), g);
    G::add_outer(e.by_pose, damped, G::scaled(slope.lateral, across));
  }
  G::add_outer(e.by_twist, damped, g);
}

/// Blocks as put(i, j, block), gradients of the rows as put.row(row, port, gradient). With poses held (a consistent
/// start) the forces do not change and the rows keep their gradient.
template <class G, class S, class C, class Put>
void eval_tangent(const JointOn<G, C>& joint, const PortMotionOn<G, S>* p, const PortSlopesOn<G, S>* ports,
                  const Constant<S>* multipliers, const SurroundingsOn<G, S>& around, const C& turns, S* residual,
                  S* rows, const Put& put) {
  eval_residual<G, S, C>(joint, p, multipliers, around, turns, residual, rows);
  const typename G::template Pose<S> H = G::relative(p[0].H, p[1].H);
  RelativeForce<G, S> e;
  e.Q = G::inverse_adjoint_map(H);
  e.f = wrench_at<G>(residual + G::dof);
  for (int k = 0; k < joint.num_rows; ++k) {
    const ConstraintRowOn<G, C>& row = joint.rows[k];
    typename G::template Wrench<S> gradient;
    eval_coordinate<G, S, C>(row.kind, row, row.constant, H, turns, gradient);
    put.row(k, 1, G::vector_of_wrench(gradient));
    put.row(k, 0, -G::inverse_adjoint_transpose_times(H, G::vector_of_wrench(gradient)));
    if (ports[0].moves && has_gradient_slope<G>(row.kind))
      add_gradient_slope<G, S>(multipliers[k], eval_gradient_slope<G, S, C>(row.kind, row, row.constant, H), gradient,
                               e);
  }
  e.has_twist = around.has_inertia && is_damped(joint);
  typename G::template Motion<S> xi;
  if (e.has_twist) xi = relative_twist<G, S>(H, p);
  for (int k = 0; k < joint.num_efforts; ++k) add_effort_slopes<G, S, C>(joint.efforts[k], H, xi, around, turns, e);
  carry_to_ports<G, S>(e, p, ports, put);
}

}  // namespace bough::elements
