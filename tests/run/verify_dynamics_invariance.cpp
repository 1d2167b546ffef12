// What must not change: momentum in free flight, the motion seen from another place, balances as the step shrinks.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "bough/motion/se3.hpp"
#include "bough/results/balance.hpp"
#include "support/scenes.hpp"
#include "support/stepper.hpp"

namespace bough::run {
namespace {

using support::Table;

const std::string free_body_text = R"({
    "bodies": [{"name": "body", "mass": 2, "inertia": [1, 2, 3], "center_of_mass": [0.2, 0.3, -0.1]}],
    "initial_velocities": [{"of": "body", "velocity": [1.3, -0.7, 0.4], "angular_velocity": [0, 0, 0]}],
    "sensors": [{"name": "v", "kind": "velocity", "at": "body"}, {"name": "x", "kind": "position", "at": "body"}],
    "analysis": {"kind": "dynamic", "end_time": 100, "step_size": 1e-3}, "output": {"stride": 1000}})";

const std::string free_beam_text = R"({
    "sections": [{"name": "section", "stiffness": {"EA": 1e4, "GA2": 4e3, "GA3": 4e3, "GJ": 50, "EI2": 60, "EI3": 40},
                  "mass": {"mass_per_length": 1.5, "rotary": [0.02, 0.01, 0.01]}}],
    "nodes": [{"name": "start", "position": [1, 2, 3]}, {"name": "end", "position": [2, 2.5, 2.5]}],
    "beams": [{"name": "beam", "section": "section", "start": "start", "end": "end", "elements": 2}],
    "initial_velocities": [{"of": "beam", "velocity": [1.3, -0.7, 0.4], "angular_velocity": [0, 0, 0]}],
    "sensors": [{"name": "v", "kind": "velocity", "at": "start"}, {"name": "x", "kind": "position", "at": "start"}],
    "analysis": {"kind": "dynamic", "end_time": 100, "step_size": 1e-3}, "output": {"stride": 1000}})";

void expect_straight_flight(const std::string& text) {
  const support::Outcome outcome = support::run(support::scene_of(text));
  ASSERT_TRUE(outcome.ok()) << outcome.summary.cause;
  EXPECT_EQ(outcome.summary.steps.accepted, 100000);
  const double v[3] = {1.3, -0.7, 0.4}, speed = std::sqrt(1.3 * 1.3 + 0.7 * 0.7 + 0.4 * 0.4);
  const char* axes[3] = {"x", "y", "z"};
  double drift = 0.0, distance = 0.0;
  for (int k = 0; k < 3; ++k) {
    for (double now : outcome.history.of(std::string("v.v") + axes[k]))
      drift = std::max(drift, std::abs(now - v[k]) / speed);
    const std::string x = std::string("x.") + axes[k];
    distance = std::max(distance,
                        std::abs(outcome.history.last(x) - outcome.history.first(x) - 100.0 * v[k]) / (100.0 * speed));
  }
  std::printf("free flight, 1e5 steps: drift of velocity %.1e, of place %.1e (relative)\n", drift, distance);
  EXPECT_LT(drift, 1e-10);
  EXPECT_LT(distance, 1e-10);
}

TEST(Invariance, a_body_that_does_not_turn_keeps_its_momentum_for_1e5_steps) { expect_straight_flight(free_body_text); }
TEST(Invariance, a_beam_that_does_not_turn_keeps_its_momentum_for_1e5_steps) { expect_straight_flight(free_beam_text); }

