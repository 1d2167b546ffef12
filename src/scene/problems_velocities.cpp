/// Initial velocities that joints do not allow, or that contradict each other within one rigid part.
#include <algorithm>
#include <cmath>
#include <numeric>
#include <unordered_map>

#include "problem_list.hpp"

namespace bough::scene {
namespace {

/// Relative tolerance, of the given speeds, of the velocity that a joint suppresses.
constexpr double allowed = 1e-3;
/// Velocities of a point on the axis of a rotation are below this part of the rotation times the arm.
constexpr double round_off = 1e-12;

/// Velocity of a rigid part in the ground's axes, linear of the point x.
struct Velocity {
  Vec3 linear = Vec3::zero(), angular = Vec3::zero(), x = Vec3::zero();
  bool turns_as_held = false;  ///< of a point, whose rotation is not given and has no inertia
  Vec3 at(const Vec3& point) const { return linear + cross(angular, Vec3(point - x)); }
};

class GivenVelocities {
 public:
  explicit GivenVelocities(const ProblemList& list) : list_(list) {
    for (const InitialVelocity& v : list.scene.initial_velocities) add(v);
  }

  bool empty() const { return of_.empty(); }

  /// Velocity of the ground, of a frame at rest, or of a part whose velocity the scene gives.
  std::optional<Velocity> of(const std::string& place) const {
    if (place.empty() || place == "ground") return Velocity{};
    auto known = of_.find(place);
    if (known == of_.end()) known = of_.find(place.substr(0, place.rfind('.')));
    if (known != of_.end()) return known->second;
    const auto thing = list_.poses.find(place);
    if (thing && thing->kind == ThingKind::frame && !list_.poses.is_moving(place)) return Velocity{};
    return std::nullopt;
  }

 private:
  void add(const InitialVelocity& v) {
    const auto thing = list_.poses.find(v.of);
    const bool is_beam = thing && thing->kind == ThingKind::beam;
    const Beam* beam = is_beam ? &list_.scene.beams[thing->index] : nullptr;
    const auto pose = list_.poses.of(std::string_view(is_beam ? beam->start : v.of));
    const auto frame = list_.poses.of(std::string_view(v.frame));
    if (!pose || !frame || list_.poses.is_moving(v.frame)) return;
    const Mat3 axes = v.axes == LoadAxes::body ? pose->R : frame->R;
    const Velocity given{axes * v.velocity, axes * v.angular_velocity, pose->x,
                         !v.has_angular_velocity && has_no_inertia_of_rotation(thing)};
    of_[v.of] = given;
    if (is_beam) of_[beam->start] = of_[beam->end] = given;
  }

  bool has_no_inertia_of_rotation(const std::optional<Thing>& thing) const {
    const Scene& s = list_.scene;
    if (!thing || thing->kind == ThingKind::beam) return false;
    if (thing->kind == ThingKind::body) return s.bodies[thing->index].is_point_mass;
    const std::string& name = s.nodes[thing->index].name;
    return std::none_of(s.beams.begin(), s.beams.end(),
                        [&name](const Beam& b) { return b.start == name || b.end == name; });
  }

