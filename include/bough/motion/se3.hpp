#pragma once
/// Motions SE(3): composition, exponential, logarithm, motion tensor (adjoint), tangent operators and their
/// derivatives. 6-vectors are (linear; angular); increments are right increments in the frame's own axes, H <- H
/// exp(eta). Lengths [m], angles [rad]. Every function is pure, does not allocate and cannot fail. Sources:
/// data/manual/theory/groups.md.
#include "bough/motion/so3.hpp"

namespace bough::motion {

/// H_ac = H_ab H_bc.
template <class S>
Frame<S> compose(const Frame<S>& a, const Frame<S>& b) {
  return {a.R * b.R, a.x + a.R * b.x};
}
template <class S>
Frame<S> inverse(const Frame<S>& a) {
  return {transpose(a.R), -transpose_times(a.R, a.x)};
}
/// H_a^-1 H_b: pose of b in a. It does not change when both frames move rigidly.
template <class S>
Frame<S> relative(const Frame<S>& a, const Frame<S>& b) {
  return {transpose_times(a.R, b.R), transpose_times(a.R, b.x - a.x)};
}
/// Parent components of the point with body components p.
template <class S>
Vec3<S> transform(const Frame<S>& a, const Vec3<S>& p) {
  return a.x + a.R * p;
}

/// H = exp(d), d = (u; psi): R = exp(~psi), x = T(psi)^T u.
template <class S>
Frame<S> exp_se3(const Vec6<S>& d) {
  const Vec3<S> u = linear_part(d), psi = angular_part(d);
  const lanes::Vec<S, 8> c = eval_stumpff(dot(psi, psi));
  const S o(0.0);
  return {series_matrix(SkewSeries<S>{c[1], c[2], o, o, o, o}, psi),
          series_times(SkewSeries<S>{c[2], c[3], o, o, o, o}, psi, u)};
}
/// d with exp(d) = H and |psi| <= pi.
template <class S>
Vec6<S> log_se3(const Frame<S>& H) {
  const Vec3<S> psi = log_so3(H.R);
  return join(inverse_tangent_so3_transpose_times(psi, H.x), psi);
}

/// Motion tensor C = Ad(H) = [R, ~x R; 0, R]: body to parent components of a twist or line [1.14].
template <class S>
Mat6<S> adjoint(const Frame<S>& H) {
  Mat6<S> r = Mat6<S>::zero();
  const Mat3<S> xR = skew(H.x) * H.R;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      r(i, j) = r(i + 3, j + 3) = H.R(i, j);
      r(i, j + 3) = xR(i, j);
    }
  return r;
}
/// C^-1 = [R^T, R^T ~x^T; 0, R^T] [1.20].
template <class S>
Mat6<S> inverse_adjoint(const Frame<S>& H) {
  Mat6<S> r = Mat6<S>::zero();
  const Mat3<S> xR = skew(H.x) * H.R;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      r(i, j) = r(i + 3, j + 3) = H.R(j, i);
      r(i, j + 3) = xR(j, i);
    }
  return r;
}
/// Ad(H) v, Ad(H)^-1 v for a twist v; Ad(H)^T f, Ad(H)^-T f for a wrench f, without a 6x6 matrix.
template <class S>
Vec6<S> adjoint_times(const Frame<S>& H, const Vec6<S>& v) {
  const Vec3<S> w = H.R * angular_part(v);
  return join(H.R * linear_part(v) + cross(H.x, w), w);
}
template <class S>
Vec6<S> inverse_adjoint_times(const Frame<S>& H, const Vec6<S>& v) {
  const Vec3<S> w = angular_part(v);
  return join(transpose_times(H.R, linear_part(v) - cross(H.x, w)), transpose_times(H.R, w));
}
template <class S>
Vec6<S> adjoint_transpose_times(const Frame<S>& H, const Vec6<S>& f) {
  const Vec3<S> n = linear_part(f);
  return join(transpose_times(H.R, n), transpose_times(H.R, angular_part(f) - cross(H.x, n)));
}
template <class S>
Vec6<S> inverse_adjoint_transpose_times(const Frame<S>& H, const Vec6<S>& f) {
  const Vec3<S> n = H.R * linear_part(f);
  return join(n, H.R * angular_part(f) + cross(H.x, n));
}

