#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "../../src/study/sweep/references.hpp"
#include "../../src/study/sweep/sampled_run.hpp"
#include "bough/io/digest.hpp"
#include "bough/study/errors.hpp"
#include "support/scratch_directory.hpp"

namespace bough::study {
namespace {

using io::QuantityKind;

TEST(Distance, of_rotations_is_the_angle_between_them) {
  // about z by 0.3, and then by 0.3 + d about the same axis
  for (const double d : {0.0, 1e-12, 1e-6, 1e-2, 1.0, 3.0}) {
    const double got = distance(QuantityKind::rotation, {0.0, 0.0, 0.1 + d}, {0.0, 0.0, 0.1});
    EXPECT_NEAR(got, d, 1e-15) << d;
  }
  EXPECT_NEAR(distance(QuantityKind::rotation, {0.0, 0.0, 2.0}, {0.0, 0.0, -2.0}), 2.0 * M_PI - 4.0, 1e-15)
      << "the short way round";
}

TEST(Distance, of_rotations_takes_vectors_and_quaternions_of_either_sign_and_any_length) {
  const double angle = 1.2, d = 1e-3, h = 0.5 * angle;
  const std::vector<double> vector{0.0, angle + d, 0.0};
  for (const double f : {1.0, -1.0, 7.0})
    EXPECT_NEAR(distance(QuantityKind::quaternion, vector, {f * std::cos(h), 0.0, f * std::sin(h), 0.0}), d, 1e-15);
}

TEST(Distance, of_rotations_about_two_axes_is_that_of_the_relative_rotation) {
  // 90 degrees about x against 90 degrees about y: R_y^T R_x turns by 120 degrees
  EXPECT_NEAR(distance(QuantityKind::rotation, {M_PI / 2, 0.0, 0.0}, {0.0, M_PI / 2, 0.0}), 2.0 * M_PI / 3.0, 1e-15);
}

TEST(Extrapolation, takes_the_leading_error_off_numbers_and_off_rotations_about_a_moving_axis) {
  // Errors c h^2, of rotations R exp(c h^2): of steps 1 and 2 with c = 0.01.
  const Samples of_one{{3.0 + 0.01, -2.0 + 0.02}, {}}, of_two{{3.0 + 0.04, -2.0 + 0.08}, {1.0, 1.0}};
  const Samples limit = extrapolated(QuantityKind::vector, of_one, of_two, 2.0);
  EXPECT_NEAR(limit[0][0], 3.0, 1e-15);
  EXPECT_NEAR(limit[0][1], -2.0, 1e-15);
  EXPECT_TRUE(limit[1].empty());
  const auto turned = [](double angle) {  // half a turn about z but for 0.1, then about x
    const double a = 0.5 * (M_PI - 0.1), b = 0.5 * angle;
    return std::vector<double>{std::cos(a) * std::cos(b), std::cos(a) * std::sin(b), std::sin(a) * std::sin(b),
                               std::sin(a) * std::cos(b)};
  };
  for (const double sign : {1.0, -1.0}) {  // of a quaternion and of its opposite
    std::vector<double> coarse = turned(0.04);
    for (double& x : coarse) x *= sign;
    const Samples rotation = extrapolated(QuantityKind::quaternion, {turned(0.01)}, {coarse}, 2.0);
    EXPECT_LT(distance(QuantityKind::quaternion, rotation[0], turned(0.0)), 1e-15);
  }
}

TEST(Errors, are_relative_to_the_largest_reference_and_have_three_norms) {
  const Samples reference{{3.0, 4.0}, {0.0, 0.0}, {0.0, 1.0}}, values{{3.0, 4.0}, {0.0, 1.0}, {2.0, 1.0}};
  const double scale = error_scale(QuantityKind::vector, reference);
  EXPECT_EQ(scale, 5.0);
  const ErrorNorms e = eval_errors(QuantityKind::vector, values, reference, scale);
  EXPECT_NEAR(e.max, 2.0 / 5.0, 1e-16);
  EXPECT_NEAR(e.end, 2.0 / 5.0, 1e-16);
  EXPECT_NEAR(e.rms, std::sqrt((0.0 + 1.0 + 4.0) / 3.0) / 5.0, 1e-16);
}

TEST(Errors, a_sample_that_is_missing_counts_for_nothing_and_none_at_all_is_told) {
  const Samples reference{{1.0}, {1.0}, {1.0}};
  const ErrorNorms e = eval_errors(QuantityKind::vector, {{1.5}, {}, {}}, reference, 1.0);
  EXPECT_EQ(e.max, 0.5);
  EXPECT_TRUE(std::isnan(e.end));
  EXPECT_TRUE(std::isnan(eval_errors(QuantityKind::vector, {{}, {}, {}}, reference, 1.0).max));
  EXPECT_EQ(error_scale(QuantityKind::vector, {{0.0}, {0.0}}), 1.0) << "nothing moves: absolute";
}

TEST(Slope, of_a_power_law_is_its_exponent) {
  const std::vector<double> h{0.1, 0.05, 0.02, 0.01};
  for (const double p : {1.0, 2.0, 5.0}) {
    std::vector<double> e;
    for (const double x : h) e.push_back(3.0 * std::pow(x, p));
    EXPECT_NEAR(log_slope(h, e), p, 1e-12);
  }
  EXPECT_TRUE(std::isnan(log_slope({0.1}, {1.0})));
  EXPECT_TRUE(std::isnan(log_slope({0.1, 0.1}, {1.0, 2.0})));
}

TEST(Order, is_fitted_to_the_finest_errors_that_the_reference_is_accurate_enough_for) {
  const std::vector<double> h{8.0, 4.0, 2.0, 1.0, 0.5};
  // errors are of second order; the last holds the reference's own
  const OrderFit clear = fit_order(h, {64e-6, 16e-6, 4e-6, 1e-6, 0.9e-6}, 0.07e-6);
  EXPECT_EQ(clear.runs, (std::vector<std::size_t>{0, 1, 2}))
      << "0.07 / 4 over log 4 is 0.013; 0.07 / 1 would be 0.0505";
  EXPECT_NEAR(clear.order, 2.0, 1e-12);
  const OrderFit all = fit_order(h, {64e-6, 16e-6, 4e-6, 1e-6, 0.25e-6}, 0.0);
  EXPECT_EQ(all.runs, (std::vector<std::size_t>{2, 3, 4}));
  EXPECT_NEAR(all.order, 2.0, 1e-12);
  EXPECT_TRUE(fit_order(h, {64e-6, 16e-6, 4e-6, 1e-6, 0.25e-6}, 1e-4).runs.empty()) << "the reference tells nothing";
  EXPECT_TRUE(fit_order(h, {64e-6, 16e-6, 4e-6, 1e-6, 0.25e-6}, unmeasured).runs.empty());
}

TEST(Order, needs_a_better_reference_where_steps_differ_by_less) {
  const double uncertainty = 0.02e-6;
  EXPECT_EQ(fit_order({4.0, 2.0}, {4e-6, 1e-6}, uncertainty).runs.size(), 2u);
  EXPECT_TRUE(fit_order({2.2, 2.0}, {1.21e-6, 1e-6}, uncertainty).runs.empty());
}

TEST(Order, skips_runs_that_failed_and_errors_of_round_off) {
  const double failed = std::numeric_limits<double>::quiet_NaN();
  const OrderFit f = fit_order({8.0, 4.0, 2.0, 1.0}, {64e-6, 16e-6, failed, 1e-14}, 0.0);
  EXPECT_EQ(f.runs, (std::vector<std::size_t>{0, 1}));
  EXPECT_NEAR(f.order, 2.0, 1e-12);
  EXPECT_TRUE(std::isnan(fit_order({2.0, 1.0}, {failed, 1e-3}, 0.0).order));
}

TEST(Order, is_judged_against_theory) {
  const auto verdict = [](double found, double expected, const char* explanation) {
    OrderFit f;
    f.order = found;
    f.expected = expected;
    f.explanation = explanation;
    judge(f);
    return f.verdict;
  };
  EXPECT_EQ(verdict(2.05, 2.0, ""), Verdict::holds);
  EXPECT_EQ(verdict(1.91, 2.0, ""), Verdict::holds);
  EXPECT_EQ(verdict(1.89, 2.0, "an explanation does not help here"), Verdict::below);
  EXPECT_EQ(verdict(2.2, 2.0, ""), Verdict::above);
  EXPECT_EQ(verdict(2.2, 2.0, "a leading term vanishes"), Verdict::explained);
  EXPECT_EQ(verdict(unmeasured, 2.0, ""), Verdict::not_measured);
  EXPECT_EQ(verdict(2.0, unmeasured, ""), Verdict::not_stated);
}

TEST(Spread, is_median_and_range) {
  const Spread odd = spread_of({3.0, 1.0, 2.0}), even = spread_of({4.0, 1.0, 2.0, 3.0});
  EXPECT_EQ(odd.median, 2.0);
  EXPECT_EQ(odd.low, 1.0);
  EXPECT_EQ(odd.high, 3.0);
  EXPECT_EQ(even.median, 2.5);
  EXPECT_TRUE(std::isnan(spread_of({}).median));
}

class Cache : public testing::Test {
 protected:
  Cache() : folder_(scratch_.path()) {
    history_.header.columns = {"tip.x"};
    records::HistoryRow row;
    row.time = 1.0;
    row.values = {1.0 / 3.0};
    history_.rows = {row};
  }
  support::ScratchDirectory scratch_;
  std::filesystem::path folder_;
  io::History history_;
};

TEST_F(Cache, gives_back_what_was_kept_bit_for_bit) {
  const ReferenceCache cache(folder_);
  EXPECT_FALSE(cache.find("scene and settings"));
  cache.keep("scene and settings", history_);
  const auto found = cache.find("scene and settings");
  ASSERT_TRUE(found);
  EXPECT_EQ(found->rows[0].values[0], 1.0 / 3.0);
  EXPECT_FALSE(cache.find("scene and other settings"));
}

TEST_F(Cache, does_not_take_another_reference_of_the_same_hash) {
  const ReferenceCache cache(folder_);
  cache.keep("one", history_);
  std::filesystem::rename(folder_ / (io::digest_of("one") + ".csv"), folder_ / (io::digest_of("two") + ".csv"));
  std::filesystem::rename(folder_ / (io::digest_of("one") + ".txt"), folder_ / (io::digest_of("two") + ".txt"));
  EXPECT_FALSE(cache.find("two")) << "the text tells them apart";
}

TEST_F(Cache, computes_anew_what_is_damaged) {
  const ReferenceCache cache(folder_);
  cache.keep("one", history_);
  std::ofstream(folder_ / (io::digest_of("one") + ".csv")) << "time,step_size,iterations,tip.x\n1,0,";
  EXPECT_FALSE(cache.find("one"));
}

TEST_F(Cache, counts_files_that_the_scene_names_to_what_a_reference_is_made_from) {
  io::StudySpec spec;
  spec.scene_folder = folder_;
  spec.scene_text = R"({"schema_version": 1, "gravity": [0, 0, -1],
    "nodes": [{"name": "a"}, {"name": "b", "position": [1, 0, 0]}],
    "materials": [{"name": "steel", "young": 2e11, "poisson": 0.3, "density": 7850}],
    "sections": [{"name": "bar", "material": "steel", "shear_factors": [0.8, 0.8],
                  "shape": {"kind": "polygon", "torsion_constant": 1e-8,
                            "file": "corners.csv"}}],
    "beams": [{"name": "beam", "section": "bar", "start": "a", "end": "b", "elements": 1}],
    "analysis": {"kind": "dynamic", "end_time": 1, "step_size": 0.1}})";
  const auto with = [&](const char* corners) {
    std::ofstream(folder_ / "corners.csv") << corners;
    EXPECT_EQ(study_scene(spec, {}).beams.size(), 1u);
    return made_from(spec, {});
  };
  const std::string thin = with("0,0\n0.02,0\n0.02,0.02\n0,0.02\n");
  EXPECT_EQ(made_from(spec, {}), thin);
  EXPECT_NE(with("0,0\n0.03,0\n0.03,0.02\n0,0.02\n"), thin);
}

TEST_F(Cache, without_a_folder_keeps_nothing) {
  const ReferenceCache cache({});
  cache.keep("one", history_);
  EXPECT_FALSE(cache.find("one"));
}

}  // namespace
}  // namespace bough::study
