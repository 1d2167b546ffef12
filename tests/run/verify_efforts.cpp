// The parts of an effort along a joint's coordinate, read by signals and by sensors.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "bough/scene/problems.hpp"
#include "support/scenes.hpp"

namespace bough::run {
namespace {

using support::Outcome;
using support::run_ok;
using support::scene_of;

const char* const parts[] = {"all", "drive", "spring", "damper", "effort", "friction", "stop"};

/// A wheel on an axle with a spring, a damper, friction that follows the rate, and a stop, each readable alone; `drive`
/// is the list of drives.
std::string wheel(const std::string& drives, const std::string& analysis, bool with_signals = true) {
  std::string signals, sensors = R"({"name": "angle", "kind": "joint_angle", "joint": "axle"},
    {"name": "rate", "kind": "joint_rate", "joint": "axle"})";
  for (const std::string part : parts) {
    signals += R"(, {"name": "s_)" + part + R"(", "kind": "joint_effort", "joint": "axle", "of": ")" + part + "\"}";
    sensors += R"(, {"name": ")" + part + R"(", "kind": "joint_effort", "joint": "axle", "of": ")" + part + "\"}";
    if (with_signals) sensors += R"(, {"name": "s_)" + part + R"(", "kind": "signal", "signal": "s_)" + part + "\"}";
  }
  return R"-({"bodies": [{"name": "wheel", "mass": 1, "inertia": [0.5, 0.5, 0.5]}],
    "joints": [{"name": "axle", "kind": "revolute", "first": "ground", "second": "wheel", "axis": [0, 0, 1], "drives": )-" +
         drives + R"-(, "forces": [{"stiffness": 7, "rest": 0.1, "damping": 5},
                 {"name": "friction", "effort": {"signal": "rubs"}, "damping": 0.25},
                 {"name": "stop", "effort": {"signal": "stops"}}]}],
    "initial_velocities": [{"of": "wheel", "angular_velocity": [0, 0, 2]}],
    "signals": [{"name": "q", "kind": "joint_angle", "joint": "axle"}, {"name": "w", "kind": "joint_rate", "joint": "axle"},
      {"name": "rubs", "kind": "formula", "expression": "-0.3*tanh(w/0.01)"},
      {"name": "stops", "kind": "formula", "expression": "-40*max(q - 0.2, 0)"})-" +
         (with_signals ? signals : "") + R"-(], "sensors": [)-" + sensors + R"-(], "analysis": )-" + analysis + "}";
}
const char* const driven = R"-([{"law": {"expression": "2*t + 0.5*sin(4*t)"}}])-";

// Every part by its formula; the drive's is J q'' less all others; all is their sum.
void expect_parts(const Outcome& run, bool is_driven, const std::string& prefix, double tolerance) {
  for (std::size_t row = 1; row < run.history.rows.size(); ++row) {
    const double t = run.history.times[row];
    const auto at = [&](const std::string& column) { return run.history.rows[row][run.history.column(column)]; };
    const double q = at("angle"), w = at("rate");
    const double spring = -7.0 * (q - 0.1), damper = -5.25 * w, friction = -0.3 * std::tanh(w / 0.01),
                 stop = -40.0 * std::max(q - 0.2, 0.0);
    SCOPED_TRACE(t);
    EXPECT_NEAR(at(prefix + "spring"), spring, 1e-9);
    EXPECT_NEAR(at(prefix + "damper"), damper, 1e-9);
    EXPECT_NEAR(at(prefix + "effort"), friction + stop, 1e-9);
    EXPECT_NEAR(at(prefix + "friction"), friction - 0.25 * w, 1e-9) << "a force by its name, with all that it has";
    EXPECT_NEAR(at(prefix + "stop"), stop, 1e-9);
    const double others = spring + damper + friction + stop;
    EXPECT_NEAR(at(prefix + "all"), at(prefix + "drive") + others, 1e-9);
    const double drive = is_driven ? 0.5 * (-8.0 * std::sin(4.0 * t)) - others : 0.0;
    EXPECT_NEAR(at(prefix + "drive"), drive, is_driven ? tolerance : 0.0);
  }
}

TEST(Efforts, every_part_is_read_by_signals_and_sensors_in_inverse_dynamics) {
  const char* const inverse = R"({"kind": "inverse_dynamics", "end_time": 1, "step_size": 0.125})";
  for (const std::vector<std::string>& way :
       {std::vector<std::string>{}, std::vector<std::string>{"/without=[\"planar\"]"}}) {
    const Outcome run = run_ok(scene_of(wheel(driven, inverse), way));
    expect_parts(run, true, "", 1e-9);
    expect_parts(run, true, "s_", 1e-9);
  }
}

