#include "bough/io/compare.hpp"
#include "write_samples.hpp"

namespace bough::io {
namespace {

History wave(int num_rows = 20) {
  History history;
  history.header.columns = {"tip.x", "tip.z", "energy"};
  for (int k = 0; k < num_rows; ++k) history.rows.push_back({0.1 * k, 0.1, 3, {2.0 * std::sin(0.4 * k), 0.0, 5.0}});
  return history;
}

const ColumnDifference& column(const Comparison& comparison, const std::string& name) {
  for (const ColumnDifference& c : comparison.columns)
    if (c.name == name) return c;
  throw std::out_of_range(name);
}

TEST(Compare, a_history_equals_itself_with_no_tolerance) {
  const Comparison comparison = compare_histories(wave(), wave(), {0.0, 0.0});
  EXPECT_TRUE(comparison.equal);
  for (const ColumnDifference& c : comparison.columns) EXPECT_EQ(c.absolute, 0.0) << c.name;
}

TEST(Compare, the_largest_difference_is_found_with_its_time) {
  History other = wave();
  other.rows[4].values[0] += 1e-3;
  other.rows[9].values[0] -= 3e-3;
  const Comparison comparison = compare_histories(wave(), other, {1e-6, 0.0});
  EXPECT_FALSE(comparison.equal);
  const ColumnDifference& x = column(comparison, "tip.x");
  EXPECT_NEAR(x.absolute, 3e-3, 1e-15);
  EXPECT_DOUBLE_EQ(x.time, 0.9);
  EXPECT_NEAR(x.relative, 3e-3 / x.scale, 1e-15);
  EXPECT_NEAR(x.scale, 4.0, 0.1) << "the range of a sine of amplitude 2";
  EXPECT_TRUE(compare_histories(wave(), other, {1e-3, 0.0}).equal) << "3e-3 of a range of 4";
  EXPECT_TRUE(compare_histories(wave(), other, {0.0, 4e-3}).equal);
}

TEST(Compare, a_coordinate_that_stays_at_zero_is_measured_by_the_motion_of_its_point) {
  History other = wave();
  other.rows[3].values[1] = 1e-16;
  const Comparison comparison = compare_histories(wave(), other, {1e-9, 0.0});
  EXPECT_TRUE(comparison.equal);
  EXPECT_NEAR(column(comparison, "tip.z").relative, 1e-16 / 4.0, 1e-17);
}

TEST(Compare, a_constant_is_measured_by_its_magnitude) {
  History other = wave();
  other.rows[3].values[2] = 5.0 + 1e-6;
  EXPECT_NEAR(column(compare_histories(wave(), other, {}), "energy").relative, 1e-6 / 5.0, 1e-12);
}

TEST(Compare, a_nan_in_either_or_both_is_never_equal) {
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  for (const double bad : {nan, inf, -inf}) {
    History damaged = wave();
    damaged.rows[7].values[0] = bad;
    for (const auto& [a, b] : {std::pair{wave(), damaged}, {damaged, wave()}, {damaged, damaged}}) {
      const Comparison comparison = compare_histories(a, b, {1e300, 1e300});
      EXPECT_FALSE(comparison.equal);
      EXPECT_TRUE(column(comparison, "tip.x").has_non_finite);
      EXPECT_DOUBLE_EQ(column(comparison, "tip.x").time, 0.7);
      EXPECT_TRUE(column(comparison, "energy").holds);
    }
  }
}

TEST(Compare, rows_and_columns_of_one_side_only_are_differences) {
  EXPECT_FALSE(compare_histories(wave(20), wave(19), {1.0, 1.0}).equal);
  History other = wave();
  other.header.columns[2] = "work";
  const Comparison comparison = compare_histories(wave(), other, {1.0, 1.0});
  EXPECT_FALSE(comparison.equal);
  EXPECT_EQ(comparison.problems, (std::vector<std::string>{"column energy is only in A", "column work is only in B"}));
  EXPECT_FALSE(compare_histories(wave(0), wave(0), {1.0, 1.0}).equal) << "nothing was compared";
}

TEST(Compare, iteration_counts_are_shown_but_not_judged) {
  History other = wave();
  other.rows[2].iterations = 9;
  const Comparison comparison = compare_histories(wave(), other, {0.0, 0.0});
  EXPECT_TRUE(comparison.equal);
  EXPECT_EQ(column(comparison, "iterations").absolute, 6.0);
}

TEST(Compare, the_order_of_columns_does_not_matter) {
  History other = wave();
  std::swap(other.header.columns[0], other.header.columns[2]);
  for (records::HistoryRow& row : other.rows) std::swap(row.values[0], row.values[2]);
  EXPECT_TRUE(compare_histories(wave(), other, {0.0, 0.0}).equal);
}

}  // namespace
}  // namespace bough::io
