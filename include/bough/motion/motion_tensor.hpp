#pragma once
/// General motion of a rigid body as one screw: Mozzi-Chasles axis, intrinsic displacement, pitch, intrinsic motion.
/// A motion is given by its Frame: the reference point (origin) moves by u = x, the body turns by R. Equation numbers
/// are those of theory/motions.md. For post-processing and model set-up: doubles, pure, no allocation, no failure.
/// Errors are a few round-off of |u|/(2 sin(phi/2)) in w and the axis, of |u| in d and all displacements.
#include <optional>

#include "bough/motion/se3.hpp"

namespace bough::motion {

enum class MotionKind {
  none,         ///< R = I, u = 0: no axis
  translation,  ///< R = I: direction n = u/|u|, any line along n is an axis; the pitch is infinite
  screw         ///< one axis
};

/// Intrinsic motion M = (d, phi, w, n) [1.10]: the axis has Plücker coordinates (w; n). intrinsic_motion gives
/// 0 <= phi <= pi; the functions below take any 0 <= phi < 2 pi, where sin(phi/2) does not vanish again.
struct IntrinsicMotion {
  MotionKind kind = MotionKind::none;
  double d = 0.0;                         ///< displacement along the axis, the same for all points [m]
  double phi = 0.0;                       ///< rotation angle [rad]
  Vec3<double> w = Vec3<double>::zero();  ///< moment of the axis about the reference point, w = r x n [m]
  Vec3<double> n = Vec3<double>::zero();  ///< unit axis; zero for MotionKind::none
};

/// Screw of a motion. A rotation of at most smallest_angle [rad] counts as none, since the axis of a rotation that is
/// only rounding of R is noise. By default only phi = 0 (up to underflow) counts as none; 1e-14 suits products of
/// rotations.
///   d = n.u [1.7],  w = G^T (u - d n) / (2 sin(phi/2)) [1.47],  G = exp(phi ~n / 2)
/// Translation: w = 0, the axis through the reference point.
IntrinsicMotion intrinsic_motion(const Frame<double>& motion, double smallest_angle = 1e-150);

/// The motion of a screw: u = d n + 2 sin(phi/2) G w [1.46].
Frame<double> frame_of(const IntrinsicMotion& m);

/// Displacement of the body point at r [m]: d n + 2 sin(phi/2) G w + (R - I) r [1.11].
Vec3<double> displacement_at(const IntrinsicMotion& m, const Vec3<double>& r);

/// Plücker coordinates (moment; direction) of the Mozzi-Chasles axis [1.9]; unit eigenvalue of the motion tensor
/// [1.25].
Vec6<double> mozzi_chasles_axis(const IntrinsicMotion& m);

/// Point of the axis nearest the reference point, r_Q = n x w [1.5].
Vec3<double> nearest_axis_point(const IntrinsicMotion& m);

/// Advance along the axis in one full turn, 2 pi d / phi [m] [1.8]; infinite for a translation, 0 for none.
double pitch(const IntrinsicMotion& m);

/// Displacement of all body points at distance rho from the axis, sqrt(d^2 + (2 rho sin(phi/2))^2) [Ex. 1.1] [m].
double displacement_on_cylinder(const IntrinsicMotion& m, double rho);

/// Factors of the motion tensor, C = T Rblk [1.19]: T = [I, ~u; 0, I] and Rblk = [R, 0; 0, R].
Mat6<double> translation_factor(const Frame<double>& motion);
Mat6<double> rotation_factor(const Frame<double>& motion);

/// N1 = (n; 0), a unit-eigenvalue vector of every motion tensor [1.21]; zero for MotionKind::none, where every 6-vector
/// is one.
Vec6<double> first_eigenvector(const IntrinsicMotion& m);

/// N = (alpha d / (2 sin(phi/2)) n + w; n), the unit-eigenvalue vectors of the motion tensor [1.22-1.24]: alpha = 0
/// is the Mozzi-Chasles axis [1.25], alpha = 1 is N2 [1.21]. Translation: (0; n) for alpha = 0, else N1, since the
/// direction becomes negligible beside the moment as phi -> 0. None: zero.
Vec6<double> screw_vector(const IntrinsicMotion& m, double alpha);

/// lambda = n.m = alpha d / (2 sin(phi/2)) of that vector [1.24], [m]; no value for translations with alpha != 0,
/// where it is infinite. None: 0.
std::optional<double> screw_lambda(const IntrinsicMotion& m, double alpha);

/// E with m = E u, N = (m; n) [1.26-1.27]: a I - ~n/2 + (a - 1/(2 tan(phi/2))) ~n~n, a = alpha/(2 sin(phi/2)), [-].
/// n unit, 0 < phi < 2 pi; no value at phi = 0, where E is infinite: there 2 sin(phi/2) E has the limit
/// alpha I + (alpha - 1) ~n~n.
std::optional<Mat3<double>> moment_of_displacement(const Vec3<double>& n, double phi, double alpha);

/// J = E^-1, u = J m [1.28-1.29]: I/a + (1 - cos phi) ~n + (1/a - sin phi) ~n~n. Regular for all phi, 0 at phi = 0; no
/// value for alpha = 0, where E removes the part of u along n.
std::optional<Mat3<double>> displacement_of_moment(const Vec3<double>& n, double phi, double alpha);

/// c1 = cos phi - alpha cos(phi/2), c2 = sin phi - 2 alpha sin(phi/2) [1.32].
struct IntrinsicCoefficients {
  double c1, c2;
};
IntrinsicCoefficients intrinsic_coefficients(double phi, double alpha);

/// Z(x, y) = [y I, x I; 0, y I] [1.34]; Z(x1, y1) Z(x2, y2) = Z(x1 y2 + y1 x2, y1 y2), and Z commutes with ~N.
Mat6<double> z_matrix(double x, double y);

/// Motion tensor and its inverse from N = screw_vector(m, alpha) with cos phi and sin phi only [1.36a, b]:
///   C^{+-1} = I +- Z(d c1, sin phi) ~N + Z(d c2, 1 - cos phi) ~N ~N
/// Errors: a few round-off of |d| (1 + |alpha|) + |u|. For a translation and for no motion, where N is infinite or
/// undetermined, the result is the limit I +- d ~N1.
Mat6<double> motion_tensor(const IntrinsicMotion& m, double alpha);
Mat6<double> inverse_motion_tensor(const IntrinsicMotion& m, double alpha);

/// Screw axis of a velocity V = (v; omega) [1.52-1.54]: Plücker coordinates (moment; unit direction) of the
/// instantaneous axis and the sliding speed along it. A translation has direction v/|v| and moment 0.
struct VelocityScrew {
  MotionKind kind = MotionKind::none;
  double sliding_speed = 0.0;                ///< along the axis [m/s]
  double angular_speed = 0.0;                ///< >= 0 [rad/s]
  Vec6<double> axis = Vec6<double>::zero();  ///< (moment [m]; unit direction)
};
VelocityScrew velocity_screw(const Vec6<double>& V);

/// Point of the screw axis nearest the reference point, ~omega v / omega^2 [1.52] [m].
Vec3<double> nearest_axis_point(const VelocityScrew& s);

}  // namespace bough::motion
