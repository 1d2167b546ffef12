// Steps that fail: halving, regrowth, causes in words, times that are never summed.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "bough/laws/make_law.hpp"
#include "support/scenes.hpp"

namespace bough::run {
namespace {

using support::Outcome;
using support::Table;

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

TEST(StepFailure, halved_steps_grow_back_and_the_result_is_that_of_the_run_without_failures) {
  // A rotor braked from 100 rad/s: 5 rad a step are asked for at first, but a node must not turn by pi in one step.
  // Its angle is 100 J/c (1 - exp(-c t / J)) with J = c.
  scene::Scene scene = support::scene_of(R"({
    "bodies": [{"name": "rotor", "mass": 1, "inertia": [1, 1, 2]}],
    "joints": [{"name": "axle", "kind": "revolute", "first": "ground", "second": "rotor", "position": [0, 0, 0], "axis": [0, 0, 1],
                "forces": [{"damping": 2}]}],
    "initial_velocities": [{"of": "rotor", "angular_velocity": [0, 0, 100]}],
    "sensors": [{"name": "angle", "kind": "joint_angle", "joint": "axle"}],
    "analysis": {"kind": "dynamic", "end_time": 3, "step_size": 0.05, "tolerance": 1e-11}})");
  const Outcome hard = support::run(scene);
  scene.analysis.step_size = 0.025;
  const Outcome easy = support::run(scene);
  ASSERT_TRUE(hard.ok()) << hard.summary.cause;
  ASSERT_TRUE(easy.ok()) << easy.summary.cause;
  EXPECT_EQ(easy.summary.steps.rejected, 0);
  EXPECT_EQ(easy.summary.steps.accepted, 120);
  EXPECT_GT(hard.summary.steps.rejected, 1) << "growing too early fails again";
  EXPECT_GT(hard.summary.steps.accepted, 60);
  EXPECT_LT(hard.summary.steps.accepted, 120) << "it does not stay small";
  EXPECT_EQ(hard.history.step_sizes.back(), 0.05);
  int changes = 0;
  for (std::size_t k = 2; k < hard.history.times.size(); ++k) {
    const double size = hard.history.step_sizes[k];
    changes += size != hard.history.step_sizes[k - 1] ? 1 : 0;
    EXPECT_EQ(hard.history.times[k], std::round(hard.history.times[k] / size) * size)
        << "a multiple of the step, not a sum";
  }
  EXPECT_GT(changes, 0);
  double error_easy = 0.0, error_hard = 0.0;
  const auto error = [](const Outcome& o) {
    double most = 0.0;
    for (double t : o.history.times)
      most = std::max(most, std::abs(o.history.at("angle", t) - 100.0 * (1.0 - std::exp(-t))));
    return most;
  };
  error_easy = error(easy);
  error_hard = error(hard);
  std::printf(
      "failures: %ld rejected, %ld accepted, %d changes; error %.1e rad, without failures at half the step %.1e rad\n",
      hard.summary.steps.rejected, hard.summary.steps.accepted, changes, error_hard, error_easy);
  EXPECT_LT(error_hard, 4.4 * error_easy) << "as with the larger step throughout";
}

TEST(StepFailure, a_body_that_spins_too_fast_for_the_step_is_followed_in_halves) {
  // 5 rad a step asked for; a turn of a node in one step has to stay below pi.
  const scene::Scene scene = support::scene_of(R"({
    "bodies": [{"name": "rotor", "mass": 1, "inertia": [1, 1, 2]}],
    "initial_velocities": [{"of": "rotor", "angular_velocity": [0, 0, 100]}],
    "sensors": [{"name": "R", "kind": "rotation", "at": "rotor"}],
    "analysis": {"kind": "dynamic", "end_time": 1, "step_size": 0.05}})");
  const Outcome outcome = support::run(scene);
  ASSERT_TRUE(outcome.ok()) << outcome.summary.cause;
  EXPECT_GT(outcome.summary.steps.rejected, 0);
  EXPECT_NEAR(outcome.history.last("R.rz"), std::remainder(100.0, 2.0 * 3.14159265358979323846), 1e-9);
  bool named = false;
  for (const std::string& note : outcome.summary.notes) named |= contains(note, "'rotor' turns by nearly half a turn");
  EXPECT_TRUE(named) << "the summary says why steps were rejected";
}

