#pragma once
/// Half-angle rotation G, R = G G, and R - I without cancellation: R - I = 2 sin(phi/2) ~n G. Pure, no allocation, no
/// failure; accurate from phi = 0, where G = I, to phi = pi, where two half rotations exist and one is returned.
#include "bough/motion/so3.hpp"

namespace bough::motion {

/// The unit quaternion of half the angle, (|q| + w; v) normalised: needs w >= 0, |q| need not be 1.
template <class S>
Quaternion<S> half_quaternion(const Quaternion<S>& q) {
  using std::sqrt;
  return normalise(Quaternion<S>{sqrt(q.w * q.w + dot(q.v, q.v)) + q.w, q.v});
}
/// G = exp(phi ~n / 2) of R = exp(phi ~n), 0 <= phi <= pi.
template <class S>
Mat3<S> half_rotation(const Mat3<S>& R) {
  return rotation_of(half_quaternion(quaternion_of(R)));
}
/// (R - I) a = 2 v x (w a + v x a) of the unit quaternion (w; v): errors relative to 2 sin(phi/2) |a|, not to |a|.
template <class S>
Vec3<S> rotation_change(const Quaternion<S>& q, const Vec3<S>& a) {
  const Vec3<S> r = cross(q.v, q.w * a + cross(q.v, a));
  return r + r;
}
/// Displacement of the body point at s from the reference point, u + (R - I) s [1.2]. Lengths [m].
template <class S>
Vec3<S> point_displacement(const Frame<S>& motion, const Vec3<S>& s) {
  return motion.x + rotation_change(normalise(quaternion_of(motion.R)), s);
}

}  // namespace bough::motion
