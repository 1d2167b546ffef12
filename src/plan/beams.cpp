#include <algorithm>
#include <cmath>

#include "bough/plan/stores.hpp"
#include "bough/scene/components.hpp"
#include "bough/scene/poses.hpp"
#include "geometry.hpp"
#include "plan_builder.hpp"

namespace bough::plan {

using elements::Port;
using motion::Frame;
using motion::Vec3;
using motion::Vec6;

namespace {

/// Vector d of the helicoid of a beam's axis, relative to its start: H(s) = H_0 exp(s d), s in [0, 1].
Vec6<double> helicoid(const scene::Beam& beam, double length) {
  if (beam.curve == scene::BeamCurve::straight)
    return lanes::join(length * Vec3<double>::unit(0), beam.twist * Vec3<double>::unit(0));
  return length * lanes::join(Vec3<double>::unit(0), beam.curvature);
}

/// The port of a beam on an existing node, with the section's frame relative to the node as its offset.
Port section_port(int node, const Frame<double>& node_pose, const Frame<double>& section, double length) {
  Port port;
  port.node = node;
  const Frame<double> offset = motion::relative(node_pose, section);
  if (is_identity(offset)) return port;
  const Vec6<double> size = motion::Se3::log(offset);
  const double shift = length_of(lanes::linear_part(size)), turn = length_of(lanes::angular_part(size));
  port.has_offset = shift > 1e-14 * length || turn > 1e-14;  // smaller offsets are round-off of the axis
  if (port.has_offset) port.offset = offset;
  return port;
}

/// Reserves space for the elements: each has some kB, and a growing array would copy them several times.
template <int N>
void reserve_elements(Builder& b, int order) {
  std::size_t count = 0;
  for (const scene::Beam& beam : b.scene.beams)
    if (beam.order == order) count += static_cast<std::size_t>(beam.elements);
  array_of<elements::Beam<N>>(b.plan.elements).reserve(count);
}

template <int N>
void add_elements(Builder& b, const scene::Beam& beam, BeamPlan& plan, const std::vector<Port>& ports) {
  const scene::Section& section = *b.section_of.at(beam.section);
  const auto loads = b.loads_of_beam.find(beam.name);
  elements::Beam<N> e;
  e.length = plan.length / beam.elements;
  const Vec6<double> d = helicoid(beam, plan.length);
  e.stiffness = section.stiffness;
  e.damping = section.damping;
  e.mass = section.mass;
  for (int i = 0; i < 36; ++i) {
    e.has_damping |= section.damping.m[i] != 0.0;
    e.has_mass |= section.mass.m[i] != 0.0;
  }
  for (int k = 0; k < beam.elements; ++k) {
    elements::PortMotion<double> reference[N];
    for (int i = 0; i < N; ++i) {
      const int node = k * (N - 1) + i;
      e.ports[i] = ports[static_cast<std::size_t>(node)];
      // Poses relative to the element's own start, so that the reference has no additional round-off far from the
      // origin.
      reference[i].H = motion::Se3::exp((static_cast<double>(i) / ((N - 1) * beam.elements)) * d);
      reference[i].v = reference[i].a = Vec6<double>::zero();
    }
    elements::set_reference(e, reference);
    plan.elements.push_back(b.add(e, beam.name));
    plan.loads.emplace_back();
    if (loads == b.loads_of_beam.end()) continue;
    for (const scene::LineLoad* l : loads->second) {
      elements::LineLoad<N> load;
      for (int i = 0; i < N; ++i) load.ports[i] = e.ports[i];
      load.length = e.length;
      for (const SpaceLoad& part : b.line_load(*l)) {
        load.wrench = part.wrench;
        load.follows = part.follows;
        load.law = part.law;
        plan.loads.back().push_back(b.add(load, l->name));
      }
    }
  }
}

}  // namespace

const std::vector<SpaceLoad>& Builder::line_load(const scene::LineLoad& load) {
  const auto [at, is_new] = line_loads.try_emplace(load.name);
  if (is_new)
    at->second = space_loads(load.force, load.moment, load.frame, load.axes == scene::LoadAxes::body,
                             add_factor(load.law, load.signal, load.name), load.name);
  return at->second;
}

void Builder::add_beams() {
  for (const scene::Section& s : scene.sections) section_of.emplace(s.name, &s);
  for (const scene::LineLoad& l : scene.line_loads) loads_of_beam[l.beam].push_back(&l);
  reserve_elements<2>(*this, 1);
  reserve_elements<3>(*this, 2);
  reserve_elements<4>(*this, 3);
  plan.beams.reserve(scene.beams.size());
  for (const scene::Beam& beam : scene.beams) {
    const int start = node_of.at(beam.start), end = node_of.at(beam.end);
    BeamPlan p;
    p.name = beam.name;
    p.order = beam.order;
    const scene::BeamAxis axis = poses.axis_of(beam).value();
    p.length = axis.length;
    const int last = beam.elements * beam.order;
    std::vector<Port> ports(static_cast<std::size_t>(last) + 1);
    for (int k = 0; k <= last; ++k) {
      const Frame<double> section = axis.at(static_cast<double>(k) / last);
      Port& port = ports[static_cast<std::size_t>(k)];
      if (k == 0 || k == last) {
        const int node = k == 0 ? start : end;
        port = section_port(node, plan.nodes[static_cast<std::size_t>(node)].pose, section, p.length);
        const std::string name = beam.name + "." + std::to_string(k);  // of the section at the beam's end
        node_of[name] = node;
        if (port.has_offset) part_offset.emplace(name, port.offset);
      } else {
        port.node = add_node(beam.name + "." + std::to_string(k), section);
      }
      p.nodes.push_back(port.node);
    }
    with_nodes_of_order(beam.order, [&]<int N>() { add_elements<N>(*this, beam, p, ports); });
    plan.beams.push_back(std::move(p));
  }
}

/// All elements of a prescribed motion, a coupling or a load.
std::vector<int> Builder::elements_with_force(const std::string& part) const {
  std::vector<int> ids;
  for (std::size_t id = 0; id < plan.directory.size(); ++id)
    if (plan.element_owner[id] == part) ids.push_back(static_cast<int>(id));
  return ids;
}

void Builder::add_sensors() {
  if (scene.sensors.empty()) return;
  std::unordered_map<std::string_view, int> joint_of;
  const bool reads_joints =
      std::any_of(scene.sensors.begin(), scene.sensors.end(), [](const scene::Sensor& s) { return !s.joint.empty(); });
  for (std::size_t i = 0; i < plan.joints.size() && reads_joints; ++i)  // the first joint of a prescribed motion
    joint_of.emplace(plan.joints[i].name, static_cast<int>(i));
  for (const scene::Sensor& s : scene.sensors) {
    SensorPlan p;
    p.sensor = s;
    if (const auto joint = poses.find(s.joint); joint && joint->kind == scene::ThingKind::joint)
      if (const scene::JointCoordinate* measured =
              scene::coordinate_of(s, scene::type_of(scene.joints[joint->index].kind))) {
        p.sensor.coordinate = measured->name;
        p.coordinate = measured->kind;
      }
    for (const scene::SensorComponent& c : scene::type_of(s.kind).components) p.components.push_back(c.name);
    if (const auto beam = poses.find(s.beam); beam && beam->kind == scene::ThingKind::beam)
      p.beam = static_cast<int>(beam->index);
    if (const auto joint = joint_of.find(s.joint); joint != joint_of.end()) p.joint = joint->second;
    if (s.kind == scene::SensorKind::joint_effort)
      p.effort =
          read_effort(scene.joints[poses.find(s.joint)->index], joint_element(plan, p.joint), p.coordinate, s.of);
    if (!s.signal.empty()) {
      p.signal = law_of_signal.at(s.signal);
      p.signal_unit = unit_of_signal.at(s.signal);
    }
    if (!s.part.empty()) p.elements = elements_with_force(s.part);
    if (!s.subdomain.empty()) {
      p.subdomain = scene::read_path(s.subdomain).value();
      if (!s.at.to.empty()) p.port = port_at(s.at);
    }
    if (p.beam < 0 && scene::type_of(s.kind).of == scene::SensorOf::point) p.port = port_at(s.at);
    p.frame = port_at(s.frame, Frame<double>::identity());
    for (const std::string& name : s.chain) p.chain.push_back(port_at(name, Frame<double>::identity()));
    if (s.chain.empty() && !s.frame.empty()) p.chain.push_back(p.frame);
    plan.sensors.push_back(p);
  }
}

void Builder::list_turning_joints() {
  std::vector<char> is_read(plan.joints.size(), 0);
  const auto note = [&is_read](int joint, motion::RowKind coordinate) {
    if (joint >= 0 && motion::traits_of(coordinate).has_angle) is_read[static_cast<std::size_t>(joint)] = 1;
  };
  for (std::size_t j = 0; j < plan.joints.size(); ++j) {
    const elements::Joint& e = joint_element(plan, static_cast<int>(j));
    for (int k = 0; k < e.num_rows; ++k) note(static_cast<int>(j), e.rows[k].kind);
    for (int k = 0; k < e.num_efforts; ++k) note(static_cast<int>(j), e.efforts[k].coordinate);
  }
  for (const SignalPlan& s : plan.signals) note(s.joint, motion::RowKind::angle);
  for (const SensorPlan& s : plan.sensors) note(s.joint, s.coordinate);
  for (std::size_t j = 0; j < is_read.size(); ++j)
    if (is_read[j] != 0) plan.turning_joints.push_back(static_cast<int>(j));
}

}  // namespace bough::plan
