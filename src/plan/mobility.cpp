/// Degrees of freedom, locked mechanisms, and motions without stiffness or without inertia, found at the start and
/// described in words.
#include "bough/plan/mobility.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>

#include "geometry.hpp"
#include "linkage_of.hpp"
#include "listed.hpp"
#include "mobility_texts.hpp"
#include "plan_builder.hpp"

namespace bough::plan {

namespace {

constexpr std::size_t most_tried = 40;  ///< largest number of joints that are tried as the cause of a locked mechanism

std::vector<std::string> find_massless(const SceneLinkage& s) {
  std::vector<std::string> texts;
  for (const LinkComponent& c : s.linkage.solve(MotionsOf::all))
    for (Eigen::Index k = 0; k < c.motions.cols() && texts.size() < told; ++k)
      texts.push_back("no mass or inertia resists a motion: " + describe(s, c, k, " can ") +
                      "; give it inertia or hold it");
  return texts;
}

/// Parts on which weights and loads act. Such a force resists or drives what turns under it, or what moves across a rod
/// that it loads, although it is no stiffness of its own.
std::vector<bool> loaded_parts(const scene::Scene& scene, SceneLinkage& s) {
  std::vector<bool> is_loaded(s.names.size(), false);
  const auto load = [&](const std::string& place) {
    const int part = s.part_of(place);
    if (at(part) < is_loaded.size()) is_loaded[at(part)] = true;
  };
  const bool has_weight = lanes::dot(scene.gravity, scene.gravity) > 0.0 || !scene.analysis.frame.empty();
  for (const scene::Body& b : scene.bodies)
    if (has_weight && b.mass > 0.0) load(b.name);
  for (const scene::Beam& b : scene.beams)
    if (has_weight) load(b.start);
  for (const scene::PointLoad& l : scene.point_loads) load(l.at.to);
  for (const scene::LineLoad& l : scene.line_loads)
    for (const scene::Beam& b : scene.beams)
      if (b.name == l.beam) load(b.start);
  return is_loaded;
}

std::vector<std::string> find_free(const scene::Scene& scene, SceneLinkage& s) {
  std::vector<std::string> texts;
  const std::vector<bool> is_loaded = loaded_parts(scene, s);
  const auto loads_resist = [&](const LinkComponent& c, Eigen::Index motion) {
    if (std::none_of(c.parts.begin(), c.parts.end(), [&](int part) { return is_loaded[at(part)]; })) return false;
    return std::any_of(c.parts.begin(), c.parts.end(),
                       [&](int part) { return c.twist_of(part, motion).tail<3>().norm() > still; }) ||
           std::any_of(c.edges.begin(), c.edges.end(), [&](int e) { return s.linkage.edges()[at(e)].is_rod; });
  };
  for (const LinkComponent& c : s.linkage.solve(MotionsOf::all)) {
    if (!c.reaches_ground && texts.size() < told)
      texts.push_back("in statics nothing holds " + listed(names_in(s, c)) + ": nothing joins it to the ground");
    for (Eigen::Index k = 0; c.reaches_ground && k < c.motions.cols() && texts.size() < told; ++k)
      texts.push_back(std::string("in statics nothing ") + (loads_resist(c, k) ? "but loads can hold " : "holds ") +
                      describe(s, c, k, ", which can "));
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
  constexpr double seen = 1e-9;  // rad; an axis that is as good as parallel locks nothing by its direction
  const double turned = angle_to_others(s.linkage, culprit, locked);
  if (turned < seen) return text;
  char angle[64];
  std::snprintf(angle, sizeof angle, "%.3g", turned * 180.0 / 3.14159265358979323846);
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

int Mobility::degrees_of_freedom() const {
  int sum = 0;
  for (const MobilityPart& p : parts) sum += p.degrees_of_freedom();
  return sum;
}

/// Rows of joints that close loops depend on each other within the digits of the input, not beyond: what is dependent
/// but for the last digit is taken so. In a plane this is known already.
void Builder::take_written_precision() {
  const bool may_depend =
      std::any_of(plan.mobility.parts.begin(), plan.mobility.parts.end(),
                  [](const MobilityPart& p) { return p.closing_rows > (p.is_counted ? p.rank : 0); });
  if (plan.precision > 0.0 || written_precision == 0.0 || !may_depend || !plan.unknowns.is_whole()) return;
  // In space rows act on rotations without inertia, and what finer rounding leaves of those that depend on each other is
  // amplified beyond itself: windows of four bars with ten decimals lost rows for some steps.
  constexpr double finest = 4e-9;
  plan.precision = std::max(written_precision, finest);
  plan.notes.push_back("places are written with " + std::to_string(written_decimals) +
                       " decimals: conditions of joints that depend on each other within them count as dependent");
}

void Builder::find_mobility() {
  Mobility& m = plan.mobility;
  const Linkage empty = empty_linkage(scene, poses, disagreement_within(written_precision));
  const SceneLinkage rigid(scene, poses, empty, {});
  std::map<std::string, int> drives;
  for (const scene::Joint& j : scene.joints)
    if (!j.drives.empty()) drives[j.name] = static_cast<int>(j.drives.size());
  for (const LinkComponent& c : rigid.linkage.solve(MotionsOf::none)) m.parts.push_back(part_of(rigid, c, drives));
  take_written_precision();
  if (plan.is_dynamic) {
    m.locked = find_locked(SceneLinkage(scene, poses, empty, {.beams_are_rigid = false}));
    const bool turns = plan.unknowns.motions == Motions::spatial || plan.unknowns.motions == Motions::planar;
    SceneLinkage massless(scene, poses, empty,
                          {.beams_are_rigid = false, .drives_hold = true, .mass_holds = true, .nothing_turns = !turns});
    massless.restrict_to(plan.unknowns.motions, lanes::column(plan.axes, 2));
    m.massless = find_massless(massless);
    if (plan.has_massless_rotations) {  // those that beams do not resist by their stiffness either
      SceneLinkage spins(scene, poses, empty,
                         {.drives_hold = true, .stiffness_holds = true, .mass_holds = true, .nothing_turns = !turns});
      spins.restrict_to(plan.unknowns.motions, lanes::column(plan.axes, 2));
      for (std::string& text : find_massless(spins))
        if (std::find(m.massless.begin(), m.massless.end(), text) == m.massless.end())
          m.massless.push_back(std::move(text));
    }
  } else {
    const bool has_signals = !places_read_by_forces(scene).empty();
    for (const SignalsHold signals : {SignalsHold::reads, SignalsHold::acts}) {
      SceneLinkage held(
          scene, poses, empty,
          {.drives_hold = true, .stiffness_holds = true, .signals = has_signals ? signals : SignalsHold::nothing});
      m.free = find_free(scene, held);
      if (!has_signals || !m.free.empty()) break;
    }
  }
  for (const auto* list : {&m.locked, &m.free, &m.massless})
    plan.notes.insert(plan.notes.end(), list->begin(), list->end());
}

}  // namespace bough::plan
