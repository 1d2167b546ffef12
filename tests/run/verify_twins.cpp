/// Errors that twins tell, on scenes of the gallery: against references in finer steps and meshes, and the order of what
/// extrapolation leaves. benchmarks/twin_errors.py does this for all scenes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "bough/records/errors.hpp"
#include "bough/run/memory_run.hpp"
#include "support/scenes.hpp"

namespace bough::run {
namespace {

using records::ErrorOf;
using records::ErrorState;

/// parts: into which each step of the scene, times `longer`, is divided; rows are at the same times for any number.
MemoryRun run_with_errors(const std::string& scene, const scene::ErrorsWanted& errors, double longer = 1.0,
                          int parts = 1) {
  scene::Scene s = support::gallery(scene);
  s.analysis.errors = errors;
  s.analysis.step_size *= longer / parts;
  s.output.stride = parts;
  s.expected.clear();
  s.measures.clear();
  return run_in_memory(s, 2);
}

/// The column in all rows, extrapolated.
std::vector<double> limit(const MemoryRun& run, std::size_t column) {
  std::vector<double> values;
  for (const records::HistoryRow& row : run.summary.errors->rows) values.push_back(row.values[3 * column]);
  return values;
}

double largest_difference(const std::vector<double>& a, const std::vector<double>& b) {
  double largest = 0.0;
  for (std::size_t k = 0; k < std::min(a.size(), b.size()); ++k) largest = std::max(largest, std::abs(a[k] - b[k]));
  return largest;
}

struct Case {
  const char* scene;
  std::vector<std::string> columns;
  double longer = 1.0;  ///< steps, times those of the scene
};

class InTime : public testing::TestWithParam<Case> {};

/// Halving steps divides the error that is left by 2^4.
TEST_P(InTime, told_errors_are_true_and_extrapolated_values_have_their_order) {
  const Case& c = GetParam();
  const auto run_in = [&c](int parts) { return run_with_errors(c.scene, {true, false}, c.longer, parts); };
  const MemoryRun coarse = run_in(1), half = run_in(2), fine = run_in(8);
  ASSERT_TRUE(coarse.ok() && half.ok() && fine.ok()) << coarse.text() << half.text() << fine.text();
  for (const std::string& name : c.columns) {
    const std::size_t k = coarse.column(name);
    const ErrorOf &told = coarse.summary.errors->columns[k], &finer = half.summary.errors->columns[k];
    ASSERT_EQ(told.time.state, ErrorState::resolved) << name << " " << told.time.cause;
    ASSERT_EQ(finer.time.state, ErrorState::resolved) << name << " " << finer.time.cause;
    const std::vector<double> truth = limit(fine, k);
    const double error = largest_difference(coarse.series(name), truth);
    EXPECT_GT(told.time.largest, 0.5 * error) << name;
    EXPECT_LT(told.time.largest, 2.0 * error) << name;
    const double order =
        std::log2(largest_difference(limit(coarse, k), truth) / largest_difference(limit(half, k), truth));
    std::printf("%-20s %-10s error %.2e, told %.2e, left %.1e, order %.2f\n", c.scene, name.c_str(), error,
                told.time.largest, largest_difference(limit(coarse, k), truth), order);
    EXPECT_GT(order, 3.5) << name;
  }
}

std::string name_of(const testing::TestParamInfo<Case>& info) { return info.param.scene; }
INSTANTIATE_TEST_SUITE_P(Twins, InTime,
                         testing::Values(Case{"rod_chain", {"tip.x", "tip.z"}},
                                         Case{"heavy_top", {"center.x", "center.z"}, 2.0},
                                         Case{"four_bar_windows", {"B0.x", "B0.y"}},
                                         Case{"free_body", {"body.wx", "body.wz", "attitude.q1"}}),
                         name_of);

class OfMesh : public testing::TestWithParam<Case> {};

TEST_P(OfMesh, told_errors_are_true) {
  const Case& c = GetParam();
  const MemoryRun run = run_with_errors(c.scene, {false, true});
  scene::Scene s = support::gallery(c.scene);
  for (scene::Beam& b : s.beams) b.elements *= 4;
  s.expected.clear();
  s.measures.clear();
  const MemoryRun fine = run_in_memory(s, 2);
  ASSERT_TRUE(run.ok() && fine.ok()) << run.text() << fine.text();
  for (const std::string& name : c.columns) {
    const ErrorOf& told = run.summary.errors->columns[run.column(name)];
    ASSERT_EQ(told.mesh.state, ErrorState::resolved) << name << " " << told.mesh.cause;
    const double error = largest_difference(run.series(name), fine.series(name));
    std::printf("%-20s %-10s error %.2e, told %.2e\n", c.scene, name.c_str(), error, told.mesh.largest);
    EXPECT_GT(told.mesh.largest, 0.5 * error) << name;
    EXPECT_LT(told.mesh.largest, 2.0 * error) << name;
  }
}

INSTANTIATE_TEST_SUITE_P(Twins, OfMesh,
                         testing::Values(Case{"elastica", {"tip.x", "root.M3"}},
                                         Case{"spin_up", {"tip.x", "torque.fx"}},
                                         Case{"right_angle_cantilever", {"tip.x", "energy"}}),
                         name_of);

}  // namespace
}  // namespace bough::run
