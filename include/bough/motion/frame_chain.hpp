#pragma once
/// Nested frames: frame i rotates and translates in frame i-1, i = 1 .. n. Frame 0 is the base, which is the inertial
/// frame if the chain starts there. All quantities are numbers at one time; functions of time belong to higher layers.
///   w_i      angular velocity of frame i in frame i-1 [rad/s];  W_ab = sum of the w_i between: of b relative to a
///   a_i      derivative of w_i from frame i, which is that from frame i-1 [rad/s^2]
///   d_g x    derivative of the vector x as seen from frame g
/// Any frame of the chain may be the observer, also one after the point's frame: sums then run backwards with a minus.
/// The functions use doubles, are pure, do not allocate and throw std::invalid_argument for a frame that is not in the
/// chain. Errors are a few round-off of the sum of the magnitudes of the terms. Equation numbers: Harithuddin,
/// Trivailo, Jazar 2015 (data/manual/theory/motions.md).
#include <vector>

#include "bough/motion/resolved.hpp"

namespace bough::motion {

/// Motion of a frame in its parent at one time. All components in the parent's axes, all derivatives from the parent.
struct FrameMotion {
  Frame<double> pose = Frame<double>::identity();            ///< of the frame in its parent [-, m]
  Vec3<double> velocity = Vec3<double>::zero();              ///< of the origin, dx/dt [m/s]
  Vec3<double> acceleration = Vec3<double>::zero();          ///< of the origin, d2x/dt2 [m/s^2]
  Vec3<double> angular_velocity = Vec3<double>::zero();      ///< w [rad/s]
  Vec3<double> angular_acceleration = Vec3<double>::zero();  ///< dw/dt [rad/s^2]
};

/// From the twist V = (v; omega) in the frame's own axes, Hdot = H ~V, and its rate:
///   dx/dt = R v,  d2x/dt2 = R (dv/dt + omega x v),  w = R omega,  dw/dt = R domega/dt.
FrameMotion motion_from_twist(const Frame<double>& pose, const Vec6<double>& twist, const Vec6<double>& twist_rate);

/// w of Rdot R^T = ~w [2.52-2.54]: the angular velocity in the parent's axes. The symmetric part of Rdot R^T, which is
/// an error of the data, has no effect.
Vec3<double> angular_velocity_of(const Mat3<double>& R, const Mat3<double>& R_rate);

/// dw/dt of Rddot R^T + Rdot Rdot^T = (dw/dt)~ [2.52-2.60], in the parent's axes.
Vec3<double> angular_acceleration_of(const Mat3<double>& R, const Mat3<double>& R_rate, const Mat3<double>& R_second);

/// The frames of a chain. Only the constructor allocates.
class FrameChain {
 public:
  /// links[i - 1] is the motion of frame i in frame i-1.
  explicit FrameChain(std::vector<FrameMotion> links) : links_(std::move(links)) {}
  int last() const { return static_cast<int>(links_.size()); }  ///< n
  const FrameMotion& link(int i) const;                         ///< 1 <= i <= n
  void set_link(int i, const FrameMotion& motion);              ///< 1 <= i <= n; for another time

