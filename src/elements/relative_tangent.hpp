#pragma once
/// Tangents of bushings and joints. Their force f on the second port is a function of the relative motion H = H_a^-1 H_b
/// and of the relative twist xi = v_b - Q v_a alone, Q = Ad(H)^-1, so it is differentiated in those and carried to the ports:
///   zeta = eta_b - Q eta_a,   dxi = dv_b - Q dv_a - ad(Q v_a) zeta,   F_a = -Q^T f,   dF_a = -Q^T (df - ^f zeta).
#include "bough/elements/body.hpp"
#include "bough/elements/joint.hpp"
#include "bough/motion/dual_series.hpp"
#include "tangent_blocks.hpp"

namespace bough::elements {

/// The force on the second port and its derivatives by zeta and, if it `has_twist`, by xi; else `by_twist` is not looked at.
template <class S>
struct RelativeForce {
  Frame<S> H;
  DualMat<S> Q;  ///< Ad(H)^-1
  Vec6<S> f = Vec6<S>::zero();
  Mat6<S> by_pose = Mat6<S>::zero();
  Mat6<S> by_twist;
  bool has_twist = false;
};

/// Ad(H)^-1 = [R^T, R^T ~x^T; 0, R^T].
template <class S>
DualMat<S> inverse_adjoint_dual(const Frame<S>& H) {
  DualMat<S> q{lanes::transpose(H.R), {}};
  for (int i = 0; i < 3; ++i) {
    const Vec3<S> row = lanes::cross(H.x, lanes::column(H.R, i));  // row i of R^T ~x^T = (~x R)^T
    for (int j = 0; j < 3; ++j) q.b(i, j) = row[j];
  }
  return q;
}

/// `matrix`: the first 12 rows of 12 columns, row-major.
template <class S>
void carry_to_ports(const RelativeForce<S>& e, const PortMotion<S>* p, const PortSlopes<S>* ports, S* matrix) {
  Mat6<S> first = Mat6<S>::zero(), second = Mat6<S>::zero();
  const DualVec<S> f = motion::wrench_dual(e.f);
  const bool moves = ports[0].moves;
  if (moves) {
    second = e.by_pose;
    if (e.has_twist) {
      const DualVec<S> carried = times(e.Q, motion::motion_dual(p[0].v));
      add_motion_product(second, e.by_twist, motion::skew(-carried));
    }
    add_motion_product(first, second, motion::scaled(-1.0, e.Q));
  }
  if (e.has_twist) {
    add_motion_product(second, e.by_twist, ports[1].velocity);
    add_motion_product(first, e.by_twist, motion::scaled(-1.0, product(e.Q, ports[0].velocity)));
  }
  put_block(first, 6, 0, 12, matrix);
  put_block(second, 6, 6, 12, matrix);
  if (moves) {
    add_wrench(first, product(motion::skew(f), e.Q));
    add_wrench(second, motion::skew(-f));
  }
  const DualMat<S> minus = motion::scaled(-1.0, e.Q);
  put_block(transposed_product(minus, first), 0, 0, 12, matrix);
  put_block(transposed_product(minus, second), 0, 6, 12, matrix);
}

/// f = U^T n,  n = K (d - d0) + D U xi,  U = T(d)^-1,  dd = U zeta.
template <class S, class C>
void eval_tangent(const BushingOf<C>& bushing, const PortMotion<S>* p, const PortSlopes<S>* ports,
                  const Surroundings<S>& around, S* residual, S* matrix_out) {
  eval_residual<S>(bushing, p, static_cast<const S*>(nullptr), around, residual);
  RelativeForce<S> e;
  e.H = motion::relative(p[0].H, p[1].H);
  e.Q = inverse_adjoint_dual(e.H);
  const Vec3<S> psi = motion::log_so3(e.H.R);
  const S x = lanes::dot(psi, psi);
  const auto k = motion::eval_inverse_coefficients(x);
  const DualVec<S> d{psi, motion::add_cross(e.H.x, psi, Vec3<S>(k.k * lanes::cross(psi, e.H.x) - 0.5 * e.H.x))};
  const auto inverse = motion::dual_inverse_tangent(d, x, k);
  const DualMat<S> U = motion::matrix(inverse);
  Vec6<S> stretch = motion::motion_vector(d);
  for (int i = 0; i < 6; ++i) stretch[i] = stretch[i] - bushing.rest[i];
  Vec6<S> n = bushing.stiffness * stretch;
  Mat6<S> n_d = lanes::cast<S>(bushing.stiffness);
  if (around.has_inertia && bushing.has_damping) {
    e.has_twist = true;
    const DualVec<S> xi = motion::motion_dual(p[1].v) - times(e.Q, motion::motion_dual(p[0].v));
    n += bushing.damping * motion::motion_vector(times(inverse, xi));
    add_motion_product(n_d, bushing.damping, jacobian(inverse, xi));
    e.by_twist = transposed_product(U, motion_product(bushing.damping, U));
  }
  const DualVec<S> force = motion::wrench_dual(n);
  e.f = motion::wrench_vector(transpose_times(inverse, force));
  Mat6<S> f_d = transposed_product(U, n_d);
  add_wrench(f_d, transpose_jacobian(inverse, force));
  e.by_pose = motion_product(f_d, U);
  carry_to_ports(e, p, ports, matrix_out);
}

/// Gradient of a row or coordinate, linear and angular, and its derivatives by the rotation increment.
template <class S>
struct RowSlopes {
  Vec6<S> gradient;
  Mat3<S> linear, angular;
};

/// With rows rho_i = R^T e_i of the relative rotation: d rho_i = ~rho_i theta, d(e_j x rho_i) = ~e_j ~rho_i theta; of the angle, with
/// s = R_21 - R_12 and c = R_11 + R_22,   g = (c ds - s dc)/(s^2 + c^2),   dg = (c dds - s ddc + ds dc^T - dc ds^T - g (2 s ds + 2 c dc)^T)/(s^2 + c^2).
template <class S>
Mat3<S> across_slope(const Mat3<S>& R, int i, int j) {
  const Vec3<S> row{{R(i, 0), R(i, 1), R(i, 2)}};  // ~e_j ~rho = rho e_j^T - (e_j . rho) I
  Mat3<S> m = lanes::outer(row, Vec3<S>::unit(j));
  for (int k = 0; k < 3; ++k) m(k, k) = m(k, k) - row[j];
  return m;
}
template <class S>
Mat3<S> angle_slope(const Mat3<S>& R, const Vec3<S>& g) {
  const S s = R(1, 0) - R(0, 1), c = R(0, 0) + R(1, 1), inverse = S(1.0) / (s * s + c * c);
  const Vec3<S> ds = across_gradient(R, 1, 0) - across_gradient(R, 0, 1);
  const Vec3<S> dc = across_gradient(R, 0, 0) + across_gradient(R, 1, 1);
  const Mat3<S> dds = across_slope(R, 1, 0) - across_slope(R, 0, 1);
  const Mat3<S> ddc = across_slope(R, 0, 0) + across_slope(R, 1, 1);
  const Vec3<S> half = s * ds + c * dc;
  const Mat3<S> turned = c * dds - s * ddc + lanes::outer(ds, dc) - lanes::outer(dc, ds);
  return inverse * (turned - lanes::outer(Vec3<S>(2.0 * g), half));
}
template <class S, class C>
void eval_row_slopes(const ConstraintRowOf<C>& row, const Frame<S>& H, RowSlopes<S>& r) {
  const auto along = [&](int i) { return Vec3<S>{{H.R(i, 0), H.R(i, 1), H.R(i, 2)}}; };
  const Vec3<S> none = Vec3<S>::zero();
  r.linear = r.angular = Mat3<S>::zero();
  switch (row.kind) {
    case RowKind::along:
      r.gradient = lanes::join(along(row.i), none);
      r.linear = lanes::skew(along(row.i));
      break;
    case RowKind::across:
      r.gradient = lanes::join(none, across_gradient(H.R, row.i, row.j));
      r.angular = across_slope(H.R, row.i, row.j);
      break;
    case RowKind::angle: {
      const Vec3<S> g = angle_gradient(H.R);
      r.gradient = lanes::join(none, g);
      r.angular = angle_slope(H.R, g);
      break;
    }
    case RowKind::screw: {
      const Vec3<S> g = angle_gradient(H.R);
      r.gradient = lanes::join(along(2), Vec3<S>(-row.pitch * g));
      r.linear = lanes::skew(along(2));
      r.angular = -row.pitch * angle_slope(H.R, g);
      break;
    }
  }
}

/// Of the force c (g . xi) g, damped = c g, by the rate's own changes.
template <class S>
void add_damping_slopes(const Vec6<S>& damped, const RowSlopes<S>& r, const Vec6<S>& xi, RelativeForce<S>& e) {
  using lanes::multiply_add;
  const Vec3<S> turned = lanes::transpose_times(r.linear, lanes::linear_part(xi)) +
                         lanes::transpose_times(r.angular, lanes::angular_part(xi));
  for (int i = 0; i < 6; ++i) {
    for (int j = 0; j < 3; ++j) e.by_pose(i, 3 + j) = multiply_add(damped[i], turned[j], e.by_pose(i, 3 + j));
    for (int j = 0; j < 6; ++j) e.by_twist(i, j) = multiply_add(damped[i], r.gradient[j], e.by_twist(i, j));
  }
}

/// `matrix`: 12 rows of forces, then the constraint rows, 12 columns, row-major. With poses held (a consistent start) the
/// forces do not change and the rows keep their gradient.
template <class S, class C>
void eval_tangent(const JointOf<C>& joint, const PortMotion<S>* p, const PortSlopes<S>* ports, const S* multipliers,
                  const Surroundings<S>& around, const C& turns, S* residual, S* matrix_out) {
  using lanes::multiply_add;
  eval_residual<S>(joint, p, multipliers, around, residual, turns);
  RelativeForce<S> e;
  e.H = motion::relative(p[0].H, p[1].H);
  e.Q = inverse_adjoint_dual(e.H);
  for (int k = 0; k < 6; ++k) e.f[k] = residual[6 + k];
  RowSlopes<S> r;
  const auto add_slopes = [&](const S& factor) {
    for (int i = 0; i < 3; ++i)
      for (int k = 0; k < 3; ++k) {
        e.by_pose(i, 3 + k) = multiply_add(factor, r.linear(i, k), e.by_pose(i, 3 + k));
        e.by_pose(3 + i, 3 + k) = multiply_add(factor, r.angular(i, k), e.by_pose(3 + i, 3 + k));
      }
  };
  for (int row = 0; row < joint.num_rows; ++row) {
    eval_row_slopes(joint.rows[row], e.H, r);
    add_slopes(multipliers[row]);
    const Vec6<S> first = motion::inverse_adjoint_transpose_times(e.H, r.gradient);
    for (int i = 0; i < 6; ++i) {
      matrix_out[(12 + row) * 12 + i] = -first[i];
      matrix_out[(12 + row) * 12 + 6 + i] = r.gradient[i];
    }
  }
  Vec6<S> xi;
  e.has_twist = around.has_inertia && is_damped(joint);
  if (e.has_twist) {
    xi = p[1].v - motion::inverse_adjoint_times(e.H, p[0].v);
    e.by_twist = Mat6<S>::zero();
  }
  for (int k = 0; k < joint.num_efforts; ++k) {
    const EffortOf<C>& effort = joint.efforts[k];
    ConstraintRowOf<C> coordinate;
    coordinate.kind = effort.coordinate == Coordinate::angle ? RowKind::angle : RowKind::along;
    coordinate.i = 2;
    eval_row_slopes(coordinate, e.H, r);
    Vec6<S> unused;
    const S value = eval_row<S, C>(coordinate, e.H, turns, nullptr, unused);
    const bool damps = e.has_twist && is_present(effort.damping);
    S rate(0.0);
    if (damps) rate = lanes::dot(r.gradient, xi);
    add_slopes(eval_effort(effort, value, damps ? &rate : nullptr, around.laws));
    const Vec6<S> stiff = effort.stiffness * r.gradient;
    for (int i = 0; i < 6; ++i)
      for (int j = 0; j < 6; ++j) e.by_pose(i, j) = multiply_add(stiff[i], r.gradient[j], e.by_pose(i, j));
    if (damps) add_damping_slopes<S>(effort.damping * r.gradient, r, xi, e);
  }
  carry_to_ports(e, p, ports, matrix_out);
}

}  // namespace bough::elements
