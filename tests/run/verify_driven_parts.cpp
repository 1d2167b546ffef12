// Springs and gravity that signals drive: laws of the same value, closed forms, Runge-Kutta, orders of convergence.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "bough/laws/make_law.hpp"
#include "support/scenes.hpp"

namespace bough::run {
namespace {

using support::Outcome;
using support::run_ok;
using support::scene_of;

struct Way {
  const char* integrator;
  const char* without;
  double order;
};
const Way ways[] = {{"generalized_alpha", "[]", 2.0},
                    {"generalized_alpha", "[\"translation\", \"line\"]", 2.0},
                    {"generalized_alpha", "[\"planar\", \"translation\", \"line\"]", 2.0},
                    {"bdf", "[]", 3.0},
                    {"bdf", "[\"planar\", \"translation\", \"line\"]", 3.0}};

/// Expects the order of the scheme, in every dimension, of the last values of some columns.
void expect_order(const std::string& json, double step, const std::vector<std::pair<std::string, double>>& exact) {
  for (const Way& way : ways) {
    SCOPED_TRACE(std::string(way.integrator) + " without " + way.without);
    const auto run = [&](double h) {
      return run_ok(
          scene_of(json, {std::string("/analysis/integrator=") + way.integrator, std::string("/without=") + way.without,
                          "/analysis/tolerance=1e-11", "/analysis/step_size=" + support::text(h)}));
    };
    const Outcome coarse = run(step), fine = run(0.5 * step);
    for (const auto& [column, value] : exact)
      EXPECT_NEAR(
          std::log2(std::abs(coarse.history.last(column) - value) / std::abs(fine.history.last(column) - value)),
          way.order, 0.25)
          << column;
  }
}

/// A pendulum of a rigid arm and a beam, with its gravity.
std::string pendulum(const std::string& gravity) {
  return R"-({"gravity": )-" + gravity + R"-(,
  "analysis": {"kind": "dynamic", "end_time": 0.5, "step_size": 5e-3, "tolerance": 1e-11},
  "sections": [{"name": "rod", "stiffness": {"EA": 1e5, "GA2": 4e4, "GA3": 4e4, "GJ": 40, "EI2": 50, "EI3": 50},
    "mass": {"mass_per_length": 0.8, "rotary": [0.002, 0.001, 0.001]}}],
  "nodes": [{"name": "elbow", "position": [0.6, 0, 0]}, {"name": "tip", "position": [1.4, 0.2, 0]}],
  "bodies": [{"name": "arm", "mass": 1.5, "center_of_mass": [0.35, 0.05, 0], "inertia": [0.02, 0.06, 0.06]},
    {"name": "bob", "kind": "point_mass", "mass": 0.4, "position": [1.4, 0.2, 0]}],
  "beams": [{"name": "rod", "section": "rod", "start": "elbow", "end": "tip", "elements": 3, "order": 2}],
  "joints": [
    {"name": "shoulder", "kind": "revolute", "first": "ground", "second": "arm", "axis": [0, 0, 1]},
    {"name": "hinge", "kind": "revolute", "first": "arm", "second": "elbow", "position": [0.6, 0, 0],
     "axis": [0, 0, 1]},
    {"name": "glue", "kind": "fixed", "first": "tip", "second": "bob"}],
  "signals": [{"name": "pull", "kind": "time", "law": {"expression": "1 + 0.5*sin(9*t)"}},
    {"name": "down", "kind": "formula", "expression": "-9.81*pull"}],
  "sensors": [{"name": "angle", "kind": "joint_angle", "joint": "shoulder"},
    {"name": "bend", "kind": "joint_angle", "joint": "hinge"}, {"name": "tip", "kind": "position", "at": "tip"},
    {"name": "load", "kind": "joint_reaction", "joint": "shoulder"}]})-";
}

// A factor that a signal gives is the factor of a law: weights along beams are integrated as inertia is. The bound
// allows for the tolerance of Newton's method in 100 steps.
TEST(DrivenParts, gravity_of_a_signal_is_that_of_its_law) {
  for (const char* without : {"[]", "[\"planar\"]"}) {
    const std::string how = std::string("/without=") + without;
    const Outcome law =
        run_ok(scene_of(pendulum(R"-({"vector": [0, -9.81, 0], "law": {"expression": "1 + 0.5*sin(9*t)"}})-"), {how}));
    for (const char* signal : {R"-({"vector": [0, -9.81, 0], "law": {"signal": "pull"}})-",
                               R"-({"components": [0, {"signal": "down"}, 0]})-"}) {
      const Outcome given = run_ok(scene_of(pendulum(signal), {how}));
      for (const char* column : {"angle", "bend", "tip.x", "tip.y"})
        EXPECT_NEAR(given.history.last(column), law.history.last(column), 1e-9) << column << signal << without;
      EXPECT_NEAR(given.history.last("load.fy"), law.history.last("load.fy"), 1e-6) << signal << without;
    }
  }
}

