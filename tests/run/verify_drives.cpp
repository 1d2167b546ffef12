// Signals that drive coordinates and that read forces: closed forms, Runge-Kutta, orders of convergence.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <exception>
#include <string>

#include "support/scenes.hpp"

namespace bough::run {
namespace {

using support::Outcome;
using support::run_ok;
using support::scene_of;

/// log2 of the ratio of errors of step sizes h and h / 2.
template <class Error>
double order_of(Error&& error, double h) {
  return std::log2(error(h) / error(0.5 * h));
}

std::string step_of(double h) { return "/analysis/step_size=" + support::text(h); }

struct Way {
  const char* integrator;
  bool is_planar;
  double order;
  std::string name() const { return std::string(integrator) + (is_planar ? " in a plane" : " in space"); }
  std::vector<std::string> overrides(double h) const {
    std::vector<std::string> list{std::string("/analysis/integrator=") + integrator, step_of(h)};
    if (!is_planar) list.emplace_back("/without=[\"planar\", \"translation\", \"line\"]");
    return list;
  }
};
const Way ways[] = {
    {"generalized_alpha", true, 2.0}, {"generalized_alpha", false, 2.0}, {"bdf", true, 3.0}, {"bdf", false, 3.0}};

/// Classical Runge-Kutta of fourth order from y at 0 to the end.
template <std::size_t N, class Rates>
std::array<double, N> runge_kutta(std::array<double, N> y, double end, int steps, Rates&& rates) {
  const double h = end / steps;
  const auto moved = [&y](const std::array<double, N>& by, double size) {
    std::array<double, N> z = y;
    for (std::size_t i = 0; i < N; ++i) z[i] += size * by[i];
    return z;
  };
  for (int k = 0; k < steps; ++k) {
    const double t = k * h;
    const auto a = rates(t, y), b = rates(t + 0.5 * h, moved(a, 0.5 * h)), c = rates(t + 0.5 * h, moved(b, 0.5 * h)),
               d = rates(t + h, moved(c, h));
    for (std::size_t i = 0; i < N; ++i) y[i] += h / 6.0 * (a[i] + 2.0 * b[i] + 2.0 * c[i] + d[i]);
  }
  return y;
}

/// A rotor whose angle signals drive.
std::string rotor(const std::string& signals, const std::string& driven_by) {
  return R"-({
  "analysis": {"kind": "dynamic", "end_time": 1, "step_size": 0.02, "tolerance": 1e-11},
  "bodies": [{"name": "rotor", "mass": 2, "inertia": [0.5, 0.5, 0.5]}],
  "joints": [{"name": "axle", "kind": "revolute", "first": "ground", "second": "rotor", "axis": [0, 0, 1],
              "drives": [{"law": {"signal": ")-" +
         driven_by + R"-("}}]}],
  "signals": [{"name": "torque", "kind": "joint_effort", "joint": "axle"}, )-" +
         signals + R"-(],
  "sensors": [{"name": "angle", "kind": "joint_angle", "joint": "axle"},
              {"name": "rate", "kind": "joint_rate", "joint": "axle"},
              {"name": "torque", "kind": "signal", "signal": "torque"}]})-";
}

// A servo that follows u = sin(3 t) with a lag, x' = (u - x) / T, prescribes the angle of a rotor:
//   x = (sin(w t) - w T cos(w t) + w T exp(-t / T)) / (1 + (w T)^2),   torque J x''
TEST(Drives, a_lag_drives_a_joint_to_the_order_of_the_motion) {
  const double w = 3.0, T = 0.2, J = 0.5, d = 1.0 + w * w * T * T, t = 1.0;
  const double angle = (std::sin(w * t) - w * T * std::cos(w * t) + w * T * std::exp(-t / T)) / d;
  const double rate = (w * std::cos(w * t) + w * w * T * std::sin(w * t) - w * std::exp(-t / T)) / d;
  const double torque = J * (w * std::cos(w * t) - rate) / T;
  const std::string json = rotor(R"-({"name": "u", "kind": "time", "law": {"expression": "sin(3*t)"}},
      {"name": "x", "kind": "state", "expression": "(u - x)/0.2"})-",
                                 "x");
  for (const Way& way : ways) {
    SCOPED_TRACE(way.name());
    const auto error_of = [&](const char* column, double exact) {
      return [&, column, exact](double h) {
        return std::abs(run_ok(scene_of(json, way.overrides(h))).history.last(column) - exact);
      };
    };
    EXPECT_NEAR(order_of(error_of("angle", angle), 0.02), way.order, 0.25);
    EXPECT_NEAR(order_of(error_of("rate", rate), 0.02), way.order, 0.25);
    EXPECT_NEAR(order_of(error_of("torque", torque), 0.01), way.order, 0.25) << "what the start leaves has decayed";
    EXPECT_LT(error_of("torque", torque)(0.01), 1e-3 * J * w);
  }
}

