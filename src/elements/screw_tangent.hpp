#pragma once
/// Tangent of the two-node beam (elements/screw_beam.hpp). Odd and even parts of every operator serve both Gauss
/// points. Derivation: beams.md, "Tangent".
#include "beam_terms.hpp"
#include "bough/elements/screw_beam.hpp"

namespace bough::elements {

/// An operator at the Gauss points: odd -+ even.
template <class T>
struct OddEven {
  T odd, even;
};

/// How d follows the nodes' increments, dd = by_node[0] eta_r + by_node[1] eta_1, and how d' = T(d)^-1 w + ad(d) v_r
/// follows d.
template <class G, class S>
struct ScrewColumns {
  typename G::template Map<S> by_node[2];  ///< ad(d) - U and U = T(d)^-1
  typename G::template BracketMap<S> rate_by_d;
};
template <class G, class S>
BOUGH_INLINE void eval_screw_columns(const ScrewRates<G, S>& r, const BeamTerms& terms, ScrewColumns<G, S>& columns) {
  const auto& d = r.inverse.d;
  columns.by_node[1] = matrix(r.inverse);
  columns.by_node[0] = G::minus(G::ad(d), columns.by_node[1]);
  if (!terms.rates) return;
  const auto w2 = G::bracket(d, r.w1);
  const auto axis = G::add(r.v + G::scaled(0.5, r.w), r.inverse.q, r.w1);
  columns.rate_by_d = G::ad(-axis);
  G::add_second(columns.rate_by_d, G::times(G::twice(r.inverse.dq), w2), d, G::times(r.inverse.q, r.w));
}

/// Operators on a section, all at one d.
template <class G, class S>
struct ScrewSlopes {
  OddEven<typename G::template Map<S>> P;
  OddEven<typename G::template BracketMap<S>> rate;    ///< the derivative of P along d'
  OddEven<typename G::template BracketMap<S>> by_d;    ///< d(P w)/dd
  OddEven<typename G::template BracketMap<S>> b_by_d;  ///< d(P c + P' w)/dd, twists of the nodes held
  typename G::template Motion<S> odd_axis;             ///< p d: the odd part of P is 1/2 + ad of it
};
template <class G, class S>
BOUGH_INLINE void eval_screw_slopes(const ScrewBlend<G, S>& f, const ScrewRates<G, S>& r,
                                    const ScrewColumns<G, S>& columns, const BeamTerms& terms, ScrewSlopes<G, S>& m) {
  const auto &d = r.inverse.d, &e = r.rate;
  m.odd_axis = G::times(f.p, d);
  m.P.odd = G::with_diagonal(G::ad(m.odd_axis), 0.5);
  auto even = G::template BracketMap<S>::zero();
  G::add_pair(even, G::times(f.q, d), d);
  m.P.even = G::with_diagonal(even, motion::gauss_offset);
  if (!terms.moves) return;
  auto &odd = m.b_by_d.odd, &second = m.b_by_d.even;
  const auto c1 = G::bracket(d, r.c);
  if (!terms.rates) {
    odd = G::ad(-G::times(f.p, r.c));
    G::add_polar(odd, G::times(G::twice(f.dp), c1), d);
    second = G::ad(-G::times(f.q, c1));
    G::add_second(second, G::times(G::twice(f.dq), G::bracket(d, c1)), d, G::times(f.q, r.c));
    return;
  }
  const auto s = G::twice(G::pairing(d, e)), s_dp = s * f.dp, s_dq = s * f.dq;
  const auto w2 = G::bracket(d, r.w1), a1 = G::add_bracket(c1, e, r.w);
  const auto p_w1 = G::times(G::twice(f.dp), r.w1), q_w1 = G::times(f.q, r.w1), q_w2 = G::times(G::twice(f.dq), w2);
  const auto q_w = G::times(f.q, r.w), qe = G::times(f.q, e);
  m.by_d.odd = G::ad(-G::times(f.p, r.w));
  G::add_polar(m.by_d.odd, p_w1, d);
  m.by_d.even = G::ad(-q_w1);
  G::add_second(m.by_d.even, q_w2, d, q_w);
  m.rate.odd = G::ad(G::add(G::times(f.p, e), s_dp, d));
  m.rate.even = G::template BracketMap<S>::zero();
  G::add_pair(m.rate.even, d, G::add(qe, s_dq, d));
  G::add_pair(m.rate.even, qe, d);
  odd = G::ad(-G::add(G::times(f.p, r.c), s_dp, r.w));
  G::add_polar(odd, G::add(G::times(G::twice(f.dp), a1), G::twice(s * f.ddp), r.w1), d);
  G::add_polar(odd, p_w1, e);
  second = G::ad(-G::add(G::times(f.q, a1), s_dq, r.w1));
  const auto left = G::bracket(d, G::add(G::times(G::twice(f.dq), a1), G::twice(s * f.ddq), r.w1));
  G::add_second(second, G::add_bracket(left, e, G::times(G::twice(f.dq), r.w1)), d,
                G::add(G::times(f.q, r.c), s_dq, r.w));
  G::add_second(second, q_w2, e, q_w);
  G::add_product(odd, m.by_d.odd, columns.rate_by_d);
  G::add_product(second, m.by_d.even, columns.rate_by_d);
}

/// Derivatives of the wrench on node 1 and of the sum over both nodes, by the increments of the nodes.
template <class G, class S>
struct ScrewBlocks {
  typename G::template Matrix<S> first[2], sum[2];
};

/// Adds those of inertia and gravity by the increment of node j, the reference or the other.
template <class G, class S, class C>
BOUGH_INLINE void add_gauss_blocks(const typename G::template Matrix<C>& mass,
                                   const typename G::template Matrix<S>* f_v, const ScrewSlopes<G, S>& m,
                                   const typename G::template Map<S>& d, const typename G::template Map<S>& velocity,
                                   const typename G::template Map<S>& b, int j, const BeamTerms& terms,
                                   ScrewBlocks<G, S>& blocks) {
  using Map = typename G::template Map<S>;
  using Block = typename G::template Matrix<S>;
  OddEven<Map> a{G::product(m.P.odd, b), G::product(m.P.even, b)}, v;
  if (terms.rates) v = {G::product(m.P.odd, velocity), G::product(m.P.even, velocity)};
  if (j == 0) {  // the reference's share of P is 1 - P
    a = {G::minus(b, a.odd), G::negated(a.even)};
    if (terms.rates) v = {G::minus(velocity, v.odd), G::negated(v.even)};
  }
  if (terms.rates) {
    // P' dw + d(P w)/dd applied to the part T(d)^-1 dw + ad(d) dv_r of d', which is d times dv
    const double sign = j == 0 ? -1.0 : 1.0;
    auto turned = G::product(m.by_d.odd, d);
    G::add_to(v.odd, 1.0, turned);
    G::add_to(turned, sign, m.rate.odd);
    G::add_product(a.odd, turned, velocity);
    turned = G::product(m.by_d.even, d);
    G::add_to(v.even, 1.0, turned);
    G::add_to(turned, sign, m.rate.even);
    G::add_product(a.even, turned, velocity);
  }
  if (terms.moves) {
    G::add_product(a.odd, m.b_by_d.odd, d);
    G::add_product(a.even, m.b_by_d.even, d);
  }
  Block at[2] = {G::block_product(mass, G::minus(a.odd, a.even)), G::block_product(mass, G::plus(a.odd, a.even))};
  if (terms.rates) {
    G::add_block_product(at[0], f_v[0], G::minus(v.odd, v.even));
    G::add_block_product(at[1], f_v[1], G::plus(v.odd, v.even));
  }
  const Block both = at[0] + at[1], difference = at[1] - at[0];
  blocks.sum[j] += both;
  blocks.first[j] += G::transposed_product(m.P.even, difference);
  add_scaled_to(blocks.first[j], 0.5, both);
  G::add_ad_transposed(blocks.first[j], m.odd_axis, both);
}

/// Those of elasticity and damping, n held where it turns with the nodes: U^T dn and ad(d)^T dn + hat(n) dd.
template <class G, class S, class C>
BOUGH_INLINE void eval_elastic_blocks(const BeamOn<G, 2, C>& e, const ScrewRates<G, S>& r,
                                      const typename G::template Wrench<S>& n, const ScrewColumns<G, S>& columns,
                                      const PortSlopesOn<G, S>* ports, const BeamTerms& terms,
                                      ScrewBlocks<G, S>& blocks) {
  const C inverse = inverse_length(e);
  const typename G::template Matrix<C> K = inverse * e.stiffness;
  const auto n_hat = G::hat(n);
  for (int j = 0; j < 2; ++j) {
    auto by = G::block_product(K, columns.by_node[j]);
    if (terms.viscous) {
      auto rate = G::product(columns.by_node[j], ports[j].velocity);
      G::add_product(rate, columns.rate_by_d, columns.by_node[j]);
      G::add_block_product(by, typename G::template Matrix<C>(inverse * e.damping), rate);
    }
    blocks.first[j] = G::transposed_product(columns.by_node[1], by);
    blocks.sum[j] = G::template Matrix<S>::zero();
    G::add_ad_transposed(blocks.sum[j], r.inverse.d, by);
    G::add_wrench_product(blocks.sum[j], n_hat, columns.by_node[j]);
  }
}

/// Forces on the nodes, F_1 = first + D^T inner and F_r = sum - F_1, put together term by term. The derivative of F_1
/// by d, forces held, is hat(inner + n/2) + 2 (D^T slope) <d, .> + D^T hat(pair).
template <class G, class S>
struct ScrewForces {
  typename G::template Wrench<S> first, sum, inner, slope, pair;
};
/// Those of elasticity and damping.
template <class G, class S>
BOUGH_INLINE void begin_screw_forces(const ScrewRates<G, S>& r, const typename G::template Wrench<S>& n,
                                     ScrewForces<G, S>& f) {
  f.sum = G::dual_bracket(r.inverse.d, n);
  f.inner = G::times(r.inverse.q, f.sum);
  f.first = G::add(n, 0.5, f.sum);
  f.slope = G::times(r.inverse.dq, f.sum);
  f.pair = G::times(r.inverse.q, n);
}
/// Adds those of inertia and gravity.
template <class G, class S>
BOUGH_INLINE void add_gauss_forces(const ScrewBlend<G, S>& b, const ScrewRates<G, S>& r, const GaussPair<G, S>& g,
                                   ScrewForces<G, S>& f) {
  const auto& d = r.inverse.d;
  f.inner = G::add(G::add_dual_bracket(f.inner, d, G::times(b.q, g.difference)), b.p, g.sum);
  f.first = G::add(G::add(f.first, 0.5, g.sum), motion::gauss_offset, g.difference);
  f.sum = f.sum + g.sum;
  f.slope = G::add(G::add(f.slope, b.dq, G::dual_bracket(d, g.difference)), b.dp, g.sum);
  f.pair = G::add(f.pair, b.q, g.difference);
}

/// Columns of d, and blocks of elasticity and damping.
template <class G, class S, class C>
BOUGH_INLINE void begin_screw_blocks(const BeamOn<G, 2, C>& e, const ScrewRates<G, S>& r,
                                     const typename G::template Wrench<S>& n, const PortSlopesOn<G, S>* ports,
                                     const BeamTerms& terms, ScrewColumns<G, S>& columns, ScrewBlocks<G, S>& blocks) {
  if (terms.moves) {
    eval_screw_columns<G, S>(r, terms, columns);
    eval_elastic_blocks<G, S, C>(e, r, n, columns, ports, terms, blocks);
  } else {
    for (int j = 0; j < 2; ++j) blocks.first[j] = blocks.sum[j] = G::template Matrix<S>::zero();
  }
}
template <class G, class S, class Put>
BOUGH_INLINE void finish_screw(const ScrewRates<G, S>& r, const typename G::template Wrench<S>& n,
                               const ScrewForces<G, S>& f, const BeamTerms& terms, const ScrewColumns<G, S>& columns,
                               ScrewBlocks<G, S>& blocks, S* residual, const Put& put) {
  const auto& d = r.inverse.d;
  auto by_d = G::hat(G::add(f.inner, 0.5, n));
  G::add_dual_second(by_d, G::dual_bracket(d, f.slope + f.slope), d, f.pair);
  const auto first = G::add_dual_bracket(f.first, d, f.inner);
  G::put(first, residual + G::dof);
  G::put(f.sum - first, residual);
  for (int j = 0; j < 2; ++j) {
    if (terms.moves) G::add_wrench_product(blocks.first[j], by_d, columns.by_node[j]);
    put(1, j, blocks.first[j]);
    subtract_from(blocks.sum[j], blocks.first[j]);
    put(0, j, blocks.first[j]);
  }
}

/// Residual, the bits of eval_residual, and its derivative by the ports' increments as put(i, j, block).
template <class G, class S, class C, class Put>
BOUGH_INLINE void eval_tangent(const BeamOn<G, 2, C>& beam, const PortMotionOn<G, S>* p,
                               const PortSlopesOn<G, S>* ports, const SurroundingsOn<G, S>& around, S* residual,
                               const Put& put) {
  using Block = typename G::template Matrix<S>;
  const BeamTerms terms(beam, ports[0].moves, around.has_inertia);
  ScrewRates<G, S> r;
  eval_screw_rates<G, S>(p, around, beam.has_mass, around.has_inertia && (beam.has_mass || beam.has_damping), r);
  const auto n = eval_screw_resultant<G, S>(beam, r, around.has_inertia && beam.has_damping);
  ScrewForces<G, S> forces;
  begin_screw_forces<G, S>(r, n, forces);
  ScrewColumns<G, S> columns;
  ScrewBlocks<G, S> blocks;
  begin_screw_blocks<G, S, C>(beam, r, n, ports, terms, columns, blocks);
  if (beam.has_mass) {
    const typename G::template Matrix<C> mass = C(0.5 * beam.length) * beam.mass;
    const ScrewBlend<G, S> f = motion::eval_screw_blend<G, S>(r.inverse.d);
    GaussPair<G, S> g;
    eval_gauss_forces<G, S, C>(mass, f, r, around.has_inertia, g);
    add_gauss_forces<G, S>(f, r, g, forces);
    ScrewSlopes<G, S> slopes;
    eval_screw_slopes<G, S>(f, r, columns, terms, slopes);
    Block f_v[2];
    if (terms.rates)
      for (int k = 0; k < 2; ++k) f_v[k] = G::gyroscopic(mass, g.v[k]);
    for (int j = 0; j < 2; ++j)
      add_gauss_blocks<G, S, C>(mass, f_v, slopes, columns.by_node[j], ports[j].velocity,
                                weighed_slope(p[j], ports[j], around), j, terms, blocks);
  }
  finish_screw<G, S>(r, n, forces, terms, columns, blocks, residual, put);
}

}  // namespace bough::elements