// Free fall under g x, x' = -2 x, x(0) = 1:  v = -g (1 - exp(-2 t)) / 2,  y = -g (t - (1 - exp(-2 t)) / 2) / 2.
TEST(DrivenParts, a_state_drives_gravity_to_the_order_of_the_motion) {
  const double t = 1.0, fade = std::exp(-2.0 * t);
  expect_order(R"-({"gravity": {"vector": [0, -9.81, 0], "law": {"signal": "x"}},
  "analysis": {"kind": "dynamic", "end_time": 1, "step_size": 0.02},
  "bodies": [{"name": "stone", "mass": 2, "inertia": [0.5, 0.5, 0.5]}],
  "signals": [{"name": "x", "kind": "state", "expression": "-2*x", "start": 1}],
  "sensors": [{"name": "at", "kind": "position", "at": "stone"}, {"name": "v", "kind": "velocity", "at": "stone"}]})-",
               0.02, {{"v.vy", -9.81 * 0.5 * (1.0 - fade)}, {"at.y", -9.81 * 0.5 * (t - 0.5 * (1.0 - fade))}});
}

/// A mass on a spring along x, at rest at 1 m.
std::string oscillator(const std::string& spring, const std::string& signals) {
  return R"-({"analysis": {"kind": "dynamic", "end_time": 1, "step_size": 0.01},
  "bodies": [{"name": "mass", "mass": 2, "inertia": [0.5, 0.5, 0.5], "position": [1, 0, 0]}],
  "joints": [{"name": "rail", "kind": "prismatic", "first": "ground", "second": "mass", "axis": [1, 0, 0]}],
  "springs": [{"name": "spring", "first": "ground", "second": "mass", "stiffness": 128)-" +
         spring + R"-(}],
  "signals": [)-" +
         signals + R"-(],
  "sensors": [{"name": "x", "kind": "joint_displacement", "joint": "rail"},
    {"name": "v", "kind": "joint_rate", "joint": "rail"}]})-";
}

// A rest length 1 + a sin(5 t) forces the oscillator with w = 8 rad/s:
//   x = a w^2 / (w^2 - 25) (sin 5 t - 5 / w sin w t)
TEST(DrivenParts, a_rest_length_forces_an_oscillator) {
  const double a = 0.1, w = 8.0, size = a * w * w / (w * w - 25.0);
  const double x = size * (std::sin(5.0) - 5.0 / w * std::sin(w)), v = 5.0 * size * (std::cos(5.0) - std::cos(w));
  const char* const driven[] = {R"-(, "rest_law": {"signal": "length"})-",
                                R"-(, "rest_law": {"expression": "1 + 0.1*sin(5*t)"})-"};
  for (const char* spring : driven)
    expect_order(
        oscillator(spring, R"-({"name": "length", "kind": "time", "law": {"expression": "1 + 0.1*sin(5*t)"}})-"),
        0.0025, {{"x", x}, {"v", v}});
}

// A stiffness that follows the length with a lag, against Runge-Kutta of order 4 in steps of 10 us.
TEST(DrivenParts, a_stiffness_that_follows_the_motion_agrees_with_runge_kutta) {
  using Y = std::array<double, 3>;  // x - 1, v, factor
  const auto rates = [](const Y& y) -> Y {
    return {y[1], -64.0 * y[2] * (y[0] - 0.2), (1.0 + 2.0 * y[0] - y[2]) / 0.1};
  };
  Y y{0.0, 0.0, 1.0};
  const double h = 1e-5;
  const auto moved = [](const Y& a, double s, const Y& b) {
    return Y{a[0] + s * b[0], a[1] + s * b[1], a[2] + s * b[2]};
  };
  for (int k = 0; k < 100000; ++k) {
    const Y a = rates(y), b = rates(moved(y, 0.5 * h, a)), c = rates(moved(y, 0.5 * h, b)), d = rates(moved(y, h, c));
    for (std::size_t i = 0; i < 3; ++i) y[i] += h / 6.0 * (a[i] + 2.0 * b[i] + 2.0 * c[i] + d[i]);
  }
  expect_order(oscillator(R"-(, "rest_length": 1.2, "stiffness_factor": {"signal": "factor"})-",
                          R"-({"name": "way", "kind": "joint_displacement", "joint": "rail"},
      {"name": "factor", "kind": "state", "expression": "(1 + 2*way - factor)/0.1", "start": 1})-"),
               0.0025, {{"x", y[0]}, {"v", y[1]}});
}

