#include "stand_in.hpp"

#include <algorithm>
#include <cmath>

#include "bough/scene/outlines.hpp"

namespace bough::results {

namespace {

using motion::Mat3;
using motion::Vec3;

constexpr double thinnest = 0.01;  // of the largest extent, so that flat and slender bodies remain visible
constexpr double equal = 1e-9;     // moments of inertia whose relative difference is below this are equal

scene::Box cuboid(const Mat3<double>& J, double mass) {
  const double trace = J(0, 0) + J(1, 1) + J(2, 2);
  scene::Box box{};
  double largest = 0.0;
  for (int i = 0; i < 3; ++i) {
    box.size[i] = std::sqrt(std::max(0.0, 6.0 * (trace - 2.0 * J(i, i)) / mass));
    largest = std::max(largest, box.size[i]);
  }
  for (int i = 0; i < 3; ++i) box.size[i] = std::max(box.size[i], thinnest * largest);
  return box;
}

/// axis: 0 to 2, the one whose moment differs from the other two.
scene::Cylinder cylinder(const Mat3<double>& J, double mass, int axis) {
  const double along = J(axis, axis), across = J((axis + 1) % 3, (axis + 1) % 3);
  const double radius = std::sqrt(2.0 * along / mass);
  const double length = std::sqrt(std::max(0.0, (12.0 * across - 6.0 * along) / mass));
  return {std::max(radius, 0.5 * thinnest * length), std::max(length, 2.0 * thinnest * radius), axis + 1};
}

/// The arms whose ends differ from the centre of mass and from each other by more than round-off.
std::vector<Vec3<double>> different_arms(const std::vector<Vec3<double>>& arms) {
  double longest = 0.0;
  for (const Vec3<double>& a : arms) longest = std::max(longest, length_of(a));
  std::vector<Vec3<double>> found;
  for (const Vec3<double>& a : arms)
    if (length_of(a) > 1e-6 * longest && std::none_of(found.begin(), found.end(), [&](const Vec3<double>& b) {
          return length_of(a - b) <= 1e-6 * longest;
        }))
      found.push_back(a);
  return found;
}

scene::Mesh bars(const std::vector<Vec3<double>>& arms) {
  double longest = 0.0;
  for (const Vec3<double>& a : arms) longest = std::max(longest, length_of(a));
  scene::Mesh all;
  for (const Vec3<double>& arm : arms) {
    const double length = length_of(arm);
    const Vec3<double> along = (1.0 / length) * arm;
    Vec3<double> other = Vec3<double>::zero();
    other[std::abs(along[2]) < 0.9 ? 2 : 0] = 1.0;
    Vec3<double> second = lanes::cross(other, along);
    second = (1.0 / length_of(second)) * second;
    const Vec3<double> third = lanes::cross(along, second);
    const scene::Mesh bar = scene::mesh_of(scene::Cylinder{0.05 * longest, length, 1});
    const int first = static_cast<int>(all.points.size());
    for (const auto& p : bar.points) {
      const Vec3<double> x = (p[0] + 0.5 * length) * along + p[1] * second + p[2] * third;
      all.points.push_back({x[0], x[1], x[2]});
    }
    for (const auto& t : bar.triangles) all.triangles.push_back({first + t[0], first + t[1], first + t[2]});
  }
  return all;
}

}  // namespace

std::optional<scene::Mesh> stand_in(const scene::Body& body, const std::vector<Vec3<double>>& arms) {
  const Mat3<double>& J = body.inertia;
  const double trace = J(0, 0) + J(1, 1) + J(2, 2);
  if (body.is_point_mass || !(body.mass > 0.0) || !(trace > 0.0)) return std::nullopt;
  const double off = std::max({std::abs(J(0, 1)), std::abs(J(0, 2)), std::abs(J(1, 2))});
  const auto is_round_about = [&](int axis) {
    return std::abs(J((axis + 1) % 3, (axis + 1) % 3) - J((axis + 2) % 3, (axis + 2) % 3)) <= equal * trace;
  };
  if (off > equal * trace || (is_round_about(0) && is_round_about(1))) {
    const std::vector<Vec3<double>> held = different_arms(arms);
    if (held.size() > 1) return bars(held);
    return scene::mesh_of(scene::Sphere{std::sqrt(2.5 * trace / (3.0 * body.mass))});
  }
  for (int axis = 0; axis < 3; ++axis)
    if (is_round_about(axis)) return scene::mesh_of(cylinder(J, body.mass, axis));
  return scene::mesh_of(cuboid(J, body.mass));
}

}  // namespace bough::results
