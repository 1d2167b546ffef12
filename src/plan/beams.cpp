#include <cmath>

#include "bough/scene/components.hpp"
#include "bough/scene/poses.hpp"
#include "plan_builder.hpp"

namespace bough::plan {

using elements::Port;
using motion::Frame;
using motion::Mat3;
using motion::Vec3;
using motion::Vec6;

namespace {

Vec3<double> unit(const Vec3<double>& a) { return (1.0 / std::sqrt(lanes::dot(a, a))) * a; }

/// Axes (1, 2, 3) with axis 1 along `first` and axis 2 nearest to `second`; zero or parallel: axis 3 nearest to inertial z, else axis 2 to y.
Mat3<double> section_axes(const Vec3<double>& first, const Vec3<double>& second) {
  const Vec3<double> e1 = unit(first);
  Vec3<double> e2 = second - lanes::dot(second, e1) * e1;
  if (lanes::dot(e2, e2) <= 1e-20 * lanes::dot(second, second)) {
    e2 = lanes::cross(Vec3<double>::unit(2), e1);
    if (lanes::dot(e2, e2) < 1e-12) e2 = Vec3<double>::unit(1) - e1[1] * e1;
  }
  e2 = unit(e2);
  const Vec3<double> e3 = lanes::cross(e1, e2);
  return {{e1[0], e2[0], e3[0], e1[1], e2[1], e3[1], e1[2], e2[2], e3[2]}};
}

const scene::Section& section_of(const scene::Scene& scene, const std::string& name) {
  for (const scene::Section& s : scene.sections)
    if (s.name == name) return s;
  return scene.sections.front();  // not reached: references were checked
}

/// Start frame and helicoid of the axis: H(s) = H_0 exp(s d), s in [0, 1].
struct Axis {
  Frame<double> start;
  Vec6<double> d;
  double length;
};

Axis make_axis(const scene::Scene& scene, const scene::Beam& beam, const Vec3<double>& start, const Vec3<double>& end) {
  const Mat3<double> frame = scene::resolve(scene, {Frame<double>::identity(), beam.frame}).R;
  const Vec3<double> second = frame * beam.axis_2;
  Axis axis;
  if (beam.curve == scene::BeamCurve::straight) {
    const Vec3<double> along = end - start;
    axis.length = std::sqrt(lanes::dot(along, along));
    axis.start = {section_axes(along, second), start};
    axis.d = lanes::join(axis.length * Vec3<double>::unit(0), beam.twist * Vec3<double>::unit(0));
  } else {
    axis.length = beam.length;
    axis.start = {section_axes(frame * beam.tangent, second), start};
    axis.d = axis.length * lanes::join(Vec3<double>::unit(0), beam.curvature);
  }
  return axis;
}

}  // namespace

Mat3<double> axes_with_third(const Vec3<double>& direction) {
  const Mat3<double> a = section_axes(direction, Vec3<double>::zero());
  return {{a(0, 1), a(0, 2), a(0, 0), a(1, 1), a(1, 2), a(1, 0), a(2, 1), a(2, 2), a(2, 0)}};
}

namespace {

/// The port of a beam on a node that was given: the section's frame as seen from the node.
Port section_port(int node, const Frame<double>& node_pose, const Frame<double>& section, double length) {
  Port port;
  port.node = node;
  const Frame<double> offset = motion::relative(node_pose, section);
  const Vec6<double> size = motion::Se3::log(offset);
  const double shift = std::sqrt(lanes::dot(lanes::linear_part(size), lanes::linear_part(size)));
  const double turn = std::sqrt(lanes::dot(lanes::angular_part(size), lanes::angular_part(size)));
  port.has_offset = shift > 1e-14 * length || turn > 1e-14;  // below: the round-off of the axis
  if (port.has_offset) port.offset = offset;
  return port;
}

template <int N>
void add_elements(Builder& b, const scene::Beam& beam, BeamPlan& plan, const Axis& axis,
                  const std::vector<Port>& ports) {
  const scene::Section& section = section_of(b.scene, beam.section);
  elements::Beam<N> e;
  e.length = axis.length / beam.elements;
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
      // Relative to the element's own start, so that the reference keeps its digits anywhere in space.
      reference[i].H = motion::Se3::exp((static_cast<double>(i) / ((N - 1) * beam.elements)) * axis.d);
      reference[i].v = reference[i].a = Vec6<double>::zero();
    }
    elements::set_reference(e, reference);
    plan.elements.push_back(b.add(e, beam.name));
    plan.loads.emplace_back();
    for (const scene::LineLoad& l : b.scene.line_loads) {
      if (l.beam != beam.name) continue;
      elements::LineLoad<N> load;
      for (int i = 0; i < N; ++i) load.ports[i] = e.ports[i];
      load.length = e.length;
      load.wrench = lanes::join(l.force, l.moment);
      load.follows = l.axes == scene::LoadAxes::body;
      load.law = b.line_load_law(l);
      plan.loads.back().push_back(b.add(load, l.name));
    }
  }
}

}  // namespace