/// Largest drift of linear and angular momentum, relative to their size, over time T; about the inertial origin.
struct Drift {
  double linear = 0.0, angular = 0.0,
         spin = 0.0;  ///< spin: angular momentum of the first node's body about its mass centre, R J w
};
Drift drift_of(const std::string& text, double h, double duration) {
  support::Stepper s(
      support::scene_of(text, {"/initial_velocities/0/angular_velocity=[1.5, 3, 1]", "/analysis/tolerance=1e-11"}));
  s.start(h);
  results::EnergyMeter meter(s.system().plan());
  const motion::Vec6<double> first = meter.eval(s.system(), s.state()).momentum;
  const auto spin = [&s] {
    const elements::NodeMotion& n = nodes_in_space(s.system().plan(), s.state()).front();
    return n.R * motion::Vec3<double>{{1.0 * n.v[3], 2.0 * n.v[4], 3.0 * n.v[5]}};
  };
  const motion::Vec3<double> first_spin = spin();
  Drift d;
  const long steps = std::lround(duration / h);
  for (long k = 1; k <= steps; ++k) {
    s.step(static_cast<double>(k) * h);
    const motion::Vec6<double> now = meter.eval(s.system(), s.state()).momentum - first;
    d.linear = std::max(d.linear, std::sqrt(lanes::dot(lanes::linear_part(now), lanes::linear_part(now)) /
                                            lanes::dot(lanes::linear_part(first), lanes::linear_part(first))));
    d.angular = std::max(d.angular, std::sqrt(lanes::dot(lanes::angular_part(now), lanes::angular_part(now)) /
                                              lanes::dot(lanes::angular_part(first), lanes::angular_part(first))));
    const motion::Vec3<double> turned = spin() - first_spin;
    d.spin = std::max(d.spin, std::sqrt(lanes::dot(turned, turned) / lanes::dot(first_spin, first_spin)));
  }
  return d;
}

void expect_drift_of_second_order(const std::string& name, const std::string& text, double h, double duration) {
  const Drift a = drift_of(text, h, duration), b = drift_of(text, h / 2, duration), c = drift_of(text, h / 4, duration);
  const Drift longer = drift_of(text, h / 2, 4 * duration);
  std::printf(
      "%s that turns: drift of momentum %.1e %.1e %.1e, of angular momentum %.1e %.1e %.1e; four times as long %.1e, "
      "%.1e\n",
      name.c_str(), a.linear, b.linear, c.linear, a.angular, b.angular, c.angular, longer.linear, longer.angular);
  EXPECT_NEAR(support::order_of(b.angular, c.angular), 2.0, 0.2);
  EXPECT_NEAR(support::order_of(a.angular, b.angular), 2.0, 0.3);
  EXPECT_LT(longer.angular, 17.0 * b.angular);
}

TEST(Invariance, angular_momentum_of_a_turning_body_drifts_with_h_squared) {
  expect_drift_of_second_order("a body", free_body_text, 0.02, 10.0);
}
TEST(Invariance, angular_momentum_of_a_turning_beam_drifts_with_h_squared) {
  expect_drift_of_second_order("a beam", free_beam_text, 0.004, 2.0);
}