// The same drive, but with the lag's law between: a formula and a table of the state.
TEST(Drives, signals_that_are_made_of_states_drive) {
  const std::string state = R"-({"name": "u", "kind": "time", "law": {"expression": "sin(3*t)"}},
      {"name": "x", "kind": "state", "expression": "(u - x)/0.2"}, )-";
  const Outcome by_formula = run_ok(scene_of(
      rotor(state + R"-({"name": "y", "kind": "formula", "expression": "x^3 + 0.2*u"})-", "y"), {step_of(1e-3)}));
  const double w = 3.0, T = 0.2, d = 1.0 + w * w * T * T, u = std::sin(w), du = w * std::cos(w), e = std::exp(-1.0 / T);
  const double x = (u - T * du + w * T * e) / d, dx = (u - x) / T, ddx = (du - dx) / T;
  EXPECT_NEAR(by_formula.history.last("angle"), x * x * x + 0.2 * u, 1e-5);
  EXPECT_NEAR(by_formula.history.last("torque"), 0.5 * (6.0 * x * dx * dx + 3.0 * x * x * ddx - 0.2 * w * w * u), 2e-4);
  const Outcome by_function =
      run_ok(scene_of(rotor(state + R"-({"name": "c", "kind": "function", "of": "x", "law": {"expression": "t^3"}},
                        {"name": "y", "kind": "formula", "expression": "c + 0.2*u"})-",
                            "y"),
                      {step_of(1e-3)}));
  for (const char* column : {"angle", "rate", "torque"})
    EXPECT_NEAR(by_function.history.last(column), by_formula.history.last(column), 1e-8) << column;
}

// A servo with a limit of its rate: x' = max(-v, min(v, (1 - x) / T)) goes at v until x = 1 - v T, then as exp(-t / T).
// The rate's corner is not at the end of a step.
TEST(Drives, a_limited_servo_follows_its_closed_form) {
  const double v = 1.5, T = 0.1, corner = (1.0 - v * T) / v, t = 1.0, e = std::exp(-(t - corner) / T);
  const std::string json =
      rotor(R"-({"name": "x", "kind": "state", "expression": "max(-1.5, min(1.5, (1 - x)/0.1))"})-", "x");
  for (const Way& way : ways) {
    const auto error = [&](double h) {
      return std::abs(run_ok(scene_of(json, way.overrides(h))).history.last("angle") - (1.0 - v * T * e));
    };
    EXPECT_LT(error(1e-3), 2e-6) << way.name();
    const Outcome fine = run_ok(scene_of(json, way.overrides(1e-3)));
    EXPECT_NEAR(fine.history.last("rate"), v * e, 1e-4) << way.name();
    EXPECT_NEAR(fine.history.last("torque"), -0.5 * v * e / T, 2e-3) << way.name();
  }
}

/// A cart whose place a signal prescribes, by a drive of its rail or by a prescribed motion, and a pendulum on it.
std::string cart(const std::string& holds, const std::string& signals) {
  return R"-({
  "gravity": [0, -9.81, 0],
  "analysis": {"kind": "dynamic", "end_time": 1, "step_size": 0.01, "tolerance": 1e-11},
  "bodies": [{"name": "cart", "mass": 3, "inertia": [1, 1, 1]},
             {"name": "bob", "mass": 2, "inertia": [0.1, 0.1, 0.1],
              "position": [0.33589882820250137, -0.6145077933233957, 0]}],
  "joints": [{"name": "pin", "kind": "revolute", "first": "cart", "second": "bob", "position": [0, 0, 0],
              "axis": [0, 0, 1]})-" +
         holds + R"-(,
  "signals": [{"name": "angle", "kind": "joint_angle", "joint": "pin"},
              {"name": "x", "kind": "state", "expression": "2*angle"})-" +
         signals + R"-(],
  "sensors": [{"name": "angle", "kind": "joint_angle", "joint": "pin"},
              {"name": "cart", "kind": "position", "at": "cart"})-";
}

