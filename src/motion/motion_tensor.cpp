#include "bough/motion/motion_tensor.hpp"

#include <limits>
#include <numbers>

#include "bough/motion/norm.hpp"

namespace bough::motion {

namespace {

/// Half-angle rotation G with R = G G.
Mat3<double> half_rotation(const IntrinsicMotion& m) { return exp_so3((0.5 * m.phi) * m.n); }

}  // namespace

IntrinsicMotion intrinsic_motion(const Frame<double>& motion, double smallest_angle) {
  const Vec3<double> psi = log_so3(motion.R);
  const double phi = norm(psi);
  IntrinsicMotion m;
  if (phi <= smallest_angle) {
    m.d = norm(motion.x);
    if (m.d > 0.0) {
      m.kind = MotionKind::translation;
      m.n = (1.0 / m.d) * motion.x;
    }
    return m;
  }
  m.kind = MotionKind::screw;
  m.phi = phi;
  m.n = (1.0 / phi) * psi;
  m.d = dot(m.n, motion.x);
  // u - d n without cancellation: the part of u across the axis.
  const Vec3<double> across = cross(m.n, cross(motion.x, m.n));
  m.w = (0.5 / std::sin(0.5 * phi)) * transpose_times(half_rotation(m), across);
  return m;
}

Vec3<double> displacement_at(const IntrinsicMotion& m, const Vec3<double>& r) {
  // R - I = 2 sin(phi/2) G ~n, so that small rotations of far points keep their digits.
  return m.d * m.n + (2.0 * std::sin(0.5 * m.phi)) * (half_rotation(m) * (m.w + cross(m.n, r)));
}

Frame<double> frame_of(const IntrinsicMotion& m) {
  return {exp_so3(m.phi * m.n), displacement_at(m, Vec3<double>::zero())};
}

Vec6<double> mozzi_chasles_axis(const IntrinsicMotion& m) { return join(m.w, m.n); }

Vec3<double> nearest_axis_point(const IntrinsicMotion& m) { return cross(m.n, m.w); }

double pitch(const IntrinsicMotion& m) {
  switch (m.kind) {
    case MotionKind::none:
      return 0.0;
    case MotionKind::translation:
      return std::numeric_limits<double>::infinity();
    case MotionKind::screw:
      break;
  }
  return 2.0 * std::numbers::pi * m.d / m.phi;
}

double displacement_on_cylinder(const IntrinsicMotion& m, double rho) {
  return std::hypot(m.d, 2.0 * rho * std::sin(0.5 * m.phi));
}

Mat6<double> translation_factor(const Frame<double>& motion) {
  return detail::upper(Mat3<double>::identity(), skew(motion.x));
}

Mat6<double> rotation_factor(const Frame<double>& motion) { return detail::upper(motion.R, Mat3<double>::zero()); }

Vec6<double> first_eigenvector(const IntrinsicMotion& m) { return join(m.n, Vec3<double>::zero()); }

Vec6<double> screw_vector(const IntrinsicMotion& m, double alpha) {
  if (m.kind != MotionKind::screw) return alpha == 0.0 ? mozzi_chasles_axis(m) : first_eigenvector(m);
  return join((0.5 * alpha * m.d / std::sin(0.5 * m.phi)) * m.n + m.w, m.n);
}

std::optional<double> screw_lambda(const IntrinsicMotion& m, double alpha) {
  if (m.kind == MotionKind::none || alpha == 0.0) return 0.0;
  if (m.kind == MotionKind::translation) return std::nullopt;
  return 0.5 * alpha * m.d / std::sin(0.5 * m.phi);
}

std::optional<Mat3<double>> moment_of_displacement(const Vec3<double>& n, double phi, double alpha) {
  const double s = std::sin(0.5 * phi), c = std::cos(0.5 * phi);
  if (s == 0.0) return std::nullopt;
  const Mat3<double> N = skew(n);
  return (0.5 / s) * (alpha * Mat3<double>::identity() - s * N + (alpha - c) * (N * N));
}

std::optional<Mat3<double>> displacement_of_moment(const Vec3<double>& n, double phi, double alpha) {
  if (alpha == 0.0) return std::nullopt;
  const double s = std::sin(0.5 * phi), inverse_a = 2.0 * s / alpha;
  const Mat3<double> N = skew(n);
  return inverse_a * Mat3<double>::identity() + (2.0 * s * s) * N + (inverse_a - std::sin(phi)) * (N * N);
}

IntrinsicCoefficients intrinsic_coefficients(double phi, double alpha) {
  return {std::cos(phi) - alpha * std::cos(0.5 * phi), std::sin(phi) - 2.0 * alpha * std::sin(0.5 * phi)};
}

Mat6<double> z_matrix(double x, double y) {
  Mat6<double> z = y * Mat6<double>::identity();
  for (int i = 0; i < 3; ++i) z(i, i + 3) = x;
  return z;
}

namespace {

/// Equation [1.36]; `sign` is 1 for C and -1 for its inverse.
Mat6<double> intrinsic_tensor(const IntrinsicMotion& m, double alpha, double sign) {
  const Mat6<double> I = Mat6<double>::identity();
  if (m.kind != MotionKind::screw) return I + (sign * m.d) * cross6(first_eigenvector(m));
  const IntrinsicCoefficients c = intrinsic_coefficients(m.phi, alpha);
  const double half_sine = std::sin(0.5 * m.phi);
  const Mat6<double> N = cross6(screw_vector(m, alpha));
  // Z ~N is formed first, since its entries are of order phi and those of ~N ~N of order 1/phi^2.
  const Mat6<double> odd = z_matrix(m.d * c.c1, std::sin(m.phi)) * N;
  const Mat6<double> even = z_matrix(m.d * c.c2, 2.0 * half_sine * half_sine) * N * N;
  return I + sign * odd + even;
}

}  // namespace

Mat6<double> motion_tensor(const IntrinsicMotion& m, double alpha) { return intrinsic_tensor(m, alpha, 1.0); }

Mat6<double> inverse_motion_tensor(const IntrinsicMotion& m, double alpha) { return intrinsic_tensor(m, alpha, -1.0); }

Vec3<double> nearest_axis_point(const VelocityScrew& s) { return cross(angular_part(s.axis), linear_part(s.axis)); }

VelocityScrew velocity_screw(const Vec6<double>& V) {
  const Vec3<double> v = linear_part(V), omega = angular_part(V);
  VelocityScrew r;
  r.angular_speed = norm(omega);
  if (r.angular_speed > 0.0) {
    const Vec3<double> n = (1.0 / r.angular_speed) * omega;
    r.kind = MotionKind::screw;
    r.sliding_speed = dot(n, v);
    r.axis = join((1.0 / r.angular_speed) * cross(n, cross(v, n)), n);
    return r;
  }
  r.sliding_speed = norm(v);
  if (r.sliding_speed > 0.0) {
    r.kind = MotionKind::translation;
    r.axis = join(Vec3<double>::zero(), (1.0 / r.sliding_speed) * v);
  }
  return r;
}

}  // namespace bough::motion