/// A body that spins by up to a radian a step, with axes and an origin askew and away from its mass centre, in space or
/// with the spin along one axis (a plane). Its mass centre flies along the parabola that gravity gives it.
void expect_parabola(const std::string& spin, double h, const std::string& center, const std::string& rotation,
                     const scene::Vec3& gravity) {
  SCOPED_TRACE(spin + " rad/s, h = " + support::text(h) + ", centre " + center);
  const support::Outcome run = support::run(support::scene_of(
      R"({"gravity": [)" + support::text(gravity[0]) + ", " + support::text(gravity[1]) + ", " +
      support::text(gravity[2]) + R"(], "bodies": [{"name": "body", "mass": 2, "inertia": [0.04, 0.05, 0.03],
        "center_of_mass": )" +
      center + R"(, "rotation": )" + rotation + R"(}],
      "initial_velocities": [{"of": "body", "velocity": [10, -5, 0], "angular_velocity": )" +
      spin + R"(}],
      "sensors": [{"name": "x", "kind": "position", "at": {"to": "body", "position": )" +
      center + R"(}},
        {"name": "v", "kind": "velocity", "at": {"to": "body", "position": )" +
      center + R"(}}],
      "analysis": {"kind": "dynamic", "tolerance": 1e-12, "end_time": 1, "step_size": )" +
      support::text(h) + "}}"));
  ASSERT_TRUE(run.ok()) << run.summary.cause;
  const support::Table& t = run.history;
  const char* axes[] = {"x", "y", "z"};
  for (int k = 0; k < 3; ++k) {
    const std::string x = std::string("x.") + axes[k], v = std::string("v.v") + axes[k];
    const double g = gravity[k], start = t.first(v);
    EXPECT_NEAR(t.last(v), start + g, 1e-9) << v;
    EXPECT_NEAR(t.last(x), t.first(x) + start + 0.5 * g, 1e-9) << x;
  }
  EXPECT_LT(run.summary.checks.momentum_balance, 1e-8);
}

TEST(Invariance, a_body_in_free_flight_keeps_its_momentum_under_any_spin) {
  const std::string askew = R"({"axis": [1, 2, 3], "angle": 0.7})", straight = R"({"axis": [0, 0, 1], "angle": 0})";
  for (const double h : {1e-3, 1e-2})
    for (const scene::Vec3& gravity : {scene::Vec3{{0, 0, 0}}, scene::Vec3{{1, 2, -9.81}}}) {
      expect_parabola("[100, 0, 0]", h, "[0, 0, 0]", straight, gravity);
      expect_parabola("[60, 50, -40]", h, "[0.2, -0.1, 0.3]", askew, gravity);
    }
  for (const double h : {1e-3, 1e-2}) expect_parabola("[0, 0, 80]", h, "[0.1, 0.2, 0]", straight, {{0, -9.81, 0}});
}

/// Three bodies of 1, 2 and 3 kg in a row, on hinges between them whose axes are that of their spin. The row turns like
/// one body about its mass centre at x = 1/3 m, which flies on; hinges see no moment. Steps describe the whole row
/// relative to one frame, in which the twist of each body is constant.
TEST(Invariance, a_row_of_hinged_bodies_that_spins_flies_straight) {
  const double w = 50.0, center = 1.0 / 3.0;
  for (const double along : {0.0, 2.0}) {  // in a plane, and in space
    SCOPED_TRACE(along);
    const double velocity[3] = {10.0, -5.0, along};
    std::string bodies, velocities;
    for (int k = 0; k < 3; ++k) {
      const std::string name(1, "abc"[k]), x = support::text(k - 1.0), separator = k == 0 ? "" : ", ";
      bodies += separator + R"({"name": ")" + name + R"(", "mass": )" + support::text(k + 1.0) +
                R"(, "inertia": [0.03, 0.04, 0.05], "position": [)" + x + ", 0, 0]}";
      velocities += separator + R"({"of": ")" + name + R"(", "velocity": [)" + support::text(velocity[0]) + ", " +
                    support::text(velocity[1] + w * (k - 1.0 - center)) + ", " + support::text(velocity[2]) +
                    R"(], "angular_velocity": [0, 0, )" + support::text(w) + "]}";
    }
    const support::Outcome run = support::run(support::scene_of(R"({"bodies": [)" + bodies + R"(], "joints": [
        {"name": "ab", "kind": "revolute", "first": "a", "second": "b", "position": [-0.5, 0, 0], "axis": [0, 0, 1]},
        {"name": "bc", "kind": "revolute", "first": "b", "second": "c", "position": [0.5, 0, 0], "axis": [0, 0, 1]}],
        "initial_velocities": [)" + velocities + R"(], "sensors": [{"name": "a", "kind": "position", "at": "a"},
          {"name": "c", "kind": "position", "at": "c"}], "analysis": {"kind": "dynamic", "tolerance": 1e-12, "end_time": 1, "step_size": 1e-3}})"));
    ASSERT_TRUE(run.ok()) << run.summary.cause;
    for (int k : {0, 2}) {
      const std::string name(1, "abc"[k]);
      const double arm = k - 1.0 - center;
      EXPECT_NEAR(run.history.last(name + ".x"), center + velocity[0] + arm * std::cos(w), 1e-8) << name;
      EXPECT_NEAR(run.history.last(name + ".y"), velocity[1] + arm * std::sin(w), 1e-8) << name;
      EXPECT_NEAR(run.history.last(name + ".z"), velocity[2], 1e-9) << name;
    }
    EXPECT_LT(run.summary.checks.momentum_balance, 1e-8);
  }
}

TEST(Invariance, spin_of_a_turning_body_stays_within_a_bound_that_shrinks_with_h_squared) {
  const Drift a = drift_of(free_body_text, 0.02, 20.0), b = drift_of(free_body_text, 0.01, 20.0),
              c = drift_of(free_body_text, 0.005, 20.0);
  const Drift longer = drift_of(free_body_text, 0.01, 160.0);
  std::printf("a body that turns: drift of R J w %.1e %.1e %.1e, eight times as long %.1e\n", a.spin, b.spin, c.spin,
              longer.spin);
  EXPECT_NEAR(support::order_of(a.spin, b.spin), 2.0, 0.2);
  EXPECT_NEAR(support::order_of(b.spin, c.spin), 2.0, 0.2);
  EXPECT_LT(longer.spin, 9.0 * b.spin);
}

/// Beams of two orders, a body, joints of several kinds, a spring, dead and follower loads, a drive, gravity askew.
const std::string mechanism_text = R"({
    "gravity": [1, -2, -9],
    "sections": [{"name": "section", "stiffness": {"EA": 2e4, "GA2": 8e3, "GA3": 8e3, "GJ": 20, "EI2": 40, "EI3": 30},
                  "mass": {"mass_per_length": 1.5, "rotary": [0.02, 0.01, 0.01]}, "damping": {"time": 1e-3}}],
    "nodes": [{"name": "A"}, {"name": "B of AB", "position": [0, 0.5, 0.1]}, {"name": "B of BC", "position": [0, 0.5, 0.1]},
              {"name": "C", "position": [1, 0.6, -0.2]}],
    "bodies": [{"name": "block", "mass": 1, "inertia": [0.02, 0.03, 0.04], "position": [1, 0.6, -0.2], "center_of_mass": [0.05, 0, 0.1]}],
    "beams": [
      {"name": "AB", "section": "section", "start": "A", "end": "B of AB", "elements": 3, "axis_2": [0, 0, 1]},
      {"name": "BC", "section": "section", "start": "B of BC", "end": "C", "elements": 2, "order": 2, "axis_2": [0, 1, 0]}],
    "joints": [
      {"name": "motor", "kind": "revolute", "first": "ground", "second": "A", "position": [0, 0, 0], "axis": [0, 0.2, 1],
       "drives": [{"law": {"expression": "0.8*t^2"}}]},
      {"name": "elbow", "kind": "universal", "first": "B of AB", "second": "B of BC", "position": [0, 0.5, 0.1], "axis": [0, 0, 1], "second_axis": [0, 1, 0]},
      {"name": "wrist", "kind": "revolute", "first": "C", "second": "block", "position": [1, 0.6, -0.2], "axis": [1, 1, 0],
       "forces": [{"stiffness": 2, "damping": 0.1, "rest": 0.3}]}],
    "springs": [{"name": "spring", "first": {"to": "ground", "position": [1, 0, 1]}, "second": {"to": "block", "position": [0.1, 0, 0]}, "stiffness": 30}],
    "loads": [
      {"name": "dead", "at": "block", "force": [1, 2, 3], "moment": [0.1, -0.1, 0.2]},
      {"name": "follower", "at": "C", "axes": "body", "force": [0, 1, -2], "law": {"expression": "sin(5*t) + 0"}},
      {"name": "wind", "beam": "AB", "force": [0, 1, 2]}],
    "sensors": [
      {"name": "x", "kind": "position", "at": "block"}, {"name": "tip", "kind": "position", "beam": "BC", "station": 0.6},
      {"name": "v", "kind": "velocity", "at": "block", "axes": "body"}, {"name": "a", "kind": "acceleration", "at": "C", "axes": "body"},
      {"name": "AB", "kind": "section_force", "beam": "AB", "station": 0.2}, {"name": "BC", "kind": "section_strain", "beam": "BC", "station": 0.5},
      {"name": "motor", "kind": "joint_reaction", "joint": "motor", "axes": "body"}, {"name": "wrist", "kind": "joint_angle", "joint": "wrist"},
      {"name": "strain", "kind": "strain_energy"}],
    "analysis": {"kind": "dynamic", "end_time": 1, "step_size": 2e-3, "tolerance": 1e-11}})";

