#pragma once
/// Maps of motions on SE(2) in compact form; see group_se3.hpp for the meaning of the names.
#include "bough/motion/group_se2_algebra.hpp"

namespace bough::motion {

struct Se2Maps : Se2Algebra {
  using Se2Algebra::scaled;
  using Se2Algebra::times;
  template <class S>
  static BOUGH_INLINE PlaneBracketMap<S> ad(const Vec3<S>& x) {
    return {{{S(0.0), x[2]}}, {{x[1], -x[0]}}};
  }
  template <class S>
  static BOUGH_INLINE PlaneBracketMap<S> ad(const Vec2<S>& x) {
    return {Vec2<S>::zero(), {{x[1], -x[0]}}};
  }
  template <class S>
  static BOUGH_INLINE PlaneMap<S> with_diagonal(const PlaneMap<S>& m, double f) {
    return {{{m.c[0] + f, m.c[1]}}, m.t, m.b + f};
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
  template <class S>
  static BOUGH_INLINE void subtract_product(PlaneMap<S>& m, const PlaneBracketMap<S>& x, const PlaneMap<S>& y) {
    m.c = subtract_complex(m.c, x.c, y.c);
    m.t = add(subtract_complex(m.t, x.c, y.t), S(-y.b), x.t);
  }
  /// m -= x ad(v)
  template <class S>
  static BOUGH_INLINE void subtract_times_ad(PlaneBracketMap<S>& m, const PlaneBracketMap<S>& x, const Vec3<S>& v) {
    const Vec2<S> turned = quarter_turn(x.c);  // c i
    m.c = add(m.c, S(-v[2]), turned);
    m.t = add_complex(m.t, turned, plane_part(v));
  }
  /// The same map with its last row, which is zero.
  template <class S>
  static BOUGH_INLINE PlaneMap<S> as_map(const PlaneBracketMap<S>& m) {
    return {m.c, m.t, S(0.0)};
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
    return {{{H.R[0], -H.R[1]}}, conjugate_times(H.R, quarter_turn(H.x)), S(1.0)};
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
  static BOUGH_INLINE PlaneWrenchMap<S> transposed(const PlaneWrenchMap<S>& m) {
    return {m.row, m.column, m.corner};
  }
};

}  // namespace bough::motion
