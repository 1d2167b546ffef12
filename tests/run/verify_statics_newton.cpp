/// Newton in statics: the tangent is the exact derivative, so changes shrink quadratically; steps that are too long
/// are cut.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <utility>

#include "verify_scenes.hpp"

namespace bough::verify {
namespace {

/// Changes obey d_{k+1} <= 4 d_k^2 once below 2e-2, down to round-off, whatever the slenderness. A slow linear rate
/// would break the bound at the small end.
void expect_quadratic(const scene::Scene& scene, double from, double to) {
  constexpr double C = 4.0, round_off = 1e-13;
  Direct run(scene);
  run.options.tolerance = 1e-13;
  run.options.max_iterations = 30;
  for (int k = 1; k <= 4; ++k) {
    const step::StepReport first = step::equilibrate(run.system, run.state, run.options, 0.25 * k * from);
    ASSERT_TRUE(first.converged) << scene.name << ": " << first.cause;
  }
  const step::StepReport r = step::equilibrate(run.system, run.state, run.options, to);
  ASSERT_TRUE(r.converged) << scene.name << ": " << r.cause;
  const auto d = r.changes();
  std::printf("  %s:", scene.name.c_str());
  for (double x : d) std::printf(" %.1e", x);
  std::printf("\n");
  int small = 0;
  for (std::size_t k = 0; k + 1 < d.size(); ++k) {
    if (d[k] > 2e-2 || d[k] < 10 * round_off) continue;
    ++small;
    EXPECT_LE(d[k + 1], std::max(C * d[k] * d[k], round_off)) << scene.name << ", iteration " << k + 1;
  }
  EXPECT_GE(small, 2) << scene.name;
  EXPECT_LE(r.iterations, 10) << scene.name;
}

TEST(VerifyStatics, newton_converges_quadratically) {
  for (const char* name : {"bend_45", "princeton_beam"}) expect_quadratic(gallery(name), 0.2, 0.3);
  expect_quadratic(gallery("elastica"), 0.05, 0.1);
  expect_quadratic(gallery("elastica", {"/sections/0/stiffness/EA=1e4"}), 0.05, 0.1);
  // What signals drive: a cord of cubic law, stiffer the higher the tip, and a load that follows its height.
  expect_quadratic(
      gallery("elastica",
              {R"-(/springs=[{"name": "cord", "first": {"to": "ground", "position": [1, -0.5, 0]}, "second": "tip",
                              "rest_length": 0.5,
                              "force_law": {"expression": "(1 + up^2)*(3*stretch + 20*stretch^3)"}}])-",
               R"-(/signals=[{"name": "up", "kind": "position", "at": "tip", "axis": "y"},
                             {"name": "force", "kind": "formula", "expression": "0.2 + 0.1*sin(3*up)"}])-",
               R"-(/loads=[{"at": "tip", "force": [0, 10, 0]},
                           {"at": "tip", "force": [0, 2, 1], "law": {"signal": "force"}}])-"}),
      0.2, 0.3);
  // A follower force makes the tangent unsymmetric; a line load and a bushing add their own parts.
  scene::Scene s = scene::make_cantilever(scene::make_section("s", 1e6, 1e6, 1e6, 10, 10, 10), 1.0, 8, 2);
  s.name = "follower";
  s.point_loads = {scene::make_load("tip", {{0, 40, 5}}, Vec3<double>::zero(), scene::LoadAxes::body)};
  scene::LineLoad line;
  line.name = "line";
  line.beam = "beam";
  line.axes = scene::LoadAxes::body;
  line.force = {{0, 10, 3}};
  s.line_loads = {line};
  expect_quadratic(s, 0.2, 0.4);
}

/// Relative motions take increments exactly, so a constant moment winds a beam up in one correction; the next finds
/// nothing left to do.
TEST(VerifyStatics, a_moment_bends_a_beam_by_two_turns_in_one_correction) {
  for (const char* name : {"helix", "roll_up"}) {
    const Outcome r = run(gallery(name, {"/analysis/load_steps=1"}));
    ASSERT_TRUE(r.ok()) << name << ": " << r.text();
    EXPECT_EQ(r.summary.steps.rejected, 0) << name;
    EXPECT_EQ(r.summary.steps.newton_iterations, 2) << name;
    for (const records::ExpectedResult& e : r.summary.expected) EXPECT_TRUE(e.holds) << name << ", " << e.name;
  }
}

TEST(VerifyStatics, the_gallery_takes_its_load_steps_without_a_rejection) {
  for (const char* name : {"bend_45", "elastica", "helix", "princeton_beam", "roll_up"})
    for (const char* steps : {"", "/analysis/load_steps=1"}) {
      const Outcome r = run(*steps != '\0' ? gallery(name, {steps}) : gallery(name));
      ASSERT_TRUE(r.ok()) << name << ": " << r.text();
      EXPECT_EQ(r.summary.steps.rejected, 0) << name;
      std::printf("  %s: %ld steps, %ld iterations\n", name, r.summary.steps.accepted,
                  r.summary.steps.newton_iterations);
      EXPECT_LE(r.summary.steps.newton_iterations, 4 * r.summary.steps.accepted + 4) << name;
    }
}

