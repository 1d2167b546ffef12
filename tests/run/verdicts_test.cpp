/// Verdicts of runs: what is wrong for a reason that a run can know is doubted with this reason, and its right twin is
/// not.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "bough/run/memory_run.hpp"
#include "support/scenes.hpp"

namespace bough::run {
namespace {

using support::Outcome;
using support::scene_of;

/// The first doubt about this with this word; empty: there is none.
std::string doubt(const Outcome& run, const std::string& about, const std::string& word = "") {
  for (const records::Doubt& d : run.summary.doubts)
    if (d.about == about && d.text.find(word) != std::string::npos) return d.text;
  return "";
}

std::string all_doubts(const Outcome& run) {
  std::string text;
  for (const records::Doubt& d : run.summary.doubts) text += d.about + ": " + d.text + "\n";
  return text;
}

Outcome run_of(const std::string& json, const std::vector<std::string>& overrides = {}) {
  Outcome out = support::run(scene_of(json, overrides));
  EXPECT_TRUE(out.ok()) << out.summary.cause;
  return out;
}

/// A mass on a rail under a force with this law, 1 s.
std::string on_rail(const std::string& law, const std::string& analysis = R"("step_size": 1e-3)") {
  return R"({"bodies": [{"name": "b", "kind": "point_mass", "mass": 1}],
    "joints": [{"name": "rail", "kind": "prismatic", "first": "ground", "second": "b", "axis": [1, 0, 0]}],
    "loads": [{"at": "b", "force": [1, 0, 0], "law": )" +
         law + R"(}],
    "sensors": [{"name": "x", "kind": "joint_displacement", "joint": "rail"},
                {"name": "v", "kind": "joint_rate", "joint": "rail"}],
    "analysis": {"kind": "dynamic", "end_time": 1, )" +
         analysis + "}}";
}

TEST(Verdict, a_pulse_shorter_than_a_step_is_told_and_one_that_steps_resolve_is_not) {
  const char* const short_pulse = R"({"expression": "1e5*exp(-((t-0.5005)/5e-5)^2) "})";
  const Outcome missed = run_of(on_rail(short_pulse));
  EXPECT_LT(std::abs(missed.history.last("v")), 0.5) << "of 8.86 m/s";
  EXPECT_NE(doubt(missed, "error", "do not see the law"), "") << all_doubts(missed);
  const Outcome controlled = run_of(on_rail(short_pulse, R"("step_size": 1e-3, "step_control": {})"));
  if (std::abs(controlled.history.last("v") - 8.862) > 0.1) {
    EXPECT_NE(doubt(controlled, "error", "do not see the law"), "") << all_doubts(controlled);
  }
  const Outcome beside = run_of(on_rail(R"({"expression": "200 + 30*t + 1e5*exp(-((t-0.5005)/5e-5)^2) "})"));
  EXPECT_NE(doubt(beside, "error", "do not see the law"), "") << "beside a load that steps see: " << all_doubts(beside);
  const Outcome tiny = run_of(on_rail(R"({"expression": "1e9*exp(-((t-0.50037)/1e-8)^2) "})"));
  EXPECT_NE(doubt(tiny, "error", "do not see the law"), "") << "a hundred thousandth of a step: " << all_doubts(tiny);
  const Outcome seen = run_of(on_rail(R"({"expression": "1e3*exp(-((t-0.5005)/5e-3)^2) "})"));
  EXPECT_NEAR(seen.history.last("v"), 8.862, 0.01);
  EXPECT_EQ(all_doubts(seen), "");
}

TEST(Verdict, a_pulse_in_a_prescribed_place_is_told_beside_a_motion_that_steps_see) {
  const auto driven = [](const std::string& law) {
    return R"({"bodies": [{"name": "b", "kind": "point_mass", "mass": 1}],
      "joints": [{"name": "rail", "kind": "prismatic", "first": "ground", "second": "b", "axis": [1, 0, 0],
                  "drives": [{"law": {"expression": ")" +
           law + R"("}}]}],
      "sensors": [{"name": "x", "kind": "joint_displacement", "joint": "rail"}],
      "analysis": {"kind": "dynamic", "end_time": 1, "step_size": 1e-3}})";
  };
  const auto carried = [](const std::string& law) {
    return R"({"frames": [{"name": "table", "position": [{"expression": ")" + law + R"("}, 0, 0]}],
      "bodies": [{"name": "b", "kind": "point_mass", "mass": 1, "frame": "table"}],
      "springs": [{"name": "s", "first": {"to": "table", "position": [-0.1, 0, 0]}, "second": "b",
                   "stiffness": 100, "rest_length": 0.1}],
      "sensors": [{"name": "x", "kind": "position", "at": "b"}],
      "analysis": {"kind": "dynamic", "end_time": 1, "step_size": 1e-3}})";
  };
  const std::string pulse = " + 0.02*exp(-((t-0.5005)/5e-5)^2)", smooth = "0.1*sin(2*pi*t)*t";
  for (const std::string& slow : {std::string("0"), std::string("0.1*t^3"), smooth}) {
    const Outcome missed = run_of(driven(slow + pulse));
    EXPECT_NE(doubt(missed, "error", "do not see the law of 'rail'"), "") << slow << "\n" << all_doubts(missed);
  }
  EXPECT_EQ(all_doubts(run_of(driven(smooth))), "");
  const Outcome on_table = run_of(carried(smooth + pulse));
  EXPECT_NE(doubt(on_table, "error", "do not see the law of 'table'"), "") << all_doubts(on_table);
  EXPECT_EQ(all_doubts(run_of(carried(smooth))), "");
}

