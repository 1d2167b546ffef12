// What the program says about a scene is so: what is held is not told free, notes that repeat are counted, statics that
// fail name ways on, and what has no effect is not asked for.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "bough/plan/plan.hpp"
#include "bough/plan/undriven.hpp"
#include "support/scenes.hpp"

namespace bough::run {
namespace {

using support::Outcome;
using support::run_ok;
using support::scene_of;

bool holds(const std::string& text, const std::string& words) { return text.find(words) != std::string::npos; }

std::string all(const std::vector<std::string>& texts) {
  std::string sum;
  for (const std::string& text : texts) sum += text + "\n";
  return sum;
}

/// A block of 1 kg on a vertical rail, in statics, with something that holds it by 1000 N/m.
std::string block(const std::string& on_rail, const std::string& more) {
  return R"-({"bodies": [{"name": "b", "mass": 1, "inertia": [1, 1, 1]}],
  "joints": [{"name": "rail", "kind": "prismatic", "first": "ground", "second": "b", "axis": [0, 0, 1])-" +
         on_rail + "}], " + more + R"-(, "gravity": [0, 0, -9.81],
  "sensors": [{"name": "b", "kind": "position", "at": "b"}], "analysis": {"kind": "static"}})-";
}

TEST(Statements, what_signals_and_laws_hold_is_not_told_free) {
  const std::string place = R"-({"name": "x", "kind": "joint_displacement", "joint": "rail"})-",
                    force = R"-("signals": [)-" + place +
                            R"-(, {"name": "f", "kind": "formula", "expression": "-1000*x"}])-";
  const std::string scenes[] = {
      block(R"-(, "forces": [{"effort": {"signal": "f"}}])-", force),
      block("", R"-("loads": [{"at": "b", "force": [0, 0, 1], "law": {"signal": "f"}}], )-" + force),
      block("", R"-("springs": [{"name": "s", "first": {"to": "ground", "position": [0, 0, 2]}, "second": "b",
                      "force_law": {"expression": "1000*stretch"}}])-"),
      // through a table, through a point and through an integral that ends where the place is the wanted one
      block(R"-(, "forces": [{"effort": {"signal": "f"}}])-",
            R"-("signals": [)-" + place + R"-(, {"name": "f", "kind": "function", "of": "x",
              "law": {"kind": "table", "times": [-1, 1], "values": [1000, -1000]}}])-"),
      block(R"-(, "forces": [{"effort": {"signal": "f"}}])-",
            R"-("signals": [{"name": "z", "kind": "position", "at": "b", "axis": "z"},
              {"name": "f", "kind": "formula", "expression": "-1000*z"}])-"),
      block(R"-(, "forces": [{"effort": {"signal": "f"}}])-",
            R"-("signals": [)-" + place + R"-(, {"name": "i", "kind": "state", "expression": "-0.00981 - x"},
              {"name": "f", "kind": "formula", "expression": "5*i"}])-")};
  for (const std::string& json : scenes) {
    const Outcome out = run_ok(scene_of(json));
    EXPECT_NEAR(out.history.last("b.z"), -9.81 / 1000.0, 1e-9) << json;
    EXPECT_FALSE(holds(all(out.summary.notes), "nothing")) << all(out.summary.notes);
  }
}

TEST(Statements, what_signals_do_not_hold_is_told_free) {
  const auto free = [](const std::string& on_rail, const std::string& more) {
    return all(plan::make_plan(scene_of(block(on_rail, more))).mobility.free);
  };
  const std::string rate = R"-("signals": [{"name": "v", "kind": "joint_rate", "joint": "rail"},
      {"name": "f", "kind": "formula", "expression": "-1000*v"}])-",
                    time = R"-("signals": [{"name": "f", "kind": "time", "law": 3}])-",
                    across = R"-("signals": [{"name": "x", "kind": "position", "at": "b", "axis": "x"},
      {"name": "f", "kind": "formula", "expression": "-1000*x"}])-",
                    idle = R"-("loads": [{"at": "b", "force": [1, 0, 0], "law": {"signal": "f"}}], "signals": [
      {"name": "x", "kind": "joint_displacement", "joint": "rail"},
      {"name": "f", "kind": "formula", "expression": "-1000*x"}])-";
  const std::string driven = R"-(, "forces": [{"effort": {"signal": "f"}}])-";
  for (const std::string& found : {free(driven, rate), free(driven, time), free(driven, across), free("", idle)})
    EXPECT_TRUE(holds(found, "in statics nothing holds 'b', which can move along")) << found;
}