/// Largest difference of two runs by sensor, each relative to the sensor's largest value; positions transformed back
/// by `place`.
double largest_difference(const Table& here, const Table& there, const scene::Frame& place) {
  double most = 0.0;
  for (std::size_t first = 0; first < here.columns.size();) {
    const std::string sensor = here.columns[first].substr(0, here.columns[first].find('.'));
    std::size_t last = first;
    while (last < here.columns.size() && here.columns[last].substr(0, here.columns[last].find('.')) == sensor) ++last;
    const bool is_position = sensor == "x" || sensor == "tip";
    double size = 0.0, difference = 0.0;
    for (std::size_t r = 0; r < here.rows.size(); ++r) {
      std::vector<double> b(there.rows[r].begin() + static_cast<std::ptrdiff_t>(first),
                            there.rows[r].begin() + static_cast<std::ptrdiff_t>(last));
      if (is_position) {
        const scene::Vec3 p = lanes::transpose(place.R) * (scene::Vec3{{b[0], b[1], b[2]}} - place.x);
        b.assign(p.v, p.v + 3);
      }
      for (std::size_t k = 0; k < b.size(); ++k) {
        size = std::max(size, std::abs(here.rows[r][first + k]));
        difference = std::max(difference, std::abs(here.rows[r][first + k] - b[k]));
      }
    }
    most = std::max(most, difference / size);
    first = last;
  }
  return most;
}

