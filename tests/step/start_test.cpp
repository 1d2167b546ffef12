#include <gtest/gtest.h>

#include <cmath>

#include "bough/schedule/serial.hpp"
#include "bough/step/advance.hpp"
#include "small_scenes.hpp"

namespace bough::step {
namespace {

struct Rig {
  scene::Scene scene;
  plan::Plan plan;
  System system;
  State state;
  explicit Rig(const scene::Scene& s)
      : scene(s),
        plan(plan::make_plan(scene)),
        system(plan, scene.solver, schedule::make_serial_walker()),
        state(make_initial_state(plan)) {}
};

TEST(MakeConsistent, closes_positions_velocities_and_accelerations) {
  scene::Scene s = test::make_chain(3);
  s.nodes[2].placement.pose.x[2] += 1e-3;  // a gap in the second hinge
  scene::InitialVelocity v;
  v.of = "b2";
  v.velocity = {{0.0, 0.0, 1.0}};
  s.initial_velocities.push_back(v);
  Rig rig(s);
  const StartReport report = make_consistent(rig.system, rig.state, true);
  ASSERT_TRUE(report.ok) << report.cause;
  EXPECT_GT(report.position_correction, 1e-5);
  EXPECT_LT(rig.system.constraint_violation(rig.state, 0), 1e-13);
  EXPECT_LT(rig.system.constraint_violation(rig.state, 1), 1e-12);
  EXPECT_LT(rig.system.constraint_violation(rig.state, 2), 1e-8);  // of accelerations near 1e3 m/s^2
}

TEST(MakeConsistent, gives_a_hanging_body_its_weight_as_reaction_at_once) {
  scene::Scene s;
  s.gravity = {{0.0, 0.0, -10.0}};
  scene::Body b;
  b.name = "weight";
  b.mass = 2.0;
  b.inertia = motion::Mat3<double>::identity();
  b.placement.pose.x = {{0.0, 0.0, -1.0}};
  s.bodies.push_back(b);
  scene::Joint j;
  j.name = "hook";
  j.kind = scene::JointKind::spherical;
  j.second.to = "weight";
  j.second.offset.x = {{0.0, 0.0, 1.0}};
  s.joints.push_back(j);
  Rig rig(s);
  ASSERT_TRUE(make_consistent(rig.system, rig.state, true).ok);
  for (double a : {rig.state.nodes[0].a[0], rig.state.nodes[0].a[2]}) EXPECT_NEAR(a, 0.0, 1e-13);
  EXPECT_NEAR(std::abs(rig.state.multipliers[2]), 20.0, 1e-12);
}

TEST(MakeConsistent, refuses_a_part_without_inertia_by_name) {
  scene::Scene s;
  s.gravity = {{0.0, 0.0, -10.0}};
  scene::Node n;
  n.name = "ghost";
  s.nodes.push_back(n);
  scene::Spring spring;
  spring.name = "line";
  spring.second.to = "ghost";
  spring.first.offset.x = {{1.0, 0.0, 0.0}};
  spring.stiffness = 1.0;
  s.springs.push_back(spring);
  Rig rig(s);
  const StartReport report = make_consistent(rig.system, rig.state, true);
  EXPECT_FALSE(report.ok);
  EXPECT_NE(report.cause.find("ghost"), std::string::npos) << report.cause;
}

TEST(MakeConsistent, refuses_contradicting_drives_by_name) {
  scene::Scene s;
  scene::Body b;
  b.name = "wheel";
  b.mass = 1.0;
  b.inertia = motion::Mat3<double>::identity();
  s.bodies.push_back(b);
  for (double rate : {1.0, 2.0}) {
    scene::Joint j;
    j.name = rate == 1.0 ? "slow" : "fast";
    j.kind = scene::JointKind::revolute;
    j.second.to = "wheel";
    j.drives.push_back({"angle", true, laws::make_constant(rate)});
    s.joints.push_back(j);
  }
  Rig rig(s);
  const StartReport report = make_consistent(rig.system, rig.state, true);
  EXPECT_FALSE(report.ok);
  EXPECT_TRUE(report.cause.find("slow") != std::string::npos && report.cause.find("fast") != std::string::npos)
      << report.cause;
}

}  // namespace
}  // namespace bough::step