// x' = 2 (theta - theta_0): (I + m L^2) theta'' + m L cos(theta) x'' + m g L sin(theta) = 0, from rest, and the force
// of the drive is the rate of the momentum.
TEST(Drives, a_state_of_the_motion_drives_a_cart_to_the_order_of_the_motion) {
  const double M = 3.0, m = 2.0, I = 0.1, g = 9.81;
  const double length = std::hypot(0.33589882820250137, 0.6145077933233957);
  const double leans = std::atan2(0.33589882820250137, 0.6145077933233957);
  const auto rates = [&](double, const std::array<double, 3>& y) {
    const double a =
        -(m * length * std::cos(y[1]) * 2.0 * y[2] + m * g * length * std::sin(y[1])) / (I + m * length * length);
    return std::array<double, 3>{2.0 * (y[1] - leans), y[2], a};
  };
  const std::array<double, 3> y = runge_kutta<3>({0.0, leans, 0.0}, 1.0, 20000, rates);
  const std::array<double, 3> dy = rates(1.0, y);
  const double force = (M + m) * 2.0 * y[2] + m * length * (dy[2] * std::cos(y[1]) - y[2] * y[2] * std::sin(y[1]));
  const std::string json =
      cart(R"-(, {"name": "rail", "kind": "prismatic", "first": "ground", "second": "cart", "position": [0, 0, 0],
                  "axis": [1, 0, 0], "drives": [{"law": {"signal": "x"}}]}])-",
           R"-(, {"name": "force", "kind": "joint_effort", "joint": "rail"})-") +
      R"-(, {"name": "force", "kind": "signal", "signal": "force"}]})-";
  for (const Way& way : ways) {
    SCOPED_TRACE(way.name());
    const auto error_of = [&](const char* column, double exact) {
      return [&, column, exact](double h) {
        return std::abs(run_ok(scene_of(json, way.overrides(h))).history.last(column) - exact);
      };
    };
    EXPECT_NEAR(order_of(error_of("angle", y[1] - leans), 0.01), way.order, 0.3);
    EXPECT_NEAR(order_of(error_of("cart.x", y[0]), 0.01), way.order, 0.3);
    EXPECT_NEAR(order_of(error_of("force", force), 0.01), way.order, 0.4);
    EXPECT_LT(error_of("force", force)(0.005), 5e-3 * std::abs(force));
    const Outcome fine = run_ok(scene_of(json, way.overrides(1e-3)));
    EXPECT_GT(fine.summary.checks.energy_scale, 1.0);
    EXPECT_LT(fine.summary.checks.energy_balance, 1e-4 * fine.summary.checks.energy_scale)
        << "the work of the drive is in the balance";
  }
}

// A prescribed motion by a signal is the drive of a rail by the same signal.
TEST(Drives, a_signal_prescribes_a_motion_as_it_drives_a_joint) {
  const std::string rail =
      cart(R"-(, {"name": "rail", "kind": "prismatic", "first": "ground", "second": "cart", "position": [0, 0, 0],
                  "axis": [1, 0, 0], "drives": [{"law": {"signal": "x"}}]}])-",
           "") +
      "]}";
  const std::string motion = cart(R"-(], "motions": [{"at": "cart", "x": {"signal": "x"}, "y": 0, "z": 0,
                                        "rotation": "hold"}])-",
                                  "") +
                             "]}";
  for (const bool planar : {true, false}) {
    const Way way{"generalized_alpha", planar, 2.0};
    const Outcome a = run_ok(scene_of(rail, way.overrides(0.01))), b = run_ok(scene_of(motion, way.overrides(0.01)));
    EXPECT_NEAR(a.history.last("angle"), b.history.last("angle"), 1e-9);
    EXPECT_NEAR(a.history.last("cart.x"), b.history.last("cart.x"), 1e-9);
  }
}