  const ProblemList& list_;
  std::unordered_map<std::string, Velocity> of_;
};

/// Relative velocities in the directions that a joint holds: of points [m/s] and of rotations [rad/s].
struct JointRates {
  double linear = 0.0, angular = 0.0;
};

/// H: pose of the second joint frame in the first; twist: of the second relative to the first, in its axes.
JointRates held_rates(const Joint& j, const Frame& H, const Vec6& twist) {
  JointRates rates;
  for (const JointRow& row : type_of(j.kind).rows) {
    double& sum = motion::traits_of(row.kind).is_length ? rates.linear : rates.angular;
    sum = std::hypot(sum, lanes::dot(eval_row(row, j.pitch, H).gradient, twist));
  }
  return rates;
}

void check_joint(ProblemList& list, std::size_t i, const GivenVelocities& velocities) {
  const Joint& j = list.scene.joints[i];
  const auto a = velocities.of(j.first.to), b = velocities.of(j.second.to);
  const auto H_a = list.poses.of(j.first), H_b = list.poses.of(j.second);
  if (!a || !b || !H_a || !H_b) return;
  const Vec3 v_a = a->at(H_b->x), v_b = b->at(H_b->x);
  const Vec6 twist = lanes::join(lanes::transpose_times(H_b->R, Vec3(v_b - v_a)),
                                 lanes::transpose_times(H_b->R, Vec3(b->angular - a->angular)));
  JointRates rates = held_rates(j, motion::relative(*H_a, *H_b), twist);
  // A point that turns with what holds it follows in all rotations, and in displacements of places off its origin.
  const auto is_off = [&](const Velocity& v) { return norm(Vec3(H_b->x - v.x)) > 0.0; };
  if (a->turns_as_held || b->turns_as_held) rates.angular = 0.0;
  if ((a->turns_as_held && is_off(*a)) || (b->turns_as_held && is_off(*b))) rates.linear = 0.0;
  const double speed = std::max({norm(v_a), norm(v_b), norm(a->linear), norm(b->linear)});
  const double turning = std::max(norm(a->angular), norm(b->angular));
  const double arm = std::max(norm(H_b->x - a->x), norm(H_b->x - b->x));
  std::string by;
  if (rates.linear > allowed * speed + round_off * turning * arm) by = text_of(rates.linear) + " m/s";
  if (rates.angular > allowed * turning) by += (by.empty() ? "" : " and ") + text_of(rates.angular) + " rad/s";
  if (!by.empty())
    list.warn("joints", i, "name", j.name, "the initial velocities leave this joint by " + by,
              "the run changes them by impulses until the joint holds: give velocities that it allows");
}

/// Sets of parts that fixed joints connect, by name.
class RigidParts {
 public:
  explicit RigidParts(const Scene& scene) {
    for (const Joint& j : scene.joints)
      if (j.kind == JointKind::fixed && !is_ground(j.first.to) && !is_ground(j.second.to))
        parent_[root(j.first.to)] = root(j.second.to);
  }
  std::string root(const std::string& name) {
    std::string at = name;
    for (auto next = parent_.find(at); next != parent_.end() && next->second != at; next = parent_.find(at))
      at = next->second;
    return at;
  }

 private:
  static bool is_ground(const std::string& name) { return name.empty() || name == "ground"; }
  std::unordered_map<std::string, std::string> parent_;
};

/// By how much the velocities of two places are not those of one rigid motion [m/s, rad/s]. Where a place turns with what
/// holds it, the other one tells how; of two such places the distance has to stay.
std::pair<double, double> difference_in_one_part(const Velocity& a, const Velocity& b) {
  if (!a.turns_as_held && !b.turns_as_held)
    return {norm(Vec3(a.linear - b.at(a.x))), norm(Vec3(a.angular - b.angular))};
  if (!a.turns_as_held) return {norm(Vec3(b.linear - a.at(b.x))), 0.0};
  if (!b.turns_as_held) return {norm(Vec3(a.linear - b.at(a.x))), 0.0};
  const Vec3 arm = a.x - b.x, off = a.linear - b.linear;
  const double distance = norm(arm);
  return {distance > 0.0 ? std::abs(dot(arm, off)) / distance : norm(off), 0.0};
}

void check_rigid_parts(ProblemList& list, const GivenVelocities& velocities) {
  RigidParts parts(list.scene);
  std::unordered_map<std::string, std::string> first_of;
  for (std::size_t i = 0; i < list.scene.initial_velocities.size(); ++i) {
    const std::string& name = list.scene.initial_velocities[i].of;
    const auto own = velocities.of(name);
    if (!own) continue;
    const auto [first, is_new] = first_of.try_emplace(parts.root(name), name);
    if (is_new || first->second == name) continue;
    const Velocity other = *velocities.of(first->second);
    const auto [off, turned] = difference_in_one_part(*own, other);
    const double speed = std::max(norm(own->linear), norm(other.at(own->x)));
    const double turning = std::max(norm(own->angular), norm(other.angular));
    if (off <= allowed * speed && turned <= allowed * turning) continue;
    list.add("initial_velocities", i, "of", name,
             "fixed joints make this one rigid part with '" + first->second +
                 "', and their initial velocities contradict each other by " +
                 (off > allowed * speed ? text_of(off) + " m/s" : text_of(turned) + " rad/s"),
             "give the part one velocity, or both the same rigid motion");
  }
}

}  // namespace

void check_initial_velocities(ProblemList& list) {
  if (!list.is_dynamic) return;
  const GivenVelocities velocities(list);
  if (velocities.empty()) return;
  check_rigid_parts(list, velocities);
  for (std::size_t i = 0; i < list.scene.joints.size(); ++i) check_joint(list, i, velocities);
}

}  // namespace bough::scene
