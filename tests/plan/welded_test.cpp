/// Which nodes become one since fixed joints tie them to each other, what they are then, and what stands against it.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "../step/small_scenes.hpp"
#include "bough/elements/body.hpp"
#include "decision_of.hpp"
#include "support/given.hpp"

namespace bough::plan {
namespace {

using motion::Frame;
using motion::Vec3;
using scene::Scene;

const Decision& welded(const Plan& p) { return test::decision_of(p, "welded"); }

scene::Joint fixed(const std::string& name, const std::string& first, const std::string& second) {
  scene::Joint j;
  j.name = name;
  j.kind = scene::JointKind::fixed;
  j.first.to = first;
  j.second.to = second;
  return j;
}

scene::Body body(const std::string& name, const Vec3<double>& at) {
  scene::Body b;
  b.name = name;
  b.placement.pose.x = at;
  b.mass = 2.0;
  for (int i = 0; i < 3; ++i) b.inertia(i, i) = 0.1 * (3 + i);
  return b;
}

scene::Sensor reaction_of(const std::string& joint) {
  scene::Sensor s;
  s.name = "reaction of " + joint;
  s.kind = scene::SensorKind::joint_reaction;
  s.joint = joint;
  return s;
}

/// Three links one after the other, in space: a hinge to the ground, then two fixed joints; a lump below the end,
/// fixed to it.
Scene frame() {
  Scene s = test::make_chain(3);
  s.without = {"planar"};
  for (std::size_t l : {1u, 2u}) s.joints[l].kind = scene::JointKind::fixed;
  s.bodies.push_back(body("lump", {{3.0, 0.0, -0.5}}));
  s.joints.push_back(fixed("hold", "b2", "lump"));
  s.joints.back().first.offset.x = {{0.0, 0.0, -0.2}};
  s.joints.back().second.offset.x = {{0.0, 0.0, 0.3}};
  return s;
}

Plan plan_of(const std::function<void(Scene&)>& change = {}) {
  Scene s = frame();
  if (change) change(s);
  return make_plan(s);
}

std::size_t node_of(const Plan& p, const std::string& name) {
  for (std::size_t n = 0; n < p.nodes.size(); ++n)
    if (p.nodes[n].name == name) return n;
  throw std::runtime_error("no node '" + name + "'");
}

TEST(WeldedNodes, are_one_and_the_joints_between_them_none) {
  const Plan p = plan_of();
  EXPECT_TRUE(welded(p).taken);
  EXPECT_EQ(welded(p).reason,
            "'a1' becomes part of 'b0' and 2 more of this or others: 3 nodes and 3 fixed joints are left out");
  EXPECT_EQ(p.nodes.size(), 10u - 3u);
  ASSERT_EQ(p.joints.size(), 1u);
  EXPECT_EQ(p.joints[0].name, "hinge0");
  EXPECT_EQ(p.num_multipliers, 5);
  EXPECT_EQ(p.graph.num_blocks(), 7 + 1);
  ASSERT_EQ(p.beams.size(), 3u);
  EXPECT_EQ(p.beams[0].nodes.back(), p.beams[1].nodes.front());
  EXPECT_EQ(p.beams[1].nodes.back(), p.beams[2].nodes.front());
  for (const BeamPlan& beam : p.beams)
    for (int node : beam.nodes) EXPECT_LT(node, 7);
  for (const elements::Beam<2>& e : array_of<elements::Beam<2>>(p.elements))
    for (const elements::Port& port : e.ports) EXPECT_FALSE(port.has_offset);
  EXPECT_EQ(p.welds.size(), 3u);
}

TEST(WeldedNodes, are_none_where_the_decision_is_barred) {
  const Plan p = plan_of([](Scene& s) { s.without.push_back("welded"); });
  EXPECT_TRUE(welded(p).barred);
  EXPECT_EQ(p.nodes.size(), 10u);
  EXPECT_EQ(p.joints.size(), 4u);
  EXPECT_EQ(p.num_multipliers, 5 + 18);
  EXPECT_TRUE(p.welds.empty());
}

TEST(WeldedNodes, carry_bodies_and_what_takes_hold_of_them_at_offsets) {
  const Plan p = plan_of([](Scene& s) {
    scene::Sensor sensor;
    sensor.name = "lump";
    sensor.at.to = "lump";
    sensor.at.offset.x = {{0.1, 0.2, 0.3}};
    s.sensors.push_back(sensor);
    support::GivenSpring spring;
    spring.name = "rope";
    spring.second.to = "lump";
    spring.stiffness = 1.0;
    s.couplings.push_back(spring);
  });
  const auto tip = static_cast<int>(node_of(p, "b2"));
  ASSERT_EQ(p.sensors.size(), 1u);
  EXPECT_EQ(p.sensors[0].port.node, tip);
  EXPECT_NEAR(p.sensors[0].port.offset.x[0], 0.1, 1e-15);
  EXPECT_NEAR(p.sensors[0].port.offset.x[2], -0.2, 1e-15);
  const elements::Port& rope = array_of<elements::Spring>(p.elements)[0].ports[1];
  EXPECT_EQ(rope.node, tip);
  EXPECT_NEAR(rope.offset.x[2], -0.5, 1e-15);
  ASSERT_EQ(p.bodies.size(), 1u);
  EXPECT_EQ(p.bodies[0].name, "lump");
  EXPECT_EQ(p.bodies[0].frame.node, tip);
  EXPECT_NEAR(p.bodies[0].frame.offset.x[2], -0.5, 1e-15);
  ASSERT_EQ(p.bodies[0].attachments.size(), 2u);  // of the fixed joint and of the rope
  EXPECT_NEAR(p.bodies[0].attachments[0].offset.x[2], -0.2, 1e-15);
  EXPECT_NEAR(p.bodies[0].attachments[1].offset.x[2], -0.5, 1e-15);
  ASSERT_EQ(p.welds.size(), 3u);
  EXPECT_EQ(p.welds[2].name, "hold");
  EXPECT_NEAR(p.welds[2].first.offset.x[2], p.welds[2].second.offset.x[2], 1e-15);
}

/// About the first's frame: the mass matrix of both as make_mass_matrix has it, by the parallel axis theorem.
TEST(WeldedNodes, have_the_masses_of_all_bodies_in_one) {
  Scene s;
  s.analysis.end_time = 0.1;
  s.bodies = {body("a", {{1.0, 0.0, 0.0}}), body("b", {{1.0, 2.0, 0.0}})};
  const motion::Mat3<double> turned{{0, -1, 0, 1, 0, 0, 0, 0, 1}};  // about axis 3 by a right angle
  s.bodies[1].placement.pose.R = turned;
  s.bodies[1].mass = 6.0;
  s.bodies[1].center_of_mass = {{0.5, 0.0, 0.0}};
  s.joints = {fixed("both", "a", "b")};
  s.joints[0].first.offset = {turned, {{0.0, 2.0, 0.0}}};
  const Plan p = make_plan(s);
  ASSERT_TRUE(welded(p).taken) << welded(p).reason;
  const auto& bodies = array_of<elements::RigidBody>(p.elements);
  ASSERT_EQ(bodies.size(), 1u);
  EXPECT_FALSE(bodies[0].ports[0].has_offset);
  const Vec3<double> at_a{{0.0, 0.0, 0.0}}, at_b{{0.0, 2.5, 0.0}}, center{{0.0, 6.0 * 2.5 / 8.0, 0.0}};
  motion::Mat3<double> inertia = s.bodies[0].inertia + turned * s.bodies[1].inertia * lanes::transpose(turned);
  const auto add = [&](double mass, const Vec3<double>& r) {
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) inertia(i, j) += mass * ((i == j ? lanes::dot(r, r) : 0.0) - r[i] * r[j]);
  };
  add(2.0, at_a - center);
  add(6.0, at_b - center);
  const motion::Mat6<double> expected = elements::make_mass_matrix(8.0, center, inertia);
  for (int i = 0; i < 36; ++i) EXPECT_NEAR(bodies[0].mass.m[i], expected.m[i], 1e-14) << i;
}

/// Elements of it keep their ports as they are.
TEST(WeldedNodes, take_the_place_of_the_one_where_most_elements_meet) {
  const Plan p = plan_of([](Scene& s) {
    for (int k = 0; k < 3; ++k) {
      support::GivenSpring spring;
      spring.name = "rope" + std::to_string(k);
      spring.second.to = "lump";
      s.couplings.push_back(spring);
    }
  });
  EXPECT_EQ(p.bodies[0].frame.node, static_cast<int>(node_of(p, "lump")));
  EXPECT_FALSE(p.bodies[0].frame.has_offset);
  EXPECT_NEAR(array_of<elements::Beam<2>>(p.elements).back().ports[1].offset.x[2], 0.5, 1e-15);
}

TEST(WeldedNodes, leave_no_joint_of_a_loop_that_closes) {
  const Plan p = plan_of([](Scene& s) {
    s.bodies.push_back(body("knob", {{3.0, 0.4, 0.0}}));
    s.joints.push_back(fixed("second", "b2", "knob"));
    s.joints.back().first.offset.x = {{0.0, 0.4, 0.0}};
    s.joints.push_back(fixed("third", "lump", "knob"));
    s.joints.back().first.offset.x = {{0.0, 0.4, 0.5}};
  });
  EXPECT_EQ(p.joints.size(), 1u);
  EXPECT_EQ(p.nodes.size(), 7u);
  EXPECT_EQ(welded(p).reason,
            "'a1' becomes part of 'b0' and 3 more of this or others: 4 nodes and 5 fixed joints are left out");
}

TEST(WeldedNodes, stay_in_the_plane_and_may_be_symmetric_about_it_together) {
  const Plan one = plan_of([](Scene& s) { s.without.clear(); });
  EXPECT_TRUE(one.took("planar")) << test::decision_of(one, "planar").reason;
  EXPECT_TRUE(welded(one).taken);
  const auto off_plane = [](Scene& s, double y) {
    s.without.clear();
    s.bodies[0].placement.pose.x[1] = y;
    s.joints.back().second.offset.x[1] = -y;
  };
  const Plan two = plan_of([&](Scene& s) { off_plane(s, 0.3); });
  EXPECT_FALSE(two.took("planar"));
  const Plan pair = plan_of([&](Scene& s) {
    off_plane(s, 0.3);
    s.bodies.push_back(body("mirrored", {{3.0, -0.3, -0.5}}));
    s.joints.push_back(s.joints.back());
    s.joints.back().name = "mirrored hold";
    s.joints.back().second.to = "mirrored";
    s.joints.back().second.offset.x[1] = 0.3;
  });
  EXPECT_TRUE(pair.took("planar")) << test::decision_of(pair, "planar").reason;
}

/// Beams lie on a line: their plane is that of the lump, which has no node.
TEST(WeldedNodes, stay_in_an_oblique_plane_that_only_their_offsets_tell) {
  const auto oblique = [](Scene& s) {
    s.without.clear();
    s.joints.erase(s.joints.begin());
    const motion::Mat3<double> axes{{0, 1, 0, -0.8, 0, 0.6, 0.6, 0, 0.8}};  // the first along the normal
    for (scene::Joint& j : s.joints) j.first.offset = j.second.offset = {axes, Vec3<double>::zero()};
    s.joints.back().first.offset.x = {{0.0, 0.3, 0.4}};
    s.gravity = {{0.0, -6.0, -8.0}};
    s.bodies[0].placement.pose.x = {{3.0, 0.3, 0.4}};
    for (int i = 0; i < 3; ++i) s.bodies[0].inertia(i, i) = 0.1;
  };
  const Plan without = plan_of([&](Scene& s) {
    oblique(s);
    s.without = {"welded"};
  });
  EXPECT_TRUE(without.took("planar")) << test::decision_of(without, "planar").reason;
  const Plan p = plan_of(oblique);
  EXPECT_TRUE(welded(p).taken);
  EXPECT_TRUE(p.took("planar")) << test::decision_of(p, "planar").reason;
}

TEST(WeldedNodes, are_held_where_one_of_them_is) {
  const Plan p = plan_of([](Scene& s) {
    scene::Joint clamp = test::joint_to_ground(scene::JointKind::fixed, "lump");
    clamp.first.offset.x = {{3.0, 0.0, -0.5}};
    s.joints[0] = clamp;
  });
  ASSERT_EQ(p.held.size(), 1u) << test::decision_of(p, "held").reason;
  EXPECT_EQ(p.held[0].node, static_cast<int>(node_of(p, "b2")));
  const std::string note =
      "'lump' cannot move: it is fixed to the ground; beams and joints may take hold of the ground itself";
  EXPECT_NE(std::find(p.notes.begin(), p.notes.end(), note), p.notes.end());
}

TEST(WeldedNodes, start_with_their_common_motion) {
  const Plan p = plan_of([](Scene& s) {
    s.joints.erase(s.joints.begin());
    const auto spin = [&s](const char* of, double x, double z) {
      s.initial_velocities.emplace_back();
      scene::InitialVelocity& v = s.initial_velocities.back();
      v.of = of;
      v.angular_velocity = {{0.3, -0.2, 0.7}};
      v.velocity = lanes::cross(v.angular_velocity, Vec3<double>{{x, 0.0, z}});
    };
    spin("link0", 0.0, 0.0);
    spin("link1", 1.0, 0.0);
    spin("link2", 2.0, 0.0);
    spin("lump", 3.0, -0.5);
  });
  EXPECT_EQ(p.nodes.size(), 7u) << welded(p).reason;
  const NodePlan& tip = p.nodes[node_of(p, "b2")];
  EXPECT_NEAR(tip.twist[1], 3.0 * 0.7, 1e-15);
}

std::string reason(const std::function<void(Scene&)>& change) {
  const Plan p = plan_of([&](Scene& s) {
    for (std::size_t l : {1u, 2u}) s.joints[l].kind = scene::JointKind::revolute;
    change(s);
  });
  EXPECT_FALSE(welded(p).taken);
  EXPECT_EQ(p.joints.size(), plan_of([&](Scene& s) {
                               for (std::size_t l : {1u, 2u}) s.joints[l].kind = scene::JointKind::revolute;
                               change(s);
                               s.without.push_back("welded");
                             }).joints.size());
  return welded(p).reason;
}

TEST(WeldedNodes, are_not_taken_with_a_reason_where_the_joint_matters) {
  EXPECT_EQ(reason([](Scene& s) { s.joints.pop_back(); }), "no fixed joint ties nodes to each other");
  EXPECT_EQ(reason([](Scene& s) {
              s.joints.back() = test::joint_to_ground(scene::JointKind::fixed, "lump");
              s.joints.back().first.offset.x = {{3.0, 0.0, -0.5}};
            }),
            "no fixed joint ties nodes to each other");
  EXPECT_EQ(reason([](Scene& s) { s.sensors.push_back(reaction_of("hold")); }),
            "joint 'hold': its reaction is asked for");
  EXPECT_EQ(reason([](Scene& s) { s.joints.back().first.offset.x[1] = 1e-9; }),
            "joint 'hold': its two sides do not start where it joins them");
  EXPECT_EQ(reason([](Scene& s) {
              s.initial_velocities.emplace_back();
              s.initial_velocities.back().of = "lump";
              s.initial_velocities.back().velocity = {{0.0, 1e-6, 0.0}};
            }),
            "joint 'hold': its two sides do not start with one motion");
  EXPECT_EQ(reason([](Scene& s) {
              support::GivenSpring spring;
              spring.name = "rope";
              spring.first.to = "b2";
              spring.second.to = "lump";
              s.couplings.push_back(spring);
            }),
            "the part of 'b2': 'rope' would have both ends at one node");
  EXPECT_EQ(reason([](Scene& s) { s.analysis.step_control = scene::StepControl{}; }),
            "joint 'hold': steps are controlled by the error of every node");
  EXPECT_EQ(reason([](Scene& s) { s.analysis.newton = scene::Newton::single; }),
            "joint 'hold': one solution a step keeps errors of a prediction that is chosen by all nodes");
  EXPECT_EQ(reason([](Scene& s) {
              s.analysis.kind = scene::AnalysisKind::statics;
              s.analysis.arc_length = scene::ArcLength{};
            }),
            "joint 'hold': lengths along the path of equilibria are means over the nodes");
}

TEST(WeldedNodes, are_not_taken_where_a_loop_of_joints_shares_a_load_that_is_asked_for) {
  const auto looped = [](Scene& s) {
    s.joints.push_back(test::joint_to_ground(scene::JointKind::spherical, "lump"));
    s.joints.back().first.offset.x = {{3.0, 0.0, -0.5}};
    s.joints.push_back(test::joint_to_ground(scene::JointKind::spherical, "b2"));
    s.joints.back().first.offset.x = {{3.0, 0.0, 0.0}};
  };
  EXPECT_EQ(reason([&](Scene& s) {
              looped(s);
              s.sensors.push_back(reaction_of("to ground of b2"));
            }),
            "joint 'hold': it is in a loop with 'to ground of b2', whose reaction is asked for: rows may share a load");
  EXPECT_TRUE(welded(plan_of(looped)).taken);  // nobody asks
  EXPECT_TRUE(welded(plan_of([&](Scene& s) {
                looped(s);
                s.sensors.push_back(reaction_of("hinge0"));  // beams lie between
              })).taken);
}

TEST(WeldedNodes, beside_such_a_loop_are_taken) {
  const Plan p = plan_of([](Scene& s) {
    for (std::size_t l : {1u, 2u}) s.joints[l].kind = scene::JointKind::revolute;
    for (const char* node : {"lump", "b2"}) {
      s.joints.push_back(test::joint_to_ground(scene::JointKind::spherical, node));
      s.joints.back().first.offset.x = {{3.0, 0.0, node[0] == 'l' ? -0.5 : 0.0}};
    }
    s.bodies.push_back(body("knob", {{3.0, 0.4, -0.5}}));
    s.joints.push_back(fixed("stud", "lump", "knob"));
    s.joints.back().first.offset.x = {{0.0, 0.4, 0.0}};
    s.sensors.push_back(reaction_of("to ground of b2"));
  });
  EXPECT_EQ(
      welded(p).reason,
      "'knob' becomes part of 'lump': 1 node and 1 fixed joint are left out; not joint 'hold': it is in a loop with "
      "'to ground of b2', whose reaction is asked for: rows may share a load");
}

/// A loop that does not close is that of its joints' rows alone; a part beside it is taken all the same.
TEST(WeldedNodes, leave_a_loop_that_does_not_close_as_it_is) {
  const Plan p = plan_of([](Scene& s) {
    s.joints.push_back(s.joints.back());
    s.joints.back().name = "again";
    s.joints.back().first.offset.x[0] = 1e-8;
  });
  EXPECT_EQ(p.joints.size(), 3u);
  EXPECT_EQ(p.nodes.size(), 10u - 2u);
  EXPECT_EQ(
      welded(p).reason,
      "'a1' becomes part of 'b0' and 1 more of this or others: 2 nodes and 2 fixed joints are left out; not joint "
      "'again': its two sides do not start where it joins them");
}

TEST(WeldedNodes, at_one_place_turn_no_more_than_one_alone) {
  Scene s;
  s.analysis.end_time = 0.1;
  s.bodies = {body("a", {{1.0, 0.0, 0.0}}), body("b", {{1.0, 0.0, 0.0}})};
  s.joints = {fixed("both", "a", "b")};
  support::GivenSpring spring;
  spring.name = "rope";
  spring.second.to = "b";
  spring.stiffness = 1.0;
  s.couplings.push_back(spring);
  s.without = {"line"};
  const Plan p = make_plan(s);
  EXPECT_TRUE(p.took("translation")) << test::decision_of(p, "translation").reason;
}

}  // namespace
}  // namespace bough::plan
