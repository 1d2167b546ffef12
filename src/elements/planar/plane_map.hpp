#pragma once
/// What closed-form tangents of planar elements are put together from: maps of motions as complex numbers, 3x3 blocks of forces.
#include "bough/elements/planar/port.hpp"

namespace bough::elements::planar {

/// y -> c y_u + t y_w, a map into displacements, and y -> (c y_u + t y_w; b y_w).
template <class S>
struct UpperRows {
  Vec2<S> c, t;
};
template <class S>
struct PlaneMap {
  Vec2<S> c, t;
  S b;
  static PlaneMap zero() { return {Vec2<S>::zero(), Vec2<S>::zero(), S(0.0)}; }
};

/// x + a b and x - a b of complex numbers.
template <class S>
BOUGH_INLINE Vec2<S> add_complex(const Vec2<S>& x, const Vec2<S>& a, const Vec2<S>& b) {
  using lanes::multiply_add;
  using lanes::negative_multiply_add;
  return {{negative_multiply_add(a[1], b[1], multiply_add(a[0], b[0], x[0])),
           multiply_add(a[1], b[0], multiply_add(a[0], b[1], x[1]))}};
}
template <class S>
BOUGH_INLINE Vec2<S> subtract_complex(const Vec2<S>& x, const Vec2<S>& a, const Vec2<S>& b) {
  using lanes::multiply_add;
  using lanes::negative_multiply_add;
  return {{multiply_add(a[1], b[1], negative_multiply_add(a[0], b[0], x[0])),
           negative_multiply_add(a[1], b[0], negative_multiply_add(a[0], b[1], x[1]))}};
}
/// The same of a real number a.
template <class A, class S>
BOUGH_INLINE Vec2<S> add_scaled(const Vec2<S>& x, const A& a, const Vec2<S>& b) {
  using lanes::multiply_add;
  return {{multiply_add(a, b[0], x[0]), multiply_add(a, b[1], x[1])}};
}
template <class S>
BOUGH_INLINE Vec2<S> conjugate(const Vec2<S>& a) {
  return {{a[0], -a[1]}};
}

/// a x, its upper rows added to y and taken from it.
template <class S>
BOUGH_INLINE PlaneMap<S> product(const PlaneMap<S>& a, const PlaneMap<S>& x) {
  return {motion::complex_times(a.c, x.c), add_scaled(motion::complex_times(a.c, x.t), x.b, a.t), a.b * x.b};
}
template <class S>
BOUGH_INLINE void add_product(PlaneMap<S>& y, const UpperRows<S>& a, const PlaneMap<S>& x) {
  y.c = add_complex(y.c, a.c, x.c);
  y.t = add_scaled(add_complex(y.t, a.c, x.t), x.b, a.t);
}
template <class S>
BOUGH_INLINE void subtract_product(PlaneMap<S>& y, const UpperRows<S>& a, const PlaneMap<S>& x) {
  y.c = subtract_complex(y.c, a.c, x.c);
  y.t = add_scaled(subtract_complex(y.t, a.c, x.t), S(-x.b), a.t);
}
template <class S>
BOUGH_INLINE PlaneMap<S> operator+(const PlaneMap<S>& x, const PlaneMap<S>& y) {
  return {x.c + y.c, x.t + y.t, x.b + y.b};
}
template <class S>
BOUGH_INLINE UpperRows<S> operator+(const UpperRows<S>& x, const UpperRows<S>& y) {
  return {x.c + y.c, x.t + y.t};
}
template <class S>
BOUGH_INLINE PlaneMap<S> negated(const PlaneMap<S>& x) {
  return {-x.c, -x.t, -x.b};
}
template <class A, class S>
BOUGH_INLINE PlaneMap<S> scaled(const A& f, const PlaneMap<S>& x) {
  return {f * x.c, f * x.t, f * x.b};
}
template <class A, class S>
BOUGH_INLINE void add_scaled_to(PlaneMap<S>& x, const A& f, const PlaneMap<S>& y) {
  using lanes::multiply_add;
  x.c = add_scaled(x.c, f, y.c);
  x.t = add_scaled(x.t, f, y.t);
  x.b = multiply_add(f, y.b, x.b);
}

/// T(d) and T(d)^-1.
template <class S>
BOUGH_INLINE PlaneMap<S> map_of(const PlaneMotion<S>& m) {
  return {conjugate(m.series.f), m.ku, S(1.0)};
}
template <class S>
BOUGH_INLINE PlaneMap<S> inverse_map(const PlaneLog<S>& log) {
  return {conjugate(log.h), -log.pu, S(1.0)};
}
/// T(d)^-1 of a motion that is no logarithm. Its h comes from the series at hand: 1/f = conj(f) / |f|^2, |f|^2 = 2 c_2, f = (c_1, theta c_2).
template <class S>
BOUGH_INLINE PlaneMap<S> inverse_tangent_map(const Vec3<S>& d) {
  const PlaneMotion<S> m(d);
  const Vec2<S> h{{0.5 * m.series.f[0] / m.series.k[1], -0.5 * m.theta}};
  return {conjugate(h), -motion::conjugate_times(h, m.ku), S(1.0)};
}
/// ad(d), ad(d) x and a ad(v).
template <class S>
BOUGH_INLINE PlaneMap<S> bracket_map(const Vec3<S>& d) {
  const S o(0.0);
  return {{{o, d[2]}}, {{d[1], -d[0]}}, o};
}
template <class S>
BOUGH_INLINE PlaneMap<S> bracket_product(const Vec3<S>& d, const PlaneMap<S>& x) {
  return {d[2] * motion::quarter_turn(x.c),
          motion::quarter_turn(add_scaled(Vec2<S>(d[2] * x.t), S(-x.b), motion::plane_part(d))), S(0.0)};
}
template <class S>
BOUGH_INLINE UpperRows<S> times_bracket(const UpperRows<S>& a, const Vec3<S>& v) {
  const Vec2<S> turned = motion::quarter_turn(a.c);
  return {v[2] * turned, -motion::complex_times(turned, motion::plane_part(v))};
}

/// Ad(H)^-1 of a port's frame H in its node's.
template <class C>
PlaneMap<C> offset_map(const PortOf<C>& port) {
  return {conjugate(port.turn), motion::conjugate_times(port.turn, motion::quarter_turn(port.x)), C(1.0)};
}

/// Products with the matrix of a section or a body, and with a map's transpose.
template <class A, class S>
BOUGH_INLINE Mat3<S> matrix_product(const Mat3<A>& m, const PlaneMap<S>& x) {
  using lanes::multiply_add;
  using lanes::negative_multiply_add;
  Mat3<S> r;
  for (int i = 0; i < 3; ++i) {
    r(i, 0) = multiply_add(m(i, 1), x.c[1], S(m(i, 0) * x.c[0]));
    r(i, 1) = negative_multiply_add(m(i, 0), x.c[1], S(m(i, 1) * x.c[0]));
    r(i, 2) = multiply_add(m(i, 2), x.b, multiply_add(m(i, 1), x.t[1], S(m(i, 0) * x.t[0])));
  }
  return r;
}
template <class A, class S>
BOUGH_INLINE void add_matrix_product(Mat3<S>& r, const Mat3<A>& m, const PlaneMap<S>& x) {
  using lanes::multiply_add;
  using lanes::negative_multiply_add;
  for (int i = 0; i < 3; ++i) {
    r(i, 0) = multiply_add(m(i, 1), x.c[1], multiply_add(m(i, 0), x.c[0], r(i, 0)));
    r(i, 1) = negative_multiply_add(m(i, 0), x.c[1], multiply_add(m(i, 1), x.c[0], r(i, 1)));
    r(i, 2) = multiply_add(m(i, 2), x.b, multiply_add(m(i, 1), x.t[1], multiply_add(m(i, 0), x.t[0], r(i, 2))));
  }
}
template <class S>
BOUGH_INLINE Mat3<S> transposed_product(const PlaneMap<S>& x, const Mat3<S>& m) {
  using lanes::multiply_add;
  using lanes::negative_multiply_add;
  Mat3<S> r;
  for (int j = 0; j < 3; ++j) {
    r(0, j) = multiply_add(x.c[1], m(1, j), S(x.c[0] * m(0, j)));
    r(1, j) = negative_multiply_add(x.c[1], m(0, j), S(x.c[0] * m(1, j)));
    r(2, j) = multiply_add(x.b, m(2, j), multiply_add(x.t[1], m(1, j), S(x.t[0] * m(0, j))));
  }
  return r;
}
/// r += ad(d)^T m.
template <class S>
BOUGH_INLINE void add_bracket_transposed(Mat3<S>& r, const Vec3<S>& d, const Mat3<S>& m) {
  using lanes::multiply_add;
  using lanes::negative_multiply_add;
  for (int j = 0; j < 3; ++j) {
    r(0, j) = multiply_add(d[2], m(1, j), r(0, j));
    r(1, j) = negative_multiply_add(d[2], m(0, j), r(1, j));
    r(2, j) = negative_multiply_add(d[0], m(1, j), multiply_add(d[1], m(0, j), r(2, j)));
  }
}

/// Derivative of a wrench by a motion, [0, column; row, corner].
template <class S>
struct WrenchSlope {
  Vec2<S> column, row;
  S corner;
};
/// m += w x.
template <class S>
BOUGH_INLINE void add_product(Mat3<S>& m, const WrenchSlope<S>& w, const PlaneMap<S>& x) {
  using lanes::multiply_add;
  using lanes::negative_multiply_add;
  m(0, 2) = multiply_add(w.column[0], x.b, m(0, 2));
  m(1, 2) = multiply_add(w.column[1], x.b, m(1, 2));
  m(2, 0) = multiply_add(w.row[1], x.c[1], multiply_add(w.row[0], x.c[0], m(2, 0)));
  m(2, 1) = negative_multiply_add(w.row[0], x.c[1], multiply_add(w.row[1], x.c[0], m(2, 1)));
  m(2, 2) = multiply_add(w.corner, x.b, multiply_add(w.row[1], x.t[1], multiply_add(w.row[0], x.t[0], m(2, 2))));
}
template <class A, class S>
BOUGH_INLINE void add_scaled_to(Mat3<S>& x, const A& f, const Mat3<S>& y) {
  using lanes::multiply_add;
  for (int i = 0; i < 9; ++i) x.m[i] = multiply_add(f, y.m[i], x.m[i]);
}

}  // namespace bough::elements::planar
