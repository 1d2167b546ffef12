#pragma once
/// The group SE(2) for elements: the functions of group_se3.hpp for motions (u; theta) of a plane, with displacements
/// as complex numbers. Brackets are displacements without rotation, so maps to brackets are stored without their last
/// row. Numbers that commute with ad(d) are plain, since <x, y> = x_theta y_theta. No structural zero is stored or
/// multiplied.
#include "bough/motion/group_se2_blocks.hpp"

namespace bough::motion {

struct Se2 : Se2Blocks {
  using Se2Blocks::log;
  using Se2Blocks::turned_back;
  // ---- poses

  template <class S>
  static BOUGH_INLINE PlanePose<S> compose(const PlanePose<S>& a, const PlanePose<S>& b) {
    return {complex_times(a.R, b.R), Vec2<S>(a.x + complex_times(a.R, b.x))};
  }
  /// H_a^-1 H_b
  template <class S>
  static BOUGH_INLINE PlanePose<S> relative(const PlanePose<S>& a, const PlanePose<S>& b) {
    return {conjugate_times(a.R, b.R), conjugate_times(a.R, Vec2<S>(b.x - a.x))};
  }
  template <class S>
  static PlanePose<S> exp(const Vec3<S>& d) {
    const lanes::Vec<S, 8> c = eval_stumpff(S(d[2] * d[2]));
    return {{{c[0], S(d[2] * c[1])}}, complex_times(Vec2<S>{{c[1], S(d[2] * c[2])}}, plane_part(d))};
  }
  template <class S>
  static Vec3<S> log(const PlanePose<S>& H) {
    Vec3<S> d;
    S square;
    static_cast<void>(log(H, d, square));
    return d;
  }
  /// Ad(H)^-1 v: the components in the frame H of a twist v given in its parent frame. A: scalar of a constant pose.
  template <class A, class S>
  static BOUGH_INLINE Vec3<S> inverse_adjoint_times(const PlanePose<A>& H, const Vec3<S>& v) {
    const Vec2<S> here{{v[0] - v[2] * H.x[1], v[1] + v[2] * H.x[0]}};
    return join(conjugate_times(H.R, here), v[2]);
  }
  /// Ad(H)^-T f: a wrench f given in the frame H, expressed in the parent frame and about its origin.
  template <class A, class S>
  static BOUGH_INLINE Vec3<S> inverse_adjoint_transpose_times(const PlanePose<A>& H, const Vec3<S>& f) {
    const Vec2<S> turned = complex_times(H.R, plane_part(f));
    return join(turned, S(f[2] + (H.x[0] * turned[1] - H.x[1] * turned[0])));
  }

  /// Linear part of a vector; R u and R^T u for a direction u; w x u, with w the angular part of a twist.
  template <class S>
  static BOUGH_INLINE Vec2<S> linear(const Vec3<S>& v) {
    return plane_part(v);
  }
  template <class S>
  static BOUGH_INLINE Vec2<S> turned(const PlanePose<S>& H, const Vec2<S>& u) {
    return complex_times(H.R, u);
  }
  template <class S>
  static BOUGH_INLINE Vec2<S> turned_back(const PlanePose<S>& H, const Vec2<S>& u) {
    return conjugate_times(H.R, u);
  }
  template <class S>
  static BOUGH_INLINE Vec2<S> spin(const Vec3<S>& v, const Vec2<S>& u) {
    return v[2] * quarter_turn(u);
  }
};

}  // namespace bough::motion
