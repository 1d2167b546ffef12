/// What `bough plan` predicts: the work of a step is counted and timed over trial steps.
#include "bough/run/outlook.hpp"

#include <gtest/gtest.h>

#include "bough/records/no_recorder.hpp"
#include "bough/run/estimate.hpp"
#include "bough/run/simulate.hpp"
#include "step/small_scenes.hpp"
#include "trial_steps.hpp"

namespace bough::run {
namespace {

/// A chain that swings, in steps of 1 ms; without checks, so that all solutions are those of Newton's method.
scene::Scene make_swing(int steps) {
  scene::Scene s = test::make_chain(6);
  s.output.checks = false;
  s.analysis.step_size = 1e-3;
  s.analysis.end_time = 1e-3 * steps;
  return s;
}

/// The later half of 64 steps has the work of a run of 64 steps less that of one of 32.
TEST(TrialSteps, count_the_work_of_the_later_half) {
  const auto steps_of = [](int steps) {
    records::NoRecorder recorder;
    const records::Summary summary = simulate(make_swing(steps), {}, recorder);
    EXPECT_EQ(summary.status, records::RunStatus::ok) << summary.cause;
    return summary.steps;
  };
  const records::StepCounts half = steps_of(32), whole = steps_of(64);
  const auto work = try_steps(make_swing(200), 64);
  ASSERT_TRUE(work);
  EXPECT_EQ(work->trial_steps, 64);
  EXPECT_EQ(32.0 * work->iterations, static_cast<double>(whole.newton_iterations - half.newton_iterations));
  EXPECT_EQ(32.0 * work->factorizations, static_cast<double>(whole.factorizations - half.factorizations));
  EXPECT_GE(work->evaluations, work->iterations);
  EXPECT_GT(work->seconds, 0.0);
}

/// A run that ends before has given as many steps as it had, but for the last, whose work is not seen.
TEST(TrialSteps, are_those_that_a_short_run_has) {
  const auto work = try_steps(make_swing(20), 64);
  ASSERT_TRUE(work);
  EXPECT_EQ(work->trial_steps, 19);
}

/// What a sweep tells in advance: the time of a run by its trial steps, of a small scene, in which what is done once a
/// step prevails over what grows with unknowns. Both are CPU times of one thread; the machine may be busy.
TEST(Outlook, forecasts_the_time_of_a_small_run) {
  scene::Scene s = test::make_chain(1);
  s.analysis.step_size = 1e-3;
  s.analysis.end_time = 8.0;
  records::NoRecorder recorder;
  const double forecast = forecast_seconds(s), taken = simulate(s, {}, recorder).times.cpu;
  EXPECT_LT(forecast, 3.0 * taken);
  EXPECT_GT(forecast, taken / 3.0);
}

TEST(Outlook, has_the_counts_of_trial_steps) {
  const scene::Scene s = make_swing(1000);
  const Outlook outlook = look_ahead(s);
  const auto work = try_steps(s, outlook.effort.trial_steps);
  ASSERT_TRUE(work);
  EXPECT_GT(outlook.effort.trial_steps, 32);
  EXPECT_EQ(outlook.effort.iterations, work->iterations);
  EXPECT_EQ(outlook.effort.factorizations, work->factorizations);
  const double measured = outlook.effort.step_seconds() / outlook.effort.model_seconds;
  EXPECT_NE(measured, 1.0) << "the step is as long as measured, not as modelled";
  for (const OutlookDecision& d : outlook.decisions) {
    if (!d.has_saving) continue;
    if (d.decision.name == "reuse") {
      EXPECT_GT(d.without.factorizations, 1.9) << "each iteration has a factorization of its own";
    } else {
      EXPECT_EQ(d.without.iterations, work->iterations) << d.decision.name;
    }
    if (d.decision.name != "reuse" && d.decision.name != "symmetric") {
      EXPECT_NEAR(d.without.step_seconds() / d.without.model_seconds / measured, 1.0, 1e-12) << d.decision.name;
    }
  }
}

/// Where no step can be taken, the counts are the usual ones, and say so.
TEST(Outlook, has_usual_counts_where_the_run_fails) {
  scene::Scene s = make_swing(1000);
  s.analysis.max_iterations = 1;
  s.analysis.max_cuts = 0;
  s.gravity = 1e6 * s.gravity;
  ASSERT_FALSE(try_steps(s, 8));
  const Outlook outlook = look_ahead(s);
  EXPECT_EQ(outlook.effort.trial_steps, 0);
  EXPECT_GT(outlook.effort.step_seconds(), 0.0);
  EXPECT_EQ(outlook.effort.step_seconds(), outlook.effort.model_seconds);
}

/// A plan is made to learn how a scene moves only where that takes little itself: of a large one with few elements a
/// beam, unless something names the nodes between them.
TEST(Refusal, of_large_scenes_makes_no_large_plan) {
  scene::Scene s = test::make_chain(6);
  const double small = estimate_run(s).memory_bytes;
  EXPECT_EQ(refusal(s, 2.0 * small), "");
  EXPECT_EQ(refusal(s, 0.9 * small), "") << "moves in a plane";
  s.beams[0].elements = 1'000'000;
  const double large = estimate_run(s).memory_bytes;
  EXPECT_EQ(refusal(s, 2.0 * large), "");
  EXPECT_EQ(refusal(s, 0.9 * large), "") << "moves in a plane";
  EXPECT_NE(refusal(s, 0.5 * large).find("a run would take about"), std::string::npos);
  s.point_loads.emplace_back();
  s.point_loads.back().name = "inside";
  s.point_loads.back().at.to = s.beams[0].name + ".500000";
  const std::string why = refusal(s, 0.9 * large);
  EXPECT_NE(why.find("taken, and"), std::string::npos) << why;
}

}  // namespace
}  // namespace bough::run
