// Signals: closed forms, orders of convergence of motions and states, and that a control loop is what springs and
// dampers of the same strength are.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "support/scenes.hpp"
#include "support/untrapped.hpp"

namespace bough::run {
namespace {

using support::gallery;
using support::Outcome;
using support::run_ok;
using support::scene_of;

/// log2 of the ratio of errors of step sizes h and h / 2.
template <class Error>
double order_of(Error&& error, double h) {
  return std::log2(error(h) / error(0.5 * h));
}

/// A rotor under torque `torque` with the signals that it needs; "rate" and "angle" are there.
scene::Scene rotor(const std::string& signals, const std::string& torque, const std::vector<std::string>& overrides) {
  return scene_of(R"-({
  "analysis": {"kind": "dynamic", "end_time": 1, "step_size": 0.02, "tolerance": 1e-11},
  "bodies": [{"name": "rotor", "mass": 2, "inertia": [0.5, 0.5, 0.5]}],
  "joints": [{"name": "axle", "kind": "revolute", "first": "ground", "second": "rotor", "axis": [0, 0, 1],
              "forces": [{"effort": )-" +
                      torque + R"-(}]}],
  "signals": [{"name": "angle", "kind": "joint_angle", "joint": "axle"},
              {"name": "rate", "kind": "joint_rate", "joint": "axle"}, )-" +
                      signals + R"-(],
  "sensors": [{"name": "angle", "kind": "joint_angle", "joint": "axle"},
              {"name": "rate", "kind": "joint_rate", "joint": "axle"}]})-",
                  overrides);
}

const std::vector<std::string> in_space = {"/without=[\"planar\"]"}, in_plane = {};

std::string step_of(double h) { return "/analysis/step_size=" + support::text(h); }

// J w' = x, x' = (u - x) / tau with u = sin(3 t): a lag in front of a rotor, from rest.
//   x = (sin(w t) - w tau cos(w t) + w tau exp(-t / tau)) / (1 + (w tau)^2),  w J = integral of x
double lagged_rate(double t) {
  const double w = 3.0, tau = 0.2, J = 0.5, d = 1.0 + w * w * tau * tau;
  return ((1.0 - std::cos(w * t)) / w - tau * std::sin(w * t) + w * tau * tau * (1.0 - std::exp(-t / tau))) / d / J;
}

TEST(Signals, states_are_integrated_to_the_order_of_the_motion) {
  const std::string signals = R"-({"name": "u", "kind": "time", "law": {"expression": "sin(3*t)"}},
                                 {"name": "x", "kind": "state", "expression": "(u - x)/0.2"})-";
  for (const std::pair<const char*, double>& rule :
       {std::pair{"generalized_alpha", 2.0}, std::pair{"bdf", 3.0}, std::pair{"variational", 2.0}})
    for (const bool planar : {true, false}) {
      const auto error = [&](double h) {
        std::vector<std::string> overrides = planar ? in_plane : in_space;
        overrides.push_back(std::string("/analysis/integrator=") + rule.first);
        overrides.push_back(step_of(h));
        return std::abs(run_ok(rotor(signals, R"-({"signal": "x"})-", overrides)).history.last("rate") -
                        lagged_rate(1.0));
      };
      EXPECT_NEAR(order_of(error, 0.02), rule.second, 0.25) << rule.first << (planar ? " in a plane" : " in space");
      EXPECT_LT(error(0.01), 2e-4);
    }
}

// A loop by signals has the tangent of springs and dampers, so also their bits but for round-off.
TEST(Signals, a_loop_is_the_spring_and_damper_of_its_strength) {
  const std::string none = R"-({"name": "unused", "kind": "time", "law": 0})-";
  const std::string loop = R"-({"name": "torque", "kind": "formula", "expression": "40*(0.5 - angle) - 3*rate"})-";
  for (const char* integrator : {"generalized_alpha", "bdf", "variational"})
    for (const bool planar : {true, false}) {
      std::vector<std::string> overrides = planar ? in_plane : in_space;
      overrides.push_back(std::string("/analysis/integrator=") + integrator);
      const Outcome by_signals = run_ok(rotor(loop, R"-({"signal": "torque"})-", overrides));
      overrides.emplace_back(R"-(/joints/0/forces=[{"stiffness": 40, "rest": 0.5, "damping": 3}])-");
      const Outcome by_spring = run_ok(rotor(none, "0", overrides));
      ASSERT_EQ(by_signals.history.rows.size(), by_spring.history.rows.size());
      for (std::size_t k = 0; k < by_spring.history.rows.size(); ++k)
        for (const char* column : {"angle", "rate"})
          EXPECT_NEAR(by_signals.history.of(column)[k], by_spring.history.of(column)[k], 1e-9) << integrator;
    }
}

// A lag that follows the angle and pushes the rotor with minus its value: J q'' = -k x, x' = (q - x)/tau, so that with
// s the roots of J tau s^3 + J s^2 + k = 0 all is a sum of exp(s t). From q = 1, x = 0 at rest, against the third-order
// equation in Runge-Kutta steps of 1e-4.
struct Lagged {
  double q = 1.0, v = 0.0, x = 0.0;
};
Lagged lagged_loop(double end) {
  const auto rate = [](const Lagged& s) { return Lagged{s.v, -40.0 * s.x / 0.5, (s.q - s.x) / 0.05}; };
  const auto plus = [](const Lagged& s, double h, const Lagged& r) {
    return Lagged{s.q + h * r.q, s.v + h * r.v, s.x + h * r.x};
  };
  const int steps = 10000;
  const double h = end / steps;
  Lagged s;
  for (int k = 0; k < steps; ++k) {
    const Lagged a = rate(s), b = rate(plus(s, 0.5 * h, a)), c = rate(plus(s, 0.5 * h, b)), d = rate(plus(s, h, c));
    s = plus(plus(plus(plus(s, h / 6.0, a), h / 3.0, b), h / 3.0, c), h / 6.0, d);
  }
  return s;
}

TEST(Signals, a_loop_through_a_state_is_of_second_order_with_the_variational_integrator) {
  const std::string signals = R"-({"name": "moved", "kind": "formula", "expression": "1 + angle"},
    {"name": "x", "kind": "state", "expression": "(moved - x)/0.05"},
    {"name": "torque", "kind": "formula", "expression": "-40*x"})-";
  const Lagged exact = lagged_loop(1.0);
  for (const bool planar : {true, false}) {
    std::vector<std::string> overrides = planar ? in_plane : in_space;
    overrides.insert(overrides.end(), {"/analysis/integrator=variational", ""});
    std::vector<Outcome> runs;
    for (const double h : {0.01, 0.005}) {
      overrides.back() = step_of(h);
      scene::Scene scene = rotor(signals, R"-({"signal": "torque"})-", overrides);
      scene.sensors.push_back(scene.sensors.front());
      scene.sensors.back().name = "x";
      scene.sensors.back().kind = scene::SensorKind::signal;
      scene.sensors.back().signal = "x";
      runs.push_back(run_ok(scene));
    }
    const std::pair<const char*, double> columns[] = {{"angle", exact.q - 1.0}, {"rate", exact.v}, {"x", exact.x}};
    for (const auto& [column, value] : columns)
      EXPECT_NEAR(
          std::log2(std::abs(runs[0].history.last(column) - value) / std::abs(runs[1].history.last(column) - value)),
          2.0, 0.25)
          << column << (planar ? " in a plane" : " in space");
    EXPECT_LT(runs[1].summary.checks.energy_balance, 1e-2 * runs[1].summary.checks.energy_scale);
  }
}

// A drive that follows the second of two lags of a law: its angle is the state at the end of every step, and the rate
// of a state is that of the motion. From rest, x' = (u - x)/tau, y' = (x - y)/tau, u = 1:
//   y = 1 - (1 + t/tau) exp(-t/tau),  y' = t/tau^2 exp(-t/tau)
TEST(Signals, states_drive_joints_of_the_variational_integrator) {
  const std::string json = R"-({
  "analysis": {"kind": "dynamic", "end_time": 1, "step_size": 0.01, "tolerance": 1e-11, "integrator": "variational"},
  "bodies": [{"name": "rotor", "mass": 2, "inertia": [0.5, 0.5, 0.5]}],
  "joints": [{"name": "axle", "kind": "revolute", "first": "ground", "second": "rotor", "axis": [0, 0, 1],
              "drives": [{"law": {"signal": "y"}}]}],
  "signals": [{"name": "x", "kind": "state", "expression": "(1 - x)/0.2"},
              {"name": "y", "kind": "state", "expression": "(x - y)/0.2"}],
  "sensors": [{"name": "angle", "kind": "joint_angle", "joint": "axle"},
              {"name": "rate", "kind": "joint_rate", "joint": "axle"},
              {"name": "y", "kind": "signal", "signal": "y"}]})-";
  const double e = std::exp(-5.0), angle = 1.0 - 6.0 * e, rate = 25.0 * e;
  for (const bool planar : {true, false}) {
    std::vector<std::string> overrides = planar ? in_plane : in_space;
    overrides.emplace_back();
    const auto run = [&](double h) {
      overrides.back() = step_of(h);
      return run_ok(scene_of(json, overrides));
    };
    const Outcome coarse = run(0.02), fine = run(0.01);
    EXPECT_NEAR(fine.history.last("angle"), fine.history.last("y"), 1e-10);
    EXPECT_NEAR(
        std::log2(std::abs(coarse.history.last("angle") - angle) / std::abs(fine.history.last("angle") - angle)), 2.0,
        0.25);
    EXPECT_NEAR(std::log2(std::abs(coarse.history.last("rate") - rate) / std::abs(fine.history.last("rate") - rate)),
                2.0, 0.25);
  }
}

