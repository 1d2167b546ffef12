#include "bough/motion/plucker.hpp"

#include "bough/motion/norm.hpp"

namespace bough::motion {

std::optional<Vec6<double>> line_along(const Vec3<double>& point, const Vec3<double>& direction) {
  const double length = norm(direction);
  if (length == 0.0) return std::nullopt;
  const Vec3<double> l{{direction[0] / length, direction[1] / length, direction[2] / length}};
  return join(cross(point, l), l);
}

std::optional<Vec6<double>> line_through(const Vec3<double>& a, const Vec3<double>& b) { return line_along(a, b - a); }

std::optional<Vec3<double>> nearest_point(const Vec6<double>& line) {
  const Vec3<double> l = angular_part(line);
  const double length = norm(l);
  if (length == 0.0) return std::nullopt;
  return (1.0 / length) * cross((1.0 / length) * l, linear_part(line));
}

std::optional<double> distance_from(const Vec6<double>& line, const Vec3<double>& point) {
  const double length = norm(angular_part(line));
  if (length == 0.0) return std::nullopt;
  return norm(linear_part(line_about(line, point))) / length;
}

Vec6<double> line_about(const Vec6<double>& line, const Vec3<double>& p) {
  const Vec3<double> l = angular_part(line);
  return join(linear_part(line) - cross(p, l), l);
}

Vec6<double> moved_line(const Frame<double>& motion, const Vec6<double>& line) { return adjoint_times(motion, line); }

Vec6<double> moved_axis(const Frame<double>& motion, int k) { return adjoint_times(motion, Vec6<double>::unit(k)); }

double mutual_moment(const Vec6<double>& a, const Vec6<double>& b) {
  return dot(linear_part(a), angular_part(b)) + dot(linear_part(b), angular_part(a));
}

}  // namespace bough::motion
