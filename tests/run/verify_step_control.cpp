// Step control: errors follow the tolerance, their estimate is honest, jumps are met, orders hold across changes of
// size.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "bough/laws/make_law.hpp"
#include "bough/step/step_control.hpp"
#include "order_scenes.hpp"
#include "support/stepper.hpp"

namespace bough::run {
namespace {

using support::Outcome;
using support::Table;

/// Steps of chosen sizes that end at given times.
scene::Scene controlled(scene::Scene scene, double tolerance, const std::vector<double>& times) {
  scene.analysis.step_control.emplace().tolerance = tolerance;
  scene.analysis.step_control->largest_step = 0.2 * scene.analysis.end_time;
  scene.expected.clear();
  for (double t : times) {
    scene::Expected e;
    e.quantity = "x.x";
    e.time = t;
    e.tolerance = 1.0;
    scene.expected.push_back(e);
  }
  return scene;
}

std::vector<double> times_up_to(double end, int count) {
  std::vector<double> times;
  for (int k = 1; k <= count; ++k) times.push_back(end * k / count);
  return times;
}

/// Largest error of some columns at the given times, over the largest value in the reference.
double error_of(const Table& run, const Table& reference, const std::vector<std::string>& columns,
                const std::vector<double>& times) {
  double most = 0.0, scale = 0.0;
  for (const std::string& c : columns) {
    scale = std::max(scale, reference.largest(c));
    for (double t : times) most = std::max(most, std::abs(run.at(c, t) - reference.at(c, t)));
  }
  return most / scale;
}

struct Group {
  std::string name;
  std::vector<std::string> columns;
};

/// Tolerances two decades apart: errors fall in proportion, slope 1, where positions decide the step, with
/// tolerance^(2/3) where velocities do.
void expect_slopes(const std::string& what, const scene::Scene& scene, double fixed_step, double coarsest,
                   const std::vector<Group>& groups, double least) {
  const double end = scene.analysis.end_time;
  const std::vector<double> times = times_up_to(end, 10);
  scene::Scene fine = scene;
  fine.analysis.step_size = fixed_step;
  const Outcome reference = support::run(fine);
  ASSERT_TRUE(reference.ok()) << reference.summary.cause;
  const Outcome coarse = support::run(controlled(scene, coarsest, times)),
                tight = support::run(controlled(scene, 1e-2 * coarsest, times));
  ASSERT_TRUE(coarse.ok() && tight.ok()) << coarse.summary.cause << tight.summary.cause;
  for (const Group& g : groups) {
    const double a = error_of(coarse.history, reference.history, g.columns, times),
                 b = error_of(tight.history, reference.history, g.columns, times);
    const double slope = std::log10(a / b) / 2.0;
    std::printf(
        "| %s, %s | tolerance %.0e, %.0e: error %.1e, %.1e | slope %.2f | steps %ld, %ld | rejected %ld, %ld |\n",
        what.c_str(), g.name.c_str(), coarsest, 1e-2 * coarsest, a, b, slope, coarse.summary.steps.accepted,
        tight.summary.steps.accepted, coarse.summary.steps.rejected, tight.summary.steps.rejected);
    EXPECT_GT(slope, least) << what << ", " << g.name;
    EXPECT_LT(slope, 1.25) << what << ", " << g.name;
  }
  EXPECT_GT(tight.summary.steps.size_changes, 1);
  EXPECT_LT(tight.summary.steps.size_changes, tight.summary.steps.accepted / 10);
}

scene::Scene with_sensors(scene::Scene scene, const std::string& point, const std::string& joint) {
  scene::Attachment at;
  at.to = point;
  scene.expected.clear();
  scene.sensors = {support::point_sensor("x", scene::SensorKind::position, at),
                   support::point_sensor("v", scene::SensorKind::velocity, at),
                   support::joint_sensor("f", scene::SensorKind::joint_reaction, joint)};
  return scene;
}

const std::vector<Group> p_v_lambda = {{"positions", {"x.x", "x.y", "x.z"}},
                                       {"velocities", {"v.vx", "v.vy", "v.vz"}},
                                       {"multipliers", {"f.fx", "f.fy", "f.fz"}}};

TEST(StepControl, errors_follow_the_tolerance_with_a_heavy_top) {
  scene::Scene scene =
      support::gallery("heavy_top", {"/analysis/end_time=0.4", "/analysis/step_size=5e-4", "/output/stride=1"});
  scene.expected.clear();
  scene.sensors.push_back(support::joint_sensor("f", scene::SensorKind::joint_reaction, scene.joints[0].name));
  expect_slopes("heavy top", scene, 1e-5, 1e-3,
                {{"positions", {"center.x", "center.y", "center.z"}}, {"multipliers", {"f.fx", "f.fy", "f.fz"}}}, 0.8);
}

TEST(StepControl, errors_follow_the_tolerance_with_ball_and_hinge) {
  scene::Scene scene = spatial_pendulum();
  scene.analysis.end_time = 1.0;
  scene.analysis.step_size = 0.01;
  expect_slopes("ball and hinge", with_sensors(scene, "b", "hinge"), 1e-4, 1e-3, p_v_lambda, 0.8);
}

TEST(StepControl, errors_follow_the_tolerance_with_a_flexible_pendulum) {
  scene::Scene scene = driven_beam();
  scene.analysis.end_time = 0.6;
  scene.analysis.step_size = 0.001;
  expect_slopes("driven beam", with_sensors(scene, "tip", "motor"), 1e-4, 1e-3, p_v_lambda, 0.5);
}

/// Slope of the straight line through (x, y) with the least sum of squared distances in y.
double slope_of(const std::vector<double>& x, const std::vector<double>& y) {
  double mean_x = 0.0, mean_y = 0.0, xx = 0.0, xy = 0.0;
  for (std::size_t k = 0; k < x.size(); ++k) {
    mean_x += x[k] / static_cast<double>(x.size());
    mean_y += y[k] / static_cast<double>(x.size());
  }
  for (std::size_t k = 0; k < x.size(); ++k) {
    xx += (x[k] - mean_x) * (x[k] - mean_x);
    xy += (x[k] - mean_x) * (y[k] - mean_y);
  }
  return xy / xx;
}

// The 30 to 40 steps of tolerances above 5e-3 do not resolve the vibrations: a single error there scatters by a factor
// of five, with the steps at which factorizations are renewed. The slope is therefore that of 13 tolerances.
TEST(StepControl, spin_up_comes_as_near_to_its_table_as_asked) {
  std::vector<double> tolerances, errors;
  for (int k = 0; k <= 12; ++k) {
    const double exponent = -1.0 - k / 3.0, tolerance = std::pow(10.0, exponent);
    const Outcome run =
        support::run(controlled(support::gallery("spin_up", {"/analysis/end_time=6.76"}), tolerance, {}));
    ASSERT_TRUE(run.ok()) << run.summary.cause;
    const double error =
        std::hypot(run.history.last("tip.x") + 0.809969332439257, run.history.last("tip.y") + 9.964795695443541);
    std::printf("| spin-up, tip at 6.76 s | tolerance %.1e: error %.1e m of 10 m | steps %ld |\n", tolerance, error,
                run.summary.steps.accepted);
    EXPECT_LT(error, 10.0 * tolerance) << "the structure is 10 m long";
    tolerances.push_back(exponent);
    errors.push_back(std::log10(error));
  }
  const double slope = slope_of(tolerances, errors);
  std::printf("| spin-up, tip at 6.76 s | slope %.2f |\n", slope);
  EXPECT_GT(slope, 0.65) << "2/3 where velocities of vibrations decide, 1 where positions do";
  EXPECT_LT(slope, 1.1);
}

TEST(StepControl, local_errors_add_up_to_the_error_where_nothing_makes_them_grow) {
  for (const bool is_controlled : {false, true}) {
    scene::Scene scene = support::gallery("pendulum", {"/analysis/end_time=1"});
    if (is_controlled) scene = controlled(std::move(scene), 1e-4, {});
    if (!is_controlled) scene.expected.clear();
    const Outcome run = support::run(scene);
    ASSERT_TRUE(run.ok()) << run.summary.cause;
    scene::Scene fine = scene;
    fine.analysis.step_control.reset();
    fine.analysis.step_size = 5e-5;
    const Outcome reference = support::run(fine);
    const double error = std::hypot(run.history.last("bob.x") - reference.history.last("bob.x"),
                                    run.history.last("bob.y") - reference.history.last("bob.y"));
    const records::Checks& c = run.summary.checks;
    ASSERT_TRUE(c.local_error_known);
    std::printf("| pendulum, 1 s, %s | error %.2e m of 1 m, local errors' sum %.2e, largest %.2e |\n",
                is_controlled ? "controlled" : "equal steps", error, c.local_error_sum, c.local_error_max);
    EXPECT_GT(c.local_error_sum, error / 3.0);
    EXPECT_LT(c.local_error_sum, error * 10.0);
  }
}

TEST(StepControl, meets_breakpoints_exactly_and_keeps_its_order_across_jumps) {
  // The force on b jumps at 0.2 s and 0.3 s.
  scene::Scene scene = driven_pendulum();
  scene.analysis.end_time = 0.4;
  scene.analysis.step_size = 0.002;
  scene = with_sensors(std::move(scene), "b", "cross");
  scene::PointLoad load;
  load.at.to = "b";
  load.force = {{3, -5, 4}};
  load.law = laws::make_piecewise(
      {{0.0, laws::make_constant(0.0)}, {0.2, laws::make_constant(1.0)}, {0.3, laws::make_constant(-0.5)}});
  scene.point_loads.push_back(load);
  expect_slopes("jumps of a force", scene, 5e-5, 1e-3, {p_v_lambda[1], p_v_lambda[2]},
                0.75);  // b hangs on a driven point
  const Outcome run = support::run(controlled(scene, 1e-4, {}));
  ASSERT_TRUE(run.ok());
  for (double t : {0.2, 0.3, 0.4}) EXPECT_NO_THROW((void)run.history.row_at(t)) << t;
}

TEST(StepControl, a_jump_that_no_breakpoint_tells_is_cut_down_to) {
  // A wheel on a hinge, J = 1 kg m^2: at rest until 1/3 s, then 4 rad/s^2.
  scene::Scene scene = support::scene_of(R"({
    "bodies": [{"name": "wheel", "mass": 1, "inertia": [1, 1, 1]}],
    "joints": [{"name": "hinge", "kind": "revolute", "first": "ground", "second": "wheel", "axis": [0, 0, 1]}],
    "loads": [{"at": "wheel", "moment": [0, 0, 4], "law": {"expression": "0.5*tanh((t - 1/3)*1e5) + 0.5"}}],
    "sensors": [{"name": "angle", "kind": "joint_angle", "joint": "hinge"}],
    "analysis": {"kind": "dynamic", "end_time": 1, "step_size": 0.01}})");
  const Outcome run = support::run(controlled(scene, 1e-4, {}));
  ASSERT_TRUE(run.ok()) << run.summary.cause;
  const double error = std::abs(run.history.last("angle") - 2.0 * 4.0 / 9.0);
  std::printf("| unknown jump | error %.1e rad at a tolerance of 1e-4 | %ld rejected for their error |\n", error,
              run.summary.steps.rejected_for_error);
  EXPECT_GT(run.summary.steps.rejected_for_error, 0);
  EXPECT_LT(error, 1e-3);
}

/// A driven crank with an undamped steel rod as a beam, whose bending and extension are struck by the start: the
/// velocities of the fastest vibrations would ask for a million steps a second.
constexpr const char* elastic_slider_crank = R"({
  "gravity": [0, -9.81, 0],
  "materials": [{"name": "steel", "young": 2.1e11, "poisson": 0.3, "density": 7850}],
  "sections": [{"name": "rod", "shape": {"kind": "circle", "radius": 0.01}, "material": "steel"}],
  "nodes": [{"name": "B", "position": [0.2, 0, 0]}, {"name": "C", "position": [0.8, 0, 0]}],
  "bodies": [{"name": "crank", "shape": {"kind": "box", "size": [0.2, 0.03, 0.02]}, "material": "steel",
              "position": [0.1, 0, 0]},
             {"name": "slider", "shape": {"kind": "box", "size": [0.1, 0.06, 0.06]}, "material": "steel",
              "position": [0.8, 0, 0]}],
  "beams": [{"name": "rod", "section": "rod", "start": "B", "end": "C", "elements": 8}],
  "joints": [{"name": "main bearing", "kind": "revolute", "first": "ground", "second": "crank", "axis": [0, 0, 1],
              "drives": [{"law": 6.283185307179586, "rate": true}]},
             {"name": "crank pin", "kind": "revolute", "first": "crank", "second": "B", "position": [0.2, 0, 0],
              "axis": [0, 0, 1]},
             {"name": "wrist pin", "kind": "universal", "first": "C", "second": "slider", "position": [0.8, 0, 0],
              "axis": [0, 1, 0], "second_axis": [0, 0, 1]},
             {"name": "guide", "kind": "prismatic", "first": "ground", "second": "slider", "position": [0.8, 0, 0],
              "axis": [1, 0, 0]}],
  "initial_velocities": [{"of": "crank", "velocity": [0, 0.6283185307179586, 0],
                          "angular_velocity": [0, 0, 6.283185307179586]}],
  "sensors": [{"name": "slider", "kind": "position", "at": "slider"},
              {"name": "middle", "kind": "position", "beam": "rod", "station": 0.5}],
  "analysis": {"kind": "dynamic", "end_time": 0.1, "step_size": 1e-4, "spectral_radius": 0.8}})";