// A dead load that a signal makes the force of a spring and damper on the tip of a cantilever: statics against beam
// theory, dynamics by its balance of energy, in which the load's power is work.
TEST(Signals, loads_read_points_of_beams) {
  const std::string json = R"-({
  "gravity": [0, -9.81, 0],
  "analysis": {"kind": "dynamic", "end_time": 0.2, "step_size": 2e-4, "tolerance": 1e-10},
  "materials": [{"name": "steel", "young": 2.1e11, "poisson": 0.3, "density": 7850}],
  "sections": [{"name": "bar", "material": "steel", "shape": {"kind": "rectangle", "width": 0.02, "height": 0.02}}],
  "nodes": [{"name": "root"}, {"name": "tip", "position": [1, 0, 0]}],
  "beams": [{"name": "arm", "section": "bar", "start": "root", "end": "tip", "elements": 4, "order": 3}],
  "joints": [{"name": "clamp", "kind": "fixed", "first": "ground", "second": "root"}],
  "signals": [{"name": "y", "kind": "position", "at": "tip", "axis": "y"},
              {"name": "vy", "kind": "velocity", "at": "tip", "axis": "y"},
              {"name": "up", "kind": "formula", "expression": "-2e4*y - 30*vy"}],
  "loads": [{"at": "tip", "force": [0, 1, 0], "law": {"signal": "up"}}],
  "sensors": [{"name": "tip", "kind": "position", "at": "tip"}]})-";
  const double EI = 2.1e11 * std::pow(0.02, 4) / 12.0, q = 7850 * 4e-4 * 9.81, rest = q / 8.0 / (EI + 2e4 / 3.0);
  for (const bool planar : {true, false}) {
    std::vector<std::string> overrides = planar ? in_plane : in_space;
    const Outcome moving = run_ok(scene_of(json, overrides));
    EXPECT_GT(moving.summary.checks.energy_scale, 1e-4);
    EXPECT_LT(moving.summary.checks.energy_balance, 2e-3 * moving.summary.checks.energy_scale);
    overrides.emplace_back(R"-(/analysis={"kind": "static"})-");
    const Outcome still = run_ok(scene_of(json, overrides));
    EXPECT_NEAR(still.history.last("tip.y"), -rest, 2e-3 * rest) << "q L^4 / 8 / (EI + k L^3 / 3)";
  }
}

