/// Which scenes have matrices that are expected to be positive definite, and what stands against it.
#include <gtest/gtest.h>

#include "../step/lattice_scene.hpp"
#include "decision_of.hpp"

namespace bough::plan {
namespace {

using test::joint_to_ground;
using test::make_lattice;

const Decision decide(const scene::Scene& s) { return test::decision_of(make_plan(s), "definite"); }

TEST(Definite, IsTakenInDynamicsWhereAllNodesHaveMass) {
  const Decision d = decide(make_lattice(scene::AnalysisKind::dynamics));
  EXPECT_TRUE(d.taken);
  EXPECT_TRUE(d.can_be_barred);
  EXPECT_EQ(d.reason, "every node has mass, and there are no constraint rows");
}

TEST(Definite, IsNotWhereANodeHasNone) {
  scene::Scene s = make_lattice(scene::AnalysisKind::dynamics);
  scene::Section light = s.sections.front();
  light.name = "light";
  light.mass = motion::Mat6<double>::zero();
  s.sections.push_back(light);
  for (scene::Beam& b : s.beams)
    if (b.start == "0,0") b.section = "light";
  const Decision d = decide(s);
  EXPECT_FALSE(d.taken);
  EXPECT_EQ(d.reason, "'0,0' has no mass");
}

TEST(Definite, IsTakenInStaticsWhereSomethingSupportsTheStructure) {
  scene::Scene s = make_lattice(scene::AnalysisKind::statics);
  EXPECT_EQ(decide(s).reason, "no node is held and no spring leads to the ground");
  scene::Spring spring;
  spring.name = "support";
  spring.second.to = "0,0";
  spring.first.offset.x = {{0.0, 0.0, -1.0}};
  spring.stiffness = 10.0;
  s.springs.push_back(spring);
  EXPECT_TRUE(decide(s).taken);
  s = make_lattice(scene::AnalysisKind::statics);
  s.joints.push_back(joint_to_ground(scene::JointKind::fixed, "0,0"));
  const Decision d = decide(s);
  EXPECT_TRUE(d.taken);
  EXPECT_EQ(d.reason, "the structure is supported, and there are no constraint rows");
}

TEST(Definite, IsNotWhereJointsHaveMultipliers) {
  scene::Scene s = make_lattice(scene::AnalysisKind::dynamics);
  s.joints.push_back(joint_to_ground(scene::JointKind::spherical, "0,0"));
  const Decision d = decide(s);
  EXPECT_FALSE(d.taken);
  EXPECT_EQ(d.reason, "joints have multipliers: 3 constraint rows");
}

TEST(Definite, IsNotWhereSymmetricPartsAreNotTaken) {
  scene::Scene s = make_lattice(scene::AnalysisKind::dynamics);
  s.without.push_back("symmetric");
  const Decision d = decide(s);
  EXPECT_FALSE(d.taken);
  EXPECT_EQ(d.reason, "tangents are not taken as symmetric");
}

}  // namespace
}  // namespace bough::plan
