#include "scenes.hpp"

#include <cmath>
#include <string>

#include "bough/elements/catalogue.hpp"
#include "bough/scene/parts.hpp"

namespace bough::bench {

namespace {

constexpr double young = 2.1e11, poisson = 0.3, density = 7850.0, side = 0.02, pitch = 0.25;
constexpr double area = side * side, inertia = side * side * side * side / 12.0;
constexpr double shear = young / (2.0 * (1.0 + poisson));

scene::Section make_bar() {
  scene::Section s;
  s.name = "bar";
  s.stiffness = s.mass = s.damping = motion::Mat6<double>::zero();
  constexpr double shear_factor = 5.0 / 6.0, torsion = 0.1406 * side * side * side * side;  // of a square
  const double stiffness[6] = {
      young * area,   shear_factor * shear * area, shear_factor * shear * area, shear * torsion, young * inertia,
      young * inertia};
  const double mass[6] = {density * area,          density * area,    density * area,
                          2.0 * density * inertia, density * inertia, density * inertia};
  for (int i = 0; i < 6; ++i) {
    s.stiffness(i, i) = stiffness[i];
    s.mass(i, i) = mass[i];
  }
  return s;
}

scene::Scene make_base(const std::string& name) {
  scene::Scene s;
  s.name = name;
  s.gravity = {{0.0, 0.0, -9.81}};
  s.sections.push_back(make_bar());
  s.analysis.step_size = 1e-3;
  s.analysis.end_time = 1.0;
  return s;
}

void add_node(scene::Scene& s, const std::string& name, const scene::Vec3& x) {
  scene::Node node;
  node.name = name;
  node.placement.pose.x = x;
  s.nodes.push_back(node);
}

void add_beam(scene::Scene& s, const std::string& start, const std::string& end, int elements) {
  scene::Beam b;
  b.name = start + "-" + end;
  b.section = "bar";
  b.start = start;
  b.end = end;
  b.elements = elements;
  s.beams.push_back(b);
}

/// About as stiff as a bar of one pitch.
void add_spring(scene::Scene& s, const std::string& node, const scene::Vec3& x) {
  s.couplings.push_back(scene::make_coupling(elements::kind_of<elements::Bushing>, "support " + node, "", node));
  s.couplings.back().first.offset.x = x;
  for (std::size_t i = 0; i < 6; ++i)
    s.couplings.back().values[7 * i] = i < 3 ? young * area / pitch : young * inertia / pitch;
}

void add_clamp(scene::Scene& s, const std::string& node, const scene::Vec3& x) {
  scene::Joint j;
  j.name = "clamp " + node;
  j.kind = scene::JointKind::fixed;
  j.first.offset.x = x;
  j.second.to = node;
  s.joints.push_back(j);
}

/// Revolute joint about y from one frame (empty: the ground) to the next.
void add_hinge(scene::Scene& s, int link, const std::string& from, const scene::Vec3& from_at, const std::string& to,
               const scene::Vec3& to_at) {
  const scene::Mat3 axes{{1, 0, 0, 0, 0, 1, 0, -1, 0}};  // axis 3 along y
  scene::Joint j;
  j.name = "hinge" + std::to_string(link);
  j.kind = scene::JointKind::revolute;
  j.first = {from, {axes, from_at}};
  j.second = {to, {axes, to_at}};
  s.joints.push_back(j);
}

void add_position_sensor(scene::Scene& s, const std::string& of) {
  scene::Sensor sensor;
  sensor.name = "tip";
  sensor.at.to = of;
  s.sensors.push_back(sensor);
}

std::string name_at(int i, int j, int k = 0) {
  return std::to_string(i) + "," + std::to_string(j) + "," + std::to_string(k);
}

}  // namespace

scene::Scene make_chain(int links) {
  scene::Scene s = make_base("chain");
  const scene::Vec3 zero = scene::Vec3::zero();
  for (int l = 0; l < links; ++l) {
    const std::string n = std::to_string(l);
    add_node(s, "a" + n, {{static_cast<double>(l), 0.0, 0.0}});
    add_node(s, "b" + n, {{static_cast<double>(l + 1), 0.0, 0.0}});
    add_beam(s, "a" + n, "b" + n, 4);
    add_hinge(s, l, l == 0 ? "" : "b" + std::to_string(l - 1), zero, "a" + n, zero);
  }
  add_position_sensor(s, "b" + std::to_string(links - 1));
  return s;
}

scene::Scene make_rigid_chain(int links) {
  scene::Scene s = make_base("rigid_chain");
  for (int l = 0; l < links; ++l) {
    scene::Body b;
    b.name = "link" + std::to_string(l);
    b.placement.pose.x = {{l + 0.5, 0.0, 0.0}};
    b.mass = density * area;
    const double across = b.mass * (1.0 + side * side) / 12.0;
    b.inertia = {{2.0 * density * inertia, 0, 0, 0, across, 0, 0, 0, across}};
    s.bodies.push_back(b);
    const bool is_first = l == 0;
    add_hinge(s, l, is_first ? "" : "link" + std::to_string(l - 1), {{is_first ? 0.0 : 0.5, 0.0, 0.0}}, b.name,
              {{-0.5, 0.0, 0.0}});
  }
  add_position_sensor(s, "link" + std::to_string(links - 1));
  return s;
}

scene::Scene make_star(int arms, int nodes) {
  scene::Scene s = make_base("star");
  add_node(s, "hub", scene::Vec3::zero());
  add_spring(s, "hub", scene::Vec3::zero());
  const double length = pitch * nodes, golden = 2.399963229728653;  // golden angle [rad]: an even spread
  for (int arm = 0; arm < arms; ++arm) {
    const double z = 1.0 - (2.0 * arm + 1.0) / arms, r = std::sqrt(1.0 - z * z);
    const std::string tip = "tip" + std::to_string(arm);
    add_node(s, tip, {{length * r * std::cos(golden * arm), length * r * std::sin(golden * arm), length * z}});
    add_beam(s, "hub", tip, nodes);
  }
  return s;
}

scene::Scene make_lattice_2d(int n, Support support) {
  scene::Scene s = make_base("lattice");
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const scene::Vec3 x{{pitch * i, pitch * j, 0.0}};
      add_node(s, name_at(i, j), x);
      if (i == 0 && support == Support::clamp) add_clamp(s, name_at(i, j), x);
      if (i == 0 && support == Support::spring) add_spring(s, name_at(i, j), x);
      if (i > 0) add_beam(s, name_at(i - 1, j), name_at(i, j), 1);
      if (j > 0) add_beam(s, name_at(i, j - 1), name_at(i, j), 1);
    }
  add_position_sensor(s, name_at(n - 1, n - 1));
  return s;
}

scene::Scene make_lattice_3d(int n) {
  scene::Scene s = make_base("lattice");
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      for (int k = 0; k < n; ++k) {
        const scene::Vec3 x{{pitch * i, pitch * j, pitch * k}};
        add_node(s, name_at(i, j, k), x);
        if (i == 0) add_spring(s, name_at(i, j, k), x);
        if (i > 0) add_beam(s, name_at(i - 1, j, k), name_at(i, j, k), 1);
        if (j > 0) add_beam(s, name_at(i, j - 1, k), name_at(i, j, k), 1);
        if (k > 0) add_beam(s, name_at(i, j, k - 1), name_at(i, j, k), 1);
      }
  return s;
}

}  // namespace bough::bench
