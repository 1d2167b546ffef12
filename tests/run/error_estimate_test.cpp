/// The estimated error of sensors against the true one, from runs in fine steps: it is right within a factor, and runs
/// are doubted where they are wrong.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "bough/step/step_control.hpp"
#include "support/scenes.hpp"

namespace bough::run {
namespace {

using support::Outcome;
using support::Table;

/// A crank on the x axis, a rod between a ball and a universal joint, a slider along x; nothing drives or loads it.
constexpr const char* free_slider_crank = R"({
  "bodies": [{"name": "crank", "mass": 0.12, "inertia": [1e-4, 1e-5, 1e-4], "position": [0, 0.1, 0.16]},
             {"name": "rod", "mass": 0.5, "inertia": [4e-3, 4e-3, 4e-3], "position": [0.1, 0.05, 0.1]},
             {"name": "slider", "mass": 2, "inertia": [1e-4, 1e-4, 1e-4], "position": [0.2, 0, 0]}],
  "joints": [{"name": "bearing", "kind": "revolute", "first": "ground", "second": "crank", "position": [0, 0.1, 0.12],
              "axis": [1, 0, 0]},
             {"name": "pin", "kind": "spherical", "first": "crank", "second": "rod", "position": [0, 0.1, 0.2]},
             {"name": "wrist", "kind": "universal", "first": "rod", "second": "slider", "position": [0.2, 0, 0],
              "axis": [0.1, 0.2, 0], "second_axis": [0, 0, 1]},
             {"name": "guide", "kind": "prismatic", "first": "ground", "second": "slider", "position": [0.2, 0, 0],
              "axis": [1, 0, 0]}],
  "initial_velocities": [{"of": "crank", "velocity": [0, -1.2, 0], "angular_velocity": [30, 0, 0]},
                         {"of": "slider", "velocity": [1.2, 0, 0]}, {"of": "rod", "velocity": [0.6, -1.2, 0]}],
  "sensors": [{"name": "rate", "kind": "joint_rate", "joint": "bearing"},
              {"name": "slider", "kind": "position", "at": "slider"}],
  "analysis": {"kind": "dynamic", "end_time": 1, "step_size": 2e-3, "spectral_radius": 0}})";

/// A mass on a spring, 20 vibrations.
constexpr const char* oscillator = R"({
  "bodies": [{"name": "mass", "mass": 1, "inertia": [0.1, 0.1, 0.1]}],
  "bushings": [{"name": "spring", "first": "ground", "second": "mass", "stiffness": [100, 100, 100, 100, 100, 100]}],
  "initial_velocities": [{"of": "mass", "velocity": [1, 0, 0]}],
  "sensors": [{"name": "x", "kind": "position", "at": "mass"}, {"name": "v", "kind": "velocity", "at": "mass"}],
  "analysis": {"kind": "dynamic", "end_time": 12.6, "step_size": 1e-2, "spectral_radius": 0.9}})";

struct Case {
  const char* what;
  scene::Scene scene;
  double fine;                ///< step of the reference
  std::vector<double> steps;  ///< multiples of it
};

Outcome run_with(scene::Scene scene, double step) {
  scene.expected.clear();
  scene.output.stride = 1;
  scene.analysis.step_size = step;
  return support::run(scene);
}

/// Largest difference of a column at the times of both, over the estimate's range.
double true_error(const Table& run, const Table& reference, const records::SensorError& e, std::size_t every) {
  const std::size_t a = run.column(e.column), b = reference.column(e.column);
  double most = 0.0;
  for (std::size_t k = 0; k < run.rows.size() && k * every < reference.rows.size(); ++k)
    most = std::max(most, std::abs(run.rows[k][a] - reference.rows[k * every][b]));
  return most / e.range;
}

