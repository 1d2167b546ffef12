// What is legal and hardly meant: hints that name the thing, change no verdict, and stay away where all is well.
#include <gtest/gtest.h>

#include <algorithm>

#include "bough/io/read_scene.hpp"
#include "bough/scene/components.hpp"
#include "scene_base.hpp"

namespace bough::io {
namespace {

struct Hint {
  const char* name;
  const char* from;
  const char* to;
  std::vector<const char*> words;  ///< all in one hint
};

std::string texts(const std::vector<Problem>& list) {
  std::string all;
  for (const Problem& p : list) all += p.text() + "\n";
  return all;
}

bool says(const std::vector<Problem>& list, const std::vector<const char*>& words) {
  return std::any_of(list.begin(), list.end(), [&words](const Problem& p) {
    return std::all_of(words.begin(), words.end(),
                       [&p](const char* word) { return p.text().find(word) != std::string::npos; });
  });
}

SceneFile read(const std::string& from, const std::string& to) {
  return read_scene_text(test::spoilt(from, to), "base");
}

const std::string cart = R"("initial_velocities": [ { "of": "cart", "velocity": [1, 0, 0] } ])";

TEST(SceneHints, sound_scene_gets_none) {
  const SceneFile file = read_scene_text(test::base_scene(), "base");
  EXPECT_TRUE(file.ok()) << texts(file.problems);
  EXPECT_TRUE(file.warnings.empty()) << texts(file.warnings);
}

TEST(SceneHints, other_units_and_huge_numbers_are_told_with_the_name_of_the_thing) {
  const Hint hints[] = {
      {"modulus in MPa", "\"young\": 2.1e11", "\"young\": 210000", {"/materials/0/young", "steel", "Pa"}},
      {"modulus in GPa", "\"young\": 2.1e11", "\"young\": 210", {"/materials/0/young", "steel", "Pa"}},
      {"density in g/cm^3", "\"density\": 7850", "\"density\": 7.85", {"/materials/0/density", "steel", "kg/m^3"}},
      {"sizes in mm", "\"width\": 0.02, \"height\": 0.04", "\"width\": 20, \"height\": 40", {"bar", "mm"}},
      {"angle in degrees", "\"angle\": 0.5", "\"angle\": 12", {"/frames/0/rotation/angle", "bench", "rad"}},
      {"gravity in mm/s^2", "[0, 0, -9.81]", "[0, 0, -9810]", {"/gravity", "9810", "m/s^2"}},
      {"stiffness of 1e30", "\"stiffness\": 10 }", "\"stiffness\": 1e30 }", {"/springs/0/stiffness", "coil", "1e+30"}},
      {"force of 1e20", "\"force\": [1, 0, 0]", "\"force\": [1e20, 0, 0]", {"/loads/0/force", "push", "1e+20 N"}},
      {"speed beyond that of light", "[1, 0, 0] } ]", "[4e8, 0, 0] } ]", {"/initial_velocities/0", "cart", "4e+08"}},
      {"inertia in kg mm^2", "[0.1, 0.2, 0.25]", "[1e7, 1e7, 1e7]", {"/bodies/0/inertia", "cart", "kg m^2"}}};
  for (const Hint& h : hints) {
    const SceneFile file = read(h.from, h.to);
    EXPECT_TRUE(file.ok()) << h.name << "\n" << texts(file.problems);
    EXPECT_TRUE(says(file.warnings, h.words)) << h.name << "\n" << texts(file.warnings);
  }
}

std::string arm(const std::string& body, const std::string& more, const std::string& analysis = R"("end_time": 1)") {
  return R"({"schema_version": 1, "gravity": [0, 0, -9.81],
    "bodies": [{"name": "link", )" +
         body + R"(, "position": [0.12, 0, 0]}],
    "joints": [{"name": "hinge", "kind": "revolute", "first": "ground", "second": "link", "position": [0, 0, 0],
      "axis": [0, 1, 0])" +
         more + R"(}], "analysis": {"kind": "dynamic", )" + analysis + "}}";
}

// Numbers that are legal in SI units and of another unit by all that surrounds them.
TEST(SceneHints, legal_numbers_of_other_units_are_told) {
  const std::string sound = R"("mass": 1.56, "inertia": [2.66e-3, 2.3e-3, 1.7e-3])";
  const struct {
    std::string scene;
    std::vector<const char*> words;
  } hints[] = {
      {arm(R"("mass": 0.008, "inertia": [1, 1, 1])", ""), {"/bodies/0/inertia", "radius of gyration", "kg m^2"}},
      {arm(R"("mass": 1.56, "inertia": [2.66, 2.3, 1.7])", ""), {"/bodies/0/inertia", "radius of gyration"}},
      {arm(sound + R"(, "center_of_mass": [60, 0, 0])", ""), {"/bodies/0/center_of_mass", "60 m", "mm"}},
      {arm(sound, R"(, "drives": [{"law": {"kind": "smooth_ramp", "end_time": 1, "to": 90}}])"),
       {"/joints/0/drives/0/law", "90 rad", "degrees"}},
      {arm(sound, R"(, "drives": [{"law": {"expression": "45*sin(3*t) + 0"}}])"), {"45 rad", "pi/180"}},
      {arm(sound, R"(, "drives": [{"rate": true, "law": 3000}])"), {"/joints/0/drives/0/law", "rpm", "314.159"}},
      {arm(sound, "", R"("end_time": 1000, "step_size": 1)"), {"/analysis/step_size", "milliseconds"}},
      {arm(sound, "", R"("end_time": 500)"), {"/analysis/end_time", "milliseconds"}}};
  for (const auto& h : hints) {
    const SceneFile file = read_scene_text(h.scene, "arm");
    EXPECT_TRUE(file.ok()) << h.scene << "\n" << texts(file.problems);
    EXPECT_TRUE(says(file.warnings, h.words)) << h.scene << "\n" << texts(file.warnings);
  }
  for (const std::string& scene :
       {arm(sound, ""), arm(sound, R"(, "drives": [{"law": {"expression": "1.57*sin(3*t) + 0"}}])"),
        arm(sound, R"(, "drives": [{"rate": true, "law": 314.159}])", R"("end_time": 1, "step_size": 1e-4)"),
        arm(sound, R"(, "drives": [{"law": {"expression": "100*t"}}])", R"("end_time": 10, "step_size": 1e-3)"),
        arm(sound, R"(, "drives": [{"law": {"expression": "6*t"}}])", R"("end_time": 10, "step_size": 1e-3)"),
        arm(sound, "", R"("end_time": 20, "step_size": 0.01)")}) {
    const SceneFile file = read_scene_text(scene, "arm");
    EXPECT_TRUE(file.warnings.empty()) << scene << "\n" << texts(file.warnings);
  }
}

// Twelve nodes beside the first: the fourth stands at a third of the beam, wherever the load was meant to act.
TEST(SceneHints, an_inner_node_of_a_mesh_that_is_chosen_is_told_with_its_place) {
  const auto scene = [](const std::string& mesh) {
    return R"({"schema_version": 1, "nodes": [{"name": "a"}, {"name": "z", "position": [4, 0, 0]}],
      "sections": [{"name": "s", "stiffness": {"EA": 1, "GA2": 1, "GA3": 1, "GJ": 1, "EI2": 1, "EI3": 1}}],
      "beams": [{"name": "b", "section": "s", "start": "a", "end": "z")" +
           mesh + R"(}], "joints": [{"name": "j", "kind": "fixed", "first": "ground", "second": "a"}],
      "loads": [{"at": "b.4", "force": [0, 0, 1]}], "analysis": {"kind": "static"}})";
  };
  const SceneFile chosen = read_scene_text(scene(""), "beam"),
                  given = read_scene_text(scene(R"(, "elements": 8)"), "beam");
  EXPECT_TRUE(says(chosen.warnings, {"/loads/0/at", "b.4", "0.333", "elements"})) << texts(chosen.warnings);
  EXPECT_FALSE(says(given.warnings, {"b.4"})) << texts(given.warnings);
}

TEST(SceneHints, numbers_beyond_computing_are_refused) {
  const Hint faults[] = {
      {"force", "\"force\": [1, 0, 0]", "\"force\": [1e300, 0, 0]", {"/loads/0/force", "push", "too large"}},
      {"stiffness", "\"stiffness\": 10 }", "\"stiffness\": 1e200 }", {"/springs/0/stiffness", "coil", "too large"}},
      {"place", "\"position\": [0, 2, -1]", "\"position\": [0, 1e308, -1]", {"/bodies/1/position", "bob", "too large"}},
      {"angle", "\"angle\": 0.5", "\"angle\": 1e300", {"/frames/0/rotation/angle", "too large"}},
      {"axis", "\"axis\": [0, 0, 1], \"angle\"", "\"axis\": [0, 0, 5e-324], \"angle\"", {"/frames/0/rotation/axis"}}};
  for (const Hint& f : faults) {
    const SceneFile file = read(f.from, f.to);
    EXPECT_TRUE(says(file.problems, f.words)) << f.name << "\n" << texts(file.problems);
  }
}

TEST(SceneHints, densities_go_with_shapes) {
  for (const char* key : {"\"density\": 7850, ", "\"material\": \"steel\", "}) {
    const SceneFile body = read("\"mass\": 2, \"inertia\"", key + std::string("\"inertia\""));
    EXPECT_TRUE(says(body.problems, {"/bodies/0", "go with a shape"})) << texts(body.problems);
    const SceneFile point =
        read("\"kind\": \"point_mass\", \"mass\": 0.5,", key + std::string("\"kind\": \"point_mass\","));
    EXPECT_TRUE(says(point.problems, {"/bodies/1", "a mass only"})) << texts(point.problems);
  }
}

TEST(SceneHints, settings_without_effect_are_told) {
  const char* const dynamic = R"("end_time": 1, "step_size": 1e-3, "spectral_radius": 0.9)";
  const Hint hints[] = {
      {"spectral radius of bdf",
       dynamic,
       R"("end_time": 1, "integrator": "bdf", "spectral_radius": 0.9)",
       {"/analysis/spectral_radius", "no effect", "bdf"}},
      {"order of bdf", dynamic, R"("end_time": 1, "bdf_order": 2)", {"/analysis/bdf_order", "no effect"}},
      {"beta of variational",
       dynamic,
       R"("end_time": 1, "newmark_beta": 0.3)",
       {"/analysis/newmark_beta", "no effect"}}};
  for (const Hint& h : hints) {
    const SceneFile file = read(h.from, h.to);
    EXPECT_TRUE(file.ok()) << h.name << "\n" << texts(file.problems);
    EXPECT_TRUE(says(file.warnings, h.words)) << h.name << "\n" << texts(file.warnings);
  }
  const SceneFile path =
      read_scene_text(R"({"schema_version": 1, "nodes": [{"name": "a"}, {"name": "b", "position": [1, 0, 0]}],
    "sections": [{"name": "s", "stiffness": [1, 1, 1, 1, 1, 1]}],
    "beams": [{"name": "arm", "section": "s", "start": "a", "end": "b", "elements": 1}],
    "joints": [{"name": "wall", "kind": "fixed", "first": "ground", "second": "a"}],
    "analysis": {"kind": "static", "load_steps": 4, "arc_length": {"step": 0.1}}})",
                      "path");
  EXPECT_TRUE(path.ok()) << texts(path.problems);
  EXPECT_TRUE(says(path.warnings, {"/analysis/load_steps", "arc_length"})) << texts(path.warnings);
}

// Springs with laws and servos are made of signals, which all analyses take; the variational integrator none that reads
// what a joint holds.
TEST(SceneHints, all_analyses_take_signals_but_the_variational_integrator_none_of_reactions) {
  const std::string start = R"({"schema_version": 1, "bodies": [{"name": "a", "mass": 1, "inertia": [1, 1, 1]}],
      "joints": [{"name": "axle", "kind": "revolute", "first": "ground", "second": "a", "axis": [0, 0, 1]}], )";
  const std::string spring =
      R"("springs": [{"name": "coil", "first": "ground", "second": {"to": "a", "position": [1, 0, 0]},
                      "force_law": {"expression": "9*stretch^3"}}], )";
  const std::string servo = R"("actuators": [{"name": "motor", "kind": "servo", "joint": "axle", "position_gain": 4,
                                              "limit": 3, "lag": 0.1}], )";
  const std::string signal = R"("signals": [{"name": "now", "kind": "time", "law": 1}], )";
  const std::string variational =
                        R"("analysis": {"kind": "dynamic", "end_time": 1, "step_size": 1e-2,
                                        "integrator": "variational"}})",
                    path = R"("analysis": {"kind": "static", "arc_length": {"step": 0.1}}})";
  for (const std::string& part : {spring, servo, signal})
    for (const std::string& analysis : {variational, path}) {
      const SceneFile file = read_scene_text(start + part + analysis, "a");
      EXPECT_TRUE(file.ok()) << part << analysis << texts(file.problems);
    }
  const std::string reaction =
      R"("signals": [{"name": "push", "kind": "joint_reaction", "joint": "axle", "component": "fx"}], )";
  EXPECT_TRUE(read_scene_text(start + reaction + path, "a").ok());
  const SceneFile refused = read_scene_text(start + reaction + variational, "a");
  ASSERT_EQ(refused.problems.size(), 1u) << texts(refused.problems);
  EXPECT_EQ(refused.problems.front().pointer, "/signals/0");
  EXPECT_TRUE(says(refused.problems, {"to first order only", "/analysis/integrator"})) << texts(refused.problems);
}

