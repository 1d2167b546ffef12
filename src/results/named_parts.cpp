#include "bough/results/named_parts.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <unordered_map>
#include <unordered_set>

#include "bough/elements/limits.hpp"
#include "bough/scene/poses.hpp"
#include "observe_parts.hpp"

namespace bough::results {

using motion::Frame;
using motion::Vec3;
using motion::Vec6;

namespace {

/// Between a part and where the state has it, relative to the size of the structure, in rad, or relative to the largest
/// speed: above what joints leave open in a run.
constexpr double agrees = 1e-6;

motion::PreciseFrame<double> place_of(const records::StoredPart& part) {
  motion::PreciseFrame<double> H;
  H.R = motion::rotation_of(
      motion::Quaternion<double>{part.rotation[0], {part.rotation[1], part.rotation[2], part.rotation[3]}});
  for (int i = 0; i < 3; ++i) {
    H.x.hi[i] = part.position[static_cast<std::size_t>(i)];
    H.x.lo[i] = part.rest[static_cast<std::size_t>(i)];
  }
  return H;
}

Vec6<double> twist_of(const records::StoredPart& part) {
  Vec6<double> v;
  std::copy(part.velocity.begin(), part.velocity.end(), v.v);
  std::copy(part.angular_velocity.begin(), part.angular_velocity.end(), v.v + 3);
  return v;
}

/// Pose of a port, with all digits of its node.
motion::PreciseFrame<double> place_of(const elements::Port& port, const elements::Field& field) {
  if (port.node == elements::ground) return motion::PreciseFrame<double>::from(motion_of_port(port, field).pose);
  const elements::NodeMotion& n = field.nodes[port.node];
  motion::PreciseFrame<double> H{n.R, n.x};
  if (!port.has_offset) return H;
  H.x.add(n.R * port.offset.x);
  H.R = n.R * port.offset.R;
  return H;
}

elements::Port port_of(int node, const Frame<double>& offset) { return {node, true, offset, -1}; }

template <class List>
auto by_name(const List& list) {
  std::unordered_map<std::string_view, const typename List::value_type*> found;
  for (const auto& item : list) found.emplace(item.name, &item);
  return found;
}

double size_of(const Vec6<double>& v, double length) {
  return std::max(length_of(lanes::linear_part(v)) / length, length_of(lanes::angular_part(v)));
}

}  // namespace

NamedParts::NamedParts(const scene::Scene& scene, const plan::Plan& plan) : frame_(scene.analysis.frame) {
  std::unordered_set<std::string> names;
  const auto add = [&](const std::string& name, const elements::Port& port) {
    if (names.insert(name).second) parts_.push_back({name, port});
  };
  for (std::size_t n = 0; n < plan.nodes.size(); ++n)
    add(plan.nodes[n].name, {static_cast<int>(n), false, Frame<double>::identity(), -1});
  for (const plan::BodyPlan& body : plan.bodies) add(body.name, body.frame);
  // Of nodes that were welded to others the plan has no more than the welds.
  const scene::Poses poses(scene);
  const auto joints = by_name(scene.joints);
  for (const plan::WeldPlan& weld : plan.welds) {
    const auto joint = joints.find(weld.name);
    if (joint == joints.end()) continue;
    for (const auto& [side, port] :
         {std::pair(&joint->second->first, &weld.first), std::pair(&joint->second->second, &weld.second)}) {
      const std::optional<Frame<double>> pose = poses.of(side->to);
      if (port->node == elements::ground || !pose) continue;
      add(side->to,
          port_of(port->node, motion::relative(plan.nodes[static_cast<std::size_t>(port->node)].pose, *pose)));
    }
  }
  for (const scene::Beam& beam : scene.beams) beams_.push_back({beam.name, beam.elements, beam.order});
}

records::StoredState NamedParts::store(const step::System& system, const step::State& state) const {
  const plan::Plan& plan = system.plan();
  const elements::Field field = system.instant().field(state);
  records::StoredState stored;
  stored.time = state.time;
  stored.runs_over_load = !plan.is_dynamic;
  stored.frame = frame_;
  stored.beams = beams_;
  stored.parts.reserve(parts_.size());
  for (const Part& part : parts_) {
    const motion::PreciseFrame<double> H = place_of(part.port, field);
    const motion::Quaternion<double> q = motion::normalise(motion::quaternion_of(H.R));
    const Vec6<double> v = motion_of_port(part.port, field).v;
    records::StoredPart& to = stored.parts.emplace_back();
    to.name = part.name;
    std::copy_n(H.x.hi.v, 3, to.position.begin());
    std::copy_n(H.x.lo.v, 3, to.rest.begin());
    to.rotation = {q.w, q.v[0], q.v[1], q.v[2]};
    std::copy_n(v.v, 3, to.velocity.begin());
    std::copy_n(v.v + 3, 3, to.angular_velocity.begin());
  }
  for (const int j : plan.turning_joints)
    stored.turns.push_back({plan.joints[static_cast<std::size_t>(j)].name, state.turns[static_cast<std::size_t>(j)]});
  for (std::size_t i = 0; i < plan.signals.size(); ++i)
    if (plan.signals[i].is_state() || plan.signals[i].rule == plan::SignalRule::input)
      stored.signals.push_back({plan.signals[i].name, state.signals.value[i]});
  return stored;
}

NamedParts::Taken NamedParts::take(const records::StoredState& stored, const step::System& system,
                                   step::State& state) const {
  const plan::Plan& plan = system.plan();
  Taken taken;
  const auto parts = by_name(stored.parts);
  std::vector<bool> is_held(plan.nodes.size(), false), is_placed(plan.nodes.size(), false);
  for (const plan::HeldNode& held : plan.held) is_held[static_cast<std::size_t>(held.node)] = true;
  const std::vector<elements::NodeMotion> before = step::nodes_in_space(plan, state);
  for (const Part& part : parts_) {
    const auto found = parts.find(part.name);
    if (found == parts.end() || part.port.node == elements::ground) continue;
    const auto n = static_cast<std::size_t>(part.port.node);
    if (is_placed[n]) continue;
    is_placed[n] = true;
    if (is_held[n]) continue;
    motion::PreciseFrame<double> H = place_of(*found->second);
    if (part.port.has_offset) {
      const Frame<double> back = motion::inverse(part.port.offset);
      H.x.add(H.R * back.x);
      H.R = H.R * back.R;
    }
    const Frame<double> way = motion::relative(motion::PreciseFrame<double>{before[n].R, before[n].x}, H);
    step::move_node(plan, state, n, motion::log_se3(way));
    const Vec6<double> v = twist_of(*found->second);
    step::set_velocity(plan, state, n, part.port.has_offset ? motion::adjoint_times(part.port.offset, v) : v);
  }
  // The increments that the nodes have got are none of a step.
  state.change_all([](auto& nodes) {
    for (auto& n : nodes.motion) n.dq = n.a = std::decay_t<decltype(nodes)>::Vector::zero();
  });
  for (const Part& part : parts_)
    if (part.port.node != elements::ground && !is_placed[static_cast<std::size_t>(part.port.node)])
      taken.as_scene.push_back(part.name);
  const auto own = by_name(parts_);
  for (const records::StoredPart& part : stored.parts)
    if (own.count(part.name) == 0) taken.left.push_back(part.name);
  const auto signals = by_name(stored.signals);
  for (std::size_t i = 0; i < plan.signals.size(); ++i) {
    const auto found = signals.find(plan.signals[i].name);
    if (found == signals.end()) continue;
    const bool is_input = plan.signals[i].rule == plan::SignalRule::input;
    if (!is_input && !plan.signals[i].is_state()) continue;
    state.signals.value[i] = found->second->value;
    if (is_input) state.signals.given[i] = found->second->value;
  }
  const elements::Field field = system.instant().field(state);
  const auto turns = by_name(stored.turns);
  for (const int j : plan.turning_joints) {
    const auto found = turns.find(plan.joints[static_cast<std::size_t>(j)].name);
    state.turns[static_cast<std::size_t>(j)] = elements::eval_joint_angle(
        plan::joint_element(plan, j), field, found == turns.end() ? 0.0 : found->second->value);
  }
  taken.refusal = disagreement(stored, system, state);
  return taken;
}

std::string NamedParts::disagreement(const records::StoredState& stored, const step::System& system,
                                     const step::State& state) const {
  const plan::Plan& plan = system.plan();
  const elements::Field field = system.instant().field(state);
  const auto parts = by_name(stored.parts);
  double speed = 0.0;
  for (const records::StoredPart& part : stored.parts)
    speed = std::max(speed, size_of(twist_of(part), plan.length_scale));
  std::unordered_set<int> held;
  for (const plan::HeldNode& node : plan.held) held.insert(node.node);
  const Part* worst = nullptr;
  double most = agrees;
  bool is_place = true;
  for (const Part& part : parts_) {
    const auto found = parts.find(part.name);
    if (found == parts.end()) continue;
    const auto see = [&](double off, bool of_place) {
      if (!(off > most)) return;
      most = off;
      worst = &part;
      is_place = of_place;
    };
    const bool is_point =
        part.port.node != elements::ground && plan.nodes[static_cast<std::size_t>(part.port.node)].is_point;
    const Frame<double> way = motion::relative(place_of(part.port, field), place_of(*found->second));
    see(length_of(way.x) / plan.length_scale, true);
    if (!is_point) see(length_of(motion::log_so3(way.R)), true);
    // What is held does not move whatever its velocity was, as behind any joint that closes in an instant.
    if (part.port.node == elements::ground || held.count(part.port.node) > 0 || speed == 0.0) continue;
    Vec6<double> off = motion_of_port(part.port, field).v - twist_of(*found->second);
    if (is_point) off = lanes::join(lanes::linear_part(off), Vec3<double>::zero());
    see(size_of(off, plan.length_scale) / speed, false);
  }
  if (worst == nullptr) return {};
  char amount[80];
  std::snprintf(amount, sizeof amount,
                is_place ? "%.3g of the size of the structure (or rad)" : "%.3g of the largest speed", most);
  std::string text =
      "'" + worst->name + "' cannot " + (is_place ? "be where" : "move as") + " the state has it, by " + amount + ": ";
  const int node = worst->port.node;
  if (node == elements::ground || held.count(node) > 0)
    return text + "the scene holds it; release it, or hold it where the run had it";
  if (worst->port.has_offset)
    return text + "it is fixed to '" + plan.nodes[static_cast<std::size_t>(node)].name +
           "' here, and was not in the run, or elsewhere; leave out the fixed joint, or bar the decision \"welded\"";
  for (const char* decision : {"line", "translation", "planar"})
    if (plan.took(decision))
      return text + "the plan has taken out motions that the run had; --without " + decision + " keeps them";
  return text;
}

}  // namespace bough::results
