#pragma once
/// Tangent of the inertia forces of a two-node beam (elements/screw_blend.hpp): odd and even parts of every operator serve both Gauss points.
#include "bough/elements/beam_forces.hpp"
#include "tangent_blocks.hpp"

namespace bough::elements {

/// d(p D y)/dd and d((t + q D^2) y)/dd.
template <class S>
DualMat<S> odd_jacobian(const ScrewBlend<S>& f, const DualVec<S>& y, const DualVec<S>& y1) {
  DualMat<S> m = motion::skew(-(f.p * y));
  add_outer(m, twice(f.dp * y1), f.d);
  return m;
}
template <class S>
DualMat<S> even_jacobian(const ScrewBlend<S>& f, const DualVec<S>& y, const DualVec<S>& y1, const DualVec<S>& y2) {
  DualMat<S> m = motion::skew(-(f.q * y1));
  add_outer(m, add_scaled(twice(f.dq * y2), -f.q, y), f.d);
  add_diagonal(m, f.q * dot(f.d, y));
  return m;
}

/// An operator at the Gauss points: odd -+ even.
template <class S>
struct OddEven {
  DualMat<S> odd, even;
};

/// Operators on a section, all at one d.
template <class S>
struct ScrewSlopes {
  OddEven<S> P, rate;   ///< P and its derivative along d'
  OddEven<S> by_d;      ///< d(P w)/dd
  OddEven<S> b_by_d;    ///< d(P c + P' w)/dd, twists of the nodes held
  DualVec<S> odd_axis;  ///< p d: the odd part of P is its cross product
};

template <class S>
void eval_screw_slopes(const ScrewBlend<S>& f, const BeamRates<S, 2>& b, bool moves, bool has_rates,
                       ScrewSlopes<S>& m) {
  const DualVec<S>&d = f.d, &w = b.w[1], &c = b.c[1], &e = b.rate[1];
  const Dual<S> zero{S(0.0), S(0.0)};
  m.odd_axis = f.p * d;
  m.P.odd = motion::skew(m.odd_axis);
  add_diagonal(m.P.odd, Dual<S>{S(0.5), S(0.0)});
  m.P.even = DualMat<S>::zero();
  add_outer(m.P.even, f.q * d, d);
  add_diagonal(m.P.even, Dual<S>{S(detail::gauss_offset), S(0.0)} - f.q * f.x);
  if (!moves) return;
  const DualVec<S> c1 = cross(d, c), c2 = cross(d, c1);
  m.b_by_d = {odd_jacobian(f, c, c1), even_jacobian(f, c, c1, c2)};
  if (!has_rates) return;
  const DualVec<S> w1 = cross(d, w), w2 = cross(d, w1), ew = cross(e, w), qe = f.q * e;
  const DualVec<S> turned = add_cross(cross(e, w1), d, ew);
  const Dual<S> s = twice(dot(d, e)), s_dp = s * f.dp, s_dq = s * f.dq;
  m.by_d = {odd_jacobian(f, w, w1), even_jacobian(f, w, w1, w2)};
  m.rate.odd = motion::skew(add_scaled(f.p * e, s_dp, d));
  m.rate.even = DualMat<S>::zero();
  add_outer(m.rate.even, add_scaled(qe, s_dq, d), d);
  add_outer(m.rate.even, d, qe);
  add_diagonal(m.rate.even, zero - s * f.q - s_dq * f.x);
  // derivatives of p' s w1 + p e x w and of q' s w2 + q (e x w1 + d x (e x w))
  DualMat<S>&odd = m.b_by_d.odd, &even = m.b_by_d.even;
  add_outer(odd, twice(add_scaled((s * f.ddp) * w1, f.dp, ew)), d);
  add_outer(odd, twice(f.dp * w1), e);
  odd = odd - motion::skew(s_dp * w);
  add_outer(even, add_scaled(twice(add_scaled((s * f.ddq) * w2, f.dq, turned)), -s_dq, w), d);
  add_outer(even, add_scaled(twice(f.dq * w2), -f.q, w), e);
  add_diagonal(even, s_dq * dot(d, w) + f.q * dot(e, w));
  even = even - motion::skew(add_scaled(s_dq * w1, f.q, ew));
  // d' = T(d)^-1 w + ad(d) v_r
  const DualMat<S> rate_by_d = jacobian(b.inverse[1], w) - motion::skew(b.v);
  add_product(odd, m.by_d.odd, rate_by_d);
  add_product(even, m.by_d.even, rate_by_d);
}

/// Derivative of the sum of P^T f by d, forces held.
template <class S>
DualMat<S> gauss_wrench_jacobian(const ScrewBlend<S>& f, const GaussPair<S>& g) {
  const DualVec<S> s1 = cross(f.d, g.sum), d1 = cross(f.d, g.difference), d2 = cross(f.d, d1);
  return even_jacobian(f, g.difference, d1, d2) - odd_jacobian(f, g.sum, s1);
}

/// How d and a node's own twist and acceleration (less the weight's) follow its increment. The reference's share of P is 1 - P.
template <class S>
struct ScrewColumn {
  DualMat<S> d, velocity, b;
  bool is_reference;
};

/// m = x - m and m = -m.
template <class S>
void subtract_from(const DualMat<S>& x, DualMat<S>& m) {
  for (int i = 0; i < 9; ++i) {
    m.a.m[i] = x.a.m[i] - m.a.m[i];
    m.b.m[i] = x.b.m[i] - m.b.m[i];
  }
}
template <class S>
void negate(DualMat<S>& m) {
  for (int i = 0; i < 9; ++i) {
    m.a.m[i] = -m.a.m[i];
    m.b.m[i] = -m.b.m[i];
  }
}

/// Adds the inertia's blocks by one node's increment: to the wrench on node 1 and to the sum over both nodes.
template <class S, class C>
void add_gauss_blocks(const Mat6<C>& mass, const Mat6<S>* f_v, const ScrewSlopes<S>& m, const ScrewColumn<S>& column,
                      bool moves, bool has_rates, Mat6<S>& first, Mat6<S>& sum) {
  OddEven<S> a{product(m.P.odd, column.b), product(m.P.even, column.b)}, v;
  if (moves && has_rates) v = {product(m.P.odd, column.velocity), product(m.P.even, column.velocity)};
  if (column.is_reference) {
    subtract_from(column.b, a.odd);
    negate(a.even);
    if (moves && has_rates) {
      subtract_from(column.velocity, v.odd);
      negate(v.even);
    }
  }
  if (moves && has_rates) {
    // P' dw + d(P w)/dd applied to the part T(d)^-1 dw + ad(d) dv_r of d', which is column.d times dv
    const double sign = column.is_reference ? -1.0 : 1.0;
    DualMat<S> turned = product(m.by_d.odd, column.d);
    add_scaled_to(v.odd, 1.0, turned);
    add_scaled_to(turned, sign, m.rate.odd);
    add_product(a.odd, turned, column.velocity);
    turned = product(m.by_d.even, column.d);
    add_scaled_to(v.even, 1.0, turned);
    add_scaled_to(turned, sign, m.rate.even);
    add_product(a.even, turned, column.velocity);
  }
  if (moves) {
    add_product(a.odd, m.b_by_d.odd, column.d);
    add_product(a.even, m.b_by_d.even, column.d);
  }
  Mat6<S> f[2];
  for (int g = 0; g < 2; ++g) {
    f[g] = motion_product(mass, g == 0 ? a.odd - a.even : a.odd + a.even);
    if (moves && has_rates) add_motion_product(f[g], f_v[g], g == 0 ? v.odd - v.even : v.odd + v.even);
  }
  Mat6<S> both, difference;
  for (int k = 0; k < 36; ++k) {
    both.m[k] = f[0].m[k] + f[1].m[k];
    difference.m[k] = f[1].m[k] - f[0].m[k];
    sum.m[k] = sum.m[k] + both.m[k];
  }
  first += transposed_product(m.P.even, difference);
  add_scaled_to(first, 0.5, both);
  add_cross_transposed(first, m.odd_axis, both);
}

}  // namespace bough::elements
