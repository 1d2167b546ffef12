// Order of the time integrator in positions, velocities and multipliers, each shown by itself: from the first step
// on, where the step size changes, with driven joints, across jumps of loads.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "order_scenes.hpp"
#include "support/stepper.hpp"

namespace bough::run {
namespace {

using support::compare;
using support::Difference;
using support::march;
using support::Sample;
using support::Stepper;

scene::Scene with_radius(scene::Scene scene, double radius) {
  scene.analysis.spectral_radius = radius;
  return scene;
}

void expect_order(const std::string& what, const Difference& coarse, const Difference& fine, double least = 1.8) {
  const double p = support::order_of(coarse.positions, fine.positions),
               v = support::order_of(coarse.velocities, fine.velocities),
               m = support::order_of(coarse.multipliers, fine.multipliers);
  std::printf("| %s | %.2f (%.1e) | %.2f (%.1e) | %.2f (%.1e) |\n", what.c_str(), p, fine.positions, v, fine.velocities,
              m, fine.multipliers);
  EXPECT_GT(p, least) << what;
  EXPECT_GT(v, least) << what;
  EXPECT_GT(m, least) << what;
}

class Orders : public testing::TestWithParam<double> {};

/// Errors of the first step, and the largest of the first 20 steps, at h and h / 2, against steps of h / fineness by
/// the same rule with a spectral radius of 0.8.
void check_start(const std::string& name, const scene::Scene& scene, double radius, double h, double fineness = 64.0) {
  const std::vector<Sample> reference = march(with_radius(scene, 0.8), h / fineness, h / 2.0, 40);
  const std::vector<Sample> coarse = march(with_radius(scene, radius), h, h, 20),
                            fine = march(with_radius(scene, radius), h / 2.0, h / 2.0, 40);
  char label[80];
  std::snprintf(label, sizeof label, "%s, rho %.1f", name.c_str(), radius);
  expect_order(std::string(label) + ", first step", compare(coarse, reference, 1, 1, 2),
               compare(fine, reference, 1, 1, 1));
  expect_order(std::string(label) + ", first 20 steps", compare(coarse, reference, 1, 20, 2),
               compare(fine, reference, 1, 20, 1));
  expect_order(std::string(label) + ", 20 h", compare(coarse, reference, 1, 20, 2), compare(fine, reference, 1, 40, 1));
}

TEST_P(Orders, second_from_the_first_step_with_ball_and_hinge) {
  check_start("ball and hinge", spatial_pendulum(), GetParam(), 0.004);
}
TEST_P(Orders, second_from_the_first_step_with_a_driven_joint) {
  check_start("driven hinge", driven_pendulum(), GetParam(), 0.004);
}
TEST_P(Orders, second_from_the_first_step_with_a_driven_beam) {
  // A reference in steps of h / 32 would have multipliers with 6e-7 of round-off, more than the first step's error at
  // h / 2.
  check_start("driven beam", driven_beam(), GetParam(), 0.0004, 8.0);
}

/// 10 steps of h, 8 of h / 2, 2 of h / 4, then h again. Samples at every end.
std::vector<Sample> march_unevenly(const scene::Scene& scene, double radius, double h, int fineness) {
  Stepper s(scene);
  s.options().spectral_radius = radius;
  const double unit = h / 4.0;  // all times are whole numbers of it
  s.start(h / fineness);
  std::vector<Sample> run;
  long at = 0;
  const auto steps = [&](int count, int size) {
    const double step = size * unit / fineness;
    s.change(step);
    for (int k = 0; k < count; ++k)
      for (int i = 1; i <= fineness; ++i) {
        s.step(static_cast<double>(at) * unit + i * step);
        if (i == fineness) {
          at += size;
          run.push_back(s.sample());
        }
      }
  };
  steps(10, 4);
  steps(8, 2);
  steps(2, 1);
  steps(1, 2);
  steps(10, 4);
  return run;
}

void check_changes(const std::string& name, const scene::Scene& scene, double radius, double h) {
  // The same pattern at h and with every step halved; the reference walks it in steps of h / 64.
  const std::vector<Sample> coarse = march_unevenly(scene, radius, h, 1), fine = march_unevenly(scene, radius, h, 2),
                            reference = march_unevenly(scene, 0.8, h, 64);
  Difference c, f;
  const Sample scale = support::scale_of(reference);
  for (std::size_t k = 0; k < coarse.size(); ++k) {
    c.include(coarse[k], reference[k], scale);
    f.include(fine[k], reference[k], scale);
  }
  char label[80];
  std::snprintf(label, sizeof label, "%s, rho %.1f, changing steps", name.c_str(), radius);
  expect_order(label, c, f);
}

TEST_P(Orders, second_where_the_step_size_changes_with_ball_and_hinge) {
  check_changes("ball and hinge", spatial_pendulum(), GetParam(), 0.005);
}
TEST_P(Orders, second_where_the_step_size_changes_with_a_driven_joint) {
  check_changes("driven hinge", driven_pendulum(), GetParam(), 0.005);
}

INSTANTIATE_TEST_SUITE_P(Radii, Orders, testing::Values(0.0, 0.5, 0.8));

TEST(OrdersOfRuns, second_across_jumps_of_a_force_and_of_a_driven_acceleration) {
  // The force on b jumps at 0.2 s and 0.3 s, the motor's angular acceleration at 0.1 s. The rows at a jump are the
  // left limits.
  const std::vector<std::string> jumps = {
      R"(/loads=[{"at": "b", "force": [3, -5, 4], "moment": [0.1, 0.2, 0.3], "axes": "body", "law": {"kind": "piecewise", "pieces": [)"
      R"({"start": 0, "law": 0}, {"start": 0.2, "law": 1}, {"start": 0.3, "law": {"expression": "-t"}}]}}])",
      R"(/joints/motor/drives/0/law={"kind": "piecewise", "pieces": [{"start": 0, "law": {"expression": "0.5*t"}}, )"
      R"({"start": 0.1, "law": {"expression": "0.5*t + 2*(t - 0.1)^2"}}]})",
      R"(/sensors=[{"name": "x", "kind": "position", "at": {"to": "b", "position": [0.3, 0.1, 0]}}, {"name": "v", "kind": "velocity", "at": "b"}, )"
      R"({"name": "f", "kind": "joint_reaction", "joint": "cross"}, {"name": "m", "kind": "joint_reaction", "joint": "motor"}])",
      "/analysis/end_time=0.4", "/analysis/tolerance=1e-12"};
  const std::string base = R"({
    "gravity": [0.3, -1.0, -9.81],
    "bodies": [
      {"name": "a", "mass": 2, "inertia": [0.3, 0.5, 0.4], "center_of_mass": [0.5, 0.1, 0]},
      {"name": "b", "mass": 1, "inertia": [0.05, 0.1, 0.12], "position": [1, 0.2, 0.1], "center_of_mass": [0.3, 0, -0.2]}],
    "joints": [
      {"name": "motor", "kind": "revolute", "first": "ground", "second": "a", "position": [0, 0, 0], "axis": [1, 0.3, 2], "drives": [{"law": 0}]},
      {"name": "cross", "kind": "universal", "first": "a", "second": "b", "position": [1, 0.2, 0.1], "axis": [0, 1, 0], "second_axis": [0, 0, 1]}],
    "analysis": {"kind": "dynamic", "end_time": 1}})";
  const auto with_step = [&](double h) {
    scene::Scene scene = support::scene_of(base, jumps);
    scene.analysis.step_size = h;
    const support::Outcome outcome = support::run(scene);
    EXPECT_TRUE(outcome.ok()) << outcome.summary.cause;
    return outcome.history;
  };
  const support::Table reference = with_step(0.005 / 64), coarse = with_step(0.005), fine = with_step(0.0025);
  const auto error = [&](const support::Table& run, const std::vector<std::string>& columns) {
    double most = 0.0;
    for (const std::string& column : columns)
      for (double t : coarse.times)
        most = std::max(most, std::abs(run.at(column, t) - reference.at(column, t)) / reference.largest(column));
    return most;
  };
  const std::vector<std::vector<std::string>> groups = {{"x.x", "x.y", "x.z"},
                                                        {"v.vx", "v.vy", "v.vz", "v.wx", "v.wy", "v.wz"},
                                                        {"f.fx", "f.fy", "f.fz", "m.fx", "m.fy", "m.mx", "m.mz"}};
  for (const auto& group : groups) {
    const double c = error(coarse, group), f = error(fine, group), order = support::order_of(c, f);
    std::printf("| across jumps, %s ... | %.2f (%.1e) |\n", group.front().c_str(), order, f);
    EXPECT_GT(order, 1.8) << group.front();
  }
}

