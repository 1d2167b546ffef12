#pragma once
/// The group SE(2) as elements see it: the names of group_se3.hpp for motions of a plane, (u; theta), whose displacements are complex
/// numbers. Brackets are displacements without rotation, so what maps to them is kept without its last row; numbers that
/// commute with ad(d) are plain, since <x, y> = x_theta y_theta; no structural zero is stored or multiplied.
#include "bough/motion/coefficients.hpp"
#include "bough/motion/se2.hpp"

namespace bough::motion {

/// Pose in a plane: e^(i theta) as (cos, sin), and the origin [m].
template <class S>
struct PlanePose {
  Vec2<S> turn, x;
  static PlanePose identity() { return {{{S(1.0), S(0.0)}}, Vec2<S>::zero()}; }
};
/// y -> c y_u + t y_theta, a displacement.
template <class S>
struct PlaneBracketMap {
  Vec2<S> c, t;
};
/// y -> (c y_u + t y_theta; b y_theta).
template <class S>
struct PlaneMap {
  Vec2<S> c, t;
  S b;
  static PlaneMap zero() { return {Vec2<S>::zero(), Vec2<S>::zero(), S(0.0)}; }
  static PlaneMap identity() { return {{{S(1.0), S(0.0)}}, Vec2<S>::zero(), S(1.0)}; }
};
/// Derivative of a wrench by a motion, [0, column; row, corner].
template <class S>
struct PlaneWrenchMap {
  Vec2<S> column, row;
  S corner;
  static PlaneWrenchMap zero() { return {Vec2<S>::zero(), Vec2<S>::zero(), S(0.0)}; }
};

struct Se2 {
  static constexpr int dof = 3;
  static constexpr bool numbers_have_slopes = false;
  template <class S>
  using Pose = PlanePose<S>;
  template <class S>
  using Vector = Vec3<S>;  ///< (u; theta)
  template <class S>
  using Matrix = Mat3<S>;
  template <class S>
  using Motion = Vec3<S>;
  template <class S>
  using Bracket = Vec2<S>;
  template <class S>
  using Wrench = Vec3<S>;  ///< (force; moment)
  template <class S>
  using Number = S;
  template <class S>
  using Map = PlaneMap<S>;
  template <class S>
  using BracketMap = PlaneBracketMap<S>;
  template <class S>
  using WrenchMap = PlaneWrenchMap<S>;
  template <class S>
  using Translation = Vec2<S>;

  // ---- poses

  template <class S>
  static BOUGH_INLINE PlanePose<S> compose(const PlanePose<S>& a, const PlanePose<S>& b) {
    return {complex_times(a.turn, b.turn), Vec2<S>(a.x + complex_times(a.turn, b.x))};
  }
  /// H_a^-1 H_b
  template <class S>
  static BOUGH_INLINE PlanePose<S> relative(const PlanePose<S>& a, const PlanePose<S>& b) {
    return {conjugate_times(a.turn, b.turn), conjugate_times(a.turn, Vec2<S>(b.x - a.x))};
  }
  template <class S>
  static PlanePose<S> exp(const Vec3<S>& d) {
    const lanes::Vec<S, 8> c = eval_stumpff(S(d[2] * d[2]));
    return {{{c[0], S(d[2] * c[1])}}, complex_times(Vec2<S>{{c[1], S(d[2] * c[2])}}, plane_part(d))};
  }
  /// Ad(H)^-1 v: a twist at the frame H from one at the frame that H is described in; A: scalar of a constant pose.
  template <class A, class S>
  static BOUGH_INLINE Vec3<S> inverse_adjoint_times(const PlanePose<A>& H, const Vec3<S>& v) {
    const Vec2<S> here{{v[0] - v[2] * H.x[1], v[1] + v[2] * H.x[0]}};
    return join(conjugate_times(H.turn, here), v[2]);
  }
  /// Ad(H)^-T f: a wrench at the frame H as one at the origin.
  template <class A, class S>
  static BOUGH_INLINE Vec3<S> inverse_adjoint_transpose_times(const PlanePose<A>& H, const Vec3<S>& f) {
    const Vec2<S> turned = complex_times(H.turn, plane_part(f));
    return join(turned, S(f[2] + (H.x[0] * turned[1] - H.x[1] * turned[0])));
  }

  // ---- compact algebra