void check(const Case& c) {
  const Outcome reference = run_with(c.scene, c.fine);
  ASSERT_TRUE(reference.ok()) << reference.summary.cause;
  for (const double step : c.steps) {
    const Outcome run = run_with(c.scene, step);
    ASSERT_TRUE(run.ok()) << c.what << ", " << step << ": " << run.summary.cause;
    ASSERT_EQ(run.summary.steps.rejected, 0) << c.what << ", " << step;
    ASSERT_FALSE(run.summary.sensor_errors.empty());
    double error = 0.0, estimate = 0.0;
    std::string worst;
    for (const records::SensorError& e : run.summary.sensor_errors) {
      const double is = true_error(run.history, reference.history, e, static_cast<std::size_t>(step / c.fine + 0.5));
      if (is > error) worst = e.column;
      error = std::max(error, is);
      estimate = std::max(estimate, e.relative());
    }
    const bool doubted = std::any_of(run.summary.doubts.begin(), run.summary.doubts.end(),
                                     [](const records::Doubt& d) { return d.about == "error"; });
    std::printf("| %s, h = %g s | %s off by %.2g of its range | estimated %.2g | %s |\n", c.what, step, worst.c_str(),
                error, estimate, doubted ? "doubted" : "not doubted");
    if (error < 0.5) {  // beyond, errors are as large as the motion and grow no more
      EXPECT_GT(estimate, error / 4.0) << c.what << ", " << step;
      // Free beams vibrate with local errors of changing sign, whose absolute values are summed up. A hundredth of the
      // range is a fourth of what is doubted.
      EXPECT_LT(estimate, error * 5.0 + 0.01) << c.what << ", " << step;
    }
    if (error > 0.12) {
      EXPECT_TRUE(doubted) << c.what << ", " << step;
    }
    if (error < 0.01) {
      EXPECT_FALSE(doubted) << c.what << ", " << step;
    }
  }
}

TEST(ErrorEstimate, is_right_within_a_factor_and_doubts_what_is_wrong) {
  const auto gallery = [](const char* name) { return support::gallery(name); };
  check({"pendulum", gallery("pendulum"), 2e-3, {0.02, 0.05, 0.1}});
  check({"two pendulums", gallery("double_pendulum"), 1e-3, {0.01, 0.04}});
  scene::Scene top = gallery("heavy_top");
  top.analysis.end_time = 1.0;
  check({"top", top, 1e-4, {1e-3, 2e-3, 4e-3}});
  check({"slider-crank that runs freely", support::scene_of(free_slider_crank), 1e-4, {1e-3, 2e-3}});
  check({"squeezer", gallery("andrews_squeezer"), 1e-5, {5e-5, 2e-4}});
  check({"four-bar", gallery("four_bar_planar"), 2e-3, {0.01, 0.05}});
  check({"two beams at a right angle", gallery("right_angle_cantilever"), 1e-2, {0.05, 0.1}});
  check({"beam in flight", gallery("flying_spaghetti"), 5e-3, {0.05, 0.02}});
  check({"row of bodies on springs", gallery("struck_row"), 2.5e-4, {1e-3, 5e-3, 1e-2}});
  check({"mass on a spring", support::scene_of(oscillator), 1e-3, {1e-2, 5e-2}});
}

TEST(ErrorEstimate, of_rates_alone_tells_as_much) {
  scene::Scene scene = support::gallery("pendulum");
  scene.sensors = {support::joint_sensor("rate", scene::SensorKind::joint_rate, "hinge")};
  check({"pendulum, its rate", scene, 2e-3, {0.02, 0.1}});
}

TEST(ErrorEstimate, follows_the_tolerance_of_step_control) {
  scene::Scene scene = support::gallery("pendulum");
  scene.expected.clear();
  const auto estimate = [&](double tolerance) {
    scene.analysis.step_control.emplace().tolerance = tolerance;
    const Outcome run = support::run(scene);
    EXPECT_TRUE(run.ok()) << run.summary.cause;
    double most = 0.0;
    for (const records::SensorError& e : run.summary.sensor_errors) most = std::max(most, e.relative());
    return most;
  };
  const double coarse = estimate(1e-2), fine = estimate(1e-4);
  EXPECT_GT(coarse / fine, 30.0);
  EXPECT_LT(coarse / fine, 300.0);
}

