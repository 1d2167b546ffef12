// Long runs: many four-bars with as many dependent constraints, a cantilever over 30 s.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "bough/scene/parts.hpp"
#include "support/scenes.hpp"

namespace bough::run {
namespace {

using support::Table;

TEST(VerifySlow, forty_windows_of_four_bars_pass_their_flat_positions) {
  const Table exact = support::reference("A02_fourbar_N40.csv");
  double error[2] = {0.0, 0.0}, extrapolated = 0.0;
  Table runs[2];
  for (int k = 0; k < 2; ++k) {
    scene::Scene scene = scene::make_four_bars(40);
    scene.analysis.end_time = 10.0;
    scene.analysis.tolerance = 1e-10;
    scene.analysis.step_size = k == 0 ? 4e-3 : 2e-3;
    const support::Outcome outcome = support::run(scene);
    ASSERT_TRUE(outcome.ok()) << outcome.summary.cause;
    runs[k] = outcome.history;
    std::printf("N = 40: %ld steps in %.1f s, %ld rejected\n", outcome.summary.steps.accepted,
                outcome.summary.times.total, outcome.summary.steps.rejected);
  }
  for (std::size_t r = 1; r < exact.times.size(); ++r) {
    const double t = exact.times[r];
    for (int i = 0; i < 2; ++i) {
      const double value = exact.rows[r][static_cast<std::size_t>(i)];
      const double a = runs[0].at(i == 0 ? "B0.x" : "B0.y", t), b = runs[1].at(i == 0 ? "B0.x" : "B0.y", t);
      error[0] = std::max(error[0], std::abs(a - value));
      error[1] = std::max(error[1], std::abs(b - value));
      extrapolated = std::max(extrapolated, std::abs(support::extrapolate(a, b) - value));
    }
  }
  std::printf("N = 40: errors %.1e %.1e (order %.2f), extrapolated %.1e\n", error[0], error[1],
              support::order_of(error[0], error[1]), extrapolated);
  EXPECT_NEAR(support::order_of(error[0], error[1]), 2.0, 0.2);
  EXPECT_LT(extrapolated, 2e-5);
}

TEST(VerifySlow, right_angle_cantilever_stays_near_the_published_motion_for_16_s_and_keeps_its_energy_for_30_s) {
  scene::Scene scene = support::gallery("right_angle_cantilever", {"/analysis/end_time=30", "/expected=[]"});
  const support::Outcome outcome = support::run(scene);
  ASSERT_TRUE(outcome.ok()) << outcome.summary.cause;
  const Table& run = outcome.history;
  double lowest = 0.0, when = 0.0;
  for (double t : run.times)
    if (t > 14 && t < 18 && run.at("tip.z", t) < lowest) {
      lowest = run.at("tip.z", t);
      when = t;
    }
  std::printf(
      "right-angle cantilever: lowest tip %.3f at %.2f (published -9.760 at 15.87), energy %.4f at 2 s, %.4f at 30 s\n",
      lowest, when, run.at("energy", 2.0), run.last("energy"));
  EXPECT_NEAR(lowest, -9.760, 0.05 * 9.760);  // sensitive by then
  EXPECT_NEAR(when, 15.87, 0.3);
  EXPECT_NEAR(run.last("energy"), run.at("energy", 2.0), 1e-3 * run.at("energy", 2.0));
}

}  // namespace
}  // namespace bough::run