TEST(StepFailure, times_are_computed_never_summed) {
  const Outcome outcome =
      support::run(support::gallery("pendulum", {"/analysis/step_size=0.1", "/analysis/end_time=100"}));
  ASSERT_TRUE(outcome.ok()) << outcome.summary.cause;
  ASSERT_EQ(outcome.history.times.size(), 1001u);
  for (std::size_t k = 0; k <= 1000; ++k)
    EXPECT_EQ(outcome.history.times[k], k == 1000 ? 100.0 : static_cast<double>(k) * (100.0 / 1000.0));
}

TEST(StepFailure, steps_end_at_breakpoints_exactly) {
  const scene::Scene scene = support::gallery("flying_spaghetti", {"/analysis/step_size=0.03", "/analysis/end_time=3",
                                                                   "/beams/beam/elements=2", "/expected=[]"});
  const Outcome outcome = support::run(scene);
  ASSERT_TRUE(outcome.ok()) << outcome.summary.cause;
  int met = 0;
  for (double t : outcome.history.times) met += t == 2.5 ? 1 : 0;
  EXPECT_EQ(met, 1);
  EXPECT_EQ(outcome.history.times.back(), 3.0);
}

TEST(StepFailure, a_drive_beyond_reach_ends_with_time_and_cause) {
  // Two rods of 1 m cannot reach 2.1 m: stretched at t = 1 s.
  const Outcome outcome = support::run(support::scene_of(R"({
    "bodies": [{"name": "crank", "mass": 1, "shape": {"kind": "rod", "length": 1, "axis": 2}, "position": [0, 0.5, 0]},
               {"name": "rod", "mass": 1, "shape": {"kind": "rod", "length": 1, "axis": 1}, "position": [0.5, 1, 0]},
               {"name": "slider", "mass": 1, "inertia": [1, 1, 1], "position": [1, 1, 0]}],
    "joints": [{"name": "O", "kind": "revolute", "first": "ground", "second": "crank", "position": [0, 0, 0], "axis": [0, 0, 1]},
               {"name": "A", "kind": "revolute", "first": "crank", "second": "rod", "position": [0, 1, 0], "axis": [0, 0, 1]},
               {"name": "B", "kind": "spherical", "first": "rod", "second": "slider", "position": [1, 1, 0]},
               {"name": "rail", "kind": "prismatic", "first": "ground", "second": "slider", "position": [1, 1, 0], "axis": [1, 0, 0],
                "drives": [{"law": {"expression": "0.8*t"}}]}],
    "sensors": [{"name": "slider", "kind": "position", "at": "slider"}],
    "analysis": {"kind": "dynamic", "end_time": 2, "step_size": 0.01}})"));
  EXPECT_EQ(outcome.summary.status, records::RunStatus::failed);
  const double reached = outcome.history.times.back(), limit = (std::sqrt(3.0) - 1.0) / 0.8;
  std::printf("beyond reach: \"%s\"\n", outcome.summary.cause.c_str());
  EXPECT_NEAR(reached, limit, 0.02) << "as far as the rods reach";
  EXPECT_TRUE(contains(outcome.summary.cause, "time")) << outcome.summary.cause;
  EXPECT_TRUE(contains(outcome.summary.cause, "'")) << "names what fails: " << outcome.summary.cause;
}

TEST(StepFailure, contradicting_drives_are_named_at_the_start) {
  const Outcome outcome = support::run(support::scene_of(R"({
    "bodies": [{"name": "a", "mass": 1, "inertia": [1, 1, 1]}, {"name": "b", "mass": 1, "inertia": [1, 1, 1]}],
    "joints": [{"name": "first", "kind": "revolute", "first": "ground", "second": "a", "position": [0, 0, 0], "axis": [0, 0, 1], "drives": [{"law": 1, "rate": true}]},
               {"name": "second", "kind": "revolute", "first": "a", "second": "b", "position": [0, 0, 0], "axis": [0, 0, 1], "drives": [{"law": 0}]},
               {"name": "third", "kind": "revolute", "first": "ground", "second": "b", "position": [0, 0, 0], "axis": [0, 0, 1], "drives": [{"law": 0}]}],
    "sensors": [], "analysis": {"kind": "dynamic", "end_time": 1, "step_size": 0.01}})"));
  EXPECT_EQ(outcome.summary.status, records::RunStatus::failed);
  std::printf("contradiction: \"%s\"\n", outcome.summary.cause.c_str());
  EXPECT_TRUE(contains(outcome.summary.cause, "contradict")) << outcome.summary.cause;
  EXPECT_TRUE(contains(outcome.summary.cause, "first") || contains(outcome.summary.cause, "third"))
      << outcome.summary.cause;
}

