#pragma once
/// An operator f(psi) = I + p(x) ~psi + q(x) ~psi ~psi, x = psi.psi, of a dual vector psi + e u: T(d) or T(d)^-1 of a motion vector d,
/// with its derivatives up to the second. A function of x is dual through x: p(x + e s) = p + e s p', s = 2 psi.u; so values ask
/// for first derivatives of the coefficients, and second derivatives of the operator for third ones.
#include "bough/motion/dual.hpp"
#include "bough/motion/skew_series.hpp"

namespace bough::motion {

template <class S>
struct DualSeries {
  DualVec<S> psi;
  Dual<S> x, p, q, dp, dq, ddp, ddq;
};

namespace detail {
template <class S>
Dual<S> along(const S& value, const S& slope, const S& s) {
  return {value, slope * s};
}
}  // namespace detail

/// T(d), exp(d)^-1 D exp(d)[delta] = (T(d) delta)~.
template <class S>
DualSeries<S> dual_tangent(const DualVec<S>& d) {
  using L = Literal<S>;
  const S x = dot(d.a, d.a), half = dot(d.a, d.b), s = half + half;
  const lanes::Vec<S, 8> c = eval_stumpff(x);
  const lanes::Vec<S, 2> last = eval_last_stumpff(x, c);
  const S b = c[2], db = c[4] - L(0.5) * c[3], ddb = L(0.25) * (c[4] - L(5) * c[5]) + L(2) * c[6];
  const S dddb = L(6) * last[0] - L(0.125) * (L(33) * c[7] - L(9) * c[6] + c[5]);
  const S dc = L(0.5) * (L(3) * c[5] - c[4]), ddc = L(0.25) * (c[5] - L(7) * c[6] + L(15) * c[7]);
  const S dddc = L(0.125) * (L(12) * c[7] - c[6] - L(57) * last[0] + L(105) * last[1]);
  using detail::along;
  return {d,
          {x, s},
          -along(b, db, s),
          along(S(c[3]), dc, s),
          -along(db, ddb, s),
          along(dc, ddc, s),
          -along(ddb, dddb, s),
          along(ddc, dddc, s)};
}
/// T(d)^-1 from the coefficients at x = psi.psi.
template <class S>
DualSeries<S> dual_inverse_tangent(const DualVec<S>& d, const S& x, const InverseCoefficients<S>& k) {
  const S half = dot(d.a, d.b), s = half + half, o(0.0);
  using detail::along;
  return {d, {x, s}, {S(0.5), o}, along(k.k, k.dk, s), {o, o}, along(k.dk, k.ddk, s), {o, o}, along(k.ddk, k.dddk, s)};
}

/// f y; f^T n for a wrench n.
template <class S>
DualVec<S> times(const DualSeries<S>& f, const DualVec<S>& y) {
  const DualVec<S> w1 = cross(f.psi, y);
  return add_cross(add_scaled(y, f.p, w1), f.q * f.psi, w1);
}
template <class S>
DualVec<S> transpose_times(const DualSeries<S>& f, const DualVec<S>& n) {
  const DualVec<S> w1 = cross(f.psi, n);
  return add_cross(add_scaled(n, -f.p, w1), f.q * f.psi, w1);
}
/// D f(psi)[e] y, along the direction e.
template <class S>
DualVec<S> slope_times(const DualSeries<S>& f, const DualVec<S>& e, const DualVec<S>& y) {
  const Dual<S> sigma = twice(dot(f.psi, e));
  const DualVec<S> w1 = cross(f.psi, y), ey = cross(e, y);
  const DualVec<S> inner = add_scaled(add_scaled((sigma * f.dp) * y, sigma * f.dq, w1), f.q, ey);
  return add_cross(add_cross(f.p * ey, f.psi, inner), f.q * e, w1);
}

/// The operator as a matrix.
template <class S>
DualMat<S> matrix(const DualSeries<S>& f) {
  DualMat<S> m = skew(f.p * f.psi);
  add_outer(m, f.q * f.psi, f.psi);
  add_diagonal(m, Dual<S>{S(1.0), S(0.0)} - f.q * f.x);
  return m;
}
/// D f(psi)[e], a matrix: ~(p' s psi + p e) + (q' s psi + q e) psi^T + psi (q e)^T - s (q' x + q) I,  s = 2 psi.e.
template <class S>
DualMat<S> slope_matrix(const DualSeries<S>& f, const DualVec<S>& e) {
  const Dual<S> s = twice(dot(f.psi, e));
  const DualVec<S> qe = f.q * e;
  DualMat<S> m = skew(add_scaled(f.p * e, s * f.dp, f.psi));
  add_outer(m, add_scaled(qe, s * f.dq, f.psi), f.psi);
  add_outer(m, f.psi, qe);
  add_diagonal(m, -(s * (f.dq * f.x + f.q)));
  return m;
}
/// d(f y)/dpsi = (2 p' w1 + 2 q' w2 - q y) psi^T + q (psi.y) I - ~(p y + q w1),  w1 = psi x y,  w2 = psi x w1.
template <class S>
DualMat<S> jacobian(const DualSeries<S>& f, const DualVec<S>& y) {
  const DualVec<S> w1 = cross(f.psi, y), w2 = cross(f.psi, w1);
  DualMat<S> m = skew(-add_scaled(f.p * y, f.q, w1));
  add_outer(m, add_scaled(twice(add_scaled(f.dp * w1, f.dq, w2)), -f.q, y), f.psi);
  add_diagonal(m, f.q * dot(f.psi, y));
  return m;
}
/// d(f^T n)/dpsi for a wrench n: [0, A; A, B] as the dual matrix A + e B.
template <class S>
DualMat<S> transpose_jacobian(const DualSeries<S>& f, const DualVec<S>& n) {
  DualSeries<S> g = f;
  g.p = -f.p;
  g.dp = -f.dp;
  return jacobian(g, n);
}
/// d(D f(psi)[e] y)/dpsi.
template <class S>
DualMat<S> second_jacobian(const DualSeries<S>& f, const DualVec<S>& e, const DualVec<S>& y) {
  const Dual<S> s = twice(dot(f.psi, e)), s_dq = s * f.dq;
  const DualVec<S> w1 = cross(f.psi, y), w2 = cross(f.psi, w1), ey = cross(e, y);
  const DualVec<S> first = twice(add_scaled(f.dp * w1, f.dq, w2));
  const DualVec<S> left = add_scaled(
      add_scaled(add_scaled(f.dp * ey, f.dq, add_cross(cross(e, w1), f.psi, ey)), s * f.ddp, w1), s * f.ddq, w2);
  DualMat<S> m = skew(-add_scaled(add_scaled(f.q * ey, s * f.dp, y), s_dq, w1));
  add_outer(m, add_scaled(twice(left), -s_dq, y), f.psi);
  add_outer(m, add_scaled(first, -f.q, y), e);
  add_diagonal(m, f.q * dot(e, y) + s_dq * dot(f.psi, y));
  return m;
}
/// d^2(n . f y)/dpsi^2, symmetric, of a wrench n and a motion y: with k = y x n, b = (n.psi)(psi.y) - x n.y, g = db/dpsi,
///   n . f y = n.y + p psi.k + q b.
template <class S>
DualMat<S> hessian(const DualSeries<S>& f, const DualVec<S>& n, const DualVec<S>& y) {
  const Dual<S> ny = dot(n, y), n_psi = dot(n, f.psi), y_psi = dot(y, f.psi), b = n_psi * y_psi - f.x * ny;
  const DualVec<S> k = cross(y, n), g = add_scaled(add_scaled(y_psi * n, n_psi, y), -twice(ny), f.psi);
  const Dual<S> k_psi = dot(k, f.psi);
  const DualVec<S> a = twice(add_scaled(add_scaled(f.dp * k, f.dq, g), f.ddp * k_psi + f.ddq * b, f.psi)), qn = f.q * n;
  DualMat<S> m = DualMat<S>::zero();
  add_outer(m, a, f.psi);
  add_outer(m, f.psi, a);
  add_outer(m, qn, y);
  add_outer(m, y, qn);
  add_diagonal(m, twice(f.dp * k_psi + f.dq * b - f.q * ny));
  return m;
}

}  // namespace bough::motion