// A servo is made of four signals and an effort, this spring of a strut.
TEST(SceneHints, items_are_counted_as_written) {
  const SceneFile file = read_scene_text(R"({"schema_version": 1,
      "bodies": [{"name": "a", "mass": 1, "inertia": [1, 1, 1]}],
      "joints": [{"name": "axle", "kind": "revolute", "first": "ground", "second": "a", "axis": [0, 0, 1]}],
      "springs": [{"name": "coil", "first": "ground", "second": {"to": "a", "position": [1, 0, 0]},
                   "force_law": {"expression": "9*stretch^3"}}],
      "actuators": [{"name": "motor", "kind": "servo", "joint": "axle", "position_gain": 4, "limit": 3, "lag": 0.1}],
      "repeat": [{"index": "i", "count": 3, "signals": [{"name": "now{i}", "kind": "time", "law": 1}]}],
      "analysis": {"kind": "dynamic", "end_time": 1, "step_size": 1e-2}})",
                                         "a");
  ASSERT_TRUE(file.ok()) << texts(file.problems);
  EXPECT_EQ(file.scene.joints.size(), 2u);
  EXPECT_GT(file.scene.signals.size(), 7u);
  const std::map<std::string, std::size_t, std::less<>> written{
      {"bodies", 1}, {"joints", 1}, {"springs", 1}, {"actuators", 1}, {"signals", 3}};
  EXPECT_EQ(file.counts, written);
}