TEST(StepFailure, a_law_that_is_not_finite_stops_the_run_with_time_and_owner) {
  for (const char* law : {"1/(t-0.5)", "sqrt(0.5-t)-1", "log(0.5-t)"}) {
    scene::Scene scene = support::scene_of(R"({"bodies": [{"name": "a", "kind": "point_mass", "mass": 1e3}],
        "loads": [{"name": "push", "at": "a", "force": [1, 0, 0]}],
        "sensors": [{"name": "x", "kind": "position", "at": "a"}],
        "analysis": {"kind": "dynamic", "end_time": 1, "step_size": 0.01}})");
    scene.point_loads.front().law =
        laws::make_expression(law);  // a file would have been refused: the reader tries laws at many times
    const Outcome outcome = support::run(scene);
    EXPECT_EQ(outcome.summary.status, records::RunStatus::failed) << law;
    std::printf("not finite, %s: \"%s\"\n", law, outcome.summary.cause.c_str());
    EXPECT_TRUE(contains(outcome.summary.cause, "push")) << outcome.summary.cause;
    EXPECT_TRUE(contains(outcome.summary.cause, "0.5")) << outcome.summary.cause;
    EXPECT_LE(outcome.history.times.back(), 0.5);
    EXPECT_GE(outcome.history.times.back(), 0.48);
    for (double x : outcome.history.of("x.x")) EXPECT_TRUE(std::isfinite(x));
  }
}

TEST(StepFailure, a_run_can_be_stopped_between_steps) {
  const Outcome outcome =
      support::run(support::gallery("pendulum"), [](const records::Progress& p) { return p.step < 10; });
  EXPECT_EQ(outcome.summary.status, records::RunStatus::interrupted);
  EXPECT_EQ(outcome.summary.steps.accepted, 10);
}

TEST(NewtonSingle, is_reported_and_of_second_order_in_motion) {
  // One linear solution a step: linearly implicit. Errors against the closed form at 1 s.
  double error[3], rate_error[3];
  for (int k = 0; k < 3; ++k) {
    scene::Scene scene = support::gallery("pendulum", {"/analysis/newton=single", "/analysis/end_time=1"});
    scene.analysis.step_size = 4e-3 / (1 << k);
    scene.sensors.push_back(support::joint_sensor("rate", scene::SensorKind::joint_rate, "hinge"));
    const Outcome outcome = support::run(scene);
    ASSERT_TRUE(outcome.ok()) << outcome.summary.cause;
    bool told = false;
    for (const std::string& note : outcome.summary.notes) told |= contains(note, "one linear solution per step");
    EXPECT_TRUE(told);
    EXPECT_EQ(outcome.summary.steps.newton_iterations, outcome.summary.steps.accepted);
    const Table exact = support::reference("A01_pendulum.csv");
    error[k] = std::abs(outcome.history.last("bob.y") - exact.at("y", 1.0));
    rate_error[k] = std::abs(outcome.history.last("rate") - exact.at("thetadot", 1.0));
  }
  std::printf("single: errors of place %.1e %.1e %.1e (order %.2f), of the rate %.1e %.1e %.1e (order %.2f)\n",
              error[0], error[1], error[2], support::order_of(error[1], error[2]), rate_error[0], rate_error[1],
              rate_error[2], support::order_of(rate_error[1], rate_error[2]));
  EXPECT_GT(support::order_of(error[1], error[2]), 1.8);
  EXPECT_GT(support::order_of(rate_error[1], rate_error[2]), 1.8);
}

}  // namespace
}  // namespace bough::run
