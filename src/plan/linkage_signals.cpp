/// What forces that signals drive hold in statics.
#include <algorithm>
#include <unordered_map>

#include "bough/scene/joint_kinds.hpp"
#include "bough/scene/signals.hpp"
#include "geometry.hpp"
#include "linkage_of.hpp"

namespace bough::plan {

using Frame = motion::Frame<double>;
using scene::SignalKind;

namespace {

/// What a signal measures at rest, where rates are zero.
bool reads_places(const scene::Signal& s) {
  switch (s.kind) {
    case SignalKind::joint_angle:
    case SignalKind::joint_displacement:
    case SignalKind::joint_effort:
    case SignalKind::spring_tension:
    case SignalKind::position:
      return true;
    default:
      return false;
  }
}

/// The signals that drive forces, with all from which these follow. In statics a state has the value with which its
/// rate vanishes, which its inputs determine.
std::vector<bool> signals_of_forces(const scene::Scene& scene) {
  std::unordered_map<std::string_view, std::size_t> index_of;
  for (std::size_t i = 0; i < scene.signals.size(); ++i) index_of.emplace(scene.signals[i].name, i);
  std::vector<bool> is_used(scene.signals.size(), false);
  std::vector<std::size_t> left;
  const auto use = [&](std::size_t i) {
    if (!is_used[i]) left.push_back(i);
    is_used[i] = true;
  };
  const auto use_name = [&](const std::string& name) {
    if (const auto known = index_of.find(name); known != index_of.end()) use(known->second);
  };
  for (const scene::Joint& j : scene.joints)
    for (const scene::JointForce& f : j.forces) use_name(f.signal);
  for (const scene::PointLoad& load : scene.point_loads) use_name(load.signal);
  for (const scene::LineLoad& load : scene.line_loads) use_name(load.signal);
  if (left.empty()) return is_used;
  const std::vector<std::vector<std::size_t>> inputs = scene::present_inputs(scene);
  while (!left.empty()) {
    const std::size_t i = left.back();
    left.pop_back();
    for (const std::size_t input : inputs[i]) use(input);
    for (const std::string& input : scene.signals[i].inputs) use_name(input);
  }
  return is_used;
}

}  // namespace

std::vector<std::size_t> places_read_by_forces(const scene::Scene& scene) {
  const std::vector<bool> is_used = signals_of_forces(scene);
  std::vector<std::size_t> read;
  for (std::size_t i = 0; i < is_used.size(); ++i)
    if (is_used[i] && reads_places(scene.signals[i])) read.push_back(i);
  return read;
}

void SceneLinkage::add_signals() {
  if (choice_.signals == SignalsHold::reads) {
    for (const std::size_t i : places_read_by_forces(scene_)) add_reading(scene_.signals[i]);
    return;
  }
  for (const scene::Joint& j : scene_.joints) {
    const auto H_a = poses_.of(j.first), H_b = poses_.of(j.second);
    LinkEdge edge{part_of(j.first.to), part_of(j.second.to), j.name, {}, Vec3d::zero(), false};
    if (!H_a || !H_b || edge.first == edge.second) continue;
    for (const scene::JointForce& f : j.forces)
      if (const auto* coordinate = scene::type_of(j.kind).coordinate(f.coordinate); coordinate && !f.signal.empty())
        edge.rows.push_back(row_of(j, {coordinate->kind}, *H_a, *H_b));
    if (!edge.rows.empty()) linkage.add(std::move(edge));
  }
  for (const scene::PointLoad& load : scene_.point_loads)
    if (!load.signal.empty()) add_load(load);
  for (const scene::LineLoad& load : scene_.line_loads) {
    const auto thing = poses_.find(load.beam);
    if (load.signal.empty() || !thing || thing->kind != scene::ThingKind::beam) continue;
    const scene::Beam& beam = scene_.beams[thing->index];
    if (const auto axis = poses_.axis_of(beam)) {
      const Frame middle = axis->at(0.5);
      const auto in_ground = poses_.of(std::string_view(load.frame));
      const motion::Mat3<double> R = load.axes == scene::LoadAxes::body || !in_ground ? middle.R : in_ground->R;
      add_action(beam.start, middle.x, R * load.force, R * load.moment);
    }
  }
}

/// Rows of all relative motions where a multiplier is read, which every motion of the parts may change.
void SceneLinkage::add_reading(const scene::Signal& s) {
  const scene::Attachment* first = nullptr;
  const scene::Attachment* second = nullptr;
  scene::Attachment observer;
  const auto named = [](const auto& list, const std::string& name) {
    const auto item = std::find_if(list.begin(), list.end(), [&name](const auto& x) { return x.name == name; });
    return item == list.end() ? nullptr : &*item;
  };
  const scene::Joint* joint = scene::reads_joint(s.kind) ? named(scene_.joints, s.joint) : nullptr;
  const scene::Coupling* spring = s.kind == SignalKind::spring_tension ? named(scene_.couplings, s.spring) : nullptr;
  if (joint != nullptr) {
    first = &joint->first;
    second = &joint->second;
  } else if (spring != nullptr) {
    first = &spring->first;
    second = &spring->second;
  } else if (scene::reads_point(s.kind)) {
    observer.to = s.frame;
    first = &observer;
    second = &s.at;
  }
  if (first == nullptr) return;
  const auto H_a = poses_.of(*first), H_b = poses_.of(*second);
  LinkEdge edge{part_of(first->to), part_of(second->to), s.name, {}, Vec3d::zero(), false};
  if (!H_a || !H_b || edge.first == edge.second) return;
  const scene::JointCoordinate* coordinate = joint == nullptr || s.kind == SignalKind::joint_effort
                                                 ? nullptr
                                                 : scene::coordinate_of(s, scene::type_of(joint->kind));
  if (coordinate != nullptr) {
    edge.rows.push_back(row_of(*joint, {coordinate->kind}, *H_a, *H_b));
  } else if (scene::reads_point(s.kind)) {
    edge.rows.push_back(linkage.along(H_a->R * Vec3d::unit(s.axis), H_b->x));
  } else {
    for (int k = 0; k < 3; ++k) edge.rows.push_back(linkage.along(Vec3d::unit(k), H_b->x));
    for (int k = 0; k < 3 && joint != nullptr; ++k) edge.rows.push_back(Linkage::about(Vec3d::unit(k)));
  }
  linkage.add(std::move(edge));
}

void SceneLinkage::add_load(const scene::PointLoad& load) {
  const auto at = poses_.of(load.at), own = poses_.of(std::string_view(load.at.to)),
             in_ground = poses_.of(std::string_view(load.frame));
  if (!at || !own || !in_ground) return;
  const motion::Mat3<double> R = load.axes == scene::LoadAxes::body ? at->R : in_ground->R;
  add_action(load.at.to, at->x, R * load.force, R * load.moment);
}

void SceneLinkage::add_action(const std::string& place, const Vec3d& x, const Vec3d& force, const Vec3d& moment) {
  const Twist row = linkage.along(force, x) + (1.0 / linkage.size()) * Linkage::about(moment);
  if (row.norm() > 0.0) hold(place, {row.normalized()});
}

/// A rod or an actuator between two points that carries a force resists motions across its line.
void SceneLinkage::add_lateral(const scene::Joint& j) {
  const scene::JointType& type = scene::type_of(j.kind);
  const bool may_pull = std::any_of(j.forces.begin(), j.forces.end(), [&type](const scene::JointForce& f) {
    const scene::JointCoordinate* coordinate = type.coordinate(f.coordinate);
    return coordinate != nullptr && coordinate->kind == motion::RowKind::distance;
  });
  const auto H_a = poses_.of(j.first), H_b = poses_.of(j.second);
  LinkEdge edge{part_of(j.first.to), part_of(j.second.to), j.name, {}, Vec3d::zero(), false};
  if (!may_pull || !H_a || !H_b || edge.first == edge.second) return;
  const Vec3d span = H_b->x - H_a->x;
  for (int k = 0; k < 3; ++k) {
    const Vec3d across = lanes::cross(span, Vec3d::unit(k));
    if (length_of(across) > 1e-3 * length_of(span))
      edge.rows.push_back(linkage.along((1.0 / length_of(across)) * across, H_b->x));
  }
  if (!edge.rows.empty()) linkage.add(std::move(edge));
}

}  // namespace bough::plan