TEST(Verdict, a_step_that_it_names_sees_the_pulse) {
  const Outcome missed = run_of(on_rail(R"({"expression": "1e5*exp(-((t-0.5005)/5e-5)^2) + 1e-9"})"));
  const std::string text = doubt(missed, "error", "take steps of ");
  ASSERT_NE(text, "");
  const std::string step = support::text(std::stod(text.substr(text.find("take steps of ") + 14)));
  const Outcome named =
      run_of(on_rail(R"({"expression": "1e5*exp(-((t-0.5005)/5e-5)^2) + 1e-9"})", R"("step_size": )" + step));
  EXPECT_NEAR(named.history.last("v"), 8.862269, 0.1) << step;
  EXPECT_EQ(all_doubts(named), "");
}

TEST(Verdict, a_wave_faster_than_the_steps_is_told) {
  const Outcome aliased = run_of(on_rail(R"({"kind": "harmonic", "amplitude": 100, "omega": 6503})"));
  EXPECT_NE(doubt(aliased, "error", "do not see the law"), "") << all_doubts(aliased);
  const Outcome seen = run_of(on_rail(R"({"kind": "harmonic", "amplitude": 100, "omega": 200})"));
  EXPECT_EQ(all_doubts(seen), "");
}

/// Two weights on rods of half a metre, let go from the horizontal (overrides: other angles, times).
constexpr const char* two_weights = R"({"gravity": [0, 0, -9.81],
  "bodies": [{"name": "a", "mass": 1, "inertia": [1e-4, 1e-4, 1e-4], "position": [0.5, 0, 0]},
             {"name": "b", "mass": 1, "inertia": [1e-4, 1e-4, 1e-4], "position": [1, 0, 0]}],
  "joints": [{"name": "A", "kind": "revolute", "first": "ground", "second": "a", "position": [0, 0, 0],
              "axis": [0, 1, 0]},
             {"name": "B", "kind": "revolute", "first": "a", "second": "b", "position": [0.5, 0, 0],
              "axis": [0, 1, 0]}],
  "sensors": [{"name": "b", "kind": "position", "at": "b"}],
  "analysis": {"kind": "dynamic", "end_time": 15, "step_size": 1e-3}})";

TEST(Verdict, chaotic_motion_is_doubted_once_its_errors_have_grown_and_not_before) {
  const Outcome late = run_of(two_weights);
  EXPECT_NE(doubt(late, "error", "grow"), "") << all_doubts(late);
  EXPECT_NE(doubt(late, "error", "sensitive"), "") << all_doubts(late);
  const Outcome early = run_of(two_weights, {"/analysis/end_time=1"});
  EXPECT_EQ(all_doubts(early), "");
}