TEST(Statements, a_mast_on_tension_only_stays_is_held) {
  const auto scene = [](const char* law) {
    return scene_of(std::string(R"-({
  "sections": [{"name": "pipe", "stiffness": {"EA": 2.4e6, "GA2": 8e5, "GA3": 8e5, "GJ": 3e3, "EI2": 4e5, "EI3": 4e5}}],
  "nodes": [{"name": "root"}, {"name": "tip", "position": [8, 0, 0]}],
  "beams": [{"name": "strut", "section": "pipe", "start": "root", "end": "tip", "elements": 4, "order": 2}],
  "joints": [{"name": "foot", "kind": "revolute", "first": "ground", "second": "root", "axis": [0, 1, 0]}],
  "springs": [
    {"name": "upper", "first": {"to": "ground", "position": [0, 0, 1.2]}, "second": "tip", "force_law": {"expression": ")-") +
                    law + R"-("}},
    {"name": "lower", "first": {"to": "ground", "position": [0, 0, -1.2]}, "second": "tip", "force_law": {"expression": ")-" +
                    law + R"-("}}],
  "loads": [{"name": "weight", "at": "tip", "force": [0, 0, -900]}], "analysis": {"kind": "static"}})-");
  };
  const plan::Plan plan = plan::make_plan(scene("3.7e5*max(0, stretch)"));
  EXPECT_TRUE(plan.mobility.free.empty()) << all(plan.mobility.free);
  EXPECT_FALSE(holds(all(plan.notes), "do not feel")) << all(plan.notes);
  run_ok(scene("3.7e5*max(0, stretch)"));
}

TEST(Statements, what_hangs_on_its_weight_is_told_to_be_held_by_loads_alone) {
  const scene::Scene pendulum = scene_of(R"-({"gravity": [0, 0, -9.81],
  "bodies": [{"name": "bob", "mass": 2, "inertia": [0.1, 0.1, 0.1], "position": [0.6, 0, -0.8]}],
  "joints": [{"name": "pivot", "kind": "revolute", "first": "ground", "second": "bob", "position": [0, 0, 0],
    "axis": [0, 1, 0]}],
  "sensors": [{"name": "bob", "kind": "position", "at": "bob"}], "analysis": {"kind": "static"}})-");
  const std::string told = all(plan::make_plan(pendulum).mobility.free);
  EXPECT_TRUE(holds(told, "nothing but loads can hold 'bob', which can turn about the axis")) << told;
}

TEST(Statements, parts_that_signals_connect_feel_each_other) {
  const auto notes = [](const std::string& read) {
    return all(plan::make_plan(scene_of(R"-({"gravity": [0, 0, -9.81],
  "bodies": [{"name": "a", "mass": 1, "inertia": [1, 1, 1]}, {"name": "b", "mass": 1, "inertia": [1, 1, 1],
    "position": [1, 0, 0]}],
  "joints": [{"name": "left", "kind": "prismatic", "first": "ground", "second": "a", "axis": [0, 0, 1]},
    {"name": "right", "kind": "prismatic", "first": "ground", "second": "b", "axis": [0, 0, 1]}],
  "loads": [{"at": "b", "force": [0, 0, 1], "law": {"signal": "f"}}],
  "signals": [{"name": "x", "kind": "joint_displacement", "joint": ")-" +
                                        read + R"-("}, {"name": "f", "kind": "formula", "expression": "-9*x"}],
  "analysis": {"kind": "dynamic", "end_time": 0.1}})-"))
                   .notes);
  };
  EXPECT_FALSE(holds(notes("left"), "do not feel each other")) << notes("left");
  EXPECT_TRUE(holds(notes("right"), "do not feel each other"));
}

