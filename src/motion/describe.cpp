#include "bough/motion/describe.hpp"

#include <sstream>
#include <stdexcept>

#include "bough/motion/composition.hpp"
#include "bough/motion/half_angle.hpp"
#include "bough/motion/parameterization.hpp"

namespace bough::motion {

namespace {

/// Largest entry of |R^T R - I|. Throws std::invalid_argument for an R that is not a rotation and for entries that are
/// not finite.
double checked_defect(const Frame<double>& motion) {
  for (const double x : motion.R.m)
    if (!std::isfinite(x)) throw std::invalid_argument("motion: the rotation has an entry that is not a finite number");
  for (const double x : motion.x.v)
    if (!std::isfinite(x)) throw std::invalid_argument("motion: the displacement has an entry that is not finite");
  const Mat3<double> difference = transpose_times(motion.R, motion.R) - Mat3<double>::identity();
  double defect = 0.0;
  for (const double x : difference.m) defect = std::fmax(defect, std::abs(x));
  if (defect > 1e-6) {
    std::ostringstream text;
    text << "motion: the matrix given as a rotation is not orthonormal, |R^T R - I| = " << defect
         << "; give a rotation matrix, a unit quaternion or a rotation vector";
    throw std::invalid_argument(text.str());
  }
  if (dot(column(motion.R, 0), cross(column(motion.R, 1), column(motion.R, 2))) < 0.0)
    throw std::invalid_argument(
        "motion: the matrix given as a rotation is a reflection (det R = -1); swap or negate an axis");
  return defect;
}

template <class Map>
ParameterReport parameters_by(std::string_view law, const Frame<double>& motion) {
  return {Map::name, law, Map::parameters(motion.R), Map::parameters(motion)};
}

void describe_screw(MotionReport& r, double smallest_angle) {
  const IntrinsicMotion m = intrinsic_motion(r.motion, smallest_angle);
  r.intrinsic = m;
  if (m.kind != MotionKind::none) r.first_eigenvector = first_eigenvector(m);
  if (m.kind != MotionKind::screw) return;
  r.pitch = pitch(m);
  r.axis_point = nearest_axis_point(m);
  r.axis_line = mozzi_chasles_axis(m);
  r.second_eigenvector = screw_vector(m, 1.0);
}

}  // namespace

MotionReport describe_motion(const Frame<double>& motion, double smallest_angle) {
  MotionReport r;
  r.rotation_defect = checked_defect(motion);
  r.motion = motion;
  r.quaternion = normalise(quaternion_of(motion.R));
  r.rotation_vector = log_so3(motion.R);
  r.angle = std::hypot(r.rotation_vector[0], r.rotation_vector[1], r.rotation_vector[2]);
  if (r.angle > 0.0) r.axis = (1.0 / r.angle) * r.rotation_vector;
  r.half_angle = half_rotation(motion.R);
  describe_screw(r, smallest_angle);
  r.parameters = {parameters_by<ExponentialMap>("phi", motion), parameters_by<CayleyMap>("2 tan(phi/2)", motion),
                  parameters_by<WienerMilenkovicMap>("4 tan(phi/4)", motion)};
  if (r.quaternion.w < CayleyLaw::smallest_cosine) {
    r.parameters[1].rotation.reset();
    r.parameters[1].motion.reset();
  }
  r.exponential_coordinates = log_se3(motion);
  r.motion_tensor = adjoint(motion);
  r.inverse_motion_tensor = inverse_adjoint(motion);
  return r;
}

MotionReport describe_relative_motion(const Frame<double>& k, const Frame<double>& l, SeenFrom seen_from,
                                      double smallest_angle) {
  checked_defect(k);
  checked_defect(l);
  return describe_motion(seen_from == SeenFrom::inertial ? relative_in_inertial(k, l) : relative(k, l), smallest_angle);
}

}  // namespace bough::motion