/// A mass on a spring and a damper under a harmonic force.
constexpr const char* forced = R"({
  "bodies": [{"name": "m", "mass": 800, "inertia": [1, 1, 1]}],
  "joints": [{"name": "j", "kind": "prismatic", "first": "ground", "second": "m", "axis": [0, 0, 1],
              "forces": [{"stiffness": 2600, "damping": 260}]}],
  "loads": [{"at": "m", "force": [0, 0, 1950], "law": {"expression": "sin(2*pi*t/5) "}}],
  "sensors": [{"name": "z", "kind": "joint_displacement", "joint": "j"}],
  "analysis": {"kind": "dynamic", "end_time": 1000, "step_size": 0.025}})";

/// A ball that falls on a stop by a formula, on a rail, or on the contact of a plane, and bounces five times and more.
std::string bouncing(bool has_contact, const std::string& end_time) {
  const std::string stop = has_contact ? R"-(}], "contacts": [{"name": "floor", "first": "ground", "second": "ball",
      "normal": [0, 0, 1], "stiffness": 1e5, "dissipation": 0.1}],)-"
                                       : R"-(, "forces": [{"effort": {"signal": "floor"}}]}],
    "signals": [{"name": "z", "kind": "position", "at": "ball", "axis": "z"},
                {"name": "v", "kind": "velocity", "at": "ball", "axis": "z"},
                {"name": "floor", "kind": "formula", "expression": "max(0, 1e4*max(0, -z)*(1 - 0.3*v))"}],)-";
  return R"-({"gravity": [0, 0, -9.81],
    "bodies": [{"name": "ball", "mass": 1, "inertia": [1, 1, 1], "position": [0, 0, 1]}],
    "joints": [{"name": "rail", "kind": "prismatic", "first": "ground", "second": "ball", "position": [0, 0, 0],
                "axis": [0, 0, 1])-" +
         stop + R"-("sensors": [{"name": "z", "kind": "position", "at": "ball"}],
    "analysis": {"kind": "dynamic", "end_time": )-" +
         end_time + R"-(, "step_size": 5e-4}})-";
}

// The error grows with the number of bounces, not by e again and again: a run in a tenth of the steps is off by 5e-4 of
// the height.
TEST(Verdict, a_motion_with_stops_is_not_called_sensitive) {
  for (const bool has_contact : {false, true})
    for (const char* end : {"5", "20"}) {
      const Outcome run = run_of(bouncing(has_contact, end));
      EXPECT_EQ(doubt(run, "error", "sensitive"), "") << all_doubts(run);
      EXPECT_EQ(doubt(run, "error", "altogether"), "") << all_doubts(run);
    }
}

// Sums of local errors are far above the error where impacts leave errors of both signs. Twins decide then.
TEST(Verdict, twins_check_a_sum_of_errors_before_it_doubts_a_run) {
  const auto run = [](const std::string& step) {
    return run_in_memory(scene_of(bouncing(true, "5"), {"/analysis/step_size=" + step}));
  };
  const auto doubts_error = [](const MemoryRun& of) {
    return std::any_of(of.summary.doubts.begin(), of.summary.doubts.end(),
                       [](const records::Doubt& d) { return d.about == "error"; });
  };
  const MemoryRun right = run("5e-4"), fine = run("5e-5");
  EXPECT_FALSE(doubts_error(right));
  EXPECT_TRUE(right.says("twice and four times as long")) << right.text();
  const auto z = right.series("z.z"), limit = fine.series("z.z");
  double error = 0.0;
  for (std::size_t k = 0; k < z.size() && 10 * k < limit.size(); ++k)
    error = std::max(error, std::abs(z[k] - limit[10 * k]));
  const auto& told = right.summary.sensor_errors.at(right.column("z.z"));
  std::printf("bouncing ball: told %.2g m, is off by %.2g m\n", told.of_steps, error);
  EXPECT_GT(told.of_steps, 0.5 * error);
  EXPECT_LT(told.of_steps, 0.01 * told.range);
  EXPECT_TRUE(doubts_error(run("5e-3"))) << "a step an impact";
}