// Driven by numbers, a spring is the spring of these numbers, damper included; energies balance.
TEST(DrivenParts, a_spring_of_constant_laws_is_a_spring) {
  const auto run = [](const std::string& spring) {
    return run_ok(scene_of(R"-({"gravity": [0, 0, -9.81],
  "analysis": {"kind": "dynamic", "end_time": 0.5, "step_size": 5e-3, "tolerance": 1e-11},
  "bodies": [{"name": "mass", "mass": 2, "inertia": [0.5, 0.6, 0.7], "position": [1, 0.2, 0]}],
  "springs": [{"name": "spring", "first": "ground", "second": {"to": "mass", "position": [0.9, 0.2, 0.1]},
    "stiffness": 300, "damping": 5)-" +
                           spring + R"-(}],
  "sensors": [{"name": "at", "kind": "position", "at": "mass"}, {"name": "turn", "kind": "quaternion", "at": "mass"}]})-"));
  };
  const Outcome plain = run(R"-(, "rest_length": 0.7)-"),
                driven = run(R"-(, "rest_law": 0.7, "stiffness_factor": {"expression": "1"})-");
  for (const char* column : {"at.x", "at.y", "at.z", "turn.q1", "turn.q3"})
    EXPECT_NEAR(driven.history.last(column), plain.history.last(column), 1e-10) << column;
  EXPECT_LT(driven.summary.checks.energy_balance, 1e-2 * driven.summary.checks.energy_scale);
}

// The derivatives by the length and by the signal are exact: Newton's method reaches round-off from a far start in six
// iterations (rates of convergence: verify_statics_newton). A weight of 20 N, a factor that grows with the length.
TEST(DrivenParts, statics_need_few_iterations_from_afar) {
  const Outcome out = run_ok(scene_of(R"-({"analysis": {"kind": "static", "tolerance": 1e-12},
  "bodies": [{"name": "mass", "mass": 2, "inertia": [0.5, 0.5, 0.5], "position": [1, 0, 0]}],
  "joints": [{"name": "rail", "kind": "prismatic", "first": "ground", "second": "mass", "axis": [1, 0, 0]}],
  "springs": [{"name": "spring", "first": "ground", "second": "mass", "stiffness": 128, "rest_length": 1,
    "stiffness_factor": {"signal": "factor"}}],
  "loads": [{"at": "mass", "force": [20, 0, 0]}],
  "signals": [{"name": "way", "kind": "joint_displacement", "joint": "rail"},
    {"name": "factor", "kind": "formula", "expression": "1 + 3*way^2"}],
  "sensors": [{"name": "x", "kind": "joint_displacement", "joint": "rail"}]})-"));
  double x = 0.1;  // 128 (1 + 3 x^2) x = 20
  for (int k = 0; k < 50; ++k) x -= (128.0 * (x + 3.0 * x * x * x) - 20.0) / (128.0 * (1.0 + 9.0 * x * x));
  EXPECT_NEAR(out.history.last("x"), x, 1e-12);
  EXPECT_LE(out.summary.steps.newton_iterations, 6);
}

/// A mass on a rail along x from 1 m, and a spring of rest length 0.5 m with the given members.
std::string on_rail(const std::string& spring, double v0, double end, const std::string& signals = "") {
  return R"-({"parameters": {"m": 2},
  "analysis": {"kind": "dynamic", "end_time": )-" +
         support::text(end) + R"-(, "step_size": 0.01},
  "bodies": [{"name": "mass", "mass": {"expression": "m"}, "inertia": [0.5, 0.5, 0.5], "position": [1, 0, 0]}],
  "joints": [{"name": "rail", "kind": "prismatic", "first": "ground", "second": "mass", "axis": [1, 0, 0]}],
  "initial_velocities": [{"of": "mass", "velocity": [)-" +
         support::text(v0) + R"-(, 0, 0]}],
  "springs": [{"name": "spring", "first": {"to": "ground", "position": [0, 0, 0]}, "second": "mass", )-" +
         spring + R"-(}],
  "signals": [{"name": "pull", "kind": "spring_tension", "spring": "spring"})-" +
         signals + R"-(],
  "sensors": [{"name": "x", "kind": "joint_displacement", "joint": "rail"},
    {"name": "pull", "kind": "signal", "signal": "pull"},
    {"name": "v", "kind": "joint_rate", "joint": "rail"}, {"name": "strain", "kind": "strain_energy"},
    {"name": "all", "kind": "total_energy"}]})-";
}

// A cubic spring, m s'' = -k s^3 from s = A at rest: after a quarter of the period, K(1/sqrt 2) / (A sqrt(k/m)), the
// spring is free, and all of k A^4 / 4 is motion.
TEST(DrivenParts, a_cubic_spring_keeps_its_period_and_its_energy) {
  const double A = 0.5, m = 2.0, root = std::comp_ellint_1(std::sqrt(0.5)) / A, k = m * root * root;  // ends at 1 s
  const double v = -A * A * std::sqrt(0.5 * k / m);
  const std::string cube =
      R"-("rest_length": 0.5, "force_law": {"expression": ")-" + support::text(k) + "*stretch^3\"}";
  const std::string of_length =
      R"-("force_law": {"expression": "0.5*m*)-" + support::text(root * root) + "*2*(length - 0.5)^3\"}";
  for (const std::string& spring : {cube, of_length})
    expect_order(on_rail(spring, 0.0, 1.0), 0.005, {{"x", -A}, {"v", v}});
  const Outcome out = run_ok(scene_of(on_rail(cube, 0.0, 1.0), {"/analysis/step_size=1e-3"}));
  const std::vector<double> strain = out.history.of("strain");
  EXPECT_NEAR(strain.front(), 0.25 * k * std::pow(A, 4), 1e-12 * strain.front());
  EXPECT_LT(strain.back(), 1e-12 * strain.front());
  EXPECT_LT(out.summary.checks.energy_balance, 2e-5 * out.summary.checks.energy_scale);
}