/// Four slender beams welded to each other, EA L^2 / EI = 2e7: the loop closes in a beam, where the tree leaves a
/// mismatch. (With nodes that move alone up to 18 of 23 load steps are rejected.)
TEST(VerifyStatics, a_closed_frame_of_slender_beams_takes_long_load_steps) {
  for (const int order : {1, 2, 3})
    for (const double pull : {-3.0, 20.0}) {
      scene::Scene s;
      s.name = "frame";
      s.sections = {scene::make_section("s", 1e7, 1e7, 1e7, 1, 1, 1)};
      s.nodes = {scene::make_node("a", {{0, 0, 0}}), scene::make_node("b", {{1, 1, 0}}),
                 scene::make_node("c", {{0, 2, 0}}), scene::make_node("d", {{-1, 1, 0}})};
      for (std::size_t i = 0; i < 4; ++i)
        s.beams.push_back(
            scene::make_beam("beam " + std::to_string(i), "s", s.nodes[i].name, s.nodes[(i + 1) % 4].name, 6, order));
      s.joints = {scene::make_weld("clamp", "a")};
      s.point_loads = {scene::make_load("c", {{0, pull, 0}})};
      s.sensors = {scene::make_point_sensor("b", scene::SensorKind::position, "b"),
                   scene::make_point_sensor("d", scene::SensorKind::position, "d")};
      s.analysis.kind = scene::AnalysisKind::statics;
      s.analysis.load_steps = 5;
      const Outcome r = run(s);
      ASSERT_TRUE(r.ok()) << r.text();
      EXPECT_LE(r.summary.steps.rejected, 1) << r.text();
      EXPECT_LE(r.summary.steps.newton_iterations, 60);
      EXPECT_NEAR(r.final("b.x"), -r.final("d.x"), 1e-7);  // symmetric
      EXPECT_NEAR(r.final("b.y"), r.final("d.y"), 1e-7);
      EXPECT_GT(pull * (1.0 - r.final("b.x")), 0.3);
    }
}

/// Elastica with a tip force P L^2 / EI = 10, one load step from the straight shape: a correction bends every element
/// without stretching its axis, so no stiffness of the axis is seen, whatever the order of the elements.
TEST(VerifyStatics, iterations_do_not_grow_with_slenderness) {
  for (const auto& [order, elements] : {std::pair{1, 16}, {2, 4}, {2, 16}, {3, 3}, {3, 16}})
    for (const double slenderness : {1e1, 1e2, 1e3, 1e4, 1e5, 1e6}) {
      const double EA = 12.0 * slenderness * slenderness, GA = EA * 5.0 / 6.0 / 2.6;  // a square of steel, EI = 1
      for (const Vec3<double>& force : {Vec3<double>{{0, 10, 0}}, Vec3<double>{{0, 8, 5}}}) {
        scene::Scene s = scene::make_cantilever(scene::make_section("s", EA, GA, GA, 0.65, 1, 1), 1.0, elements, order);
        s.point_loads = {scene::make_load("tip", force)};
        s.analysis.load_steps = 1;
        const Outcome r = run(s);
        ASSERT_TRUE(r.ok()) << r.text();
        EXPECT_EQ(r.summary.steps.rejected, 0) << "order " << order << ", L/h = " << slenderness;
        EXPECT_LT(r.summary.steps.newton_iterations, 12) << "order " << order << ", L/h = " << slenderness;
      }
    }
}

TEST(VerifyStatics, a_load_step_too_long_for_newton_is_cut_and_ends_at_the_same_equilibrium) {
  scene::Scene s = gallery("elastica", {"/analysis/tolerance=1e-10"});
  s.expected.clear();
  const Outcome fine = run(s);
  ASSERT_TRUE(fine.ok()) << fine.text();
  s.analysis.load_steps = 1;
  s.analysis.max_iterations = 6;
  const Outcome coarse = run(s);
  ASSERT_TRUE(coarse.ok()) << coarse.text();
  EXPECT_GT(coarse.summary.steps.rejected, 0);
  EXPECT_EQ(coarse.rows.back().time, 1.0);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(coarse.summary.final_values[i], fine.summary.final_values[i], 1e-9);
  for (std::size_t i = 1; i < coarse.rows.size(); ++i) EXPECT_GT(coarse.rows[i].time, coarse.rows[i - 1].time);
  s.analysis.max_cuts = 0;
  const Outcome uncut = run(s);
  EXPECT_FALSE(uncut.ok());
  EXPECT_TRUE(uncut.says("no equilibrium at load factor 1")) << uncut.text();
}

}  // namespace
}  // namespace bough::verify
