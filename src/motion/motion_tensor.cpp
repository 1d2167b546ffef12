#include "bough/motion/motion_tensor.hpp"

#include <limits>
#include <numbers>

namespace bough::motion {

namespace {

double norm(const Vec3<double>& a) { return std::hypot(a[0], a[1], a[2]); }

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

Vec6<double> screw_vector(const IntrinsicMotion& m, double alpha) {
  return join((0.5 * alpha * m.d / std::sin(0.5 * m.phi)) * m.n + m.w, m.n);
}

Mat6<double> motion_tensor(const IntrinsicMotion& m, double alpha) {
  const double s = std::sin(m.phi), c = std::cos(m.phi), sh = std::sin(0.5 * m.phi), ch = std::cos(0.5 * m.phi);
  const auto Z = [](double x, double y) {
    Mat6<double> z = y * Mat6<double>::identity();
    for (int i = 0; i < 3; ++i) z(i, i + 3) = x;
    return z;
  };
  const Mat6<double> N = cross6(screw_vector(m, alpha));
  return Mat6<double>::identity() + Z(m.d * (c - alpha * ch), s) * N +
         Z(m.d * (s - 2.0 * alpha * sh), 2.0 * sh * sh) * N * N;
}

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
