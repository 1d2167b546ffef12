#pragma once
/// Operators f(D) = I + p D + q D^2 of D = ad(d) on any group of group.hpp, with their derivatives by d up to the
/// second: the tangent operator T(d) and its inverse. Since D^3 = -X D every analytic function of D has this form,
/// with p and q functions of X = <d, d>:
///   T(d) = (1 - exp(-D)) / D:  p = -c_2(X), q = c_3(X);        T(d)^-1:  p = 1/2, q = k(X)        (coefficients.hpp)
/// exp(d)^-1 (d/dt) exp(d) = T(d) d'. All derivatives follow from dX[e] = 2 <d, e> and dD[e] = E, with E = ad(e) and a
/// prime for derivatives by X.
#include "bough/motion/group.hpp"
#include "bough/motion/operators_translations.hpp"

namespace bough::motion {

/// T(d). Once a call is inlined, the compiler removes the members that are not used.
template <class G, class S>
struct Tangent {
  typename G::template Motion<S> d;
  typename G::template Number<S> p, q, dp, dq, ddp, ddq;
};
/// T(d)^-1, at rotations below 2 pi.
template <class G, class S>
struct InverseTangent {
  typename G::template Motion<S> d;
  typename G::template Number<S> q, dq, ddq;
};

template <class G, class S>
requires(G::turns) BOUGH_INLINE Tangent<G, S> eval_tangent_operator(const typename G::template Motion<S>& d) {
  using L = Literal<S>;
  const typename G::template Number<S> X = G::square(d);
  const S x = G::real(X);
  const lanes::Vec<S, 8> c = eval_stumpff(x);
  const S p = -c[2], dp = L(0.5) * c[3] - c[4], ddp = L(-0.25) * (c[4] - L(5) * c[5]) - L(2) * c[6];
  const S dq = L(0.5) * (L(3) * c[5] - c[4]), ddq = L(0.25) * (c[5] - L(7) * c[6] + L(15) * c[7]);
  Tangent<G, S> f;
  f.d = d;
  f.p = G::number(X, p, dp);
  f.q = G::number(X, S(c[3]), dq);
  f.dp = G::number(X, dp, ddp);
  f.dq = G::number(X, dq, ddq);
  if constexpr (G::numbers_have_slopes) {
    const lanes::Vec<S, 2> last = eval_last_stumpff(x, c);
    const S dddp = L(0.125) * (L(33) * c[7] - L(9) * c[6] + c[5]) - L(6) * last[0];
    const S dddq = L(0.125) * (L(12) * c[7] - c[6] - L(57) * last[0] + L(105) * last[1]);
    f.ddp = G::number(X, ddp, dddp);
    f.ddq = G::number(X, ddq, dddq);
  } else {
    f.ddp = ddp;
    f.ddq = ddq;
  }
  return f;
}
template <class G, class S>
BOUGH_INLINE InverseTangent<G, S> inverse_tangent_from(const typename G::template Motion<S>& d,
                                                       const typename G::template Number<S>& X,
                                                       const InverseCoefficients<S>& k) {
  InverseTangent<G, S> f;
  f.d = d;
  f.q = G::number(X, k.k, k.dk);
  f.dq = G::number(X, k.dk, k.ddk);
  f.ddq = G::number(X, k.ddk, k.dddk);
  return f;
}
template <class G, class S>
requires(G::turns)
    BOUGH_INLINE InverseTangent<G, S> eval_inverse_tangent_operator(const typename G::template Motion<S>& d) {
  const typename G::template Number<S> X = G::square(d);
  return inverse_tangent_from<G, S>(d, X, eval_inverse_coefficients(S(G::real(X))));
}
/// T(d)^-1 at d = log(H).
template <class G, class S>
BOUGH_INLINE InverseTangent<G, S> eval_log(const typename G::template Pose<S>& H) {
  typename G::template Motion<S> d;
  typename G::template Number<S> X;
  const auto k = G::log(H, d, X);
  return inverse_tangent_from<G, S>(d, X, k);
}

namespace detail {
// The odd part of either operator, p w and r + p w; p = 1/2 for the inverse.
template <class G, class S, class W>
BOUGH_INLINE W odd_part(const Tangent<G, S>& f, const W& w) {
  return G::times(f.p, w);
}
template <class G, class S, class W>
BOUGH_INLINE W odd_part(const InverseTangent<G, S>&, const W& w) {
  return G::scaled(0.5, w);
}
template <class R, class G, class S, class W>
BOUGH_INLINE R add_odd_part(const R& r, const Tangent<G, S>& f, const W& w) {
  return G::add(r, f.p, w);
}
template <class R, class G, class S, class W>
BOUGH_INLINE R add_odd_part(const R& r, const InverseTangent<G, S>&, const W& w) {
  return G::add(r, 0.5, w);
}
/// p' w1 + q' w2 for two vectors of one kind; p' = 0 for the inverse.
template <class G, class S, class W>
BOUGH_INLINE W slopes_of(const Tangent<G, S>& f, const W& w1, const W& w2) {
  return G::add(G::times(f.dp, w1), f.dq, w2);
}
template <class G, class S, class W>
BOUGH_INLINE W slopes_of(const InverseTangent<G, S>& f, const W&, const W& w2) {
  return G::times(f.dq, w2);
}
/// r + s p' w
template <class R, class G, class S, class N, class W>
BOUGH_INLINE R add_odd_slope(const R& r, const Tangent<G, S>& f, const N& s, const W& w) {
  return G::add(r, s * f.dp, w);
}
template <class R, class G, class S, class N, class W>
BOUGH_INLINE R add_odd_slope(const R& r, const InverseTangent<G, S>&, const N&, const W&) {
  return r;
}
/// r + s (p'' w1 + q'' w2)
template <class G, class S, class N, class W>
BOUGH_INLINE W add_second_slopes(const W& r, const Tangent<G, S>& f, const N& s, const W& w1, const W& w2) {
  return G::add(G::add(r, s * f.ddp, w1), s * f.ddq, w2);
}
template <class G, class S, class N, class W>
BOUGH_INLINE W add_second_slopes(const W& r, const InverseTangent<G, S>& f, const N& s, const W&, const W& w2) {
  return G::add(r, s * f.ddq, w2);
}
template <class W>
BOUGH_INLINE W doubled(const W& w) {
  return w + w;
}
}  // namespace detail

// The functions below take either operator F = Tangent or InverseTangent; y, e are motions, n a wrench.

/// f y
template <template <class, class> class F, class G, class S>
BOUGH_INLINE typename G::template Motion<S> times(const F<G, S>& f, const typename G::template Motion<S>& y) {
  const auto w = G::bracket(f.d, y);
  return G::add_bracket(detail::add_odd_part(y, f, w), f.d, G::times(f.q, w));
}
/// f^T n
template <template <class, class> class F, class G, class S>
BOUGH_INLINE typename G::template Wrench<S> transpose_times(const F<G, S>& f, const typename G::template Wrench<S>& n) {
  const auto w = G::dual_bracket(f.d, n);
  return G::add_dual_bracket(detail::add_odd_part(n, f, w), f.d, G::times(f.q, w));
}
/// f as a map.
template <template <class, class> class F, class G, class S>
BOUGH_INLINE typename G::template Map<S> matrix(const F<G, S>& f) {
  auto m = G::ad(detail::odd_part(f, f.d));
  G::add_pair(m, f.d, G::times(f.q, f.d));
  return G::with_diagonal(m, 1.0);
}
/// f'[e] y, f'[e] the derivative of f along e:
///   p E y + q (E D + D E) y + 2 <d, e> (p' D y + q' D^2 y)
template <template <class, class> class F, class G, class S>
BOUGH_INLINE typename G::template Bracket<S> slope_times(const F<G, S>& f, const typename G::template Motion<S>& e,
                                                         const typename G::template Motion<S>& y) {
  const auto s = G::twice(G::pairing(f.d, e));
  const auto w = G::bracket(f.d, y), ey = G::bracket(e, y);
  const auto inner = G::add(G::times(s * f.dq, w), f.q, ey);
  const auto r = detail::add_odd_slope(detail::odd_part(f, ey), f, s, w);
  return G::add_bracket(G::add_bracket(r, f.d, inner), e, G::times(f.q, w));
}
/// f'[e] as a map.
template <template <class, class> class F, class G, class S>
BOUGH_INLINE typename G::template BracketMap<S> slope_matrix(const F<G, S>& f,
                                                             const typename G::template Motion<S>& e) {
  const auto s = G::twice(G::pairing(f.d, e));
  const auto qe = G::times(f.q, e);
  auto m = G::ad(detail::add_odd_slope(detail::odd_part(f, e), f, s, f.d));
  G::add_pair(m, f.d, G::add(qe, s * f.dq, f.d));
  G::add_pair(m, qe, f.d);
  return m;
}
/// d(f y)/dd: e -> f'[e] y.
template <template <class, class> class F, class G, class S>
BOUGH_INLINE typename G::template BracketMap<S> jacobian(const F<G, S>& f, const typename G::template Motion<S>& y) {
  const auto w1 = G::bracket(f.d, y), w2 = G::bracket(f.d, w1);
  auto m = G::ad(-G::add(detail::odd_part(f, y), f.q, w1));
  G::add_second(m, detail::doubled(detail::slopes_of(f, w1, w2)), f.d, G::times(f.q, y));
  return m;
}
/// d(f'[e] y)/dd.
template <template <class, class> class F, class G, class S>
typename G::template BracketMap<S> second_jacobian(const F<G, S>& f, const typename G::template Motion<S>& e,
                                                   const typename G::template Motion<S>& y) {
  const auto s = G::twice(G::pairing(f.d, e));
  const auto s_dq = s * f.dq;
  const auto w1 = G::bracket(f.d, y), w2 = G::bracket(f.d, w1), ey = G::bracket(e, y);
  const auto turned = G::add_bracket(G::bracket(e, w1), f.d, ey);
  const auto left = detail::add_second_slopes(detail::slopes_of(f, ey, turned), f, s, w1, w2);
  auto axis = G::times(f.q, ey);
  axis = G::add(axis, s_dq, w1);
  auto m = G::ad(-detail::add_odd_slope(G::widened(axis), f, s, y));
  G::add_second(m, detail::doubled(left), f.d, G::times(s_dq, y));
  G::add_second(m, detail::doubled(detail::slopes_of(f, w1, w2)), e, G::times(f.q, y));
  return m;
}
/// d(f^T n)/dd.
template <template <class, class> class F, class G, class S>
typename G::template WrenchMap<S> transpose_jacobian(const F<G, S>& f, const typename G::template Wrench<S>& n) {
  const auto n1 = G::dual_bracket(f.d, n), n2 = G::dual_bracket(f.d, n1);
  auto m = G::hat(G::add(detail::odd_part(f, n), f.q, n1));
  G::add_dual_second(m, detail::doubled(detail::slopes_of(f, n1, n2)), f.d, G::times(f.q, n));
  return m;
}
/// d^2(n . T y)/dd^2, symmetric. With k = -ad(y)^T n and g = -ad(D y)^T n - ad(y)^T D^T n, the derivatives of n . D y
/// and n . D^2 y.
template <class G, class S>
typename G::template WrenchMap<S> hessian(const Tangent<G, S>& f, const typename G::template Wrench<S>& n,
                                          const typename G::template Motion<S>& y) {
  const auto w = G::bracket(f.d, y);
  const auto n1 = G::dual_bracket(f.d, n), k = -G::dual_bracket(y, n);
  const auto g = G::subtract_dual_bracket(-G::dual_bracket(w, n), y, n1);
  const auto once = G::power(n, w), twice = G::power(n1, w);  // n . D y, n . D^2 y
  const auto a = G::add_covector(detail::slopes_of(f, k, g), f.ddp * once + f.ddq * twice, f.d);
  auto m = G::template WrenchMap<S>::zero();
  G::add_symmetric_polar(m, detail::doubled(a), f.d);
  G::subtract_symmetric_pair(m, y, G::times(f.q, n));
  G::add_pairing(m, detail::doubled(f.dp * once + f.dq * twice));
  return m;
}

}  // namespace bough::motion

#include "bough/motion/operators_se2.hpp"  // overloads for SE(2), used there instead of the above