TEST(SceneHints, velocities_that_joints_do_not_allow_are_told_with_joint_and_size) {
  const SceneFile across = read(cart, R"("initial_velocities": [ { "of": "cart", "velocity": [1, 3, 0] } ])");
  EXPECT_TRUE(across.ok()) << texts(across.problems);
  EXPECT_TRUE(says(across.warnings, {"/joints/1", "rail", "3 m/s"})) << texts(across.warnings);
  const SceneFile turning = read(cart, R"("initial_velocities": [ { "of": "cart", "angular_velocity": [0, 2, 0] } ])");
  EXPECT_TRUE(says(turning.warnings, {"rail", "2 rad/s"})) << texts(turning.warnings);
  const SceneFile clamped = read(cart, R"("initial_velocities": [ { "of": "root", "velocity": [0, 0, 4] } ])");
  EXPECT_TRUE(says(clamped.warnings, {"clamp", "4 m/s"})) << texts(clamped.warnings);
}

TEST(SceneHints, velocities_of_one_rigid_part_that_contradict_each_other_are_refused) {
  const auto two = [](const char* second) {
    return read_scene_text(std::string(R"({"schema_version": 1, "bodies": [
      {"name": "a", "mass": 1, "inertia": [1, 1, 1]},
      {"name": "b", "mass": 1, "inertia": [1, 1, 1], "position": [1, 0, 0]}],
      "joints": [{"name": "glue", "kind": "fixed", "first": "a", "second": "b"}],
      "initial_velocities": [{"of": "a", "angular_velocity": [0, 0, 2]}, {"of": "b", )") +
                               second + R"(}], "analysis": {"kind": "dynamic", "end_time": 1}})",
                           "two");
  };
  const SceneFile same = two(R"("velocity": [0, 2, 0], "angular_velocity": [0, 0, 2])");
  EXPECT_TRUE(same.ok()) << texts(same.problems);
  EXPECT_TRUE(same.warnings.empty()) << texts(same.warnings);
  const SceneFile other = two(R"("velocity": [0, 5, 0], "angular_velocity": [0, 0, 2])");
  EXPECT_TRUE(says(other.problems, {"/initial_velocities/1", "'a'", "\"b\"", "contradict", "3 m/s"}))
      << texts(other.problems);
}

TEST(SceneHints, gaps_are_judged_against_the_parts_that_meet) {
  const std::string rail = R"("second": "cart", "position": [0, 2, 0], "axis": [1, 0, 0] })";
  const auto with_gap = [&rail](const char* gap, const char* far) {
    std::string text =
        test::spoilt(R"("first": "ground", )" + rail,
                     std::string(R"("first": { "to": "ground", "position": [0, 2, )") + gap +
                         R"(] }, "second": { "to": "cart", "position": [0, 0, 0] }, "axis": [1, 0, 0] })");
    const std::string bodies = "\"bodies\": [";
    text.insert(text.find(bodies) + bodies.size(), far);
    return read_scene_text(text, "gap");
  };
  const char* const moon = R"({ "name": "moon", "mass": 1, "inertia": [1, 1, 1], "position": [1e9, 0, 0] }, )";
  for (const char* far : {"", moon}) {
    for (const char* gap : {"0.005", "500"}) {
      const SceneFile file = with_gap(gap, far);
      EXPECT_TRUE(says(file.problems, {"/joints/1", "rail", "apart"})) << gap << far << "\n" << texts(file.problems);
    }
    const SceneFile closed = with_gap("1e-8", far);
    EXPECT_TRUE(closed.ok()) << texts(closed.problems);
  }
}

TEST(SceneHints, beams_whose_elements_turn_too_far_are_refused_by_name) {
  const auto ring = [](int elements) {
    return read_scene_text(
        R"({"schema_version": 1, "nodes": [{"name": "a"}, {"name": "b", "position": [0, 0.63661977236758, 0]}],
      "sections": [{"name": "s", "stiffness": [1, 1, 1, 1, 1, 1]}],
      "beams": [{"name": "ring", "section": "s", "start": "a", "end": "b", "elements": )" +
            std::to_string(elements) +
            R"(, "curve": {"curvature": [0, 0, 3.141592653589793], "length": 1, "tangent": [1, 0, 0]}}],
      "joints": [{"name": "wall", "kind": "fixed", "first": "ground", "second": "a"}],
      "analysis": {"kind": "static"}})",
        "ring");
  };
  EXPECT_TRUE(ring(2).ok()) << texts(ring(2).problems);
  EXPECT_TRUE(says(ring(1).problems, {"ring", "element", "3.14"})) << texts(ring(1).problems);
}