namespace detail {
/// [A, B; 0, A]: the shape of every operator on motions.
template <class S>
Mat6<S> upper(const Mat3<S>& A, const Mat3<S>& B) {
  Mat6<S> r = Mat6<S>::zero();
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      r(i, j) = r(i + 3, j + 3) = A(i, j);
      r(i, j + 3) = B(i, j);
    }
  return r;
}
/// [0, A; A, B]: the shape of derivatives of their transposes.
template <class S>
Mat6<S> lower_right(const Mat3<S>& A, const Mat3<S>& B) {
  Mat6<S> r = Mat6<S>::zero();
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      r(i, j + 3) = r(i + 3, j) = A(i, j);
      r(i + 3, j + 3) = B(i, j);
    }
  return r;
}
}  // namespace detail

/// ad(v) = ~V = [~w, ~v; 0, ~w] [1.35].
template <class S>
Mat6<S> cross6(const Vec6<S>& v) {
  return detail::upper(skew(angular_part(v)), skew(linear_part(v)));
}
/// ad(v) w.
template <class S>
Vec6<S> cross6_times(const Vec6<S>& v, const Vec6<S>& w) {
  const Vec3<S> omega = angular_part(v), w_a = angular_part(w);
  return join(cross(omega, linear_part(w)) + cross(linear_part(v), w_a), cross(omega, w_a));
}
/// ad(v)^T f.
template <class S>
Vec6<S> cross6_transpose_times(const Vec6<S>& v, const Vec6<S>& f) {
  const Vec3<S> omega = angular_part(v), n = linear_part(f);
  return join(cross(n, omega), cross(n, linear_part(v)) + cross(angular_part(f), omega));
}
/// ^P = [0, ~p; ~p, ~q] of P = (p; q): ad(v)^T P = ^P v [1.41].
template <class S>
Mat6<S> hat6(const Vec6<S>& P) {
  return detail::lower_right(skew(linear_part(P)), skew(angular_part(P)));
}

/// An operator f(ad d) of one d = (u; psi) with its coefficients, for several products at the same d:
/// T(d), exp(d)^-1 D exp(d)[delta] = (T(d) delta)~, T = I - ad/2 + ad^2/6 - ..., or T^-1 = I + ad/2 + ad^2/12 - ...
/// a, x are motion increments, n is a wrench. Matrices: row i, column j is d(.)_i / dd_j.
template <class S>
struct MotionOperator {
  SkewSeries<S> f;
  Vec6<S> d;

  Mat6<S> matrix() const {
    return detail::upper(series_matrix(f, psi()), series_slope_matrix(f, psi(), linear_part(d)));
  }
  /// f a.
  Vec6<S> times(const Vec6<S>& a) const {
    const Vec3<S> a_w = angular_part(a);
    return join(series_times(f, psi(), linear_part(a)) + series_slope_times(f, psi(), linear_part(d), a_w),
                series_times(f, psi(), a_w));
  }
  /// f^T n.
  Vec6<S> transpose_times(const Vec6<S>& n) const {
    const SkewSeries<S> g = transposed(f);
    const Vec3<S> n_l = linear_part(n);
    return join(series_times(g, psi(), n_l),
                series_times(g, psi(), angular_part(n)) + series_slope_times(g, psi(), linear_part(d), n_l));
  }
  /// d(f a)/dd = [M(a_w), M(a_l) + M_u(a_w); 0, M(a_w)].
  Mat6<S> derivative(const Vec6<S>& a) const {
    const SeriesJacobian<S> m = series_jacobian(f, psi(), linear_part(d), angular_part(a));
    return detail::upper(m.value, series_jacobian(f, psi(), linear_part(a)) + m.slope);
  }
  /// d(f a)/dd x, without a 6x6 matrix.
  Vec6<S> slope_times(const Vec6<S>& x, const Vec6<S>& a) const {
    const Vec3<S> x_w = angular_part(x), a_w = angular_part(a);
    return join(series_slope_times(f, psi(), x_w, linear_part(a)) + series_slope_times(f, psi(), linear_part(x), a_w) +
                    series_second_times(f, psi(), linear_part(d), x_w, a_w),
                series_slope_times(f, psi(), x_w, a_w));
  }
  /// d(f^T n)/dd = [0, M(n_l); M(n_l), M(n_w) + M_u(n_l)], M of f^T.
  Mat6<S> transpose_derivative(const Vec6<S>& n) const {
    const SkewSeries<S> g = transposed(f);
    const SeriesJacobian<S> m = series_jacobian(g, psi(), linear_part(d), linear_part(n));
    return detail::lower_right(m.value, series_jacobian(g, psi(), angular_part(n)) + m.slope);
  }

