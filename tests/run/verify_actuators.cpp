// Servos with a lag and a limit, against closed forms.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "support/scenes.hpp"

namespace bough::run {
namespace {

using support::Outcome;
using support::run_ok;
using support::scene_of;

/// A wheel of 2 kg m^2 on a hinge, with a servo; where it hangs in space is told by its axis.
std::string wheel(const std::string& servo, double end, const std::string& more = "") {
  return R"-({"analysis": {"kind": "dynamic", "end_time": )-" + support::text(end) +
         R"-(, "step_size": 0.01, "tolerance": 1e-11},
  "bodies": [{"name": "wheel", "mass": 3, "inertia": [2, 2, 2]}],
  "joints": [{"name": "hinge", "kind": "revolute", "first": "ground", "second": "wheel", "axis": [0, 0, 1]}],
  "actuators": [{"name": "servo", "kind": "servo", "joint": "hinge", )-" +
         servo + R"-(}],
  "sensors": [{"name": "angle", "kind": "joint_angle", "joint": "hinge"},
    {"name": "rate", "kind": "joint_rate", "joint": "hinge"},
    {"name": "torque", "kind": "signal", "signal": "servo"}])-" +
         more + "}";
}

/// A servo whose closed loop on a wheel of inertia J has the poles -a, -b, -c:
///   lag = 1/(a + b + c),  rate_gain = J lag (ab + bc + ca),  position_gain = J lag abc
struct Poles {
  double a = 2.0, b = 5.0, c = 11.0, J = 2.0;
  double lag() const { return 1.0 / (a + b + c); }
  double rate_gain() const { return J * lag() * (a * b + b * c + c * a); }
  double position_gain() const { return J * lag() * a * b * c; }
  std::string text(const std::string& target, double limit) const {
    return "\"position_gain\": " + support::text(position_gain()) + ", \"rate_gain\": " + support::text(rate_gain()) +
           ", \"lag\": " + support::text(lag()) + ", \"limit\": " + support::text(limit) + ", \"target\": " + target;
  }
  /// 1 - angle after a step of the target from 0 to 1, and its first two derivatives: without torque and speed at the
  /// start, sum of A_i exp(-p_i t) with sum A_i = 1, sum p_i A_i = 0, sum p_i^2 A_i = 0.
  double left(double t, int derivative) const {
    const double p[3] = {a, b, c};
    double sum = 0.0;
    for (int i = 0; i < 3; ++i) {
      const double q = p[(i + 1) % 3], r = p[(i + 2) % 3];
      sum += q * r / ((q - p[i]) * (r - p[i])) * std::pow(-p[i], derivative) * std::exp(-p[i] * t);
    }
    return sum;
  }
};

// Within its limit, the closed loop is that of its poles: order 2 and 3, in space and in a plane, torque included.
TEST(Actuators, a_servo_has_the_poles_of_its_gains_and_lag) {
  const Poles poles;
  const double end = 0.6;
  const struct {
    const char *integrator, *without;
    double order;
  } ways[] = {{"generalized_alpha", "[]", 2.0},
              {"generalized_alpha", "[\"planar\"]", 2.0},
              {"bdf", "[]", 3.0},
              {"bdf", "[\"planar\"]", 3.0}};
  const std::pair<const char*, double> exact[] = {
      {"angle", 1.0 - poles.left(end, 0)}, {"rate", -poles.left(end, 1)}, {"torque", -poles.J * poles.left(end, 2)}};
  for (const auto& way : ways) {
    SCOPED_TRACE(std::string(way.integrator) + " without " + way.without);
    const auto run = [&](double h) {
      return run_ok(scene_of(wheel(poles.text("1", 1e3), end),
                             {std::string("/analysis/integrator=") + way.integrator,
                              std::string("/without=") + way.without, "/analysis/step_size=" + support::text(h)}));
    };
    const Outcome coarse = run(0.005), fine = run(0.0025);
    for (const auto& [column, value] : exact) {
      EXPECT_NEAR(fine.history.last(column), value, 3e-4) << column;
      EXPECT_NEAR(
          std::log2(std::abs(coarse.history.last(column) - value) / std::abs(fine.history.last(column) - value)),
          way.order, 0.3)
          << column;
    }
  }
}

// At its limit F, T = F (1 - exp(-t/lag)). When the target jumps to the other side the command does, and the torque
// goes there at once, as T = F (2 exp(-(t - t1)/lag) - 1) if the first exponential is over: nothing has wound up.
TEST(Actuators, a_limited_servo_does_not_wind_up) {
  const double lag = 0.05, F = 4.0, t1 = 1.5, end = 1.6, J = 2.0;
  const Outcome out =
      run_ok(scene_of(wheel(R"-("position_gain": 1e4, "lag": 0.05, "limit": 4, "target": {"kind": "piecewise",
        "pieces": [{"start": 0, "law": 1e3}, {"start": 1.5, "law": -1e3}]})-",
                            end),
                      {"/analysis/step_size=1e-3"}));
  const auto torque = [&](double t) {
    const double grown = F * (1.0 - std::exp(-std::min(t, t1) / lag));
    return t < t1 ? grown : -F + (grown + F) * std::exp(-(t - t1) / lag);
  };
  const double lost = 1.0 - std::exp(-t1 / lag), rate_1 = F / J * (t1 - lag * lost);
  for (const double t : {0.05, 0.3, 1.5, 1.52, 1.55, 1.6})
    EXPECT_NEAR(out.history.at("torque", t), torque(t), 2e-4) << t;
  EXPECT_NEAR(out.history.at("rate", t1), rate_1, 1e-6);
  EXPECT_NEAR(out.history.last("rate"),
              rate_1 + (-F * (end - t1) + (F * lost + F) * lag * (1.0 - std::exp(-(end - t1) / lag))) / J, 1e-4);
  EXPECT_LE(out.history.largest("torque"), F * (1.0 + 1e-12));
  EXPECT_LT(out.summary.checks.energy_balance, 1e-4 * out.summary.checks.energy_scale);
}