// A rotation about a fixed axis: angle = x of a lag.
TEST(Drives, a_signal_prescribes_a_rotation) {
  const std::string json = R"-({
  "analysis": {"kind": "dynamic", "end_time": 1, "step_size": 1e-3, "tolerance": 1e-11},
  "bodies": [{"name": "rotor", "mass": 2, "inertia": [0.5, 0.5, 0.5]}],
  "motions": [{"at": "rotor", "x": 0, "y": 0, "z": 0, "rotation": {"axis": [0, 0, 1], "angle": {"signal": "x"}}}],
  "signals": [{"name": "x", "kind": "state", "expression": "(2 - x)/0.5"}],
  "sensors": [{"name": "turn", "kind": "rotation", "at": "rotor"}]})-";
  const double x = 2.0 * (1.0 - std::exp(-2.0));
  EXPECT_NEAR(run_ok(scene_of(json)).history.last("turn.rz"), x, 1e-5);
}

// In statics the state is where its rate is 0, and so is what it drives.
TEST(Drives, statics_find_the_coordinate_where_the_state_rests) {
  const std::string json = rotor(R"-({"name": "u", "kind": "time", "law": {"expression": "0.4*t"}},
      {"name": "x", "kind": "state", "expression": "(u - x)/0.2"})-",
                                 "x");
  EXPECT_NEAR(run_ok(scene_of(json, {"/analysis={\"kind\": \"static\"}"})).history.last("angle"), 0.4, 1e-12);
}

// A law of time by the name of a signal is that law.
TEST(Drives, a_signal_of_time_is_its_law) {
  const std::string json = rotor(R"-({"name": "u", "kind": "time", "law": {"expression": "1 - cos(3*t)"}})-", "u");
  const Outcome a = run_ok(scene_of(json));
  const Outcome b = run_ok(scene_of(json, {R"-(/joints/0/drives/0/law={"expression": "1 - cos(3*t)"})-"}));
  EXPECT_EQ(a.history.of("angle"), b.history.of("angle"));
}

// Admittance control: the drive moves a mass m on a spring k as a virtual mass M with a damper c would move under the
// target force less the measured one, which a sensor gives with a lag T:
//   F = m p'' + k p,   f' = (F - f) / T,   M p'' = Ft - f - c p'
TEST(Drives, a_measured_force_controls_a_drive) {
  const double m = 2.0, k = 300.0, M = 1.0, c = 15.0, T = 0.05, target = 20.0;
  const auto rates = [&](double, const std::array<double, 3>& y) {
    const double a = (target - y[2] - c * y[1]) / M;
    return std::array<double, 3>{y[1], a, (m * a + k * y[0] - y[2]) / T};
  };
  const std::array<double, 3> y = runge_kutta<3>({0.0, 0.0, 0.0}, 0.5, 20000, rates);
  const double force = m * rates(0.0, y)[1] + k * y[0];
  const std::string json = R"-({
  "analysis": {"kind": "dynamic", "end_time": 0.5, "step_size": 2e-3, "tolerance": 1e-11},
  "bodies": [{"name": "mass", "mass": 2, "inertia": [1, 1, 1]}],
  "joints": [{"name": "rail", "kind": "prismatic", "first": "ground", "second": "mass", "position": [0, 0, 0],
              "axis": [1, 0, 0], "drives": [{"law": {"signal": "p"}}]}],
  "springs": [{"name": "wall", "first": {"to": "ground", "position": [5, 0, 0]}, "second": "mass", "stiffness": 300}],
  "signals": [{"name": "force", "kind": "joint_effort", "joint": "rail"},
              {"name": "measured", "kind": "state", "expression": "(force - measured)/0.05"},
              {"name": "v", "kind": "state", "expression": "20 - measured - 15*v"},
              {"name": "p", "kind": "state", "expression": "v"}],
  "sensors": [{"name": "p", "kind": "joint_displacement", "joint": "rail"},
              {"name": "force", "kind": "signal", "signal": "force"},
              {"name": "measured", "kind": "signal", "signal": "measured"}]})-";
  for (const Way& way : ways) {
    SCOPED_TRACE(way.name());
    const auto error_of = [&](const char* column, double exact) {
      return [&, column, exact](double h) {
        return std::abs(run_ok(scene_of(json, way.overrides(h))).history.last(column) - exact);
      };
    };
    // States start to second order, accelerations that follow them to first: what a force feeds back is of second
    // order.
    EXPECT_NEAR(order_of(error_of("p", y[0]), 4e-3), 2.0, 0.3);
    EXPECT_NEAR(order_of(error_of("measured", y[2]), 4e-3), 2.0, 0.3);
    EXPECT_LT(error_of("force", force)(1e-3), 2e-3 * target);
  }
}

