#include "bough/scene/parts.hpp"

#include <algorithm>
#include <stdexcept>

#include "bough/scene/sensor_kinds.hpp"

namespace bough::scene {

scene::Section make_section(const std::string& name, double EA, double GA2, double GA3, double GJ, double EI2,
                            double EI3) {
  scene::Section s;
  s.name = name;
  s.stiffness = s.mass = s.damping = scene::Mat6::zero();
  const double diagonal[6] = {EA, GA2, GA3, GJ, EI2, EI3};
  for (int i = 0; i < 6; ++i) s.stiffness(i, i) = diagonal[i];
  return s;
}

void set_mass(scene::Section& s, double mass, double rotary_1, double rotary_2, double rotary_3) {
  const double diagonal[6] = {mass, mass, mass, rotary_1, rotary_2, rotary_3};
  for (int i = 0; i < 6; ++i) s.mass(i, i) = diagonal[i];
}

scene::Node make_node(const std::string& name, const Vec3& position) {
  scene::Node n;
  n.name = name;
  n.placement.pose.x = position;
  return n;
}

scene::Beam make_beam(const std::string& name, const std::string& section, const std::string& start,
                      const std::string& end, int elements, int order) {
  scene::Beam b;
  b.name = name;
  b.section = section;
  b.start = start;
  b.end = end;
  b.axis_2 = Vec3::unit(1);
  b.elements = elements;
  b.order = order;
  return b;
}

scene::Joint make_weld(const std::string& name, const std::string& node) {
  scene::Joint j;
  j.name = name;
  j.kind = scene::JointKind::fixed;
  j.second.to = node;
  return j;
}

scene::Joint make_joint(const std::string& name, scene::JointKind kind, const std::string& first,
                        const Vec3& first_offset, const std::string& second, const Vec3& second_offset) {
  scene::Joint j;
  j.name = name;
  j.kind = kind;
  j.first.to = first;
  j.first.offset.x = first_offset;
  j.second.to = second;
  j.second.offset.x = second_offset;
  return j;
}

scene::Body make_body(const std::string& name, double mass, const Vec3& inertia, const Vec3& position) {
  scene::Body b;
  b.name = name;
  b.mass = mass;
  for (int i = 0; i < 3; ++i) b.inertia(i, i) = inertia[i];
  b.placement.pose.x = position;
  return b;
}

Coupling make_coupling(const CouplingKind& kind, const std::string& name, const std::string& first,
                       const std::string& second, std::vector<double> values) {
  std::size_t numbers = 0, laws = 0;
  for (const CouplingField& field : kind.fields) {
    numbers += field.count();
    laws += field.type == CouplingFieldType::law ? 1 : 0;
  }
  values.resize(numbers);
  return {&kind, name, {first}, {second}, std::move(values), std::vector<Factor>(laws)};
}

scene::PointLoad make_load(const std::string& node, const Vec3& force, const Vec3& moment, scene::LoadAxes axes) {
  scene::PointLoad l;
  l.name = "load at " + node;
  l.at.to = node;
  l.axes = axes;
  l.force = force;
  l.moment = moment;
  return l;
}

scene::Sensor make_point_sensor(const std::string& name, scene::SensorKind kind, const std::string& node) {
  scene::Sensor s;
  s.name = name;
  s.kind = kind;
  s.at.to = node;
  return s;
}

scene::Sensor make_section_sensor(const std::string& name, const std::string& beam, double station) {
  scene::Sensor s;
  s.name = name;
  s.kind = scene::SensorKind::section_force;
  s.beam = beam;
  s.station = station;
  return s;
}

scene::Sensor make_joint_sensor(const std::string& name, const std::string& joint, scene::SensorKind kind) {
  scene::Sensor s;
  s.name = name;
  s.kind = kind;
  s.joint = joint;
  return s;
}

scene::Scene make_cantilever(const scene::Section& section, double length, int elements, int order) {
  scene::Scene s;
  s.name = "cantilever";
  s.sections = {section};
  s.nodes = {make_node("root", Vec3::zero()), make_node("tip", length * Vec3::unit(0))};
  s.beams = {make_beam("beam", section.name, "root", "tip", elements, order)};
  s.joints = {make_weld("clamp", "root")};
  s.sensors = {make_point_sensor("tip", scene::SensorKind::position, "tip"),
               make_point_sensor("turn", scene::SensorKind::rotation, "tip"), make_joint_sensor("clamp", "clamp")};
  s.analysis.kind = scene::AnalysisKind::statics;
  return s;
}

scene::Scene make_four_bars(int windows) {
  scene::Scene s;
  s.name = "four_bars";
  s.gravity = {{0.0, -9.81, 0.0}};
  const double across = 1.0 / 12.0;
  const auto add_speed = [&s](const std::string& of, double speed, double turning) {
    scene::InitialVelocity v;
    v.of = of;
    v.velocity = {{speed, 0.0, 0.0}};
    v.angular_velocity = {{0.0, 0.0, turning}};
    s.initial_velocities.push_back(v);
  };
  constexpr scene::JointKind hinge = scene::JointKind::revolute;
  for (int k = 0; k <= windows; ++k) {
    const std::string name = std::to_string(k), crank = "crank " + name;
    const auto x = static_cast<double>(k);
    s.bodies.push_back(make_body(crank, 1.0, {{across, 0.0, across}}, {{x, 0.5, 0.0}}));
    add_speed(crank, 0.5, -1.0);
    s.joints.push_back(make_joint("A" + name, hinge, "", {{x, 0.0, 0.0}}, crank, {{0.0, -0.5, 0.0}}));
    if (k == 0) continue;
    const std::string coupler = "coupler " + name, before = "crank " + std::to_string(k - 1);
    s.bodies.push_back(make_body(coupler, 1.0, {{0.0, across, across}}, {{x - 0.5, 1.0, 0.0}}));
    add_speed(coupler, 1.0, 0.0);
    s.joints.push_back(make_joint("B" + name + " left", hinge, before, {{0.0, 0.5, 0.0}}, coupler, {{-0.5, 0.0, 0.0}}));
    s.joints.push_back(make_joint("B" + name + " right", hinge, crank, {{0.0, 0.5, 0.0}}, coupler, {{0.5, 0.0, 0.0}}));
  }
  scene::Sensor corner = make_point_sensor("B0", scene::SensorKind::position, "crank 0");
  corner.at.offset.x = {{0.0, 0.5, 0.0}};
  s.sensors = {corner};
  s.analysis.spectral_radius = 0.9;
  return s;
}

void scale_masses(scene::Scene& s, double factor) {
  for (scene::Body& b : s.bodies) {
    b.mass *= factor;
    b.inertia = factor * b.inertia;
  }
  for (scene::Section& c : s.sections) {
    c.mass = factor * c.mass;
    c.stiffness = factor * c.stiffness;
    c.damping = factor * c.damping;
  }
  for (scene::Joint& j : s.joints)
    for (scene::JointForce& f : j.forces) {
      if (f.effort.node() != nullptr)
        throw std::invalid_argument("scale_masses: joint '" + j.name + "' has an effort by a law");
      f.stiffness *= factor;
      f.damping *= factor;
    }
}

void to_millimetres(scene::Scene& s) {
  const auto longer = [](Vec3& v) { v = 1e3 * v; };
  if (!s.couplings.empty() || !s.point_loads.empty() || !s.line_loads.empty() || !s.motions.empty() ||
      !s.frames.empty())
    throw std::invalid_argument("to_millimetres: couplings, loads, prescribed motions and frames are not handled");
  longer(s.gravity);
  for (scene::Node& n : s.nodes) longer(n.placement.pose.x);
  for (scene::Body& b : s.bodies) {
    longer(b.placement.pose.x);
    longer(b.center_of_mass);
    b.mass *= 1e-3;
    b.inertia = 1e3 * b.inertia;
  }
  for (scene::Section& c : s.sections)
    for (int i = 0; i < 6; ++i)
      for (int j = 0; j < 6; ++j) {
        const double lengths = (i < 3 ? 1.0 : 1e3) * (j < 3 ? 1.0 : 1e3);  // N, N mm, N mm^2
        c.stiffness(i, j) *= lengths;
        c.mass(i, j) *= 1e-6 * lengths;  // t/mm, t, t mm
      }
  for (scene::Joint& j : s.joints) {
    longer(j.first.offset.x);
    longer(j.second.offset.x);
    if (!j.forces.empty()) throw std::invalid_argument("to_millimetres: joint '" + j.name + "' has forces");
  }
  for (scene::InitialVelocity& v : s.initial_velocities) longer(v.velocity);
  for (scene::Sensor& q : s.sensors) longer(q.at.offset.x);
}

double column_factor(const scene::Scene& s, const std::string& column, double length, double force) {
  for (const scene::Sensor& q : s.sensors) {
    const std::vector<std::string> columns = columns_of(q);
    const auto at = std::find(columns.begin(), columns.end(), column);
    if (at == columns.end()) continue;
    const std::string unit = unit_of(q, static_cast<std::size_t>(at - columns.begin()));
    if (unit == "m" || unit == "m/s" || unit == "m/s^2") return length;
    if (unit == "1/m") return 1.0 / length;
    if (unit == "N") return force;
    if (unit == "N m" || unit == "J") return force * length;
  }
  return 1.0;
}

}  // namespace bough::scene