  template <class S>
  static BOUGH_INLINE const Vec3<S>& motion(const Vec3<S>& v) {
    return v;
  }
  template <class S>
  static BOUGH_INLINE const Vec3<S>& wrench(const Vec3<S>& f) {
    return f;
  }
  template <class S>
  static BOUGH_INLINE const Vec3<S>& vector_of_motion(const Vec3<S>& v) {
    return v;
  }
  template <class S>
  static BOUGH_INLINE const Vec3<S>& vector_of_wrench(const Vec3<S>& f) {
    return f;
  }
  template <class S>
  static BOUGH_INLINE Vec3<S> translation(const Vec2<S>& u) {
    return join(u, S(0.0));
  }
  template <class S>
  static BOUGH_INLINE Vec2<S> turned_back(const PlanePose<S>& H, const Vec2<S>& u) {
    return conjugate_times(H.turn, u);
  }

  template <class S>
  static BOUGH_INLINE auto log(const PlanePose<S>& H, Vec3<S>& d, S& x) {
    const S angle = angle_of(H.turn[0], H.turn[1]);
    x = angle * angle;
    const auto k = eval_inverse_coefficients(x);
    d = join(complex_times(Vec2<S>{{S(S(1.0) - x * k.k), S(-0.5 * angle)}}, H.x), angle);
    return k;
  }
  template <class S>
  static BOUGH_INLINE S square(const Vec3<S>& d) {
    return d[2] * d[2];
  }
  template <class S>
  static BOUGH_INLINE const S& number(const S&, const S& f, const S&) {
    return f;
  }
  template <class S>
  static BOUGH_INLINE const S& real(const S& x) {
    return x;
  }
  template <class S>
  static BOUGH_INLINE S twice(const S& x) {
    return x + x;
  }

  template <class S>
  static BOUGH_INLINE Vec2<S> bracket(const Vec3<S>& x, const Vec3<S>& y) {
    return {{negative_multiply_add(x[2], y[1], S(y[2] * x[1])), negative_multiply_add(y[2], x[0], S(x[2] * y[0]))}};
  }
  template <class S>
  static BOUGH_INLINE Vec2<S> bracket(const Vec3<S>& x, const Vec2<S>& y) {
    return {{-(x[2] * y[1]), x[2] * y[0]}};
  }
  template <class S>
  static BOUGH_INLINE Vec2<S> add_bracket(const Vec2<S>& r, const Vec3<S>& x, const Vec3<S>& y) {
    return {{negative_multiply_add(x[2], y[1], multiply_add(y[2], x[1], r[0])),
             negative_multiply_add(y[2], x[0], multiply_add(x[2], y[0], r[1]))}};
  }
  template <class S>
  static BOUGH_INLINE Vec2<S> add_bracket(const Vec2<S>& r, const Vec3<S>& x, const Vec2<S>& y) {
    return {{negative_multiply_add(x[2], y[1], r[0]), multiply_add(x[2], y[0], r[1])}};
  }
  template <class T, class S>
  static BOUGH_INLINE Vec3<S> add_bracket(const Vec3<S>& r, const Vec3<S>& x, const T& y) {
    return join(add_bracket(plane_part(r), x, y), r[2]);
  }
  template <class S>
  static BOUGH_INLINE Vec3<S> dual_bracket(const Vec3<S>& x, const Vec3<S>& n) {
    return {{x[2] * n[1], -(x[2] * n[0]), negative_multiply_add(x[0], n[1], S(x[1] * n[0]))}};
  }
  template <class S>
  static BOUGH_INLINE Vec3<S> dual_bracket(const Vec2<S>& x, const Vec3<S>& n) {
    return {{S(0.0), S(0.0), negative_multiply_add(x[0], n[1], S(x[1] * n[0]))}};
  }
  template <class S>
  static BOUGH_INLINE Vec3<S> add_dual_bracket(const Vec3<S>& r, const Vec3<S>& x, const Vec3<S>& n) {
    return {{multiply_add(x[2], n[1], r[0]), negative_multiply_add(x[2], n[0], r[1]),
             negative_multiply_add(x[0], n[1], multiply_add(x[1], n[0], r[2]))}};
  }
  template <class S>
  static BOUGH_INLINE Vec3<S> subtract_dual_bracket(const Vec3<S>& r, const Vec3<S>& x, const Vec3<S>& n) {
    return {{negative_multiply_add(x[2], n[1], r[0]), multiply_add(x[2], n[0], r[1]),
             multiply_add(x[0], n[1], negative_multiply_add(x[1], n[0], r[2]))}};
  }
  template <class S>
  static BOUGH_INLINE Vec3<S> subtract_dual_bracket(const Vec3<S>& r, const Vec2<S>& x, const Vec3<S>& n) {
    return {{r[0], r[1], multiply_add(x[0], n[1], negative_multiply_add(x[1], n[0], r[2]))}};
  }
  /// A bracket as a motion.
  template <class S>
  static BOUGH_INLINE Vec3<S> widened(const Vec2<S>& x) {
    return join(x, S(0.0));
  }
  template <class S>
  static BOUGH_INLINE S pairing(const Vec3<S>& x, const Vec3<S>& y) {
    return x[2] * y[2];
  }
  template <class S>
  static BOUGH_INLINE S power(const Vec3<S>& n, const Vec3<S>& y) {
    return lanes::dot(n, y);
  }
  template <class S>
  static BOUGH_INLINE S power(const Vec3<S>& n, const Vec2<S>& y) {
    return multiply_add(n[1], y[1], S(n[0] * y[0]));
  }
  template <class S>
  static BOUGH_INLINE S real_power(const Vec3<S>& n, const Vec3<S>& y) {
    return lanes::dot(n, y);
  }
  template <class S>
  static BOUGH_INLINE Vec3<S> add_covector(const Vec3<S>& r, const S& f, const Vec3<S>& x) {
    return {{r[0], r[1], multiply_add(f, x[2], r[2])}};
  }
  template <class S, int N>
  static BOUGH_INLINE lanes::Vec<S, N> times(const S& f, const lanes::Vec<S, N>& x) {
    return f * x;
  }
  template <class A, class S, int N>
  static BOUGH_INLINE lanes::Vec<S, N> scaled(const A& f, const lanes::Vec<S, N>& x) {
    return f * x;
  }
  template <class F, class S, int N>
  static BOUGH_INLINE lanes::Vec<S, N> add(lanes::Vec<S, N> r, const F& f, const lanes::Vec<S, N>& x) {
    for (int i = 0; i < N; ++i) r[i] = multiply_add(f, x[i], r[i]);
    return r;
  }
  template <class F, class S>
  static BOUGH_INLINE Vec3<S> add(const Vec3<S>& r, const F& f, const Vec2<S>& x) {
    return {{multiply_add(f, x[0], r[0]), multiply_add(f, x[1], r[1]), r[2]}};
  }
  template <class C, class S>
  static BOUGH_INLINE Vec3<S> matrix_times(const Mat3<C>& m, const Vec3<S>& x) {
    return m * x;
  }