// A hardening spring F = -k u^3 along the line between two points, here of a mass on a rail: with
// the mass m its period is 7.4162987 / (a sqrt(k / m)), a the amplitude.
TEST(Signals, a_strut_takes_any_law_of_length) {
  for (const bool planar : {true, false}) {
    const Outcome r = run_ok(scene_of(R"-({
  "analysis": {"kind": "dynamic", "end_time": 4, "step_size": 2e-3, "tolerance": 1e-10},
  "bodies": [{"name": "mass", "mass": 2, "inertia": [1, 1, 1], "position": [1.3, 0, 0]}],
  "joints": [{"name": "rail", "kind": "prismatic", "first": "ground", "second": "mass", "axis": [1, 0, 0]},
             {"name": "spring", "kind": "strut", "first": "ground", "second": "mass",
              "forces": [{"effort": {"signal": "pull"}}]}],
  "signals": [{"name": "length", "kind": "joint_displacement", "joint": "spring"},
              {"name": "u", "kind": "formula", "expression": "length - 1"},
              {"name": "pull", "kind": "function", "of": "u", "law": {"expression": "-500*t^3"}}],
  "sensors": [{"name": "length", "kind": "joint_displacement", "joint": "spring"}],
  "expected": [{"quantity": "length", "figure": "period", "level": 1, "value": 1.563493, "tolerance": 2e-5},
               {"quantity": "length", "figure": "min", "value": 0.7, "tolerance": 1e-5}]})-",
                                      planar ? in_plane : in_space));
    for (const records::ExpectedResult& e : r.summary.expected) EXPECT_TRUE(e.holds) << e.value;
  }
}

