// The cost of a check is in proportion to the scene, whatever is in it.
#include "support/growth.hpp"

#include <gtest/gtest.h>

#include "bough/laws/make_law.hpp"
#include "bough/scene/poses.hpp"
#include "bough/scene/problems.hpp"

namespace bough::scene {
namespace {

std::string name(const char* stem, int i) { return stem + std::to_string(i); }

Section bar(const std::string& section) {
  Section s;
  s.name = section;
  s.stiffness = s.mass = s.damping = Mat6::zero();
  for (int i = 0; i < 6; ++i) s.stiffness(i, i) = s.mass(i, i) = 1.0;
  return s;
}

/// n beams in a row, each with a section of its own.
Scene row_of_beams(int n) {
  Scene s;
  for (int i = 0; i <= n; ++i) s.nodes.push_back({name("n", i), {{Mat3::identity(), {{1.0 * i, 0, 0}}}, ""}});
  for (int i = 0; i < n; ++i) {
    s.sections.push_back(bar(name("s", i)));
    Beam b;
    b.name = name("b", i);
    b.section = name("s", i);
    b.start = name("n", i);
    b.end = name("n", i + 1);
    s.beams.push_back(b);
  }
  s.analysis.end_time = 1.0;
  return s;
}

void expect_linear(const std::function<Scene(int)>& make, int size) {
  const auto prepare = [&](int n) -> std::function<void()> {
    const Scene s = make(n);
    return [s] { (void)problems_in(s); };
  };
  EXPECT_LT(test::growth_by_sixteen(prepare, size / 4), test::linear_by_sixteen);
}

TEST(ProblemsGrowth, of_sections_sensors_and_figures) {
  expect_linear(
      [](int n) {
        Scene s = row_of_beams(n);
        for (int i = 0; i < n; ++i) {
          Sensor sensor;
          sensor.name = name("f", i);
          sensor.kind = SensorKind::section_force;
          sensor.beam = name("b", i);
          s.sensors.push_back(sensor);
          Expected figure;
          figure.quantity = name("f", i) + ".N";
          figure.tolerance = 1.0;
          s.expected.push_back(figure);
        }
        return s;
      },
      2000);
}

Scene nested(int n) {
  Scene s = row_of_beams(1);
  for (int i = 0; i < n; ++i) {
    FrameDef f;
    f.name = name("f", i);
    f.placement = {{Mat3::identity(), {{0.001, 0, 0}}}, i == 0 ? "" : name("f", i - 1)};
    s.frames.push_back(f);
  }
  return s;
}

Signal reading(SignalKind kind, const std::string& signal) {
  Signal s;
  s.name = signal;
  s.kind = kind;
  return s;
}

Signal formula_of(const std::string& signal, const std::vector<std::string>& inputs) {
  Signal s = reading(SignalKind::formula, signal);
  s.inputs = inputs;
  std::string sum = "1";
  for (const std::string& input : inputs) sum += " + " + input;
  s.formula = laws::Formula(sum, inputs);
  return s;
}

/// n bodies on hinges of their own.
Scene hinges(int n) {
  Scene s;
  for (int i = 0; i < n; ++i) {
    Body body;
    body.name = name("body", i);
    body.mass = 1.0;
    body.inertia = Mat3::identity();
    body.placement.pose.x = {{1.0 * i, 0, 0}};
    s.bodies.push_back(body);
    Joint joint;
    joint.name = name("hinge", i);
    joint.kind = JointKind::revolute;
    joint.first.offset.x = body.placement.pose.x;
    joint.second.to = body.name;
    s.joints.push_back(joint);
  }
  s.analysis.end_time = 1.0;
  return s;
}

/// Each joint has an effort that a signal drives, and signals that read its rate and its effort.
TEST(ProblemsGrowth, of_signals_that_read_joints) {
  expect_linear(
      [](int n) {
        Scene s = hinges(n);
        for (int i = 0; i < n; ++i) {
          Signal rate = reading(SignalKind::joint_rate, name("rate", i)),
                 effort = reading(SignalKind::joint_effort, name("effort", i));
          rate.joint = effort.joint = name("hinge", i);
          s.signals.insert(s.signals.end(), {rate, formula_of(name("torque", i), {rate.name}), effort});
          s.joints[static_cast<std::size_t>(i)].forces.push_back({"angle", 0, 0, 0, {}, name("torque", i)});
        }
        return s;
      },
      6000);
}

/// A chain of signals each of which follows from the one after it, the last from a rate.
TEST(ProblemsGrowth, of_signals_that_follow_from_each_other) {
  expect_linear(
      [](int n) {
        Scene s = hinges(1);
        for (int i = 0; i < n; ++i) s.signals.push_back(formula_of(name("link", i), {name("link", i + 1)}));
        s.signals.push_back(reading(SignalKind::joint_rate, name("link", n)));
        s.signals.back().joint = "hinge0";
        return s;
      },
      8000);
}

/// The chain follows from a circle of two at its end, and another one leads to it. Only the circle is named.
TEST(ProblemsGrowth, of_signals_in_a_circle) {
  const auto make = [](int n) {
    Scene s = hinges(1);
    for (int i = 0; i < n; ++i) s.signals.push_back(formula_of(name("link", i), {name("link", i + 1)}));
    s.signals.push_back(formula_of(name("link", n), {"other"}));
    s.signals.push_back(formula_of("other", {name("link", n), "way0"}));
    for (int i = 0; i < n; ++i)
      s.signals.push_back(
          formula_of(name("way", i), i + 1 < n ? std::vector{name("way", i + 1)} : std::vector<std::string>{}));
    return s;
  };
  expect_linear(make, 8000);
  std::string told;
  for (const SceneProblem& p : problems_in(make(10)))
    if (p.rule.find("in a circle") != std::string::npos) told += p.value;
  EXPECT_EQ(told, "link10, other");
}

TEST(ProblemsGrowth, of_frames_in_frames) { expect_linear(nested, 2000); }

TEST(ProblemsGrowth, of_nodes_in_deep_frames) {
  expect_linear(
      [](int n) {
        Scene s = nested(n);
        for (int i = 0; i < n; ++i) s.nodes.push_back({name("m", i), {Frame::identity(), name("f", n - 1 - i)}});
        return s;
      },
      2000);
}

/// Names that nobody has: all names are compared with each, until that has cost enough.
TEST(ProblemsGrowth, of_names_that_are_not_there) {
  expect_linear(
      [](int n) {
        Scene s = row_of_beams(n);
        for (Beam& b : s.beams) b.end += "_with_a_long_and_wrong_ending";
        return s;
      },
      3000);
}

TEST(ProblemsGrowth, of_chains_of_a_split) {
  expect_linear(
      [](int n) {
        Scene s = nested(n);
        Sensor sensor;
        sensor.name = "split";
        sensor.kind = SensorKind::acceleration_split;
        sensor.at.to = "n0";
        for (int i = 0; i < n; ++i) sensor.chain.push_back(name("f", i));
        s.sensors.push_back(sensor);
        return s;
      },
      2000);
}

/// Thousands of things with the same fault are counted, not kept.
TEST(Problems, beyond_some_hundreds_are_counted) {
  Scene s = row_of_beams(5000);
  for (Beam& b : s.beams) b.end = b.start;
  std::size_t kept = 0, more = 0;
  for (const SceneProblem& p : problems_in(s))
    if (!p.is_warning) {
      ++kept;
      more += p.more;
    }
  EXPECT_LT(kept, 1000u);
  EXPECT_GE(kept + more, 5000u);
}

/// The names of poses in deep frames are what they were when each way up was gone anew.
TEST(FrameTree, poses_add_up_along_the_way) {
  const Scene s = nested(1000);
  const Poses poses(s);
  EXPECT_NEAR(poses.of(std::string_view("f999"))->x[0], 1.0, 1e-12);
  EXPECT_FALSE(poses.frames().stands_in_itself(999));
  Scene circle = s;
  circle.frames[0].placement.frame = "f10";
  const Poses in_circle(circle);
  for (const int i : {0, 10, 500}) {
    EXPECT_TRUE(in_circle.frames().stands_in_itself(static_cast<std::size_t>(i)));
    EXPECT_FALSE(in_circle.of(std::string_view(name("f", i))).has_value());
  }
}

Scene driven_by(const laws::Law& law) {
  Scene s = row_of_beams(1);
  s.nodes.push_back({"moved", {{Mat3::identity(), {{0, 5, 0}}}, ""}});
  PointLoad l;
  l.name = "push";
  l.at.to = "n1";
  l.force = {{0, 1, 0}};
  l.law = law;
  s.point_loads.push_back(l);
  s.analysis.step_size = 1e-3;
  return s;
}

std::string problem_with_law(const laws::Law& law) {
  for (const SceneProblem& p : problems_in(driven_by(law)))
    if (p.section == "point_loads" && !p.is_warning) return p.key + ": " + p.rule + "; " + p.hint;
  return "";
}

TEST(Problems, a_law_with_thousands_of_breakpoints_a_step_is_named) {
  const std::string told = problem_with_law(laws::make_expression("step(sin(1e9*t))"));
  EXPECT_NE(told.find("law: this law changes branch more than 1000 times a step of 0.001 s"), std::string::npos)
      << told;
  EXPECT_NE(told.find("take steps that resolve the law"), std::string::npos) << told;
  EXPECT_EQ(problem_with_law(laws::make_expression("abs(sin(1e4*t))")), "");  // three a step
  EXPECT_EQ(problem_with_law(laws::make_expression("abs(sin(t) + 1 - 1 - sin(t))")), "");
}

/// What sums up a law by quadrature is checked by the law: its values take all of the way to them, here minutes, beyond
/// what a test is given.
TEST(Problems, the_rate_of_a_frame_is_checked_without_summing_it_up) {
  Scene s = row_of_beams(1);
  FrameDef f;
  f.name = "table";
  f.motion.emplace();
  f.motion->name = "table";
  f.motion->turns.push_back({{{0, 0, 1}}, laws::make_expression("abs(sin(1e7*t))").integral(0.0)});
  s.frames.push_back(f);
  s.analysis.end_time = 1000.0;
  s.analysis.step_size = 1e-3;
  std::string told;
  for (const SceneProblem& p : problems_in(s))
    if (p.section == "frames") told = p.rule;
  EXPECT_NE(told.find("changes branch more than"), std::string::npos) << told;
}

}  // namespace
}  // namespace bough::scene
