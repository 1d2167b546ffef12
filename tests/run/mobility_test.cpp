/// Degrees of freedom, locked mechanisms, motions that nothing holds or that have no inertia; joints that are judged
/// by the parts that meet.
#include <gtest/gtest.h>

#include <algorithm>

#include "bough/plan/plan.hpp"
#include "support/scenes.hpp"

namespace bough {
namespace {

const std::string soon = R"("analysis": {"kind": "dynamic", "end_time": 0.02, "step_size": 0.01})";
const std::string statics = R"("analysis": {"kind": "static"})";

std::string body(const std::string& name, const std::string& position, const std::string& inertia = "[0.1, 0.2, 0.3]") {
  return R"({"name": ")" + name + R"(", "mass": 1, "inertia": )" + inertia + R"(, "position": )" + position + "}";
}

std::string joint(const std::string& name, const std::string& kind, const std::string& first, const std::string& second,
                  const std::string& position, const std::string& axis = "[0, 0, 1]") {
  return R"({"name": ")" + name + R"(", "kind": ")" + kind + R"(", "first": ")" + first + R"(", "second": ")" + second +
         R"(", "position": )" + position + R"(, "axis": )" + axis + "}";
}

/// Four hinges in a loop; the axis of one is turned by five degrees.
scene::Scene four_bar(const std::string& turned,
                      const std::string& how = "[0.0871557427476582, 0, 0.9961946980917455]") {
  const auto hinge = [&](const char* name, const char* first, const char* second, const char* position) {
    return joint(name, "revolute", first, second, position, turned == name ? how : "[0, 0, 1]");
  };
  return support::scene_of(
      "{\"bodies\": [" + body("crank", "[0, 0.5, 0]") + ", " + body("coupler", "[1, 1, 0]") + ", " +
      body("rocker", "[2.5, 0.5, 0]") + "], \"joints\": [" + hinge("A", "ground", "crank", "[0, 0, 0]") + ", " +
      hinge("B", "crank", "coupler", "[0, 1, 0]") + ", " + hinge("C", "coupler", "rocker", "[2, 1.3, 0]") + ", " +
      hinge("D", "ground", "rocker", "[3, 0, 0]") + "], " + soon + "}");
}

std::string all(const std::vector<std::string>& texts) {
  std::string sum;
  for (const std::string& t : texts) sum += t + "\n";
  return sum;
}

bool says(const std::vector<std::string>& texts, const std::vector<std::string>& words) {
  return std::any_of(texts.begin(), texts.end(), [&words](const std::string& text) {
    return std::all_of(words.begin(), words.end(),
                       [&text](const std::string& word) { return text.find(word) != std::string::npos; });
  });
}

TEST(Mobility, counts_what_joints_leave_and_what_loops_take) {
  const plan::Mobility m = plan::make_plan(four_bar("")).mobility;
  ASSERT_EQ(m.parts.size(), 1u);
  EXPECT_EQ(m.parts[0].freedoms, 3);      // of the spanning tree
  EXPECT_EQ(m.parts[0].closing_rows, 5);  // of the hinge that closes the loop
  EXPECT_EQ(m.parts[0].rank, 2);
  EXPECT_EQ(m.degrees_of_freedom(), 1);
  EXPECT_TRUE(m.locked.empty()) << all(m.locked);
  EXPECT_TRUE(m.massless.empty()) << all(m.massless);
}

TEST(Mobility, counts_the_mechanisms_of_the_gallery) {
  const std::pair<const char*, int> known[] = {{"pendulum", 1},     {"double_pendulum", 2},  {"four_bar_planar", 1},
                                               {"bricard", 1},      {"andrews_squeezer", 1}, {"heavy_top", 3},
                                               {"slider_crank", 1}, {"tumbling_body", 6}};
  for (const auto& [name, count] : known) {
    const plan::Plan p = plan::make_plan(support::gallery(name));
    EXPECT_EQ(p.mobility.degrees_of_freedom(), count) << name;
    EXPECT_TRUE(p.mobility.locked.empty() && p.mobility.free.empty() && p.mobility.massless.empty()) << name;
  }
}

TEST(Mobility, finds_the_one_axis_that_locks_a_four_bar) {
  for (const std::string name : {"A", "B", "C", "D"})
    for (const char* how : {"[0.0871557427476582, 0, 0.9961946980917455]", "[0.02, 0.05, 0.99]"}) {
      const plan::Plan p = plan::make_plan(four_bar(name, how));
      EXPECT_EQ(p.mobility.degrees_of_freedom(), 0);
      ASSERT_EQ(p.mobility.locked.size(), 1u);
      EXPECT_TRUE(says(p.mobility.locked, {"cannot move", "the axis of joint '" + name + "'"})) << p.mobility.locked[0];
      EXPECT_TRUE(says(p.notes, {"cannot move"}));
    }
}