// A motor that follows a path on a flexible arm, linear as a spring and damper whose rest is carried along.
TEST(Signals, a_motor_tracks_a_path_on_a_flexible_arm_as_its_spring_and_damper_do) {
  const std::string json = R"-({
  "gravity": [0, -9.81, 0],
  "analysis": {"kind": "dynamic", "end_time": 0.6, "step_size": 1e-3, "tolerance": 1e-10},
  "materials": [{"name": "steel", "young": 2.1e11, "poisson": 0.3, "density": 7850}],
  "sections": [{"name": "bar", "material": "steel", "shape": {"kind": "rectangle", "width": 0.02, "height": 0.005}}],
  "nodes": [{"name": "root"}, {"name": "tip", "position": [1, 0, 0]}],
  "beams": [{"name": "arm", "section": "bar", "start": "root", "end": "tip", "elements": 6}],
  "joints": [{"name": "hinge", "kind": "revolute", "first": "ground", "second": "root", "axis": [0, 0, 1],
              "forces": [{"effort": {"signal": "torque"}}]}],
  "signals": [{"name": "path", "kind": "time", "law": {"kind": "cycloidal", "end_time": 0.5, "to": 1.2}},
              {"name": "angle", "kind": "joint_angle", "joint": "hinge"},
              {"name": "rate", "kind": "joint_rate", "joint": "hinge"},
              {"name": "torque", "kind": "formula", "expression": "150*(path - angle) - 6*rate"}],
  "sensors": [{"name": "tip", "kind": "position", "at": "tip"},
              {"name": "angle", "kind": "joint_angle", "joint": "hinge"}]})-";
  for (const bool planar : {true, false}) {
    std::vector<std::string> overrides = planar ? in_plane : in_space;
    const Outcome by_signals = run_ok(scene_of(json, overrides));
    overrides.emplace_back(R"-(/joints/0/forces=[{"stiffness": 150, "damping": 6, "effort": {"kind": "scaled",
                              "factor": 150, "law": {"kind": "cycloidal", "end_time": 0.5, "to": 1.2}}}])-");
    const Outcome by_spring = run_ok(scene_of(json, overrides));
    EXPECT_GT(by_signals.history.largest("angle"), 1.0);
    for (std::size_t k = 0; k < by_spring.history.rows.size(); ++k)
      for (const char* column : {"tip.x", "tip.y", "angle"})
        EXPECT_NEAR(by_signals.history.of(column)[k], by_spring.history.of(column)[k], 1e-8) << planar;
  }
}