// Without gains, the effort of the start fades with the lag: T = T_0 exp(-t / lag).
TEST(Actuators, the_effort_of_the_start_fades_with_the_lag) {
  const Outcome out =
      run_ok(scene_of(wheel(R"-("lag": 0.2, "limit": 4, "start": 3)-", 0.3), {"/analysis/step_size=1e-3"}));
  EXPECT_NEAR(out.history.first("torque"), 3.0, 1e-12);
  EXPECT_NEAR(out.history.last("torque"), 3.0 * std::exp(-1.5), 1e-5);
}

// A servo of speed follows a ramp of the target rate with the lag of its closed loop; a signal may be the target.
TEST(Actuators, a_servo_follows_the_rate_that_a_signal_gives) {
  const Outcome out = run_ok(
      scene_of(wheel(R"-("rate_gain": 40, "lag": 0.005, "limit": 1e3, "target_rate": {"signal": "wanted"})-", 2.0,
                     R"-(, "signals": [{"name": "wanted", "kind": "time", "law": {"expression": "3*t"}},
              {"name": "twice", "kind": "formula", "expression": "2*servo"}])-"),
               {"/analysis/step_size=1e-3"}));
  // Once settled, the wheel accelerates by 3 rad/s^2 under 6 N m, 6/40 rad/s behind.
  EXPECT_NEAR(out.history.last("torque"), 6.0, 1e-6);
  EXPECT_NEAR(out.history.last("rate"), 6.0 - 6.0 / 40.0, 1e-6);
}

// Without a limit and a lag the effort is the sum of gains itself, a spring and a damper.
TEST(Actuators, a_servo_without_limit_and_lag_is_a_spring_and_a_damper) {
  const Outcome servo = run_ok(
      scene_of(wheel(R"-("position_gain": 50, "rate_gain": 4, "target": 0.3)-", 1.0), {"/analysis/step_size=2e-3"}));
  const double rate = 4.0 / (2.0 * 2.0), own = std::sqrt(50.0 / 2.0 - rate * rate);
  const double left = 0.3 * std::exp(-rate) * (std::cos(own) + rate / own * std::sin(own));
  EXPECT_NEAR(servo.history.last("angle"), 0.3 - left, 2e-5);
  const Outcome limited =
      run_ok(scene_of(wheel(R"-("position_gain": 50, "target": 1e3, "limit": 4)-", 0.5), {"/analysis/step_size=2e-3"}));
  EXPECT_NEAR(limited.history.last("angle"), 0.5 * 4.0 / 2.0 * 0.25, 1e-9);
  const Outcome lagging = run_ok(scene_of(wheel(R"-("lag": 0.2, "start": 3)-", 0.3), {"/analysis/step_size=1e-3"}));
  EXPECT_NEAR(lagging.history.last("torque"), 3.0 * std::exp(-1.5), 1e-5);
  EXPECT_ANY_THROW(scene_of(wheel(R"-("position_gain": 1, "start": 3)-", 0.3)));
}

// The rate of a target is its own, unless another is given: a wheel that starts with the target stays on it up to the
// torque that its acceleration takes, J t^2 / gain, and not a damper's lag behind.
TEST(Actuators, the_rate_of_a_target_follows_by_itself) {
  const std::string gains = R"-("position_gain": 4000, "rate_gain": 400, "target": )-",
                    law = R"-({"expression": "0.5*sin(2*t)"})-";
  const auto behind = [&](const std::string& target, const std::string& more = "", const std::string& other = "") {
    const Outcome out = run_ok(scene_of(wheel(gains + target + more, 1.0, other), {"/analysis/step_size=1e-3"}));
    return 0.5 * std::sin(2.0) - out.history.last("angle");
  };
  const double own = behind(law), given = behind(law, R"-(, "target_rate": {"expression": "cos(2*t)"})-");
  EXPECT_NEAR(own, given, 1e-9);
  EXPECT_LT(std::abs(own), 0.01);
  EXPECT_GT(std::abs(behind(law, R"-(, "target_rate": 0)-")), 0.02);
  const std::string time = R"-(, "signals": [{"name": "wanted", "kind": "time", "law": )-" + law + "}]",
                    state = R"-(, "signals": [{"name": "turning", "kind": "time", "law": {"expression": "cos(2*t)"}},
                      {"name": "wanted", "kind": "state", "expression": "turning"}])-";
  EXPECT_NEAR(behind(R"-({"signal": "wanted"})-", "", time), given, 1e-9);
  EXPECT_NEAR(behind(R"-({"signal": "wanted"})-", "", state), given, 1e-5);
}