TEST(Verdict, steady_forced_vibrations_forget_their_errors_and_coarse_ones_are_doubted) {
  const Outcome fine = run_of(forced);
  EXPECT_EQ(all_doubts(fine), "");
  const Outcome coarse = run_of(forced, {"/analysis/end_time=200", "/analysis/step_size=0.5"});
  EXPECT_NE(doubt(coarse, "error"), "") << "ten steps a period: " << all_doubts(coarse);
  const Outcome free = run_of(forced, {"/joints/0/forces/0/damping=0", "/analysis/step_size=0.05"});
  EXPECT_NE(doubt(free, "error"), "") << "without a damper nothing is forgotten: " << all_doubts(free);
  // z'' + w^2 z = f sin(v t) from rest, over 290 periods.
  const double w = std::sqrt(2600.0 / 800.0), v = 2.0 * std::numbers::pi / 5.0, a = 1950.0 / 800.0 / (w * w - v * v);
  const auto z = free.history.column("z");
  double error = 0.0;
  for (std::size_t i = 0; i < free.history.times.size(); ++i) {
    const double t = free.history.times[i];
    error = std::max(error, std::abs(free.history.rows[i][z] - a * (std::sin(v * t) - v / w * std::sin(w * t))));
  }
  const records::SensorError& told = free.summary.sensor_errors.at(0);
  EXPECT_GT(told.relative(), 0.5 * error / told.range) << error;
  EXPECT_LT(told.relative(), 3.0 * error / told.range) << error;
}

/// A cantilever of 1 m and 2 N m^2 under a force that follows its end.
std::string beck(double force, const std::string& mass) {
  return R"({"sections": [{"name": "s", "stiffness": {"EA": 2e8, "GA2": 8e7, "GA3": 8e7, "GJ": 10, "EI2": 2, "EI3": 2})" +
         mass + R"(}],
    "nodes": [{"name": "a"}, {"name": "b", "position": [1, 0, 0]}],
    "beams": [{"name": "l", "section": "s", "start": "a", "end": "b", "elements": 6, "order": 3}],
    "joints": [{"name": "c", "kind": "fixed", "first": "ground", "second": "a"}],
    "loads": [{"at": "b", "force": [)" +
         support::text(-force) + R"(, 0, 0], "axes": "body"}],
    "sensors": [{"name": "tip", "kind": "position", "at": "b"}],
    "analysis": {"kind": "static"}})";
}
constexpr const char* with_mass = R"(, "mass": {"mass_per_length": 0.4, "rotary": [1e-6, 1e-9, 1e-9]})";

/// Beck's column flutters above 20.05 EI / L^2 = 40.1 N.
TEST(Verdict, statics_under_a_following_load_are_doubted_where_they_flutter) {
  const Outcome above = run_of(beck(44.0, with_mass));
  EXPECT_NE(doubt(above, "stability", "flutters"), "") << all_doubts(above);
  EXPECT_FALSE(above.summary.stability->is_known);
  double low = 30.0, high = 50.0;
  for (int k = 0; k < 12; ++k) {
    const double force = 0.5 * (low + high);
    (doubt(run_of(beck(force, with_mass)), "stability").empty() ? low : high) = force;
  }
  std::printf("| Beck's column | flutters above %.5f EI / L^2, closed form 20.0509 |\n", 0.25 * (low + high));
  EXPECT_NEAR(0.25 * (low + high), 20.0509, 0.05);
  const Outcome massless = run_of(beck(10.0, ""));
  EXPECT_FALSE(massless.summary.stability->is_known);
  EXPECT_NE(massless.summary.not_judged.find("stability is not examined"), std::string::npos)
      << massless.summary.not_judged;
  EXPECT_EQ(all_doubts(massless), "");
}