// A line of two beams that hangs slack between two points, from straight pieces without stress: it needs more halvings
// than the default number. Its lowest point and its tension are those of the catenary.
TEST(Statements, statics_of_a_slack_line_are_found_or_name_ways_on) {
  const auto scene = [](const std::string& cuts) {
    return scene_of(R"-({"gravity": [0, 0, -9.81],
  "sections": [{"name": "chain", "stiffness": {"EA": 8e8, "GA2": 1e8, "GA3": 1e8, "GJ": 2e3, "EI2": 2e3, "EI3": 2e3},
    "mass": {"mass_per_length": 150, "rotary": [0.5, 0.25, 0.25]}}],
  "nodes": [{"name": "a"}, {"name": "m", "position": [150, 0, -80]}, {"name": "n", "position": [150, 0, -80]},
    {"name": "b", "position": [300, 0, 0]}],
  "beams": [{"name": "left", "section": "chain", "start": "a", "end": "m", "elements": 15, "order": 2},
    {"name": "right", "section": "chain", "start": "n", "end": "b", "elements": 15, "order": 2}],
  "joints": [{"name": "p", "kind": "spherical", "first": "ground", "second": "a"},
    {"name": "q", "kind": "spherical", "first": "ground", "second": "b"},
    {"name": "f", "kind": "spherical", "first": "m", "second": "n"}],
  "sensors": [{"name": "m", "kind": "position", "at": "m"}, {"name": "q", "kind": "joint_reaction", "joint": "q"}],
  "analysis": {"kind": "static")-" +
                    cuts + "}}");
  };
  const Outcome out = run_ok(scene(""));
  // Half of it, of unstretched length L, with H = w a:  H L/EA + a asinh(L/a) = 150.
  const double length = std::hypot(150.0, 80.0), weight = 150.0 * 9.81, EA = 8e8;
  double low = 1.0, high = 1e4;
  while (high - low > 1e-10) {
    const double a = 0.5 * (low + high);
    (weight * a * length / EA + a * std::asinh(length / a) < 150.0 ? low : high) = a;
  }
  const double sag = 0.5 * weight * length * length / EA + low * (std::hypot(1.0, length / low) - 1.0);
  EXPECT_NEAR(out.history.last("m.z"), -sag, 1e-4 * sag);
  EXPECT_NEAR(std::abs(out.history.last("q.fx")), weight * low, 1e-4 * weight * low);
  EXPECT_TRUE(holds(all(out.summary.notes), "a load step was halved")) << all(out.summary.notes);
  const Outcome cut = support::run(scene(R"-(, "max_cuts": 3)-"));
  EXPECT_FALSE(cut.ok());
  for (const char* word : {"load_steps", "max_cuts", "arc_length", "equilibrium"})
    EXPECT_TRUE(holds(cut.summary.cause, word)) << cut.summary.cause;
}

TEST(Statements, notes_that_differ_in_numbers_alone_are_counted) {
  const Outcome out = run_ok(scene_of(R"-({"bodies": [{"name": "floor", "mass": 1, "inertia": [1, 1, 1]}],
  "joints": [{"name": "rail", "kind": "prismatic", "first": "ground", "second": "floor", "axis": [1, 0, 0],
    "drives": [{"rate": true, "law": {"kind": "piecewise", "pieces": [{"start": 0, "law": 0}, {"start": 0.1, "law": 1},
      {"start": 0.2, "law": -1}, {"start": 0.3, "law": 2}, {"start": 0.4, "law": -2}]}}]}],
  "analysis": {"kind": "dynamic", "end_time": 0.6, "step_size": 0.02}})-"));
  EXPECT_LE(out.summary.notes.size(), 3u) << all(out.summary.notes);
  EXPECT_TRUE(holds(all(out.summary.notes), "3 more times with other numbers, the last time: velocities were made"))
      << all(out.summary.notes);
}

/// A platform on two rails, prescribed, carried by a leg between ball joints that is a cylinder and a rod.
std::string leg(const std::string& inertia, const std::string& more = "") {
  const std::string body = R"-("mass": 1, "inertia": )-" + inertia;
  return R"-({"gravity": [0, 0, -9.81], "analysis": {"kind": "inverse_dynamics", "end_time": 0.5, "step_size": 0.05},
  "bodies": [{"name": "platform", "mass": 5, "inertia": [1, 1, 1], "position": [0, 0, 1]},
    {"name": "cylinder", )-" +
         body + R"-(, "position": [0.375, 0, 0.25], "rotation": {"axes": {"3": [-0.6, 0, 0.8], "1": [0.8, 0, 0.6]}}},
    {"name": "piston", )-" +
         body + R"-(, "position": [0.1875, 0, 0.5], "rotation": {"axes": {"3": [-0.6, 0, 0.8], "1": [0.8, 0, 0.6]}}}],
  "joints": [{"name": "rail", "kind": "prismatic", "first": "ground", "second": "platform", "position": [0, 0, 1],
     "axis": [0, 0, 1], "drives": [{"law": {"expression": "0.1*sin(3*t)"}}]},
    {"name": "foot", "kind": "spherical", "first": "ground", "second": "cylinder", "position": [0.5625, 0, 0]},
    {"name": "jack", "kind": "prismatic", "first": "cylinder", "second": "piston", "position": [0.28, 0, 0.37],
     "axis": [-0.6, 0, 0.8]},
    {"name": "head", "kind": "spherical", "first": "piston", "second": "platform", "position": [0, 0, 0.75]}],
  "sensors": [{"name": "rail", "kind": "joint_reaction", "joint": "rail"},
    {"name": "leg", "kind": "rotation", "at": "cylinder"}])-" +
         more + "}";
}