// Statics: the gain is a spring up to the limit; a torque beyond it is carried by a stop behind.
TEST(Actuators, statics_hold_against_a_torque) {
  const auto angle = [](double torque) {
    return run_ok(scene_of(R"-({"analysis": {"kind": "static", "tolerance": 1e-12},
  "bodies": [{"name": "wheel", "mass": 3, "inertia": [2, 2, 2]}],
  "joints": [{"name": "hinge", "kind": "revolute", "first": "ground", "second": "wheel", "axis": [0, 0, 1],
    "forces": [{"stiffness": 5}]}],
  "loads": [{"at": "wheel", "moment": [0, 0, )-" +
                           support::text(torque) + R"-(]}],
  "actuators": [{"name": "servo", "kind": "servo", "joint": "hinge", "position_gain": 20, "limit": 6, "lag": 0.1,
    "target": 0.1}],
  "sensors": [{"name": "angle", "kind": "joint_angle", "joint": "hinge"}]})-"))
        .history.last("angle");
  };
  EXPECT_NEAR(angle(3.0), (3.0 + 20.0 * 0.1) / 25.0, 1e-12);
  EXPECT_NEAR(angle(12.0), (12.0 - 6.0) / 5.0, 1e-12);
}

// A cylinder between two points of a boom, in space, is a servo of a strut: it lifts a weight and holds it where the
// gain balances the force of the closed form.
TEST(Actuators, a_servo_of_a_strut_holds_a_boom) {
  const Outcome out = run_ok(scene_of(R"-({"gravity": [0, 0, -9.81],
  "analysis": {"kind": "dynamic", "end_time": 8, "step_size": 5e-3},
  "bodies": [{"name": "boom", "mass": 50, "center_of_mass": [1, 0, 0], "inertia": [1, 20, 20]}],
  "joints": [
    {"name": "pin", "kind": "revolute", "first": "ground", "second": "boom", "axis": [0, -1, 0]},
    {"name": "ram", "kind": "strut", "first": {"to": "ground", "position": [0.6, 0, -1]},
     "second": {"to": "boom", "position": [0.8, 0, 0]}}],
  "actuators": [{"name": "push", "kind": "servo", "joint": "ram", "position_gain": 4e4, "rate_gain": 6e3,
    "limit": 5e3, "lag": 0.01, "target": 1.3}],
  "sensors": [{"name": "angle", "kind": "joint_angle", "joint": "pin"},
    {"name": "length", "kind": "joint_displacement", "joint": "ram"},
    {"name": "push", "kind": "signal", "signal": "push"}]})-"));
  const double angle = out.history.last("angle"), length = out.history.last("length");
  EXPECT_NEAR(out.history.last("push"), 4e4 * (1.3 - length), 1e-3);
  // Moments about the pin: the ram's force times its lever is that of the weight.
  const double x = 0.8 * std::cos(angle), z = 0.8 * std::sin(angle);
  const double lever = (x * (z + 1.0) - z * (x - 0.6)) / std::hypot(x - 0.6, z + 1.0);
  EXPECT_NEAR(out.history.last("push") * lever, 50.0 * 9.81 * std::cos(angle), 1e-2);
  EXPECT_LT(out.summary.checks.energy_balance, 1e-3 * out.summary.checks.energy_scale);
}

// Step control compares the state with the limit: a limit and inertias a thousand times as large take the same steps.
TEST(Actuators, errors_count_relative_to_the_limit) {
  const auto steps = [](const char* inertia, const char* limit, const char* gain) {
    return run_ok(scene_of(wheel(std::string("\"position_gain\": ") + gain + ", \"rate_gain\": " + gain +
                                     ", \"lag\": 0.1, \"target\": 1, \"limit\": " + limit,
                                 2.0),
                           {std::string("/bodies/0/inertia=[") + inertia + ", " + inertia + ", " + inertia + "]",
                            std::string("/bodies/0/mass=") + inertia, "/analysis/step_control={}"}))
        .summary.steps.accepted;
  };
  EXPECT_EQ(steps("2", "3", "8"), steps("2000", "3000", "8000"));
}

}  // namespace
}  // namespace bough::run
