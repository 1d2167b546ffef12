/// Degrees of freedom, locked mechanisms, and motions without stiffness or without inertia, found at the start and
/// described in words.
#include "bough/plan/mobility.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>

#include "bough/plan/undriven.hpp"
#include "bough/scene/analysis_kinds.hpp"
#include "geometry.hpp"
#include "linkage_of.hpp"
#include "listed.hpp"
#include "plan_builder.hpp"

namespace bough::plan {

namespace {

constexpr double still = 1e-7;          ///< relative: smaller twists are round-off of null vectors
constexpr std::size_t told = 4;         ///< largest number of notes of one kind
constexpr std::size_t most_tried = 40;  ///< largest number of joints that are tried as the cause of a locked mechanism

std::size_t at(int i) { return static_cast<std::size_t>(i); }

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

/// Describes a motion: which parts move, how, and at which joints.
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

std::vector<std::string> find_massless(const SceneLinkage& s) {
  std::vector<std::string> texts;
  for (const LinkComponent& c : s.linkage.solve(MotionsOf::all))
    for (Eigen::Index k = 0; k < c.motions.cols() && texts.size() < told; ++k)
      texts.push_back("no mass or inertia resists a motion: " + describe(s, c, k, " can ") +
                      "; give it inertia or hold it");
  return texts;
}

/// Names of the beams, and of the nodes and bodies that belong to no beam.
std::vector<std::string> names_in(const SceneLinkage& s, const LinkComponent& c) {
  std::vector<std::string> names;
  for (const int e : c.edges)
    if (s.linkage.edges()[at(e)].is_beam) names.push_back(s.linkage.edges()[at(e)].name);
  for (const int part : c.parts)
    if (!s.has_beam[at(part)]) names.push_back(s.names[at(part)]);
  return names;
}

std::vector<std::string> find_free(const SceneLinkage& s) {
  std::vector<std::string> texts;
  for (const LinkComponent& c : s.linkage.solve(MotionsOf::all)) {
    if (!c.reaches_ground && texts.size() < told)
      texts.push_back("in statics nothing holds " + listed(names_in(s, c)) + ": nothing joins it to the ground");
    for (Eigen::Index k = 0; c.reaches_ground && k < c.motions.cols() && texts.size() < told; ++k)
      texts.push_back("in statics nothing holds " + describe(s, c, k, ", which can "));
  }
  return texts;
}

MobilityPart part_of(const SceneLinkage& s, const LinkComponent& c, const std::map<std::string, int>& drives) {
  MobilityPart p;
  p.names = names_in(s, c);
  for (const int part : c.parts) p.has_beams |= s.has_beam[at(part)];
  for (const int e : c.edges) {
    const LinkEdge& edge = s.linkage.edges()[at(e)];
    p.joints += edge.is_joint ? 1 : 0;
    if (const auto driven = drives.find(edge.name); driven != drives.end()) p.drives += driven->second;
  }
  p.freedoms = c.freedoms;
  p.closing_rows = c.closing_rows;
  p.rank = c.rank;
  p.is_counted = c.is_rank_known;
  p.reaches_ground = c.reaches_ground;
  return p;
}

/// Joints that have freedoms but do not move.
std::vector<int> locked_joints(const Linkage& linkage, const LinkComponent& c) {
  std::vector<int> locked;
  for (const int e : c.edges) {
    const LinkEdge& edge = linkage.edges()[at(e)];
    if (!edge.is_joint || edge.rows.size() >= 6) continue;
    double most = 0.0;
    for (Eigen::Index k = 0; k < c.motions.cols(); ++k)
      most = std::max(most, (c.twist_of(edge.second, k) - c.twist_of(edge.first, k)).norm());
    if (most <= still) locked.push_back(e);
  }
  return locked;
}

/// Smallest angle between the axis of a joint and those of the others [rad].
double angle_to_others(const Linkage& linkage, int joint, const std::vector<int>& joints) {
  const Vec3d& axis = linkage.edges()[at(joint)].axis;
  double least = 2.0;
  for (const int e : joints) {
    const Vec3d& other = linkage.edges()[at(e)].axis;
    if (e == joint || lanes::dot(other, other) == 0.0) continue;
    least = std::min(least, std::atan2(length_of(lanes::cross(axis, other)), std::abs(lanes::dot(axis, other))));
  }
  return least;
}

/// The joint that locks a mechanism: the one which, if its sides could rotate freely, would let most of the others
/// move; of several, the one whose axis is farthest from those of the others. -1: none.
int joint_that_locks(const Linkage& linkage, const std::vector<int>& locked) {
  int best = -1;
  std::size_t fewest = locked.size();
  double farthest = 0.0;
  for (const int e : locked) {
    if (lanes::dot(linkage.edges()[at(e)].axis, linkage.edges()[at(e)].axis) == 0.0) continue;
    std::size_t still_locked = 0;
    for (const LinkComponent& c : linkage.solve(MotionsOf::all, e)) {
      if (!c.is_rank_known) return -1;
      for (const int other : locked_joints(linkage, c))
        still_locked += other != e && std::find(locked.begin(), locked.end(), other) != locked.end() ? 1 : 0;
    }
    const double angle = angle_to_others(linkage, e, locked);
    if (still_locked + 1 >= locked.size()) continue;  // no other joint moves
    if (best >= 0 && (still_locked > fewest || (still_locked == fewest && angle <= farthest))) continue;
    best = e;
    fewest = still_locked;
    farthest = angle;
  }
  return best;
}

std::string locked_text(const SceneLinkage& s, const LinkComponent& c, const std::vector<int>& locked) {
  std::vector<std::string> names;
  for (const int e : locked) names.push_back(s.linkage.edges()[at(e)].name);
  std::string text = "joints " + listed(names) + " cannot move: their loops take every freedom that they leave";
  if (c.mobility() == 0)
    text += " (" + std::to_string(c.freedoms) + " freedoms, " + std::to_string(c.rank) + " independent conditions of " +
            std::to_string(c.closing_rows) + ": 0 degrees of freedom)";
  const int culprit = locked.size() <= most_tried ? joint_that_locks(s.linkage, locked) : -1;
  if (culprit < 0) return text;
  char angle[64];
  std::snprintf(angle, sizeof angle, "%.3g",
                angle_to_others(s.linkage, culprit, locked) * 180.0 / 3.14159265358979323846);
  return text + "; the axis of joint '" + s.linkage.edges()[at(culprit)].name + "' stands " + angle +
         " degrees off those of the others: turned back, or as a spherical joint, it lets them move";
}

std::vector<std::string> find_locked(const SceneLinkage& s) {
  std::vector<std::string> texts;
  for (const LinkComponent& c : s.linkage.solve(MotionsOf::loops)) {
    if (c.motions.rows() == 0 || c.closing_rows == 0 || texts.size() == told) continue;
    const std::vector<int> locked = locked_joints(s.linkage, c);
    if (locked.size() > 1) texts.push_back(locked_text(s, c, locked));
  }
  return texts;
}

}  // namespace

std::vector<std::string> undriven_motions(const scene::Scene& scene, const Plan& plan) {
  const scene::AnalysisType& analysis = scene::type_of(scene.analysis.kind);
  if (!plan.is_dynamic || analysis.integrates) return {};
  std::vector<std::string> texts;
  const auto add = [&texts](const std::string& text) {
    if (texts.size() < told) texts.push_back(text);
  };
  const std::string asked = std::string(analysis.title) + " takes a motion that drives prescribe completely, but ";
  const scene::Poses poses(scene);
  // In space: what the plan leaves out could move.
  const SceneLinkage driven(scene, poses, empty_linkage(scene, poses), {.drives_hold = true});
  for (const LinkComponent& c : driven.linkage.solve(MotionsOf::all)) {
    if (!c.reaches_ground) add(asked + "nothing joins " + listed(names_in(driven, c)) + " to the ground");
    for (Eigen::Index k = 0; c.reaches_ground && k < c.motions.cols(); ++k)
      add(asked + describe(driven, c, k, " can still ") + "; drive that");
  }
  for (const scene::Beam& b : scene.beams)
    add(asked + "beam '" + b.name + "' bends as its loads ask for; take rigid bodies for it");
  for (const scene::Signal& signal : scene.signals)
    if (signal.kind == scene::SignalKind::state)
      add(asked + "the state '" + signal.name + "' follows from its past; give it as a law of time");
  return texts;
}

int Mobility::degrees_of_freedom() const {
  int sum = 0;
  for (const MobilityPart& p : parts) sum += p.degrees_of_freedom();
  return sum;
}

void Builder::find_mobility() {
  Mobility& m = plan.mobility;
  const Linkage empty = empty_linkage(scene, poses);
  const SceneLinkage rigid(scene, poses, empty, {});
  std::map<std::string, int> drives;
  for (const scene::Joint& j : scene.joints)
    if (!j.drives.empty()) drives[j.name] = static_cast<int>(j.drives.size());
  for (const LinkComponent& c : rigid.linkage.solve(MotionsOf::none)) m.parts.push_back(part_of(rigid, c, drives));
  if (plan.is_dynamic) {
    m.locked = find_locked(SceneLinkage(scene, poses, empty, {.beams_are_rigid = false}));
    const bool turns = plan.unknowns.motions == Motions::spatial || plan.unknowns.motions == Motions::planar;
    SceneLinkage massless(scene, poses, empty,
                          {.beams_are_rigid = false, .drives_hold = true, .mass_holds = true, .nothing_turns = !turns});
    massless.restrict_to(plan.unknowns.motions, lanes::column(plan.axes, 2));
    m.massless = find_massless(massless);
  } else {
    m.free = find_free(SceneLinkage(scene, poses, empty, {.drives_hold = true, .stiffness_holds = true}));
  }
  for (const auto* list : {&m.locked, &m.free, &m.massless})
    plan.notes.insert(plan.notes.end(), list->begin(), list->end());
}

}  // namespace bough::plan