// A PID controller whose motor saturates and whose integrator is held back by what the motor does not give, against
// Runge's and Kutta's method on the three equations:
//   J w' = clamp(u),  theta' = w,  i' = e + 2 (clamp(u) - u),  u = 30 e + 10 i - 4 w,  e = 1 - theta
TEST(Signals, a_limited_integrator_agrees_with_runge_kutta) {
  const auto rates = [](const std::array<double, 3>& y) {
    const double e = 1.0 - y[0], u = 30.0 * e + 10.0 * y[2] - 4.0 * y[1], given = std::clamp(u, -3.0, 3.0);
    return std::array<double, 3>{y[1], given / 0.5, e + 2.0 * (given - u)};
  };
  std::array<double, 3> y{};
  const int steps = 40000;
  const double h = 1.0 / steps;
  for (int k = 0; k < steps; ++k) {
    const auto moved = [&](const std::array<double, 3>& by, double size) {
      return std::array<double, 3>{y[0] + size * by[0], y[1] + size * by[1], y[2] + size * by[2]};
    };
    const auto a = rates(y), b = rates(moved(a, 0.5 * h)), c = rates(moved(b, 0.5 * h)), d = rates(moved(c, h));
    for (std::size_t i = 0; i < 3; ++i) y[i] += h / 6.0 * (a[i] + 2.0 * b[i] + 2.0 * c[i] + d[i]);
  }
  const std::string signals = R"-({"name": "err", "kind": "formula", "expression": "1 - angle"},
      {"name": "i", "kind": "state", "expression": "err + 2*(given - u)"},
      {"name": "u", "kind": "formula", "expression": "30*err + 10*i - 4*rate"},
      {"name": "given", "kind": "formula", "expression": "max(-3, min(3, u))"})-";
  for (const char* integrator : {"generalized_alpha", "bdf"}) {
    const Outcome r = run_ok(
        rotor(signals, R"-({"signal": "given"})-", {std::string("/analysis/integrator=") + integrator, step_of(5e-4)}));
    EXPECT_NEAR(r.history.last("angle"), y[0], 2e-6) << integrator;
    EXPECT_NEAR(r.history.last("rate"), y[1], 2e-5) << integrator;
  }
}

// Stick and slip on a belt of 0.1 m/s, m = 1 kg, k = 100 N/m: friction by a bristle whose steady force falls from 6 N at
// break-away to 4 N within 0.3 mm/s. With Coulomb's law the block sticks for 0.4 s and slips for 0.40689 s.
TEST(Signals, a_bristle_sticks_and_slips_as_coulombs_law_does) {
  const Outcome r = run_ok(scene_of(R"-({
  "parameters": {"belt": 0.1, "Fs": 6, "Fk": 4, "vs": 3e-4, "s0": 1e6, "s1": 50},
  "analysis": {"kind": "dynamic", "end_time": 4, "step_size": 2e-4},
  "bodies": [{"name": "block", "mass": 1, "inertia": [1, 1, 1]}],
  "joints": [
    {"name": "slide", "kind": "prismatic", "first": "ground", "second": "block", "axis": [1, 0, 0],
     "forces": [{"stiffness": 100}, {"effort": {"signal": "friction"}}]}
  ],
  "signals": [
    {"name": "speed", "kind": "joint_rate", "joint": "slide"},
    {"name": "sliding", "kind": "formula", "expression": "belt - speed"},
    {"name": "most", "kind": "formula", "expression": "(Fk + (Fs - Fk)*exp(-(sliding/vs)^2))/s0"},
    {"name": "share", "kind": "formula",
     "expression": "step(bristle*sliding)*min(1, max(0, (abs(bristle) - 0.97*most)/(0.03*most)))"},
    {"name": "stretching", "kind": "formula", "expression": "sliding*(1 - share*abs(bristle)/most)"},
    {"name": "bristle", "kind": "state", "expression": "stretching"},
    {"name": "friction", "kind": "formula", "expression": "s0*bristle + s1*stretching"}
  ],
  "sensors": [
    {"name": "x", "kind": "joint_displacement", "joint": "slide"},
    {"name": "speed", "kind": "joint_rate", "joint": "slide"},
    {"name": "friction", "kind": "signal", "signal": "friction"}
  ],
  "output": {"stride": 10},
  "expected": [
    {"quantity": "x", "figure": "max", "value": 0.0623606797749979, "tolerance": 5e-4,
     "source": "Coulomb's law with 6 and 4 N, closed form"},
    {"quantity": "x", "figure": "period", "level": 0.04, "value": 0.8068887871591405, "tolerance": 8e-3,
     "source": "Coulomb's law with 6 and 4 N, closed form"}
  ]
})-"));
  for (const records::ExpectedResult& e : r.summary.expected) EXPECT_TRUE(e.holds) << e.value;
}

// The block of friction_incline with less friction, from rest on the unloaded bristle: g (sin a - mu cos a) t^2 / 2 but
// for the 1.2 ms in which the bristle is stretched.
TEST(Signals, a_bristle_slides_as_coulombs_law_does) {
  const Outcome r = run_ok(gallery(
      "friction_incline", {"/parameters/mu=0.4", "/analysis/start=given", "/analysis/end_time=1", "/expected=[]"}));
  EXPECT_NEAR(r.history.last("way"), 0.7533581577749314, 2.5e-3);
}

