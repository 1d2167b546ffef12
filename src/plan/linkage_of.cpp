#include "linkage_of.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <unordered_map>
#include <utility>

#include "bough/scene/couplings.hpp"
#include "bough/scene/joint_kinds.hpp"
#include "geometry.hpp"

namespace bough::plan {

using Frame = motion::Frame<double>;
using Mat3 = motion::Mat3<double>;

namespace {

Vec3d axis_of(const Frame& H, int k) { return {{H.R(0, k), H.R(1, k), H.R(2, k)}}; }

/// Whether every motion of a body has inertia.
bool has_whole_inertia(const scene::Body& b) {
  const Mat3& J = b.inertia;
  const double trace = J(0, 0) + J(1, 1) + J(2, 2);
  const Vec3d rows[3] = {{{J(0, 0), J(0, 1), J(0, 2)}}, {{J(1, 0), J(1, 1), J(1, 2)}}, {{J(2, 0), J(2, 1), J(2, 2)}}};
  const double volume = lanes::dot(rows[0], lanes::cross(rows[1], rows[2]));
  return b.mass > 0.0 && volume > 1e-12 * trace * trace * trace;
}

}  // namespace

Linkage empty_linkage(const scene::Scene& scene, const scene::Poses& poses, double precision) {
  constexpr double round_off = 1e-9;
  Vec3d low = Vec3d::zero(), high = low;
  bool is_first = true;
  const auto include = [&](const std::optional<Frame>& H) {
    if (!H) return;
    for (int k = 0; k < 3; ++k) {
      low[k] = is_first ? H->x[k] : std::min(low[k], H->x[k]);
      high[k] = is_first ? H->x[k] : std::max(high[k], H->x[k]);
    }
    is_first = false;
  };
  for (const scene::Node& n : scene.nodes) include(poses.of(n.placement));
  for (const scene::Body& b : scene.bodies) include(poses.of(b.placement));
  for (const scene::Joint& j : scene.joints) include(poses.of(j.second));
  const double size = length_of(high - low);
  return Linkage(0.5 * (low + high), size > 0.0 ? size : 1.0, std::max(round_off, precision));
}

SceneLinkage::SceneLinkage(const scene::Scene& scene, const scene::Poses& poses, const Linkage& empty,
                           const LinkageChoice& choice)
    : linkage(empty), names(1), has_beam(1, false), scene_(scene), poses_(poses), choice_(choice) {
  std::vector<bool> is_massive(scene.nodes.size() + scene.bodies.size(), false);
  for (std::size_t b = 0; b < scene.bodies.size() && choice.mass_holds; ++b)
    is_massive[scene.nodes.size() + b] =
        choice.nothing_turns ? scene.bodies[b].mass > 0.0 : has_whole_inertia(scene.bodies[b]);
  for (const scene::Beam& b : scene.beams)
    if (choice.mass_holds && !choice.beams_are_rigid)
      for (const std::string* end : {&b.start, &b.end})
        if (const auto place = place_of(*end)) is_massive[*place] = true;
  part_at_.assign(is_massive.size(), Linkage::ground);
  for (std::size_t place = 0; place < is_massive.size(); ++place)
    if (!is_massive[place])
      part_at_[place] = add_part(place < scene.nodes.size() ? scene.nodes[place].name
                                                            : scene.bodies[place - scene.nodes.size()].name);
  linkage.reserve(scene.joints.size() + (choice.beams_are_rigid ? scene.beams.size() : 0));
  for (const scene::Beam& b : scene.beams) {
    if (!choice.beams_are_rigid) continue;
    LinkEdge weld{part_of(b.start), part_of(b.end), b.name, {}, Vec3d::zero(), false, true};
    for (const int part : {weld.first, weld.second}) has_beam[static_cast<std::size_t>(part)] = true;
    if (weld.first == weld.second) continue;
    weld.rows.reserve(6);
    for (int k = 0; k < 3; ++k) weld.rows.push_back(linkage.along(Vec3d::unit(k), linkage.center()));
    for (int k = 0; k < 3; ++k) weld.rows.push_back(Linkage::about(Vec3d::unit(k)));
    linkage.add(std::move(weld));
  }
  for (const scene::Joint& j : scene.joints) add_joint(j);
  for (const scene::PrescribedMotion& m : scene.motions) add_motion(m);
  if (choice.stiffness_holds) add_stiffness();
  if (choice.signals != SignalsHold::nothing) add_signals();
  if (choice.drives_hold) add_point_masses();
  for (std::size_t b = 0; b < scene.bodies.size(); ++b)
    if (choice.mass_holds && !is_massive[scene.nodes.size() + b]) add_masses(scene.bodies[b]);
  if (choice.mass_holds && choice.beams_are_rigid)
    for (const scene::Beam& b : scene.beams) add_masses(b);
}

int SceneLinkage::add_part(const std::string& name) {
  names.push_back(name);
  has_beam.push_back(false);
  return linkage.add_part();
}

std::optional<std::size_t> SceneLinkage::place_of(std::string_view name) const {
  const auto thing = poses_.find(name);
  if (thing && thing->kind == scene::ThingKind::node) return thing->index;
  if (thing && thing->kind == scene::ThingKind::body) return scene_.nodes.size() + thing->index;
  return std::nullopt;
}

int SceneLinkage::part_of(const std::string& place) {
  if (place.empty()) return Linkage::ground;
  if (const auto known = place_of(place)) return part_at_[*known];
  const std::size_t dot_at = place.rfind('.');
  if (dot_at == std::string::npos) return Linkage::ground;
  const auto thing = poses_.find(std::string_view(place).substr(0, dot_at));
  if (!thing || thing->kind != scene::ThingKind::beam) return Linkage::ground;
  if (choice_.mass_holds && !choice_.beams_are_rigid) return Linkage::ground;
  if (choice_.beams_are_rigid) return part_of(scene_.beams[thing->index].start);
  const auto [inner, is_new] = part_of_inner_.try_emplace(place, Linkage::ground);
  if (is_new) {
    inner->second = add_part(place);
    has_beam.back() = true;
  }
  return inner->second;
}

void SceneLinkage::hold(const std::string& place, std::vector<Twist> rows) {
  const int part = part_of(place);
  if (part != Linkage::ground && !rows.empty())
    linkage.add({Linkage::ground, part, place, std::move(rows), Vec3d::zero(), false});
}

Twist SceneLinkage::row_of(const scene::Joint& j, const scene::JointRow& row, const Frame& H_a,
                           const Frame& H_b) const {
  const auto gradient = scene::eval_row(row, j.pitch, motion::relative(H_a, H_b)).gradient;
  const Vec3d force = H_b.R * lanes::linear_part(gradient), moment = H_b.R * lanes::angular_part(gradient);
  const double unit = motion::traits_of(row.kind).is_length ? linkage.size() : 1.0;
  return linkage.along(force, H_b.x) + (1.0 / unit) * Linkage::about(moment);
}

void SceneLinkage::add_joint(const scene::Joint& j) {
  const auto H_a = poses_.of(j.first), H_b = poses_.of(j.second);
  LinkEdge edge{part_of(j.first.to), part_of(j.second.to), j.name, {}, Vec3d::zero(), true};
  if (!H_a || !H_b || edge.first == edge.second) return;
  const scene::JointType& type = scene::type_of(j.kind);
  const auto hold_row = [&](const scene::JointRow& row) { edge.rows.push_back(row_of(j, row, *H_a, *H_b)); };
  const auto hold_coordinate = [&](const std::string& name) {
    if (const scene::JointCoordinate* coordinate = type.coordinate(name)) hold_row({coordinate->kind});
  };
  edge.is_rod = std::any_of(type.rows.begin(), type.rows.end(),
                            [](const scene::JointRow& row) { return row.kind == motion::RowKind::distance; });
  edge.rows.reserve(type.rows.size() + j.drives.size() + j.forces.size());
  if (type.has_common_axis()) edge.axis = axis_of(*H_a, 2);
  for (const scene::JointRow& row : type.rows) hold_row(row);
  for (const scene::JointDrive& d : j.drives)
    if (choice_.drives_hold) hold_coordinate(d.coordinate);
  for (const scene::JointForce& f : j.forces)
    if (choice_.stiffness_holds && f.stiffness > 0.0) hold_coordinate(f.coordinate);
  linkage.add(std::move(edge));
}

void SceneLinkage::add_motion(const scene::PrescribedMotion& m) {
  const auto H = poses_.of(m.at);
  if (!H) return;
  const auto holds = [this](const laws::Law& law, const std::string& signal) {
    return choice_.drives_hold || (signal.empty() && law.is_constant());
  };
  std::vector<Twist> rows;
  for (int k = 0; k < 3; ++k)
    if (m.displacement[k] && holds(*m.displacement[k], m.displacement_signal[k]))
      rows.push_back(linkage.along(Vec3d::unit(k), H->x));
  if (m.hold_rotation || (m.rotation_axis && holds(m.angle, m.angle_signal)))
    for (int k = 0; k < 3; ++k) rows.push_back(Linkage::about(Vec3d::unit(k)));
  hold(m.at.to, std::move(rows));
}

/// A spring under tension or compression also resists motions across its line.
void SceneLinkage::add_stiffness() {
  for (const scene::Joint& j : scene_.joints) add_lateral(j);
  for (const scene::Coupling& c : scene_.couplings) {
    const auto a = poses_.of(c.first), b = poses_.of(c.second);
    LinkEdge edge{part_of(c.first.to), part_of(c.second.to), c.name, {}, Vec3d::zero(), false};
    if (!a || !b || edge.first == edge.second) continue;
    if (const auto force = scene::line_force_of(c)) {
      if (force->stiffness == 0.0) continue;
      const Vec3d span = b->x - a->x;
      const double length = length_of(span);
      const bool is_tense = std::abs(length - force->rest_length) > 1e-9 * length;
      for (int k = 0; k < 3 && is_tense; ++k) edge.rows.push_back(linkage.along(Vec3d::unit(k), b->x));
      if (!is_tense) edge.rows.push_back(linkage.along((1.0 / length) * span, b->x));
    } else {
      add_rows(edge, c.kind->stiffness(c, *a, *b), *a, b->x);
    }
    linkage.add(std::move(edge));
  }
}

/// The rows of a stiffness in the axes of `frame`, of forces at x, as rows that hold.
void SceneLinkage::add_rows(LinkEdge& edge, const motion::Mat6<double>& stiffness, const motion::Frame<double>& frame,
                            const Vec3d& x) {
  for (int i = 0; i < 6; ++i) {
    Twist row = Twist::Zero();
    for (int k = 0; k < 3; ++k)
      row += stiffness(i, k) * linkage.along(axis_of(frame, k), x) +
             stiffness(i, k + 3) * Linkage::about(axis_of(frame, k));
    if (row.norm() > 0.0) edge.rows.push_back(row.normalized());
  }
}

/// The plan holds the rotation of a point mass if it has no effect on other parts, and its spin about the line through
/// all its attachment points.
void SceneLinkage::add_point_masses() {
  struct Use {
    bool feels = false;  // another part depends on its rotation
    std::vector<Vec3d> met;
  };
  std::unordered_map<std::string, Use> uses;
  const auto look_at = [&](const scene::Attachment& a, bool turns) {
    const auto use = uses.find(a.to);
    if (use == uses.end()) return;
    use->second.feels |= turns;
    if (length_of(a.offset.x) > 0.0) use->second.met.push_back(a.offset.x);
  };
  for (const scene::Body& b : scene_.bodies)
    if (b.is_point_mass) uses.emplace(b.name, Use{});
  for (const scene::Joint& j : scene_.joints)
    for (const scene::Attachment* end : {&j.first, &j.second}) look_at(*end, !scene::type_of(j.kind).joins_points());
  for (const scene::Coupling& c : scene_.couplings) {
    look_at(c.first, !c.kind->acts_along_line);
    look_at(c.second, !c.kind->pulls_at_point);
  }
  for (const scene::Beam& beam : scene_.beams)
    for (const std::string* end : {&beam.start, &beam.end})
      if (const auto use = uses.find(*end); use != uses.end()) use->second.feels = true;
  for (const scene::Body& b : scene_.bodies) {
    if (!b.is_point_mass) continue;
    const auto& [feels, met] = uses.at(b.name);
    if (feels) continue;
    std::vector<Twist> rows;
    const bool is_in_line = std::all_of(met.begin(), met.end(), [&first = met](const Vec3d& x) {
      return length_of(lanes::cross(x, first.front())) <= 1e-12 * lanes::dot(x, x);
    });
    if (met.empty())
      for (int k = 0; k < 3; ++k) rows.push_back(Linkage::about(Vec3d::unit(k)));
    else if (is_in_line)
      if (const auto H = poses_.of(b.placement))
        rows.push_back(Linkage::about((1.0 / length_of(met.front())) * (H->R * met.front())));
    hold(b.name, std::move(rows));
  }
}

void SceneLinkage::add_masses(const scene::Body& b) {
  const auto H = poses_.of(b.placement);
  if (!H || b.mass == 0.0) return;
  std::vector<Twist> rows;
  for (int k = 0; k < 3; ++k) rows.push_back(linkage.along(Vec3d::unit(k), motion::transform(*H, b.center_of_mass)));
  const double trace = b.inertia(0, 0) + b.inertia(1, 1) + b.inertia(2, 2);
  for (int i = 0; i < 3 && trace > 0.0; ++i) {
    Vec3d row = Vec3d::zero();
    for (int k = 0; k < 3; ++k) row += (b.inertia(i, k) / trace) * axis_of(*H, k);
    rows.push_back(Linkage::about(row));
  }
  hold(b.name, std::move(rows));
}

/// The mass of a beam lies along its axis, and resists displacements of each of its points; its spin only with inertia of
/// its sections about their axis.
void SceneLinkage::add_masses(const scene::Beam& b) {
  const auto axis = poses_.axis_of(b);
  const auto section = std::find_if(scene_.sections.begin(), scene_.sections.end(),
                                    [&b](const scene::Section& s) { return s.name == b.section; });
  if (!axis || section == scene_.sections.end() || !(section->mass(0, 0) > 0.0)) return;
  std::vector<Twist> rows;
  for (const double at : {0.0, 0.5, 1.0})
    for (int k = 0; k < 3; ++k) rows.push_back(linkage.along(Vec3d::unit(k), axis->at(at).x));
  if (section->mass(3, 3) > 0.0) rows.push_back(Linkage::about(axis_of(axis->start, 0)));
  hold(b.start, std::move(rows));
}

void SceneLinkage::restrict_to(Motions motions, const Vec3d& normal) {
  if (motions == Motions::spatial) return;
  for (std::size_t part = 1; part < names.size(); ++part) {
    LinkEdge edge{Linkage::ground, static_cast<int>(part), names[part], {}, Vec3d::zero(), false};
    if (motions == Motions::planar) {
      edge.rows.push_back(linkage.along(normal, linkage.center()));
      for (int k = 0; k < 3; ++k) {
        const Vec3d in_plane = lanes::cross(normal, Vec3d::unit(k));
        if (length_of(in_plane) > 0.1) edge.rows.push_back(Linkage::about(in_plane));
      }
    } else {
      for (int k = 0; k < 3; ++k) edge.rows.push_back(Linkage::about(Vec3d::unit(k)));
    }
    linkage.add(std::move(edge));
  }
}

}  // namespace bough::plan
