#include "links.hpp"

#include <algorithm>

#include "bough/elements/catalogue.hpp"
#include "bough/laws/make_law.hpp"
#include "bough/scene/parts.hpp"

namespace lean {

using namespace bough;

namespace {

struct Links {
  int count = 8;
  bool in_plane = false;
  bool has_joints = true, has_springs = true, has_beams = true;
  bool is_damped = false;
  bool has_point_masses = false;
};

constexpr double length = 0.5;  // of a link [m]
constexpr int many = 80;        // links, whose sub-domains are equal: their elements are evaluated in lanes

scene::Attachment at(const std::string& name, double x, double y = 0.0, double z = 0.0) {
  scene::Attachment a;
  a.to = name;
  a.offset.x = {{x, y, z}};
  return a;
}

motion::Mat6<double> diagonal(double linear, double angular) {
  motion::Mat6<double> m = motion::Mat6<double>::zero();
  for (int i = 0; i < 6; ++i) m(i, i) = i < 3 ? linear : angular;
  return m;
}

std::string link_name(int k) { return "link" + std::to_string(k); }

void add_bodies(scene::Scene& s, const Links& l) {
  for (int k = 0; k < l.count; ++k) {
    scene::Body b;
    b.name = link_name(k);
    b.mass = 1.0;
    b.is_point_mass = l.has_point_masses;
    if (!l.has_point_masses)
      for (int i = 0; i < 3; ++i) b.inertia(i, i) = 0.02 + 0.01 * i;
    b.placement.pose.x = {{(k + 0.5) * length, 0.0, 0.0}};
    s.bodies.push_back(b);
  }
}

/// Links hang on each other by revolute joints with a spring about the axis, or by bushings; the first one on the
/// ground.
void add_couplings(scene::Scene& s, const Links& l) {
  for (int k = 0; k < l.count; ++k) {
    const scene::Attachment first = k == 0 ? at("", 0.0) : at(link_name(k - 1), 0.5 * length),
                            second = at(link_name(k), -0.5 * length);
    if (l.has_joints) {
      scene::Joint j;
      j.name = "hinge" + std::to_string(k);
      j.kind = scene::JointKind::revolute;
      j.first = first;
      j.second = second;
      scene::JointForce f;
      f.coordinate = "angle";
      f.stiffness = 20.0;
      f.damping = l.is_damped ? 0.1 : 0.0;
      j.forces.push_back(f);
      s.joints.push_back(j);
    } else {
      scene::Coupling b =
          scene::make_coupling(elements::kind_of<elements::Bushing>, "bush" + std::to_string(k), "", "");
      b.first = first;
      b.second = second;
      std::copy_n(diagonal(1e4, 50.0).m, 36, b.values.begin());
      if (l.is_damped) std::copy_n(diagonal(10.0, 0.1).m, 36, b.values.begin() + 36);
      s.couplings.push_back(b);
    }
  }
}

void add_springs(scene::Scene& s, const Links& l) {
  for (int k = 0; k < l.count; ++k) {
    s.couplings.push_back(scene::make_coupling(elements::kind_of<elements::Spring>, "spring" + std::to_string(k), "",
                                               link_name(k), {40.0, 0.9, l.is_damped ? 0.5 : 0.0}));
    s.couplings.back().first = at("", k * length, 1.0, l.in_plane ? 0.0 : 0.2);
    s.couplings.back().second = at(link_name(k), 0.0);
  }
}

/// A cantilever of each order on the last link.
void add_beams(scene::Scene& s, const Links& l) {
  scene::Section section;
  section.name = "bar";
  section.stiffness = diagonal(1e5, 20.0);
  section.mass = diagonal(0.3, 1e-5);
  section.damping = diagonal(l.is_damped ? 10.0 : 0.0, l.is_damped ? 2e-3 : 0.0);
  s.sections.push_back(section);
  const double end = l.count * length;
  for (int order = 1; order <= 2; ++order) {
    scene::Node tip;
    tip.name = "tip" + std::to_string(order);
    tip.placement.pose.x = {{end + 1.0, order == 1 ? 0.0 : 0.3, 0.0}};
    s.nodes.push_back(tip);
    scene::Beam b;
    b.name = "beam" + std::to_string(order);
    b.section = "bar";
    b.start = link_name(l.count - 1);
    b.end = tip.name;
    b.start_offset = motion::Vec3<double>{{0.5 * length, 0.0, 0.0}};
    b.elements = 2;
    b.order = order;
    s.beams.push_back(b);
  }
}

scene::Scene make_links(const Links& l) {
  scene::Scene s;
  s.gravity = {{0.0, -9.81, l.in_plane ? 0.0 : 0.5}};
  add_bodies(s, l);
  add_couplings(s, l);
  if (l.has_springs) add_springs(s, l);
  if (l.has_beams) add_beams(s, l);
  s.analysis.end_time = 1.0;
  s.analysis.step_size = 1e-3;
  s.output.checks = false;
  return s;
}

/// Beams from bead to bead; beads are point masses, or bodies that turn.
scene::Scene make_beads(bool are_points) {
  const Links l{.has_joints = false, .has_springs = false, .has_point_masses = are_points};
  scene::Scene s = make_links(l);
  s.couplings.clear();
  scene::Node root;
  root.name = "root";
  s.nodes.push_back(root);
  for (int k = 0; k < l.count; ++k) {
    scene::Beam b;
    b.name = "wire" + std::to_string(k);
    b.section = "bar";
    b.start = k == 0 ? "root" : link_name(k - 1);
    b.end = link_name(k);
    s.beams.push_back(b);
  }
  scene::Joint wall;
  wall.name = "wall";
  wall.second.to = "root";
  s.joints.push_back(wall);
  return s;
}

/// Point masses on springs between their origins: nothing turns.
scene::Scene make_net() {
  Links l{.has_joints = false, .has_beams = false, .has_point_masses = true};
  scene::Scene s = make_links(l);
  std::erase_if(s.couplings, [](const scene::Coupling& c) { return c.kind == &elements::kind_of<elements::Bushing>; });
  return s;
}

scene::Sensor sensor(const std::string& name, scene::SensorKind kind) {
  scene::Sensor r;
  r.name = name;
  r.kind = kind;
  return r;
}

void add_sensors(scene::Scene& s) {
  scene::Sensor place = sensor("place", scene::SensorKind::position);
  place.at.to = link_name(3);
  scene::Sensor force = sensor("force", scene::SensorKind::section_force);
  force.beam = "beam1";
  scene::Sensor reaction = sensor("reaction", scene::SensorKind::joint_reaction);
  reaction.joint = "hinge0";
  s.sensors = {place, force, reaction, sensor("energy", scene::SensorKind::total_energy)};
}

scene::Scene make_statics() {
  scene::Scene s = make_links({.count = 3, .has_joints = false});
  s.analysis.kind = scene::AnalysisKind::statics;
  s.analysis.load_steps = 100;
  return s;
}

}  // namespace

std::vector<scene::Scene> make_scenes() {
  std::vector<scene::Scene> r;
  const auto add = [&r](const std::string& name, scene::Scene s) {
    s.name = name;
    r.push_back(std::move(s));
  };
  const scene::Scene links = make_links({});
  const auto add_changed = [&](const std::string& name, auto change) {
    scene::Scene s = links;
    change(s);
    add(name, s);
  };
  add("links", links);
  add("damped", make_links({.is_damped = true}));
  add("bushings", make_links({.has_joints = false}));
  add("damped bushings", make_links({.has_joints = false, .is_damped = true}));
  add("many", make_links({.count = many}));
  add("many damped", make_links({.count = many, .is_damped = true}));
  add("planar", make_links({.in_plane = true}));
  add("planar damped", make_links({.in_plane = true, .is_damped = true}));
  add("planar bushings", make_links({.in_plane = true, .has_joints = false}));
  add("planar many", make_links({.count = many, .in_plane = true}));
  add("planar many damped", make_links({.count = many, .in_plane = true, .is_damped = true}));
  add("beads", make_beads(true));
  add("turning beads", make_beads(false));
  add("net", make_net());
  add("statics", make_statics());
  add_changed("sensors", [](scene::Scene& s) { add_sensors(s); });
  add_changed("pictures", [](scene::Scene& s) {
    s.output.motion = true;
    s.output.motion_stride = 1;  // else a picture of every hundredth part of the run
  });
  add_changed("checks", [](scene::Scene& s) { s.output.checks = true; });
  for (const bool are_rare : {true, false})
    add_changed(are_rare ? "rare rows" : "rows", [are_rare](scene::Scene& s) {
      s.output.checks = true;
      s.output.stride = are_rare ? 1000 : 1;
      add_sensors(s);
    });
  add_changed("signals", [](scene::Scene& s) {
    scene::Signal rate, drag;
    rate.name = "rate";
    rate.kind = scene::SignalKind::joint_rate;
    rate.joint = "hinge0";
    drag.name = "drag";
    drag.inputs = {"rate"};
    drag.formula = laws::Formula("-rate", drag.inputs);
    s.signals = {rate, drag};
    s.joints[0].forces.emplace_back();
    s.joints[0].forces.back().coordinate = "angle";
    s.joints[0].forces.back().signal = "drag";
  });
  add_changed("step control", [](scene::Scene& s) { s.analysis.step_control = scene::StepControl{.tolerance = 1e-2}; });
  add_changed("moving frame", [](scene::Scene& s) {
    scene::FrameDef f;
    f.name = "platform";
    f.motion.emplace();
    for (laws::Law& x : f.motion->position) x = laws::make_constant(0.0);
    f.motion->turns.push_back({motion::Vec3<double>::unit(2), laws::make_ramp(0.0, 10.0, 0.0, 10.0)});
    s.frames.push_back(f);
    s.analysis.frame = "platform";
  });
  add_changed("variational", [](scene::Scene& s) { s.analysis.integrator = scene::Integrator::variational; });
  return r;
}

}  // namespace lean