TEST(OrdersOfRuns, the_impulse_of_a_driven_rate_that_jumps_is_inertia_times_jump) {
  // A bar about its end, J = m l^2 / 3 = 1 kg m^2, from rest to 3 rad/s at 0.5 s and back to rest at 0.7 s.
  const std::string base = R"({
    "bodies": [{"name": "bar", "mass": 3, "shape": {"kind": "rod", "length": 1, "axis": 1}, "position": [0.5, 0, 0]}],
    "joints": [{"name": "motor", "kind": "revolute", "first": "ground", "second": "bar", "position": [0, 0, 0], "axis": [0, 0, 1],
                "drives": [{"rate": true, "law": {"kind": "piecewise", "pieces": [{"start": 0, "law": 0}, {"start": 0.5, "law": 3},
                            {"start": 0.7, "law": 0}]}}]}],
    "sensors": [{"name": "angle", "kind": "joint_angle", "joint": "motor"}, {"name": "rate", "kind": "joint_rate", "joint": "motor"}],
    "analysis": {"kind": "dynamic", "end_time": 1, "step_size": 0.01}})";
  const scene::Scene scene = support::scene_of(base);
  const support::Outcome outcome = support::run(scene);
  ASSERT_TRUE(outcome.ok()) << outcome.summary.cause;
  int told = 0;
  for (const std::string& note : outcome.summary.notes) told += note.find("impulses") != std::string::npos ? 1 : 0;
  EXPECT_EQ(told, 2) << "one note for each jump";
  EXPECT_NEAR(outcome.history.last("angle"), 0.6, 1e-12);
  EXPECT_NEAR(outcome.history.at("rate", 0.6), 3.0, 1e-9);
  EXPECT_NEAR(outcome.history.last("rate"), 0.0, 1e-9);

  Stepper s(scene);
  s.start(0.01);
  for (int k = 1; k <= 50; ++k) s.step(0.01 * k);
  const step::StartReport jump =
      s.start(0.01);  // from the left limit to the right one; J = 1, F = m (l / 2) jump = 4.5 N s
  EXPECT_NEAR(jump.velocity_impulse, 4.5, 1e-9);
}

}  // namespace
}  // namespace bough::run
