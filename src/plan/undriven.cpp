/// Motions that drives leave free where the whole motion is prescribed: those that have no effect stay at rest, and all
/// others are refused.
#include "bough/plan/undriven.hpp"

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "bough/scene/analysis_kinds.hpp"
#include "bough/scene/sensor_kinds.hpp"
#include "bough/scene/signals.hpp"
#include "geometry.hpp"
#include "listed.hpp"
#include "mobility_texts.hpp"

namespace bough::plan {

namespace {

using Frame = motion::Frame<double>;

/// The motions that drives leave free, and whether they have an effect on anything else.
class FreeMotions {
 public:
  explicit FreeMotions(const scene::Scene& scene)
      : scene_(scene),
        poses_(scene),
        // In space: what the plan leaves out could move.
        linkage_(scene, poses_, empty_linkage(scene, poses_), {.drives_hold = true}),
        components_(linkage_.linkage.solve(MotionsOf::all)) {
    for (const scene::Joint& j : scene.joints) joint_of_.emplace(j.name, &j);
  }

  /// Calls visit(component, number of the motion); the number is -1 for parts that nothing joins to the ground.
  template <class Visit>
  void for_each(const Visit& visit) const {
    for (const LinkComponent& c : components_) {
      if (!c.reaches_ground) visit(c, Eigen::Index{-1});
      for (Eigen::Index k = 0; c.reaches_ground && k < c.motions.cols(); ++k) visit(c, k);
    }
  }

  std::string describe_motion(const LinkComponent& c, Eigen::Index k, const char* between) const {
    return k < 0 ? "nothing joins " + listed(names_in(linkage_, c)) + " to the ground"
                 : describe(linkage_, c, k, between);
  }

  /// A joint with a coordinate that moves and could be driven, or what else holds the motion.
  std::string advice(const LinkComponent& c, Eigen::Index k) {
    if (k < 0) return "join them to it";
    for (const int e : c.edges) {
      const LinkEdge& edge = linkage_.linkage.edges()[at(e)];
      const auto joint = joint_of_.find(edge.name);
      if (!edge.is_joint || joint == joint_of_.end()) continue;
      for (const scene::JointCoordinate& coordinate : scene::type_of(joint->second->kind).coordinates)
        if (moves(*joint->second, coordinate, c, k))
          return "drive the " + coordinate.name + " of joint '" + edge.name + "'";
    }
    return "no joint has a coordinate along it that could be driven: take a joint that holds it, as a universal one in "
           "place of a spherical one";
  }

  /// Whether a motion has no effect: each body in it turns about an axis through its mass centre about which its inertia
  /// is symmetric, so that no force of inertia or weight belongs to it, and nothing else acts along it or reads it.
  bool is_idle(const LinkComponent& c, Eigen::Index k) {
    if (k < 0) return false;
    most_ = 0.0;
    for (const int part : c.parts) most_ = std::max(most_, c.twist_of(part, k).norm());
    return bodies_turn_in_themselves(c, k) && nothing_acts_along(c, k) && nobody_asks(c, k);
  }

 private:
  /// Velocity of a place on a part in the ground, per unit of the linkage's size, and its rotation.
  Twist motion_at(const LinkComponent& c, Eigen::Index k, const scene::Attachment& at) {
    const auto pose = poses_.of(at);
    const Twist t = c.twist_of(linkage_.part_of(at.to), k);
    if (!pose) return t;
    const Vec3d w{{t[3], t[4], t[5]}};
    const Vec3d v = lanes::cross(w, Vec3d((1.0 / linkage_.linkage.size()) * (pose->x - linkage_.linkage.center())));
    Twist moved = t;
    for (int i = 0; i < 3; ++i) moved[i] += v[i];
    return moved;
  }
  bool is_still(double x) const { return std::abs(x) <= still * most_; }

  bool moves(const scene::Joint& j, const scene::JointCoordinate& coordinate, const LinkComponent& c, Eigen::Index k) {
    const auto H_a = poses_.of(j.first), H_b = poses_.of(j.second);
    if (!H_a || !H_b) return false;
    const Twist row = linkage_.row_of(j, {coordinate.kind}, *H_a, *H_b);
    const Twist relative = c.twist_of(linkage_.part_of(j.second.to), k) - c.twist_of(linkage_.part_of(j.first.to), k);
    return std::abs(row.dot(relative)) > 1e-6 * relative.norm();
  }

  bool bodies_turn_in_themselves(const LinkComponent& c, Eigen::Index k) {
    for (const scene::Body& b : scene_.bodies) {
      const Twist t = c.twist_of(linkage_.part_of(b.name), k);
      if (t.norm() <= still * most_) continue;
      const auto pose = poses_.of(b.placement);
      if (!pose) return false;
      scene::Attachment center;
      center.to = b.name;
      center.offset.x = b.center_of_mass;
      if (b.mass > 0.0 && !is_still(motion_at(c, k, center).head<3>().norm())) return false;
      const Vec3d axis = lanes::transpose_times(pose->R, Vec3d{{t[3], t[4], t[5]}});
      const double turning = length_of(axis), largest = std::max({b.inertia(0, 0), b.inertia(1, 1), b.inertia(2, 2)});
      if (turning == 0.0) continue;
      const Vec3d n = (1.0 / turning) * axis, Jn = b.inertia * n;
      const double own = lanes::dot(n, Jn), across = 0.5 * (b.inertia(0, 0) + b.inertia(1, 1) + b.inertia(2, 2) - own);
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) {
          const double round = (i == j ? across : 0.0) + (own - across) * n[i] * n[j];
          if (std::abs(b.inertia(i, j) - round) > 1e-9 * largest) return false;
        }
    }
    return true;
  }

