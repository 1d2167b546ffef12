#pragma once
/// General motion of a rigid body as one screw: Mozzi-Chasles axis, intrinsic displacement, pitch, intrinsic motion.
/// A motion is given by its Frame: the reference point (origin) moves by u = x, the body turns by R. Equation numbers
/// are those of src/motion/README.md. For post-processing and model set-up: doubles, pure, no allocation, no failure.
#include "bough/motion/se3.hpp"

namespace bough::motion {

enum class MotionKind {
  none,         ///< R = I, u = 0: no axis
  translation,  ///< R = I: direction n = u/|u|, any line along n is an axis; the pitch is infinite
  screw         ///< one axis
};

/// Intrinsic motion M = (d, phi, w, n) [1.10]: the axis has Plücker coordinates (w; n).
struct IntrinsicMotion {
  MotionKind kind = MotionKind::none;
  double d = 0.0;                         ///< displacement along the axis, the same for all points [m]
  double phi = 0.0;                       ///< rotation angle, 0 <= phi <= pi [rad]
  Vec3<double> w = Vec3<double>::zero();  ///< moment of the axis about the reference point, w = r x n [m]
  Vec3<double> n = Vec3<double>::zero();  ///< unit axis; zero for MotionKind::none
};

/// Screw of a motion. A rotation of at most smallest_angle [rad] counts as none: the axis of a motion whose rotation is
/// the rounding of R is noise. The default decides by phi = 0 (up to underflow); 1e-14 suits products of rotations.
///   d = n.u [1.7],  w = G^T (u - d n) / (2 sin(phi/2)) [1.47],  G = exp(phi ~n / 2)
/// Translation: w = 0, the axis through the reference point.
IntrinsicMotion intrinsic_motion(const Frame<double>& motion, double smallest_angle = 1e-150);

/// The motion of a screw: u = d n + 2 sin(phi/2) G w [1.46].
Frame<double> frame_of(const IntrinsicMotion& m);

/// Displacement of the body point at r [m]: d n + 2 sin(phi/2) G w + (R - I) r [1.11].
Vec3<double> displacement_at(const IntrinsicMotion& m, const Vec3<double>& r);

/// Plücker coordinates (moment; direction) of the Mozzi-Chasles axis [1.9]; unit eigenvalue of the motion tensor [1.25].
Vec6<double> mozzi_chasles_axis(const IntrinsicMotion& m);

/// Point of the axis nearest the reference point, r_Q = n x w [1.5].
Vec3<double> nearest_axis_point(const IntrinsicMotion& m);

/// Advance along the axis in one full turn, 2 pi d / phi [m] [1.8]; infinite for a translation, 0 for none.
double pitch(const IntrinsicMotion& m);

/// N = (alpha d / (2 sin(phi/2)) n + w; n), the unit-eigenvalue vectors of the motion tensor [1.22-1.24], screws only.
Vec6<double> screw_vector(const IntrinsicMotion& m, double alpha);

/// Motion tensor from a vector N of screw_vector with the same alpha [1.36a], cos phi and sin phi only, screws only:
///   C = I + Z(d c1, sin phi) ~N + Z(d c2, 1 - cos phi) ~N ~N,  Z(x, y) = [y I, x I; 0, y I]
///   c1 = cos phi - alpha cos(phi/2),  c2 = sin phi - 2 alpha sin(phi/2)
Mat6<double> motion_tensor(const IntrinsicMotion& m, double alpha);

/// Screw axis of a velocity V = (v; omega) [1.52-1.54]: Plücker coordinates (moment; unit direction) of the
/// instantaneous axis and the sliding speed along it. A translation has direction v/|v| and moment 0.
struct VelocityScrew {
  MotionKind kind = MotionKind::none;
  double sliding_speed = 0.0;                ///< along the axis [m/s]
  double angular_speed = 0.0;                ///< >= 0 [rad/s]
  Vec6<double> axis = Vec6<double>::zero();  ///< (moment [m]; unit direction)
};
VelocityScrew velocity_screw(const Vec6<double>& V);

}  // namespace bough::motion
