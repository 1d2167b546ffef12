// What is said about reactions that are not unique is a property of the scene: the same whatever the plan saves.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "bough/run/memory_run.hpp"
#include "support/scenes.hpp"

namespace bough::run {
namespace {

using support::run;
using support::scene_of;

/// The note on rows that depend on others, without a saving or with all; empty: there is none.
std::string note_of(const std::string& json, const std::vector<std::string>& overrides) {
  const auto outcome = run(scene_of(json, overrides));
  EXPECT_TRUE(outcome.ok()) << outcome.summary.cause;
  for (const std::string& note : outcome.summary.notes)
    if (note.find("depend on others") != std::string::npos) return note;
  return "";
}

const std::string dynamic = R"("analysis": {"kind": "dynamic", "end_time": 0.1, "step_size": 0.005})";

std::string bodies(const std::vector<std::string>& places) {
  std::string list;
  for (std::size_t k = 0; k < places.size(); ++k)
    list += (k > 0 ? ", " : "") + std::string(R"({"name": ")") + static_cast<char>('a' + k) +
            R"(", "mass": 1, "inertia": [0.1, 0.1, 0.1], "position": )" + places[k] + "}";
  return R"("bodies": [)" + list + "]";
}
std::string joint(const std::string& name, const std::string& kind, const std::string& first, const std::string& second,
                  const std::string& position, const std::string& more = "") {
  return R"({"name": ")" + name + R"(", "kind": ")" + kind + R"(", "first": ")" + first + R"(", "second": ")" + second +
         R"(", "position": )" + position + more + "}";
}
const std::string about_y = R"(, "axis": [0, 1, 0])", along_x = R"(, "axis": [1, 0, 0])";

/// Four bars with parallel hinges: a swings, b couples, c swings, on the ground.
std::string four_bar(const std::string& more_of_crank, const std::string& analysis,
                     const std::string& last = "revolute") {
  return R"({"gravity": [0, 0, -9.81], )" + bodies({"[0, 0, 0.5]", "[1, 0, 1.2]", "[2, 0, 0.7]"}) + R"(, "joints": [)" +
         joint("crank", "revolute", "ground", "a", "[0, 0, 0]", about_y + more_of_crank) + ", " +
         joint("left", "revolute", "a", "b", "[0, 0, 1]", about_y) + ", " +
         joint("right", "revolute", "b", "c", "[2, 0, 1.4]", about_y) + ", " +
         joint("rocker", last, "ground", "c", "[2.2, 0, 0]", last == "spherical" ? "" : about_y) + "], " + analysis +
         "}";
}

struct Case {
  const char* name;
  std::string json;
  const char* rows;  ///< how the note begins; empty: there is none
};

std::vector<Case> cases() {
  const std::string drive = R"-(, "drives": [{"law": {"expression": "0.2*sin(3*t)"}}])-",
                    spring = R"(, "forces": [{"stiffness": 300}])";
  return {
      {"four bars in a plane", four_bar("", dynamic), "3 constraint"},
      {"driven four bars", four_bar(drive, dynamic), "3 constraint"},
      {"four bars whose efforts are asked for",
       four_bar(drive, R"("analysis": {"kind": "inverse_dynamics", "end_time": 0.4, "step_size": 0.1})"),
       "3 constraint"},
      {"four bars on a spring in statics", four_bar(spring, R"("analysis": {"kind": "static"})"), "3 constraint"},
      {"four bars with a ball that takes what is too much", four_bar("", dynamic, "spherical"), "1 constraint"},
      {"an open chain in a plane",
       R"({"gravity": [0, 0, -9.81], )" + bodies({"[0, 0, 0.5]", "[0, 0, 1.5]"}) + R"(, "joints": [)" +
           joint("lower", "revolute", "ground", "a", "[0, 0, 0]", about_y) + ", " +
           joint("upper", "revolute", "a", "b", "[0, 0, 1]", about_y) + "], " + dynamic + "}",
       ""},
      {"a slide on two rails along a line",
       R"({"gravity": [9.81, 0, 0], )" + bodies({"[0, 0, 0]"}) + R"(, "joints": [)" +
           joint("front", "prismatic", "ground", "a", "[0, 1, 0]", along_x) + ", " +
           joint("back", "prismatic", "ground", "a", "[0, -1, 0]", along_x) + "], " + dynamic + "}",
       "5 constraint"},
      {"a ring of parts fixed to each other that falls",
       R"({"gravity": [0, 0, -9.81], )" + bodies({"[0, 0, 0]", "[1, 0, 0]", "[0, 1, 0]"}) + R"(, "joints": [)" +
           joint("ab", "fixed", "a", "b", "[0.5, 0, 0]") + ", " + joint("bc", "fixed", "b", "c", "[0.5, 0.5, 0]") +
           ", " + joint("ca", "fixed", "c", "a", "[0, 0.5, 0]") + "], " + dynamic + "}",
       "6 constraint"},
  };
}

