#pragma once
/// Operators that are analytic functions of a rotation or motion vector: f(psi) = I + p(x) ~psi + q(x) ~psi ~psi, x =
/// phi^2. The tangent operator, its inverse and their transposes differ in (p, q) only; a transpose flips the sign of
/// p. On SE(3) the same function of the dual vector psi + e u (e^2 = 0) gives [f(psi), D f(psi)[u]; 0, f(psi)]
/// (transference).
#include "bough/motion/coefficients.hpp"

namespace bough::motion {

/// Coefficients of one operator with derivatives by x.
template <class S>
struct SkewSeries {
  S p, q;      ///< I + p ~psi + q ~psi^2
  S dp, dq;    ///< d/dx
  S ddp, ddq;  ///< d^2/dx^2
};

/// T(psi) = I - b ~psi + c ~psi^2: exp(psi)^-1 D exp(psi)[delta] = (T(psi) delta)~.
template <class S>
SkewSeries<S> tangent_series(const S& x) {
  const AngleCoefficients<S> a = eval_angle_coefficients(x);
  return {-a.b, a.c, -a.db, a.dc, -a.ddb, a.ddc};
}
/// T(psi)^-1 = I + 1/2 ~psi + k ~psi^2.
template <class S>
SkewSeries<S> inverse_tangent_series(const S& x) {
  const InverseCoefficients<S> a = eval_inverse_coefficients(x);
  return {S(0.5), a.k, S(0.0), a.dk, S(0.0), a.ddk};
}
template <class S>
SkewSeries<S> transposed(const SkewSeries<S>& f) {
  return {-f.p, f.q, -f.dp, f.dq, -f.ddp, f.ddq};
}

/// f(psi) as a matrix, from ~psi ~psi = psi psi^T - x I.
template <class S>
Mat3<S> series_matrix(const SkewSeries<S>& f, const Vec3<S>& psi) {
  const S diagonal = S(1.0) - f.q * dot(psi, psi);
  const Vec3<S> p = f.p * psi, q = f.q * psi;
  Mat3<S> r = outer(q, psi) + skew(p);
  for (int i = 0; i < 3; ++i) r(i, i) = r(i, i) + diagonal;
  return r;
}
/// f(psi) v.
template <class S>
Vec3<S> series_times(const SkewSeries<S>& f, const Vec3<S>& psi, const Vec3<S>& v) {
  return v + cross(psi, f.p * v + f.q * cross(psi, v));
}
/// D f(psi)[u], a matrix: p ~u + q (~psi ~u + ~u ~psi) + 2 (psi.u) (p' ~psi + q' ~psi ~psi).
template <class S>
Mat3<S> series_slope_matrix(const SkewSeries<S>& f, const Vec3<S>& psi, const Vec3<S>& u) {
  const S half = dot(psi, u), s = half + half;
  const Vec3<S> sp = (s * f.dq) * psi + f.q * u, qp = f.q * psi;
  Mat3<S> r = outer(sp, psi) + outer(qp, u) + skew(f.p * u + (s * f.dp) * psi);
  const S diagonal = -s * (f.q + f.dq * dot(psi, psi));
  for (int i = 0; i < 3; ++i) r(i, i) = r(i, i) + diagonal;
  return r;
}
/// D f(psi)[u] v.
template <class S>
Vec3<S> series_slope_times(const SkewSeries<S>& f, const Vec3<S>& psi, const Vec3<S>& u, const Vec3<S>& v) {
  const S half = dot(psi, u), s = half + half;
  const Vec3<S> w = cross(psi, v);
  return cross(u, f.p * v + f.q * w) + cross(psi, (s * f.dp) * v + (s * f.dq) * w + f.q * cross(u, v));
}

/// D^2 f(psi)[u, x] v: the derivative of D f(psi)[x] v along u.
///   2 (x.u) (p' w1 + q' w2) + 2 (psi.x) (p' u x v + q' (w2)_u + 2 (psi.u) (p'' w1 + q'' w2))
///   + 2 (psi.u) (p' x x v + q' (w2)_x) + q (x x (u x v) + u x (x x v)),   w1 = psi x v, w2 = psi x w1
template <class S>
Vec3<S> series_second_times(const SkewSeries<S>& f, const Vec3<S>& psi, const Vec3<S>& u, const Vec3<S>& x,
                            const Vec3<S>& v) {
  const S half_u = dot(psi, u), half_x = dot(psi, x), half_ux = dot(u, x);
  const S su = half_u + half_u, sx = half_x + half_x, sux = half_ux + half_ux, both = su * sx;
  const Vec3<S> w1 = cross(psi, v), uv = cross(u, v), xv = cross(x, v);
  const Vec3<S> first = (both * f.ddp + sux * f.dp) * v + (both * f.ddq + sux * f.dq) * w1;
  return cross(psi, first + (sx * f.dq) * uv + (su * f.dq) * xv) +
         cross(u, (sx * f.dp) * v + (sx * f.dq) * w1 + f.q * xv) +
         cross(x, (su * f.dp) * v + (su * f.dq) * w1 + f.q * uv);
}

/// d(f(psi) v)/dpsi as a matrix and its derivative along u, the blocks of the 6x6 derivative on SE(3).
///   M   = -p ~v - q (~w1 + ~psi ~v) + 2 (p' w1 + q' w2) psi^T,           w1 = psi x v, w2 = psi x w1
///   M_u = -2 (psi.u) (p' ~v + q' (~w1 + ~psi ~v)) - q (~(u x v) + ~u ~v) + 2 (p' w1 + q' w2) u^T
///         + 2 (p' u x v + q' (w2)_u + 2 (psi.u) (p'' w1 + q'' w2)) psi^T
template <class S>
struct SeriesJacobian {
  Mat3<S> value;  ///< M
  Mat3<S> slope;  ///< M_u
};
template <class S>
Mat3<S> series_jacobian(const SkewSeries<S>& f, const Vec3<S>& psi, const Vec3<S>& v) {
  const Vec3<S> w1 = cross(psi, v), w2 = cross(psi, w1), g = f.dp * w1 + f.dq * w2;
  // ~psi ~v = v psi^T - (psi.v) I
  Mat3<S> m = outer(g + g - f.q * v, psi) - skew(f.p * v + f.q * w1);
  const S diagonal = f.q * dot(psi, v);
  for (int i = 0; i < 3; ++i) m(i, i) = m(i, i) + diagonal;
  return m;
}
template <class S>
SeriesJacobian<S> series_jacobian(const SkewSeries<S>& f, const Vec3<S>& psi, const Vec3<S>& u, const Vec3<S>& v) {
  const S half = dot(psi, u), s = half + half, psi_v = dot(psi, v);
  const Vec3<S> w1 = cross(psi, v), w2 = cross(psi, w1), w1u = cross(u, v), w2u = cross(u, w1) + cross(psi, w1u);
  const Vec3<S> g = f.dp * w1 + f.dq * w2, left = g + g - f.q * v;
  const Vec3<S> gu = f.dp * w1u + f.dq * w2u + s * (f.ddp * w1 + f.ddq * w2);
  SeriesJacobian<S> r;
  r.value = outer(left, psi) - skew(f.p * v + f.q * w1);
  r.slope = outer(gu + gu - (s * f.dq) * v, psi) + outer(left, u) - skew(s * (f.dp * v + f.dq * w1) + f.q * w1u);
  const S diagonal = f.q * psi_v, diagonal_slope = s * f.dq * psi_v + f.q * dot(u, v);
  for (int i = 0; i < 3; ++i) {
    r.value(i, i) = r.value(i, i) + diagonal;
    r.slope(i, i) = r.slope(i, i) + diagonal_slope;
  }
  return r;
}

}  // namespace bough::motion
