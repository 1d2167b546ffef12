#pragma once
/// The compact algebra of SE(2): vectors, numbers and brackets; see group_se3.hpp for the meaning of the names.
#include "bough/motion/coefficients.hpp"
#include "bough/motion/se2.hpp"

namespace bough::motion {

/// Pose in a plane: the rotation e^(i theta) as (cos, sin), and the origin [m].
template <class S>
struct PlanePose {
  Vec2<S> R, x;
  static PlanePose identity() { return {{{S(1.0), S(0.0)}}, Vec2<S>::zero()}; }
};
/// y -> c y_u + t y_theta, a displacement.
template <class S>
struct PlaneBracketMap {
  Vec2<S> c, t;
  static PlaneBracketMap zero() { return {Vec2<S>::zero(), Vec2<S>::zero()}; }
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
struct Se2Algebra {
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
  static constexpr int translations = 2;
  static constexpr bool turns = true, has_moving_frames = false;
  template <class S>
  using Translation = Vec2<S>;
  template <class S>
  using Rotation = Vec2<S>;  ///< (cos, sin)
  template <class C>
  struct Direction {
    static constexpr bool has_numbers = true;
    Vec2<C> d{{C(1.0), C(0.0)}};
    static Direction axial() { return {}; }
  };

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
  /// v + a translation by u.
  template <class S>
  static BOUGH_INLINE Vec3<S> add_translation(const Vec3<S>& v, const Vec2<S>& u) {
    return {{v[0] + u[0], v[1] + u[1], v[2]}};
  }

  template <class S>
  static BOUGH_INLINE auto log(const PlanePose<S>& H, Vec3<S>& d, S& x) {
    const S angle = angle_of(H.R[0], H.R[1]);
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
  static BOUGH_INLINE Vec3<S> add_dual_bracket(const Vec3<S>& r, const Vec3<S>& x, const Vec3<S>& n) {
    return {{multiply_add(x[2], n[1], r[0]), negative_multiply_add(x[2], n[0], r[1]),
             negative_multiply_add(x[0], n[1], multiply_add(x[1], n[0], r[2]))}};
  }
  template <class S>
  static BOUGH_INLINE Vec3<S> subtract_dual_bracket(const Vec3<S>& r, const Vec3<S>& x, const Vec3<S>& n) {
    return {{negative_multiply_add(x[2], n[1], r[0]), multiply_add(x[2], n[0], r[1]),
             multiply_add(x[0], n[1], negative_multiply_add(x[1], n[0], r[2]))}};
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
  static BOUGH_INLINE S real_power(const Vec3<S>& n, const Vec3<S>& y) {
    return lanes::dot(n, y);
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

  /// f d - e0, a strain.
  template <class C, class S>
  static BOUGH_INLINE Vec3<S> strain(const C& f, const Vec3<S>& d, const Vec3<C>& e0) {
    Vec3<S> e;
    for (int i = 0; i < 3; ++i) e[i] = f * d[i] - e0[i];
    return e;
  }
  template <class S>
  static BOUGH_INLINE void put(const Vec3<S>& n, S* out) {
    for (int k = 0; k < 3; ++k) out[k] = n[k];
  }
  /// The wrench of a force f without a moment, written to `out` or returned.
  template <class S>
  static BOUGH_INLINE void put_force(const Vec2<S>& f, S* out) {
    out[0] = f[0];
    out[1] = f[1];
    out[2] = S(0.0);
  }
  template <class S>
  static BOUGH_INLINE Vec3<S> force(const Vec2<S>& f) {
    return join(f, S(0.0));
  }
  /// Components in the axes of H of a wrench given in inertial axes, about the same point.
  template <class S>
  static BOUGH_INLINE Vec3<S> wrench_turned_back(const PlanePose<S>& H, const Vec3<S>& n) {
    return join(conjugate_times(H.R, plane_part(n)), n[2]);
  }
  /// Components in the axes of H exp(d) of a wrench given in inertial axes, about the same point.
  template <class S>
  static BOUGH_INLINE Vec3<S> turned_back(const PlanePose<S>& H, const Vec3<S>& d, const Vec3<S>& n) {
    const lanes::Vec<S, 8> c = eval_stumpff(S(d[2] * d[2]));
    const Vec2<S> turn = complex_times(H.R, Vec2<S>{{c[0], S(d[2] * c[1])}});
    return join(conjugate_times(turn, plane_part(n)), n[2]);
  }

  /// M (u; 0)
  template <class C, class S>
  static BOUGH_INLINE Vec3<S> matrix_times(const Mat3<C>& m, const Vec2<S>& u) {
    Vec3<S> n;
    for (int i = 0; i < 3; ++i) n[i] = multiply_add(m(i, 1), u[1], S(m(i, 0) * u[0]));
    return n;
  }
};

}  // namespace bough::motion
