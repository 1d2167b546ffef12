#pragma once
/// Tangents of beams and line loads in closed form. All that moves a section, from the nodes' increments on, is an operator on motions, a
/// dual matrix, so only masses, stiffnesses and what they multiply are full 6x6 blocks. Derivation: README.md, "Tangent".
#include "bough/elements/beam_forces.hpp"
#include "screw_tangent.hpp"
#include "tangent_blocks.hpp"

namespace bough::elements {

/// Derivatives of d_i, z_i, d_i', z_i' (see BeamRates) by the increment of one node: operators on motions.
template <class S>
struct RateSlopes {
  DualMat<S> d, z, rate, zz;
};

/// Column blocks of one element: by node i itself and by the reference node.
template <class S, int N>
struct BeamColumns {
  RateSlopes<S> own[N], reference[N];
  DualMat<S> b[N];  ///< of a - (R^T g; 0) of every node by its own increment
};

/// z_i = U w_i, d_i' = z_i + ad(d_i) v_r, z_i' = U c_i + (D U[d_i']) w_i, with dd_i = U eta_i - (U - ad(d_i)) eta_r.
template <class S, int N>
void eval_beam_columns(const BeamRates<S, N>& b, const PortMotion<S>* p, const PortSlopes<S>* ports,
                       const Surroundings<S>& around, bool has_mass, bool has_rates, BeamColumns<S, N>& columns) {
  constexpr int r = Beam<N>::reference;
  const bool moves = ports[r].moves;
  if (has_mass)
    for (int i = 0; i < N; ++i) {
      columns.b[i] = around.has_inertia ? ports[i].acceleration : DualMat<S>::zero();
      if (moves) columns.b[i].b = columns.b[i].b - lanes::skew(lanes::transpose_times(p[i].H.R, around.gravity));
    }
  const DualMat<S> zero = DualMat<S>::zero();
  for (int i = 0; i < N; ++i) {
    if (i == r) continue;
    const DualSeries<S>& inverse = b.inverse[i];
    const DualMat<S> U = matrix(inverse);
    RateSlopes<S>&own = columns.own[i], &ref = columns.reference[i];
    own.d = moves ? U : zero;
    ref.d = moves ? motion::skew(b.d[i]) - U : zero;
    DualMat<S> by_w, slope, by_d;
    if (has_rates) {
      own.z = product(U, ports[i].velocity);
      ref.z = product(U, motion::scaled(-1.0, ports[r].velocity));
      if (moves) {
        by_w = jacobian(inverse, b.w[i]);
        add_product(own.z, by_w, own.d);
        add_product(ref.z, by_w, ref.d);
      }
      own.rate = own.z;
      ref.rate = ref.z;
      if (moves) {
        const DualMat<S> v = motion::skew(-b.v);
        add_product(own.rate, v, own.d);
        add_product(ref.rate, v, ref.d);
        add_product(ref.rate, motion::skew(b.d[i]), ports[r].velocity);
      }
    }
    if (!has_mass || N == 2) continue;  // screw_tangent.hpp does without
    own.zz = product(U, columns.b[i]);
    ref.zz = product(U, motion::scaled(-1.0, columns.b[r]));
    if (!moves) continue;
    by_d = jacobian(inverse, b.c[i]);
    if (has_rates) {
      by_d = by_d + second_jacobian(inverse, b.rate[i], b.w[i]);
      slope = slope_matrix(inverse, b.rate[i]);
      add_product(own.zz, slope, ports[i].velocity);
      add_product(ref.zz, slope, motion::scaled(-1.0, ports[r].velocity));
      add_product(own.zz, by_w, own.rate);
      add_product(ref.zz, by_w, ref.rate);
    }
    add_product(own.zz, by_d, own.d);
    add_product(ref.zz, by_d, ref.d);
  }
}

/// A blend over the nodes, by the increment of node j.
template <class S, int N>
DualMat<S> blend_column(const double* shape, const BeamColumns<S, N>& columns, DualMat<S> RateSlopes<S>::*of, int j) {
  constexpr int r = Beam<N>::reference;
  if (j != r) return motion::scaled(shape[j], columns.own[j].*of);
  DualMat<S> sum = motion::scaled(shape[r == 0 ? 1 : 0], columns.reference[r == 0 ? 1 : 0].*of);
  for (int i = 1; i < N; ++i)
    if (i != r && !(r == 0 && i == 1)) add_scaled_to(sum, shape[i], columns.reference[i].*of);
  return sum;
}

/// Forces conjugate to d_i and their sum over all nodes, with derivatives by the nodes' increments.
template <class S, int N>
struct BeamBlocks {
  DualVec<S> force[N], sum;
  Mat6<S> by[N][N], sum_by[N];
};

/// Elasticity and damping.
template <class S, int N, class C>
void eval_internal_blocks(const Beam<N, C>& beam, const BeamRates<S, N>& b, bool viscous,
                          const BeamColumns<S, N>& columns, BeamBlocks<S, N>& out) {
  constexpr int r = Beam<N>::reference;
  const C inverse = 1.0 / beam.length;
  const auto add_column = [&](Mat6<S>& x, const auto& k, DualMat<S> RateSlopes<S>::*of, int i, int j) {
    add_motion_product(x, k, j == r ? columns.reference[i].*of : columns.own[j].*of);
  };
  if constexpr (N == 2) {
    const Mat6<C> K = inverse * beam.stiffness;
    out.by[1][0] = motion_product(K, columns.reference[1].d);
    out.by[1][1] = motion_product(K, columns.own[1].d);
    if (viscous) {
      const Mat6<C> D = inverse * beam.damping;
      add_column(out.by[1][0], D, &RateSlopes<S>::rate, 1, 0);
      add_column(out.by[1][1], D, &RateSlopes<S>::rate, 1, 1);
    }
  } else {
    const auto& rule = strain_rule<N>();
    Mat6<S> by_d[N][N] = {};
    Mat6<S> by_rate[N][N];
    if (viscous)
      for (auto& row : by_rate)
        for (Mat6<S>& block : row) block = Mat6<S>::zero();
    for (int g = 0; g < Beam<N>::num_strain_points; ++g) {
      const double *shape = rule.shape[g], *slope = rule.slope[g], w = rule.weight[g];
      StrainPoint<S> s;
      eval_strain_point<S, N>(beam, b, viscous, g, s);
      const DualMat<S> T = matrix(s.T), &A = s.bending, G = transpose_jacobian(s.T, s.n);
      const Mat6<C> K = inverse * beam.stiffness;
      Mat6<C> D;
      if (viscous) D = inverse * beam.damping;
      Mat6<S> n_d = motion_product(K, A), n_y = motion_product(K, T), n_d1, n_y1;
      if (viscous) {
        add_motion_product(n_d, D, jacobian(s.T, s.y1) + second_jacobian(s.T, s.d1, s.y));
        add_motion_product(n_y, D, slope_matrix(s.T, s.d1));
        n_d1 = motion_product(D, A);
        n_y1 = motion_product(D, T);
      }
      const DualMat<S> G_transposed{lanes::transpose(G.a), lanes::transpose(G.b)};
      Mat6<S> slope_d = transposed_product(T, n_d), shape_d = transposed_product(A, n_d),
              shape_y = transposed_product(A, n_y);
      const Mat6<S> slope_y = transposed_product(T, n_y);
      add_wrench(slope_d, G);
      add_wrench(shape_d, hessian(s.T, s.n, s.y));
      add_wrench(shape_y, G_transposed);
      const auto spread = [&](Mat6<S>(&blocks)[N][N], const Mat6<S>& sd, const Mat6<S>& sy, const Mat6<S>& hd,
                              const Mat6<S>& hy) {
        for (int i = 0; i < N; ++i)
          for (int j = 0; j < N; ++j) {
            if (i == r || j == r) continue;
            add_scaled_to(blocks[i][j], w * slope[i] * shape[j], sd);
            add_scaled_to(blocks[i][j], w * slope[i] * slope[j], sy);
            add_scaled_to(blocks[i][j], w * shape[i] * shape[j], hd);
            add_scaled_to(blocks[i][j], w * shape[i] * slope[j], hy);
          }
      };
      spread(by_d, slope_d, slope_y, shape_d, shape_y);
      if (viscous)
        spread(by_rate, transposed_product(T, n_d1), transposed_product(T, n_y1), transposed_product(A, n_d1),
               transposed_product(A, n_y1));
    }
    for (int i = 0; i < N; ++i)
      for (int j = 0; j < N; ++j) {
        if (i == r) continue;
        Mat6<S>& x = out.by[i][j] = Mat6<S>::zero();
        for (int k = 0; k < N; ++k) {
          if (k == r || (j != r && j != k)) continue;
          add_motion_product(x, by_d[i][k], j == r ? columns.reference[k].d : columns.own[k].d);
          if (viscous) add_motion_product(x, by_rate[i][k], j == r ? columns.reference[k].rate : columns.own[k].rate);
        }
      }
  }
  // what the nodes bear together: sum_i ad(d_i)^T p_i
  for (int j = 0; j < N; ++j) {
    out.sum_by[j] = Mat6<S>::zero();
    for (int i = 0; i < N; ++i) {
      if (i == r) continue;
      add_cross_transposed(out.sum_by[j], b.d[i], out.by[i][j]);
      if (j == i || j == r)
        add_wrench(out.sum_by[j],
                   product(motion::skew(out.force[i]), j == r ? columns.reference[i].d : columns.own[i].d));
    }
  }
}

/// Inertia and gravity at a mass point:  dv = dv_r + T dz + J(z) dd,  db = db_r + T dz' + T' dz + J(z) dd' + (J(z') + J'(z)) dd.
template <class S, int N, class C>
void add_mass_point(const Beam<N, C>& beam, const PortSlopes<S>* ports, int point, const MassPoint<S>& m,
                    bool has_rates, const BeamColumns<S, N>& columns, BeamBlocks<S, N>& out) {
  constexpr int r = Beam<N>::reference;
  const bool moves = ports[r].moves;
  const double* shape = mass_rule<N>().shape[point];
  const DualMat<S> T = matrix(m.T);
  const Mat6<C> mass = C(mass_rule<N>().weight[point] * beam.length) * beam.mass;
  DualMat<S> slope, by_z, by_d, by_f;
  Mat6<S> f_v;
  if (moves) {
    by_f = transpose_jacobian(m.T, m.f);
    by_d = jacobian(m.T, m.zz);
    if (has_rates) {
      by_d = by_d + second_jacobian(m.T, m.rate, m.z);
      by_z = jacobian(m.T, m.z);
      slope = slope_matrix(m.T, m.rate);
      f_v = gyroscopic_matrix(mass, m.v, motion::wrench_dual(Vec6<S>(mass * motion::motion_vector(m.v))));
    }
  }
  for (int j = 0; j < N; ++j) {
    using Rates = RateSlopes<S>;
    DualMat<S> a = product(T, blend_column(shape, columns, &Rates::zz, j));
    if (j == r) a = a + columns.b[r];
    DualMat<S> d;
    Mat6<S> f;
    if (moves) {
      d = blend_column(shape, columns, &Rates::d, j);
      add_product(a, by_d, d);
    }
    if (moves && has_rates) {
      const DualMat<S> z = blend_column(shape, columns, &Rates::z, j);
      add_product(a, slope, z);
      add_product(a, by_z, blend_column(shape, columns, &Rates::rate, j));
      DualMat<S> v = product(T, z);
      add_product(v, by_z, d);
      if (j == r) v = v + ports[r].velocity;
      f = motion_product(f_v, v);
      add_motion_product(f, mass, a);
    } else {
      f = motion_product(mass, a);
    }
    Mat6<S> q = transposed_product(T, f);
    if (moves) add_wrench(q, product(by_f, d));
    for (int i = 0; i < N; ++i)
      if (i != r) add_scaled_to(out.by[i][j], shape[i], q);
    out.sum_by[j] += f;
  }
}

/// What acts on the other node of a two-node beam directly, not through d.
template <class S>
struct DirectBlocks {
  DualVec<S> force;
  DualMat<S> by_d;  ///< its derivative by d, [0, A; A, B]
  Mat6<S> by[2];    ///< the rest of it, by the nodes' increments
};

/// From forces conjugate to d_i to the nodes:  F_i = U_i^T p_i (+ direct),  F_r = sum - sum_i F_i.  `matrix`: 6N x 6N, row-major.
template <class S, int N>
void carry_to_nodes(const BeamRates<S, N>& b, const PortSlopes<S>* ports, const BeamColumns<S, N>& columns,
                    BeamBlocks<S, N>& blocks, S* matrix_out, const DirectBlocks<S>* direct = nullptr) {
  constexpr int r = Beam<N>::reference;
  const bool moves = ports[r].moves;
  for (int i = 0; i < N; ++i) {
    if (i == r) continue;
    const DualMat<S> U = matrix(b.inverse[i]);
    DualMat<S> by_force;
    if (moves) by_force = transpose_jacobian(b.inverse[i], blocks.force[i]);
    if (moves && direct != nullptr) by_force = by_force + direct->by_d;
    for (int j = 0; j < N; ++j) {
      Mat6<S> f = transposed_product(U, blocks.by[i][j]);
      if (direct != nullptr) f += direct->by[j];
      if (moves && j == i) add_wrench(f, product(by_force, columns.own[i].d));
      if (moves && j == r) add_wrench(f, product(by_force, columns.reference[i].d));
      put_block(f, 6 * i, 6 * j, 6 * N, matrix_out);
      for (int k = 0; k < 36; ++k) blocks.sum_by[j].m[k] = blocks.sum_by[j].m[k] - f.m[k];
    }
  }
  for (int j = 0; j < N; ++j) put_block(blocks.sum_by[j], 6 * r, 6 * j, 6 * N, matrix_out);
}

/// Inertia and gravity of a two-node beam; elasticity stands in `blocks`.
template <class S, class C>
void eval_screw_tangent(const Beam<2, C>& beam, const BeamRates<S, 2>& b, const PortSlopes<S>* ports, bool has_inertia,
                        const BeamColumns<S, 2>& columns, BeamBlocks<S, 2>& blocks, S* residual, S* matrix_out) {
  const bool moves = ports[0].moves;
  const Mat6<C> mass = point_mass(beam);
  const ScrewBlend<S> blend = eval_screw_blend(b.d[1]);
  GaussPair<S> g;
  eval_gauss_forces(mass, blend, b, has_inertia, g);
  DirectBlocks<S> direct;
  direct.force = eval_gauss_wrench(blend, g);
  if (moves) direct.by_d = gauss_wrench_jacobian(blend, g);
  blocks.sum = blocks.sum + g.sum;
  ScrewSlopes<S> slopes;
  eval_screw_slopes(blend, b, moves, has_inertia, slopes);
  Mat6<S> f_v[2];
  if (moves && has_inertia)
    for (int k = 0; k < 2; ++k)
      f_v[k] = gyroscopic_matrix(mass, g.v[k], motion::wrench_dual(Vec6<S>(mass * motion::motion_vector(g.v[k]))));
  for (int j = 0; j < 2; ++j) {
    const ScrewColumn<S> column{j == 0 ? columns.reference[1].d : columns.own[1].d, ports[j].velocity, columns.b[j],
                                j == 0};
    direct.by[j] = Mat6<S>::zero();
    add_gauss_blocks(mass, f_v, slopes, column, moves, has_inertia, direct.by[j], blocks.sum_by[j]);
  }
  eval_nodal_wrenches<S, 2>(b, blocks.force, blocks.sum, residual, &direct.force);
  carry_to_nodes(b, ports, columns, blocks, matrix_out, &direct);
}

/// Residual of a beam, and its derivative by the ports' increments, 6N x 6N, row-major.
template <class S, int N, class C>
void eval_tangent(const Beam<N, C>& beam, const PortMotion<S>* p, const PortSlopes<S>* ports,
                  const Surroundings<S>& around, S* residual, S* matrix_out) {
  constexpr int r = Beam<N>::reference;
  const bool viscous = around.has_inertia && beam.has_damping,
             has_rates = around.has_inertia && (beam.has_mass || beam.has_damping);
  BeamRates<S, N> b;
  eval_beam_rates<S, N>(p, around, beam.has_mass, beam.has_damping, b);
  BeamColumns<S, N> columns;
  eval_beam_columns(b, p, ports, around, beam.has_mass, N == 2 ? viscous : has_rates, columns);
  BeamBlocks<S, N> blocks;
  eval_internal_forces<S, N>(beam, b, viscous, blocks.force);
  eval_internal_blocks(beam, b, viscous, columns, blocks);
  blocks.sum = DualVec<S>::zero();
  for (int i = 0; i < N; ++i)
    if (i != r) blocks.sum = add_cross(blocks.sum, blocks.force[i], b.d[i]);
  if constexpr (N == 2) {
    if (beam.has_mass)
      return eval_screw_tangent(beam, b, ports, around.has_inertia, columns, blocks, residual, matrix_out);
  } else if (beam.has_mass)
    for (int g = 0; g < Beam<N>::num_mass_points; ++g) {
      MassPoint<S> m;
      eval_mass_point<S, N>(beam, b, around.has_inertia, g, m);
      const DualVec<S> q = transpose_times(m.T, m.f);
      for (int i = 0; i < N; ++i)
        if (i != r) blocks.force[i] = add_scaled(blocks.force[i], mass_rule<N>().shape[g][i], q);
      blocks.sum = blocks.sum + m.f;
      add_mass_point(beam, ports, g, m, around.has_inertia, columns, blocks);
    }
  eval_nodal_wrenches<S, N>(b, blocks.force, blocks.sum, residual);
  carry_to_nodes(b, ports, columns, blocks, matrix_out);
}

/// The same of a line load. A dead load turns against the section: d(R^T q) = ~(R^T q) theta.
template <class S, int N, class C>
void eval_tangent(const LineLoad<N, C>& load, const PortMotion<S>* p, const PortSlopes<S>* ports,
                  const Surroundings<S>& around, S* residual, S* matrix_out) {
  constexpr int r = Beam<N>::reference;
  BeamRates<S, N> b;
  eval_relative_motions<S, N>(p, b);
  BeamColumns<S, N> columns;
  eval_beam_columns(b, p, ports, around, false, false, columns);
  BeamBlocks<S, N> blocks;
  blocks.sum = DualVec<S>::zero();
  for (int i = 0; i < N; ++i) {
    blocks.force[i] = DualVec<S>::zero();
    blocks.sum_by[i] = Mat6<S>::zero();
    for (int j = 0; j < N; ++j) blocks.by[i][j] = Mat6<S>::zero();
  }
  for (int g = 0; g < N; ++g) {
    const double* shape = mass_rule<N>().shape[g];
    const DualSeries<S> series = motion::dual_tangent(blend<S, N>(shape, b.d));
    const DualVec<S> f = eval_load(load, p[r], series, around, g), q = transpose_times(series, f);
    for (int i = 0; i < N; ++i)
      if (i != r) blocks.force[i] = add_scaled(blocks.force[i], shape[i], q);
    blocks.sum = blocks.sum + f;
    if (!ports[r].moves) continue;
    const DualMat<S> T = matrix(series), by_f = transpose_jacobian(series, f);
    const Mat3<S> force = lanes::skew(f.a), moment = lanes::skew(f.b);
    for (int j = 0; j < N; ++j) {
      const DualMat<S> d = blend_column(shape, columns, &RateSlopes<S>::d, j);
      Mat6<S> f_j = Mat6<S>::zero();
      if (!load.follows) {    // by the rotation theta of the section
        Mat3<S> theta = d.a;  // theta = theta_r + T (dd - ad(d) eta_r), angular parts
        if (j == r) theta = theta - lanes::skew(series.psi.a);
        theta = T.a * theta;
        if (j == r)
          for (int i = 0; i < 3; ++i) theta(i, i) = theta(i, i) + 1.0;
        const Mat3<S> upper = force * theta, lower = moment * theta;
        for (int i = 0; i < 3; ++i)
          for (int k = 0; k < 3; ++k) {
            f_j(i, 3 + k) = upper(i, k);
            f_j(3 + i, 3 + k) = lower(i, k);
          }
      }
      Mat6<S> q_j = transposed_product(T, f_j);
      add_wrench(q_j, product(by_f, d));
      for (int i = 0; i < N; ++i)
        if (i != r) add_scaled_to(blocks.by[i][j], shape[i], q_j);
      blocks.sum_by[j] += f_j;
    }
  }
  eval_nodal_wrenches<S, N>(b, blocks.force, blocks.sum, residual);
  carry_to_nodes(b, ports, columns, blocks, matrix_out);
}

}  // namespace bough::elements
