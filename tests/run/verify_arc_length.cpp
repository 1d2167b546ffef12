// Statics past limit points: a truss in closed form, the deep arch against its published limit load and against the
// driven crown.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "stability_scenes.hpp"

namespace bough::verify {
namespace {

/// Two springs of rest length 1 from (-b, 0) and (b, 0) to a block that slides along y, h above the line between
/// them; pushed down by `load`.
///   P(y) = 2 k y (1 / l - 1),  l = sqrt(b^2 + y^2);  limit loads where l^3 = b^2
constexpr double base = 0.9, stiffness = 1000.0;

double truss_load(double y) { return 2.0 * stiffness * y * (1.0 / std::hypot(base, y) - 1.0); }

scene::Scene truss(const std::string& arc_length, double load, double ground_offset = 0.0) {
  const double height = std::sqrt(1.0 - base * base);
  const auto text = [](double x) { return support::text(x); };
  return support::scene_of(
      R"({
    "bodies": [{"name": "block", "mass": 1, "inertia": [1, 1, 1], "position": [)" +
      text(ground_offset) + ", " + text(height) + R"(, 0]}],
    "joints": [{"name": "slide", "kind": "prismatic", "first": "ground", "second": "block", "axis": [0, 1, 0]}],
    "springs": [
      {"name": "left", "first": {"to": "ground", "position": [)" +
      text(ground_offset - base) + R"(, 0, 0]}, "second": "block", "stiffness": 1000, "rest_length": 1},
      {"name": "right", "first": {"to": "ground", "position": [)" +
      text(ground_offset + base) + R"(, 0, 0]}, "second": "block", "stiffness": 1000, "rest_length": 1}],
    "loads": [{"name": "push", "at": "block", "force": [0, )" +
      text(-load) + R"(, 0]}],
    "sensors": [{"name": "block", "kind": "position", "at": "block"}],
    "analysis": {"kind": "static", "tolerance": 1e-11, "arc_length": )" +
      arc_length + "}}");
}

TEST(ArcLength, follows_a_truss_through_both_limit_points_to_the_far_side) {
  const double load = 200.0, critical = std::cbrt(base * base), y_limit = std::sqrt(critical * critical - base * base);
  const support::Outcome run = support::run(truss(R"({"step": 0.05, "after_limit_points": 2})", load));
  ASSERT_TRUE(run.ok()) << run.summary.cause;
  ASSERT_EQ(run.summary.limit_points.size(), 2u);
  const double limit = truss_load(y_limit) / load;
  EXPECT_NEAR(run.summary.limit_points[0].load_factor, limit, 1e-10);
  EXPECT_NEAR(run.summary.limit_points[1].load_factor, -limit, 1e-10);
  EXPECT_TRUE(run.summary.limit_points[0].is_maximum);
  EXPECT_FALSE(run.summary.limit_points[1].is_maximum);
  // Every row is an equilibrium, and the path goes one way.
  double before = 1.0;
  for (std::size_t r = 0; r < run.history.times.size(); ++r) {
    const double y = run.history.rows[r][run.history.column("block.y")];
    EXPECT_NEAR(run.history.times[r], truss_load(y) / load, 1e-9) << r;
    EXPECT_LT(y, before);
    before = y;
  }
  EXPECT_EQ(run.history.times.back(), 1.0);
  EXPECT_LT(run.history.last("block.y"), -0.4);
  std::printf("| truss | limit load factors off by %.1e, %.1e | %ld steps, %ld rejected, %ld iterations |\n",
              run.summary.limit_points[0].load_factor - limit, run.summary.limit_points[1].load_factor + limit,
              run.summary.steps.accepted, run.summary.steps.rejected, run.summary.steps.newton_iterations);
}

// The same truss, whose load grows with what a state of a signal sits at, x' = 0, and whose springs are struts with a
// factor that a formula of the height gives:  2 c(y) k y (1 / l - 1) = load f,  c = 1 + a y.
TEST(ArcLength, follows_signals_and_states_past_limit_points) {
  const double load = 200.0, a = 0.2, height = std::sqrt(1.0 - base * base);
  scene::Scene scene = support::scene_of(
      R"({"bodies": [{"name": "block", "mass": 1, "inertia": [1, 1, 1], "position": [0, )" + support::text(height) +
      R"(, 0]}],
    "joints": [{"name": "slide", "kind": "prismatic", "first": "ground", "second": "block", "axis": [0, 1, 0]}],
    "springs": [
      {"name": "left", "first": {"to": "ground", "position": [-0.9, 0, 0]}, "second": "block", "stiffness": 1000,
       "rest_length": 1, "stiffness_factor": {"signal": "c"}},
      {"name": "right", "first": {"to": "ground", "position": [0.9, 0, 0]}, "second": "block", "stiffness": 1000,
       "rest_length": 1, "stiffness_factor": {"signal": "c"}}],
    "signals": [{"name": "y", "kind": "position", "at": "block", "axis": "y"},
      {"name": "c", "kind": "formula", "expression": "1 + 0.2*y"},
      {"name": "factor", "kind": "time", "law": {"expression": "t"}},
      {"name": "x", "kind": "state", "expression": "(factor - x)/0.3"}],
    "loads": [{"name": "push", "at": "block", "force": [0, -200, 0], "law": {"signal": "x"}}],
    "sensors": [{"name": "block", "kind": "position", "at": "block"}, {"name": "x", "kind": "signal", "signal": "x"}],
    "analysis": {"kind": "static", "tolerance": 1e-11, "arc_length": {"step": 0.05, "after_limit_points": 2}}})");
  const support::Outcome run = support::run(scene);
  ASSERT_TRUE(run.ok()) << run.summary.cause;
  ASSERT_EQ(run.summary.limit_points.size(), 2u);
  const auto factor_at = [&](double y) { return (1.0 + a * y) * truss_load(y) / load; };
  double before = 1.0;
  for (std::size_t r = 0; r < run.history.times.size(); ++r) {
    const double y = run.history.rows[r][run.history.column("block.y")];
    EXPECT_NEAR(run.history.times[r], factor_at(y), 1e-9) << r;
    EXPECT_NEAR(run.history.rows[r][run.history.column("x")], run.history.times[r], 1e-12) << r;
    EXPECT_LT(y, before);
    before = y;
  }
  // Limit loads: the largest and the least value of that function between the two shapes without forces.
  double most = -1e9, least = 1e9;
  for (int k = 0; k <= 200000; ++k) {
    const double f = factor_at(height * (1.0 - 2.0 * k / 200000.0));
    most = std::max(most, f);
    least = std::min(least, f);
  }
  EXPECT_NEAR(run.summary.limit_points[0].load_factor, most, 1e-8);
  EXPECT_NEAR(run.summary.limit_points[1].load_factor, least, 1e-8);
}

/// The truss with a block that may leave sideways, 2 b wide, followed past two limit points in steps of one length.
support::Outcome follow_steep_truss(double b, double right_stiffness, double step) {
  const auto spring = [](const char* name, double x, double k) {
    return std::string(R"({"name": ")") + name + R"(", "first": {"to": "ground", "position": [)" + support::text(x) +
           R"(, 0, 0]}, "second": "block", "rest_length": 1, "stiffness": )" + support::text(k) + "}";
  };
  const std::string length = support::text(step);
  return support::run(support::scene_of(R"({
    "bodies": [{"name": "block", "kind": "point_mass", "mass": 1, "position": [0, )" +
                                        support::text(std::sqrt(1.0 - b * b)) + R"(, 0]}],
    "motions": [{"at": "block", "z": 0}],
    "springs": [)" + spring("left", -b, stiffness) +
                                        ", " + spring("right", b, right_stiffness) + R"(],
    "loads": [{"name": "push", "at": "block", "force": [0, -1000, 0]}],
    "sensors": [{"name": "block", "kind": "position", "at": "block"}],
    "analysis": {"kind": "static", "unstable": true, "tolerance": 1e-11,
      "arc_length": {"step": )" + length +
                                        R"(, "largest_step": )" + length +
                                        R"(, "after_limit_points": 2, "end_load_factor": 0.2}}})"));
}

// It loses stability where l^2 - l^3 = b^2, before its limit point at l^3 = b^2. A step that holds both is repeated with
// a shorter length, so that the bifurcation is told.
TEST(ArcLength, a_bifurcation_and_a_limit_point_within_one_step_are_told_apart) {
  const double b = 0.3, load = 1000.0;
  double l = 0.9;  // the larger root
  for (int k = 0; k < 50; ++k) l -= (l * l - l * l * l - b * b) / (2.0 * l - 3.0 * l * l);
  const auto load_at = [&](double length) {
    return 2.0 * stiffness * std::sqrt(length * length - b * b) * (1.0 / length - 1.0) / load;
  };
  const support::Outcome run = follow_steep_truss(b, stiffness, 0.6);
  ASSERT_TRUE(run.ok()) << run.summary.cause;
  EXPECT_GE(run.summary.steps.rejected, 1);
  ASSERT_EQ(run.summary.limit_points.size(), 2u);
  EXPECT_NEAR(run.summary.limit_points[0].load_factor, load_at(std::cbrt(b * b)), 1e-9);
  ASSERT_GE(run.summary.bifurcations.size(), 1u);
  EXPECT_TRUE(run.summary.bifurcations[0].is_lost);
  EXPECT_NEAR(run.summary.bifurcations[0].load_factor, load_at(l), 1e-6);
  EXPECT_NE(run.summary.bifurcations[0].mode.find("along (1, 0, 0)"), std::string::npos);
}

// With a softer spring on one side the block leans over and reaches a limit point instead, and no branches cross. Steps
// beyond that point end on another branch, which is seen and told by none as a bifurcation, whatever their length.
TEST(ArcLength, steps_that_end_on_another_branch_are_repeated) {
  const struct {
    double b, right_stiffness;
    std::vector<double> steps;
  } trusses[] = {{0.2, 900.0, {0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.8}}, {0.33, 600.0, {1.0}}};
  for (const auto& truss : trusses) {
    const support::Outcome fine = follow_steep_truss(truss.b, truss.right_stiffness, 0.01);
    ASSERT_TRUE(fine.ok()) << fine.summary.cause;
    ASSERT_FALSE(fine.summary.limit_points.empty());
    EXPECT_EQ(fine.summary.steps.rejected, 0);
    EXPECT_TRUE(fine.summary.bifurcations.empty());
    for (const double step : truss.steps) {
      const support::Outcome run = follow_steep_truss(truss.b, truss.right_stiffness, step);
      ASSERT_TRUE(run.ok()) << run.summary.cause;
      EXPECT_GE(run.summary.steps.rejected, 1) << step;
      EXPECT_TRUE(run.summary.bifurcations.empty()) << step;
      ASSERT_FALSE(run.summary.limit_points.empty()) << step;
      EXPECT_NEAR(run.summary.limit_points[0].load_factor, fine.summary.limit_points[0].load_factor, 1e-8) << step;
    }
  }
}

TEST(ArcLength, ends_at_the_first_passing_of_its_load_or_at_a_limit_point) {
  const double load = 200.0, y_limit = std::sqrt(std::pow(base * base, 2.0 / 3.0) - base * base);
  const double limit = truss_load(y_limit) / load;
  const auto end_of = [&](const std::string& more) {
    const support::Outcome run = support::run(truss(R"({"step": 0.03, )" + more + "}", load));
    EXPECT_TRUE(run.ok()) << run.summary.cause;
    return std::pair<double, double>{run.history.times.back(), run.history.last("block.y")};
  };
  const auto below = end_of("\"end_load_factor\": " + support::text(0.5 * limit));
  EXPECT_EQ(below.first, 0.5 * limit);
  EXPECT_GT(below.second, y_limit);
  const auto behind = end_of("\"end_load_factor\": 0, \"after_limit_points\": 1");
  EXPECT_NEAR(behind.first, 0.0, 0.0);
  EXPECT_NEAR(behind.second, 0.0, 1e-9) << "the flat shape is an equilibrium";
  const auto at = end_of("\"end_at_limit_point\": 1");
  EXPECT_NEAR(at.first, limit, 1e-10);
  EXPECT_NEAR(at.second, y_limit, 1e-6);
}

TEST(ArcLength, a_path_that_does_not_come_to_its_end_says_so) {
  scene::Scene stuck = truss(R"({"max_steps": 5, "step": 0.01, "largest_step": 0.01})", 200.0);
  const support::Outcome run = support::run(stuck);
  EXPECT_FALSE(run.ok());
  EXPECT_NE(run.summary.cause.find("did not come to its end in 5 steps"), std::string::npos) << run.summary.cause;
}

TEST(ArcLength, deep_arch_meets_its_limit_load_and_goes_on) {
  const support::Outcome run = support::run(support::gallery("deep_arch"));
  ASSERT_TRUE(run.ok()) << run.summary.cause;
  ASSERT_GE(run.summary.limit_points.size(), 1u);
  std::printf("| deep arch | limit load %.6f | %ld steps, %ld rejected, %ld iterations, %.1f s |\n",
              1000.0 * run.summary.limit_points[0].load_factor, run.summary.steps.accepted, run.summary.steps.rejected,
              run.summary.steps.newton_iterations, run.summary.times.total);
  EXPECT_NEAR(1000.0 * run.summary.limit_points[0].load_factor, 897.28913, 1e-6 * 897.3 + 5e-6);
  for (const records::ExpectedResult& e : run.summary.expected) EXPECT_TRUE(e.holds) << e.name << " " << e.value;
  EXPECT_LT(run.history.last("crown.y"), -13.8) << "past the limit the crown goes on down";
  EXPECT_NEAR(run.history.last("load.fy"), 0.0, 1e-6);
}

// A step had been accepted and a point within it was not met by Newton: the run ended there, with nothing to show for
// it. Slender arches have no factor next to their limit point, and round-off of their axial forces above the tolerance,
// which made steps shorter and shorter: 132 at EA = 1e12.
TEST(ArcLength, a_slender_arch_meets_its_limit_point_in_as_many_steps_as_a_stout_one) {
  for (const double EA : {1e10, 1e11, 1e12, 3e12}) {
    const std::string text = support::text(EA);
    const support::Outcome run = support::run(
        support::gallery("deep_arch", {"/sections/0/stiffness/EA=" + text, "/sections/0/stiffness/GA2=" + text,
                                       "/sections/0/stiffness/GA3=" + text}));
    ASSERT_TRUE(run.ok()) << EA << ": " << run.summary.cause;
    ASSERT_GE(run.summary.limit_points.size(), 1u);
    EXPECT_TRUE(run.summary.limit_points[0].is_located) << EA;
    // Of the arch without extension, from EA = 1e9 and 1e10, less what extension takes in proportion to 1 / EA.
    EXPECT_NEAR(1000.0 * run.summary.limit_points[0].load_factor, 897.30908 - 1.987e6 / EA, 2e-5) << EA;
    EXPECT_NEAR(run.history.last("load.fy"), 0.0, 1.0) << EA;
    EXPECT_LE(run.summary.steps.accepted + run.summary.steps.rejected, 16) << EA;
    std::printf("| deep arch, EA = %.0e | limit load %.6f | %ld steps, %ld rejected, %ld iterations, %.1f s |\n", EA,
                1000.0 * run.summary.limit_points[0].load_factor, run.summary.steps.accepted,
                run.summary.steps.rejected, run.summary.steps.newton_iterations, run.summary.times.total);
  }
}

/// Lee's frame of two legs of length 120 on hinges, EI = 1440e4, loaded at a fifth of its beam.
scene::Scene lee_frame(double slenderness, int order) {
  const double EI = 1.44e7, EA = 12.0 * EI * slenderness * slenderness / (120.0 * 120.0), GA = EA / 3.12;
  const auto text = [](double x) { return support::text(x); };
  const std::string mesh = R"("order": )" + std::to_string(order) + R"(, "elements": )";
  return support::scene_of(
      R"({
    "sections": [{"name": "s", "stiffness": {"EA": )" +
      text(EA) + R"(, "GA2": )" + text(GA) + R"(, "GA3": )" + text(GA) +
      R"(, "GJ": 1.44e7, "EI2": 1.44e7, "EI3": 1.44e7}}],
    "nodes": [{"name": "foot"}, {"name": "corner", "position": [0, 120, 0]},
              {"name": "loaded", "position": [24, 120, 0]},
              {"name": "end", "position": [120, 120, 0]}],
    "beams": [{"name": "column", "section": "s", "start": "foot", "end": "corner", "axis_2": [-1, 0, 0], )" +
      mesh + R"(10},
              {"name": "arm", "section": "s", "start": "corner", "end": "loaded", )" +
      mesh + R"(2}, {"name": "rest", "section": "s", "start": "loaded", "end": "end", )" + mesh + R"(8}],
    "joints": [{"name": "foot hinge", "kind": "revolute", "first": "ground", "second": "foot", "axis": [0, 0, 1]},
               {"name": "end hinge", "kind": "revolute", "first": "ground", "second": "end", "axis": [0, 0, 1]}],
    "loads": [{"name": "push", "at": "loaded", "force": [0, -20000, 0]}],
    "sensors": [{"name": "loaded", "kind": "position", "at": "loaded"}],
    "analysis": {"kind": "static", "arc_length": {"end_load_factor": 0, "after_limit_points": 1}}})");
}

class SlenderFrame : public testing::TestWithParam<double> {};

TEST_P(SlenderFrame, meets_its_limit_point_in_few_steps) {
  double limit[4] = {};
  for (const int order : {1, 2, 3}) {
    const support::Outcome run = support::run(lee_frame(GetParam(), order));
    ASSERT_TRUE(run.ok()) << "order " << order << ": " << run.summary.cause;
    ASSERT_GE(run.summary.limit_points.size(), 1u);
    EXPECT_TRUE(run.summary.limit_points[0].is_located) << "order " << order;
    EXPECT_LE(run.summary.steps.accepted + run.summary.steps.rejected, 18) << "order " << order;
    limit[order] = 20000.0 * run.summary.limit_points[0].load_factor;
    std::printf("| Lee's frame, order %d | limit load %.3f | %ld steps, %ld rejected, %ld iterations, %.1f s |\n",
                order, limit[order], run.summary.steps.accepted, run.summary.steps.rejected,
                run.summary.steps.newton_iterations, run.summary.times.total);
  }
  EXPECT_NEAR(limit[2], limit[3], 1e-3 * limit[3]);
  EXPECT_NEAR(limit[1], limit[3], 2e-2 * limit[3]);
  EXPECT_NEAR(limit[3], 18532.0, 40.0) << "1.8532 of the published 1e4 for slender frames";
  EXPECT_NEAR(limit[3], 18558.746, 5e-3) << "of slenderness 1e4, whose extension counts by 1e-8";
}

INSTANTIATE_TEST_SUITE_P(ArcLength, SlenderFrame, testing::Values(1e4, 1e5));

// Round-off of 1e12 times the bending stiffness hides where the path turns.
TEST(ArcLength, a_limit_point_that_is_lost_in_round_off_is_told_so) {
  const support::Outcome run = support::run(lee_frame(1e6, 2));
  ASSERT_TRUE(run.ok()) << run.summary.cause;
  ASSERT_GE(run.summary.limit_points.size(), 1u);
  const records::LimitPoint& limit = run.summary.limit_points[0];
  EXPECT_NEAR(20000.0 * limit.load_factor, 18558.8, limit.is_located ? 0.02 : 2.0);
}

// The load rises along the path where it starts; the sphere of the first step meets the branch of the opposite load as
// well.
TEST(ArcLength, a_frame_that_buckles_aside_is_followed_from_its_start) {
  const support::Outcome run = support::run(right_angle_frame(2.0, 1e-3, R"("arc_length": {"end_load_factor": 0.8})"));
  ASSERT_TRUE(run.ok()) << run.summary.cause;
  double before = 0.0;
  for (const double factor : run.history.times) {
    EXPECT_GE(factor, before);
    before = factor;
  }
  EXPECT_TRUE(run.summary.limit_points.empty());
  EXPECT_TRUE(run.summary.bifurcations.empty());
  EXPECT_EQ(run.summary.stability->unstable_directions, 0);
}

TEST(ArcLength, bifurcations_of_a_straight_column_are_located_and_told) {
  // In units of EI / L^2: P (1 + P (1 / GA - 1 / EA)) = n^2 pi^2
  const support::Outcome run = support::run(hinged_column(60.0, R"("tolerance": 1e-11, "arc_length": {})"));
  ASSERT_TRUE(run.ok()) << run.summary.cause;
  ASSERT_EQ(run.summary.bifurcations.size(), 2u);
  const double flexible = (3.12 - 1.0) / 4800.0;
  for (int n : {1, 2}) {
    const double right = n * n * 9.869604401089358;
    const double exact = 2.0 * right / (1.0 + std::sqrt(1.0 + 4.0 * flexible * right));
    EXPECT_NEAR(60.0 * run.summary.bifurcations[static_cast<std::size_t>(n - 1)].load_factor, exact, 3e-4 * exact);
  }
  EXPECT_NE(run.summary.bifurcations[0].mode.find("'column.8' moves most, along (0, 1, 0)"), std::string::npos)
      << run.summary.bifurcations[0].mode;
  EXPECT_EQ(run.summary.stability->unstable_directions, 2);
}

TEST(ArcLength, every_point_of_the_arch_is_an_equilibrium_by_load_steps) {
  // The last point before the limit, found again by load steps from rest.
  const support::Outcome path = support::run(support::gallery(
      "deep_arch", {"/analysis/arc_length/end_load_factor=0.8", "/analysis/arc_length/after_limit_points=0"}));
  ASSERT_TRUE(path.ok()) << path.summary.cause;
  scene::Scene scene = support::gallery("deep_arch");
  scene.analysis.arc_length.reset();
  scene.analysis.load_steps = 8;
  scene.point_loads[0].force = 0.8 * scene.point_loads[0].force;
  const support::Outcome steps = support::run(scene);
  ASSERT_TRUE(steps.ok()) << steps.summary.cause;
  for (const char* column : {"crown.x", "crown.y", "clamp.fx", "clamp.mz"})
    EXPECT_NEAR(path.history.last(column), steps.history.last(column), 1e-6 * steps.history.largest(column)) << column;
}

}  // namespace
}  // namespace bough::verify