  // ---- maps

  template <class S>
  static BOUGH_INLINE PlaneBracketMap<S> ad(const Vec3<S>& x) {
    return {{{S(0.0), x[2]}}, {{x[1], -x[0]}}};
  }
  template <class S>
  static BOUGH_INLINE PlaneBracketMap<S> ad(const Vec2<S>& x) {
    return {Vec2<S>::zero(), {{x[1], -x[0]}}};
  }
  template <class S>
  static BOUGH_INLINE PlaneMap<S> with_diagonal(const PlaneBracketMap<S>& m, double f) {
    return {{{m.c[0] + f, m.c[1]}}, m.t, S(f)};
  }
  template <class S>
  static BOUGH_INLINE void add_pair(PlaneBracketMap<S>& m, const Vec3<S>& x, const Vec3<S>& y) {
    m.c[0] = negative_multiply_add(x[2], y[2], m.c[0]);
    m.t = add(m.t, x[2], plane_part(y));
  }
  template <class S>
  static BOUGH_INLINE void add_second(PlaneBracketMap<S>& m, const Vec2<S>& a, const Vec3<S>& x, const Vec3<S>& y) {
    m.c[0] = multiply_add(x[2], y[2], m.c[0]);
    m.t = add(m.t, x[2], Vec2<S>(a - plane_part(y)));
  }
  template <class S>
  static BOUGH_INLINE void add_polar(PlaneBracketMap<S>& m, const Vec2<S>& a, const Vec3<S>& x) {
    m.t = add(m.t, x[2], a);
  }
  template <class S>
  static BOUGH_INLINE PlaneMap<S> plus(const PlaneMap<S>& x, const PlaneMap<S>& y) {
    return {x.c + y.c, x.t + y.t, x.b + y.b};
  }
  template <class S>
  static BOUGH_INLINE PlaneBracketMap<S> plus(const PlaneBracketMap<S>& x, const PlaneBracketMap<S>& y) {
    return {x.c + y.c, x.t + y.t};
  }
  template <class S>
  static BOUGH_INLINE PlaneMap<S> minus(const PlaneMap<S>& x, const PlaneMap<S>& y) {
    return {x.c - y.c, x.t - y.t, x.b - y.b};
  }
  template <class S>
  static BOUGH_INLINE PlaneMap<S> minus(const PlaneMap<S>& x, const PlaneBracketMap<S>& y) {
    return {x.c - y.c, x.t - y.t, x.b};
  }
  template <class S>
  static BOUGH_INLINE PlaneMap<S> minus(const PlaneBracketMap<S>& x, const PlaneMap<S>& y) {
    return {x.c - y.c, x.t - y.t, -y.b};
  }
  template <class S>
  static BOUGH_INLINE PlaneMap<S> negated(const PlaneMap<S>& x) {
    return {-x.c, -x.t, -x.b};
  }
  template <class A, class S>
  static BOUGH_INLINE PlaneMap<S> scaled(const A& f, const PlaneMap<S>& x) {
    return {f * x.c, f * x.t, f * x.b};
  }
  template <class A, class S>
  static BOUGH_INLINE void add_to(PlaneMap<S>& m, const A& f, const PlaneMap<S>& x) {
    m.c = add(m.c, f, x.c);
    m.t = add(m.t, f, x.t);
    m.b = multiply_add(f, x.b, m.b);
  }
  template <class T, class A, class S>
  static BOUGH_INLINE void add_to(T& m, const A& f, const PlaneBracketMap<S>& x) {
    m.c = add(m.c, f, x.c);
    m.t = add(m.t, f, x.t);
  }
  template <class S>
  static BOUGH_INLINE PlaneMap<S> product(const PlaneMap<S>& x, const PlaneMap<S>& y) {
    return {complex_times(x.c, y.c), add(complex_times(x.c, y.t), y.b, x.t), x.b * y.b};
  }
  template <class S>
  static BOUGH_INLINE PlaneBracketMap<S> product(const PlaneBracketMap<S>& x, const PlaneMap<S>& y) {
    return {complex_times(x.c, y.c), add(complex_times(x.c, y.t), y.b, x.t)};
  }
  template <class T, class S>
  static BOUGH_INLINE void add_product(T& m, const PlaneBracketMap<S>& x, const PlaneMap<S>& y) {
    m.c = add_complex(m.c, x.c, y.c);
    m.t = add(add_complex(m.t, x.c, y.t), y.b, x.t);
  }
  template <class T, class S>
  static BOUGH_INLINE void add_product(T& m, const PlaneBracketMap<S>& x, const PlaneBracketMap<S>& y) {
    m.c = add_complex(m.c, x.c, y.c);
    m.t = add_complex(m.t, x.c, y.t);
  }
  template <class S>
  static BOUGH_INLINE Vec3<S> times(const PlaneMap<S>& m, const Vec3<S>& y) {
    return join(add(complex_times(m.c, plane_part(y)), y[2], m.t), S(m.b * y[2]));
  }
  template <class S>
  static BOUGH_INLINE Vec2<S> times(const PlaneBracketMap<S>& m, const Vec3<S>& y) {
    return add(complex_times(m.c, plane_part(y)), y[2], m.t);
  }
  template <class S>
  static BOUGH_INLINE Vec3<S> transpose_times(const PlaneMap<S>& m, const Vec3<S>& n) {
    const Vec2<S> f = plane_part(n);
    return join(conjugate_times(m.c, f), S(m.b * n[2] + lanes::dot(m.t, f)));
  }
  template <class S>
  static BOUGH_INLINE Vec3<S> transpose_times(const PlaneBracketMap<S>& m, const Vec3<S>& n) {
    const Vec2<S> f = plane_part(n);
    return join(conjugate_times(m.c, f), S(lanes::dot(m.t, f)));
  }
  template <class S>
  static BOUGH_INLINE PlaneMap<S> inverse_adjoint_map(const PlanePose<S>& H) {
    return {{{H.turn[0], -H.turn[1]}}, conjugate_times(H.turn, quarter_turn(H.x)), S(1.0)};
  }

