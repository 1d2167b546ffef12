#include "bough/motion/spinning_disc.hpp"

namespace bough::motion {

FrameChain chain_of(const SpinningDisc& disc, double psi, double phi) {
  const Vec3<double> axis_3 = Vec3<double>::unit(2);
  const Mat3<double> lean = exp_so3(disc.tilt * Vec3<double>::unit(1));
  FrameMotion shaft, wheel;
  shaft.pose.R = exp_so3(phi * axis_3);
  shaft.angular_velocity = disc.precession * axis_3;
  wheel.pose.R = lean * exp_so3(psi * axis_3);
  wheel.angular_velocity = disc.spin * (lean * axis_3);
  return FrameChain({shaft, wheel});
}

PointMotion point_of(const SpinningDisc& disc) { return {.frame = 2, .position = disc.radius * Vec3<double>::unit(0)}; }

Resolved razi_acceleration(const Resolved& precession, const Resolved& spin, const Resolved& r) {
  return cross(cross(precession, spin), r);
}

}  // namespace bough::motion
