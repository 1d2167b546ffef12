#pragma once
/// Complex numbers and angles for motions of a plane (group_se2.hpp): displacements are u = u_1 + i u_2, rotations e^(i
/// theta).
#include "bough/motion/coefficients.hpp"
#include "bough/motion/quaternion.hpp"

namespace bough::motion {

template <class S>
using Vec2 = lanes::Vec<S, 2>;  ///< a complex number

template <class A, class S>
BOUGH_INLINE Vec2<S> complex_times(const Vec2<A>& a, const Vec2<S>& b) {
  return {{negative_multiply_add(a[1], b[1], S(a[0] * b[0])), multiply_add(a[1], b[0], S(a[0] * b[1]))}};
}
/// conj(a) b: the opposite rotation, and the transpose of complex_times(a, .).
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
/// x - a b
template <class S>
BOUGH_INLINE Vec2<S> subtract_complex(const Vec2<S>& x, const Vec2<S>& a, const Vec2<S>& b) {
  return {{multiply_add(a[1], b[1], negative_multiply_add(a[0], b[0], x[0])),
           negative_multiply_add(a[1], b[0], negative_multiply_add(a[0], b[1], x[1]))}};
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

/// theta of e^(i theta) = c + i s, |theta| <= pi. It is the arctangent of s/c where that is below 1/4; else the angle
/// is halved three times.
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
        const auto beyond = less(c, S(0.0));  // |theta| > pi/2
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

/// (theta/2) cot(theta/2), the real part of 1/f, as a function of x = theta^2.
template <class S>
S half_cotangent(const S& x) {
  return S(1.0) - x * eval_inverse_coefficients(x).k;
}

}  // namespace bough::motion
