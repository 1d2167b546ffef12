#include "bough/motion/frame_chain.hpp"

#include <stdexcept>
#include <string>

#include "frame_walk.hpp"

namespace bough::motion {

namespace {

/// The vector a whose skew matrix ~a is the skew-symmetric part of M.
Vec3<double> axial(const Mat3<double>& M) {
  return {{0.5 * (M(2, 1) - M(1, 2)), 0.5 * (M(0, 2) - M(2, 0)), 0.5 * (M(1, 0) - M(0, 1))}};
}

}  // namespace

FrameMotion motion_from_twist(const Frame<double>& pose, const Vec6<double>& twist, const Vec6<double>& twist_rate) {
  const Vec3<double> v = linear_part(twist), omega = angular_part(twist);
  return {pose, pose.R * v, pose.R * (linear_part(twist_rate) + cross(omega, v)), pose.R * omega,
          pose.R * angular_part(twist_rate)};
}

Vec3<double> angular_velocity_of(const Mat3<double>& R, const Mat3<double>& R_rate) {
  return axial(R_rate * transpose(R));
}

Vec3<double> angular_acceleration_of(const Mat3<double>& R, const Mat3<double>& R_rate, const Mat3<double>& R_second) {
  // Rdot Rdot^T = -~w ~w is symmetric: adding it only cancels the symmetric part of Rddot R^T.
  return axial(R_second * transpose(R) + R_rate * transpose(R_rate));
}

const FrameMotion& FrameChain::link(int i) const {
  if (i < 1 || i > last())
    throw std::invalid_argument("frame chain: the moving frames are 1 to " + std::to_string(last()) + ", not " +
                                std::to_string(i));
  return links_[static_cast<std::size_t>(i) - 1];
}

void FrameChain::set_link(int i, const FrameMotion& motion) {
  (void)link(i);
  links_[static_cast<std::size_t>(i) - 1] = motion;
}

PointMotion origin_of(const FrameChain& chain, int i) {
  const FrameMotion& m = chain.link(i);
  return {i - 1, m.pose.x, m.velocity, m.acceleration};
}

FrameMotion relative_motion(const FrameChain& chain, Of b, RelativeTo a) {
  const Walk w = walk(chain, a.frame, b.frame);
  return {w.pose, w.velocity, w.acceleration, w.angular_velocity, w.local + w.transport};
}

Resolved resolve(const FrameChain& chain, const Resolved& x, In axes) {
  const Axes change(chain, x.axes().frame, axes);
  return change(x.components(x.axes()));
}

Resolved angular_velocity(const FrameChain& chain, Of b, RelativeTo a, In axes) {
  return Axes(chain, a.frame, axes)(walk(chain, a.frame, b.frame).angular_velocity);
}

AngularAcceleration angular_acceleration(const FrameChain& chain, Of b, RelativeTo a, From g, In axes) {
  // d_g W_ab = d_a W_ab + W_ga x W_ab [2.2], so the transport terms are sum_i W_ai x w_i + W_ga x sum_i w_i.
  const Walk from_a = walk(chain, a.frame, b.frame);
  const Vec3<double> W_ga = -walk(chain, a.frame, g.frame).angular_velocity;
  const Axes change(chain, a.frame, axes);
  return {change(from_a.local), change(from_a.transport + cross(W_ga, from_a.angular_velocity))};
}

}  // namespace bough::motion