TEST(Mobility, names_body_and_axis_of_a_motion_that_statics_leaves_open) {
  const std::string beam = R"("sections": [{"name": "s", "stiffness": [1e4, 1e4, 1e4, 10, 10, 10]}],
    "nodes": [{"name": "root"}, {"name": "tip", "position": [1, 0, 0]}],
    "beams": [{"name": "boom", "section": "s", "start": "root", "end": "tip", "elements": 4}],
    "loads": [{"name": "push", "at": "tip", "force": [0, 1, 0]}], )" +
                           statics;
  const auto scene = [&beam](const std::string& joints) {
    return support::scene_of("{\"joints\": [" + joints + "], " + beam + "}");
  };
  const scene::Scene pinned = scene(joint("pin", "revolute", "ground", "root", "[0, 0, 0]"));
  EXPECT_TRUE(says(plan::make_plan(pinned).mobility.free,
                   {"'boom'", "turn about the axis (0, 0, 1) through (0, 0, 0)", "joint 'pin'"}));
  const support::Outcome run = support::run(pinned);
  EXPECT_FALSE(run.ok());
  EXPECT_NE(run.summary.cause.find("'pin'"), std::string::npos) << run.summary.cause;

  const plan::Plan spinning =
      plan::make_plan(scene(joint("left", "spherical", "ground", "root", "[0, 0, 0]", "[1, 0, 0]") + ", " +
                            joint("right", "spherical", "ground", "tip", "[1, 0, 0]", "[1, 0, 0]")));
  EXPECT_TRUE(says(spinning.mobility.free, {"'boom'", "turn about the axis (1, 0, 0)"})) << all(spinning.mobility.free);
  EXPECT_EQ(spinning.mobility.free.size(), 1u);

  const plan::Plan clamped = plan::make_plan(scene(joint("wall", "fixed", "ground", "root", "[0, 0, 0]")));
  EXPECT_TRUE(clamped.mobility.free.empty()) << all(clamped.mobility.free);
}

TEST(Mobility, springs_and_bushings_hold_in_statics) {
  const auto scene = [](const char* stiffness) {
    return support::scene_of(
        "{\"bodies\": [" + body("block", "[0, 0, 0]") +
        R"(], "bushings": [{"name": "mount", "first": "ground", "second": "block", "stiffness": )" + stiffness +
        "}], " + statics + "}");
  };
  EXPECT_TRUE(plan::make_plan(scene("[1, 1, 1, 1, 1, 1]")).mobility.free.empty());
  EXPECT_TRUE(
      says(plan::make_plan(scene("[1, 1, 1, 0, 1, 1]")).mobility.free, {"'block'", "turn about the axis (1, 0, 0)"}));
}

TEST(Mobility, tells_of_motions_without_inertia_although_nothing_excites_them) {
  const std::string arm = body("arm", "[0.5, 0, 0]"), pivot = joint("pivot", "revolute", "ground", "arm", "[0, 0, 0]");
  const auto plan_of = [&](const std::string& bodies, const std::string& joints) {
    return plan::make_plan(
        support::scene_of("{\"bodies\": [" + bodies + "], \"joints\": [" + joints + "], " + soon + "}"));
  };
  const std::string shaft = joint("shaft", "revolute", "arm", "rotor", "[1, 0, 0]");
  const plan::Plan rotor = plan_of(arm + ", " + body("rotor", "[1, 0, 0]", "[0.1, 0.1, 0]"), pivot + ", " + shaft);
  EXPECT_TRUE(says(rotor.mobility.massless, {"'rotor'", "turn about the axis (0, 0, 1)", "inertia"}))
      << all(rotor.mobility.massless);
  EXPECT_TRUE(says(rotor.notes, {"'rotor'"}));
  const plan::Plan sound = plan_of(arm + ", " + body("rotor", "[1, 0, 0]", "[0.1, 0.1, 0.1]"), pivot + ", " + shaft);
  EXPECT_TRUE(sound.mobility.massless.empty()) << all(sound.mobility.massless);
  // off its axis the mass resists; held by a weld the arm does
  const std::string off = joint("shaft", "revolute", "arm", "rotor", "[0.8, 0, 0]"),
                    weld = joint("shaft", "fixed", "arm", "rotor", "[1, 0, 0]");
  EXPECT_TRUE(
      plan_of(arm + ", " + body("rotor", "[1, 0, 0]", "[0.1, 0.1, 0]"), pivot + ", " + off).mobility.massless.empty());
  EXPECT_TRUE(
      plan_of(arm + ", " + body("rotor", "[1, 0, 0]", "[0, 0, 0]"), pivot + ", " + weld).mobility.massless.empty());
}

