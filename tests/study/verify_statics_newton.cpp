/// Newton in statics: the tangent is the exact derivative, so changes shrink quadratically; steps that are too long are cut.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "verify_scenes.hpp"

namespace bough::verify {
namespace {

/// Changes obey d_{k+1} <= C d_k^2 once below 1e-2, down to round-off. C is of the order of the slenderness: bending moves nodes along their
/// tangents first, and the length this adds answers with EA. A slow linear rate would break the bound at the small end.
void expect_quadratic(const scene::Scene& scene, double from, double to) {
  constexpr double C = 1e3, round_off = 1e-13;
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
    if (d[k] > 1e-2 || d[k] < 10 * round_off) continue;
    small += d[k] < 1e-4 ? 1 : 0;
    EXPECT_LE(d[k + 1], std::max(C * d[k] * d[k], round_off)) << scene.name << ", iteration " << k + 1;
  }
  EXPECT_GE(small, 1) << scene.name;
  EXPECT_LE(r.iterations, 10) << scene.name;
}

TEST(VerifyStatics, newton_converges_quadratically) {
  for (const char* name : {"bend_45", "princeton_beam"}) expect_quadratic(gallery(name), 0.2, 0.3);
  for (const char* name : {"helix", "roll_up"}) expect_quadratic(gallery(name), 0.2, 0.25);
  expect_quadratic(gallery("elastica", {"/sections/0/stiffness/EA=1e4", "/sections/0/stiffness/GA2=1e4",
                                        "/sections/0/stiffness/GA3=1e4"}),
                   0.05, 0.1);
  // A follower force makes the tangent unsymmetric; a line load and a bushing add their own parts.
  scene::Scene s = make_cantilever(make_section("s", 1e6, 1e6, 1e6, 10, 10, 10), 1.0, 8, 2);
  s.name = "follower";
  s.point_loads = {make_load("tip", {{0, 40, 5}}, Vec3<double>::zero(), scene::LoadAxes::body)};
  scene::LineLoad line;
  line.name = "line";
  line.beam = "beam";
  line.axes = scene::LoadAxes::body;
  line.force = {{0, 10, 3}};
  s.line_loads = {line};
  expect_quadratic(s, 0.2, 0.4);
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