TEST(Invariance, a_mechanism_turned_and_moved_by_a_kilometre_moves_the_same) {
  const scene::Scene scene = support::scene_of(mechanism_text);
  const support::Outcome here = support::run(scene);
  ASSERT_TRUE(here.ok()) << here.summary.cause;
  // How much the motion itself makes of round-off: a twin whose load differs by 1e-15.
  scene::Scene twin = scene;
  twin.point_loads.front().force = (1.0 + 1e-15) * twin.point_loads.front().force;
  twin.gravity = (1.0 + 1e-15) * twin.gravity;
  const double natural = largest_difference(here.history, support::run(twin).history, scene::Frame::identity());
  for (const scene::Vec3 turn : {scene::Vec3{{0, 0, 0}}, scene::Vec3{{0.7, -1.1, 2.0}}, scene::Vec3{{3.1, 0.1, 0.0}}}) {
    const scene::Frame place{motion::exp_so3(turn), {{600.0, -700.0, 400.0}}};
    const support::Outcome there = support::run(support::moved(scene, place));
    ASSERT_TRUE(there.ok()) << there.summary.cause;
    const double difference = largest_difference(here.history, there.history, place);
    std::printf(
        "moved by 1 km, turned by (%.1f, %.1f, %.1f): largest relative difference %.1e; a perturbation of 1e-15 makes "
        "%.1e\n",
        turn[0], turn[1], turn[2], difference, natural);
    // Loads are rounded to 1e-16 and places are read as numbers of 1e3 with 1e-13 of round-off.
    EXPECT_LT(difference, 1e-9);
  }
}