// A damper of force c v |v|:  v = v0 / (1 + w t), x = m / c ln(1 + w t), w = c v0 / m.
TEST(DrivenParts, a_quadratic_damper_slows_a_mass_down) {
  const double w = 1.5 * 3.0 / 2.0, end = 1.0;
  expect_order(on_rail(R"-("force_law": {"expression": "1.5*rate*abs(rate)"})-", 3.0, end), 0.005,
               {{"x", 2.0 / 1.5 * std::log(1.0 + w * end)}, {"v", 3.0 / (1.0 + w * end)}});
}

// A stop of which half a period is spent in contact: it gives back the speed, and a table is the spring of its slope.
TEST(DrivenParts, a_one_sided_table_gives_back_the_speed) {
  const double k = 800.0, gap = 0.4, v = 2.0, w = std::sqrt(k / 2.0), contact = 3.14159265358979324 / w;
  const double end = gap / v + contact + 0.1;
  const Outcome out =
      run_ok(scene_of(on_rail(R"-("force_law": {"kind": "table", "times": [0, 0.6], "values": [-480, 0]})-", -v, end),
                      {"/analysis/step_size=1e-4", "/analysis/spectral_radius=0.99"}));
  EXPECT_NEAR(out.history.last("v"), v, 1e-4);
  EXPECT_NEAR(out.history.last("x"), -gap + v * 0.1, 1e-4);
  const std::vector<double> x = out.history.of("x"), strain = out.history.of("strain");
  EXPECT_NEAR(*std::min_element(x.begin(), x.end()), -gap - v / w, 1e-6);
  EXPECT_NEAR(*std::max_element(strain.begin(), strain.end()), 0.5 * 2.0 * v * v, 1e-4);
  EXPECT_LT(out.summary.checks.energy_balance, 1e-4 * out.summary.checks.energy_scale);
}