  bool nothing_acts_along(const LinkComponent& c, Eigen::Index k) {
    const auto rests = [&](const scene::Attachment& a) { return is_still(motion_at(c, k, a).head<3>().norm()); };
    const auto acts = [&](const scene::Coupling& coupling) {
      if (coupling.kind->acts_along_line) return !rests(coupling.first) || !rests(coupling.second);
      return !is_still(
          (c.twist_of(linkage_.part_of(coupling.second.to), k) - c.twist_of(linkage_.part_of(coupling.first.to), k))
              .norm());
    };
    if (std::any_of(scene_.couplings.begin(), scene_.couplings.end(), acts)) return false;
    for (const scene::PointLoad& l : scene_.point_loads) {
      const Twist t = motion_at(c, k, l.at);
      const bool has_moment = lanes::dot(l.moment, l.moment) > 0.0;
      if (!is_still(t.head<3>().norm()) || ((has_moment || l.axes == scene::LoadAxes::body) && !is_still(t.norm())))
        return false;
    }
    for (const scene::Joint& j : scene_.joints)
      for (const scene::JointForce& f : j.forces)
        if (const auto* along = scene::type_of(j.kind).coordinate(f.coordinate);
            along != nullptr && moves(j, *along, c, k))
          return false;
    return scene_.beams.empty();
  }

  /// Whether no sensor or signal reads a coordinate that moves.
  bool nobody_asks(const LinkComponent& c, Eigen::Index k) {
    const auto asks = [&](const std::string& name, const auto& item) {
      const auto joint = joint_of_.find(name);
      if (joint == joint_of_.end()) return false;
      const auto* coordinate = scene::coordinate_of(item, scene::type_of(joint->second->kind));
      return coordinate != nullptr && moves(*joint->second, *coordinate, c, k);
    };
    return std::none_of(scene_.sensors.begin(), scene_.sensors.end(),
                        [&](const scene::Sensor& s) { return asks(s.joint, s); }) &&
           std::none_of(scene_.signals.begin(), scene_.signals.end(), [&](const scene::Signal& s) {
             if (scene::reads_point(s.kind)) return !is_still(motion_at(c, k, s.at).head<3>().norm());
             return scene::reads_joint(s.kind) && asks(s.joint, s);
           });
  }

  const scene::Scene& scene_;
  scene::Poses poses_;
  SceneLinkage linkage_;
  std::vector<LinkComponent> components_;
  std::unordered_map<std::string_view, const scene::Joint*> joint_of_;
  double most_ = 0.0;  ///< largest twist of the motion that is looked at
};

bool asks_for_drives(const scene::Scene& scene, const Plan& plan) {
  const scene::AnalysisType& type = scene::type_of(scene.analysis.kind);
  return plan.is_dynamic && !type.integrates && !type.is_of_instant;
}

}  // namespace

std::vector<std::string> undriven_motions(const scene::Scene& scene, const Plan& plan) {
  if (!asks_for_drives(scene, plan)) return {};
  const std::string asked =
      std::string(scene::type_of(scene.analysis.kind).title) + " takes a motion that drives prescribe completely, but ";
  std::vector<std::string> texts;
  FreeMotions free(scene);
  free.for_each([&](const LinkComponent& c, Eigen::Index k) {
    if (!free.is_idle(c, k))
      texts.push_back(asked + free.describe_motion(c, k, " can still ") + "; " + free.advice(c, k));
  });
  for (const scene::Beam& b : scene.beams)
    texts.push_back(asked + "beam '" + b.name + "' bends as its loads ask for; take rigid bodies for it");
  for (const scene::Signal& signal : scene.signals)
    if (signal.kind == scene::SignalKind::state)
      texts.push_back(asked + "the state '" + signal.name + "' follows from its past; give it as a law of time");
  return texts;
}

IdleMotions idle_motions(const scene::Scene& scene, const Plan& plan) {
  IdleMotions idle;
  if (!asks_for_drives(scene, plan)) return idle;
  FreeMotions free(scene);
  std::string first;
  free.for_each([&](const LinkComponent& c, Eigen::Index k) {
    if (!free.is_idle(c, k)) return;
    if (idle.count++ == 0) first = free.describe_motion(c, k, ", which can ");
  });
  if (idle.count == 0) return idle;
  idle.note = "no drive prescribes " + first;
  if (idle.count > 1) idle.note += ", and " + std::to_string(idle.count - 1) + " more such motions";
  idle.note += idle.count > 1 ? ": they have" : ": it has";
  idle.note += " no effect on anything else, and the least velocities are taken, at rest as far as drives leave it";
  return idle;
}

}  // namespace bough::plan
