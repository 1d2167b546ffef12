/// The walk along a chain and the parts of velocities and accelerations that follow from it.
#include <stdexcept>
#include <string>

#include "frame_walk.hpp"

namespace bough::motion {

namespace {

void require_frame(const FrameChain& chain, int frame) {
  if (frame < 0 || frame > chain.last())
    throw std::invalid_argument("frame chain: the frames are 0 to " + std::to_string(chain.last()) + ", not " +
                                std::to_string(frame));
}

/// Adds `sign` times the motion, as seen from g, of a vector that has the value x and the derivatives `rate` and
/// `second` in the frame reached (all components in the axes of g).
void add_vector(Walk& w, double sign, const Vec3<double>& x, const Vec3<double>& rate, const Vec3<double>& second) {
  const Vec3<double>& W = w.angular_velocity;
  w.pose.x += sign * x;
  w.velocity += sign * (rate + cross(W, x));
  w.acceleration += sign * (second + 2.0 * cross(W, rate) + cross(w.local + w.transport, x) + cross(W, cross(W, x)));
}

/// Goes from frame i-1 to frame i.
void step_out(Walk& w, const FrameMotion& link) {
  const Mat3<double> R = w.pose.R;
  add_vector(w, 1.0, R * link.pose.x, R * link.velocity, R * link.acceleration);
  const Vec3<double> turn = R * link.angular_velocity;
  w.transport += cross(w.angular_velocity, turn);  // W_gi x w_i = W_g(i-1) x w_i
  w.local += R * link.angular_acceleration;
  w.angular_velocity += turn;
  w.pose.R = R * link.pose.R;
}

/// Goes back from frame i to frame i-1 and subtracts the terms of step_out. The origin of frame i is a point of frame
/// i-1, so its motion is subtracted after the change of frame.
void step_in(Walk& w, const FrameMotion& link) {
  const Mat3<double> R = w.pose.R * transpose(link.pose.R);
  const Vec3<double> turn = R * link.angular_velocity;
  w.angular_velocity -= turn;
  w.local -= R * link.angular_acceleration;
  w.transport -= cross(w.angular_velocity, turn);
  w.pose.R = R;
  add_vector(w, -1.0, R * link.pose.x, R * link.velocity, R * link.acceleration);
}

}  // namespace

Walk walk(const FrameChain& chain, int g, int b) {
  require_frame(chain, g);
  require_frame(chain, b);
  Walk w;
  for (int i = g + 1; i <= b; ++i) step_out(w, chain.link(i));
  for (int i = g; i > b; --i) step_in(w, chain.link(i));
  return w;
}

Rate derivative(const FrameChain& chain, const Resolved& x, const Rate& rate, From observer) {
  const In axes = x.axes();
  const Resolved W = angular_velocity(chain, Of(rate.observer().frame), RelativeTo(observer.frame), axes);
  return {resolve(chain, rate.value(rate.observer()), axes) + cross(W, x), observer};
}

Rate mixed_derivative(const FrameChain& chain, const Resolved& x, const Rate& rate, Of c, From observer) {
  const In axes = x.axes();
  const Resolved W_ac = angular_velocity(chain, c, RelativeTo(observer.frame), axes);
  const Resolved W_bc = angular_velocity(chain, c, RelativeTo(rate.observer().frame), axes);
  return {resolve(chain, rate.value(rate.observer()), axes) + cross(W_ac - W_bc, x), observer};
}

MixedAcceleration mixed_acceleration(const FrameChain& chain, const PointMotion& r, From first, From second, In axes) {
  const In own(r.frame);
  const Of c(r.frame);
  const Vec3<double> W_ac = angular_velocity(chain, c, RelativeTo(first.frame), own).components(own);
  const Vec3<double> W_bc = angular_velocity(chain, c, RelativeTo(second.frame), own).components(own);
  const Vec3<double> W_ac_rate =
      angular_acceleration(chain, c, RelativeTo(first.frame), From(r.frame), own).total().components(own);
  const Axes change(chain, r.frame, axes);
  return {change(r.acceleration), change(cross(W_bc + W_ac, r.velocity)), change(cross(W_ac_rate, r.position)),
          change(cross(cross(W_bc, W_ac), r.position)), change(cross(W_ac, cross(W_bc, r.position)))};
}

VelocityParts velocity_split(const FrameChain& chain, const PointMotion& r, From g, In axes) {
  const Walk w = walk(chain, g.frame, r.frame);
  const Axes change(chain, g.frame, axes);
  return {change(w.pose.R * r.velocity), change(cross(w.angular_velocity, w.pose.R * r.position)), change(w.velocity)};
}

AccelerationParts acceleration_split(const FrameChain& chain, const PointMotion& r, From g, In axes) {
  const Walk w = walk(chain, g.frame, r.frame);
  const Axes change(chain, g.frame, axes);
  const Vec3<double>& W = w.angular_velocity;
  const Vec3<double> x = w.pose.R * r.position;
  return {.local = change(w.pose.R * r.acceleration),
          .tangential = change(cross(w.local, x)),
          .coriolis = change(2.0 * cross(W, w.pose.R * r.velocity)),
          .centripetal = change(cross(W, cross(W, x))),
          .razi = change(cross(w.transport, x)),
          .origin = change(w.acceleration)};
}

PointMotion observe(const FrameChain& chain, const PointMotion& r, From g) {
  const In axes(g.frame);
  return {g.frame, transform(walk(chain, g.frame, r.frame).pose, r.position),
          velocity_split(chain, r, g, axes).total().components(axes),
          acceleration_split(chain, r, g, axes).total().components(axes)};
}

InertialForces inertial_forces(double mass, const AccelerationParts& parts) {
  return {.applied = mass * parts.total(),
          .tangential = -mass * parts.tangential,
          .coriolis = -mass * parts.coriolis,
          .centrifugal = -mass * parts.centripetal,
          .razi = -mass * parts.razi,
          .origin = -mass * parts.origin};
}

}  // namespace bough::motion
