#pragma once
/// Tangents of rigid bodies, point loads and springs.
#include "bough/elements/body.hpp"
#include "tangent_blocks.hpp"

namespace bough::elements {

/// Of a point of mass m:  df = m (du' - d(R^T g)) - m (du x w + u x dw); no moments.
template <class S, class C>
void eval_point_tangent(const C& mass, const PortMotion<S>* p, const PortSlopes<S>* ports, const DualMat<S>& a,
                        bool turns, S* matrix) {
  Mat3<S> linear = a.a, angular = a.b;
  if (turns) {
    const Mat3<S> w = lanes::skew(lanes::angular_part(p[0].v)), u = lanes::skew(lanes::linear_part(p[0].v));
    linear += w * ports[0].velocity.a;
    angular += w * ports[0].velocity.b;
    angular = angular - u * ports[0].velocity.a;
  }
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 3; ++j) {
      matrix[6 * i + j] = i < 3 ? S(mass * linear(i, j)) : S(0.0);
      matrix[6 * i + 3 + j] = i < 3 ? S(mass * angular(i, j)) : S(0.0);
    }
}

/// dF = M (da - d(R^T g)) - (ad(v)^T M + ^(M v)) dv,  d(R^T g) = ~(R^T g) theta.
template <class S, class C>
void eval_tangent(const RigidBodyOf<C>& body, const PortMotion<S>* p, const PortSlopes<S>* ports,
                  const Surroundings<S>& around, S* residual, S* matrix) {
  eval_residual<S>(body, p, static_cast<const S*>(nullptr), around, residual);
  DualMat<S> a = DualMat<S>::zero();
  if (around.has_inertia) a = ports[0].acceleration;
  if (ports[0].moves) a.b = a.b - lanes::skew(lanes::transpose_times(p[0].H.R, around.gravity));
  if (is_seen_as_point(body, around)) {
    const bool turns = around.has_inertia && around.nodes_turn && ports[0].moves;
    return eval_point_tangent<S, C>(body.mass(0, 0), p, ports, a, turns, matrix);
  }
  Mat6<S> x = motion_product(body.mass, a);
  if (around.has_inertia && ports[0].moves) {
    const DualVec<S> v = motion::motion_dual(p[0].v), momentum = motion::wrench_dual(Vec6<S>(body.mass * p[0].v));
    add_motion_product(x, gyroscopic_matrix(body.mass, v, momentum), ports[0].velocity);
  }
  put_block(x, 0, 0, 6, matrix);
}

/// A dead load turns against the port: d(R^T f) = ~(R^T f) theta.
template <class S, class C>
void eval_tangent(const PointLoadOf<C>& load, const PortMotion<S>* p, const PortSlopes<S>* ports,
                  const Surroundings<S>& around, S* residual, S* matrix) {
  eval_residual<S>(load, p, static_cast<const S*>(nullptr), around, residual);
  Mat6<S> x = Mat6<S>::zero();
  if (!load.follows && ports[0].moves) {
    const Mat3<S> force = lanes::skew(Vec3<S>{{residual[0], residual[1], residual[2]}}),
                  moment = lanes::skew(Vec3<S>{{residual[3], residual[4], residual[5]}});
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        x(i, 3 + j) = force(i, j);
        x(3 + i, 3 + j) = moment(i, j);
      }
  }
  put_block(x, 0, 0, 6, matrix);
}

/// Force t n on the second port in inertial axes, n = r/l, t = k (l - l0) + c n.w, w the relative velocity:
///   d(t n) = (t/l) (I - n n^T) dr + n dt,   dt = (k n + (c/l) (w - n n.w)).dr + c n.dw,
///   dr = R_b eta_b - R_a eta_a (linear parts),   dw = R_b (dv_b + theta_b x v_b) - R_a (dv_a + theta_a x v_a).
template <class S, class C>
void eval_tangent(const SpringOf<C>& spring, const PortMotion<S>* p, const PortSlopes<S>* ports,
                  const Surroundings<S>& around, S* residual, S* matrix) {
  eval_residual<S>(spring, p, static_cast<const S*>(nullptr), around, residual);
  const Vec3<S> r = p[1].H.x - p[0].H.x;
  const S length = eval_length(p), inverse = S(1.0) / length;
  const Vec3<S> n = inverse * r;
  const bool damped = around.has_inertia && is_present(spring.damping);
  S tension = spring.stiffness * (length - spring.rest_length);
  Vec3<S> gradient = spring.stiffness * n;
  if (damped) {
    const Vec3<S> w = p[1].H.R * lanes::linear_part(p[1].v) - p[0].H.R * lanes::linear_part(p[0].v);
    const S along = lanes::dot(n, w);
    tension = tension + spring.damping * along;
    gradient += (spring.damping * inverse) * (w - along * n);
  }
  const S lateral = tension * inverse;
  Mat3<S> by_r = lanes::outer(n, Vec3<S>(gradient - lateral * n));
  for (int i = 0; i < 3; ++i) by_r(i, i) = by_r(i, i) + lateral;
  for (int q = 0; q < 2; ++q) {
    const double sign = q == 0 ? -1.0 : 1.0;
    Mat3<S> by[2] = {Mat3<S>::zero(), Mat3<S>::zero()};  // of t n, by the linear and angular parts of eta_q
    if (ports[q].moves) by[0] = sign * (by_r * p[q].H.R);
    if (damped) {
      const Vec3<S> damping = sign * (spring.damping * n), in_port = lanes::transpose_times(p[q].H.R, damping);
      Vec3<S> linear = lanes::transpose_times(ports[q].velocity.a, in_port);
      Vec3<S> angular = lanes::transpose_times(ports[q].velocity.b, in_port);
      if (ports[q].moves) angular += lanes::cross(lanes::linear_part(p[q].v), in_port);
      by[0] += lanes::outer(n, linear);
      by[1] += lanes::outer(n, angular);
    }
    for (int k = 0; k < 2; ++k) {
      Mat6<S> x = Mat6<S>::zero();
      for (int part = 0; part < 2; ++part) {
        const Mat3<S> turned = lanes::transpose_times(p[k].H.R, by[part]);
        for (int i = 0; i < 3; ++i)
          for (int j = 0; j < 3; ++j) x(i, 3 * part + j) = k == 0 ? S(-turned(i, j)) : turned(i, j);
      }
      if (k == q && ports[q].moves) {
        const Mat3<S> force = lanes::skew(Vec3<S>{{residual[6 * k], residual[6 * k + 1], residual[6 * k + 2]}});
        for (int i = 0; i < 3; ++i)
          for (int j = 0; j < 3; ++j) x(i, 3 + j) = x(i, 3 + j) + force(i, j);
      }
      put_block(x, 6 * k, 6 * q, 12, matrix);
    }
  }
}

}  // namespace bough::elements
