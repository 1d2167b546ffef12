#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "bough/solve/reference/sparse_oracle.hpp"
#include "small_scenes.hpp"
#include "support/given.hpp"
#include "support/rig.hpp"

namespace bough::step {
namespace {

using test::Rig;

TEST(MakeConsistent, closes_positions_velocities_and_accelerations) {
  scene::Scene s = test::make_chain(3);
  s.nodes[2].placement.pose.x[2] += 1e-3;  // a gap in the second hinge
  scene::InitialVelocity v;
  v.of = "b2";
  v.velocity = {{0.0, 0.0, 1.0}};
  s.initial_velocities.push_back(v);
  Rig rig(s);
  const StartReport report = make_consistent(rig.system, rig.state, true, 1e-3);
  ASSERT_TRUE(report.ok) << report.cause;
  EXPECT_GT(report.position_correction, 1e-5);
  EXPECT_LT(rig.system.constraints().violation(rig.state, 0), 1e-13);
  EXPECT_LT(rig.system.constraints().violation(rig.state, 1), 1e-12);
  double largest = 0.0;  // 1e9 rad/s^2: what closes the gap has bent the bars, which are let go
  for (const elements::NodeMotion& n : rig.nodes())
    for (int i = 0; i < 6; ++i) largest = std::max(largest, std::abs(n.a[i]));
  EXPECT_LT(rig.system.constraints().violation(rig.state, 2), std::numeric_limits<double>::epsilon() * largest);
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
  ASSERT_TRUE(make_consistent(rig.system, rig.state, true, 1e-3).ok);
  for (double a : {rig.nodes()[0].a[0], rig.nodes()[0].a[2]}) EXPECT_NEAR(a, 0.0, 1e-13);
  EXPECT_NEAR(std::abs(rig.state.multipliers[2]), 20.0, 1e-12);
}

TEST(MakeConsistent, refuses_a_part_without_inertia_by_name) {
  scene::Scene s;
  s.gravity = {{0.0, 0.0, -10.0}};
  scene::Node n;
  n.name = "ghost";
  s.nodes.push_back(n);
  support::GivenSpring spring;
  spring.name = "line";
  spring.second.to = "ghost";
  spring.first.offset.x = {{1.0, 0.0, 0.0}};
  spring.stiffness = 1.0;
  s.couplings.push_back(spring);
  Rig rig(s);
  const StartReport report = make_consistent(rig.system, rig.state, true, 1e-3);
  EXPECT_FALSE(report.ok);
  EXPECT_NE(report.cause.find("ghost"), std::string::npos) << report.cause;
  EXPECT_NE(report.cause.find("needs inertia"), std::string::npos) << report.cause;
}

/// A solver that is missing has nothing to do with inertia.
TEST(MakeConsistent, a_library_that_is_not_part_of_the_build_is_named_alone) {
  if (solve::SparseOracle::available(solve::Library::umfpack)) GTEST_SKIP() << "this build has UMFPACK";
  scene::Scene s = test::make_chain(2);
  s.solver.form = scene::SolverForm::monolithic;
  s.solver.library = scene::SolverLibrary::umfpack;
  Rig rig(s);
  const StartReport report = make_consistent(rig.system, rig.state, true, 1e-3);
  EXPECT_FALSE(report.ok);
  EXPECT_NE(report.cause.find("UMFPACK"), std::string::npos) << report.cause;
  EXPECT_EQ(report.cause.find("inertia"), std::string::npos) << report.cause;
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
    j.drives.push_back({"angle", true, laws::make_constant(rate), ""});
    s.joints.push_back(j);
  }
  Rig rig(s);
  const StartReport report = make_consistent(rig.system, rig.state, true, 1e-3);
  EXPECT_FALSE(report.ok);
  EXPECT_TRUE(report.cause.find("slow") != std::string::npos && report.cause.find("fast") != std::string::npos)
      << report.cause;
}

/// The chain in another unit of length; masses with it, so that forces stay.
void rescale(scene::Scene& s, double length) {
  s.gravity = length * s.gravity;
  for (scene::Node& n : s.nodes) n.placement.pose.x = length * n.placement.pose.x;
  for (scene::Section& c : s.sections)
    for (int i = 0; i < 6; ++i)
      for (int j = 0; j < 6; ++j) {
        const double lengths = (i < 3 ? 1.0 : length) * (j < 3 ? 1.0 : length);
        c.stiffness(i, j) *= lengths;
        c.mass(i, j) *= lengths / (length * length);
      }
  for (scene::InitialVelocity& v : s.initial_velocities) v.velocity = length * v.velocity;
  for (scene::Joint& j : s.joints) {
    j.first.offset.x = length * j.first.offset.x;
    j.second.offset.x = length * j.second.offset.x;
  }
}

constexpr double units[] = {1e-3, 1.0, 1e3, 1e6};  // 1e3: metres and kilograms become millimetres and tonnes

TEST(MakeConsistent, starts_alike_in_metres_and_in_millimetres) {
  StartReport base;
  for (const double length : {1.0, 1e-3, 1e3, 1e6}) {
    scene::Scene s = test::make_chain(3);
    s.nodes[2].placement.pose.x[2] += 1e-3;
    scene::InitialVelocity v;
    v.of = "b2";
    v.velocity = {{0.0, 0.0, 1.0}};
    s.initial_velocities.push_back(v);
    rescale(s, length);
    Rig rig(s);
    const StartReport r = make_consistent(rig.system, rig.state, true, 1e-3);
    ASSERT_TRUE(r.ok) << r.cause;
    if (length == 1.0) base = r;
    EXPECT_NEAR(r.position_correction, base.position_correction, 1e-10 * base.position_correction) << length;
    EXPECT_NEAR(r.velocity_change, base.velocity_change, 1e-10) << length;
    EXPECT_LT(rig.system.constraints().violation(rig.state, 0), 1e-13 * length);
  }
}

TEST(MakeConsistent, refuses_a_gap_of_a_ten_millionth_of_the_size_in_any_unit) {
  for (const double length : units)
    for (const double gap : {1e-7, 1e-11}) {
      scene::Scene s = test::make_chain(1);
      scene::Joint other = s.joints[0];
      other.name = "other";
      other.first.offset.x[0] += gap;
      s.joints.push_back(other);
      rescale(s, length);
      Rig rig(s);
      const StartReport r = make_consistent(rig.system, rig.state, true, 1e-3);
      EXPECT_EQ(r.ok, gap < 1e-9) << length << ": " << r.cause;
      EXPECT_EQ(r.cause.find("cannot be closed") != std::string::npos, gap > 1e-9) << r.cause;
    }
}

TEST(MakeConsistent, refuses_rates_that_contradict_each_other_in_any_unit) {
  for (const double length : units)
    for (const double slip : {1e-6, 1e-11}) {
      scene::Scene s;
      scene::Body b;
      b.name = "slider";
      b.mass = 1.0;
      b.inertia = motion::Mat3<double>::identity();
      b.inertia = (length * length) * b.inertia;
      b.placement.pose.x = {{length, 0.0, 0.0}};
      s.bodies.push_back(b);
      for (const double rate : {1.0, 1.0 + slip}) {
        scene::Joint j;
        j.name = rate == 1.0 ? "slow" : "fast";
        j.kind = scene::JointKind::prismatic;
        j.first.offset.x = b.placement.pose.x;
        j.second.to = "slider";
        j.drives.push_back({"displacement", true, laws::make_constant(rate * length), ""});
        s.joints.push_back(j);
      }
      Rig rig(s);
      const StartReport r = make_consistent(rig.system, rig.state, true, 1e-3);
      EXPECT_EQ(r.ok, slip < 1e-8) << length << ": " << r.cause;
    }
}

}  // namespace
}  // namespace bough::step