// In statics a state rests: the integral part of a controller brings the tip to its target against the load.
TEST(Signals, integral_control_reaches_its_target_in_statics) {
  const Outcome r = run_ok(rotor(R"-({"name": "err", "kind": "formula", "expression": "0.3 - angle"},
                                    {"name": "i", "kind": "state", "expression": "err"},
                                    {"name": "torque", "kind": "formula", "expression": "5*err + 2*i - 7*angle"})-",
                                 R"-({"signal": "torque"})-", {"/analysis={\"kind\": \"static\"}"}));
  EXPECT_NEAR(r.history.last("angle"), 0.3, 1e-12);
}

TEST(Signals, start_in_the_equilibrium_of_their_loop) {
  const std::string loop = R"-({"name": "i", "kind": "state", "expression": "0.3 - angle", "start": 4},
      {"name": "torque", "kind": "formula", "expression": "20*(0.3 - angle) + 8*i - 3*rate - 2*angle"})-";
  const Outcome r = run_ok(rotor(loop, R"-({"signal": "torque"})-", {"/analysis/start=equilibrium"}));
  for (const double angle : r.history.of("angle")) EXPECT_NEAR(angle, 0.3, 1e-11);
  EXPECT_LT(r.history.largest("rate"), 1e-10);
}

/// What an input at zero prescribes is solved for together with what pulls at it: the round-off of that is no miss.
TEST(Signals, an_input_at_zero_holds_what_it_prescribes) {
  for (const char* const start : {"given", "equilibrium"}) {
    const Outcome r = run_ok(scene_of(std::string(R"-({"gravity": [0, 0, -9.81],
      "materials": [{"name": "steel", "young": 2.1e11, "poisson": 0.3, "density": 7850}],
      "sections": [{"name": "bar", "material": "steel", "shape": {"kind": "circle", "radius": 0.02}}],
      "nodes": [{"name": "foot"}],
      "bodies": [{"name": "head", "mass": 4, "inertia": [0.1, 0.1, 0.1], "position": [0.1, 0, 2]}],
      "beams": [{"name": "mast", "section": "bar", "start": "foot", "end": {"to": "head", "position": [-0.1, 0, 0]}}],
      "signals": [{"name": "shake", "kind": "input"}],
      "motions": [{"name": "table", "at": "foot", "x": {"signal": "shake"}, "y": 0, "z": 0, "rotation": "hold"}],
      "sensors": [{"name": "foot", "kind": "position", "at": "foot"}],
      "analysis": {"kind": "dynamic", "end_time": 0.02, "step_size": 1e-3, "start": ")-") +
                                      start + "\"}}"));
    EXPECT_LT(r.history.largest("foot.x"), 1e-15);
  }
}

TEST(Signals, what_is_not_finite_is_named) {
  const test::Untrapped untrapped;
  const Outcome r =
      support::run(rotor(R"-({"name": "torque", "kind": "formula", "expression": "1/(0.2 - angle)^0.5"})-",
                         R"-({"signal": "torque"})-", in_plane));
  EXPECT_FALSE(r.ok());
  EXPECT_NE(r.summary.cause.find("signal 'torque'"), std::string::npos) << r.summary.cause;
  // What a law adds to a spring has the spring's name.
  const Outcome spring = support::run(scene_of(R"-({
  "analysis": {"kind": "dynamic", "end_time": 1, "step_size": 0.01},
  "bodies": [{"name": "mass", "mass": 2, "inertia": [1, 1, 1], "position": [1, 0, 0]}],
  "joints": [{"name": "rail", "kind": "prismatic", "first": "ground", "second": "mass", "axis": [1, 0, 0]}],
  "springs": [{"name": "coil", "first": "ground", "second": "mass",
               "force_law": {"expression": "-1/(1.2 - length)^0.5"}}]})-"));
  EXPECT_FALSE(spring.ok());
  EXPECT_NE(spring.summary.cause.find("signal 'coil_force'"), std::string::npos) << spring.summary.cause;
}

}  // namespace
}  // namespace bough::run