TEST(SceneHints, faulty_beam_does_not_make_its_section_unused) {
  const SceneFile file = read("\"end\": \"tip\"", "\"end\": \"tipp\"");
  EXPECT_FALSE(file.ok());
  const SceneFile wrong_order = read("\"elements\": 2, \"order\": 2", "\"elements\": 2, \"order\": 9");
  EXPECT_FALSE(wrong_order.ok());
  EXPECT_FALSE(says(wrong_order.warnings, {"no beam uses"})) << texts(wrong_order.warnings);
}

TEST(SceneHints, problems_name_the_thing_that_they_are_in) {
  const SceneFile file = read("\"elements\": 4 }", "\"elements\": 0 }");
  EXPECT_TRUE(says(file.problems, {"/beams/0/elements of \"upper\""})) << texts(file.problems);
}

TEST(SceneHints, spectral_radius_of_one_goes_with_clamps_alone) {
  const auto beam = [](const char* kind) {
    return read_scene_text(
        std::string(R"({"schema_version": 1, "nodes": [{"name": "a"}, {"name": "b", "position": [1, 0, 0]}],
      "sections": [{"name": "s", "stiffness": [1, 1, 1, 1, 1, 1], "mass": [1, 1, 1, 1, 1, 1]}],
      "beams": [{"name": "arm", "section": "s", "start": "a", "end": "b", "elements": 1}], "joints": [{"name": "wall", "kind": ")") +
            kind + R"(", "first": "ground", "second": "a", "axis": [0, 0, 1]}],
      "analysis": {"kind": "dynamic", "end_time": 1, "spectral_radius": 1}})",
        "beam");
  };
  EXPECT_TRUE(beam("fixed").ok()) << texts(beam("fixed").problems);
  EXPECT_TRUE(says(beam("revolute").problems, {"/analysis/spectral_radius", "below 1"}));
}