/// A deep strip of 1 m, bending stiffness 2 N m^2 sideways and torsional stiffness 2 N m^2, under a load at its end:
/// Prandtl's critical load is 4.013 sqrt(EI GJ) / L^2 = 8.03 N.
std::string strip(double force, const std::string& analysis) {
  return R"({"sections": [{"name": "s", "stiffness": {"EA": 1e7, "GA2": 4e6, "GA3": 4e6, "GJ": 2, "EI2": 300, "EI3": 2},
      "mass": {"mass_per_length": 0.5, "rotary": [2e-4, 1e-4, 1e-4]}, "damping": {"time": 1e-3}}],
    "nodes": [{"name": "a"}, {"name": "b", "position": [1, 0, 0]}],
    "beams": [{"name": "l", "section": "s", "start": "a", "end": "b", "axis_2": [0, 1, 0], "elements": 4, "order": 3}],
    "joints": [{"name": "c", "kind": "fixed", "first": "ground", "second": "a"}],
    "loads": [{"at": "b", "force": [0, 0, )" +
         support::text(-force) + R"(], "law": )" + analysis + "}}";
}

TEST(Verdict, a_strip_that_buckles_sideways_in_time_is_doubted_though_its_plan_keeps_it_in_its_plane) {
  const std::string ramp = R"({"kind": "ramp", "end_time": 1}}],
    "sensors": [{"name": "b", "kind": "position", "at": "b"}],
    "analysis": {"kind": "dynamic", "end_time": 3, "step_size": 4e-3)";
  const Outcome above = run_of(strip(12.0, ramp));
  EXPECT_NE(doubt(above, "stability", "out of its plane"), "") << all_doubts(above);
  const Outcome below = run_of(strip(6.0, ramp));
  EXPECT_EQ(all_doubts(below), "");
  const std::string rest = R"(1}],
    "sensors": [{"name": "b", "kind": "position", "at": "b"}],
    "analysis": {"kind": "dynamic", "start": "equilibrium", "end_time": 0.1, "step_size": 2e-3)";
  const Outcome start = run_of(strip(12.0, rest));
  EXPECT_NE(doubt(start, "stability", "the equilibrium in which the run starts"), "") << all_doubts(start);
  EXPECT_EQ(all_doubts(run_of(strip(6.0, rest))), "");
}

/// A shallow truss of two springs, 1 m to each side and 0.1 m high, of 10 kN/m. Its limit load is 3.83 N.
std::string truss(double load, int steps) {
  return R"({"bodies": [{"name": "m", "kind": "point_mass", "mass": 1, "position": [0, 0.1, 0]}],
    "joints": [{"name": "g", "kind": "prismatic", "first": "ground", "second": "m", "position": [0, 0.1, 0],
                "axis": [0, 1, 0]}],
    "springs": [{"name": "l", "first": {"to": "ground", "position": [-1, 0, 0]}, "second": "m", "stiffness": 1e4},
                {"name": "r", "first": {"to": "ground", "position": [1, 0, 0]}, "second": "m", "stiffness": 1e4}],
    "loads": [{"at": "m", "force": [0, )" +
         support::text(-load) + R"(, 0]}],
    "sensors": [{"name": "m", "kind": "position", "at": "m"}],
    "analysis": {"kind": "static", "load_steps": )" +
         std::to_string(steps) + "}}";
}

TEST(Verdict, a_load_step_that_snaps_through_is_doubted_and_one_that_stiffens_is_not) {
  for (const int steps : {1, 2, 7, 20}) {
    const Outcome snapped = support::run(support::scene_of(truss(4.02, steps)));
    // Short steps come so near to the limit point that none leads beyond; the failure names the way on.
    if (snapped.ok())
      EXPECT_NE(doubt(snapped, "stability", "another branch"), "") << steps << " steps: " << all_doubts(snapped);
    else
      EXPECT_NE(snapped.summary.cause.find("arc_length"), std::string::npos) << snapped.summary.cause;
    EXPECT_EQ(all_doubts(run_of(truss(3.7, steps))), "") << steps << " steps";
    EXPECT_EQ(all_doubts(run_of(truss(-2000.0, steps))), "") << steps << " steps, pulled upwards";
  }
}

}  // namespace
}  // namespace bough::run