int Builder::line_load_law(const scene::LineLoad& load) {
  const auto [at, is_new] = line_laws.try_emplace(load.name, 0);
  if (is_new) at->second = add_factor(load.law, load.name);
  return at->second;
}

void Builder::add_beams() {
  for (const scene::Beam& beam : scene.beams) {
    const int start = node_of.at(beam.start), end = node_of.at(beam.end);
    const Frame<double> start_pose = plan.nodes[static_cast<std::size_t>(start)].pose;
    const Frame<double> end_pose = plan.nodes[static_cast<std::size_t>(end)].pose;
    const Vec3<double> from = beam.start_offset ? motion::transform(start_pose, *beam.start_offset) : start_pose.x;
    const Vec3<double> to = beam.end_offset ? motion::transform(end_pose, *beam.end_offset) : end_pose.x;
    const Axis axis = make_axis(scene, beam, from, to);
    BeamPlan p;
    p.name = beam.name;
    p.order = beam.order;
    p.length = axis.length;
    const int last = beam.elements * beam.order;
    std::vector<Port> ports(static_cast<std::size_t>(last) + 1);
    for (int k = 0; k <= last; ++k) {
      const Frame<double> section =
          motion::compose(axis.start, motion::Se3::exp((static_cast<double>(k) / last) * axis.d));
      Port& port = ports[static_cast<std::size_t>(k)];
      if (k == 0)
        port = section_port(start, start_pose, section, axis.length);
      else if (k == last)
        port = section_port(end, end_pose, section, axis.length);
      else
        port.node = add_node(beam.name + "." + std::to_string(k), section);
      p.nodes.push_back(port.node);
    }
    if (beam.order == 1)
      add_elements<2>(*this, beam, p, axis, ports);
    else if (beam.order == 2)
      add_elements<3>(*this, beam, p, axis, ports);
    else
      add_elements<4>(*this, beam, p, axis, ports);
    plan.beams.push_back(std::move(p));
  }
}

void Builder::add_sensors() {
  for (const scene::Sensor& s : scene.sensors) {
    SensorPlan p;
    p.sensor = s;
    p.components = scene::components_of(s.kind);
    if (p.components.empty()) p.components = {""};
    for (std::size_t i = 0; i < plan.beams.size(); ++i)
      if (!s.beam.empty() && plan.beams[i].name == s.beam) p.beam = static_cast<int>(i);
    for (std::size_t i = 0; i < plan.joints.size(); ++i)
      if (!s.joint.empty() && plan.joints[i].name == s.joint && plan.joints[i].what != "held rotation" && p.joint < 0)
        p.joint = static_cast<int>(i);
    if (p.beam < 0 && !s.at.to.empty()) p.port = port_at(s.at);
    plan.sensors.push_back(p);
  }
}

}  // namespace bough::plan