 private:
  Vec3<S> psi() const { return angular_part(d); }
};
template <class S>
MotionOperator<S> tangent_operator(const Vec6<S>& d) {
  const Vec3<S> psi = angular_part(d);
  return {tangent_series(dot(psi, psi)), d};
}
/// |psi| != 2 pi, 4 pi, ...
template <class S>
MotionOperator<S> inverse_tangent_operator(const Vec6<S>& d) {
  const Vec3<S> psi = angular_part(d);
  return {inverse_tangent_series(dot(psi, psi)), d};
}
/// exp(d) from T(d), without new coefficients: sin(phi)/phi = 1 - x c.
template <class S>
Frame<S> exp_se3(const MotionOperator<S>& T) {
  const Vec3<S> psi = angular_part(T.d);
  const S o(0.0), a = S(1.0) - dot(psi, psi) * T.f.q;
  return {series_matrix(SkewSeries<S>{a, -T.f.p, o, o, o, o}, psi),
          series_times(SkewSeries<S>{-T.f.p, T.f.q, o, o, o, o}, psi, linear_part(T.d))};
}

/// T(d) and T(d)^-1 as matrices.
template <class S>
Mat6<S> tangent(const Vec6<S>& d) {
  return tangent_operator(d).matrix();
}
template <class S>
Mat6<S> inverse_tangent(const Vec6<S>& d) {
  return inverse_tangent_operator(d).matrix();
}
/// T a, T^-1 a, T^T n, T^-T n without a 6x6 matrix; a is a motion increment, n a wrench.
template <class S>
Vec6<S> tangent_times(const Vec6<S>& d, const Vec6<S>& a) {
  return tangent_operator(d).times(a);
}
template <class S>
Vec6<S> inverse_tangent_times(const Vec6<S>& d, const Vec6<S>& a) {
  return inverse_tangent_operator(d).times(a);
}
template <class S>
Vec6<S> tangent_transpose_times(const Vec6<S>& d, const Vec6<S>& n) {
  return tangent_operator(d).transpose_times(n);
}
template <class S>
Vec6<S> inverse_tangent_transpose_times(const Vec6<S>& d, const Vec6<S>& n) {
  return inverse_tangent_operator(d).transpose_times(n);
}
/// Derivatives by d of T(d) a, T(d)^-1 a, T(d)^T n, T(d)^-T n, in closed form; row i, column j: d(.)_i / dd_j.
template <class S>
Mat6<S> tangent_derivative(const Vec6<S>& d, const Vec6<S>& a) {
  return tangent_operator(d).derivative(a);
}
template <class S>
Mat6<S> inverse_tangent_derivative(const Vec6<S>& d, const Vec6<S>& a) {
  return inverse_tangent_operator(d).derivative(a);
}
template <class S>
Mat6<S> tangent_transpose_derivative(const Vec6<S>& d, const Vec6<S>& n) {
  return tangent_operator(d).transpose_derivative(n);
}
template <class S>
Mat6<S> inverse_tangent_transpose_derivative(const Vec6<S>& d, const Vec6<S>& n) {
  return inverse_tangent_operator(d).transpose_derivative(n);
}

}  // namespace bough::motion
