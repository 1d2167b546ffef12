#pragma once
/// Motions SE(2) of a plane, (u; theta): displacements are complex numbers u = u_1 + i u_2, turns e^(i theta).
///   exp(d) = (theta, f u),  f = (e^(i theta) - 1) / (i theta)
///   T(d) y = (conj(f) y_u + k u y_w; y_w),  k = e^(-i theta) f'(theta),   ad(d) v = (i d_w v_u - i v_w d_u; 0)
/// The same as those of se3.hpp for motions within the plane. With Stumpff's c_n(theta^2) of coefficients.hpp:
///   f = c_1 + i theta c_2,  k = theta c_3 + i c_2,  1/f = (theta/2) cot(theta/2) - i theta/2.
#include "bough/motion/coefficients.hpp"
#include "bough/motion/quaternion.hpp"

namespace bough::motion {

template <class S>
using Vec2 = lanes::Vec<S, 2>;  ///< a complex number

template <class A, class S>
BOUGH_INLINE Vec2<S> complex_times(const Vec2<A>& a, const Vec2<S>& b) {
  return {{negative_multiply_add(a[1], b[1], S(a[0] * b[0])), multiply_add(a[1], b[0], S(a[0] * b[1]))}};
}
/// conj(a) b: what turns the other way, and the transpose of complex_times(a, .).
template <class A, class S>
BOUGH_INLINE Vec2<S> conjugate_times(const Vec2<A>& a, const Vec2<S>& b) {
  return {{multiply_add(a[1], b[1], S(a[0] * b[0])), negative_multiply_add(a[1], b[0], S(a[0] * b[1]))}};
}
/// x + a b
template <class S>
BOUGH_INLINE Vec2<S> add_complex(const Vec2<S>& x, const Vec2<S>& a, const Vec2<S>& b) {
  return {{negative_multiply_add(a[1], b[1], multiply_add(a[0], b[0], x[0])),
           multiply_add(a[1], b[0], multiply_add(a[0], b[1], x[1]))}};
}
/// i a
template <class S>
BOUGH_INLINE Vec2<S> quarter_turn(const Vec2<S>& a) {
  return {{-a[1], a[0]}};
}
template <class S>
BOUGH_INLINE Vec2<S> plane_part(const Vec3<S>& v) {
  return {{v[0], v[1]}};
}
template <class S>
BOUGH_INLINE Vec3<S> join(const Vec2<S>& u, const S& w) {
  return {{u[0], u[1], w}};
}

/// theta of e^(i theta) = c + i s, |theta| <= pi: the arctangent of s/c where that is below 1/4, else by halving the angle three times.
template <class S>
S angle_of(const S& c, const S& s) {
  using L = Literal<S>;
  using std::sqrt;
  const auto below = less(s, S(0.0));
  const S size = select(below, S(-s), s);
  const auto near = less(size, S(L(0.25) * c));
  return choose(
      near,
      [&] {
        const S t = select(near, s, S(0.0)) / select(near, c, S(1.0));
        return S(detail::horner(detail::near_arctangent<L>, S(t * t)) * t);
      },
      [&] {
        const auto beyond = less(c, S(0.0));  // a quarter of a turn
        const S other = select(below, S(c - L(1)), S(L(1) - c));
        const S w = select(beyond, size, S(c + L(1))), v = select(beyond, other, s);
        const S vv = v * v, m = sqrt(multiply_add(w, w, vv)), sum = m + w;
        const S inverse = L(1) / (sum + sqrt((m + m) * sum)), tt = vv * inverse * inverse;
        return S(L(8) * inverse * detail::horner(detail::arctangent<L>, tt) * v);
      });
}
template <class S, int N>
lanes::Jet<S, N> angle_of(const lanes::Jet<S, N>& c, const lanes::Jet<S, N>& s) {
  lanes::Jet<S, N> r;
  r.a = angle_of(c.a, s.a);
  for (int i = 0; i < N; ++i) r.d[i] = c.a * s.d[i] - s.a * c.d[i];
  return r;
}

/// q = (1 - (theta/2) cot(theta/2)) / theta^2 as a function of x = theta^2, and its derivative by x.
template <class S>
struct InverseSeries {
  S q, dq;
};
template <class S>
InverseSeries<S> eval_inverse_series(const S& x) {
  const auto k = eval_inverse_coefficients(x);
  return {k.k, k.dk};
}
template <class S, int N>
InverseSeries<lanes::Jet<S, N>> eval_inverse_series(const lanes::Jet<S, N>& x) {
  const auto k = eval_inverse_coefficients(x.a);
  return {lanes::chain(x, k.k, k.dk), lanes::chain(x, k.dk, k.ddk)};
}
/// 1/f - the real part as a function of x = theta^2.
template <class S>
S half_cotangent(const S& x) {
  return S(1.0) - x * eval_inverse_series(x).q;
}

/// f and k at an angle, with their first (d) and second (dd) derivatives by it.
template <class S>
struct PlaneSeries {
  Vec2<S> f, k, df, dk, ddf, ddk;
};
template <class S>
PlaneSeries<S> eval_plane_series(const S& theta) {
  const S x = theta * theta;
  const lanes::Vec<S, 8> c = eval_stumpff(x);
  PlaneSeries<S> r;
  r.f = {{c[1], theta * c[2]}};
  r.k = {{theta * c[3], c[2]}};
  // (theta c_n)' = c_{n-1} - (n - 1) c_n,  c_n' = theta (n c_{n+2} - c_{n+1})
  r.df = {{theta * (c[3] - c[2]), c[1] - c[2]}};
  r.dk = {{c[2] - 2.0 * c[3], theta * (2.0 * c[4] - c[3])}};
  r.ddf = {{2.0 * (c[2] - c[3]) - c[1], theta * (2.0 * (c[3] - c[4]) - c[2])}};
  r.ddk = {{theta * (4.0 * c[4] - 6.0 * c[5] - c[3]), 4.0 * c[3] - 6.0 * c[4] - c[2]}};
  return r;
}

/// Operators of one motion d.
template <class S>
struct PlaneMotion {
  PlaneSeries<S> series;
  Vec2<S> u, ku;
  S theta;

