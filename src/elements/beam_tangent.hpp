#pragma once
/// Tangents of beams of three and four nodes and of line loads in closed form. The motion of a section follows from the
/// nodes' increments by maps of motions in the group's compact form, so only masses, stiffnesses and their products are
/// full blocks. Derivation: beams.md, "Tangent".
#include "bough/elements/beam_forces.hpp"
#include "screw_tangent.hpp"

namespace bough::elements {

/// Derivatives of d_i, z_i, d_i', z_i' (see BeamRates) by the increment of one node.
template <class G, class S>
struct RateSlopes {
  typename G::template Map<S> d, z, rate, zz;
};

/// Column blocks of one element: by node i itself and by the reference node.
template <class G, class S, int N>
struct BeamColumns {
  RateSlopes<G, S> own[N], reference[N];
  typename G::template Map<S> b[N];  ///< of a - (R^T g; 0) of every node by its own increment
};

/// z_i = U w_i, d_i' = z_i + ad(d_i) v_r, z_i' = U c_i + (D U[d_i']) w_i, with dd_i = U eta_i - (U - ad(d_i)) eta_r.
/// The dependence of z_i' on d_i', J_i dd_i' with J_i = d(U w_i)/dd_i, is added to its dependence on z_i and d_i by
/// substituting dd_i' = dz_i - ad(v_r) dd_i + ad(d_i) dv_r.
template <class G, class S, int N>
void eval_node_columns(const BeamRates<G, S, N>& b, const PortSlopesOn<G, S>* ports, bool has_mass,
                       const BeamTerms& terms, int i, BeamColumns<G, S, N>& columns) {
  constexpr int r = beam_reference<N>;
  const auto& inverse = b.inverse[i];
  const auto U = matrix(inverse);
  RateSlopes<G, S>&own = columns.own[i], &ref = columns.reference[i];
  if (terms.moves) {
    own.d = U;
    ref.d = G::minus(G::ad(b.d[i]), U);
  }
  typename G::template BracketMap<S> by_w;
  typename G::template Map<S> carried;  ///< ref.z + ad(d_i) dv_r
  if (terms.rates) {
    by_w = jacobian(inverse, b.w[i]);
    own.z = G::product(U, ports[i].velocity);
    ref.z = G::negated(G::product(U, ports[r].velocity));
    G::add_product(own.z, by_w, own.d);
    G::add_product(ref.z, by_w, ref.d);
    carried = ref.z;
    G::add_product(carried, G::ad(b.d[i]), ports[r].velocity);
  }
  if (terms.viscous) {
    const auto v = G::ad(-b.v);
    own.rate = own.z;
    ref.rate = carried;
    G::add_product(own.rate, v, own.d);
    G::add_product(ref.rate, v, ref.d);
  }
  if (!has_mass) return;
  own.zz = G::product(U, columns.b[i]);
  ref.zz = G::negated(G::product(U, columns.b[r]));
  if (!terms.moves) return;
  auto by_d = jacobian(inverse, b.c[i]);
  if (terms.rates) {
    by_d = G::plus(by_d, second_jacobian(inverse, b.rate[i], b.w[i]));
    G::subtract_times_ad(by_d, by_w, b.v);
    const auto slope = slope_matrix(inverse, b.rate[i]);
    G::add_product(own.zz, slope, ports[i].velocity);
    G::subtract_product(ref.zz, slope, ports[r].velocity);
    G::add_product(own.zz, by_w, own.z);
    G::add_product(ref.zz, by_w, carried);
  }
  G::add_product(own.zz, by_d, own.d);
  G::add_product(ref.zz, by_d, ref.d);
}
template <class G, class S, int N>
void eval_beam_columns(const BeamRates<G, S, N>& b, const PortMotionOn<G, S>* p, const PortSlopesOn<G, S>* ports,
                       const SurroundingsOn<G, S>& around, bool has_mass, const BeamTerms& terms,
                       BeamColumns<G, S, N>& columns) {
  if (has_mass)
    for (int i = 0; i < N; ++i) columns.b[i] = weighed_slope(p[i], ports[i], around);
  for (int i = 0; i < N; ++i)
    if (i != beam_reference<N>) eval_node_columns<G, S, N>(b, ports, has_mass, terms, i, columns);
}

/// A blend over the nodes by the increment of the reference node, or of another without its factor shape[j].
template <class G, class S, int N>
typename G::template Map<S> section_column(const double* shape, const BeamColumns<G, S, N>& columns,
                                           typename G::template Map<S> RateSlopes<G, S>::*of, int j) {
  constexpr int r = beam_reference<N>, first = r == 0 ? 1 : 0;
  if (j != r) return columns.own[j].*of;
  auto sum = G::scaled(shape[first], columns.reference[first].*of);
  for (int i = first + 1; i < N; ++i)
    if (i != r) G::add_to(sum, shape[i], columns.reference[i].*of);
  return sum;
}

/// Derivatives of forces conjugate to d_i and of their sum over all nodes, by the nodes' increments.
template <class G, class S, int N>
struct BeamBlocks {
  typename G::template Matrix<S> by[N][N], sum_by[N];
};

/// Derivatives of the forces of a strain point, T^T n by the node's slope and A^T n by its value, by d and y = dd/ds
/// there.
template <class G, class S>
struct StrainBlocks {
  typename G::template Matrix<S> slope_d, slope_y, shape_d, shape_y;
};
/// Adds w (N_i' s_j + N_i h_j), s_j = N_j slope_d + N_j' slope_y and h_j the same of the others, to the derivatives
/// of p_i by d_j.
template <class G, class S, int N>
void spread(const ShapeRule<N, N - 1>& rule, int point, const StrainBlocks<G, S>& s,
            typename G::template Matrix<S> (&by_d)[N][N]) {
  constexpr int r = beam_reference<N>;
  const double *shape = rule.shape[point], *slope = rule.slope[point], w = rule.weight[point];
  for (int j = 0; j < N; ++j) {
    if (j == r) continue;
    typename G::template Matrix<S> by_slope = shape[j] * s.slope_d, by_shape = shape[j] * s.shape_d;
    add_scaled_to(by_slope, slope[j], s.slope_y);
    add_scaled_to(by_shape, slope[j], s.shape_y);
    for (int i = 0; i < N; ++i) {
      if (i == r) continue;
      add_scaled_to(by_d[i][j], w * slope[i], by_slope);
      add_scaled_to(by_d[i][j], w * shape[i], by_shape);
    }
  }
}

/// Elasticity and damping at one strain point.
template <class G, class S, int N, class C>
void add_strain_point(const BeamOn<G, N, C>& beam, const BeamRates<G, S, N>& b, bool viscous,
                      const ShapeRule<N, N - 1>& rule, int point, typename G::template Matrix<S> (&by_d)[N][N],
                      typename G::template Matrix<S> (&by_rate)[N][N]) {
  using Block = typename G::template Matrix<S>;
  const C inverse = 1.0 / beam.length;
  StrainPoint<G, S> s;
  eval_strain_point<G, S, N, C>(beam, b, viscous, rule, point, s);
  const auto T = matrix(s.T);
  const auto& A = s.bending;
  const auto by_force = transpose_jacobian(s.T, s.n);
  const typename G::template Matrix<C> K = inverse * beam.stiffness;
  Block n_d = G::block_product(K, A), n_y = G::block_product(K, T);
  if (viscous) {
    const typename G::template Matrix<C> D = inverse * beam.damping;
    G::add_block_product(n_d, D, G::plus(jacobian(s.T, s.y1), second_jacobian(s.T, s.d1, s.y)));
    G::add_block_product(n_y, D, slope_matrix(s.T, s.d1));
    const Block n_d1 = G::block_product(D, A), n_y1 = G::block_product(D, T);
    const StrainBlocks<G, S> rates{G::transposed_product(T, n_d1), G::transposed_product(T, n_y1),
                                   G::transposed_product(A, n_d1), G::transposed_product(A, n_y1)};
    spread<G, S, N>(rule, point, rates, by_rate);
  }
  StrainBlocks<G, S> blocks{G::transposed_product(T, n_d), G::transposed_product(T, n_y), G::transposed_product(A, n_d),
                            G::transposed_product(A, n_y)};
  G::add_wrench_map(blocks.slope_d, by_force);
  G::add_wrench_map(blocks.shape_d, hessian(s.T, s.n, s.y));
  G::add_wrench_map(blocks.shape_y, G::transposed(by_force));
  spread<G, S, N>(rule, point, blocks, by_d);
}

/// Elasticity and damping.
template <class G, class S, int N, class C>
void eval_internal_blocks(const BeamOn<G, N, C>& beam, const BeamRates<G, S, N>& b, bool viscous,
                          const BeamColumns<G, S, N>& columns, BeamBlocks<G, S, N>& out) {
  using Block = typename G::template Matrix<S>;
  constexpr int r = beam_reference<N>;
  const auto& rule = strain_rule<N>();
  Block by_d[N][N], by_rate[N][N];
  for (int i = 0; i < N; ++i)
    for (int j = 0; j < N; ++j) {
      by_d[i][j] = Block::zero();
      if (viscous) by_rate[i][j] = Block::zero();
    }
  for (int g = 0; g < N - 1; ++g) add_strain_point<G, S, N, C>(beam, b, viscous, rule, g, by_d, by_rate);
  for (int i = 0; i < N; ++i)
    for (int j = 0; j < N; ++j) {
      if (i == r) continue;
      Block& x = out.by[i][j] = Block::zero();
      for (int k = 0; k < N; ++k) {
        if (k == r || (j != r && j != k)) continue;
        const RateSlopes<G, S>& column = j == r ? columns.reference[k] : columns.own[k];
        G::add_block_product(x, by_d[i][k], column.d);
        if (viscous) G::add_block_product(x, by_rate[i][k], column.rate);
      }
    }
}
/// Derivative of the sum over all nodes, sum_i ad(d_i)^T p_i.
template <class G, class S, int N>
void sum_internal_blocks(const BeamRates<G, S, N>& b, const typename G::template Wrench<S>* p,
                         const BeamColumns<G, S, N>& columns, BeamBlocks<G, S, N>& out) {
  constexpr int r = beam_reference<N>;
  for (int j = 0; j < N; ++j) {
    out.sum_by[j] = G::template Matrix<S>::zero();
    for (int i = 0; i < N; ++i) {
      if (i == r) continue;
      G::add_ad_transposed(out.sum_by[j], b.d[i], out.by[i][j]);
      if (j == i || j == r)
        G::add_wrench_product(out.sum_by[j], G::hat(p[i]), j == r ? columns.reference[i].d : columns.own[i].d);
    }
  }
}

/// Inertia and gravity at a mass point:  dv = dv_r + T dz + J(z) dd,  db = db_r + T dz' + T' dz + J(z) dd' + (J(z') +
/// J'(z)) dd, where again dd' = dz - ad(v_r) dd + ad(d) dv_r.
template <class G, class S, int N, class C>
void add_mass_point(const BeamOn<G, N, C>& beam, const BeamRates<G, S, N>& b, const PortSlopesOn<G, S>* ports,
                    const ShapeRule<N, N>& rule, int point, const MassPoint<G, S>& m, const BeamTerms& terms,
                    const BeamColumns<G, S, N>& columns, BeamBlocks<G, S, N>& out) {
  using Rates = RateSlopes<G, S>;
  constexpr int r = beam_reference<N>;
  const double* shape = rule.shape[point];
  const auto T = matrix(m.T);
  const typename G::template Matrix<C> mass = C(rule.weight[point] * beam.length) * beam.mass;
  typename G::template BracketMap<S> J, by_z, by_d;
  typename G::template WrenchMap<S> by_f;
  typename G::template Matrix<S> f_v;
  if (terms.moves) {
    by_f = transpose_jacobian(m.T, m.f);
    by_d = jacobian(m.T, m.zz);
  }
  if (terms.rates) {
    J = jacobian(m.T, m.z);
    by_z = G::plus(J, slope_matrix(m.T, m.rate));
    by_d = G::plus(by_d, second_jacobian(m.T, m.rate, m.z));
    G::subtract_times_ad(by_d, J, b.v);
    f_v = G::gyroscopic(mass, m.v);
  }
  for (int j = 0; j < N; ++j) {
    const double factor = j == r ? 1.0 : shape[j];  // blocks of other nodes omit the factor, which is applied at the
                                                    // end
    auto a = G::product(T, section_column<G, S, N>(shape, columns, &Rates::zz, j));
    if (j == r) a = G::plus(a, columns.b[r]);
    typename G::template Map<S> d;
    if (terms.moves) {
      d = section_column<G, S, N>(shape, columns, &Rates::d, j);
      G::add_product(a, by_d, d);
    }
    typename G::template Matrix<S> f;
    if (terms.rates) {
      const auto z = section_column<G, S, N>(shape, columns, &Rates::z, j);
      G::add_product(a, by_z, z);
      auto v = G::product(T, z);
      G::add_product(v, J, d);
      if (j == r) {
        v = G::plus(v, ports[r].velocity);
        G::add_product(a, J, G::product(G::ad(m.T.d), ports[r].velocity));
      }
      f = G::block_product(f_v, v);
      G::add_block_product(f, mass, a);
    } else {
      f = G::block_product(mass, a);
    }
    auto q = G::transposed_product(T, f);
    if (terms.moves) G::add_wrench_product(q, by_f, d);
    for (int i = 0; i < N; ++i)
      if (i != r) add_scaled_to(out.by[i][j], shape[i] * factor, q);
    add_scaled_to(out.sum_by[j], factor, f);
  }
}

/// From forces conjugate to d_i to the nodes:  F_i = U_i^T p_i,  F_r = sum - sum_i F_i, as put(i, j, block).
template <class G, class S, int N, class Put>
void carry_to_nodes(const BeamRates<G, S, N>& b, bool moves, const typename G::template Wrench<S>* p,
                    const BeamColumns<G, S, N>& columns, BeamBlocks<G, S, N>& blocks, const Put& put) {
  constexpr int r = beam_reference<N>;
  for (int i = 0; i < N; ++i) {
    if (i == r) continue;
    const auto U = matrix(b.inverse[i]);
    typename G::template WrenchMap<S> by_force;
    if (moves) by_force = transpose_jacobian(b.inverse[i], p[i]);
    for (int j = 0; j < N; ++j) {
      auto f = G::transposed_product(U, blocks.by[i][j]);
      if (moves && j == i) G::add_wrench_product(f, by_force, columns.own[i].d);
      if (moves && j == r) G::add_wrench_product(f, by_force, columns.reference[i].d);
      put(i, j, f);
      add_scaled_to(blocks.sum_by[j], -1.0, f);
    }
  }
  for (int j = 0; j < N; ++j) put(r, j, blocks.sum_by[j]);
}

/// Sets all derivatives to zero.
template <class G, class S, int N>
void clear(BeamBlocks<G, S, N>& blocks) {
  for (int j = 0; j < N; ++j) {
    blocks.sum_by[j] = G::template Matrix<S>::zero();
    for (int i = 0; i < N; ++i) blocks.by[i][j] = G::template Matrix<S>::zero();
  }
}

/// Residual of a beam, the bits of eval_residual, and its derivative by the ports' increments as put(i, j, block).
template <class G, class S, int N, class C, class Put>
requires(N > 2) void eval_tangent(const BeamOn<G, N, C>& beam, const PortMotionOn<G, S>* p,
                                  const PortSlopesOn<G, S>* ports, const SurroundingsOn<G, S>& around, S* residual,
                                  const Put& put) {
  const BeamTerms terms(beam, ports[0].moves, around.has_inertia);
  BeamRates<G, S, N> b;
  eval_beam_rates<G, S, N>(p, around, beam.has_mass, beam.has_damping, b);
  BeamColumns<G, S, N> columns;
  eval_beam_columns<G, S, N>(b, p, ports, around, beam.has_mass, terms, columns);
  BeamBlocks<G, S, N> blocks;
  typename G::template Wrench<S> force[N];
  eval_internal_forces<G, S, N, C>(beam, b, around.has_inertia && beam.has_damping, force);
  auto sum = sum_relative_forces<G, S, N>(b, force);
  if (terms.moves) {
    eval_internal_blocks<G, S, N, C>(beam, b, terms.viscous, columns, blocks);
    sum_internal_blocks<G, S, N>(b, force, columns, blocks);
  } else {
    clear<G, S, N>(blocks);
  }
  if (beam.has_mass) {
    const auto& rule = mass_rule<N>();
    for (int g = 0; g < N; ++g) {
      MassPoint<G, S> m;
      eval_mass_point<G, S, N, C>(beam, b, around.has_inertia, rule, g, m);
      add_mass_forces<G, S, N>(rule.shape[g], m, force, sum);
      add_mass_point<G, S, N, C>(beam, b, ports, rule, g, m, terms, columns, blocks);
    }
  }
  eval_nodal_wrenches<G, S, N>(b, force, sum, residual);
  carry_to_nodes<G, S, N>(b, terms.moves, force, columns, blocks, put);
}

/// As above for a line load. A dead load turns against the section, which moves by eta_r + T (dd - ad(d) eta_r).
template <class G, class S, int N, class C, class Put>
void eval_tangent(const LineLoadOn<G, N, C>& load, const PortMotionOn<G, S>* p, const PortSlopesOn<G, S>* ports,
                  const SurroundingsOn<G, S>& around, S* residual, const Put& put) {
  constexpr int r = beam_reference<N>;
  const bool moves = ports[0].moves;
  BeamRates<G, S, N> b;
  eval_relative_motions<G, S, N>(p, b);
  BeamColumns<G, S, N> columns;
  eval_beam_columns<G, S, N>(b, p, ports, around, false, {moves, false, false}, columns);
  BeamBlocks<G, S, N> blocks;
  clear<G, S, N>(blocks);
  const auto zero = G::wrench(G::template Vector<S>::zero());
  typename G::template Wrench<S> force[N], sum = zero;
  for (int i = 0; i < N; ++i) force[i] = zero;
  const auto& rule = mass_rule<N>();
  for (int g = 0; g < N; ++g) {
    const double* shape = rule.shape[g];
    const auto at = motion::eval_tangent_operator<G, S>(blend<G, S, N>(shape, b.d));
    const auto f = eval_load<G, S, N, C>(load, p[r], at, around, rule, g);
    const auto q = transpose_times(at, f);
    for (int i = 0; i < N; ++i)
      if (i != r) force[i] = G::add(force[i], shape[i], q);
    sum = sum + f;
    if (!moves) continue;
    const auto T = matrix(at);
    const auto by_f = transpose_jacobian(at, f);
    for (int j = 0; j < N; ++j) {
      const double factor = j == r ? 1.0 : shape[j];
      const auto d = section_column<G, S, N>(shape, columns, &RateSlopes<G, S>::d, j);
      auto f_j = G::template Matrix<S>::zero();
      if (!load.follows) {
        auto section = G::product(T, d);
        if (j == r) section = G::with_diagonal(G::minus(section, G::product(T, G::as_map(G::ad(at.d)))), 1.0);
        G::add_turning_product(f_j, f, section);
      }
      auto q_j = G::transposed_product(T, f_j);
      G::add_wrench_product(q_j, by_f, d);
      for (int i = 0; i < N; ++i)
        if (i != r) add_scaled_to(blocks.by[i][j], shape[i] * factor, q_j);
      add_scaled_to(blocks.sum_by[j], factor, f_j);
    }
  }
  eval_nodal_wrenches<G, S, N>(b, force, sum, residual);
  carry_to_nodes<G, S, N>(b, moves, force, columns, blocks, put);
}

}  // namespace bough::elements