TEST(Efforts, every_part_is_read_by_signals_and_sensors_in_time) {
  const char* const dynamic = R"({"kind": "dynamic", "end_time": 0.5, "step_size": 0.001, "tolerance": 1e-11})";
  for (const std::string drives : {driven, "[]"})
    for (const char* prefix : {"", "s_"})
      expect_parts(run_ok(scene_of(wheel(drives, dynamic))), drives != "[]", prefix, 2e-3);
}

// What is prescribed needs 10 N m against a damper of 5 N m s at 2 rad/s, while nothing accelerates.
TEST(Efforts, the_drive_of_a_damped_axle_at_constant_speed_gives_what_the_damper_takes) {
  const Outcome run = run_ok(scene_of(R"({"bodies": [{"name": "wheel", "mass": 1, "inertia": [1, 1, 1]}],
    "joints": [{"name": "axle", "kind": "revolute", "first": "ground", "second": "wheel", "axis": [0, 0, 1],
      "drives": [{"law": 2, "rate": true}], "forces": [{"damping": 5}]}],
    "initial_velocities": [{"of": "wheel", "angular_velocity": [0, 0, 2]}],
    "sensors": [{"name": "drive", "kind": "joint_effort", "joint": "axle", "of": "drive"},
      {"name": "damper", "kind": "joint_effort", "joint": "axle", "of": "damper"},
      {"name": "net", "kind": "joint_effort", "joint": "axle"}],
    "analysis": {"kind": "inverse_dynamics", "end_time": 1, "step_size": 0.5}})"));
  EXPECT_NEAR(run.history.last("drive"), 10.0, 1e-12);
  EXPECT_NEAR(run.history.last("damper"), -10.0, 1e-12);
  EXPECT_NEAR(run.history.last("net"), 0.0, 1e-12);
}

// A sensor only looks.
TEST(Efforts, sensors_of_efforts_change_no_bit_of_the_motion) {
  const char* const dynamic = R"({"kind": "dynamic", "end_time": 0.5, "step_size": 0.001})";
  scene::Scene with = scene_of(wheel(driven, dynamic, false)), without = with;
  std::erase_if(without.sensors, [](const scene::Sensor& s) { return s.kind == scene::SensorKind::joint_effort; });
  const Outcome a = run_ok(with), b = run_ok(without);
  for (const char* column : {"angle", "rate"}) EXPECT_EQ(a.history.of(column), b.history.of(column)) << column;
}

TEST(Efforts, of_a_displacement_are_forces_and_of_a_rod_what_holds_it) {
  const Outcome run = run_ok(scene_of(R"({"gravity": [0, 0, -10],
    "bodies": [{"name": "bob", "kind": "point_mass", "mass": 3, "position": [0, 0, -2]}],
    "joints": [{"name": "rod", "kind": "distance", "first": "ground", "second": "bob"}],
    "sensors": [{"name": "rod", "kind": "joint_effort", "joint": "rod", "of": "drive"}],
    "analysis": {"kind": "dynamic", "end_time": 0.1, "step_size": 0.01}})"));
  EXPECT_NEAR(run.history.last("rod"), -30.0, 1e-8) << "towards the ground: shorter";
  EXPECT_EQ(run.summary.header.about.front().unit, "N");
}

/// The first thing told about the word of a part, as "rule: hint".
std::string told_of(const std::string& part) {
  scene::Scene scene = scene_of(wheel(driven, R"({"kind": "dynamic", "end_time": 1, "step_size": 0.01})", false));
  for (scene::Sensor& s : scene.sensors)
    if (s.name == "all") s.of = part;
  for (const scene::SceneProblem& p : scene::problems_in(scene))
    if (p.key == "of") return p.rule + ": " + p.hint;
  return "";
}

TEST(Efforts, words_that_miss_a_part_narrowly_are_led_to_it) {
  EXPECT_EQ(told_of("drive"), "");
  EXPECT_EQ(told_of("friction"), "");
  for (const auto& [given, meant] :
       {std::pair{"drives", "drive"}, std::pair{"Drive", "drive"}, std::pair{"motor", "drive"},
        std::pair{"damping", "damper"}, std::pair{"stiffness", "spring"}, std::pair{"sprong", "spring"},
        std::pair{"net", "all"}, std::pair{"limit", "effort"}, std::pair{"frction", "friction"},
        std::pair{"servo", "effort"}})
    EXPECT_NE(told_of(given).find("did you mean \"" + std::string(meant) + "\"?"), std::string::npos)
        << given << ": " << told_of(given);
  EXPECT_NE(told_of("zzzzzzzz").find("or the name of a force"), std::string::npos) << told_of("zzzzzzzz");
}

}  // namespace
}  // namespace bough::run