TEST(Statements, inverse_dynamics_leaves_spins_without_effect_at_rest) {
  const scene::Scene free = scene_of(leg("[0.02, 0.02, 0.001]"));
  EXPECT_TRUE(plan::undriven_motions(free, plan::make_plan(free)).empty());
  const Outcome out = run_ok(free);
  EXPECT_TRUE(holds(all(out.summary.notes), "'cylinder' and 'piston', which can turn about the axis"))
      << all(out.summary.notes);
  // The same with a universal joint, which holds the spin.
  std::string held = leg("[0.02, 0.02, 0.001]");
  const std::string ball = R"-("spherical", "first": "ground", "second": "cylinder", "position": [0.5625, 0, 0])-";
  held.replace(held.find(ball), ball.size(),
               R"-("universal", "first": "ground", "second": "cylinder", "position": [0.5625, 0, 0],
                   "axis": [0.8, 0, 0.6], "second_axis": [0, 1, 0])-");
  const Outcome same = run_ok(scene_of(held));
  for (const char* column : {"rail.fx", "rail.fy", "rail.my"})
    EXPECT_NEAR(out.history.last(column), same.history.last(column), 1e-6 * 50.0) << column;
}

TEST(Statements, inverse_dynamics_names_every_motion_with_an_effect_and_what_to_do) {
  const scene::Scene lopsided = scene_of(leg("[0.02, 0.03, 0.02]"));
  const std::string told = all(plan::undriven_motions(lopsided, plan::make_plan(lopsided)));
  EXPECT_TRUE(holds(told, "universal")) << told;
  EXPECT_FALSE(support::run(lopsided).ok());
  std::string bodies, joints;
  for (int k = 0; k < 7; ++k) {
    const std::string n = std::to_string(k);
    bodies += std::string(k > 0 ? ", " : "") + R"-({"name": "door )-" + n +
              R"-(", "mass": 1, "inertia": [0.1, 0.1, 0.1], "position": [1, )-" + n + ", 0]}";
    joints += std::string(k > 0 ? ", " : "") + R"-({"name": "hinge )-" + n +
              R"-(", "kind": "revolute", "first": "ground", "second": "door )-" + n + R"-(", "position": [0, )-" + n +
              R"-(, 0], "axis": [0, 1, 0]})-";
  }
  const Outcome doors = support::run(scene_of("{\"bodies\": [" + bodies + "], \"joints\": [" + joints +
                                              R"-(], "analysis": {"kind": "inverse_dynamics", "end_time": 1}})-"));
  EXPECT_FALSE(doors.ok());
  for (int k = 0; k < 7; ++k)
    EXPECT_TRUE(holds(doors.summary.cause, "drive the angle of joint 'hinge " + std::to_string(k) + "'"))
        << doors.summary.cause;
}

// A point mass has no inertia of rotation: where its velocity is given and its rotation is not, it turns with its part.
TEST(Statements, a_point_mass_turns_with_what_holds_it) {
  const std::string arm = R"-({"analysis": {"kind": "dynamic", "end_time": 0.1, "step_size": 0.01},
  "bodies": [{"name": "arm", "mass": 1, "inertia": [0.1, 0.2, 0.3], "position": [0.5, 0, 0]},
    {"name": "bob", "kind": "point_mass", "mass": 2, "position": [1, 0, 0]},
    {"name": "twin", "kind": "point_mass", "mass": 2, "position": [1, 1, 0]}],
  "joints": [{"name": "pivot", "kind": "revolute", "first": "ground", "second": "arm", "position": [0, 0, 0],
      "axis": [0, 0, 1]},
    {"name": "tip", "kind": "fixed", "first": "arm", "second": "bob", "position": [1, 0, 0]},
    {"name": "side", "kind": "fixed", "first": "bob", "second": "twin", "position": [1, 1, 0]}],
  "sensors": [{"name": "bob", "kind": "velocity", "at": "bob"}], "initial_velocities": [)-";
  const std::string of_arm = R"-({"of": "arm", "velocity": [0, 1.5, 0], "angular_velocity": [0, 0, 3]}, )-",
                    of_points = R"-({"of": "bob", "velocity": [0, 3, 0]}, {"of": "twin", "velocity": [-3, 3, 0]}]})-";
  const Outcome out = run_ok(scene_of(arm + of_arm + of_points));
  EXPECT_NEAR(out.history.first("bob.wz"), 3.0, 1e-9);
  EXPECT_TRUE(out.summary.changed_velocities.empty());
  EXPECT_FALSE(holds(all(out.summary.notes), "velocities")) << all(out.summary.notes);
  EXPECT_NO_THROW(scene_of(arm + of_points));
  // Velocities that no rotation joins contradict each other still.
  EXPECT_ANY_THROW(scene_of(arm + of_arm + R"-({"of": "bob", "velocity": [0, 2, 0]}]})-"));
  EXPECT_ANY_THROW(
      scene_of(arm + R"-({"of": "bob", "velocity": [0, 3, 0]}, {"of": "twin", "velocity": [-3, 2, 0]}]})-"));
}