/// Two telescopic Cardan shafts side by side between a driven input and a braked output: one row depends on the others,
/// and its null vector, a torque locked between the two shafts, turns with them.
const char* const cardan_shafts = R"-({
  "parameters": {"w": 12, "b": {"expression": "17*pi/180"}, "g": {"expression": "34*pi/180"}, "L": 0.3},
  "bodies": [
    {"name": "input", "mass": 2, "inertia": [0.01, 0.02, 0.02], "position": [-0.1, 0, 0]},
    {"name": "output", "mass": 2, "inertia": [0.01, 0.02, 0.02],
     "position": [{"expression": "L*cos(b) + 0.1*cos(g)"}, 0, {"expression": "L*sin(b) + 0.1*sin(g)"}],
     "rotation": {"axis": [0, -1, 0], "angle": {"expression": "g"}}}],
  "joints": [
    {"name": "in", "kind": "revolute", "first": "ground", "second": "input", "position": [-0.1, 0, 0],
     "axis": [1, 0, 0], "drives": [{"law": {"expression": "w"}, "rate": true}]},
    {"name": "out", "kind": "revolute", "first": "ground", "second": "output",
     "axis": [{"expression": "cos(g)"}, 0, {"expression": "sin(g)"}], "forces": [{"effort": -6.5}]}],
  "repeat": [{"index": "i", "first": 1, "count": 2,
    "bodies": [
      {"name": "near {i}", "mass": 0.5, "inertia": [0.004, 0.003, 0.003],
       "position": [{"expression": "0.075*cos(b)"}, 0, {"expression": "0.075*sin(b)"}],
       "rotation": {"axis": [0, -1, 0], "angle": {"expression": "b"}}},
      {"name": "far {i}", "mass": 0.5, "inertia": [0.004, 0.003, 0.003],
       "position": [{"expression": "0.225*cos(b)"}, 0, {"expression": "0.225*sin(b)"}],
       "rotation": {"axis": [0, -1, 0], "angle": {"expression": "b"}}}],
    "joints": [
      {"name": "first cross {i}", "kind": "universal", "first": "input", "second": "near {i}", "position": [0, 0, 0],
       "axis": [0, 0, 1], "second_axis": [0, 1, 0]},
      {"name": "slide {i}", "kind": "prismatic", "first": "near {i}", "second": "far {i}",
       "position": [{"expression": "0.15*cos(b)"}, 0, {"expression": "0.15*sin(b)"}],
       "axis": [{"expression": "cos(b)"}, 0, {"expression": "sin(b)"}]},
      {"name": "second cross {i}", "kind": "universal", "first": "far {i}", "second": "output",
       "position": [{"expression": "L*cos(b)"}, 0, {"expression": "L*sin(b)"}], "axis": [0, 1, 0],
       "second_axis": [{"expression": "-sin(g)"}, 0, {"expression": "cos(g)"}]}],
    "sensors": [{"name": "r{i}", "kind": "joint_reaction", "joint": "slide {i}", "axes": "body"}]}],
  "sensors": [{"name": "torque", "kind": "joint_effort", "joint": "in", "of": "drive"}],
  "analysis": {"kind": "dynamic", "end_time": 4, "step_size": 0.002}})-";

// What no equation sees grew by e every radian. The closed form is that of two Hooke's joints in phase: the shafts
// between turn at w3 = w cos b / (1 - sin^2 b cos^2 wt), and each takes J w3 w3' / w of the drive's torque.
TEST(Redundancy, reactions_of_loops_that_turn_stay_those_of_least_norm) {
  const double w = 12.0, b = 17.0 * 3.14159265358979323846 / 180.0, inertia = 0.008, brake = 6.5;
  for (const char* form : {"local", "augmented", "hybrid"}) {
    const MemoryRun outcome = run_in_memory(scene_of(cardan_shafts, {std::string("/solver/form=") + form}));
    ASSERT_TRUE(outcome.ok()) << form << ": " << outcome.text();
    const auto torque = outcome.series("torque"), first = outcome.series("r1.mz"), second = outcome.series("r2.mz");
    double off = 0.0, apart = 0.0;
    for (std::size_t k = 1; k < outcome.rows.size(); ++k) {
      const double c = std::cos(w * outcome.rows[k].time), s = std::sin(w * outcome.rows[k].time), sine = std::sin(b);
      const double d = 1.0 - sine * sine * c * c, speed = w * std::cos(b) / d;
      const double rate = -w * std::cos(b) / (d * d) * (2.0 * sine * sine * c * s * w);
      const double expected = brake + 2.0 * inertia * speed * rate / w;
      off = std::max(off, std::abs(std::abs(torque[k]) - expected));
      apart = std::max(apart, std::abs(first[k] - second[k]));
    }
    std::printf("%s: torque off by %.1e N m, the shafts share it to %.1e N m\n", form, off, apart);
    EXPECT_LT(off, 2e-4) << form;    // twice the error of second order of these steps
    EXPECT_LT(apart, 1e-6) << form;  // by symmetry they share it equally, but for the tolerance
  }
}

TEST(Redundancy, is_told_alike_with_and_without_every_saving) {
  const char* const savings[] = {"planar", "line", "translation", "held", "welded"};
  for (const Case& c : cases()) {
    SCOPED_TRACE(c.name);
    const std::string told = note_of(c.json, {});
    EXPECT_EQ(told.substr(0, std::string(c.rows).size()), c.rows) << told;
    EXPECT_EQ(told.empty(), std::string(c.rows).empty()) << told;
    std::string all;
    for (const char* saving : savings) {
      EXPECT_EQ(note_of(c.json, {std::string("/without=[\"") + saving + "\"]"}), told) << "without " << saving;
      all += (all.empty() ? "\"" : ", \"") + std::string(saving) + "\"";
    }
    EXPECT_EQ(note_of(c.json, {"/without=[" + all + "]"}), told) << "in full";
  }
}

}  // namespace
}  // namespace bough::run
