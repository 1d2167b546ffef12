// Whole sweeps, from the file to the indices, against closed forms.
#include <gtest/gtest.h>

#include <cmath>

#include "bough/io/read_sweep.hpp"
#include "bough/run/memory_run.hpp"
#include "bough/study/cases.hpp"
#include "support/source_dir.hpp"

namespace bough::study {
namespace {

/// F L^3 / (3 E I) with lognormal inputs: S_i = (exp(a_i^2 s_i^2) - 1) / (exp(sum a_j^2 s_j^2) - 1).
TEST(VerifyCases, indices_of_a_cantilever_are_those_of_its_formula) {
  const io::SweepFile file = io::read_sweep(support::source_dir() / "data" / "sweeps" / "cantilever_indices.json");
  for (const io::Problem& p : file.problems) FAIL() << p.text();
  std::vector<CaseResult> results;
  const SweepCases cases = make_cases(file.spec);
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const SweepCase c = cases.at(i);
    const io::SceneFile scene = io::read_scene_text(file.spec.scene_text, "cantilever", overrides_of(file.spec, c));
    ASSERT_TRUE(scene.ok());
    const run::MemoryRun run = run::run_in_memory(scene.scene);
    ASSERT_TRUE(run.ok()) << run.text();
    results.emplace_back();
    results.back().which.name = c.name;
    results.back().report.take(run.summary, scene.scene);
    EXPECT_NEAR(*results.back().report.measures.at(1).value, 1.0, 1e-6) << c.name;  // shear
  }
  const std::vector<MeasureSensitivity> all = sensitivities_of(file.spec, results);
  ASSERT_EQ(all.size(), 2u);
  const double own[] = {0.04, 0.0225, 0.01, 0.0225}, sum = 0.095;  // a_i^2 s_i^2
  for (std::size_t k = 0; k < 4; ++k) {
    const Index &first = all[0].of.values[0][k], &total = all[0].of.values[1][k];
    const double exact = std::expm1(own[k]) / std::expm1(sum);
    EXPECT_NEAR(first.value, exact, 0.06) << k;  // 256 samples: intervals are 0.15 to 0.25 wide
    EXPECT_LT(*first.low, exact);
    EXPECT_GT(*first.high, exact);
    EXPECT_NEAR(total.value, exact * std::exp(sum - own[k]), 0.06) << k;
  }
}

}  // namespace
}  // namespace bough::study
