#pragma once
/// Scenes with nodes that joints move as prescribed.
#include "same_motion.hpp"

namespace bough::test {

/// The first hinge of a chain turns by a law, with a damper of its own: a crank.
inline void drive_first_hinge(scene::Scene& s, const laws::Law& angle) {
  s.joints[0].drives.emplace_back();
  s.joints[0].drives[0].coordinate = "angle";
  s.joints[0].drives[0].law = angle;
  s.joints[0].forces.emplace_back();
  s.joints[0].forces[0].coordinate = "angle";
  s.joints[0].forces[0].stiffness = 3.0;
  s.joints[0].forces[0].damping = 0.5;
}

/// A node or body shaken along three axes and turned about one.
inline scene::PrescribedMotion shaker(const std::string& of) {
  scene::PrescribedMotion m;
  m.name = "shaker of " + of;
  m.at.to = of;
  for (int i = 0; i < 3; ++i) m.displacement[i] = laws::make_harmonic(0.01 + 0.01 * i, 9.0 + i);
  m.rotation_axis = motion::Vec3<double>{{0.6, 0.0, 0.8}};
  m.angle = laws::make_harmonic(0.2, 11.0);
  return m;
}

/// Three links, the first driven at its hinge; a block that is shaken carries an arm on a hinge, a spring, a rope to the links and a load; a block that
/// is clamped holds another rope to the shaken one.
inline scene::Scene varied(int order) {
  scene::Scene s = make_chain(3, order);
  s.without = {"planar"};
  drive_first_hinge(s, laws::make_harmonic(0.4, 6.0));
  s.bodies = {block("block", 0.0, 1.0, 0.0), block("arm", 0.5, 1.0, 0.2), block("stone", 0.0, 2.0, 0.0)};
  s.motions = {shaker("block")};
  s.joints.push_back(make_arm_hinge());
  scene::Joint wall;
  wall.name = "wall";
  wall.kind = scene::JointKind::fixed;
  wall.first.to = "stone";
  wall.second.offset.x = {{0.0, 2.0, 0.0}};
  s.joints.push_back(wall);
  for (const char* to : {"b1", "stone"}) {
    scene::Spring rope;
    rope.name = std::string("rope to ") + to;
    rope.first.to = "block";
    rope.second.to = to;
    rope.stiffness = 30.0;
    rope.damping = 2.0;
    rope.rest_length = 0.8;
    s.springs.push_back(rope);
  }
  scene::PointLoad load;
  load.name = "push";
  load.at.to = "block";
  load.axes = scene::LoadAxes::body;
  load.force = {{3.0, -4.0, 5.0}};
  load.moment = {{0.3, 0.2, 0.1}};
  s.point_loads.push_back(load);
  return s;
}

inline scene::Scene barred(scene::Scene s) {
  s.without.push_back("driven");
  return s;
}

}  // namespace bough::test
