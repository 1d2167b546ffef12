#include "mobility_texts.hpp"

#include <cmath>
#include <cstdio>

#include "geometry.hpp"
#include "listed.hpp"

namespace bough::plan {

namespace {

std::string vector_text(const Vec3d& v, double round_off) {
  std::string text = "(";
  for (int k = 0; k < 3; ++k) {
    char number[32];
    std::snprintf(number, sizeof number, "%s%.4g", k == 0 ? "" : ", ", std::abs(v[k]) <= round_off ? 0.0 : v[k]);
    text += number;
  }
  return text + ")";
}

/// "turn about the axis (0, 0, 1) through (0, 0, 0) m" or "move along (1, 0, 0)".
std::string motion_text(const Linkage& linkage, const Twist& t) {
  const Vec3d v{{t[0], t[1], t[2]}}, w{{t[3], t[4], t[5]}};
  const double turning = length_of(w);
  if (turning <= still * t.norm()) return "move along " + vector_text((1.0 / length_of(v)) * v, 1e-9);
  const Vec3d axis = (1.0 / turning) * w;
  const Vec3d x = linkage.center() + (linkage.size() / turning) * lanes::cross(axis, v);
  const Vec3d nearest = x - lanes::dot(x, axis) * axis;  // point of the axis closest to the origin
  return "turn about the axis " + vector_text(axis, 1e-9) + " through " + vector_text(nearest, 1e-9 * linkage.size()) +
         " m";
}

}  // namespace

std::string describe(const SceneLinkage& s, const LinkComponent& c, Eigen::Index motion, const char* between) {
  double most = 0.0;
  int largest = c.parts.front();
  for (const int part : c.parts)
    if (const double size = c.twist_of(part, motion).norm(); size > most * (1.0 + 1e-9)) {
      most = size;
      largest = part;
    }
  std::vector<std::string> moving, joints;
  const auto moves = [&](int part) { return c.twist_of(part, motion).norm() > still * most; };
  for (const int e : c.edges) {
    const LinkEdge& edge = s.linkage.edges()[at(e)];
    if (edge.is_beam && moves(edge.second)) moving.push_back(edge.name);
    const Twist relative = c.twist_of(edge.second, motion) - c.twist_of(edge.first, motion);
    if (edge.is_joint && relative.norm() > still * most) joints.push_back(edge.name);
  }
  for (const int part : c.parts)  // nodes of beams are included in these
    if (!s.has_beam[at(part)] && moves(part)) moving.push_back(s.names[at(part)]);
  std::string text = listed(moving) + between + motion_text(s.linkage, c.twist_of(largest, motion));
  if (!joints.empty()) text += " at joint" + std::string(joints.size() > 1 ? "s " : " ") + listed(joints);
  return text;
}

std::vector<std::string> names_in(const SceneLinkage& s, const LinkComponent& c) {
  std::vector<std::string> names;
  for (const int e : c.edges)
    if (s.linkage.edges()[at(e)].is_beam) names.push_back(s.linkage.edges()[at(e)].name);
  for (const int part : c.parts)
    if (!s.has_beam[at(part)]) names.push_back(s.names[at(part)]);
  return names;
}

}  // namespace bough::plan