// A formula of length and rate that is linear is a spring with a damper: motion, strain energy, balance. One that names
// a signal has the same force, and its work is counted.
TEST(DrivenParts, a_linear_formula_is_a_spring_with_a_damper) {
  const char* const one = R"-(, {"name": "one", "kind": "time", "law": 1})-";
  const auto run = [&](const std::string& spring) {
    return run_ok(scene_of(on_rail(spring, 1.0, 1.0, one), {"/analysis/tolerance=1e-12", "/analysis/step_size=2e-3"}));
  };
  const Outcome plain = run(R"-("rest_length": 0.5, "stiffness": 90, "damping": 3)-"),
                driven = run(R"-("rest_length": 0.5, "force_law": {"expression": "45*m*stretch + 3*rate"})-"),
                mixed = run(R"-("rest_length": 0.5, "stiffness": 40, "damping": 1,
                               "force_law": {"expression": "50*(length - 0.5) + rate*m"})-"),
                named = run(R"-("rest_length": 0.5, "force_law": {"expression": "one*90*stretch + 3*rate"})-");
  for (const Outcome* out : {&driven, &mixed, &named}) {
    for (const char* column : {"x", "v"})
      EXPECT_NEAR(out->history.last(column), plain.history.last(column), 1e-10) << column;
    EXPECT_NEAR(out->history.last("pull"), plain.history.last("pull"), 1e-8);
  }
  for (const Outcome* out : {&driven, &mixed}) {
    EXPECT_NEAR(out->history.last("strain"), plain.history.last("strain"), 1e-9);
    EXPECT_NEAR(out->history.last("all"), plain.history.last("all"), 1e-9);
  }
  EXPECT_EQ(named.history.last("strain"), 0.0);
  for (const Outcome* out : {&plain, &driven, &mixed, &named})
    EXPECT_LT(out->summary.checks.energy_balance, 2e-4 * out->summary.checks.energy_scale);
}

// Of the efforts along one hinge, the one that is a law of its angle, -8 q^3, stores 2 q^4; a law of the angle of
// another hinge does work.
TEST(DrivenParts, an_effort_of_its_own_coordinate_alone_stores_energy) {
  const Outcome out = run_ok(scene_of(R"-({"analysis": {"kind": "dynamic", "end_time": 1, "step_size": 1e-3},
  "bodies": [{"name": "A", "mass": 1, "inertia": [1, 1, 1]}, {"name": "B", "mass": 1, "inertia": [1, 1, 1]}],
  "joints": [{"name": "a", "kind": "revolute", "first": "ground", "second": "A", "axis": [0, 0, 1],
     "forces": [{"damping": 0.2}, {"effort": {"signal": "own"}}, {"effort": {"signal": "other"}}]},
    {"name": "b", "kind": "revolute", "first": "ground", "second": "B", "axis": [0, 0, 1]}],
  "initial_velocities": [{"of": "B", "angular_velocity": [0, 0, 1.5]}],
  "signals": [{"name": "qa", "kind": "joint_angle", "joint": "a"}, {"name": "qb", "kind": "joint_angle", "joint": "b"},
    {"name": "own", "kind": "function", "of": "qa", "law": {"expression": "-8*t^3"}},
    {"name": "other", "kind": "function", "of": "qb", "law": {"expression": "2*t"}}],
  "sensors": [{"name": "angle", "kind": "joint_angle", "joint": "a"}, {"name": "strain", "kind": "strain_energy"}]})-"));
  const double angle = out.history.last("angle");
  EXPECT_GT(angle, 0.2);
  EXPECT_NEAR(out.history.last("strain"), 2.0 * std::pow(angle, 4), 1e-12);
  EXPECT_LT(out.summary.checks.energy_balance, 1e-5 * out.summary.checks.energy_scale);
}

// A rubber cord in space: its strain energy is the integral of its table.
TEST(DrivenParts, a_cord_stores_the_integral_of_its_table) {
  const Outcome out = run_ok(scene_of(R"-({"gravity": [0, 0, -9.81],
  "analysis": {"kind": "dynamic", "end_time": 0.5, "step_size": 1e-3, "tolerance": 1e-11, "spectral_radius": 0.95},
  "bodies": [{"name": "bob", "mass": 2, "inertia": [0.5, 0.6, 0.7], "position": [0.3, 0.2, -1]}],
  "springs": [{"name": "cord", "first": "ground", "second": {"to": "bob", "position": [0.1, 0, 0.2]},
    "force_law": {"kind": "table", "times": [0, 0.7, 0.9, 1.4], "values": [0, 0, 30, 70], "interpolation": "monotone"}}],
  "initial_velocities": [{"of": "bob", "velocity": [0.5, 1, 0], "angular_velocity": [1, -2, 0.5]}],
  "sensors": [{"name": "end", "kind": "position", "at": {"to": "bob", "position": [0.1, 0, 0.2]}},
    {"name": "strain", "kind": "strain_energy"}]})-"));
  const laws::Law energy =
      laws::make_table({0, 0.7, 0.9, 1.4}, {0, 0, 30, 70}, laws::Interpolation::monotone).integral(0.0);
  const double length = std::hypot(out.history.last("end.x"), out.history.last("end.y"), out.history.last("end.z"));
  const double rest = std::hypot(0.4, 0.2, 0.8);  // where the energy is 0: the length at the start
  EXPECT_NEAR(out.history.last("strain"), energy.at(length).value - energy.at(rest).value, 1e-9);
  EXPECT_GT(std::abs(out.history.last("strain")), 0.1);
  EXPECT_LT(out.summary.checks.energy_balance, 1e-4 * out.summary.checks.energy_scale);
}