/// Root of the mean square difference of the columns at the times of the run, over the range of the reference; the
/// largest of all columns that have one. The reference has many more rows.
double mean_error(const Table& run, const Table& reference) {
  double most = 0.0;
  for (std::size_t c = 0; c < reference.columns.size(); ++c) {
    double low = reference.rows[0][c], high = low, squares = 0.0;
    for (const std::vector<double>& row : reference.rows) {
      low = std::min(low, row[c]);
      high = std::max(high, row[c]);
    }
    for (std::size_t k = 0, r = 0; k < run.rows.size(); ++k) {
      while (r + 1 < reference.rows.size() && reference.times[r] < run.times[k]) ++r;
      squares += std::pow(run.rows[k][c] - reference.rows[r][c], 2);
    }
    const double mean = std::sqrt(squares / static_cast<double>(run.rows.size()));
    if (high - low > 1e-6) most = std::max(most, mean / (high - low));
  }
  return most;
}

TEST(StepControl, vibrations_that_no_sensor_sees_do_not_decide_the_step) {
  scene::Scene scene = support::scene_of(elastic_slider_crank);
  scene.analysis.step_size = 1e-5;
  const Outcome reference = support::run(scene);
  ASSERT_TRUE(reference.ok()) << reference.summary.cause;
  scene.analysis.step_size = 1e-4;
  scene.analysis.step_control.emplace().tolerance = 1e-4;
  const Outcome run = support::run(scene);
  ASSERT_TRUE(run.ok()) << run.summary.cause;
  const double slider = std::abs(run.history.last("slider.x") - reference.history.last("slider.x")),
               middle = std::hypot(run.history.last("middle.x") - reference.history.last("middle.x"),
                                   run.history.last("middle.y") - reference.history.last("middle.y"));
  std::string limit;
  for (const std::string& note : run.summary.notes)
    if (note.find("decided the size") != std::string::npos) limit = note;
  std::printf("| elastic slider-crank, 0.1 s | %ld steps | error %.1e m of the slider, %.1e m of the rod | %s |\n",
              run.summary.steps.accepted, slider, middle, limit.c_str());
  EXPECT_LT(run.summary.steps.accepted, 4000);
  EXPECT_LT(slider, 1e-4);
  EXPECT_LT(middle, 1e-4);
  EXPECT_NE(limit.find("beam 'rod'"), std::string::npos) << limit;
}

