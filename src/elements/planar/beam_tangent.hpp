#pragma once
/// Tangents of planar beams in closed form: elements/README.md, "Tangent", where all that moves a section is a map of a few complex numbers
/// and only masses, stiffnesses and what they multiply are full 3x3 blocks.
#include "beam_forces.hpp"
#include "plane_map.hpp"

namespace bough::elements::planar {

/// How a port's motion follows its increment eta: H <- H exp(eta) if `moves`, dv = velocity eta, da = acceleration eta.
/// `moves` is the same for all ports of an element; the columns of ports on the ground are dropped afterwards.
template <class S>
struct PortSlopes {
  bool moves = true;
  PlaneMap<S> velocity, acceleration;
};

/// J(y) = d(T y)/dd, T' = T'[delta] along a motion, J'(y) the derivative of J(y) along it.
template <class S>
UpperRows<S> jacobian(const PlaneMotion<S>& m, const Vec3<S>& y) {
  return {y[2] * m.series.k, m.by_angle(y)};
}
template <class S>
UpperRows<S> slope_map(const PlaneMotion<S>& m, const Vec3<S>& delta) {
  return {delta[2] * conjugate(m.series.df), add_complex(Vec2<S>(delta[2] * motion::complex_times(m.series.dk, m.u)),
                                                         m.series.k, motion::plane_part(delta))};
}
template <class S>
UpperRows<S> second_jacobian(const PlaneMotion<S>& m, const Vec3<S>& delta, const Vec3<S>& y) {
  const Vec2<S> by_angle = y[2] * m.series.dk;
  const Vec2<S> second = add_scaled(motion::conjugate_times(m.series.ddf, motion::plane_part(y)), y[2],
                                    motion::complex_times(m.series.ddk, m.u));
  return {delta[2] * by_angle, add_complex(Vec2<S>(delta[2] * second), by_angle, motion::plane_part(delta))};
}
/// d(T^T m)/dd, forces held.
template <class S>
WrenchSlope<S> transpose_jacobian(const PlaneMotion<S>& m, const Vec3<S>& force) {
  const Vec2<S> n = motion::plane_part(force);
  return {motion::complex_times(m.series.df, n), motion::conjugate_times(m.series.k, n),
          lanes::dot(motion::complex_times(m.series.dk, m.u), n)};
}
/// d(J(y)^T m)/dd, y and forces held: the second derivative of m . T(d) y.
template <class S>
WrenchSlope<S> hessian(const PlaneMotion<S>& m, const Vec3<S>& y, const Vec3<S>& force) {
  const Vec2<S> n = motion::plane_part(force), side = y[2] * motion::conjugate_times(m.series.dk, n);
  const Vec2<S> second = add_scaled(motion::conjugate_times(m.series.ddf, motion::plane_part(y)), y[2],
                                    motion::complex_times(m.series.ddk, m.u));
  return {side, side, lanes::dot(second, n)};
}
/// d(T^-T p)/dd, where n = T^-T p:  dn_u = h' p_u dtheta = -h f' n_u dtheta,  dn_w = -d((k u) . n_u).
template <class S>
WrenchSlope<S> inverse_transpose_jacobian(const PlaneMotion<S>& m, const Vec2<S>& h, const Vec3<S>& wrench) {
  const Vec2<S> n = motion::plane_part(wrench);
  const Vec2<S> turned = -motion::complex_times(motion::complex_times(m.series.df, h), n);
  return {turned, -motion::conjugate_times(m.series.k, n),
          -(lanes::dot(motion::complex_times(m.series.dk, m.u), n) + lanes::dot(m.ku, turned))};
}
/// d(ad(d)^T p)/dd.
template <class S>
WrenchSlope<S> bracket_transpose_jacobian(const Vec3<S>& p) {
  const Vec2<S> turned = motion::quarter_turn(motion::plane_part(p));
  return {-turned, turned, S(0.0)};
}
template <class S>
WrenchSlope<S> transposed(const WrenchSlope<S>& w) {
  return {w.row, w.column, w.corner};
}

/// Derivatives of d_i, z_i, d_i', z_i' (BeamRates) by the increment of one node.
template <class S>
struct RateSlopes {
  PlaneMap<S> d, z, rate, zz;
};
/// By node i itself and by the reference node.
template <class S, int N>
struct BeamColumns {
  PlaneMotion<S> T[N];  ///< of d_i
  RateSlopes<S> own[N], reference[N];
  PlaneMap<S> b[N];  ///< of a - (R^T g; 0) of every node by its own increment
};

/// By what forces are derived.
struct BeamTerms {
  bool moves;    ///< poses: all but a consistent start
  bool rates;    ///< velocities too
  bool viscous;  ///< of them those of strains
};

/// How T z' + T'[d'] z of a section or a node follows z and d beside T dz', where d' = z + ad(d) v_r:
///   by_z = J(z) + T',   by_d = J(z') + J'(z) - J(z) ad(v_r);  by J(z) what ad(d) makes of dv_r
template <class S>
struct AccelerationSlopes {
  UpperRows<S> J, by_z, by_d;
};
template <class S>
AccelerationSlopes<S> eval_acceleration_slopes(const PlaneMotion<S>& T, const Vec3<S>& z, const Vec3<S>& rate,
                                               const Vec3<S>& zz, const Vec3<S>& v) {
  const UpperRows<S> J = jacobian(T, z), turned = times_bracket(J, v);
  const UpperRows<S> by_d = jacobian(T, zz) + second_jacobian(T, rate, z);
  return {J, J + slope_map(T, rate), {by_d.c - turned.c, by_d.t - turned.t}};
}

/// z_i = U w_i, d_i' = z_i + ad(d_i) v_r, z_i' = U (c_i - T' z_i) with U = T(d_i)^-1 and dd_i = U eta_i - (U - ad(d_i)) eta_r. As T z_i = w_i,
///   dz_i = U (dw_i - J(z_i) dd_i),   dz_i' = U (dc_i - T' dz_i - J(z_i) dd_i' - (J(z_i') + J'(z_i)) dd_i)
template <class S, int N>
void eval_beam_columns(const BeamRates<S, N>& b, const PortMotion<S>* p, const PortSlopes<S>* ports,
                       const Surroundings<S>& around, bool has_mass, const BeamTerms& terms,
                       BeamColumns<S, N>& columns) {
  constexpr int r = elements::Beam<N>::reference;
  if (has_mass)
    for (int i = 0; i < N; ++i) {
      columns.b[i] = ports[i].acceleration;
      if (terms.moves) columns.b[i].t += motion::quarter_turn(motion::conjugate_times(p[i].turn, around.gravity));
    }
  for (int i = 0; i < N; ++i) {
    if (i == r) continue;
    const PlaneMap<S> U = inverse_map(b.log[i]);
    PlaneMotion<S>& T = columns.T[i];
    RateSlopes<S>&own = columns.own[i], &ref = columns.reference[i];
    if (terms.moves) {
      T = PlaneMotion<S>(b.d[i]);
      own.d = U;
      ref.d = bracket_map(b.d[i]) + negated(U);
    }
    PlaneMap<S> carried;
    if (terms.rates) {
      const UpperRows<S> J = jacobian(T, b.z[i]);
      own.z = ports[i].velocity;
      ref.z = negated(ports[r].velocity);
      subtract_product(own.z, J, own.d);
      subtract_product(ref.z, J, ref.d);
      own.z = product(U, own.z);
      ref.z = product(U, ref.z);
      carried = bracket_product(b.d[i], ports[r].velocity);
    }
    if (terms.viscous) {
      own.rate = own.z + negated(bracket_product(b.v, own.d));
      ref.rate = ref.z + carried + negated(bracket_product(b.v, ref.d));
    }
    if (!has_mass) continue;
    own.zz = columns.b[i];
    ref.zz = negated(columns.b[r]);
    if (terms.rates) {
      const AccelerationSlopes<S> slopes = eval_acceleration_slopes<S>(T, b.z[i], b.rate[i], b.zz[i], b.v);
      subtract_product(own.zz, slopes.by_z, own.z);
      subtract_product(ref.zz, slopes.by_z, ref.z);
      subtract_product(own.zz, slopes.by_d, own.d);
      subtract_product(ref.zz, slopes.by_d, ref.d);
      subtract_product(ref.zz, slopes.J, carried);
    } else if (terms.moves) {
      const UpperRows<S> J = jacobian(T, b.zz[i]);
      subtract_product(own.zz, J, own.d);
      subtract_product(ref.zz, J, ref.d);
    }
    own.zz = product(U, own.zz);
    ref.zz = product(U, ref.zz);
  }
}

/// A blend of d_i, z_i, d_i' or z_i' over the nodes, by the increment of the reference node or of node j.
template <class S, int N>
PlaneMap<S> blend_column(const double* shape, const BeamColumns<S, N>& columns, PlaneMap<S> RateSlopes<S>::*of, int j) {
  constexpr int r = elements::Beam<N>::reference, first = r == 0 ? 1 : 0;
  if (j != r) return scaled(shape[j], columns.own[j].*of);
  PlaneMap<S> sum = scaled(shape[first], columns.reference[first].*of);
  for (int i = first + 1; i < N; ++i)
    if (i != r) add_scaled_to(sum, shape[i], columns.reference[i].*of);
  return sum;
}

/// Derivatives of forces conjugate to d_i and of their sum over all nodes, by the nodes' increments.
template <class S, int N>
struct BeamBlocks {
  Mat3<S> by[N][N], sum_by[N];
};

/// Elasticity and damping; p: their forces.
template <class S, int N, class C>
void eval_internal_blocks(const Beam<N, C>& e, const BeamRates<S, N>& b, const Vec3<S>* p, const BeamTerms& terms,
                          const BeamColumns<S, N>& columns, BeamBlocks<S, N>& out) {
  constexpr int r = elements::Beam<N>::reference;
  const C inverse = 1.0 / e.length;
  const Mat3<C> K = inverse * e.stiffness;
  Mat3<C> D;
  if (terms.viscous) D = inverse * e.damping;
  if constexpr (N == 2) {
    out.by[1][0] = matrix_product(K, columns.reference[1].d);
    out.by[1][1] = matrix_product(K, columns.own[1].d);
    if (terms.viscous) {
      add_matrix_product(out.by[1][0], D, columns.reference[1].rate);
      add_matrix_product(out.by[1][1], D, columns.own[1].rate);
    }
  } else {
    for (int i = 0; i < N; ++i)
      for (int j = 0; j < N; ++j) out.by[i][j] = Mat3<S>::zero();
    const auto& rule = strain_rule<N>();
    for (int g = 0; g < N - 1; ++g) {
      const double *shape = rule.shape[g], *slope = rule.slope[g], w = rule.weight[g];
      StrainPoint<S> s;
      eval_strain_point(e, b, terms.viscous, rule, g, s);
      const PlaneMap<S> T = map_of(s.T);
      const UpperRows<S> A = jacobian(s.T, s.y);
      const PlaneMap<S> bending{A.c, A.t, S(0.0)};
      const WrenchSlope<S> by_force = transpose_jacobian(s.T, s.n), by_slope = transposed(by_force),
                           second = hessian(s.T, s.y, s.n);
      UpperRows<S> by_d, by_y;
      if (terms.viscous) {
        by_d = jacobian(s.T, s.y1) + second_jacobian(s.T, s.d1, s.y);
        by_y = slope_map(s.T, s.d1);
      }
      for (int j = 0; j < N; ++j) {
        const PlaneMap<S> d = blend_column(shape, columns, &RateSlopes<S>::d, j),
                          y = blend_column(slope, columns, &RateSlopes<S>::d, j);
        PlaneMap<S> strain = product(T, y);
        add_product(strain, A, d);
        Mat3<S> n = matrix_product(K, strain);
        if (terms.viscous) {
          PlaneMap<S> rate = product(T, blend_column(slope, columns, &RateSlopes<S>::rate, j));
          add_product(rate, A, blend_column(shape, columns, &RateSlopes<S>::rate, j));
          add_product(rate, by_d, d);
          add_product(rate, by_y, y);
          add_matrix_product(n, D, rate);
        }
        Mat3<S> along_slope = transposed_product(T, n), along_shape = transposed_product(bending, n);
        add_product(along_slope, by_force, d);
        add_product(along_shape, by_slope, y);
        add_product(along_shape, second, d);
        for (int i = 0; i < N; ++i) {
          if (i == r) continue;
          add_scaled_to(out.by[i][j], w * slope[i], along_slope);
          add_scaled_to(out.by[i][j], w * shape[i], along_shape);
        }
      }
    }
  }
  // what the nodes bear together: sum_i ad(d_i)^T p_i
  for (int j = 0; j < N; ++j) {
    out.sum_by[j] = Mat3<S>::zero();
    for (int i = 0; i < N; ++i) {
      if (i == r) continue;
      add_bracket_transposed(out.sum_by[j], b.d[i], out.by[i][j]);
      if (j == i || j == r)
        add_product(out.sum_by[j], bracket_transpose_jacobian(p[i]),
                    j == r ? columns.reference[i].d : columns.own[i].d);
    }
  }
}

/// d(m a - ad(v)^T m v)/dv.
template <class A, class S>
Mat3<S> gyroscopic_matrix(const Mat3<A>& m, const Vec3<S>& v) {
  using lanes::multiply_add;
  using lanes::negative_multiply_add;
  const Vec3<S> momentum = m * v;
  Mat3<S> x;
  for (int j = 0; j < 3; ++j) {
    x(0, j) = -(v[2] * m(1, j));
    x(1, j) = v[2] * m(0, j);
    x(2, j) = negative_multiply_add(v[1], m(0, j), S(v[0] * m(1, j)));
  }
  x(0, 2) = x(0, 2) - momentum[1];
  x(1, 2) = x(1, 2) + momentum[0];
  x(2, 0) = x(2, 0) + momentum[1];
  x(2, 1) = x(2, 1) - momentum[0];
  return x;
}

/// Inertia and gravity at a mass point:  dv = dv_r + T dz + J(z) dd,  db = db_r + T dz' + T' dz + J(z) dd' + (J(z') + J'(z)) dd.
template <class S, int N, class C>
void add_mass_blocks(const Beam<N, C>& e, const BeamRates<S, N>& b, const PortSlopes<S>* ports,
                     const ShapeRule<N, N>& rule, int point, const MassPoint<S>& m, const BeamTerms& terms,
                     const BeamColumns<S, N>& columns, BeamBlocks<S, N>& out) {
  constexpr int r = elements::Beam<N>::reference;
  const double* shape = rule.shape[point];
  const PlaneMap<S> T = map_of(m.T);
  const Mat3<C> mass = C(rule.weight[point] * e.length) * e.mass;
  AccelerationSlopes<S> slopes;
  WrenchSlope<S> by_force;
  Mat3<S> by_v;
  if (terms.moves) by_force = transpose_jacobian(m.T, m.f);
  if (terms.rates) {
    slopes = eval_acceleration_slopes(m.T, m.z, m.rate, m.zz, b.v);
    by_v = gyroscopic_matrix(mass, m.v);
  } else if (terms.moves) {
    slopes.by_d = jacobian(m.T, m.zz);
  }
  for (int j = 0; j < N; ++j) {
    const bool is_reference = j == r;
    // of other nodes without the factor shape[j], which the blocks take at the end
    const double factor = is_reference ? 1.0 : shape[j];
    const auto column = [&](PlaneMap<S> RateSlopes<S>::*of) {
      return is_reference ? blend_column(shape, columns, of, r) : columns.own[j].*of;
    };
    PlaneMap<S> d, a = product(T, column(&RateSlopes<S>::zz));
    if (terms.moves) {
      d = column(&RateSlopes<S>::d);
      add_product(a, slopes.by_d, d);
    }
    if (is_reference) a = a + columns.b[r];
    Mat3<S> f;
    if (terms.rates) {
      const PlaneMap<S> z = column(&RateSlopes<S>::z);
      PlaneMap<S> v = product(T, z);
      add_product(v, slopes.J, d);
      add_product(a, slopes.by_z, z);
      if (is_reference) {
        v = v + ports[r].velocity;
        add_product(a, slopes.J, bracket_product(join(m.T.u, m.T.theta), ports[r].velocity));
      }
      f = matrix_product(mass, a);
      add_matrix_product(f, by_v, v);
    } else {
      f = matrix_product(mass, a);
    }
    Mat3<S> q = transposed_product(T, f);
    if (terms.moves) add_product(q, by_force, d);
    for (int i = 0; i < N; ++i)
      if (i != r) add_scaled_to(out.by[i][j], shape[i] * factor, q);
    add_scaled_to(out.sum_by[j], factor, f);
  }
}

/// F_i = T(d_i)^-T p_i,  F_r = sum - sum_i F_i: blocks of the wrenches at the nodes, given as put(i, j, block).
template <class S, int N, class Put>
void eval_nodal_blocks(const BeamRates<S, N>& b, const Vec3<S>* out, const BeamTerms& terms,
                       const BeamColumns<S, N>& columns, BeamBlocks<S, N>& blocks, const Put& put) {
  constexpr int r = elements::Beam<N>::reference;
  for (int i = 0; i < N; ++i) {
    if (i == r) continue;
    const PlaneMap<S> U = inverse_map(b.log[i]);
    WrenchSlope<S> by_d;
    if (terms.moves) by_d = inverse_transpose_jacobian(columns.T[i], b.log[i].h, out[i]);
    for (int j = 0; j < N; ++j) {
      Mat3<S> block = transposed_product(U, blocks.by[i][j]);
      if (terms.moves && (j == i || j == r))
        add_product(block, by_d, j == r ? columns.reference[i].d : columns.own[i].d);
      add_scaled_to(blocks.sum_by[j], -1.0, block);
      put(i, j, block);
    }
  }
  for (int j = 0; j < N; ++j) put(r, j, blocks.sum_by[j]);
}

/// Residual of a beam, the bits of eval_residual, and its derivative by the ports' increments as put(i, j, block).
template <class S, int N, class C, class Put>
void eval_tangent(const Beam<N, C>& e, const PortMotion<S>* p, const PortSlopes<S>* ports,
                  const Surroundings<S>& around, Vec3<S>* out, const Put& put) {
  const bool moves = ports[0].moves, rates = has_rates(e, around), viscous = around.has_inertia && e.has_damping;
  const BeamTerms terms{moves, moves && rates, moves && viscous};
  BeamRates<S, N> b;
  Vec3<S> force[N];
  eval_beam_rates(e, p, around, b);
  eval_internal_forces(e, b, viscous, force);
  Vec3<S> sum = sum_of(b, force);
  BeamColumns<S, N> columns;
  BeamBlocks<S, N> blocks;
  eval_beam_columns(b, p, ports, around, e.has_mass, terms, columns);
  if (moves) {
    eval_internal_blocks(e, b, force, terms, columns, blocks);
  } else {
    for (int j = 0; j < N; ++j) {
      blocks.sum_by[j] = Mat3<S>::zero();
      for (int i = 0; i < N; ++i) blocks.by[i][j] = Mat3<S>::zero();
    }
  }
  if (e.has_mass) {
    const ShapeRule<N, N>& rule = mass_rule<N>();
    for (int g = 0; g < N; ++g) {
      MassPoint<S> m;
      eval_mass_point(e, b, rates, rule, g, m);
      add_mass_point<S, N>(rule.shape[g], m, force, sum);
      add_mass_blocks(e, b, ports, rule, g, m, terms, columns, blocks);
    }
  }
  eval_nodal_wrenches(b, force, sum, out);
  eval_nodal_blocks(b, out, terms, columns, blocks, put);
}

}  // namespace bough::elements::planar
