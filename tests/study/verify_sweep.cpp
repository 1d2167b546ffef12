// Whole studies of a pendulum with a closed form: orders, references, repeatability, failures.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "bough/io/read_study.hpp"
#include "bough/study/sweep.hpp"
#include "support/scratch_directory.hpp"
#include "support/source_dir.hpp"

namespace bough::study {
namespace {

/// The gallery's pendulum to 0.5 s against the table of its closed form (place), and against itself in much finer
/// steps (force).
io::StudySpec pendulum_study(const std::string& steps = "[0.02, 0.01, 0.005]", const std::string& extra = "") {
  const std::string text = R"({
    "schema_version": 1, "scene": "pendulum.json",
    "set": [{"pointer": "/analysis/end_time", "value": 0.5}, {"pointer": "/analysis/tolerance", "value": 1e-11}],
    "quantities": [
      {"name": "place", "sensor": "bob", "source": "closed form",
       "table": {"file": "../reference/A01_pendulum.csv", "columns": ["x", "y", "zero"]}},
      {"name": "force", "sensor": "hinge force", "components": ["fx", "fy"]}],
    "sample_interval": 0.1, "repetitions": 2)" +
                           extra + R"(,
    "reference": {"set": [{"pointer": "/analysis/step_size", "value": 6.25e-4}],
                  "check": [{"pointer": "/analysis/step_size", "value": 1.25e-3}], "order": 2},
    "grids": [{"name": "steps",
      "axes": [{"name": "integrator", "values": ["generalized_alpha", "variational"]},
               {"name": "step size", "values": )" +
                           steps + R"(}],
      "abscissa": "step size",
      "orders": [{"quantity": "place", "order": 2, "theory": "second order"},
                 {"quantity": "force", "order": 2, "theory": "second order"}]}]})";
  // the table has no column for the third coordinate, which is zero
  static const support::ScratchDirectory scratch;  // runs read it after this returns
  const std::filesystem::path& folder = scratch.path();
  std::filesystem::create_directories(folder / "reference");
  std::filesystem::create_directories(folder / "scenarios");
  const std::filesystem::path data = std::filesystem::path(support::source_dir()) / "data";
  std::filesystem::copy_file(data / "scenarios/pendulum.json", folder / "scenarios/pendulum.json",
                             std::filesystem::copy_options::overwrite_existing);
  std::ifstream in(data / "reference/A01_pendulum.csv");
  std::ofstream out(folder / "reference/A01_pendulum.csv");
  for (std::string line; std::getline(in, line);) {
    if (!line.empty() && line.back() == '\r') line.pop_back();
    out << line << (line[0] == 't' ? ",zero\n" : ",0\n");
  }
  out.close();
  io::StudyFile file = io::read_study_text(text, "pendulum", folder / "scenarios");
  for (const io::Problem& p : file.problems) ADD_FAILURE() << p.text();
  return file.spec;
}

TEST(Sweep, finds_the_orders_of_both_integrators_against_closed_form_and_finer_steps) {
  const SweepResult r = run_sweep(pendulum_study(), {});
  ASSERT_EQ(r.series.size(), 4u);
  EXPECT_EQ(r.num_runs(), 6u);
  EXPECT_EQ(r.references[0].kinds, (std::vector<std::string>{"table", "computed"}));
  EXPECT_EQ(r.references[0].errors_of, (std::vector<std::string>{"all", "time"}));
  EXPECT_EQ(r.references[0].uncertainties[0], 0.0);
  EXPECT_GT(r.references[0].uncertainties[1], 0.0);
  EXPECT_LT(r.references[0].uncertainties[1], 1e-5);
  for (std::size_t s = 0; s < 2; ++s)
    for (const OrderFit& f : r.series[s].fits) {
      EXPECT_EQ(f.verdict, Verdict::holds) << r.series[s].label << ": " << f.order;
      EXPECT_NEAR(f.order, 2.0, 0.1);
    }
  EXPECT_EQ(r.num_failed(), 0u);
  for (const SweepRun& run : r.runs) {
    EXPECT_EQ(run.num_samples, 6u);
    EXPECT_EQ(run.wall.size(), 2u);
    EXPECT_TRUE(run.is_repeatable);
    EXPECT_GT(run.steps.accepted, 0);
    // the closed form and the computed reference of another quantity agree on who is finer
    EXPECT_GT(run.errors[0].max, 0.0);
    EXPECT_LE(run.errors[0].rms, run.errors[0].max);
    EXPECT_LE(run.errors[0].end, run.errors[0].max);
  }
}