scene::Sensor sensor_of(scene::SensorKind kind) {
  scene::Sensor sensor;
  sensor.name = "s";
  sensor.kind = kind;
  return sensor;
}

/// The same crank, of which sensors show a force, an acceleration or energies. Where errors count at every node, each
/// of these runs takes some 65 000 steps.
TEST(StepControl, forces_and_energies_do_not_ask_for_every_vibration) {
  using Kind = scene::SensorKind;
  struct Case {
    const char* what;
    Kind kind;
    double error;  ///< root of the mean square, of the range; forces are mostly vibrations' own
  };
  const Case cases[] = {{"reaction", Kind::joint_reaction, 0.3},
                        {"acceleration", Kind::acceleration, 0.3},
                        {"kinetic energy", Kind::kinetic_energy, 0.1},
                        {"strain energy", Kind::strain_energy, 0.1},
                        {"potential energy", Kind::potential_energy, 0.01},
                        {"total energy", Kind::total_energy, 0.1}};
  for (const Case& c : cases) {
    scene::Scene scene = support::scene_of(elastic_slider_crank);
    scene.analysis.end_time = 0.02;
    scene.sensors = {sensor_of(c.kind)};
    scene.sensors[0].joint = c.kind == Kind::joint_reaction ? "main bearing" : "";
    scene.sensors[0].at.to = c.kind == Kind::acceleration ? "slider" : "";
    scene.analysis.step_size = 2e-6;
    const Outcome reference = support::run(scene);
    scene.analysis.step_size = 1e-4;
    scene.analysis.step_control.emplace().tolerance = 1e-4;
    const Outcome run = support::run(scene, [&](const records::Progress& p) { return p.step < 2000; });
    ASSERT_TRUE(reference.ok() && run.ok()) << c.what << run.summary.cause;
    const double error = mean_error(run.history, reference.history);
    std::printf("| elastic slider-crank, 0.02 s, %s | %ld steps | error %.2g of the range |\n", c.what,
                run.summary.steps.accepted, error);
    EXPECT_LT(run.summary.steps.accepted, 1000) << c.what;
    EXPECT_LT(error, c.error) << c.what;
  }
}