  // ---- maps to wrenches

  template <class S>
  static BOUGH_INLINE PlaneWrenchMap<S> hat(const Vec3<S>& n) {
    return {{{n[1], -n[0]}}, {{-n[1], n[0]}}, S(0.0)};
  }
  template <class S>
  static BOUGH_INLINE void add_dual_second(PlaneWrenchMap<S>& m, const Vec3<S>& a, const Vec3<S>& x, const Vec3<S>& n) {
    m.column = add(m.column, x[2], Vec2<S>{{a[0] - n[0], a[1] - n[1]}});
    m.corner = multiply_add(x[2], a[2], multiply_add(x[1], n[1], multiply_add(x[0], n[0], m.corner)));
  }
  template <class S>
  static BOUGH_INLINE void add_symmetric_polar(PlaneWrenchMap<S>& m, const Vec3<S>& a, const Vec3<S>& x) {
    const Vec2<S> side = x[2] * plane_part(a);
    m.column = m.column + side;
    m.row = m.row + side;
    m.corner = multiply_add(x[2], S(a[2] + a[2]), m.corner);
  }
  template <class S>
  static BOUGH_INLINE void subtract_symmetric_pair(PlaneWrenchMap<S>& m, const Vec3<S>& y, const Vec3<S>& n) {
    const Vec2<S> side = y[2] * plane_part(n);
    const S half = multiply_add(y[1], n[1], S(y[0] * n[0]));
    m.column = m.column + side;
    m.row = m.row + side;
    m.corner = m.corner - (half + half);
  }
  template <class S>
  static BOUGH_INLINE void add_pairing(PlaneWrenchMap<S>& m, const S& f) {
    m.corner = m.corner + f;
  }
  template <class S>
  static BOUGH_INLINE PlaneWrenchMap<S> plus(const PlaneWrenchMap<S>& x, const PlaneWrenchMap<S>& y) {
    return {x.column + y.column, x.row + y.row, x.corner + y.corner};
  }
  template <class S>
  static BOUGH_INLINE PlaneWrenchMap<S> transposed(const PlaneWrenchMap<S>& m) {
    return {m.row, m.column, m.corner};
  }

