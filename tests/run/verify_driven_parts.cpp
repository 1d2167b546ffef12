// Springs and gravity that signals drive: laws of the same value, closed forms, Runge-Kutta, orders of convergence.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>
#include <vector>

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

// The derivatives by the length and by the signal are exact: Newton's method reaches round-off from a far start in the
// iterations of a quadratic method. A weight of 20 N, a factor that grows with the length.
TEST(DrivenParts, statics_converge_quadratically) {
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

}  // namespace
}  // namespace bough::run
