// Units of signals and of the sensors that show them.
#include <gtest/gtest.h>

#include <map>

#include "bough/io/read_scene.hpp"
#include "bough/plan/history_header.hpp"
#include "bough/scene/signals.hpp"

namespace bough::io {
namespace {

/// A hinge and a rail with the signals given, the first of which drives the hinge, the second the rail.
scene::Scene scene_with(const std::string& signals, const std::string& hinge, const std::string& rail) {
  const SceneFile file = read_scene_text(
      R"({"schema_version": 1, "analysis": {"kind": "dynamic", "end_time": 1},
    "bodies": [{"name": "door", "mass": 1, "inertia": [1, 1, 1]}, {"name": "sledge", "mass": 1, "inertia": [1, 1, 1]}],
    "joints": [{"name": "hinge", "kind": "revolute", "first": "ground", "second": "door", "axis": [0, 0, 1])" +
          hinge + R"(},
      {"name": "rail", "kind": "prismatic", "first": "ground", "second": "sledge", "axis": [1, 0, 0])" +
          rail + R"(}],
    "springs": [{"name": "coil", "first": "door", "second": {"to": "sledge", "position": [0, 1, 0]}, "stiffness": 1}],
    "signals": [)" +
          signals + "]}",
      "units");
  EXPECT_TRUE(file.ok()) << (file.ok() ? "" : file.problems.front().pointer + ": " + file.problems.front().rule);
  return file.scene;
}

/// Units by name, "?" where nothing is known.
std::map<std::string, std::string> units_of(const scene::Scene& scene) {
  std::map<std::string, std::string> units;
  const auto found = scene::units_of_signals(scene);
  for (std::size_t i = 0; i < found.size(); ++i) units[scene.signals[i].name] = found[i].value_or("?");
  return units;
}
using Units = std::map<std::string, std::string>;

std::string formula(const std::string& name, const std::string& text, const std::string& kind = "formula") {
  return R"({"name": ")" + name + R"(", "kind": ")" + kind + R"(", "expression": ")" + text + "\"}";
}

TEST(SignalUnits, are_those_of_what_is_read) {
  const scene::Scene scene = scene_with(
      R"({"name": "q", "kind": "joint_angle", "joint": "hinge"}, {"name": "w", "kind": "joint_rate", "joint": "hinge"},
      {"name": "T", "kind": "joint_effort", "joint": "hinge"}, {"name": "s", "kind": "joint_displacement", "joint": "rail"},
      {"name": "v", "kind": "joint_rate", "joint": "rail"}, {"name": "F", "kind": "joint_effort", "joint": "rail"},
      {"name": "N", "kind": "spring_tension", "spring": "coil"},
      {"name": "R", "kind": "joint_reaction", "joint": "hinge", "component": "fx"},
      {"name": "M", "kind": "joint_reaction", "joint": "hinge", "component": "mx"},
      {"name": "x", "kind": "position", "at": "sledge", "axis": "x"},
      {"name": "u", "kind": "velocity", "at": "sledge", "axis": "x"})",
      "", "");
  Units units = units_of(scene);
  units.erase("M_turned");
  EXPECT_EQ(units, (Units{{"q", "rad"},
                          {"w", "rad/s"},
                          {"T", "N m"},
                          {"s", "m"},
                          {"v", "m/s"},
                          {"F", "N"},
                          {"N", "N"},
                          {"R", "N"},
                          {"M", "N m"},
                          {"x", "m"},
                          {"u", "m/s"}}));
}

// Gains have units that nobody has given, so that what they make is known by what it drives alone.
TEST(SignalUnits, follow_from_formulas_and_from_what_is_driven) {
  const std::string signals = formula("torque", "150*lag - 12*rate") + "," + formula("force", "100*lag") + "," +
                              R"({"name": "path", "kind": "time", "law": 1},
      {"name": "angle", "kind": "joint_angle", "joint": "hinge"}, {"name": "rate", "kind": "joint_rate", "joint": "hinge"},)" +
                              formula("lag", "path - angle") + "," + formula("sum", "lag", "state") + "," +
                              formula("count", "rate", "state") + "," + formula("ratio", "rate/rate") + "," +
                              formula("work", "torque*ratio") + "," + formula("gain", "2*lag") + "," +
                              formula("late", "(lag - late)/0.1", "state");
  const scene::Scene scene = scene_with(signals, R"(, "forces": [{"effort": {"signal": "torque"}}])",
                                        R"(, "forces": [{"effort": {"signal": "force"}}])");
  EXPECT_EQ(units_of(scene), (Units{{"torque", "N m"},
                                    {"force", "N"},
                                    {"path", "?"},
                                    {"angle", "rad"},
                                    {"rate", "rad/s"},
                                    {"lag", "rad"},
                                    {"sum", "rad s"},
                                    {"count", "rad"},
                                    {"ratio", ""},
                                    {"work", "N m"},
                                    {"gain", "?"},
                                    {"late", "?"}}));
}

TEST(SignalUnits, of_drives_are_those_of_coordinates) {
  const scene::Scene scene =
      scene_with(formula("turn", "1", "state") + "," + R"({"name": "way", "kind": "time", "law": 0})",
                 R"(, "drives": [{"law": {"signal": "turn"}}])", R"(, "drives": [{"law": {"signal": "way"}}])");
  EXPECT_EQ(units_of(scene), (Units{{"turn", "rad"}, {"way", "m"}}));
}

// One number for a torque and a force has no unit of its own.
TEST(SignalUnits, of_what_drives_two_kinds_are_not_known) {
  const scene::Scene scene =
      scene_with(R"({"name": "both", "kind": "input"})", R"(, "forces": [{"effort": {"signal": "both"}}])",
                 R"(, "forces": [{"effort": {"signal": "both"}}])");
  EXPECT_EQ(units_of(scene), (Units{{"both", "?"}}));
}

TEST(SignalUnits, that_are_declared_hold_and_are_passed_on) {
  const scene::Scene scene = scene_with(
      R"({"name": "p", "kind": "input", "unit": "Pa"}, {"name": "n", "kind": "input", "unit": "-"},
      {"name": "x", "kind": "state", "expression": "p", "nominal": 3, "unit": "Pa s"},)" +
          formula("q", "p*n"),
      "", "");
  EXPECT_EQ(units_of(scene), (Units{{"p", "Pa"}, {"n", ""}, {"x", "Pa s"}, {"x_of_nominal", ""}, {"q", "Pa"}}));
}

TEST(SignalUnits, are_those_of_columns_and_of_pictures) {
  scene::Scene scene = scene_with(R"({"name": "q", "kind": "joint_angle", "joint": "hinge"},
      {"name": "p", "kind": "input", "unit": "Pa"}, {"name": "c", "kind": "time", "law": 1, "unit": "K"})",
                                  "", "");
  for (const char* name : {"q", "p", "c"}) {
    scene::Sensor sensor;
    sensor.name = name;
    sensor.kind = scene::SensorKind::signal;
    sensor.signal = name;
    scene.sensors.push_back(sensor);
  }
  const plan::Plan plan = plan::make_plan(scene);
  const records::HistoryHeader header = plan::make_header(plan);
  ASSERT_EQ(header.about.size(), 3u);
  EXPECT_EQ(header.about[0].unit, "rad");
  EXPECT_EQ(header.about[1].unit, "Pa");
  EXPECT_EQ(header.about[2].unit, "K");
  for (const plan::SignalPlan& s : plan.signals) EXPECT_EQ(s.unit, s.name == "q" ? "rad" : "Pa");
}

}  // namespace
}  // namespace bough::io