// Statics against a stop behind a gap: 100 N on a spring of 50 N/m, and 500 (s - 0.8)^1.5 beyond 0.8 m.
TEST(DrivenParts, statics_press_a_stop_behind_a_gap) {
  const Outcome out = run_ok(scene_of(R"-({"analysis": {"kind": "static", "tolerance": 1e-12, "load_steps": 4},
  "bodies": [{"name": "mass", "mass": 2, "inertia": [0.5, 0.5, 0.5], "position": [1, 0, 0]}],
  "joints": [{"name": "rail", "kind": "prismatic", "first": "ground", "second": "mass", "axis": [1, 0, 0]}],
  "springs": [{"name": "spring", "first": "ground", "second": "mass", "stiffness": 50, "rest_length": 1,
    "force_law": {"expression": "500*max(0, stretch - 0.8)^1.5"}}],
  "loads": [{"at": "mass", "force": [100, 0, 0]}],
  "sensors": [{"name": "x", "kind": "joint_displacement", "joint": "rail"}, {"name": "strain", "kind": "strain_energy"}]})-"));
  double x = 1.0;
  for (int k = 0; k < 50; ++k)
    x -= (50.0 * x + 500.0 * std::pow(x - 0.8, 1.5) - 100.0) / (50.0 + 750.0 * std::sqrt(x - 0.8));
  EXPECT_NEAR(out.history.last("x"), x, 1e-10);
  EXPECT_NEAR(out.history.last("strain"), 25.0 * x * x + 200.0 * std::pow(x - 0.8, 2.5), 1e-9);
}