/// Energy and momentum balance of a conservative system at two step sizes.
void expect_balances_of_second_order(const std::string& name, scene::Scene scene, double h) {
  double energy[3], momentum[3];
  for (int k = 0; k < 3; ++k) {
    scene.analysis.step_size = h / (1 << k);
    scene.analysis.tolerance = 1e-11;
    const support::Outcome outcome = support::run(scene);
    ASSERT_TRUE(outcome.ok()) << outcome.summary.cause;
    energy[k] = outcome.summary.checks.energy_balance / outcome.summary.checks.energy_scale;
    momentum[k] = outcome.summary.checks.momentum_balance;
  }
  std::printf(
      "%s: energy balance %.1e %.1e %.1e of the energy (order %.2f), momentum balance %.1e %.1e %.1e kg m/s (order "
      "%.2f)\n",
      name.c_str(), energy[0], energy[1], energy[2], support::order_of(energy[1], energy[2]), momentum[0], momentum[1],
      momentum[2], support::order_of(momentum[1], momentum[2]));
  EXPECT_GT(support::order_of(energy[1], energy[2]), 1.8) << name;  // beams: their fast motions fade faster than h^2
  EXPECT_NEAR(support::order_of(momentum[1], momentum[2]), 2.0, 0.2) << name;
}

// A drive whose rate jumps gives momentum at once, by an impulse of the ground that no force shows: 2 kg from rest to
// 1.5 m/s. The balance leaves it out.
TEST(Balances, of_momentum_leave_out_what_a_jump_of_a_drive_gives) {
  const support::Outcome run = support::run_ok(support::scene_of(R"({"gravity": [0, 0, -9.81],
    "analysis": {"kind": "dynamic", "end_time": 1, "step_size": 0.01, "tolerance": 1e-11},
    "bodies": [{"name": "sledge", "mass": 2, "inertia": [1, 1, 1]}],
    "joints": [{"name": "rail", "kind": "prismatic", "first": "ground", "second": "sledge", "axis": [1, 0, 0],
      "drives": [{"law": {"kind": "ramp", "start_time": 0.5, "end_time": 1.5, "from": 0, "to": 1.5}}]}],
    "sensors": [{"name": "v", "kind": "velocity", "at": "sledge"}]})"));
  EXPECT_NEAR(run.history.last("v.vx"), 1.5, 1e-9);
  EXPECT_LT(run.summary.checks.momentum_balance, 1e-9);
}

TEST(Balances, shrink_with_h_squared_where_nothing_is_lost) {
  scene::Scene pendulum = support::gallery("double_pendulum");
  pendulum.analysis.end_time = 1.0;
  expect_balances_of_second_order("double pendulum", pendulum, 2e-3);
  scene::Scene bricard = support::gallery("bricard");
  expect_balances_of_second_order("Bricard", bricard, 4e-3);
  scene::Scene mechanism =
      support::scene_of(mechanism_text, {"/sections/0/damping={\"time\": 0}", "/joints/wrist/forces/0/damping=0"});
  expect_balances_of_second_order("mechanism with beams", mechanism, 1e-3);
}

/// Gravity is a potential; the same weights as dead loads at the mass centres are work. Where work is summed exactly,
/// both leave the integrator the same, although its own error is far larger than the difference.
TEST(Balances, tell_the_work_of_constant_loads_like_a_potential) {
  scene::Scene heavy = support::gallery("double_pendulum", {"/analysis/end_time=1", "/analysis/step_size=0.004"});
  heavy.expected.clear();
  heavy.analysis.tolerance = 1e-12;
  scene::Scene loaded = heavy;
  loaded.gravity = scene::Vec3::zero();
  for (const scene::Body& b : heavy.bodies) {
    scene::PointLoad weight;
    weight.name = "weight of " + b.name;
    weight.at.to = b.name;
    weight.at.offset.x = b.center_of_mass;
    weight.force = b.mass * heavy.gravity;
    loaded.point_loads.push_back(weight);
  }
  const support::Outcome a = support::run(heavy), b = support::run(loaded);
  ASSERT_TRUE(a.ok() && b.ok());
  const records::Checks &x = a.summary.checks, &y = b.summary.checks;
  std::printf("energy balance with gravity %.10e J, with dead loads %.10e J\n", x.energy_balance, y.energy_balance);
  EXPECT_GT(x.energy_balance, 1e-6 * x.energy_scale);
  EXPECT_NEAR(x.energy_balance, y.energy_balance, 1e-6 * x.energy_balance);
  EXPECT_NEAR(x.momentum_balance, y.momentum_balance, 1e-6 * x.momentum_balance);
}

