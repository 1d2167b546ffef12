/// Which nodes are eliminated before the linear solver since joints prescribe their motion, and what stands against it.
#include <gtest/gtest.h>

#include <functional>

#include "../step/small_scenes.hpp"
#include "bough/plan/plan.hpp"
#include "bough/plan/small_inverse.hpp"
#include "decision_of.hpp"

namespace bough::plan {
namespace {

using test::joint_to_ground;

const Decision& driven(const Plan& p) { return test::decision_of(p, "driven"); }

void turn_first_hinge(scene::Scene& s) {
  s.joints[0].drives.emplace_back();
  s.joints[0].drives[0].coordinate = "angle";
  s.joints[0].drives[0].law = laws::make_ramp(0.0, 1.0, 0.0, 0.1);
}

/// Three links one after the other, the first turned by a law, in space.
Plan plan_of(const std::function<void(scene::Scene&)>& change) {
  scene::Scene s = test::make_chain(3);
  s.without = {"planar"};
  turn_first_hinge(s);
  change(s);
  return make_plan(s);
}

TEST(DrivenNodes, stand_beyond_the_graph_with_the_joints_that_move_them) {
  const Plan p = plan_of([](scene::Scene&) {});
  EXPECT_TRUE(driven(p).taken);
  EXPECT_EQ(driven(p).reason, "'a0' moves as prescribed: 6 unknowns and 6 rows of joints are eliminated beforehand");
  EXPECT_TRUE(p.held.empty());
  ASSERT_EQ(p.driven.size(), 1u);
  EXPECT_EQ(p.nodes[static_cast<std::size_t>(p.driven[0].node)].name, "a0");
  EXPECT_EQ(p.driven[0].joints, (std::vector<int>{0}));
  EXPECT_EQ(p.graph.num_blocks(), 8 + 2);
  EXPECT_EQ(p.block_of_node[static_cast<std::size_t>(p.driven[0].node)], 10);
  EXPECT_EQ(p.joints[0].block, 11);
  EXPECT_EQ(p.num_multipliers, 6 + 5 + 5);
  for (int block : p.graph.element_blocks) EXPECT_LT(block, 10);
}

TEST(DrivenNodes, are_none_where_the_decision_is_barred) {
  const Plan p = plan_of([](scene::Scene& s) { s.without.push_back("driven"); });
  EXPECT_TRUE(driven(p).barred);
  EXPECT_TRUE(p.driven.empty());
  EXPECT_EQ(p.graph.num_blocks(), 9 + 3);
}

TEST(DrivenNodes, are_those_of_a_plane_by_three_rows) {
  const Plan p = plan_of([](scene::Scene& s) { s.without.clear(); });
  ASSERT_TRUE(p.took("planar"));
  EXPECT_EQ(driven(p).reason, "'a0' moves as prescribed: 3 unknowns and 3 rows of joints are eliminated beforehand");
}

TEST(DrivenNodes, may_be_moved_by_several_joints_that_add_up_and_that_have_springs) {
  const Plan p = plan_of([](scene::Scene& s) {
    s.joints[0].forces.emplace_back();
    s.joints[0].forces[0].stiffness = 2.0;
    s.joints[1].kind = scene::JointKind::spherical;  // b0 - a1
    scene::PrescribedMotion m;
    m.name = "shaker";
    m.at.to = "b2";
    for (auto& law : m.displacement) law = laws::make_harmonic(0.1, 3.0);
    m.hold_rotation = true;
    s.motions.push_back(m);
    s.joints.pop_back();  // b1 - a2: two chains
  });
  EXPECT_EQ(driven(p).reason,
            "'a0' and 1 more move as prescribed: 12 unknowns and 12 rows of joints are eliminated beforehand");
  ASSERT_EQ(p.driven.size(), 2u);
  EXPECT_EQ(p.driven[1].joints.size(), 2u);
}

TEST(DrivenNodes, are_those_on_a_frame_that_moves) {
  const Plan p = plan_of([](scene::Scene& s) {
    s.frames.push_back(test::make_turntable({{0.0, 0.0, 1.0}}));
    s.joints[0].kind = scene::JointKind::fixed;
    s.joints[0].drives.clear();
    s.joints[0].first.to = "table";
  });
  EXPECT_EQ(p.driven.size(), 1u) << driven(p).reason;
}

/// Those at rest are held, barred or not; those that have to move there first are driven there.
TEST(DrivenNodes, are_not_those_that_rest) {
  const auto clamp = [](scene::Scene& s) {
    s.joints[0].kind = scene::JointKind::fixed;
    s.joints[0].drives.clear();
  };
  const std::string none = "no motion is prescribed for a node on all sides";
  EXPECT_EQ(driven(plan_of(clamp)).reason, none);
  EXPECT_EQ(driven(plan_of([&](scene::Scene& s) {
              clamp(s);
              s.without.push_back("held");
            })).reason,
            none);
  EXPECT_EQ(plan_of([&](scene::Scene& s) {
              clamp(s);
              s.joints[0].first.offset.x[1] = 1e-9;
            }).driven.size(),
            1u);
}

std::string reason(const std::function<void(scene::Scene&)>& change) {
  const Plan p = plan_of(change);
  EXPECT_FALSE(driven(p).taken);
  EXPECT_TRUE(p.driven.empty());
  return driven(p).reason;
}

TEST(DrivenNodes, are_not_taken_with_a_reason_where_more_has_to_be_known) {
  using scene::Scene;
  EXPECT_EQ(reason([](Scene& s) { s.joints[0].drives.clear(); }), "no motion is prescribed for a node on all sides");
  EXPECT_EQ(reason([](Scene& s) { s.joints.push_back(joint_to_ground(scene::JointKind::spherical, "a0")); }),
            "'a0': it is held more than once");
  EXPECT_EQ(reason([](Scene& s) {
              scene::Joint j = joint_to_ground(scene::JointKind::spherical, "b1");
              j.first.to = "a0";
              s.joints.push_back(j);
              s.joints.push_back(joint_to_ground(scene::JointKind::planar, "a2"));
            }),
            "'a0': another chain of joints leads from it to the ground: their rows may depend on each other");
  EXPECT_EQ(reason([](Scene& s) {  // six rows, but one direction is held twice and one not at all
              s.joints[0].kind = scene::JointKind::planar;
              scene::PrescribedMotion m;
              m.name = "slides";
              m.at.to = "a0";
              m.displacement[0] = m.displacement[1] = laws::make_constant(0.0);  // 1: as the joint does
              s.motions.push_back(m);
            }),
            "'a0': its joints do not hold it on all sides");
  EXPECT_EQ(reason([](Scene& s) {
              s.joints.resize(1);
              s.beams.clear();
              s.nodes.resize(1);
            }),
            "nothing would be left");
}

TEST(InvertSmall, inverts_or_leaves_alone) {
  double a[9] = {0.0, 2e-5, 0.0, 4e3, 0.0, 1e3, 0.0, 0.0, 0.5};
  ASSERT_TRUE(invert_small(a, 3, 1e-6));
  const double expected[9] = {0.0, 2.5e-4, -0.5, 5e4, 0.0, 0.0, 0.0, 0.0, 2.0};
  for (int i = 0; i < 9; ++i) EXPECT_NEAR(a[i], expected[i], 1e-15 * 5e4);
  double b[4] = {1.0, 2.0, 1.0, 2.0 + 1e-9};
  EXPECT_FALSE(invert_small(b, 2, 1e-6));
  EXPECT_EQ(b[3], 2.0 + 1e-9);
  double c[4] = {1.0, 2.0, 0.0, 0.0};
  EXPECT_FALSE(invert_small(c, 2, 1e-6));
}

}  // namespace
}  // namespace bough::plan
