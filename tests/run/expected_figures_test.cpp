// Expected figures and samples: what is between rows, between steps, and at the corners of a run.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "bough/run/memory_run.hpp"
#include "bough/scene/problems.hpp"
#include "support/scenes.hpp"

namespace bough::run {
namespace {

using records::ExpectedResult;
using support::scene_of;

/// A wheel on a torsion spring that swings as  angle = 25 sin(2 t).
scene::Scene wheel(const std::string& analysis, const std::string& expected = "") {
  return scene_of(R"({
    "bodies": [{"name": "wheel", "mass": 1, "inertia": [0.3, 0.3, 0.5]}],
    "joints": [{"name": "axle", "kind": "revolute", "first": "ground", "second": "wheel", "position": [0, 0, 0],
                "axis": [0, 0, 1], "forces": [{"stiffness": 2}]}],
    "initial_velocities": [{"of": "wheel", "angular_velocity": [0, 0, 50]}],
    "sensors": [{"name": "angle", "kind": "joint_angle", "joint": "axle"},
                {"name": "rate", "kind": "joint_rate", "joint": "axle"},
                {"name": "rim", "kind": "acceleration", "at": "wheel", "axes": "body"}],
    "output": {"stride": 1000000},
    "analysis": {"kind": "dynamic", "tolerance": 1e-11, )" +
                  analysis + R"(}, "expected": [)" + expected + "]}");
}
double angle_at(double t) { return 25.0 * std::sin(2.0 * t); }

/// A free wheel at rest, turned by a torque of 1 N m from 0.5 s on: angle = (t - 0.5)^2 from there.
scene::Scene pushed(double h, const std::string& expected) {
  return scene_of(R"json({
    "bodies": [{"name": "wheel", "mass": 1, "inertia": [0.3, 0.3, 0.5]}],
    "joints": [{"name": "axle", "kind": "revolute", "first": "ground", "second": "wheel", "position": [0, 0, 0],
                "axis": [0, 0, 1], "forces": [{"effort": {"expression": "step(t - 0.5)"}}]}],
    "sensors": [{"name": "angle", "kind": "joint_angle", "joint": "axle"},
                {"name": "rim", "kind": "acceleration", "at": "wheel", "axes": "body"}],
    "analysis": {"kind": "dynamic", "end_time": 1, "step_size": )json" +
                  support::text(h) + R"(}, "expected": [)" + expected + "]}");
}

std::string figure(const std::string& quantity, double time, double value = 0.0, double tolerance = 1.0) {
  return R"({"quantity": ")" + quantity + R"(", "time": )" + support::text(time) + R"(, "value": )" +
         support::text(value) + R"(, "tolerance": )" + support::text(tolerance) + "}";
}
std::string whole(const std::string& quantity, const std::string& kind, double value, double tolerance,
                  const std::string& more = "") {
  return R"({"quantity": ")" + quantity + R"(", "figure": ")" + kind + R"(", "value": )" + support::text(value) +
         R"(, "tolerance": )" + support::text(tolerance) + more + "}";
}
std::string joined(const std::vector<std::string>& list) {
  std::string text;
  for (const std::string& item : list) text += (text.empty() ? "" : ", ") + item;
  return text;
}

std::vector<ExpectedResult> figures_of(const scene::Scene& scene) {
  const MemoryRun run = run_in_memory(scene);
  EXPECT_TRUE(run.ok()) << run.text();
  return run.summary.expected;
}

// Steps of 4 ms: a figure of the nearest step would be off by up to 0.1 rad; the step's own error is 2e-3 rad at the
// end.
TEST(ExpectedFigures, a_time_within_a_step_is_met_as_well_as_the_ends_of_steps) {
  std::vector<std::string> list;
  std::vector<double> times;
  for (int k = 0; k < 40; ++k) {
    times.push_back(0.004 * (3 * k + 0.1 * (k % 10) + 0.05));
    list.push_back(figure("angle", times.back()));
    list.push_back(figure("rate", times.back()));
  }
  const scene::Scene scene = wheel(R"("end_time": 0.6, "step_size": 0.004)", joined(list));
  const auto found = figures_of(scene);
  // The phase error of generalized-alpha grows with time: what a step's end shows is compared at the same time.
  scene::Scene rows = scene;
  rows.output.stride = 1;
  const MemoryRun run = run_in_memory(rows);
  const std::vector<double> angles = run.series("angle");
  double worst = 0.0, nearest = 0.0;
  for (std::size_t k = 0; k < times.size(); ++k) {
    const auto row = static_cast<std::size_t>(times[k] / 0.004);
    const double at_ends = std::max(std::abs(angles[row] - angle_at(0.004 * static_cast<double>(row))),
                                    std::abs(angles[row + 1] - angle_at(0.004 * static_cast<double>(row + 1))));
    const double off = std::abs(found[2 * k].value - angle_at(times[k]));
    EXPECT_LT(off, 1.05 * at_ends + 1e-8) << times[k];  // 25 (2 h)^4 / 384 of the interpolation: 3e-10
    EXPECT_EQ(found[2 * k].taken, "interpolated within a step");
    worst = std::max(worst, off);
    nearest = std::max(nearest, std::abs(angles[row] - angle_at(times[k])));
    EXPECT_NEAR(found[2 * k + 1].value, 50.0 * std::cos(2.0 * times[k]), 5e-3) << times[k];
  }
  std::printf("angle within steps: off by %.1e at most, the step before by %.1e\n", worst, nearest);
}

TEST(ExpectedFigures, at_the_end_of_a_step_they_are_the_bits_of_the_row) {
  scene::Scene scene = wheel(R"("end_time": 1, "step_size": 0.01)",
                             joined({figure("angle", 0.0), figure("angle", 0.37), figure("angle", 1.0),
                                     figure("rim.alz", 0.37), figure("rate", 0.0)}));
  scene.output.stride = 1;
  const MemoryRun run = run_in_memory(scene);
  ASSERT_TRUE(run.ok()) << run.text();
  const auto& found = run.summary.expected;
  EXPECT_EQ(found[0].value, run.series("angle")[0]);
  EXPECT_EQ(found[1].value, run.series("angle")[37]);
  EXPECT_EQ(found[2].value, run.series("angle")[100]);
  EXPECT_EQ(found[3].value, run.series("rim.alz")[37]);
  EXPECT_EQ(found[4].value, run.series("rate")[0]);
  for (const ExpectedResult& f : found) EXPECT_EQ(f.taken, "at the end of a step") << f.name;
}

// Both sides of the jump are met by parabolas; across it nothing could be.
TEST(ExpectedFigures, nothing_is_interpolated_across_a_breakpoint) {
  const auto found = figures_of(
      pushed(0.1, joined({figure("angle", 0.47), figure("angle", 0.5), figure("angle", 0.53), figure("angle", 0.999),
                          figure("rim.alz", 0.47), figure("rim.alz", 0.53), figure("rim.alz", 0.5)})));
  EXPECT_NEAR(found[0].value, 0.0, 1e-12);
  EXPECT_NEAR(found[1].value, 0.0, 1e-12);
  EXPECT_NEAR(found[2].value, 0.03 * 0.03, 1e-10);
  EXPECT_NEAR(found[3].value, 0.499 * 0.499, 1e-10);
  EXPECT_NEAR(found[4].value, 0.0, 1e-10);
  EXPECT_NEAR(found[5].value, 2.0, 1e-9);
  EXPECT_NEAR(found[6].value, 0.0, 1e-10) << "the end of the step before the jump";
}

// 5 rad in a step are refused, so every step of 0.1 s is cut; a steady turn is interpolated exactly.
TEST(ExpectedFigures, rejected_steps_leave_nothing_behind) {
  scene::Scene scene = wheel(R"("end_time": 1, "step_size": 0.1)",
                             joined({figure("angle", 0.13), figure("angle", 0.77), whole("angle", "max", 50, 1e-6)}));
  scene.joints[0].forces.clear();
  const MemoryRun run = run_in_memory(scene);
  ASSERT_TRUE(run.ok()) << run.text();
  EXPECT_GT(run.summary.steps.rejected, 0);
  EXPECT_NEAR(run.summary.expected[0].value, 6.5, 1e-9);
  EXPECT_NEAR(run.summary.expected[1].value, 38.5, 1e-9);
  EXPECT_NEAR(run.summary.expected[2].value, 50.0, 1e-9);
}

TEST(ExpectedFigures, steps_of_chosen_sizes_end_there) {
  const auto found =
      figures_of(wheel(R"("end_time": 2, "step_size": 0.001, "step_control": {"tolerance": 1e-4})",
                       joined({figure("angle", 0.77123), figure("angle", 0.77124), whole("angle", "max", 25, 1e-2),
                               whole("angle", "time_of_max", 0.785, 1)})));
  EXPECT_EQ(found[0].taken, "at the end of a step");
  EXPECT_NEAR(found[0].value, angle_at(0.77123), 2e-2);
  EXPECT_NEAR(found[1].value - found[0].value, angle_at(0.77124) - angle_at(0.77123), 1e-6);
  EXPECT_TRUE(found[2].holds) << found[2].value;
  EXPECT_NEAR(found[3].value, 0.25 * std::numbers::pi, 2e-3);
}

TEST(ExpectedFigures, every_integrator_is_interpolated) {
  for (const char* integrator : {"bdf", "variational"}) {
    const auto found =
        figures_of(wheel(std::string(R"("end_time": 1, "step_size": 0.002, "integrator": ")") + integrator + "\"",
                         joined({figure("angle", 0.0005), figure("angle", 0.4567), figure("angle", 0.9993)})));
    for (const auto& [k, t] : {std::pair<int, double>{0, 0.0005}, {1, 0.4567}, {2, 0.9993}})
      EXPECT_NEAR(found[static_cast<std::size_t>(k)].value, angle_at(t), 1e-3) << integrator << " at " << t;
  }
}

// Rows at the start and at the end alone: all figures come from the steps.
TEST(ExpectedFigures, extremes_range_and_period_take_all_steps_and_what_is_between) {
  constexpr double pi = std::numbers::pi;
  const auto found = figures_of(wheel(
      R"("end_time": 10, "step_size": 0.01, "spectral_radius": 0.99)",
      joined({whole("angle", "max", 25, 1e-3), whole("angle", "min", -25, 1e-3), whole("angle", "range", 50, 2e-3),
              whole("angle", "period", pi, 5e-4), whole("angle", "time_of_max", 0.25 * pi, 5e-4),
              whole("rate", "max", 50, 1e-2), whole("rim.alz", "max", 100, 1e-2)})));
  for (const ExpectedResult& f : found)
    EXPECT_TRUE(f.holds) << f.name << " " << f.value << ", expected " << f.reference << ", " << f.taken;
  // The end of a step alone would be lower by up to 25 (2 h / 2)^2 / 2 = 1.2e-3; the mean of three periods is what
  // counts.
  EXPECT_EQ(found[3].taken, "mean of 2 between upward crossings of 0");
}

// The pull of the hinge of a pendulum is largest at the bottom, 3 m g, which no step ends at.
TEST(ExpectedFigures, forces_and_periods_of_a_pendulum) {
  scene::Scene scene = support::gallery(
      "pendulum", {"/analysis/end_time=5",
                   "/expected=[" +
                       joined({whole("hinge force.fy", "max", 29.43, 1e-3), whole("bob.y", "min", -1, 1e-5),
                               whole("bob.y", "time_of_min", 0.59196, 1e-4), whole("bob.y", "time_of_max", 0.0, 1e-9),
                               whole("bob.x", "period", 2.3678419475762374, 1e-4)}) +
                       "]"});
  for (const ExpectedResult& f : figures_of(scene)) EXPECT_TRUE(f.holds) << f.name << " " << f.value;
}

TEST(ExpectedFigures, a_period_without_two_crossings_says_so) {
  const auto found =
      figures_of(wheel(R"("end_time": 0.1, "step_size": 0.01)", whole("angle", "period", 3, 1, R"(, "level": -30)")));
  EXPECT_FALSE(found[0].holds);
  EXPECT_FALSE(found[0].has_value);
  EXPECT_NE(found[0].taken.find("0 upward crossings of -30"), std::string::npos) << found[0].taken;
}

TEST(ExpectedFigures, tolerances_are_absolute_relative_or_both) {
  scene::Scene scene = wheel(R"("end_time": 0.1, "step_size": 0.01)", figure("angle", 0.1, 5.0, 1e-9));
  const auto holds = [&](double value, double absolute, double relative) {
    scene.expected[0].value = value;
    scene.expected[0].tolerance = absolute;
    scene.expected[0].relative_tolerance = relative;
    return figures_of(scene)[0].holds;
  };
  const double value = figures_of(scene)[0].value;
  EXPECT_FALSE(holds(1.011 * value, 0.0, 0.01));
  EXPECT_TRUE(holds(1.009 * value, 0.0, 0.01));
  EXPECT_TRUE(holds(1.011 * value, 0.0015 * value, 0.01));
  EXPECT_TRUE(holds(-value, 2.001 * value, 0.0)) << "the sign of the value does not matter";
}

/// A cantilever under a tip moment of half a circle.
scene::Scene bent(const std::string& analysis, const std::string& expected) {
  return scene_of(R"({
    "sections": [{"name": "s", "stiffness": {"EA": 1e4, "GA2": 1e4, "GA3": 1e4, "GJ": 1, "EI2": 1, "EI3": 1}}],
    "nodes": [{"name": "root"}, {"name": "tip", "position": [1, 0, 0]}],
    "beams": [{"name": "beam", "section": "s", "start": "root", "end": "tip", "elements": 4}],
    "joints": [{"name": "wall", "kind": "fixed", "first": "ground", "second": "root", "position": [0, 0, 0]}],
    "loads": [{"at": "tip", "moment": [0, 0, 3.141592653589793]}],
    "sensors": [{"name": "tip", "kind": "position", "at": "tip"}],
    "analysis": {"kind": "static", )" +
                  analysis + R"(}, "expected": [)" + expected + "]}");
}
/// y of the tip at a load factor: (1 - cos) of the angle over the angle.
double tip_at(double factor) {
  const double angle = std::numbers::pi * factor;
  return (1.0 - std::cos(angle)) / angle;
}

TEST(ExpectedFigures, load_steps_end_where_a_figure_is_asked_for) {
  const auto found = figures_of(bent(R"("load_steps": 4)", joined({figure("tip.y", 0.31), figure("tip.y", 0.5),
                                                                   figure("tip.y", 0.9999), figure("tip.y", 0.0)})));
  EXPECT_NEAR(found[0].value, tip_at(0.31), 1e-10);
  EXPECT_NEAR(found[1].value, tip_at(0.5), 1e-10);
  EXPECT_NEAR(found[2].value, tip_at(0.9999), 1e-10);
  EXPECT_EQ(found[3].value, 0.0);
  for (const ExpectedResult& f : found) EXPECT_EQ(f.taken, "at the end of a load step") << f.name;
}

// A tip force P L^2 / EI = 20 in steps of four iterations at most, which are too few for the first ones.
TEST(ExpectedFigures, load_steps_that_are_cut_end_there_as_well) {
  scene::Scene scene = bent(R"("load_steps": 1, "max_iterations": 4, "tolerance": 1e-11)",
                            joined({figure("tip.y", 0.31), figure("tip.y", 0.62)}));
  scene.point_loads[0].moment = scene::Vec3::zero();
  const auto press = [&](double factor) { scene.point_loads[0].force = {0.0, 20.0 * factor, 0.0}; };
  press(1.0);
  const MemoryRun run = run_in_memory(scene);
  ASSERT_TRUE(run.ok()) << run.text();
  EXPECT_GT(run.summary.steps.rejected, 0);
  scene.expected.clear();
  scene.analysis.max_iterations = 30;
  for (const auto& [k, factor] : {std::pair<std::size_t, double>{0, 0.31}, {1, 0.62}}) {
    press(factor);
    EXPECT_NEAR(run.summary.expected[k].value, run_in_memory(scene).final("tip.y"), 1e-9) << factor;
  }
}

// Two springs and a block between them (verify_arc_length): the load passes 0.01 on the way up, back down, and up
// again.
TEST(ExpectedFigures, a_path_is_met_where_it_passes_the_load_factor) {
  const double base = 0.9, height = std::sqrt(1.0 - base * base);
  const auto load = [&](double y) { return 2000.0 * y * (1.0 / std::hypot(base, y) - 1.0) / 200.0; };
  const auto truss = [&](const std::string& arc) {
    return scene_of(R"({
      "bodies": [{"name": "block", "mass": 1, "inertia": [1, 1, 1], "position": [0, )" +
                    support::text(height) + R"(, 0]}],
      "joints": [{"name": "slide", "kind": "prismatic", "first": "ground", "second": "block", "axis": [0, 1, 0]}],
      "springs": [{"name": "left", "first": {"to": "ground", "position": [-0.9, 0, 0]}, "second": "block",
                   "stiffness": 1000, "rest_length": 1},
                  {"name": "right", "first": {"to": "ground", "position": [0.9, 0, 0]}, "second": "block",
                   "stiffness": 1000, "rest_length": 1}],
      "loads": [{"at": "block", "force": [0, -200, 0]}],
      "sensors": [{"name": "block", "kind": "position", "at": "block"}],
      "analysis": {"kind": "static", "tolerance": 1e-11, "arc_length": )" +
                    arc + R"(}, "expected": [)" + figure("block.y", 0.0123) + "]}");
  };
  // With and without a figure the path is the same to the last step.
  const MemoryRun once = run_in_memory(truss(R"({"step": 0.05, "end_load_factor": 0.1})"));
  ASSERT_TRUE(once.ok()) << once.text();
  EXPECT_NEAR(load(once.summary.expected[0].value), 0.0123, 1e-9);
  EXPECT_GT(once.summary.expected[0].value, 0.3) << "on the way up";
  scene::Scene scene = truss(R"({"step": 0.05, "after_limit_points": 2})");
  const MemoryRun whole_path = run_in_memory(scene);
  ASSERT_TRUE(whole_path.ok()) << whole_path.text();
  EXPECT_NEAR(load(whole_path.summary.expected[0].value), 0.0123, 1e-9);
  EXPECT_LT(whole_path.summary.expected[0].value, -0.3) << "the last time it is passed";
  scene.expected.clear();
  const MemoryRun without = run_in_memory(scene);
  ASSERT_EQ(without.rows.size(), whole_path.rows.size());
  for (std::size_t r = 0; r < without.rows.size(); ++r)
    EXPECT_NEAR(without.rows[r].values[1], whole_path.rows[r].values[1], 1e-9) << r;
}

// A scene of planar steps, whose nodes stay in lanes between rows: who reads them changes no bit.
TEST(ExpectedFigures, the_motion_is_the_same_with_and_without_them) {
  scene::Scene scene = support::gallery("four_bar_planar", {"/analysis/end_time=0.3", "/output/stride=10"});
  const MemoryRun with = run_in_memory(scene);
  scene.expected.push_back({"B0.x", scene::FigureKind::max, {}, {}, 1.0, 1.0, 0.0, ""});
  scene.expected.push_back({"B0.x", scene::FigureKind::value, 0.1234567, {}, 0.0, 1.0, 0.0, ""});
  const MemoryRun more = run_in_memory(scene);
  ASSERT_TRUE(more.ok()) << more.text();
  ASSERT_EQ(with.rows.size(), more.rows.size());
  for (std::size_t r = 0; r < with.rows.size(); ++r) EXPECT_EQ(with.rows[r].values, more.rows[r].values) << r;
}

// Steps begin anew at the breakpoint, so that no sample after it is the end of one.
TEST(Samples, times_within_steps_are_told_all_in_order) {
  scene::Scene scene = pushed(0.03, "");
  SimulateOptions options;
  for (int k = 0; k <= 10; ++k) options.stops.push_back(0.1 * k);
  std::vector<double> times, angles, accelerations;
  options.sample = [&](double time, const std::vector<double>& values) {
    times.push_back(time);
    angles.push_back(values[0]);
    accelerations.push_back(values[6]);
  };
  const MemoryRun run = run_in_memory(scene, options);
  ASSERT_TRUE(run.ok()) << run.text();
  ASSERT_EQ(run.column("rim.alz"), 6u);
  EXPECT_EQ(times, options.stops);
  for (std::size_t k = 0; k < times.size(); ++k) {
    const double past = std::max(0.0, times[k] - 0.5);
    EXPECT_NEAR(angles[k], past * past, 1e-9) << times[k];
    EXPECT_NEAR(accelerations[k], k > 5 ? 2.0 : 0.0, 1e-8) << times[k];
  }
}

TEST(Samples, load_steps_end_at_them) {
  SimulateOptions options;
  options.stops = {0.125, 0.3, 1.0};
  std::vector<double> found;
  options.sample = [&](double, const std::vector<double>& values) { found.push_back(values[1]); };
  ASSERT_TRUE(run_in_memory(bent(R"("load_steps": 3)", ""), options).ok());
  ASSERT_EQ(found.size(), 3u);
  for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(found[k], tip_at(options.stops[k]), 1e-10);
}

TEST(ExpectedFigures, a_period_of_statics_is_refused) {
  scene::Scene scene = bent(R"("load_steps": 1)", figure("tip.y", 1.0));
  scene.expected[0].time.reset();
  scene.expected[0].figure = scene::FigureKind::period;
  const auto problems = scene::problems_in(scene);
  ASSERT_EQ(problems.size(), 1u);
  EXPECT_EQ(problems[0].key, "figure");
  EXPECT_NE(problems[0].rule.find("the analysis is static"), std::string::npos);
}

}  // namespace
}  // namespace bough::run