/// A crank held to a steady rate by a drive lifts a weight: all energy comes through the drive, whose work is its
/// torque over its angle.
TEST(Balances, tell_the_work_of_drives_over_their_way) {
  double error[2];
  for (int k = 0; k < 2; ++k) {
    scene::Scene s = support::gallery("slider_crank", {"/analysis/tolerance=1e-11"});
    s.expected.clear();
    s.analysis.step_size /= 1 << k;
    const support::Outcome r = support::run(s);
    ASSERT_TRUE(r.ok()) << r.summary.cause;
    error[k] = r.summary.checks.energy_balance / r.summary.checks.energy_scale;
  }
  std::printf("slider crank: energy balance %.2e, %.2e of the energy\n", error[0], error[1]);
  EXPECT_LT(error[0], 1e-4);
  EXPECT_GT(support::order_of(error[0], error[1]), 1.8);
}

TEST(Balances, are_left_out_when_not_asked_for_and_change_no_result) {
  scene::Scene s = support::gallery("double_pendulum", {"/analysis/end_time=0.1"});
  const support::Outcome with = support::run(s);
  s.output.checks = false;
  const support::Outcome without = support::run(s);
  ASSERT_TRUE(with.ok() && without.ok());
  EXPECT_TRUE(with.summary.checks.evaluated);
  EXPECT_GT(with.summary.checks.energy_balance, 0.0);
  EXPECT_FALSE(without.summary.checks.evaluated);
  EXPECT_EQ(without.summary.checks.energy_balance, 0.0);
  EXPECT_EQ(with.history.rows, without.history.rows);
}

