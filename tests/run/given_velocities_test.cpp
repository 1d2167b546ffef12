/// Initial velocities that a scene gives against those that a run starts with: what is told, what is a doubt, and what
/// is neither.
#include <gtest/gtest.h>

#include "bough/laws/make_law.hpp"
#include "bough/run/memory_run.hpp"
#include "bough/scene/parts.hpp"

namespace bough::run {
namespace {

using scene::Vec3;

const records::Doubt* doubt_about_start(const MemoryRun& run) {
  for (const records::Doubt& d : run.summary.doubts)
    if (d.about == "initial velocities") return &d;
  return nullptr;
}

scene::Scene start_of_four_bars(int windows) {
  scene::Scene s = scene::make_four_bars(windows);
  s.analysis.step_size = 1e-3;
  s.analysis.end_time = 1e-3;
  return s;
}

TEST(GivenVelocities, a_crank_that_40_windows_hold_back_is_doubted_with_what_was_asked_and_what_it_got) {
  scene::Scene s = start_of_four_bars(40);
  s.initial_velocities.resize(1);
  const MemoryRun run = run_in_memory(s);
  ASSERT_TRUE(run.ok()) << run.text();
  ASSERT_EQ(run.summary.changed_velocities.size(), 2u) << "velocity and angular velocity";
  const records::ChangedVelocity &turn = run.summary.changed_velocities[0], &shift = run.summary.changed_velocities[1];
  EXPECT_TRUE(turn.is_angular != shift.is_angular);
  for (const records::ChangedVelocity& v : {turn, shift}) {
    EXPECT_EQ(v.of, s.initial_velocities[0].of);
    const std::size_t axis = v.is_angular ? 2 : 0;
    EXPECT_EQ(v.asked[axis], v.is_angular ? -1.0 : 0.5);
    EXPECT_GT(v.got[axis] / v.asked[axis], 0.001);
    EXPECT_LT(v.got[axis] / v.asked[axis], 0.05) << "one crank moves 81 bodies";
  }
  const records::Doubt* doubt = doubt_about_start(run);
  ASSERT_NE(doubt, nullptr);
  EXPECT_NE(doubt->text.find("'" + s.initial_velocities[0].of + "' was given (0.5, 0, 0) m/s"), std::string::npos)
      << doubt->text;
  EXPECT_TRUE(run.says("was given (0.5, 0, 0) m/s")) << run.text();
}

TEST(GivenVelocities, three_are_named_and_the_others_counted) {
  scene::Scene s = start_of_four_bars(2);
  for (scene::InitialVelocity& v : s.initial_velocities) v.velocity[0] *= 1.0 + v.velocity[0];
  const MemoryRun run = run_in_memory(s);
  ASSERT_TRUE(run.ok()) << run.text();
  const records::Doubt* doubt = doubt_about_start(run);
  ASSERT_NE(doubt, nullptr);
  EXPECT_GT(run.summary.changed_velocities.size(), 3u);
  EXPECT_NE(doubt->text.find("; and " + std::to_string(run.summary.changed_velocities.size() - 3) + " others"),
            std::string::npos)
      << doubt->text;
}

TEST(GivenVelocities, those_that_the_joints_allow_are_kept_and_nothing_is_told) {
  const MemoryRun run = run_in_memory(start_of_four_bars(2));
  ASSERT_TRUE(run.ok()) << run.text();
  EXPECT_TRUE(run.summary.changed_velocities.empty());
  EXPECT_FALSE(run.says("velocities")) << run.text();
}

/// A bar of 1/3 m in a direction that has no short digits: what its joint takes from its velocity is round-off.
TEST(GivenVelocities, round_off_is_not_told) {
  scene::Scene s;
  s.bodies = {scene::make_body("bar", 1.0, {{0.1, 0.1, 0.1}}, {{0.1, 0.2, 0.3}})};
  s.joints = {scene::make_joint("ball", scene::JointKind::spherical, "", Vec3::zero(), "bar", {{-0.1, -0.2, -0.3}})};
  scene::InitialVelocity v;
  v.of = "bar";
  v.angular_velocity = {{0.7, -0.3, 1.1}};
  v.velocity = lanes::cross(v.angular_velocity, Vec3{{0.1, 0.2, 0.3}});
  s.initial_velocities = {v};
  s.analysis.step_size = 1e-3;
  s.analysis.end_time = 1e-3;
  const MemoryRun run = run_in_memory(s);
  ASSERT_TRUE(run.ok()) << run.text();
  EXPECT_FALSE(run.says("velocities")) << run.text();
  s.initial_velocities[0].velocity[0] += 1e-3;
  const MemoryRun off = run_in_memory(s);
  EXPECT_NE(doubt_about_start(off), nullptr);
}

/// A drive whose rate at the start is zero but for round-off, 1e-17 m/s, starts a structure at rest: nothing is
/// corrected that could be seen.
TEST(GivenVelocities, impulses_of_round_off_are_not_told) {
  scene::Scene s;
  s.bodies = {scene::make_body("slider", 1.0, {{0.1, 0.1, 0.1}}, Vec3::zero())};
  scene::PrescribedMotion m;
  m.name = "push";
  m.at.to = "slider";
  for (int i = 0; i < 3; ++i) m.displacement[i] = laws::make_constant(0.0);
  m.displacement[0] = laws::make_expression("1e-14*t + t^3");
  s.motions = {m};
  s.analysis.step_size = 1e-3;
  s.analysis.end_time = 1e-3;
  const MemoryRun run = run_in_memory(s);
  ASSERT_TRUE(run.ok()) << run.text();
  EXPECT_FALSE(run.says("velocities")) << run.text();
}

/// A wheel that a motor starts at once was given nothing; the ball beside it keeps what it was given.
TEST(GivenVelocities, what_drives_start_is_no_change_of_a_given_velocity) {
  scene::Scene s;
  s.bodies = {scene::make_body("wheel", 1.0, {{0.1, 0.1, 0.1}}, Vec3::zero()),
              scene::make_body("ball", 1.0, {{0.1, 0.1, 0.1}}, {{2.0, 0.0, 0.0}})};
  s.joints = {scene::make_joint("motor", scene::JointKind::revolute, "", Vec3::zero(), "wheel", Vec3::zero())};
  s.joints[0].drives.emplace_back().law = laws::make_expression("2*t");
  s.joints[0].drives[0].coordinate = "angle";
  scene::InitialVelocity v;
  v.of = "ball";
  v.velocity = {{1.0, 0.0, 0.0}};
  s.initial_velocities = {v};
  s.analysis.step_size = 1e-3;
  s.analysis.end_time = 1e-3;
  const MemoryRun run = run_in_memory(s);
  ASSERT_TRUE(run.ok()) << run.text();
  EXPECT_TRUE(run.says("velocities were made consistent")) << run.text();
  EXPECT_EQ(doubt_about_start(run), nullptr);
}

}  // namespace
}  // namespace bough::run