 private:
  std::vector<FrameMotion> links_;
};

/// Motion of a point of a frame. Components are in that frame's axes, and derivatives are seen from it.
struct PointMotion {
  int frame = 0;
  Vec3<double> position = Vec3<double>::zero();      ///< r from the frame's origin [m]
  Vec3<double> velocity = Vec3<double>::zero();      ///< r' [m/s]
  Vec3<double> acceleration = Vec3<double>::zero();  ///< r'' [m/s^2]
};

/// The origin of frame i as a point of frame i-1. With it the part `origin` of an acceleration can be split further.
PointMotion origin_of(const FrameChain& chain, int i);

/// Motion of frame b in frame a, as if the chain between them were one link. Components are in the axes of a, and all
/// derivatives are seen from a, also the angular acceleration [2.29].
FrameMotion relative_motion(const FrameChain& chain, Of b, RelativeTo a);

/// The same vector in other axes: no derivative is taken.
Resolved resolve(const FrameChain& chain, const Resolved& x, In axes);

/// Kinematic chain rule W_ab = w_{a+1} + ... + w_b, for b < a minus the sum from b+1 to a [2.23-2.24].
Resolved angular_velocity(const FrameChain& chain, Of b, RelativeTo a, In axes);

/// d_g W_ab = sum_i ( a_i + W_gi x w_i ), i = a+1 .. b [2.29]; a = g = 0, b = 3: a_1 + a_2 + a_3 + W_2 x w_2 + W_3 x
/// w_3 [2.31].
struct AngularAcceleration {
  Resolved local;      ///< sum of the a_i
  Resolved transport;  ///< sum of the W_gi x w_i, since the axes turn
  Resolved total() const { return local + transport; }
};
AngularAcceleration angular_acceleration(const FrameChain& chain, Of b, RelativeTo a, From g, In axes);

/// Euler transformation d_A x = d_B x + W_AB x x [2.2, 2.16]; B is the rate's own observer. The result is in the axes
/// of x.
Rate derivative(const FrameChain& chain, const Resolved& x, const Rate& rate, From observer);

/// Mixed transformation for a vector x of frame C [2.22]: d_A x = d_B x + (W_AC - W_BC) x x. B is the rate's own
/// observer. The result equals that of `derivative`, here computed from the angular velocities of C.
Rate mixed_derivative(const FrameChain& chain, const Resolved& x, const Rate& rate, Of c, From observer);

/// d_B (d_A r) of the vector r of a point of frame C [2.35]. With A = B, `tangential` is the sum of the tangential and
/// Razi parts of acceleration_split, and `razi` is zero.
struct MixedAcceleration {
  Resolved local;        ///< r''
  Resolved coriolis;     ///< (W_BC + W_AC) x r'
  Resolved tangential;   ///< (d_C W_AC) x r
  Resolved razi;         ///< (W_BC x W_AC) x r, the mixed Razi acceleration
  Resolved centripetal;  ///< W_AC x (W_BC x r), the mixed centripetal acceleration
  Resolved total() const { return local + coriolis + tangential + razi + centripetal; }
};
/// first: A, from which the derivative is taken first; second: B. The origins of the frames do not matter: r is
/// differentiated as a vector.
MixedAcceleration mixed_acceleration(const FrameChain& chain, const PointMotion& r, From first, From second, In axes);

/// Velocity of a point of frame n seen from frame g.
struct VelocityParts {
  Resolved local;       ///< r'
  Resolved tangential;  ///< W_gn x r [2.2]
  Resolved origin;      ///< of the origin of frame n
  Resolved total() const { return local + tangential + origin; }
};
VelocityParts velocity_split(const FrameChain& chain, const PointMotion& r, From g, In axes);

/// Acceleration of a point of frame n seen from frame g [2.44-2.45; two frames 2.18, three 2.42].
struct AccelerationParts {
  Resolved local;        ///< r''
  Resolved tangential;   ///< (sum a_i) x r
  Resolved coriolis;     ///< 2 W_gn x r'
  Resolved centripetal;  ///< W_gn x (W_gn x r)
  Resolved razi;         ///< sum_i (W_gi x w_i) x r
  Resolved origin;       ///< of the origin of frame n, which is at rest in the source; see origin_of
  Resolved total() const { return local + tangential + coriolis + centripetal + razi + origin; }
};
AccelerationParts acceleration_split(const FrameChain& chain, const PointMotion& r, From g, In axes);

/// The point as seen from another frame: position, velocity and acceleration there.
PointMotion observe(const FrameChain& chain, const PointMotion& r, From g);

/// Forces on a mass observed in frame n [2.46-2.48]. The applied force is F = m total, the inertial forces are minus
/// the other terms, so m r'' = F + tangential + coriolis + centrifugal + razi + origin [N].
struct InertialForces {
  Resolved applied;      ///< F, which the motion requires
  Resolved tangential;   ///< Euler force
  Resolved coriolis;     ///< Coriolis force
  Resolved centrifugal;  ///< centrifugal force
  Resolved razi;         ///< Razi force
  Resolved origin;       ///< from the translation of the frames
  /// Sum of the inertial forces, which an observer in frame n adds to the applied force.
  Resolved sum() const { return tangential + coriolis + centrifugal + razi + origin; }
};
/// mass [kg]; the parts must be seen from an inertial frame.
InertialForces inertial_forces(double mass, const AccelerationParts& parts);

}  // namespace bough::motion
