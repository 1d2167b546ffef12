#pragma once
/// Tangents of bushings and joints. Their force f on the second port is a function of the relative motion H = H_a^-1 H_b
/// and of the relative twist xi = v_b - Q v_a alone, Q = Ad(H)^-1, so it is differentiated in those and carried to the ports:
///   zeta = eta_b - Q eta_a,   dxi = dv_b - Q dv_a - ad(Q v_a) zeta,   F_a = -Q^T f,   dF_a = -Q^T (df - ^f zeta).
#include "bough/elements/body.hpp"
#include "bough/elements/joint.hpp"
#include "bough/lanes/jet.hpp"
#include "tangent_blocks.hpp"

namespace bough::elements {

/// The force on the second port and its derivatives by zeta and xi.
struct RelativeForce {
  Frame<double> H;
  Vec6<double> f = Vec6<double>::zero();
  Mat6<double> by_pose = Mat6<double>::zero(), by_twist = Mat6<double>::zero();
};

/// `matrix`: the first 12 rows of 12 columns, row-major.
inline void carry_to_ports(const RelativeForce& e, const PortMotion<double>* p, const PortSlopes* ports,
                           bool has_inertia, double* matrix) {
  const Mat6<double> Q = motion::inverse_adjoint(e.H);
  Mat6<double> first = Mat6<double>::zero(), second = Mat6<double>::zero(), hat = Mat6<double>::zero();
  const bool moves = ports[0].moves;
  if (moves) {
    hat = motion::hat6(e.f);
    second = e.by_pose;
    if (has_inertia) add_product(second, e.by_twist, motion::cross6(Q * p[0].v), -1.0);
    add_product(first, second, Q, -1.0);
  }
  if (has_inertia) {
    add_product(second, e.by_twist, ports[1].velocity);
    add_product(first, product(e.by_twist, Q), ports[0].velocity, -1.0);
  }
  put_block(first, 6, 0, 12, matrix);
  put_block(second, 6, 6, 12, matrix);
  add_product(first, hat, Q);
  put_block(-1.0 * transposed_product(Q, first), 0, 0, 12, matrix);
  put_block(-1.0 * transposed_product(Q, second - hat), 0, 6, 12, matrix);
}

/// f = U^T n,  n = K (d - d0) + D U xi,  U = T(d)^-1,  dd = U zeta.
inline void eval_tangent(const Bushing& bushing, const PortMotion<double>* p, const PortSlopes* ports,
                         const Surroundings<double>& around, double* residual, double* matrix) {
  eval_residual<double>(bushing, p, nullptr, around, residual);
  RelativeForce e;
  e.H = motion::relative(p[0].H, p[1].H);
  const Vec6<double> d = motion::log_se3(e.H);
  const auto op = motion::inverse_tangent_operator(d);
  const Mat6<double> U = op.matrix();
  Vec6<double> n = bushing.stiffness * (d - bushing.rest);
  Mat6<double> n_d = bushing.stiffness;
  if (around.has_inertia && bushing.has_damping) {
    const Vec6<double> xi = p[1].v - motion::inverse_adjoint_times(e.H, p[0].v);
    n += bushing.damping * op.times(xi);
    add_product(n_d, bushing.damping, op.derivative(xi));
    e.by_twist = transposed_product(U, product(bushing.damping, U));
  }
  e.f = op.transpose_times(n);
  Mat6<double> f_d = op.transpose_derivative(n);
  add_transposed_product(f_d, U, n_d);
  e.by_pose = product(f_d, U);
  carry_to_ports(e, p, ports, around.has_inertia, matrix);
}

/// Gradient of a row or coordinate as jets along the rotation increment; it depends on the relative rotation alone.
using RotationJet = lanes::Jet<double, 3>;
inline Frame<RotationJet> seed_rotation(const Frame<double>& H) {
  Frame<RotationJet> r = motion::cast<RotationJet>(H);
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 3; ++k) {
      const int next = (k + 1) % 3, last = (k + 2) % 3;
      r.R(i, next).d[k] = H.R(i, last);   // e_k x e_next = e_last
      r.R(i, last).d[k] = -H.R(i, next);  // e_k x e_last = -e_next
    }
  return r;
}

/// `matrix`: 12 rows of forces, then the constraint rows, 12 columns, row-major. With poses held (a consistent start) the
/// forces do not change and the rows keep their gradient.
inline void eval_tangent(const Joint& joint, const PortMotion<double>* p, const PortSlopes* ports,
                         const double* multipliers, const Surroundings<double>& around, double turns, double* residual,
                         double* matrix) {
  eval_residual<double>(joint, p, multipliers, around, residual, turns);
  RelativeForce e;
  e.H = motion::relative(p[0].H, p[1].H);
  const Frame<RotationJet> H = seed_rotation(e.H);
  Vec6<RotationJet> gradient;
  const auto add_gradient = [&](double factor) {
    for (int i = 0; i < 6; ++i) {
      e.f[i] += factor * gradient[i].a;
      for (int k = 0; k < 3; ++k) e.by_pose(i, 3 + k) += factor * gradient[i].d[k];
    }
  };
  for (int row = 0; row < joint.num_rows; ++row) {
    ConstraintRow free = joint.rows[row];
    free.law = -1;  // a law moves the row, not its gradient
    eval_row<RotationJet>(free, H, turns, nullptr, gradient);
    add_gradient(multipliers[row]);
    Vec6<double> g;
    for (int i = 0; i < 6; ++i) g[i] = gradient[i].a;
    const Vec6<double> first = motion::inverse_adjoint_transpose_times(e.H, g);
    for (int i = 0; i < 6; ++i) {
      matrix[(12 + row) * 12 + i] = -first[i];
      matrix[(12 + row) * 12 + 6 + i] = g[i];
    }
  }
  const bool damped = around.has_inertia;
  const Vec6<double> xi = damped ? p[1].v - motion::inverse_adjoint_times(e.H, p[0].v) : Vec6<double>::zero();
  for (int k = 0; k < joint.num_efforts; ++k) {
    const Effort& effort = joint.efforts[k];
    const double value = eval_coordinate<RotationJet>(effort.coordinate, H, turns, gradient).a;
    RotationJet rate(0.0);
    for (int i = 0; i < 6; ++i) rate = rate + xi[i] * gradient[i];
    add_gradient(eval_effort(effort, value, rate.a, around.laws));
    for (int i = 0; i < 6; ++i)
      for (int j = 0; j < 6; ++j) {
        const double gg = gradient[i].a * gradient[j].a;
        e.by_pose(i, j) += effort.stiffness * gg + (j < 3 ? 0.0 : effort.damping * gradient[i].a * rate.d[j % 3]);
        e.by_twist(i, j) += effort.damping * gg;
      }
  }
  carry_to_ports(e, p, ports, around.has_inertia, matrix);
}

}  // namespace bough::elements
