/// Which nodes need no unknowns since joints hold them at rest, and what stands against it.
#include <gtest/gtest.h>

#include <functional>

#include "../step/small_scenes.hpp"
#include "decision_of.hpp"

namespace bough::plan {
namespace {

using test::joint_to_ground;

const Decision& held(const Plan& p) { return test::decision_of(p, "held"); }

/// Three links one after the other, the first clamped, in space.
scene::Scene clamped() {
  scene::Scene s = test::make_chain(3);
  s.without = {"planar"};
  s.joints[0].kind = scene::JointKind::fixed;
  return s;
}

Plan plan_of(const std::function<void(scene::Scene&)>& change) {
  scene::Scene s = clamped();
  change(s);
  return make_plan(s);
}

TEST(HeldNodes, have_no_unknowns_and_their_joints_no_multipliers_in_the_system) {
  const Plan p = plan_of([](scene::Scene&) {});
  EXPECT_TRUE(held(p).taken);
  EXPECT_EQ(held(p).reason, "'a0' does not move: 6 unknowns and 6 rows of joints are left out");
  ASSERT_EQ(p.held.size(), 1u);
  EXPECT_EQ(p.nodes[static_cast<std::size_t>(p.held[0].node)].name, "a0");
  EXPECT_EQ(p.held[0].joints, (std::vector<int>{0}));
  EXPECT_EQ(p.joints[0].block, -1);
  EXPECT_EQ(p.joints[0].rows.size(), 6u);  // which multipliers are recovered
  EXPECT_EQ(p.num_multipliers, 6 + 5 + 5);
  EXPECT_EQ(p.graph.num_blocks(), 8 + 2);
  int next = 0;
  for (std::size_t n = 0; n < p.nodes.size(); ++n) EXPECT_EQ(p.block_of_node[n], p.nodes[n].name == "a0" ? -1 : next++);
}

TEST(HeldNodes, are_none_where_the_decision_is_barred) {
  const Plan p = plan_of([](scene::Scene& s) { s.without.push_back("held"); });
  EXPECT_TRUE(held(p).barred);
  EXPECT_TRUE(p.held.empty());
  EXPECT_EQ(p.graph.num_blocks(), 9 + 3);
  for (std::size_t n = 0; n < p.nodes.size(); ++n) EXPECT_EQ(p.block_of_node[n], static_cast<int>(n));
}

TEST(HeldNodes, are_those_of_a_plane_by_three_rows) {
  const Plan p = plan_of([](scene::Scene& s) { s.without.clear(); });
  ASSERT_TRUE(p.took("planar"));
  ASSERT_EQ(p.held.size(), 1u);
  EXPECT_EQ(p.held[0].inverse.size(), 9u);
  EXPECT_EQ(held(p).reason, "'a0' does not move: 3 unknowns and 3 rows of joints are left out");
}

/// The multipliers of the wrench that unit multipliers make are these: W^-1 W = 1.
TEST(HeldNodes, know_the_multipliers_of_a_wrench) {
  scene::Scene s = clamped();
  s.joints[0].first.offset.x = {{0.3, -0.2, 0.1}};  // beside the node, its axes turned
  s.joints[0].second.offset.x = {{0.3, -0.2, 0.1}};
  const Plan p = make_plan(s);
  ASSERT_EQ(p.held.size(), 1u);
  const elements::Joint& e = array_of<elements::Joint>(p.elements)[0];
  elements::NodeMotion node{};
  node.R = p.nodes[0].pose.R;
  node.x = motion::Vec3Pair::from(p.nodes[0].pose.x);
  elements::Field field;
  field.nodes = &node;
  field.around = {motion::Vec3<double>::zero(), nullptr, false};
  ASSERT_EQ(p.held[0].node, 0);
  for (std::size_t k = 0; k < 6; ++k) {
    double unit[6] = {}, residual[12];
    unit[k] = 1.0;
    elements::evaluate(e, field, unit, 0.0, residual, nullptr);
    for (std::size_t i = 0; i < 6; ++i) {
      double sum = 0.0;
      for (std::size_t c = 0; c < 6; ++c) sum += p.held[0].inverse[6 * i + c] * residual[c];
      EXPECT_NEAR(sum, i == k ? 1.0 : 0.0, 1e-15) << i << k;
    }
  }
}

TEST(HeldNodes, may_carry_joints_that_form_a_tree) {
  const Plan p = plan_of([](scene::Scene& s) {
    scene::Joint j = joint_to_ground(scene::JointKind::spherical, "b1");
    j.first.to = "a0";
    s.joints.push_back(j);
  });
  EXPECT_EQ(p.held.size(), 1u) << held(p).reason;
}

TEST(HeldNodes, may_be_held_by_several_joints_that_add_up) {
  const Plan p = plan_of([](scene::Scene& s) {
    s.joints[0].kind = scene::JointKind::spherical;
    scene::PrescribedMotion m;
    m.name = "no rotation";
    m.at.to = "a0";
    m.hold_rotation = true;
    s.motions.push_back(m);
  });
  ASSERT_EQ(p.held.size(), 1u) << held(p).reason;
  EXPECT_EQ(p.held[0].joints.size(), 2u);
}

TEST(HeldNodes, may_be_held_by_a_drive_that_stands_still) {
  const auto driven = [](double angle) {
    return plan_of([angle](scene::Scene& s) {
      s.joints[0].kind = scene::JointKind::revolute;
      s.joints[0].drives.emplace_back();
      s.joints[0].drives[0].coordinate = "angle";
      s.joints[0].drives[0].law = laws::make_constant(angle);
    });
  };
  EXPECT_EQ(driven(0.0).held.size(), 1u);
  EXPECT_EQ(held(driven(0.1)).reason, "'a0': it does not start where it is held");
}

std::string reason(const std::function<void(scene::Scene&)>& change) {
  const Plan p = plan_of(change);
  EXPECT_FALSE(held(p).taken);
  EXPECT_TRUE(p.held.empty());
  return held(p).reason;
}

TEST(HeldNodes, are_not_taken_with_a_reason_where_more_has_to_be_known) {
  using scene::Scene;
  EXPECT_EQ(reason([](Scene& s) { s.joints[0].kind = scene::JointKind::revolute; }),
            "no joint holds a node to the ground on all sides");
  EXPECT_EQ(reason([](Scene& s) { s.joints.push_back(joint_to_ground(scene::JointKind::spherical, "a0")); }),
            "'a0': it is held more than once");
  // a0 - beam - b0 - hinge - a1 is no way for rows; b0 - hinge - a1 - joint - ground is one, but not from a0.
  EXPECT_EQ(reason([](Scene& s) {
              scene::Joint j = joint_to_ground(scene::JointKind::spherical, "b1");
              j.first.to = "a0";
              s.joints.push_back(j);
              s.joints.push_back(joint_to_ground(scene::JointKind::planar, "a2"));
            }),
            "'a0': another chain of joints leads from it to the ground: their rows may depend on each other");
  EXPECT_EQ(reason([](Scene& s) {
              for (const char* from : {"a0", "a0", "b0"}) {
                scene::Joint j = joint_to_ground(scene::JointKind::spherical, "b1");
                j.first.to = from;
                s.joints.push_back(j);
              }
            }),
            "'a0': joints that it carries form a loop: their rows may depend on each other");
  EXPECT_EQ(reason([](Scene& s) {
              scene::InitialVelocity v;
              v.of = "a0";
              v.velocity = {{0.0, 1e-3, 0.0}};
              s.initial_velocities.push_back(v);
            }),
            "'a0': it starts moving");
  EXPECT_EQ(reason([](Scene& s) { s.joints[0].first.offset.x[1] = 1e-9; }), "'a0': it does not start where it is held");
  EXPECT_EQ(reason([](Scene& s) {
              s.joints[0].kind = scene::JointKind::revolute;
              s.joints[0].drives.emplace_back();
              s.joints[0].drives[0].coordinate = "angle";
              s.joints[0].drives[0].law = laws::make_ramp(0.0, 1.0, 0.0, 0.1);
            }),
            "'a0': a law moves it");
  EXPECT_EQ(reason([](Scene& s) {
              for (std::size_t l = 1; l < 3; ++l) s.joints[l].kind = scene::JointKind::fixed;
              for (auto& j : s.joints) j.first = {};
              s.beams.clear();
              s.nodes.erase(s.nodes.begin() + 5);
              s.nodes.erase(s.nodes.begin() + 3);
              s.nodes.erase(s.nodes.begin() + 1);
              for (std::size_t l = 0; l < 3; ++l) s.joints[l].first.offset.x = s.nodes[l].placement.pose.x;
            }),
            "nothing would be left");
}

TEST(HeldNodes, at_a_frame_that_moves_are_not_taken_and_in_the_observers_frame_are) {
  const auto on_table = [](scene::Scene& s) {
    s.frames.push_back(test::make_turntable({{0.0, 0.0, 1.0}}));
    s.joints[0].first.to = "table";
  };
  EXPECT_EQ(reason(on_table), "'a0': the frame it is fixed to moves");
  const Plan p = plan_of([&](scene::Scene& s) {
    on_table(s);
    s.analysis.frame = "table";
  });
  EXPECT_EQ(p.held.size(), 1u) << held(p).reason;
}

TEST(HeldNodes, next_to_others_that_cannot_be_taken) {
  const Plan p = plan_of([](scene::Scene& s) {
    s.joints.push_back(joint_to_ground(scene::JointKind::fixed, "b2"));
    s.joints.back().first.offset.x = {{3.0, 1e-6, 0.0}};
  });
  ASSERT_EQ(p.held.size(), 1u);
  EXPECT_EQ(held(p).reason,
            "'a0' does not move: 6 unknowns and 6 rows of joints are left out; not 'b2': it does not start where it is "
            "held");
}

}  // namespace
}  // namespace bough::plan