// A force that is measured without delay is part of the loop that Newton's iteration solves: with an effort
// G (Ft - tension) on the mass, its spring and damper are 1 + G times as strong.
TEST(Drives, a_tension_without_delay_is_solved_with_the_motion) {
  const std::string json = R"-({
  "analysis": {"kind": "dynamic", "end_time": 1, "step_size": 2e-3, "tolerance": 1e-11},
  "bodies": [{"name": "mass", "mass": 2, "inertia": [1, 1, 1], "position": [1, 0, 0]}],
  "joints": [{"name": "rail", "kind": "prismatic", "first": "ground", "second": "mass", "axis": [1, 0, 0],
              "forces": [{"effort": {"signal": "push"}, "stiffness": 20, "rest": 0.1, "damping": 0.5}]}],
  "springs": [{"name": "wall", "first": "ground", "second": "mass", "stiffness": 300, "damping": 4}],
  "signals": [{"name": "tension", "kind": "spring_tension", "spring": "wall"},
              {"name": "push", "kind": "formula", "expression": "5*(20 - tension)"},
              {"name": "effort", "kind": "joint_effort", "joint": "rail"}],
  "sensors": [{"name": "x", "kind": "position", "at": "mass"}, {"name": "v", "kind": "velocity", "at": "mass"},
              {"name": "tension", "kind": "signal", "signal": "tension"},
              {"name": "effort", "kind": "signal", "signal": "effort"}]})-";
  for (const Way& way : ways) {
    SCOPED_TRACE(way.name());
    std::vector<std::string> overrides = way.overrides(2e-3);
    const Outcome loop = run_ok(scene_of(json, overrides));
    const double u = loop.history.last("x.x") - 1.0, v = loop.history.last("v.vx");
    EXPECT_NEAR(loop.history.last("tension"), 300.0 * u + 4.0 * v, 1e-9);
    EXPECT_NEAR(loop.history.last("effort"), 5.0 * (20.0 - loop.history.last("tension")) - 20.0 * (u - 0.1) - 0.5 * v,
                1e-9);
    overrides.emplace_back("/springs/0/stiffness=1800");
    overrides.emplace_back("/springs/0/damping=24");
    overrides.emplace_back("/joints/0/forces/0/effort=100");
    const Outcome plain = run_ok(scene_of(json, overrides));
    for (std::size_t i = 0; i < plain.history.rows.size(); ++i)
      EXPECT_NEAR(loop.history.of("x.x")[i], plain.history.of("x.x")[i], 1e-10);
  }
}

// A rod between two points: its multiplier is its force. A weight on it, at rest.
TEST(Drives, the_force_of_a_rod_is_read) {
  const std::string json = R"-({
  "gravity": [0, 0, -10],
  "analysis": {"kind": "dynamic", "end_time": 0.01, "step_size": 1e-3},
  "bodies": [{"name": "weight", "kind": "point_mass", "mass": 3, "position": [0, 0, -2]}],
  "joints": [{"name": "rod", "kind": "distance", "first": "ground", "second": "weight"}],
  "signals": [{"name": "force", "kind": "joint_effort", "joint": "rod"},
              {"name": "slow", "kind": "state", "expression": "(force - slow)/0.01"}],
  "sensors": [{"name": "force", "kind": "signal", "signal": "force"},
              {"name": "slow", "kind": "signal", "signal": "slow"}]})-";
  const Outcome r = run_ok(scene_of(json));
  EXPECT_NEAR(r.history.first("force"), -30.0, 1e-9) << "a rod under tension pulls the second towards the first";
  EXPECT_NEAR(r.history.last("force"), -30.0, 1e-9);
  EXPECT_NEAR(r.history.last("slow"), -30.0 * (1.0 - std::exp(-1.0)), 2e-2);
}

