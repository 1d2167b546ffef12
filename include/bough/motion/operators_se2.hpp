#pragma once
/// The operators of operators.hpp on SE(2), where they are complex numbers: f(d) y = (c y_u + k u y_theta; y_theta)
/// of d = (u; theta),
///   c = 1 - theta^2 q + i theta p,   k = theta q - i p,
/// and a prime below is the derivative by theta, p' = 2 theta dp/dX and so on. SE(2) lacks the functions of a group
/// that only the general forms use.
#include "bough/motion/operators.hpp"

namespace bough::motion {

namespace detail {
/// p and its derivatives by X.
template <class S>
struct OddPart {
  S p, dp, ddp;
};
template <class S>
BOUGH_INLINE OddPart<S> odd_numbers(const Tangent<Se2, S>& f) {
  return {f.p, f.dp, f.ddp};
}
template <class S>
BOUGH_INLINE OddPart<S> odd_numbers(const InverseTangent<Se2, S>&) {
  return {S(0.5), S(0.0), S(0.0)};
}
template <template <class, class> class F, class S>
BOUGH_INLINE Vec2<S> plane_c(const F<Se2, S>& f) {
  const S &theta = f.d[2], p = odd_numbers(f).p;
  return {{S(1.0) - theta * theta * f.q, theta * p}};
}
template <template <class, class> class F, class S>
BOUGH_INLINE Vec2<S> plane_k(const F<Se2, S>& f) {
  return {{f.d[2] * f.q, -odd_numbers(f).p}};
}
/// c' and k'.
template <class S>
BOUGH_INLINE Vec2<S> plane_c1(const Tangent<Se2, S>& f) {
  const S &theta = f.d[2], x = theta * theta;
  return {{-2.0 * theta * (f.q + x * f.dq), f.p + 2.0 * x * f.dp}};
}
template <class S>
BOUGH_INLINE Vec2<S> plane_c1(const InverseTangent<Se2, S>& f) {
  const S &theta = f.d[2], x = theta * theta;
  return {{-2.0 * theta * (f.q + x * f.dq), S(0.5)}};
}
/// k' u and k'' u; c''.
template <class S>
BOUGH_INLINE Vec2<S> plane_k1(const Tangent<Se2, S>& f, const Vec2<S>& u) {
  const S &theta = f.d[2], x = theta * theta;
  return complex_times(Vec2<S>{{f.q + 2.0 * x * f.dq, -2.0 * theta * f.dp}}, u);
}
template <class S>
BOUGH_INLINE Vec2<S> plane_k1(const InverseTangent<Se2, S>& f, const Vec2<S>& u) {
  const S &theta = f.d[2], x = theta * theta;
  return S(f.q + 2.0 * x * f.dq) * u;
}
template <class S>
BOUGH_INLINE Vec2<S> plane_k2(const Tangent<Se2, S>& f, const Vec2<S>& u) {
  const S &theta = f.d[2], x = theta * theta;
  return complex_times(Vec2<S>{{theta * (6.0 * f.dq + 4.0 * x * f.ddq), -2.0 * f.dp - 4.0 * x * f.ddp}}, u);
}
template <class S>
BOUGH_INLINE Vec2<S> plane_k2(const InverseTangent<Se2, S>& f, const Vec2<S>& u) {
  const S &theta = f.d[2], x = theta * theta;
  return S(theta * (6.0 * f.dq + 4.0 * x * f.ddq)) * u;
}
template <template <class, class> class F, class S>
BOUGH_INLINE Vec2<S> plane_c2(const F<Se2, S>& f) {
  const S &theta = f.d[2], x = theta * theta;
  const OddPart<S> odd = odd_numbers(f);
  return {{-2.0 * f.q - x * (10.0 * f.dq + 4.0 * x * f.ddq), theta * (6.0 * odd.dp + 4.0 * x * odd.ddp)}};
}
/// c' y_u + y_theta k' u: the derivative of f y by theta.
template <template <class, class> class F, class S>
BOUGH_INLINE Vec2<S> by_angle(const F<Se2, S>& f, const Vec3<S>& y) {
  return Se2::add(complex_times(plane_c1(f), plane_part(y)), y[2], plane_k1(f, plane_part(f.d)));
}
/// c'' y_u + y_theta k'' u
template <template <class, class> class F, class S>
BOUGH_INLINE Vec2<S> by_angle_twice(const F<Se2, S>& f, const Vec3<S>& y) {
  return Se2::add(complex_times(plane_c2(f), plane_part(y)), y[2], plane_k2(f, plane_part(f.d)));
}
}  // namespace detail

template <template <class, class> class F, class S>
BOUGH_INLINE PlaneMap<S> matrix(const F<Se2, S>& f) {
  return {detail::plane_c(f), complex_times(detail::plane_k(f), plane_part(f.d)), S(1.0)};
}
template <template <class, class> class F, class S>
BOUGH_INLINE Vec3<S> times(const F<Se2, S>& f, const Vec3<S>& y) {
  const PlaneMap<S> m = matrix(f);
  return join(Se2::add(complex_times(m.c, plane_part(y)), y[2], m.t), y[2]);
}
template <template <class, class> class F, class S>
BOUGH_INLINE Vec3<S> transpose_times(const F<Se2, S>& f, const Vec3<S>& n) {
  const PlaneMap<S> m = matrix(f);
  const Vec2<S> force = plane_part(n);
  return join(conjugate_times(m.c, force), S(n[2] + lanes::dot(m.t, force)));
}
template <template <class, class> class F, class S>
BOUGH_INLINE Vec2<S> slope_times(const F<Se2, S>& f, const Vec3<S>& e, const Vec3<S>& y) {
  const Vec2<S> own = y[2] * complex_times(detail::plane_k(f), plane_part(e));
  return Se2::add(own, e[2], detail::by_angle(f, y));
}
template <template <class, class> class F, class S>
BOUGH_INLINE PlaneBracketMap<S> slope_matrix(const F<Se2, S>& f, const Vec3<S>& e) {
  return {e[2] * detail::plane_c1(f),
          Se2::add(complex_times(detail::plane_k(f), plane_part(e)), e[2], detail::plane_k1(f, plane_part(f.d)))};
}
template <template <class, class> class F, class S>
BOUGH_INLINE PlaneBracketMap<S> jacobian(const F<Se2, S>& f, const Vec3<S>& y) {
  return {y[2] * detail::plane_k(f), detail::by_angle(f, y)};
}
template <template <class, class> class F, class S>
BOUGH_INLINE PlaneBracketMap<S> second_jacobian(const F<Se2, S>& f, const Vec3<S>& e, const Vec3<S>& y) {
  const Vec2<S> across = y[2] * detail::plane_k1(f, plane_part(e));
  return {S(e[2] * y[2]) * detail::plane_k1(f, Vec2<S>{{S(1.0), S(0.0)}}),
          Se2::add(across, e[2], detail::by_angle_twice(f, y))};
}
template <template <class, class> class F, class S>
BOUGH_INLINE PlaneWrenchMap<S> transpose_jacobian(const F<Se2, S>& f, const Vec3<S>& n) {
  const Vec2<S> force = plane_part(n);
  return {conjugate_times(detail::plane_c1(f), force), conjugate_times(detail::plane_k(f), force),
          lanes::dot(detail::plane_k1(f, plane_part(f.d)), force)};
}
template <class S>
BOUGH_INLINE PlaneWrenchMap<S> hessian(const Tangent<Se2, S>& f, const Vec3<S>& n, const Vec3<S>& y) {
  const Vec2<S> force = plane_part(n), k1 = detail::plane_k1(f, Vec2<S>{{S(1.0), S(0.0)}});
  const Vec2<S> side = y[2] * conjugate_times(k1, force);
  return {side, side, lanes::dot(detail::by_angle_twice(f, y), force)};
}

}  // namespace bough::motion
