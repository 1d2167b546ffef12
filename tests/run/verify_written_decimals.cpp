/// Scenes whose numbers were written with few decimals, as programs write them: what is symmetric or dependent but for
/// its last digit is taken so, and told; what is not is left alone.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>

#include "bough/motion/se3.hpp"
#include "bough/plan/plan.hpp"
#include "support/scenes.hpp"

namespace bough::run {
namespace {

using support::Outcome;

constexpr int num_windows = 12;

/// Windows of four bars in a plane askew, whose loops have dependent rows in the plane, too.
scene::Scene windows(const std::vector<std::string>& overrides = {}) {
  std::vector<std::string> all{"/parameters/N=" + std::to_string(num_windows), "/analysis/end_time=0.1"};
  all.insert(all.end(), overrides.begin(), overrides.end());
  scene::Scene s = support::gallery("four_bar_windows", all);
  s.expected.clear();
  const motion::Vec3<double> turn{{0.4, -1.1, 0.7}};
  return support::moved(s, {motion::exp_so3(turn), {{0.3, -0.2, 0.9}}});
}

/// The scene as it is read from a file with this number of decimals: places are rounded, and directions turned by as
/// much as their rounded components turn them.
scene::Scene written_with(int decimals, scene::Scene s, unsigned seed) {
  std::mt19937 random(seed);
  const double unit = std::pow(10.0, decimals);
  std::uniform_real_distribution<double> uniform(-0.5 / unit, 0.5 / unit);
  const auto rounded = [unit](scene::Vec3& x) {
    for (int k = 0; k < 3; ++k) x[k] = std::round(x[k] * unit) / unit;
  };
  const auto turned = [&](scene::Mat3& R) {
    R = R * motion::exp_so3(motion::Vec3<double>{{uniform(random), uniform(random), uniform(random)}});
  };
  rounded(s.gravity);
  for (scene::Body& b : s.bodies) {
    rounded(b.placement.pose.x);
    turned(b.placement.pose.R);
  }
  for (scene::Joint& j : s.joints)
    for (scene::Attachment* a : {&j.first, &j.second}) {
      for (int k = 0; k < 3; ++k) a->offset.x[k] += uniform(random);
      turned(a->offset.R);
    }
  for (scene::InitialVelocity& v : s.initial_velocities) {
    rounded(v.velocity);
    rounded(v.angular_velocity);
  }
  return s;
}

/// The same, but that a joint has one place and one direction in the file, and both of its frames follow from these:
/// joints are closed at the start.
/// turns: directions of joints are those of one rounded vector each; else of vectors that are parallel before and after.
scene::Scene written_with_joints_in_space(int decimals, const scene::Scene& exact, bool turns, unsigned seed) {
  scene::Scene s = written_with(decimals, exact, seed);
  const double unit = std::pow(10.0, decimals);
  std::mt19937 random(seed + 1);
  std::uniform_real_distribution<double> uniform(-0.5 / unit, 0.5 / unit);
  const auto pose_of = [](const scene::Scene& of, const std::string& name) {
    for (const scene::Body& b : of.bodies)
      if (b.name == name) return b.placement.pose;
    return scene::Frame::identity();
  };
  for (std::size_t k = 0; k < s.joints.size(); ++k) {
    const scene::Attachment& at = exact.joints[k].second;
    scene::Frame joint = motion::compose(pose_of(exact, at.to), at.offset);
    for (int i = 0; i < 3; ++i) joint.x[i] = std::round(joint.x[i] * unit) / unit;
    if (turns)
      joint.R = joint.R * motion::exp_so3(motion::Vec3<double>{{uniform(random), uniform(random), uniform(random)}});
    for (scene::Attachment* a : {&s.joints[k].first, &s.joints[k].second})
      a->offset = motion::compose(motion::inverse(pose_of(s, a->to)), joint);
  }
  return s;
}

double figure(const Outcome& r, const std::string& name) {
  for (const auto& [key, value] : r.summary.solver)
    if (key == name) return value;
  ADD_FAILURE() << name;
  return -1.0;
}

TEST(WrittenDecimals, a_plane_is_found_and_told) {
  const Outcome exact = support::run_ok(windows());
  for (const int decimals : {9, 7, 6}) {
    SCOPED_TRACE(std::to_string(decimals) + " decimals");
    const scene::Scene s = written_with(decimals, windows(), 3);
    const plan::Plan p = plan::make_plan(s);
    EXPECT_EQ(p.unknowns.motions, plan::Motions::planar);
    const std::string start = "places are written with " + std::to_string(decimals) + " decimals";
    EXPECT_TRUE(
        std::any_of(p.notes.begin(), p.notes.end(), [&](const std::string& n) { return n.starts_with(start); }));
    const Outcome r = support::run_ok(s);
    const double allowed = 100.0 * std::pow(10.0, -decimals);
    for (const char* c : {"B0.x", "B0.y", "B0.z"}) EXPECT_NEAR(r.history.last(c), exact.history.last(c), allowed) << c;
    EXPECT_EQ(figure(r, "dependent_rows"), figure(exact, "dependent_rows"));
    for (const std::string& note : r.summary.notes)
      EXPECT_EQ(note.find("singular position"), std::string::npos) << note;
    EXPECT_LE(r.summary.steps.newton_iterations, 1.1 * static_cast<double>(exact.summary.steps.newton_iterations));
  }
}

// Rows that are known to depend are decided where they close, at a cost that does not grow with the number of loops.
TEST(WrittenDecimals, rows_depend_within_them_in_space_too) {
  const auto in_space = [](scene::Scene s) {
    s.without.emplace_back("planar");
    return s;
  };
  const Outcome exact = support::run_ok(in_space(windows()));
  for (const int decimals : {10, 9, 7, 6}) {
    SCOPED_TRACE(std::to_string(decimals) + " decimals");
    const scene::Scene s = in_space(written_with_joints_in_space(decimals, windows(), decimals >= 9, 3));
    const plan::Plan p = plan::make_plan(s);
    ASSERT_EQ(p.unknowns.motions, plan::Motions::spatial);
    EXPECT_GT(p.precision, 0.0);
    EXPECT_TRUE(p.mobility.locked.empty());
    const Outcome r = support::run_ok(s);
    const double allowed = 100.0 * std::pow(10.0, -decimals);
    for (const char* c : {"B0.x", "B0.y", "B0.z"}) EXPECT_NEAR(r.history.last(c), exact.history.last(c), allowed) << c;
    EXPECT_EQ(figure(r, "dependent_rows"), figure(exact, "dependent_rows"));
    EXPECT_LE(r.summary.steps.newton_iterations, 1.1 * static_cast<double>(exact.summary.steps.newton_iterations));
    EXPECT_LE(r.summary.steps.factorizations, 1.5 * static_cast<double>(exact.summary.steps.factorizations));
  }
}

TEST(WrittenDecimals, what_is_off_by_more_is_left_alone) {
  scene::Scene s = written_with(9, windows(), 3);
  s.joints[4].second.offset.R = s.joints[4].second.offset.R * motion::exp_so3(motion::Vec3<double>{{1e-6, 0.0, 0.0}});
  EXPECT_EQ(plan::make_plan(s).unknowns.motions, plan::Motions::spatial);
  // Few decimals are written by hand, and meant; coordinates of more than twelve have no precision but round-off.
  EXPECT_EQ(plan::make_plan(written_with(4, windows(), 3)).unknowns.motions, plan::Motions::spatial);
  scene::Scene full = windows();
  EXPECT_EQ(plan::make_plan(full).unknowns.motions, plan::Motions::planar);
  full.joints[4].second.offset.R =
      full.joints[4].second.offset.R * motion::exp_so3(motion::Vec3<double>{{1e-9, 0.0, 0.0}});
  EXPECT_EQ(plan::make_plan(full).unknowns.motions, plan::Motions::spatial);
}

}  // namespace
}  // namespace bough::run