// A torque from a table of angle and rate whose values a bilinear function has is that function.
TEST(Drives, a_table_of_two_signals_is_the_function_that_it_holds) {
  const std::string json = R"-({
  "analysis": {"kind": "dynamic", "end_time": 1, "step_size": 0.01, "tolerance": 1e-11},
  "bodies": [{"name": "rotor", "mass": 2, "inertia": [0.5, 0.5, 0.5]}],
  "joints": [{"name": "axle", "kind": "revolute", "first": "ground", "second": "rotor", "axis": [0, 0, 1],
              "forces": [{"effort": {"signal": "torque"}}]}],
  "signals": [{"name": "angle", "kind": "joint_angle", "joint": "axle"},
              {"name": "rate", "kind": "joint_rate", "joint": "axle"},
              {"name": "torque", "kind": "surface", "of": ["angle", "rate"], "x": [-1, 0.3, 4], "y": [-5, 0, 1, 9],
               "values": [[0, 0, 0, 0], [0, 0, 0, 0], [0, 0, 0, 0]]}],
  "sensors": [{"name": "angle", "kind": "joint_angle", "joint": "axle"}]})-";
  std::string table;
  for (const double x : {-1.0, 0.3, 4.0}) {
    table += table.empty() ? "[[" : "], [";
    for (const double y : {-5.0, 0.0, 1.0, 9.0})
      table += (y == -5.0 ? "" : ", ") + support::text(2.0 - 3.0 * x - 0.5 * y - 0.2 * x * y);
  }
  const std::string values = "/signals/2/values=" + table + "]]";
  for (const Way& way : ways) {
    std::vector<std::string> overrides = way.overrides(0.01);
    overrides.push_back(values);
    const Outcome a = run_ok(scene_of(json, overrides));
    overrides.back() =
        R"-(/signals/2={"name": "torque", "kind": "formula", "expression": "2 - 3*angle - 0.5*rate - 0.2*angle*rate"})-";
    const Outcome b = run_ok(scene_of(json, overrides));
    for (std::size_t i = 0; i < a.history.rows.size(); ++i)
      EXPECT_NEAR(a.history.of("angle")[i], b.history.of("angle")[i], 1e-10) << way.name();
  }
}

// Every component that a row holds alone is that of the sensor: a body under forces and moments that change, held by a
// joint whose first frame has the ground's axes, and another body clamped to it; with and without what the plan
// decides.
TEST(Drives, a_signal_reads_what_the_sensor_of_a_reaction_measures) {
  const struct {
    const char* kind;
    std::vector<std::string> components;
  } joints[] = {{"fixed", {"fx", "fy", "fz", "mx", "my", "mz"}},
                {"revolute", {"fx", "fy", "fz", "mx", "my"}},
                {"prismatic", {"fx", "fy", "mx", "my", "mz"}},
                {"cylindrical", {"fx", "fy", "mx", "my"}},
                {"spherical", {"fx", "fy", "fz"}},
                {"planar", {"fz", "mx", "my"}}};
  for (const auto& joint : joints)
    for (const bool in_plane : {false, true})
      for (const char* without : {"[]", "[\"planar\", \"translation\", \"line\", \"held\", \"welded\"]"}) {
        SCOPED_TRACE(std::string(joint.kind) + (in_plane ? " in a plane" : "") + " without " + without);
        std::string signals, sensors;
        for (const std::string& c : joint.components) {
          signals += std::string(signals.empty() ? "" : ", ") + R"-({"name": "s_)-" + c +
                     R"-(", "kind": "joint_reaction", "joint": "joint", "component": ")-" + c + "\"}";
          sensors += R"-(, {"name": ")-" + c + R"-(", "kind": "signal", "signal": "s_)-" + c + "\"}";
        }
        const std::string force = in_plane ? "[3, -2, 0]" : "[3, -2, 5]", moment = in_plane ? "[0, 0, 2]" : "[1, 3, 2]";
        const Outcome out =
            run_ok(scene_of(R"-({"analysis": {"kind": "dynamic", "end_time": 0.3, "step_size": 5e-3},
  "bodies": [{"name": "a", "mass": 2, "inertia": [0.3, 0.4, 0.5], "center_of_mass": [0.3, 0.1, 0]},
    {"name": "b", "mass": 1, "inertia": [0.1, 0.2, 0.15], "position": [0.8, 0, 0]}],
  "joints": [{"name": "joint", "kind": ")-" +
                                std::string(joint.kind) +
                                R"-(", "first": {"to": "ground", "rotation": {"axis": [0, 0, 1], "angle": 0}},
     "second": {"to": "a", "rotation": {"axis": [0, 0, 1], "angle": 0}}, "position": [0, 0, 0]},
    {"name": "clamp", "kind": "fixed", "first": "a", "second": "b"}],
  "loads": [{"at": "b", "force": )-" +
                                force + R"-(, "moment": )-" + moment +
                                R"-(, "law": {"expression": "2 + sin(9*t)"}}],
  "signals": [)-" + signals + R"-(],
  "sensors": [{"name": "all", "kind": "joint_reaction", "joint": "joint"})-" +
                                sensors + "]}",
                            {std::string("/without=") + without, "/analysis/tolerance=1e-11"}));
        for (const double t : out.history.times)
          for (const std::string& c : joint.components)
            EXPECT_NEAR(out.history.at(c, t), out.history.at("all." + c, t), 1e-8) << c << " at " << t;
      }
}