/// The step that is named makes the run good.
TEST(ErrorEstimate, names_a_step_that_does) {
  const Outcome coarse = run_with(support::gallery("pendulum"), 0.1);
  ASSERT_EQ(coarse.summary.doubts.size(), 1u);
  const std::string& text = coarse.summary.doubts[0].text;
  const std::size_t at = text.find("steps of ");
  ASSERT_NE(at, std::string::npos) << text;
  const double step = std::stod(text.substr(at + 9));
  EXPECT_LT(step, 0.09) << text;
  EXPECT_GT(step, 0.02) << text;
  EXPECT_TRUE(run_with(support::gallery("pendulum"), 0.95 * step).summary.doubts.empty()) << text;
}

/// A spatial slider-crank under its weight whose steps of 2 ms let the integrator take a fifth of the energy: its rate
/// after 2 s is wrong, the run says so with a step, and this step makes it right.
TEST(ErrorEstimate, names_a_step_that_does_for_a_spatial_slider_crank) {
  scene::Scene scene = support::scene_of(free_slider_crank, {"/gravity=[0,0,-9.81]", "/analysis/end_time=2"});
  for (scene::InitialVelocity& v : scene.initial_velocities)
    if (v.of == "rod") v.angular_velocity = {{0.0, 0.0, 12.0}};  // as crank and slider ask
  const Outcome reference = [&] {
    scene::Scene fine = scene;
    fine.analysis.spectral_radius = 0.9;
    return run_with(fine, 1e-4);
  }();
  const Outcome coarse = run_with(scene, 2e-3);
  ASSERT_TRUE(reference.ok() && coarse.ok()) << coarse.summary.cause;
  EXPECT_GT(std::abs(coarse.history.last("rate") - reference.history.last("rate")), 3.0) << "of 37.5 rad/s";
  std::string text;
  for (const records::Doubt& d : coarse.summary.doubts)
    if (d.about == "error") text = d.text;
  const std::size_t at = text.find("steps of ");
  ASSERT_NE(at, std::string::npos) << text;
  const double step = std::stod(text.substr(at + 9));
  EXPECT_GT(step, 1e-4) << text;
  const Outcome named = run_with(scene, step);
  ASSERT_TRUE(named.ok()) << named.summary.cause;
  EXPECT_TRUE(named.summary.doubts.empty()) << named.summary.doubts[0].text;
  const double range = named.summary.sensor_errors[0].range;
  EXPECT_NEAR(named.history.last("rate"), reference.history.last("rate"), 0.05 * range) << step;
}

/// Silence is no approval: where no error was estimated, the verdict says of what.
TEST(ErrorEstimate, says_of_which_sensors_there_is_none) {
  scene::Scene scene = support::gallery("pendulum", {"/analysis/end_time=0.2"});
  scene.expected.clear();
  scene.sensors = {support::joint_sensor("angle", scene::SensorKind::joint_angle, "hinge")};
  const auto not_judged = [](const scene::Scene& s) {
    const Outcome run = support::run(s);
    EXPECT_TRUE(run.ok()) << run.summary.cause;
    return run.summary.not_judged;
  };
  EXPECT_EQ(not_judged(scene), "");
  scene::Scene other = scene;
  other.sensors.push_back(support::joint_sensor("pull", scene::SensorKind::joint_reaction, "hinge"));
  EXPECT_NE(not_judged(other).find("the error in time of 'pull' is not estimated"), std::string::npos)
      << not_judged(other);
  other = scene;
  other.analysis.integrator = scene::Integrator::variational;
  EXPECT_NE(not_judged(other).find("not estimated, the variational integrator"), std::string::npos);
  other.analysis.integrator = scene::Integrator::bdf;
  EXPECT_NE(not_judged(other).find("not estimated, backward differences"), std::string::npos);
  other = scene;
  other.output.checks = false;
  EXPECT_NE(not_judged(other).find("/output/checks is false"), std::string::npos);
}

