#pragma once
/// Tangents of beams and line loads in closed form. Forces are differentiated in the coordinates in which they are
/// written, the relative motions d_i with their rates and the motion of the reference node, and then carried to the
/// nodes; a common rigid motion changes no d_i, so nothing is spent on it. Derivation: README.md, "Tangents of beams".
#include "bough/elements/beam.hpp"
#include "bough/motion/second_slopes.hpp"
#include "tangent_blocks.hpp"

namespace bough::elements {

/// Forces p_i (row i != r) and wrench on the reference node (row r), with their derivatives.
template <int N>
struct ShapeBlocks {
  Vec6<double> force[N] = {};
  Mat6<double> d[N][N] = {}, rate[N][N] = {}, rate2[N][N] = {};  ///< by d_j, d_j', d_j''
  Mat6<double> pose[N] = {}, v[N] = {}, a[N] = {};               ///< by increment, twist, acceleration of the reference
};

/// A section of the beam: d and its rates, operators, and how its motion carries that of the reference node.
struct SectionSlopes {
  motion::TangentSlopes<double> slopes;
  Mat6<double> T, E;  ///< T(d), Ad(exp d)^-1
  explicit SectionSlopes(const Vec6<double>& d)
      : slopes(d), T(slopes.T().matrix()), E(motion::inverse_adjoint(motion::exp_se3(slopes.T()))) {}
};

/// Adds a derivative `by` of a section's wrench f, as T^T by to the forces and E^T by to the reference, to the blocks that
/// `block(row)` names with weight(row).
template <int N, class Block>
void spread_rows(const double* shape, const Mat6<double>& q, const Mat6<double>& h, double w, const Block& block) {
  for (int i = 0; i < N; ++i)
    add_scaled(block(i), i == Beam<N>::reference ? w : w * shape[i], i == Beam<N>::reference ? h : q);
}
template <int N>
void spread_columns(const double* shape, const Mat6<double>& q, const Mat6<double>& h, Mat6<double> (&blocks)[N][N]) {
  for (int j = 0; j < N; ++j)
    if (j != Beam<N>::reference)
      spread_rows<N>(shape, q, h, shape[j], [&](int i) -> Mat6<double>& { return blocks[i][j]; });
}
template <int N>
void spread_column(const double* shape, const Mat6<double>& q, const Mat6<double>& h, Mat6<double> (&blocks)[N]) {
  spread_rows<N>(shape, q, h, 1.0, [&](int i) -> Mat6<double>& { return blocks[i]; });
}

/// The wrench f of a section, its derivative by d (section axes) and those of T^T f and Ad(exp d)^-T f themselves.
template <int N>
void spread_force(const double* shape, const SectionSlopes& s, const Vec6<double>& f, const Mat6<double>& f_by_d,
                  ShapeBlocks<N>& b) {
  const Vec6<double> q = s.slopes.T().transpose_times(f), h = lanes::transpose_times(s.E, f);
  for (int i = 0; i < N; ++i) b.force[i] += i == Beam<N>::reference ? h : shape[i] * q;
  Mat6<double> carried = f_by_d, by_shape = s.slopes.T().transpose_derivative(f);
  add_product(carried, motion::hat6(f), s.T, -1.0);
  add_transposed_product(by_shape, s.T, f_by_d);
  spread_columns<N>(shape, by_shape, transposed_product(s.E, carried), b.d);
}

/// Elasticity and damping: n = C (e - e0) + D e',  p_i += w (N_i' T^T n + N_i A^T n).
template <int N>
void add_internal_slopes(const Beam<N>& beam, const BeamShape<double, N>& b, const Vec6<double>* rate,
                         ShapeBlocks<N>& out) {
  const bool viscous = rate != nullptr && beam.has_damping;
  const double inverse = 1.0 / beam.length;
  if constexpr (N == 2) {
    Vec6<double> p[2] = {};
    add_internal_forces<double, N>(beam, b, rate, p);
    out.force[1] += p[1];
    add_scaled(out.d[1][1], inverse, beam.stiffness);
    if (viscous) add_scaled(out.rate[1][1], inverse, beam.damping);
  } else {
    const auto& rule = strain_rule<N>();
    for (int g = 0; g < Beam<N>::num_strain_points; ++g) {
      const double *shape = rule.shape[g], *slope = rule.slope[g], w = rule.weight[g];
      const Vec6<double> y = blend<double, N>(slope, b.d);
      const motion::TangentSlopes<double> slopes(blend<double, N>(shape, b.d));
      const auto& op = slopes.T();
      const Mat6<double> T = op.matrix(), A = op.derivative(y);
      Vec6<double> n = beam.stiffness * (inverse * op.times(y) - beam.reference_strain[g]);
      const Mat6<double> C = inverse * beam.stiffness, D = inverse * beam.damping;
      Mat6<double> n_d = product(C, A), n_y = product(C, T), n_d1 = {}, n_y1 = {};
      if (viscous) {
        const Vec6<double> d1 = blend<double, N>(shape, rate), y1 = blend<double, N>(slope, rate);
        n += D * (op.times(y1) + A * d1);
        add_product(n_d, D, op.derivative(y1) + slopes.second(d1, y));
        add_product(n_y, D, op.derivative(d1) - cross6_product(op.times(d1), T));
        n_d1 = product(D, A);
        n_y1 = product(D, T);
      }
      const Vec6<double> by_slope = op.transpose_times(n), by_shape = lanes::transpose_times(A, n);
      const Mat6<double> G = op.transpose_derivative(n);
      Mat6<double> slope_d = G, shape_d = slopes.hessian(n, y), shape_y = lanes::transpose(G);
      add_transposed_product(slope_d, T, n_d);
      add_transposed_product(shape_d, A, n_d);
      add_transposed_product(shape_y, A, n_y);
      const Mat6<double> slope_y = transposed_product(T, n_y);
      const auto spread = [&](Mat6<double>(&blocks)[N][N], const Mat6<double>& sd, const Mat6<double>& sy,
                              const Mat6<double>& hd, const Mat6<double>& hy) {
        for (int i = 0; i < N; ++i)
          for (int j = 0; j < N; ++j) {
            if (i == Beam<N>::reference || j == Beam<N>::reference) continue;
            const double ss = w * slope[i] * shape[j], sl = w * slope[i] * slope[j], hs = w * shape[i] * shape[j],
                         hl = w * shape[i] * slope[j];
            for (int k = 0; k < 36; ++k) blocks[i][j].m[k] += ss * sd.m[k] + sl * sy.m[k] + hs * hd.m[k] + hl * hy.m[k];
          }
      };
      for (int i = 0; i < N; ++i)
        if (i != Beam<N>::reference) out.force[i] += (w * slope[i]) * by_slope + (w * shape[i]) * by_shape;
      spread(out.d, slope_d, slope_y, shape_d, shape_y);
      if (viscous)
        spread(out.rate, transposed_product(T, n_d1), transposed_product(T, n_y1), transposed_product(A, n_d1),
               transposed_product(A, n_y1));
    }
  }
}

/// Inertia and gravity at the mass points: f = w L (m a - ad(v)^T m v). With E = Ad(exp d)^-1, c = E v_r, o = T d',
///   v = c + o,   a = E a_r - ad(o) c + T d'' + A(d') d',   dE = -ad(T dd) E,   D T[d'] = A(d') - ad(o) T.
template <int N>
void add_inertia_slopes(const Beam<N>& beam, const BeamShape<double, N>& b, const Vec6<double>* rate,
                        const Vec6<double>* rate2, const PortMotion<double>& r, bool moves, ShapeBlocks<N>& out) {
  const auto& rule = mass_rule<N>();
  for (int g = 0; g < N; ++g) {
    const double* shape = rule.shape[g];
    const SectionSlopes s(blend<double, N>(shape, b.d));
    const Mat6<double> m = (rule.weight[g] * beam.length) * beam.mass;
    const Mat6<double> by_a = product(m, s.E);
    const auto spread = [&](const Mat6<double>& by, Mat6<double>(&blocks)[N][N]) {
      spread_columns<N>(shape, transposed_product(s.T, by), transposed_product(s.E, by), blocks);
    };
    const auto spread_one = [&](const Mat6<double>& by, Mat6<double>(&blocks)[N]) {
      spread_column<N>(shape, transposed_product(s.T, by), transposed_product(s.E, by), blocks);
    };
    const Vec6<double> carried = s.E * r.a;
    Mat6<double> a_d = cross6_product(carried, s.T);
    if (!moves) {
      spread_force<N>(shape, s, m * carried, product(m, a_d), out);
      spread_one(by_a, out.a);
      continue;
    }
    const auto& op = s.slopes.T();
    const Vec6<double> d1 = blend<double, N>(shape, rate), d2 = blend<double, N>(shape, rate2);
    const Vec6<double> c = s.E * r.v, own = s.T * d1, v = c + own;
    const Mat6<double> A = op.derivative(d1), cT = cross6_product(c, s.T), oT = cross6_product(own, s.T);
    const Vec6<double> mv = m * v;
    const Vec6<double> f =
        m * (carried - motion::cross6_times(own, c) + s.T * d2 + A * d1) - motion::cross6_transpose_times(v, mv);
    Mat6<double> f_v = -1.0 * motion::hat6(mv);
    add_transposed_product(f_v, motion::cross6(v), m, -1.0);
    a_d = a_d + cross6_product(c, A) - cross6_product(own, cT) + op.derivative(d2) + s.slopes.second(d1, d1);
    const Mat6<double> a_1 = cT + 2.0 * A - oT;
    Mat6<double> by_d = product(m, a_d), by_1 = product(m, a_1);
    add_product(by_d, f_v, cT + A);
    add_product(by_1, f_v, s.T);
    Mat6<double> by_v = product(f_v, s.E);
    add_product(by_v, m, cross6_product(own, s.E), -1.0);
    spread_force<N>(shape, s, f, by_d, out);
    spread(by_1, out.rate);
    spread(product(m, s.T), out.rate2);
    spread_one(by_v, out.v);
    spread_one(by_a, out.a);
  }
}

/// Derivatives of d_i, d_i', d_i'' by one node's increment.
struct RateSlopes {
  Mat6<double> d, rate, rate2;
};

/// Node i against the reference: d_i' = U o, o = v_i - c, c = Q v_r, U = T(d_i)^-1, Q = Ad(H_ri)^-1, and
///   d_i'' = U (a_i - Q a_r + ad(o) c - A(d') d').   zeta = eta_i - Q eta_r moves H_ri; dQ = -ad(zeta) Q.
template <int N>
void eval_rate_slopes(const BeamShape<double, N>& b, int i, const PortMotion<double>* p, const PortSlopes* ports,
                      const Vec6<double>* rate, const Vec6<double>* rate2, const Mat6<double>& U, const Mat6<double>& Q,
                      RateSlopes& by_node, RateSlopes& by_reference) {
  constexpr int r = Beam<N>::reference;
  const Mat6<double> zero = Mat6<double>::zero(), UQ = motion_product(U, Q);
  const bool moves = ports[i].moves;
  by_node.d = moves ? U : zero;
  by_reference.d = moves ? -1.0 * UQ : zero;
  if (rate == nullptr) return;
  by_node.rate = motion_product(U, ports[i].velocity);
  by_node.rate2 = motion_product(U, ports[i].acceleration);
  by_reference.rate = zero;
  add_motion_product(by_reference.rate, UQ, ports[r].velocity, -1.0);
  by_reference.rate2 = zero;
  add_motion_product(by_reference.rate2, UQ, ports[r].acceleration, -1.0);
  if (!moves) return;
  const motion::TangentSlopes<double> slopes(b.d[i]);
  const auto& op = slopes.T();
  const Vec6<double> c = Q * p[r].v, own = p[i].v - c;
  const Mat6<double> A = op.derivative(rate[i]), ad_c = motion::cross6(c);
  const Mat6<double> W = 2.0 * A - cross6_product(own, op.matrix());  // of A(d') d' by d'
  Mat6<double> inner = ad_c;
  add_motion_product(inner, A, U);
  Mat6<double> rate_zeta = zero;  // by zeta, velocities held
  add_motion_product(rate_zeta, U, inner, -1.0);
  Mat6<double> y = cross6_product(p[i].v, ad_c) - motion::cross6(Q * p[r].a);
  add_motion_product(y, op.derivative(rate2[i]) + slopes.second(rate[i], rate[i]), U, -1.0);
  by_node.rate = by_node.rate + rate_zeta;
  add_motion_product(by_reference.rate, rate_zeta, Q, -1.0);
  Mat6<double> y_node = y, y_reference = zero;
  add_motion_product(y_node, ad_c, ports[i].velocity, -1.0);
  add_motion_product(y_node, W, by_node.rate, -1.0);
  add_motion_product(y_reference, y, Q, -1.0);
  add_motion_product(y_reference, cross6_product(p[i].v, Q), ports[r].velocity);
  add_motion_product(y_reference, W, by_reference.rate, -1.0);
  add_motion_product(by_node.rate2, U, y_node);
  add_motion_product(by_reference.rate2, U, y_reference);
}

/// From shape coordinates to the nodes:  F_i = U_i^T p_i,  F_r = f_r - sum_i Q_i^T F_i,  d(Q^T F) = Q^T (dF - ^F zeta).
/// `matrix`: 6N x 6N, row-major.
template <int N>
void carry_to_nodes(const BeamShape<double, N>& b, const ShapeBlocks<N>& s, const PortMotion<double>* p,
                    const PortSlopes* ports, const Vec6<double>* rate, const Vec6<double>* rate2, double* matrix) {
  constexpr int r = Beam<N>::reference;
  Mat6<double> K[N][N] = {}, U[N], Q[N];
  for (int j = 0; j < N; ++j) {
    if (j == r) continue;
    U[j] = b.inverse[j].matrix();
    Q[j] = motion::inverse_adjoint(b.relative[j]);
    RateSlopes node, reference;
    eval_rate_slopes<N>(b, j, p, ports, rate, rate2, U[j], Q[j], node, reference);
    for (int i = 0; i < N; ++i) {
      if (ports[j].moves) {
        add_product(K[i][j], s.d[i][j], node.d);
        add_product(K[i][r], s.d[i][j], reference.d);
      }
      if (rate == nullptr) continue;
      add_product(K[i][j], s.rate[i][j], node.rate);
      add_product(K[i][j], s.rate2[i][j], node.rate2);
      add_product(K[i][r], s.rate[i][j], reference.rate);
      add_product(K[i][r], s.rate2[i][j], reference.rate2);
    }
  }
  for (int i = 0; i < N; ++i) {
    if (ports[r].moves) K[i][r] += s.pose[i];
    if (rate == nullptr) continue;
    add_product(K[i][r], s.v[i], ports[r].velocity);
    add_product(K[i][r], s.a[i], ports[r].acceleration);
  }
  for (int i = 0; i < N; ++i) {
    if (i == r) continue;
    const Mat6<double> hat = motion::hat6(b.inverse[i].transpose_times(s.force[i]));
    for (int j = 0; j < N; ++j) K[i][j] = transposed_product(U[i], K[i][j]);
    if (ports[i].moves) {
      const Mat6<double> G = product(b.inverse[i].transpose_derivative(s.force[i]), U[i]);
      K[i][i] += G;
      add_product(K[i][r], G, Q[i], -1.0);
    }
    for (int j = 0; j < N; ++j) {
      Mat6<double> carried = K[i][j];
      if (ports[i].moves && j == i) add_scaled(carried, -1.0, hat);
      if (ports[i].moves && j == r) add_product(carried, hat, Q[i]);
      add_transposed_product(K[r][j], Q[i], carried, -1.0);
    }
  }
  for (int i = 0; i < N; ++i)
    for (int j = 0; j < N; ++j) put_block(K[i][j], 6 * i, 6 * j, 6 * N, matrix);
}

/// Residual of a beam, and its derivative by the ports' increments, 6N x 6N, row-major.
template <int N>
void eval_tangent(const Beam<N>& beam, const PortMotion<double>* p, const PortSlopes* ports,
                  const Surroundings<double>& around, double* residual, double* matrix) {
  constexpr int r = Beam<N>::reference;
  const bool moves = around.has_inertia;
  BeamShape<double, N> b;
  Vec6<double> rate[N], rate2[N];
  eval_beam_motion<double, N>(p, moves, b, rate, rate2);
  eval_wrenches<double, N>(beam, p, b, moves ? rate : nullptr, rate2, around, residual);
  ShapeBlocks<N> s;
  add_internal_slopes<N>(beam, b, moves ? rate : nullptr, s);
  if (beam.has_mass) {
    const PortMotion<double> base = add_gravity(p[r], around);
    add_inertia_slopes<N>(beam, b, rate, rate2, base, moves, s);
    const Mat3<double> turning = lanes::skew(lanes::transpose_times(p[r].H.R, around.gravity));  // R^T g by rotations
    for (int row = 0; row < N; ++row)
      for (int i = 0; i < 6; ++i)
        for (int j = 0; j < 3; ++j)
          for (int k = 0; k < 3; ++k) s.pose[row](i, 3 + j) -= s.a[row](i, k) * turning(k, j);
  }
  carry_to_nodes<N>(b, s, p, ports, moves ? rate : nullptr, rate2, matrix);
}

/// The same of a line load. A dead load turns against the section: d(R^T q) = ~(R^T q) theta.
template <int N>
void eval_tangent(const LineLoad<N>& load, const PortMotion<double>* p, const PortSlopes* ports,
                  const Surroundings<double>& around, double* residual, double* matrix) {
  eval_residual<double, N>(load, p, nullptr, around, residual);
  const auto& rule = mass_rule<N>();
  const BeamShape<double, N> b = eval_shape<double, N>(p);
  ShapeBlocks<N> s;
  for (int g = 0; g < N; ++g) {
    const SectionSlopes section(blend<double, N>(rule.shape[g], b.d));
    Vec6<double> f = (-rule.weight[g] * load.length * around.laws[load.law]) * load.wrench;
    Mat6<double> turning = Mat6<double>::zero();
    if (!load.follows) {
      const Mat3<double> R = p[Beam<N>::reference].H.R * motion::exp_se3(section.slopes.T()).R;
      f = lanes::join(lanes::transpose_times(R, lanes::linear_part(f)),
                      lanes::transpose_times(R, lanes::angular_part(f)));
      const Mat3<double> force = lanes::skew(lanes::linear_part(f)), moment = lanes::skew(lanes::angular_part(f));
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) {
          turning(i, 3 + j) = force(i, j);
          turning(3 + i, 3 + j) = moment(i, j);
        }
    }
    spread_force<N>(rule.shape[g], section, f, product(turning, section.T), s);
    const Mat6<double> by_pose = product(turning, section.E);
    spread_column<N>(rule.shape[g], transposed_product(section.T, by_pose), transposed_product(section.E, by_pose),
                     s.pose);
  }
  carry_to_nodes<N>(b, s, p, ports, nullptr, nullptr, matrix);
}

}  // namespace bough::elements