  PlaneMotion() = default;
  explicit PlaneMotion(const Vec3<S>& d)
      : series(eval_plane_series(d[2])), u(plane_part(d)), ku(complex_times(series.k, u)), theta(d[2]) {}

  /// T y
  Vec3<S> times(const Vec3<S>& y) const {
    return join(Vec2<S>(conjugate_times(series.f, plane_part(y)) + y[2] * ku), y[2]);
  }
  /// T^T m
  Vec3<S> transpose_times(const Vec3<S>& m) const {
    const Vec2<S> n = plane_part(m);
    return join(complex_times(series.f, n), S(m[2] + dot(ku, n)));
  }
  /// d(T y)/dd = (k y_w, (conj f)' y_u + k' u y_w; 0): its last column's upper part.
  Vec2<S> by_angle(const Vec3<S>& y) const {
    return conjugate_times(series.df, plane_part(y)) + y[2] * complex_times(series.dk, u);
  }
  /// (d(T y)/dd) delta
  Vec3<S> slope_times(const Vec3<S>& delta, const Vec3<S>& y) const {
    return join(Vec2<S>(delta[2] * by_angle(y) + y[2] * complex_times(series.k, plane_part(delta))), S(0.0));
  }
  /// (d(T y)/dd)^T m
  Vec3<S> slope_transpose_times(const Vec3<S>& y, const Vec3<S>& m) const {
    const Vec2<S> n = plane_part(m);
    return join(Vec2<S>(y[2] * conjugate_times(series.k, n)), dot(by_angle(y), n));
  }
};

/// A motion that is a logarithm, |theta| < 2 pi, and its T^-1 z = (conj(h) z_u - z_w p u; z_w),  h = 1/f = 1 - theta^2 q - i theta/2,
/// p = i/2 - theta q.
template <class S>
struct PlaneLog {
  Vec3<S> d;
  Vec2<S> h, p, pu;
  InverseSeries<S> series;

  PlaneLog() = default;
  /// d = log of the pose (e^(i theta) = turn, x).
  PlaneLog(const Vec2<S>& turn, const Vec2<S>& x) {
    const S angle = angle_of(turn[0], turn[1]), square = angle * angle;
    series = eval_inverse_series(square);
    h = {{S(S(1.0) - square * series.q), S(-0.5 * angle)}};
    p = {{S(-(angle * series.q)), S(0.5)}};
    d = join(complex_times(h, x), angle);
    pu = complex_times(p, plane_part(d));
  }
  /// T^-1 z
  Vec3<S> inverse_times(const Vec3<S>& z) const {
    return join(Vec2<S>(conjugate_times(h, plane_part(z)) - z[2] * pu), z[2]);
  }
  /// (d(T^-1 z)/dd) delta:  h' = -2 theta (q + x dq/dx) - i/2,  p' = -(q + 2 x dq/dx)
  Vec3<S> inverse_slope_times(const Vec3<S>& delta, const Vec3<S>& z) const {
    const S x = d[2] * d[2], once = series.q + x * series.dq, twice = once + x * series.dq;
    const Vec2<S> slope{{S(-2.0 * d[2] * once), S(-0.5)}};
    const Vec2<S> by_angle = conjugate_times(slope, plane_part(z)) + S(z[2] * twice) * plane_part(d);
    return join(Vec2<S>(delta[2] * by_angle - z[2] * complex_times(p, plane_part(delta))), S(0.0));
  }
  /// T^-T m
  Vec3<S> inverse_transpose_times(const Vec3<S>& m) const {
    const Vec2<S> n = plane_part(m);
    return join(complex_times(h, n), S(m[2] - dot(pu, n)));
  }
};

/// ad(d) v
template <class S>
Vec3<S> plane_bracket(const Vec3<S>& d, const Vec3<S>& v) {
  return join(quarter_turn(Vec2<S>(d[2] * plane_part(v) - v[2] * plane_part(d))), S(0.0));
}
/// ad(d)^T p
template <class S>
Vec3<S> plane_bracket_transpose(const Vec3<S>& d, const Vec3<S>& p) {
  const Vec2<S> f = plane_part(p);
  return join(Vec2<S>(-(d[2] * quarter_turn(f))), S(-dot(quarter_turn(plane_part(d)), f)));
}

/// T(d)^-1 as a matrix.
template <class S>
Mat3<S> inverse_tangent_plane(const Vec3<S>& d) {
  const S x = d[2] * d[2];
  const PlaneMotion<S> m(d);
  const Vec2<S> h{{half_cotangent(x), -0.5 * d[2]}}, last = -conjugate_times(h, m.ku);
  const S o(0.0);
  return {
      {h[0], h[1], last[0], -h[1], h[0], last[1], o, o, S(1.0)}};  // conj(h) y = (h_0 y_0 + h_1 y_1, h_0 y_1 - h_1 y_0)
}

}  // namespace bough::motion