// The force of a prescribed motion, a spring, a bushing and a load, as sensors and signals: they hold a weight together.
TEST(Statements, forces_of_motions_springs_bushings_and_loads_are_read) {
  const Outcome out = run_ok(scene_of(R"-({"gravity": [0, 0, -9.81],
  "sections": [{"name": "bar", "stiffness": [1e6, 1e6, 1e6, 1e4, 1e4, 1e4]}],
  "nodes": [{"name": "a"}, {"name": "b", "position": [2, 0, 0]}, {"name": "c", "position": [4, 0, 0]}],
  "beams": [{"name": "ab", "section": "bar", "start": "a", "end": "b", "elements": 2},
    {"name": "bc", "section": "bar", "start": "b", "end": "c", "elements": 2}],
  "motions": [{"name": "pin", "at": "a", "x": 0, "y": 0, "z": 0}, {"name": "roller", "at": "c", "y": 0, "z": 0},
    {"name": "no spin", "at": "b", "rotation": "hold"}],
  "loads": [{"name": "push", "at": "b", "force": [0, 0, -12]}, {"name": "wind", "beam": "bc", "force": [0, 3, 0]}],
  "springs": [{"name": "rope", "first": {"to": "ground", "position": [2, 0, 3]}, "second": "b", "stiffness": 50,
    "rest_length": 2.9}],
  "bushings": [{"name": "pad", "first": "ground", "second": "b", "stiffness": [70, 80, 90, 1, 1, 1]}],
  "signals": [{"name": "at_pin", "kind": "force", "of": "pin", "component": "fz"},
    {"name": "pushed", "kind": "force", "of": "push", "component": "fz"},
    {"name": "held", "kind": "force", "of": "no spin", "component": "mz"}],
  "sensors": [{"name": "pin", "kind": "force", "of": "pin"}, {"name": "roller", "kind": "force", "of": "roller"},
    {"name": "turn", "kind": "force", "of": "no spin"}, {"name": "rope", "kind": "force", "of": "rope"},
    {"name": "pad", "kind": "force", "of": "pad"}, {"name": "push", "kind": "force", "of": "push"},
    {"name": "wind", "kind": "force", "of": "wind"}, {"name": "b", "kind": "position", "at": "b"},
    {"name": "at_pin", "kind": "signal", "signal": "at_pin"}, {"name": "pushed", "kind": "signal", "signal": "pushed"},
    {"name": "held", "kind": "signal", "signal": "held"}],
  "analysis": {"kind": "static", "tolerance": 1e-11}})-"));
  const auto last = [&out](const char* column) { return out.history.last(column); };
  EXPECT_NEAR(last("push.fz"), -12.0, 1e-12);
  EXPECT_NEAR(last("pushed"), -12.0, 1e-12);
  EXPECT_NEAR(last("wind.fy"), 3.0 * 2.0, 1e-9);
  EXPECT_NEAR(last("wind.mz"), 3.0 * 2.0 * 1.0, 1e-3);  // about the start of its beam
  EXPECT_NEAR(last("pad.fz"), -90.0 * last("b.z"), 1e-4);
  const double length = 3.0 - last("b.z"), tension = 50.0 * (std::hypot(length, last("b.y")) - 2.9);
  EXPECT_NEAR(last("rope.fz"), tension * length / std::hypot(length, last("b.y")), 1e-9);
  for (const char* axis : {"fy", "fz"})
    EXPECT_NEAR(last((std::string("pin.") + axis).c_str()) + last((std::string("roller.") + axis).c_str()) +
                    last((std::string("rope.") + axis).c_str()) + last((std::string("pad.") + axis).c_str()) +
                    last((std::string("push.") + axis).c_str()) + last((std::string("wind.") + axis).c_str()),
                0.0, 1e-7)
        << axis;
  EXPECT_NEAR(last("at_pin"), last("pin.fz"), 1e-9);
  EXPECT_NEAR(last("held"), last("turn.mz"), 1e-9);
  EXPECT_GT(std::abs(last("held")), 0.1);
}

}  // namespace
}  // namespace bough::run