TEST(Joints, gaps_are_measured_by_the_parts_that_meet_and_named) {
  const auto length_of = [](const std::string& more) {
    const plan::Plan p = plan::make_plan(support::scene_of(
        "{\"bodies\": [" + body("arm", "[0.5, 0, 0]", "[0.01, 0.02, 0.03]") + more + "], \"joints\": [" +
        joint("pivot", "revolute", "ground", "arm", "[0, 0, 0]") + "], " + soon + "}"));
    return p.joints[0].length;
  };
  const double near = length_of("");
  EXPECT_GT(near, 0.4);
  EXPECT_LT(near, 0.6);
  EXPECT_EQ(length_of(", " + body("moon", "[10000, 0, 0]")), near);
}

TEST(Joints, rates_are_those_of_the_coordinate_that_is_asked_for) {
  const auto rate = [](const char* coordinate) {
    return support::run(support::scene_of("{\"gravity\": [0, 0, -9.81], \"bodies\": [" + body("block", "[0, 0, 0]") +
                                          "], \"joints\": [" +
                                          joint("rail", "cylindrical", "ground", "block", "[0, 0, 0]") +
                                          R"(], "initial_velocities": [{"of": "block", "angular_velocity": [0, 0, 3]}],
      "sensors": [{"name": "rate", "kind": "joint_rate", "joint": "rail", "coordinate": ")" +
                                          coordinate + R"("}],
      "analysis": {"kind": "dynamic", "end_time": 1, "step_size": 0.01}})"))
        .history.last("rate");
  };
  EXPECT_NEAR(rate("displacement"), -9.81, 1e-9);
  EXPECT_NEAR(rate("angle"), 3.0, 1e-9);
}

TEST(Springs, that_pass_through_length_zero_are_named) {
  const auto run = [](const char* velocity) {
    return support::run(support::scene_of(
        R"({"bodies": [{"name": "dot", "kind": "point_mass", "mass": 1, "position": [0, -0.1, 0]}],
      "springs": [{"name": "rope", "first": "ground", "second": "dot", "stiffness": 1, "rest_length": 0.1}],
      "initial_velocities": [{"of": "dot", "velocity": )" +
        std::string(velocity) + R"(}], "analysis": {"kind": "dynamic", "end_time": 0.5, "step_size": 0.01}})"));
  };
  const auto names_it = [](const support::Outcome& o) {
    return std::any_of(o.summary.doubts.begin(), o.summary.doubts.end(), [](const records::Doubt& d) {
      return d.about == "springs" && d.text.find("'rope'") != std::string::npos;
    });
  };
  EXPECT_TRUE(names_it(run("[0, 2, 0]")));
  EXPECT_FALSE(names_it(run("[0, -2, 0]")));
  EXPECT_FALSE(names_it(run("[2, 0, 0]")));  // round the anchor
}

TEST(DependentRows, are_told_in_groups) {
  std::string bodies = body("crank", "[0, 0.5, 0]"), joints = joint("A", "revolute", "ground", "crank", "[0, 0, 0]");
  std::string left = "crank";
  for (int k = 0; k < 6; ++k) {
    const std::string n = std::to_string(k), x = std::to_string(2 * k), next = std::to_string(2 * k + 2);
    bodies += ", " + body("coupler" + n, "[" + std::to_string(2 * k + 1) + ", 1, 0]") + ", " +
              body("rocker" + n, "[" + next + ", 0.5, 0]");
    joints += ", " + joint("B" + n, "revolute", left, "coupler" + n, "[" + x + ", 1, 0]") + ", " +
              joint("C" + n, "revolute", "coupler" + n, "rocker" + n, "[" + next + ", 1, 0]") + ", " +
              joint("D" + n, "revolute", "ground", "rocker" + n, "[" + next + ", 0, 0]");
    left = "rocker" + n;
  }
  scene::Scene s = support::scene_of("{\"bodies\": [" + bodies + "], \"joints\": [" + joints + "], " + soon + "}");
  s.without = {"planar"};
  const support::Outcome run = support::run(s);
  EXPECT_TRUE(says(run.summary.notes, {"depend on others", "others of their loops"})) << all(run.summary.notes);
  for (const std::string& note : run.summary.notes) EXPECT_LT(note.size(), 300u) << note;
}

}  // namespace
}  // namespace bough
