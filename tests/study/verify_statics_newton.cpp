/// Newton in statics: the tangent is the exact derivative, so changes shrink quadratically; steps that are too long are cut.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "verify_scenes.hpp"

namespace bough::verify {
namespace {

struct Quadratic {
  int steps = 0;         ///< pairs of changes compared
  double worst = 1e300;  ///< smallest log(d_{k+1}) / log(d_k) seen
};

/// d_{k+1} = C d_k^2: for three changes in the quadratic range log(d2/d1)/log(d1/d0) tends to 2, with C dropping out.
std::vector<double> exponents(const step::StepReport& r) {
  std::vector<double> p;
  const auto d = r.changes();
  for (std::size_t k = 2; k < d.size(); ++k)
    if (d[k - 2] < 0.3 && d[k - 1] < 0.05 * d[k - 2] && d[k] > 1e-12) p.push_back(std::log(d[k] / d[k - 1]) / std::log(d[k - 1] / d[k - 2]));
  return p;
}

void expect_quadratic(const scene::Scene& scene, double from, double to) {
  Direct run(scene);
  run.options.tolerance = 1e-13;
  run.options.max_iterations = 30;
  if (from > 0.0) {
    const step::StepReport first = step::equilibrate(run.system, run.state, run.options, from);
    ASSERT_TRUE(first.converged) << scene.name << ": " << first.cause;
  }
  const step::StepReport r = step::equilibrate(run.system, run.state, run.options, to);
  ASSERT_TRUE(r.converged) << scene.name << ": " << r.cause;
  std::printf("  %s:", scene.name.c_str());
  for (double d : r.changes()) std::printf(" %.1e", d);
  const std::vector<double> p = exponents(r);
  std::printf("  exponents:");
  for (double x : p) std::printf(" %.2f", x);
  std::printf("\n");
  ASSERT_FALSE(p.empty()) << scene.name;
  EXPECT_GT(p.back(), 1.8) << scene.name;
}

TEST(VerifyStatics, newton_converges_quadratically) {
  for (const char* name : {"elastica", "bend_45", "princeton_beam"}) expect_quadratic(gallery(name), 0.2, 0.3);
  expect_quadratic(gallery("helix"), 0.1, 0.2);
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