/// Whoever looks at a state in space changes nothing of it: at rows, at a load's end, at the end of the run and where
/// steps fail.
TEST(Rows, that_nobody_asks_for_change_no_other) {
  const std::string spun = R"({
    "sections": [{"name": "section", "stiffness": {"EA": 1e6, "GA2": 4e5, "GA3": 4e5, "GJ": 500, "EI2": 600, "EI3": 600},
                  "mass": {"mass_per_length": 1.5, "rotary": [0.02, 0.01, 0.01]}}],
    "nodes": [{"name": "lower", "position": [0, 0, 0]}, {"name": "upper", "position": [1, 0, 0]}],
    "beams": [{"name": "beam", "section": "section", "start": "lower", "end": "upper", "elements": 9}],
    "initial_velocities": [{"of": "beam", "velocity": [0, -30, 0], "angular_velocity": [0, 0, 60]}],
    "sensors": [{"name": "lower", "kind": "position", "at": "lower"}, {"name": "energy", "kind": "total_energy"}],
    "analysis": {"kind": "dynamic", "end_time": 2, "step_size": 0.05}})";
  const std::string held = R"({
    "sections": [{"name": "section", "stiffness": {"EA": 1e6, "GA2": 4e5, "GA3": 4e5, "GJ": 500, "EI2": 600, "EI3": 600},
                  "mass": {"mass_per_length": 1.5, "rotary": [0.02, 0.01, 0.01]}}],
    "nodes": [{"name": "root", "position": [0, 0, 0]}, {"name": "lower", "position": [1, 0, 0]}],
    "beams": [{"name": "beam", "section": "section", "start": "root", "end": "lower", "elements": 20}],
    "joints": [{"name": "wall", "kind": "fixed", "first": "ground", "second": "root", "position": [0, 0, 0]}],
    "loads": [{"name": "load", "at": "lower", "force": [0, 100, 0], "law": {"kind": "harmonic", "amplitude": 1, "omega": 20}}],
    "sensors": [{"name": "lower", "kind": "position", "at": "lower"}, {"name": "energy", "kind": "total_energy"}],
    "analysis": {"kind": "dynamic", "end_time": 1, "step_size": 1e-3}})";
  const std::string wound = R"({
    "bodies": [{"name": "rotor", "mass": 1, "inertia": [1, 1, 2]}],
    "joints": [{"name": "axle", "kind": "revolute", "first": "ground", "second": "rotor", "position": [0.3, 0, 0], "axis": [0, 0, -1],
                "forces": [{"stiffness": 1, "damping": 0.01}]}],
    "initial_velocities": [{"of": "rotor", "velocity": [0, -6, 0], "angular_velocity": [0, 0, 20]}],
    "sensors": [{"name": "lower", "kind": "position", "at": "rotor"}, {"name": "energy", "kind": "total_energy"},
                {"name": "angle", "kind": "joint_angle", "joint": "axle"}],
    "analysis": {"kind": "dynamic", "end_time": 3, "step_size": 0.01}})";
  for (scene::Scene scene : {support::gallery("flying_spaghetti"), support::scene_of(spun), support::scene_of(held),
                             support::scene_of(wound)}) {
    scene.output.checks = false;
    const support::Outcome all = support::run(scene);
    scene.output.stride = 7;
    const support::Outcome some = support::run(scene);
    ASSERT_TRUE(all.ok() && some.ok()) << all.summary.cause << some.summary.cause;
    EXPECT_EQ(scene.analysis.step_size > 0.04, all.summary.steps.rejected > 0) << "it turns too far in a step";
    if (!scene.bodies.empty()) {
      EXPECT_GT(all.history.largest("angle"), 10.0) << "a spring that is wound up remembers its turns";
    }
    EXPECT_EQ(all.summary.steps.newton_iterations, some.summary.steps.newton_iterations);
    EXPECT_EQ(all.history.times.back(), some.history.times.back());
    for (const std::string column : {"lower.x", "lower.y", "energy"})
      for (double t : some.history.times)
        EXPECT_EQ(some.history.at(column, t), all.history.at(column, t)) << column << " at " << t;
    // Certificates that are summed or looked for in every step see what they need.
    scene.output.checks = true;
    const support::Outcome checked = support::run(scene);
    scene.output.stride = 1;
    const support::Outcome whole = support::run(scene);
    ASSERT_TRUE(checked.ok() && whole.ok()) << checked.summary.cause << whole.summary.cause;
    const records::Checks &a = checked.summary.checks, &b = whole.summary.checks;
    EXPECT_EQ(checked.history.times, some.history.times);
    EXPECT_EQ(checked.history.rows, some.history.rows);
    EXPECT_EQ(a.numerical_dissipation, b.numerical_dissipation) << "left at the end";
    EXPECT_EQ(a.energy_gained, b.energy_gained);
    EXPECT_LE(a.momentum_balance, b.momentum_balance) << "seen at a seventh of the times";
    EXPECT_EQ(a.local_error_sum, b.local_error_sum);
    EXPECT_EQ(a.local_error_max_velocity, b.local_error_max_velocity);
  }
}

TEST(Expected, beyond_the_end_of_a_shortened_run_is_not_reached) {
  const support::Outcome r = support::run(support::gallery("pendulum", {"/analysis/end_time=0.5"}));
  ASSERT_TRUE(r.ok()) << r.summary.cause;
  int not_reached = 0;
  for (const records::ExpectedResult& e : r.summary.expected) not_reached += e.reached ? 0 : 1;
  EXPECT_EQ(not_reached, 2);  // bob.x and bob.y at 1 s
  const support::Outcome whole = support::run(support::gallery("pendulum"));
  for (const records::ExpectedResult& e : whole.summary.expected) EXPECT_TRUE(e.reached && e.holds) << e.name;
}

}  // namespace
}  // namespace bough::run