/// Nothing else is shown, and yet the motion is kept.
TEST(StepControl, errors_of_energies_follow_the_tolerance) {
  for (const auto kind : {scene::SensorKind::kinetic_energy, scene::SensorKind::potential_energy}) {
    const char* const what = kind == scene::SensorKind::kinetic_energy ? "kinetic" : "potential";
    scene::Scene scene = support::gallery("double_pendulum", {"/analysis/end_time=1"});
    scene.sensors = {sensor_of(kind)};
    const std::vector<double> times = times_up_to(1.0, 10);
    double errors[2];
    scene.expected.clear();
    scene.analysis.step_size = 1e-4;
    const Outcome reference = support::run(scene);
    for (int k = 0; k < 2; ++k) {
      scene::Scene steps = controlled(scene, k == 0 ? 1e-3 : 1e-5, times);
      for (scene::Expected& e : steps.expected) e.quantity = "s";
      const Outcome run = support::run(steps);
      ASSERT_TRUE(run.ok() && reference.ok()) << run.summary.cause;
      errors[k] = error_of(run.history, reference.history, {"s"}, times);
      std::printf("| double pendulum, %s | error %.1e | %ld steps |\n", what, errors[k], run.summary.steps.accepted);
    }
    EXPECT_GT(std::log10(errors[0] / errors[1]) / 2.0, 0.8) << what;
    EXPECT_LT(errors[1], 1e-3) << what;
  }
}