/// A body on a bushing along x and another about z, their stiffness times a factor: m x'' = -f k x, x = 0 at the start.
std::string on_bushings(const std::string& factor, double k, double v0) {
  const std::string stiffness = support::text(k), speed = support::text(v0);
  return R"-({"analysis": {"kind": "dynamic", "end_time": 1, "step_size": 0.01},
  "bodies": [{"name": "slider", "mass": 2, "inertia": [0.5, 0.6, 0.7]},
    {"name": "wheel", "mass": 3, "inertia": [1.5, 1.6, 2], "position": [0, 1, 0]}],
  "bushings": [
    {"name": "axial", "first": "ground", "second": "slider", "stiffness": [)-" +
         stiffness + ", 500, 500, 90, 90, 90], \"stiffness_factor\": " + factor + R"-(},
    {"name": "torsional", "first": "ground", "second": "wheel", "stiffness": [900, 900, 900, 90, 90, )-" +
         stiffness + "], \"stiffness_factor\": " + factor + R"-(}],
  "initial_velocities": [{"of": "slider", "velocity": [)-" +
         speed + R"-(, 0, 0]}, {"of": "wheel", "angular_velocity": [0, 0, )-" + speed + R"-(]}],
  "signals": [{"name": "of_time", "kind": "time", "law": {"expression": "1/(1 + t)^2"}},
    {"name": "s", "kind": "state", "expression": "-s^2", "start": 1},
    {"name": "square", "kind": "formula", "expression": "s^2"},
    {"name": "way", "kind": "position", "at": "slider", "axis": "x"}],
  "sensors": [{"name": "at", "kind": "position", "at": "slider"}, {"name": "v", "kind": "velocity", "at": "slider"},
    {"name": "turn", "kind": "rotation", "at": "wheel"}, {"name": "w", "kind": "velocity", "at": "wheel"},
    {"name": "strain", "kind": "strain_energy"}, {"name": "all", "kind": "total_energy"}]})-";
}

/// A factor that falls as 1 / (1 + t)^2, with k = (mu^2 + 1/4) m:  x = b sqrt(1 + t) sin(mu ln(1 + t)), x'(0) = mu b.
struct Softening {
  static constexpr double m = 2.0, mu = 7.0, b = 0.1, k = (mu * mu + 0.25) * m, v0 = mu * b;
  double x, v, strain, energy;
  explicit Softening(double t) {
    const double turn = mu * std::log(1.0 + t), root = std::sqrt(1.0 + t);
    x = b * root * std::sin(turn);
    v = b * (0.5 * std::sin(turn) + mu * std::cos(turn)) / root;
    strain = 0.5 * k * x * x / ((1.0 + t) * (1.0 + t));
    energy = strain + 0.5 * m * v * v;
  }
};

// A law, a signal of time, and the square of a state s' = -s^2: the same factor, to the order of the motion.
TEST(DrivenParts, a_bushing_softens_to_the_order_of_the_motion) {
  const Softening end(1.0);
  for (const std::string factor :
       {R"-({"expression": "1/(1 + t)^2"})-", R"-({"signal": "of_time"})-", R"-({"signal": "square"})-"})
    expect_order(on_bushings(factor, Softening::k, Softening::v0), 0.005,
                 {{"at.x", end.x}, {"v.vx", end.v}, {"turn.rz", end.x}, {"w.wz", end.v}});
}

// A stiffness that falls takes energy, dE/dt = 1/2 k' x^2: the energies are those of the closed form, and the balance
// closes to second order, that of its sums. The variational integrator agrees.
TEST(DrivenParts, a_bushing_that_softens_balances_its_energy) {
  const Softening end(1.0);
  for (const char* integrator : {"generalized_alpha", "bdf", "variational"})
    for (const char* without : {"[]", "[\"planar\"]"})
      for (const std::string factor : {R"-({"expression": "1/(1 + t)^2"})-", R"-({"signal": "square"})-"}) {
        SCOPED_TRACE(std::string(integrator) + " without " + without + factor);
        const auto run = [&](double h) {
          return run_ok(scene_of(on_bushings(factor, Softening::k, Softening::v0),
                                 {std::string("/analysis/integrator=") + integrator, "/analysis/tolerance=1e-11",
                                  std::string("/without=") + without, "/analysis/step_size=" + support::text(h)}));
        };
        const Outcome coarse = run(2e-3), fine = run(1e-3);
        EXPECT_NEAR(fine.history.last("strain"), 2.0 * end.strain, 1e-3 * end.energy);
        EXPECT_NEAR(fine.history.last("all"), 2.0 * end.energy, 1e-3 * end.energy);
        EXPECT_GT(fine.history.first("all") - fine.history.last("all"), 0.4 * end.energy);
        EXPECT_NEAR(std::log2(coarse.summary.checks.energy_balance / fine.summary.checks.energy_balance), 2.0, 0.2);
        EXPECT_LT(fine.summary.checks.energy_balance, 1e-4 * fine.summary.checks.energy_scale);
      }
}

/// 20 N on a mass against 128 (1 + 3 x^2) x of a bushing, whose factor is a formula of the place.
std::string stiffening_pad(const std::string& analysis) {
  return R"-({"analysis": )-" + analysis + R"-(,
  "bodies": [{"name": "mass", "mass": 2, "inertia": [0.5, 0.5, 0.5]}],
  "bushings": [{"name": "pad", "first": "ground", "second": "mass", "stiffness": [128, 90, 90, 9, 9, 9],
    "stiffness_factor": {"signal": "factor"}}],
  "loads": [{"at": "mass", "force": [20, 0, 0]}],
  "signals": [{"name": "way", "kind": "position", "at": "mass", "axis": "x"},
    {"name": "factor", "kind": "formula", "expression": "1 + 3*way^2"}],
  "sensors": [{"name": "at", "kind": "position", "at": "mass"}, {"name": "strain", "kind": "strain_energy"}]})-";
}

// Statics, with exact derivatives: Newton's method needs few iterations.
TEST(DrivenParts, a_bushing_stiffens_with_its_way_in_statics) {
  for (const char* without : {"[]", "[\"planar\"]"}) {
    const Outcome out = run_ok(
        scene_of(stiffening_pad(R"({"kind": "static", "tolerance": 1e-12})"), {std::string("/without=") + without}));
    double x = 0.1;
    for (int k = 0; k < 50; ++k) x -= (128.0 * (x + 3.0 * x * x * x) - 20.0) / (128.0 * (1.0 + 9.0 * x * x));
    EXPECT_NEAR(out.history.last("at.x"), x, 1e-12);
    EXPECT_NEAR(out.history.last("strain"), 64.0 * (1.0 + 3.0 * x * x) * x * x, 1e-11);
    EXPECT_LE(out.summary.steps.newton_iterations, 6);
  }
}

// The same along the path of equilibria: its load factor follows from the place in closed form at every row.
TEST(DrivenParts, a_bushing_stiffens_with_its_way_on_a_path_by_arc_length) {
  const Outcome out = run_ok(scene_of(stiffening_pad(R"({"kind": "static", "tolerance": 1e-11,
    "arc_length": {"step": 0.05, "largest_step": 0.1}})")));
  ASSERT_GT(out.history.times.size(), 2u);
  for (std::size_t r = 0; r < out.history.times.size(); ++r) {
    const double x = out.history.rows[r][out.history.column("at.x")];
    EXPECT_NEAR(20.0 * out.history.times[r], 128.0 * (1.0 + 3.0 * x * x) * x, 1e-9) << r;
  }
}

// Started in equilibrium under its weight, with a factor of 2 from a state that sits at x' = 0, a mass stays there.
TEST(DrivenParts, a_bushing_of_a_state_starts_in_equilibrium) {
  const Outcome out = run_ok(scene_of(R"-({"gravity": [0, -9.81, 0],
  "analysis": {"kind": "dynamic", "end_time": 1, "step_size": 0.01, "start": "equilibrium", "tolerance": 1e-11},
  "bodies": [{"name": "mass", "mass": 2, "inertia": [0.5, 0.5, 0.5]}],
  "bushings": [{"name": "pad", "first": "ground", "second": "mass", "stiffness": [90, 128, 90, 9, 9, 9],
    "stiffness_factor": {"signal": "factor"}}],
  "signals": [{"name": "factor", "kind": "state", "expression": "(2 - factor)/0.1"}],
  "sensors": [{"name": "at", "kind": "position", "at": "mass"}, {"name": "strain", "kind": "strain_energy"}]})-"));
  const double y = -2.0 * 9.81 / 256.0;
  for (const double at : out.history.of("at.y")) EXPECT_NEAR(at, y, 1e-12);
  EXPECT_NEAR(out.history.last("strain"), 128.0 * y * y, 1e-11);
}

// The force that moves a mass on a bushing as prescribed, m x'' + f k x.
TEST(DrivenParts, inverse_dynamics_pulls_against_the_factor_of_a_bushing) {
  const Outcome out = run_ok(scene_of(R"-({"analysis": {"kind": "inverse_dynamics", "end_time": 1, "step_size": 0.1},
  "bodies": [{"name": "mass", "mass": 2, "inertia": [0.5, 0.5, 0.5]}],
  "joints": [{"name": "rail", "kind": "prismatic", "first": "ground", "second": "mass", "axis": [1, 0, 0],
    "drives": [{"law": {"expression": "0.3*t^2"}}]}],
  "bushings": [{"name": "pad", "first": "ground", "second": "mass", "stiffness": [128, 90, 90, 9, 9, 9],
    "stiffness_factor": {"signal": "factor"}}],
  "signals": [{"name": "way", "kind": "joint_displacement", "joint": "rail"},
    {"name": "factor", "kind": "formula", "expression": "1 + 3*way^2"},
    {"name": "pull", "kind": "joint_effort", "joint": "rail"}],
  "sensors": [{"name": "pull", "kind": "signal", "signal": "pull"}]})-"));
  for (std::size_t r = 0; r < out.history.times.size(); ++r) {
    const double t = out.history.times[r], x = 0.3 * t * t;
    EXPECT_NEAR(out.history.rows[r][out.history.column("pull")], 2.0 * 0.6 + 128.0 * (1.0 + 3.0 * x * x) * x, 1e-9);
  }
}

// A factor does not scale the damping: with stiffness switched off a mass slows down as m v' = -c v.
TEST(DrivenParts, a_factor_of_zero_leaves_the_damping_of_a_bushing) {
  const Outcome out = run_ok(scene_of(on_bushings("0", Softening::k, 0.7),
                                      {"/bushings/axial/damping=[3, 0, 0, 0, 0, 0]", "/analysis/step_size=1e-3"}));
  EXPECT_NEAR(out.history.last("v.vx"), 0.7 * std::exp(-1.5), 1e-6);
  EXPECT_NEAR(out.history.last("turn.rz"), 0.7, 1e-9);
  EXPECT_EQ(out.history.last("strain"), 0.0);
}

}  // namespace
}  // namespace bough::run
