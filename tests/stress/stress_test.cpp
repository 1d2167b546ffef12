/// The table's own tools: references that share nothing with the elements, and verdicts.
#include "bough/stress/stress.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <numbers>

#include "bench.hpp"
#include "bough/scene/parts.hpp"
#include "planar_rod.hpp"
#include "rigid_reference.hpp"
#include "support/untrapped.hpp"
#include "tangent_matrix.hpp"

namespace bough::stress {
namespace {

constexpr double pi = std::numbers::pi;

TEST(StressReference, rod_bends_into_a_circle_and_follows_the_elastica) {
  const stress::RodSection full =
      stress::along({1.0, 1e9, 1e9, 2.0, 0.0, 0.0}, {0.0, 0.0, 0.0, 2.0 * 2.0 * pi, 0.0, 0.0});
  EXPECT_NEAR(full.theta, 2.0 * pi, 1e-12);
  EXPECT_NEAR(full.x, 0.0, 1e-12);
  EXPECT_NEAR(full.y, 0.0, 1e-12);
  // P L^2 / EI = 1, 5, 10 by elliptic integrals; shear and extension add EI / (EA L^2) = 1e-14.
  for (const auto& [load, y] :
       {std::pair{1.0, .30172077379981353}, {5.0, .713791523611912728}, {10.0, .810609024880296453}})
    EXPECT_NEAR(stress::cantilever_rod({{1.0, 1e14, 1e14, 1.0, 0.0, 0.0}}, 0.0, load).back().y, y, 1e-11) << load;
}

TEST(StressReference, rod_stretches_and_shears) {
  const auto end = stress::cantilever_rod({{2.0, 100.0, 40.0, 1e9, 0.0, 0.0}}, 1.0, 1.0).back();
  EXPECT_NEAR(end.x, 2.0 + 2.0 / 100.0, 1e-8);
  EXPECT_NEAR(end.y, 2.0 / 40.0, 1e-8);
}

TEST(StressReference, pendulum_has_its_period) {
  const stress::PendulumState quarter = stress::physical_pendulum(9.81, 0.0, 2.3678419475762374 / 4.0);
  EXPECT_NEAR(quarter.angle, -0.5 * pi, 1e-12);
  EXPECT_NEAR(quarter.rate, -std::sqrt(2.0 * 9.81), 1e-12);
}

TEST(StressReference, scales_bring_a_bad_matrix_near_one) {
  Eigen::MatrixXd A(2, 2);
  A << 1e12, 1e3, 2e3, 5e-6;
  Eigen::VectorXd row, column;
  stress::equilibrate(A, row, column);
  const Eigen::MatrixXd scaled = (row.asDiagonal() * A * column.asDiagonal()).cwiseAbs();
  EXPECT_NEAR(scaled.rowwise().maxCoeff().minCoeff(), 1.0, 1e-6);
  EXPECT_NEAR(scaled.colwise().maxCoeff().maxCoeff(), 1.0, 1e-6);
}

TEST(StressReference, files_that_are_carried_along_are_whole) {
  const stress::ReferenceTable t = stress::reference_table("A02_fourbar_N40.csv");
  ASSERT_EQ(t.times.size(), 101u);
  EXPECT_EQ(t.times.back(), 10.0);
  EXPECT_EQ(t.rows[1][t.column("B0x")], 0.10167644339874828);
  EXPECT_FALSE(stress::gallery_scene("andrews_squeezer").bodies.empty());
  EXPECT_THROW((void)stress::data_file("reference/none.csv"), std::out_of_range);
}

TEST(StressBench, a_figure_beyond_its_limit_or_without_value_does_not_hold) {
  const test::Untrapped untrapped;  // NaN is compared
  EXPECT_TRUE((StressFigure{"a", 1.0, 1.0}.holds()));
  EXPECT_FALSE((StressFigure{"a", 1.0 + 1e-15, 1.0}.holds()));
  EXPECT_FALSE((StressFigure{"a", std::nan(""), 1.0}.holds()));
  EXPECT_FALSE((StressFigure{"a", std::nan(""), std::numeric_limits<double>::infinity()}.holds()));
}

TEST(StressBench, a_run_counts_its_work_and_a_refusal_has_to_name_its_reason) {
  StressCase c;
  stress::Bench bench(c, false);
  scene::Scene s = scene::make_cantilever(scene::make_section("s", 1e4, 5e3, 5e3, 100, 100, 100), 1.0, 4, 1);
  s.point_loads = {scene::make_load("tip", {{0, 1e-3, 0}})};
  (void)bench.run(s);
  EXPECT_EQ(c.runs, 1);
  EXPECT_GT(c.iterations, 0);
  EXPECT_GT(c.condition, 1.0);
  EXPECT_GT(c.lapack_ratio, 0.0);
  EXPECT_LT(c.lapack_ratio, lapack_ratio_limit);
  EXPECT_THROW(bench.expect_refusal(s, {}), std::runtime_error);
  s.joints.clear();
  s.sensors.pop_back();
  EXPECT_THROW(bench.expect_refusal(s, {"a word that is not there"}), std::runtime_error);
  bench.expect_refusal(s, {"nothing holds"});
  EXPECT_NE(c.refusal.find("nothing holds"), std::string::npos);
}

TEST(StressBench, a_run_that_is_stopped_ends_after_its_step_and_is_no_result) {
  StressCase c;
  int asked = 0;
  stress::Bench bench(c, false, [&] { return ++asked == 2; });
  scene::Scene s = scene::make_cantilever(scene::make_section("s", 1e4, 5e3, 5e3, 100, 100, 100), 1.0, 4, 1);
  s.analysis.load_steps = 10;
  EXPECT_THROW((void)bench.try_run(s), std::runtime_error);
  EXPECT_EQ(asked, 2);
  EXPECT_EQ(c.runs, 0);
}

TEST(StressBench, the_ratio_is_that_of_lapack) {
  StressCase c;
  stress::Bench bench(c, false);
  bench.backward_error(10 * 0x1p-53, 4.0);  // at most twice 10 / 4
  EXPECT_NEAR(c.lapack_ratio, 5.0, 1e-9);
}

TEST(StressTable, options_with_a_wrong_name_are_told_the_nearest) {
  EXPECT_TRUE(problems_in(StressOptions{}).empty());
  EXPECT_TRUE(problems_in(StressOptions{.only = "spin"}).empty());
  const std::vector<std::string> problems = problems_in(StressOptions{.threads = 0, .only = "elastic"});
  ASSERT_EQ(problems.size(), 2u);
  EXPECT_NE(problems[1].find("elastica"), std::string::npos);
}

TEST(StressTable, one_case_runs_alone_and_is_told_once) {
  int told = 0;
  const std::vector<StressCase> cases = run_stress({.quick = true, .threads = 2, .only = "one_body"},
                                                   [&](const StressCase&, std::size_t done, std::size_t all) {
                                                     ++told;
                                                     EXPECT_EQ(done, 1u);
                                                     EXPECT_EQ(all, 1u);
                                                   });
  ASSERT_EQ(cases.size(), 1u);
  EXPECT_EQ(told, 1);
  EXPECT_EQ(cases[0].status, StressStatus::holds) << cases[0].measured;
  EXPECT_TRUE(run_stress({.quick = true}, {}, [] { return true; }).empty());
}

}  // namespace
}  // namespace bough::stress