TEST(StepControl, cuts_a_first_step_that_is_far_too_long) {
  scene::Scene scene =
      controlled(support::gallery("pendulum", {"/analysis/end_time=1", "/analysis/step_size=0.1"}), 1e-9, {});
  scene.analysis.step_control->largest_step = 0.1;
  const Outcome run = support::run(scene, [](const records::Progress& p) { return p.step < 5; });
  EXPECT_GT(run.summary.steps.rejected_for_error, 5) << "from 0.1 s down to microseconds";
  EXPECT_TRUE(std::any_of(run.summary.notes.begin(), run.summary.notes.end(), [](const std::string& note) {
    return note.find("the first rejected step was that from 0.000000: the local error of the ") == 0 &&
           note.find(" times what the tolerance of step control allows") != std::string::npos;
  })) << "a step rejected for its error says for which";
}

/// A slider at rest, and an oscillation of two states of the size a with 30 rad/s:  u = a cos(30 t), w = a sin(30 t).
std::string quiet(double size, const std::string& nominal) {
  const std::string a = support::text(size);
  return R"-({"analysis": {"kind": "dynamic", "end_time": 2, "step_size": 1e-3, "step_control": {"tolerance": 1e-4}},
  "bodies": [{"name": "slider", "mass": 2, "inertia": [1, 1, 1]}],
  "joints": [{"name": "rail", "kind": "prismatic", "first": "ground", "second": "slider", "axis": [1, 0, 0],
              "forces": [{"stiffness": 10, "damping": 1}]}],
  "signals": [{"name": "u", "kind": "state", "expression": "-30*w", "start": )-" +
         a + nominal + R"-(}, {"name": "w", "kind": "state", "expression": "30*u", "start": 0)-" + nominal + R"-(}],
  "sensors": [{"name": "x", "kind": "joint_displacement", "joint": "rail"},
              {"name": "u", "kind": "signal", "signal": "u"}]})-";
}

Outcome quiet_run(double size, const std::string& nominal, double tolerance) {
  return support::run_ok(
      support::scene_of(quiet(size, nominal),
                        {"/analysis/step_control/tolerance=" + support::text(tolerance), "/analysis/tolerance=1e-11"}));
}