TEST(SceneHints, rate_of_a_joint_with_two_coordinates_says_which) {
  const std::string sensor = R"("kind": "joint_angle", "joint": "hinge" })", rail = R"("kind": "prismatic")";
  const auto rate = [&](const char* kind, const char* coordinate) {
    std::string text =
        test::spoilt(sensor, std::string(R"("kind": "joint_rate", "joint": "rail")") + coordinate + " }");
    text.replace(text.find(rail), rail.size(), std::string("\"kind\": \"") + kind + "\"");
    return read_scene_text(text, "rate");
  };
  EXPECT_TRUE(rate("prismatic", "").ok());
  EXPECT_TRUE(says(rate("cylindrical", "").problems, {"/sensors/2", "coordinate"}));
  EXPECT_TRUE(rate("cylindrical", R"(, "coordinate": "angle")").ok());
  EXPECT_TRUE(rate("cylindrical", R"(, "coordinate": "displacement")").ok());
  EXPECT_TRUE(
      says(rate("prismatic", R"(, "coordinate": "angle")").problems, {"/sensors/2/coordinate", "displacement"}));
}

TEST(SceneHints, every_kind_of_joint_is_read_as_itself) {
  for (const scene::JointType& type : scene::joint_types()) {
    EXPECT_EQ(&scene::type_of(type.kind), &type) << type.name;
    EXPECT_EQ(scene::joint_kind_named(type.name), type.kind);
  }
  EXPECT_EQ(scene::joint_kind_named("ninth"), std::nullopt);
  for (const char* kind : {"revolute", "prismatic", "cylindrical", "planar"}) {
    std::string text = test::base_scene();
    const std::string rail = R"("kind": "prismatic")";
    text.replace(text.find(rail), rail.size(), std::string("\"kind\": \"") + kind + "\"");
    const SceneFile file = read_scene_text(text, "kinds");
    ASSERT_TRUE(file.ok()) << texts(file.problems);
    EXPECT_EQ(scene::to_string(file.scene.joints[1].kind), kind);
  }
}

}  // namespace
}  // namespace bough::io