  // ---- full blocks

  template <class A, class S>
  static BOUGH_INLINE Mat3<S> block_product(const Mat3<A>& m, const PlaneMap<S>& x) {
    Mat3<S> r;
    for (int i = 0; i < 3; ++i) {
      r(i, 0) = multiply_add(m(i, 1), x.c[1], S(m(i, 0) * x.c[0]));
      r(i, 1) = negative_multiply_add(m(i, 0), x.c[1], S(m(i, 1) * x.c[0]));
      r(i, 2) = multiply_add(m(i, 2), x.b, multiply_add(m(i, 1), x.t[1], S(m(i, 0) * x.t[0])));
    }
    return r;
  }
  template <class A, class S>
  static BOUGH_INLINE Mat3<S> block_product(const Mat3<A>& m, const PlaneBracketMap<S>& x) {
    Mat3<S> r;
    for (int i = 0; i < 3; ++i) {
      r(i, 0) = multiply_add(m(i, 1), x.c[1], S(m(i, 0) * x.c[0]));
      r(i, 1) = negative_multiply_add(m(i, 0), x.c[1], S(m(i, 1) * x.c[0]));
      r(i, 2) = multiply_add(m(i, 1), x.t[1], S(m(i, 0) * x.t[0]));
    }
    return r;
  }
  template <class A, class S>
  static BOUGH_INLINE void add_block_product(Mat3<S>& r, const Mat3<A>& m, const PlaneMap<S>& x) {
    for (int i = 0; i < 3; ++i) {
      r(i, 0) = multiply_add(m(i, 1), x.c[1], multiply_add(m(i, 0), x.c[0], r(i, 0)));
      r(i, 1) = negative_multiply_add(m(i, 0), x.c[1], multiply_add(m(i, 1), x.c[0], r(i, 1)));
      r(i, 2) = multiply_add(m(i, 2), x.b, multiply_add(m(i, 1), x.t[1], multiply_add(m(i, 0), x.t[0], r(i, 2))));
    }
  }
  template <class A, class S>
  static BOUGH_INLINE void add_block_product(Mat3<S>& r, const Mat3<A>& m, const PlaneBracketMap<S>& x) {
    for (int i = 0; i < 3; ++i) {
      r(i, 0) = multiply_add(m(i, 1), x.c[1], multiply_add(m(i, 0), x.c[0], r(i, 0)));
      r(i, 1) = negative_multiply_add(m(i, 0), x.c[1], multiply_add(m(i, 1), x.c[0], r(i, 1)));
      r(i, 2) = multiply_add(m(i, 1), x.t[1], multiply_add(m(i, 0), x.t[0], r(i, 2)));
    }
  }
  template <class S, class A>
  static BOUGH_INLINE Mat3<S> transposed_product(const PlaneMap<S>& x, const Mat3<A>& m) {
    Mat3<S> r;
    for (int j = 0; j < 3; ++j) {
      r(0, j) = multiply_add(x.c[1], m(1, j), S(x.c[0] * m(0, j)));
      r(1, j) = negative_multiply_add(x.c[1], m(0, j), S(x.c[0] * m(1, j)));
      r(2, j) = multiply_add(x.b, m(2, j), multiply_add(x.t[1], m(1, j), S(x.t[0] * m(0, j))));
    }
    return r;
  }
  template <class S, class A>
  static BOUGH_INLINE Mat3<S> transposed_product(const PlaneBracketMap<S>& x, const Mat3<A>& m) {
    Mat3<S> r;
    for (int j = 0; j < 3; ++j) {
      r(0, j) = multiply_add(x.c[1], m(1, j), S(x.c[0] * m(0, j)));
      r(1, j) = negative_multiply_add(x.c[1], m(0, j), S(x.c[0] * m(1, j)));
      r(2, j) = multiply_add(x.t[1], m(1, j), S(x.t[0] * m(0, j)));
    }
    return r;
  }
  template <class S>
  static BOUGH_INLINE void add_ad_transposed(Mat3<S>& r, const Vec3<S>& d, const Mat3<S>& m) {
    for (int j = 0; j < 3; ++j) {
      r(0, j) = multiply_add(d[2], m(1, j), r(0, j));
      r(1, j) = negative_multiply_add(d[2], m(0, j), r(1, j));
      r(2, j) = negative_multiply_add(d[0], m(1, j), multiply_add(d[1], m(0, j), r(2, j)));
    }
  }
  template <class S>
  static BOUGH_INLINE void add_wrench_map(Mat3<S>& r, const PlaneWrenchMap<S>& w) {
    r(0, 2) = r(0, 2) + w.column[0];
    r(1, 2) = r(1, 2) + w.column[1];
    r(2, 0) = r(2, 0) + w.row[0];
    r(2, 1) = r(2, 1) + w.row[1];
    r(2, 2) = r(2, 2) + w.corner;
  }
  template <class S>
  static BOUGH_INLINE void add_wrench_product(Mat3<S>& r, const PlaneWrenchMap<S>& w, const PlaneMap<S>& x) {
    r(0, 2) = multiply_add(w.column[0], x.b, r(0, 2));
    r(1, 2) = multiply_add(w.column[1], x.b, r(1, 2));
    r(2, 0) = multiply_add(w.row[1], x.c[1], multiply_add(w.row[0], x.c[0], r(2, 0)));
    r(2, 1) = negative_multiply_add(w.row[0], x.c[1], multiply_add(w.row[1], x.c[0], r(2, 1)));
    r(2, 2) = multiply_add(w.corner, x.b, multiply_add(w.row[1], x.t[1], multiply_add(w.row[0], x.t[0], r(2, 2))));
  }
  template <class C, class S>
  static BOUGH_INLINE Mat3<S> gyroscopic(const Mat3<C>& m, const Vec3<S>& v) {
    const Vec3<S> momentum = m * v;
    Mat3<S> r;
    for (int j = 0; j < 3; ++j) {
      r(0, j) = -(v[2] * m(1, j));
      r(1, j) = v[2] * m(0, j);
      r(2, j) = negative_multiply_add(v[1], m(0, j), S(v[0] * m(1, j)));
    }
    r(0, 2) = r(0, 2) - momentum[1];
    r(1, 2) = r(1, 2) + momentum[0];
    r(2, 0) = r(2, 0) + momentum[1];
    r(2, 1) = r(2, 1) - momentum[0];
    return r;
  }
  template <class S>
  static BOUGH_INLINE void subtract_turned_back(PlaneMap<S>& m, const Vec2<S>& components) {
    m.t = m.t + quarter_turn(components);
  }
};

}  // namespace bough::motion