// The mechanism alone would let steps grow to a fiftieth of the run, 40 ms. A step of local error tol^(3/2) has
// h ~ tol^(1/2), so the error of the states follows the tolerance.
// A mass on a spring alone: of the shares that limit a step, e_q / tolerance^(3/2) and e_v / tolerance, the second is
// the larger one above the tolerance (e_q / e_v)^2, where both are equal.
TEST(StepControl, tells_whether_places_or_velocities_limit_a_step) {
  const scene::Scene scene = support::scene_of(R"-({
  "bodies": [{"name": "mass", "mass": 2, "inertia": [1, 1, 1], "position": [1, 0, 0]}],
  "joints": [{"name": "rail", "kind": "prismatic", "first": "ground", "second": "mass", "axis": [1, 0, 0],
              "forces": [{"stiffness": 200, "rest": 0.3}]}],
  "analysis": {"kind": "dynamic", "end_time": 1, "step_size": 0.01, "step_control": {}}})-");
  constexpr double h = 0.01;
  support::Stepper s(scene);
  s.start(h);
  step::LocalError error(s.system(), s.options(), 1.0);
  for (int k = 1; k <= 8; ++k) {
    if (k > 1) error.accept(s.state());
    s.step(k * h);
    ASSERT_FALSE(error.measure(s.system(), s.state()));
  }
  const double ratio = error.relative_motion() / error.relative_velocity(), both = ratio * ratio;
  EXPECT_GT(both, 0.0);
  EXPECT_TRUE(error.limit(1.01 * both).is_velocity);
  EXPECT_FALSE(error.limit(0.99 * both).is_velocity);
}

TEST(StepControl, a_fast_state_beside_a_quiet_mechanism_decides_the_steps) {
  const double exact = std::cos(60.0);
  std::vector<double> errors;
  for (const double tolerance : {1e-3, 1e-4, 1e-5}) {
    const Outcome r = quiet_run(1.0, "", tolerance);
    errors.push_back(std::abs(r.history.last("u") - exact));
    EXPECT_LT(errors.back(), 60.0 * tolerance);  // 60 rad of a motion whose error per rad is below the tolerance
    EXPECT_LT(r.summary.step_size, 0.5 * std::sqrt(tolerance));
    EXPECT_TRUE(std::any_of(r.summary.notes.begin(), r.summary.notes.end(), [](const std::string& note) {
      return note.find("for the error of the state '") != std::string::npos;
    }));
  }
  EXPECT_NEAR(std::log10(errors[0] / errors[1]), 1.0, 0.2);
  EXPECT_NEAR(std::log10(errors[1] / errors[2]), 1.0, 0.2);
}

// A state of the size 1e-6 is watched as one of the size 1 if that is its nominal size, and not at all if that is 1.
TEST(StepControl, errors_of_states_are_relative_to_their_nominal_size) {
  const Outcome one = quiet_run(1.0, "", 1e-4), small = quiet_run(1e-6, R"(, "nominal": 1e-6)", 1e-4);
  const auto steps = static_cast<double>(one.summary.steps.accepted);
  EXPECT_NEAR(static_cast<double>(small.summary.steps.accepted), steps, 0.02 * steps);
  EXPECT_NEAR(small.history.last("u"), 1e-6 * one.history.last("u"), 1e-10);
  EXPECT_LT(static_cast<double>(quiet_run(1e-6, "", 1e-4).summary.steps.accepted), 0.25 * steps);
}

// A lag of 5 ms that a jump wakes after a second of rest:  x = 1 - exp(-200 (t - 1)).
TEST(StepControl, a_state_that_jumps_is_met_again) {
  const Outcome r = support::run_ok(support::scene_of(R"-({
  "analysis": {"kind": "dynamic", "end_time": 2, "step_size": 1e-3, "tolerance": 1e-11,
               "step_control": {"tolerance": 1e-4}},
  "bodies": [{"name": "slider", "mass": 2, "inertia": [1, 1, 1]}],
  "joints": [{"name": "rail", "kind": "prismatic", "first": "ground", "second": "slider", "axis": [1, 0, 0],
              "forces": [{"stiffness": 10, "damping": 1}]}],
  "signals": [{"name": "u", "kind": "time", "law": {"expression": "step(t - 1)"}},
              {"name": "x", "kind": "state", "expression": "200*(u - x)"}],
  "sensors": [{"name": "at", "kind": "joint_displacement", "joint": "rail"},
              {"name": "x", "kind": "signal", "signal": "x"}],
  "expected": [{"quantity": "x", "time": 1.005, "value": 0.63212055882856, "tolerance": 1e-3,
                "source": "1 - exp(-1)"},
               {"quantity": "x", "value": 1, "tolerance": 1e-6, "source": "the end of the lag"}]})-"));
  for (const records::ExpectedResult& figure : r.summary.expected) EXPECT_TRUE(figure.holds) << figure.value;
}

}  // namespace
}  // namespace bough::run