/// Two bodies on joints, free to turn, at rest in a world without gravity: the start makes them consistent to
/// round-off, and that is all the energy there is.
TEST(ErrorEstimate, energies_of_round_off_do_not_grow) {
  const Outcome run = support::run(support::scene_of(R"({
    "bodies": [{"name": "a", "mass": 2, "inertia": [0.1, 0.2, 0.3], "position": [0.3, 0.4, 0.5]},
               {"name": "b", "mass": 3, "inertia": [0.3, 0.1, 0.2], "position": [0.7, -0.1, 0.9]}],
    "joints": [{"name": "ball", "kind": "spherical", "first": "a", "second": "b", "position": [0.45, 0.13, 0.71]},
               {"name": "hinge", "kind": "revolute", "first": "ground", "second": "a", "position": [0.1, 0.2, 0.3],
                "axis": [0.3, 0.5, 0.7]}],
    "sensors": [{"name": "x", "kind": "position", "at": "b"}],
    "analysis": {"kind": "dynamic", "end_time": 1, "step_size": 1e-2}})"));
  ASSERT_TRUE(run.ok()) << run.summary.cause;
  EXPECT_GT(run.summary.checks.energy_gained, 0.01 * run.summary.checks.energy_scale)
      << "there is nothing that a bound of round-off would have to let pass";
  EXPECT_TRUE(run.summary.doubts.empty()) << run.summary.doubts[0].text;
}

/// A mass on a spring, v = 2 cos(w t): e_v = h^3 C_v v''' is largest where v''' = 2 w^3, and speeds are relative to 2.
TEST(ErrorEstimate, local_error_of_velocities_is_that_of_an_oscillator) {
  const double w = 2.0 * 3.14159265358979323846, h = 0.01;
  const Outcome run = support::run(support::scene_of(
      R"({"bodies": [{"name": "mass", "mass": 1, "inertia": [1, 1, 1], "position": [0, 0, 0]}],
    "joints": [{"name": "guide", "kind": "prismatic", "first": "ground", "second": "mass", "position": [0, 0, 0],
                "axis": [0, 0, 1], "forces": [{"stiffness": )" +
      support::text(w * w) + R"(}]}],
    "initial_velocities": [{"of": "mass", "velocity": [0, 0, 2]}],
    "sensors": [{"name": "v", "kind": "velocity", "at": "mass"}],
    "analysis": {"kind": "dynamic", "end_time": 3, "step_size": 0.01}})"));
  ASSERT_TRUE(run.ok()) << run.summary.cause;
  const double constant = std::abs(step::make_alpha_coefficients(0.8).error_of_velocities());
  const double expected = h * h * h * constant * w * w * w;
  EXPECT_NEAR(run.summary.checks.local_error_max_velocity, expected, 0.03 * expected);
}

/// The gap that velocities open within a step, relative to the length of the parts at the joint (1 m here).
TEST(ErrorEstimate, violation_of_a_step_is_that_of_velocities_times_its_size) {
  for (const double h : {1e-2, 5e-3}) {
    const Outcome run = support::run(support::scene_of(
        R"({"gravity": [0, 0, -9.81],
      "bodies": [{"name": "bob", "mass": 1, "inertia": [0.1, 0.1, 0.1], "position": [1, 0, 0]}],
      "joints": [{"name": "pin", "kind": "revolute", "first": "ground", "second": "bob", "position": [0, 0, 0],
                  "axis": [0, 1, 0]}],
      "sensors": [{"name": "x", "kind": "position", "at": "bob"}],
      "analysis": {"kind": "dynamic", "end_time": 1, "step_size": )" +
        support::text(h) + "}}"));
    ASSERT_TRUE(run.ok()) << run.summary.cause;
    const records::Checks& checks = run.summary.checks;
    EXPECT_GT(checks.relative_violation_step, 0.0);
    EXPECT_NEAR(checks.relative_violation_step, h * checks.constraint_violation_velocity,
                1e-9 * checks.relative_violation_step);
  }
}

}  // namespace
}  // namespace bough::run