// Friction that follows the force on a rail with a lag T, n' = (m g - n) / T, n(0) = 0:
//   v = v0 - mu g (t - T (1 - exp(-t / T)))
TEST(Drives, an_effort_follows_a_reaction_through_a_state) {
  const double mu = 0.3, g = 9.81, T = 0.2, t = 0.5;
  const Outcome out = run_ok(scene_of(R"-({"gravity": [0, 0, -9.81],
  "analysis": {"kind": "dynamic", "end_time": 0.5, "step_size": 1e-3},
  "bodies": [{"name": "block", "mass": 4, "inertia": [0.3, 0.4, 0.5]}],
  "joints": [{"name": "rail", "kind": "prismatic", "first": "ground", "second": "block", "axis": [1, 0, 0],
     "second_axis": [0, 1, 0], "forces": [{"effort": {"signal": "friction"}}]}],
  "initial_velocities": [{"of": "block", "velocity": [3, 0, 0]}],
  "signals": [{"name": "normal", "kind": "joint_reaction", "joint": "rail", "component": "fy"},
    {"name": "pressed", "kind": "state", "expression": "(normal - pressed)/0.2"},
    {"name": "friction", "kind": "formula", "expression": "-0.3*pressed"}],
  "sensors": [{"name": "v", "kind": "joint_rate", "joint": "rail"},
    {"name": "normal", "kind": "signal", "signal": "normal"}]})-"));
  EXPECT_NEAR(out.history.last("normal"), 4.0 * g, 1e-9);  // axes of the rail: (y, z, x)
  EXPECT_NEAR(out.history.last("v"), 3.0 - mu * g * (t - T * (1.0 - std::exp(-t / T))), 1e-5);
}

// A fixed joint whose reaction a signal reads is kept: 6 N accelerate 3 kg, of which it carries 1 kg.
TEST(Drives, a_fixed_joint_that_a_signal_reads_is_not_left_out) {
  const Outcome out = run_ok(scene_of(R"-({"analysis": {"kind": "dynamic", "end_time": 0.1},
  "bodies": [{"name": "a", "mass": 2, "inertia": [0.3, 0.4, 0.5]}, {"name": "b", "mass": 1, "inertia": [0.1, 0.2, 0.15]}],
  "joints": [{"name": "rail", "kind": "prismatic", "first": "ground", "second": "a", "axis": [1, 0, 0]},
    {"name": "clamp", "kind": "fixed", "first": "a", "second": "b"}],
  "loads": [{"at": "a", "force": [6, 0, 0]}],
  "signals": [{"name": "carried", "kind": "joint_reaction", "joint": "clamp", "component": "fx"}],
  "sensors": [{"name": "carried", "kind": "signal", "signal": "carried"}]})-"));
  EXPECT_NEAR(out.history.last("carried"), 2.0, 1e-10);
}

// A force that follows a reaction at once would follow from itself.
TEST(Drives, an_effort_that_is_a_reaction_is_refused) {
  std::string cause;
  try {
    (void)scene_of(R"-({"analysis": {"kind": "dynamic", "end_time": 0.5},
  "bodies": [{"name": "block", "mass": 4, "inertia": [0.3, 0.4, 0.5]}],
  "joints": [{"name": "rail", "kind": "prismatic", "first": "ground", "second": "block", "axis": [1, 0, 0],
     "forces": [{"effort": {"signal": "normal"}}]}],
  "signals": [{"name": "normal", "kind": "joint_reaction", "joint": "rail", "component": "fy"}]})-");
  } catch (const std::exception& e) {
    cause = e.what();
  }
  EXPECT_NE(cause.find("/joints/0/forces/0/effort/signal"), std::string::npos) << cause;
  EXPECT_NE(cause.find("would follow from itself"), std::string::npos) << cause;
}

}  // namespace
}  // namespace bough::run