// Errors of both integrators have even powers of the step, and generalized-alpha a small third one: two runs tell the
// error of the finer one, and leave one of fourth order.
TEST(Sweep, extrapolates_pairs_of_runs_to_fourth_order_and_tells_their_errors) {
  const SweepResult r = run_sweep(pendulum_study("[0.02, 0.01, 0.005, 0.0025]"), {});
  ASSERT_EQ(r.series.size(), 4u);
  for (std::size_t s = 2; s < 4; ++s) {
    const SweepSeries& pairs = r.series[s];
    ASSERT_EQ(pairs.runs.size(), 3u) << pairs.label;
    EXPECT_NEAR(pairs.fits[0].order, 4.0, 0.3) << pairs.label;
    for (const std::size_t k : pairs.runs) {
      const SweepRun& pair = r.runs[k];
      const SweepRun &fine = r.runs[pair.pair->first], &coarse = r.runs[pair.pair->second];
      EXPECT_DOUBLE_EQ(coarse.abscissa, 2.0 * fine.abscissa);
      EXPECT_NEAR(pair.told_over_true[0], 1.0, 0.02) << pair.label;
      EXPECT_LT(pair.errors[0].max, 0.02 * fine.errors[0].max) << pair.label;
      EXPECT_EQ(pair.steps.accepted, fine.steps.accepted + coarse.steps.accepted);
      EXPECT_DOUBLE_EQ(pair.wall[0], fine.wall[0] + coarse.wall[0]);
    }
  }
}

TEST(Sweep, gives_the_same_errors_bitwise_twice_with_and_without_kept_references_on_one_thread_and_two) {
  const support::ScratchDirectory scratch;
  const std::filesystem::path cache = scratch / "cache";
  const SweepResult first = run_sweep(pendulum_study(), {.threads = 1, .cache = cache});
  const SweepResult second = run_sweep(pendulum_study(), {.threads = 2, .cache = cache});
  EXPECT_FALSE(first.references[0].is_cached);
  EXPECT_TRUE(second.references[0].is_cached);
  ASSERT_EQ(first.runs.size(), second.runs.size());
  for (std::size_t k = 0; k < first.runs.size(); ++k)
    for (std::size_t q = 0; q < 2; ++q) {
      EXPECT_EQ(first.runs[k].errors[q].max, second.runs[k].errors[q].max) << first.runs[k].label;
      EXPECT_EQ(first.runs[k].errors[q].rms, second.runs[k].errors[q].rms);
      EXPECT_EQ(first.runs[k].errors[q].end, second.runs[k].errors[q].end);
    }
  EXPECT_EQ(first.references[0].uncertainties, second.references[0].uncertainties);
}

TEST(Sweep, keeps_runs_that_fail_with_their_cause) {
  // one iteration of Newton does not reach 1e-11, and steps may not be cut
  const io::StudySpec spec = pendulum_study("[0.1, 0.005]", R"(, "comment": "limits follow", "time_limit": 20)");
  io::StudySpec limited = spec;
  limited.overrides.push_back("/analysis/max_iterations=2");
  limited.overrides.push_back("/analysis/max_cuts=0");
  const SweepResult r = run_sweep(limited, {});
  EXPECT_GT(r.num_failed(), 0u);
  for (const SweepRun& run : r.runs) {
    if (run.status == records::RunStatus::ok) continue;
    EXPECT_FALSE(run.cause.empty());
    EXPECT_TRUE(std::isnan(run.errors[0].max));
    EXPECT_TRUE(run.wall.empty()) << "failures are not timed";
  }
  EXPECT_NE(sweep_csv(r).find("failed"), std::string::npos);
  EXPECT_NE(sweep_json(r).find("\"cause\""), std::string::npos);
}

TEST(Sweep, tells_that_a_reference_could_not_be_computed) {
  io::StudySpec spec = pendulum_study("[0.02, 0.01]");
  spec.reference.overrides.push_back("/analysis/max_iterations=1");
  spec.reference.overrides.push_back("/analysis/max_cuts=0");
  const SweepResult r = run_sweep(spec, {.repetitions = 1});
  EXPECT_FALSE(r.references[0].trouble.empty());
  for (const SweepRun& run : r.runs) EXPECT_TRUE(std::isnan(run.errors[1].max));
}

TEST(Sweep, advises_the_quickest_run_that_keeps_an_error) {
  const SweepResult r = run_sweep(pendulum_study(), {});
  for (const SweepAdvice& a : r.advice) {
    double quickest = HUGE_VAL;
    for (const SweepRun& run : r.runs)
      if (r.references[run.grid].errors_of[a.quantity] == a.errors_of && run.errors[a.quantity].max <= a.wanted)
        quickest = std::min(quickest, spread_of(run.wall).median);
    ASSERT_EQ(a.run.has_value(), std::isfinite(quickest)) << a.wanted;
    if (!a.run) continue;
    EXPECT_LE(r.runs[*a.run].errors[a.quantity].max, a.wanted);
    EXPECT_EQ(spread_of(r.runs[*a.run].wall).median, quickest);
  }
}

TEST(Sweep, stops_when_asked_and_says_so) {
  const SweepResult r = run_sweep(pendulum_study(), {.stop = [] { return true; }});
  EXPECT_TRUE(r.was_stopped);
}

}  // namespace
}  // namespace bough::study
