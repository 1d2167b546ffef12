#include "bough/motion/screw.hpp"

#include "bough/motion/norm.hpp"

namespace bough::motion {

Screw screw_of(const Vec6<double>& S) {
  const Vec3<double> m = linear_part(S), l = angular_part(S);
  Screw r;
  r.magnitude = norm(l);
  if (r.magnitude > 0.0) {
    r.kind = MotionKind::screw;
    r.n = (1.0 / r.magnitude) * l;
    const Vec3<double> per_unit = (1.0 / r.magnitude) * m;
    r.h = dot(r.n, per_unit);
    r.point = cross(r.n, per_unit);
    return r;
  }
  r.magnitude = norm(m);
  if (r.magnitude > 0.0) {
    r.kind = MotionKind::translation;
    r.n = (1.0 / r.magnitude) * m;
  }
  return r;
}

Vec6<double> vector_of(const Screw& s) {
  if (s.kind == MotionKind::translation) return join(s.magnitude * s.n, Vec3<double>::zero());
  return s.magnitude * join(cross(s.point, s.n) + s.h * s.n, s.n);
}

Screw moved_screw(const Frame<double>& motion, const Screw& s) {
  Screw r = s;
  r.n = motion.R * s.n;
  if (s.kind == MotionKind::screw) r.point = transform(motion, s.point);
  return r;
}

Vec6<double> motion_screw(const IntrinsicMotion& m, double magnitude, double alpha) {
  if (m.kind != MotionKind::screw) return m.d * first_eigenvector(m);
  return magnitude * screw_vector(m, alpha);
}

}  // namespace bough::motion
