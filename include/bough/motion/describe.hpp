#pragma once
/// A report of one motion: the representations of its rotation, its screw, its parameters and its motion tensor.
/// Equation numbers are those of data/manual/theory/motions.md. Lengths in the unit of the input, angles [rad].
#include <array>
#include <optional>
#include <string_view>

#include "bough/motion/motion_tensor.hpp"

namespace bough::motion {

/// Parameters of one vectorial parameterization (parameterization.hpp): p of the rotation, P = (u; p) of the motion.
struct ParameterReport {
  std::string_view name;                 ///< "exponential", "cayley", "wiener_milenkovic"
  std::string_view law;                  ///< "phi", "2 tan(phi/2)", "4 tan(phi/4)"
  std::optional<Vec3<double>> rotation;  ///< p; none for Cayley at phi = pi, where it is infinite
  std::optional<Vec6<double>> motion;    ///< P = (u; p); none where p is none
};

struct MotionReport {
  Frame<double> motion = Frame<double>::identity();  ///< the motion described: R, and u = x of the reference point
  double rotation_defect = 0.0;                      ///< largest entry of |R^T R - I| of the given R

  // Rotation. At phi = pi the axis is one of two, n or -n.
  double angle = 0.0;                                              ///< phi, 0 <= phi <= pi [rad]
  std::optional<Vec3<double>> axis;                                ///< n; none at phi = 0
  Vec3<double> rotation_vector = Vec3<double>::zero();             ///< phi n [rad]
  Quaternion<double> quaternion = Quaternion<double>::identity();  ///< w >= 0, unit
  Mat3<double> half_angle = Mat3<double>::identity();              ///< G, R = G G

  // Screw [1.5-1.10].
  IntrinsicMotion intrinsic;               ///< (d, phi, w, n) and its kind; see intrinsic_motion
  std::optional<double> pitch;             ///< 2 pi d/phi; none for a translation (infinite) and for no motion
  std::optional<Vec3<double>> axis_point;  ///< of the Mozzi-Chasles axis, nearest the reference point; screws only
  std::optional<Vec6<double>> axis_line;   ///< its Plücker coordinates (moment; direction); screws only

  std::array<ParameterReport, 3> parameters;
  Vec6<double> exponential_coordinates = Vec6<double>::zero();  ///< log H = (u; psi) = phi (w; n) + d (n; 0)

  // Motion tensor [1.14, 1.20], its unit-eigenvalue vectors [1.21].
  Mat6<double> motion_tensor = Mat6<double>::identity();
  Mat6<double> inverse_motion_tensor = Mat6<double>::identity();
  std::optional<Vec6<double>> first_eigenvector;   ///< N1 = (n; 0); none for no motion
  std::optional<Vec6<double>> second_eigenvector;  ///< N2 = (d/(2 sin(phi/2)) n + w; n); screws only
};

/// Report of a motion. A rotation of at most smallest_angle [rad] counts as none in `intrinsic` and in all members
/// derived from it (see intrinsic_motion). R is used as given. Throws std::invalid_argument if a number is not finite,
/// |R^T R - I| exceeds 1e-6 or det R < 0; only these errors allocate.
MotionReport describe_motion(const Frame<double>& motion, double smallest_angle = 1e-150);

/// Axes of a relative motion.
enum class SeenFrom {
  inertial,  ///< C = C_l C_k^-1 [1.42-1.45]: reference point at the origin of the inertial frame
  first      ///< C* = C_k^-1 C_l [1.48-1.49]: pose of l in k; does not change when both move rigidly
};

/// Report of the motion that takes frame k to frame l. The product of two rotations has rounding errors of about 4e-16,
/// so smaller relative rotations have a random axis: by default they count as translations.
MotionReport describe_relative_motion(const Frame<double>& k, const Frame<double>& l, SeenFrom seen_from,
                                      double smallest_angle = 1e-14);

}  // namespace bough::motion
