// Draws, sequences and distributions against published values, their moments and their quantiles.
#include "bough/study/sampling.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <numeric>
#include <set>

#include "bough/study/cases.hpp"

namespace bough::study {
namespace {

using io::SweepDesign;
using io::SweepDesignKind;
using Kind = Distribution::Kind;

TEST(Sampling, philox_gives_the_known_answers_of_its_authors) {
  using Words = std::array<std::uint32_t, 4>;
  EXPECT_EQ(philox({0, 0, 0, 0}, {0, 0}), (Words{0x6627e8d5u, 0xe169c58du, 0xbc57ac4cu, 0x9b00dbd8u}));
  const std::uint32_t ones = 0xffffffffu;
  EXPECT_EQ(philox({ones, ones, ones, ones}, {ones, ones}),
            (Words{0x408f276du, 0x41c83b0eu, 0xa20bc7c6u, 0x6d5451fdu}));
  EXPECT_EQ(philox({0x243f6a88u, 0x85a308d3u, 0x13198a2eu, 0x03707344u}, {0xa4093822u, 0x299f31d0u}),
            (Words{0xd16cfe09u, 0x94fdccebu, 0x5001e420u, 0x24126ea1u}));
}

TEST(Sampling, draws_are_uniform_and_streams_are_independent) {
  constexpr int n = 200'000;
  double sum = 0.0, squares = 0.0, products = 0.0;
  for (std::uint64_t r = 0; r < n; ++r) {
    const double u = uniform_draw(7, 0, r), v = uniform_draw(7, 1, r);
    ASSERT_GT(u, 0.0);
    ASSERT_LT(u, 1.0);
    sum += u;
    squares += u * u;
    products += (u - 0.5) * (v - 0.5);
  }
  const double sigma = 1.0 / std::sqrt(static_cast<double>(n));
  EXPECT_NEAR(sum / n, 0.5, 4.0 * sigma / std::sqrt(12.0));
  EXPECT_NEAR(squares / n, 1.0 / 3.0, 4.0 * sigma * std::sqrt(4.0 / 45.0));
  EXPECT_NEAR(products / n, 0.0, 4.0 * sigma / 12.0);
  EXPECT_NE(uniform_draw(1, 0, 0), uniform_draw(2, 0, 0));
}

TEST(Sampling, a_permutation_holds_each_number_once) {
  std::vector<std::uint32_t> p = permutation(3, 5, 1000);
  EXPECT_FALSE(std::is_sorted(p.begin(), p.end()));
  std::sort(p.begin(), p.end());
  for (std::uint32_t k = 0; k < p.size(); ++k) ASSERT_EQ(p[k], k);
}

TEST(Sampling, sobol_points_are_those_of_the_published_sequence) {
  // Joe and Kuo's first points in two and three dimensions.
  const double points[][3] = {{0, 0, 0},
                              {0.5, 0.5, 0.5},
                              {0.75, 0.25, 0.25},
                              {0.25, 0.75, 0.75},
                              {0.375, 0.375, 0.625},
                              {0.875, 0.875, 0.125},
                              {0.625, 0.125, 0.875},
                              {0.125, 0.625, 0.375}};
  for (std::uint32_t r = 0; r < 8; ++r)
    for (std::size_t d = 0; d < 3; ++d) EXPECT_EQ(sobol_point(r, d), points[r][d]) << r << " " << d;
}

/// Of 2^m points each of 2^m intervals holds one, in every dimension; and of pairs of dimensions the first 2^m points
/// meet every box of 2^a by 2^b at most 2^t times, with the t of a (t, m, 2)-net that stays small.
TEST(Sampling, sobol_points_are_stratified_in_every_dimension) {
  for (std::size_t d = 0; d < most_sobol_dimensions; ++d) {
    std::set<int> intervals;
    for (std::uint32_t r = 0; r < 1024; ++r) intervals.insert(static_cast<int>(sobol_point(r, d) * 1024.0));
    EXPECT_EQ(intervals.size(), 1024u) << d;
  }
  for (std::size_t d = 1; d < most_sobol_dimensions; ++d)
    for (std::size_t e = 0; e < d; ++e) {
      std::map<std::pair<int, int>, int> boxes;
      for (std::uint32_t r = 0; r < 4096; ++r)
        ++boxes[{static_cast<int>(sobol_point(r, d) * 8.0), static_cast<int>(sobol_point(r, e) * 8.0)}];
      EXPECT_EQ(boxes.size(), 64u) << d << " " << e;
      for (const auto& [box, count] : boxes) EXPECT_EQ(count, 64) << d << " " << e;
    }
}

TEST(Sampling, normal_quantiles_invert_the_distribution) {
  EXPECT_NEAR(normal_quantile(0.5), 0.0, 1e-16);
  EXPECT_NEAR(normal_quantile(0.975), 1.959963984540054, 1e-14);
  EXPECT_NEAR(normal_quantile(1e-10), -6.361340902404056, 1e-13);
  for (double u = 1e-15; u < 1.0; u = u < 1e-3 ? 3.0 * u : u + 0.0137) {
    const double x = normal_quantile(u);
    EXPECT_NEAR(0.5 * std::erfc(-x / std::sqrt(2.0)) / u, 1.0, 1e-13) << u;
  }
}

/// Moments by the midpoint rule in u, and a quantile of each in closed form.
TEST(Sampling, distributions_have_their_moments_and_quantiles) {
  struct Case {
    Distribution d;
    double mean, variance, u, quantile;
  };
  const auto make = [](Kind kind, double a, double b) {
    Distribution d;
    d.kind = kind;
    d.low = d.mean = a;
    d.high = d.deviation = b;
    return d;
  };
  Distribution dice = make(Kind::discrete, 0, 0);
  dice.values = {1, 2, 5};
  Distribution loaded = dice;
  loaded.weights = {2, 0, 6};
  const double s = 0.3;
  const Case cases[] = {{make(Kind::uniform, -1, 3), 1.0, 16.0 / 12.0, 0.25, 0.0},
                        {make(Kind::normal, 2, 0.5), 2.0, 0.25, 0.8413447460685429, 2.5},
                        {make(Kind::lognormal, 1, s), std::exp(1 + s * s / 2),
                         (std::exp(s * s) - 1) * std::exp(2 + s * s), 0.5, std::exp(1.0)},
                        {dice, 8.0 / 3.0, 10.0 - 64.0 / 9.0, 0.4, 2.0},
                        {loaded, 4.0, 19.0 - 16.0, 0.26, 5.0}};
  constexpr int n = 400'000;
  for (const Case& c : cases) {
    double sum = 0.0, squares = 0.0;
    for (int k = 0; k < n; ++k) {
      const double x = quantile(c.d, (k + 0.5) / n);
      sum += x;
      squares += x * x;
    }
    EXPECT_NEAR(sum / n, c.mean, 1e-5 * (1.0 + std::abs(c.mean)));
    EXPECT_NEAR(squares / n - sum * sum / n / n, c.variance, 2e-4 * c.variance);
    EXPECT_NEAR(quantile(c.d, c.u), c.quantile, 1e-12);
  }
}

SweepDesign design_of(SweepDesignKind kind, std::size_t variables, std::uint32_t samples) {
  SweepDesign d;
  d.kind = kind;
  d.samples = samples;
  d.variables.resize(variables);
  return d;
}

TEST(Sampling, a_latin_hypercube_has_one_point_in_each_stratum) {
  for (const std::uint32_t n : {1u, 7u, 100u}) {
    const auto rows = unit_rows_of(design_of(SweepDesignKind::latin_hypercube, 3, n), 0);
    ASSERT_EQ(rows.size(), n);
    for (std::size_t k = 0; k < 3; ++k) {
      std::set<int> strata;
      for (const auto& row : rows) strata.insert(static_cast<int>(row[k] * n));
      EXPECT_EQ(strata.size(), n);
    }
  }
}

TEST(Sampling, trajectories_of_morris_move_each_variable_once_by_half_the_levels) {
  const auto rows = unit_rows_of(design_of(SweepDesignKind::morris, 4, 50), 0);
  ASSERT_EQ(rows.size(), 250u);
  for (std::size_t t = 0; t < 50; ++t) {
    std::set<std::size_t> moved;
    for (std::size_t r = 5 * t + 1; r < 5 * t + 5; ++r)
      for (std::size_t k = 0; k < 4; ++k)
        if (rows[r][k] != rows[r - 1][k]) {
          EXPECT_DOUBLE_EQ(std::abs(rows[r][k] - rows[r - 1][k]), 0.5);
          EXPECT_TRUE(moved.insert(k).second);
        }
    EXPECT_EQ(moved.size(), 4u);
  }
}

TEST(Sampling, cases_are_all_combinations_with_conditions_kept) {
  io::SweepSpec spec;
  spec.designs = {design_of(SweepDesignKind::grid, 2, 0), design_of(SweepDesignKind::random, 1, 3)};
  const auto values = [](std::initializer_list<double> list) {
    std::vector<io::SweepValue> all;
    for (const double x : list) all.push_back({std::to_string(x), x});
    return all;
  };
  spec.designs[0].variables[0] = {"a", {"/parameters/a"}, values({1, 2}), {}, {}};
  spec.designs[0].variables[1] = {"b", {"/parameters/b", "/x/y"}, values({3, 4, 5}), {}, {}};
  spec.designs[1].variables[0].name = "c";
  spec.designs[1].variables[0].pointers = {"/parameters/c"};
  const SweepCases all = make_cases(spec);
  ASSERT_EQ(all.size(), 18u);
  EXPECT_EQ(all.at(0).name, "01");
  EXPECT_EQ(all.at(3).inputs[1].number, 4.0);
  EXPECT_EQ(all.at(0).inputs[2].text, all.at(15).inputs[2].text);
  EXPECT_EQ(overrides_of(spec, all.at(4)).size(), 4u);
  const std::vector<std::string> names = {"a", "b", "c"};
  spec.where.push_back({"a*b", laws::Formula("a*b", names), names, 4.5, 8.5});
  const SweepCases some = make_cases(spec);
  EXPECT_EQ(some.size(), 9u);  // 1*5, 2*3, 2*4
  EXPECT_EQ(some.left_out(), 9u);
  EXPECT_EQ(some.at(0).name, "07");  // names do not depend on conditions
  EXPECT_EQ(some.at(0).inputs[2].text, all.at(6).inputs[2].text);
}

TEST(Sampling, what_is_drawn_has_twelve_digits_and_reads_back) {
  for_each_row(design_of(SweepDesignKind::random, 2, 200), 0, [](const std::vector<io::SweepValue>& row) {
    for (const io::SweepValue& v : row) {
      EXPECT_LE(v.text.size(), 18u);
      EXPECT_EQ(std::stod(v.text), v.number);
    }
  });
}

TEST(Sampling, cases_keep_values_of_any_kind_as_they_are_written) {
  const std::vector<io::SweepValue> rows[] = {{{"1e3", 1000.0}, {"\"word\"", {}}, {"0.1", 0.1}},
                                              {{"1000", 1000.0}, {"[1, 2]", {}}, {"0.30000000000000004", 0.1 + 0.2}},
                                              {{"-0", -0.0}, {"true", {}}, {"0.123456789012", 0.123456789012}}};
  SweepCases cases({"a", "b", "c"});
  for (const auto& row : rows) cases.add(row);
  cases.leave_out();
  ASSERT_EQ(cases.size(), 3u);
  EXPECT_EQ(cases.left_out(), 1u);
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_EQ(cases.at(i).inputs[k].text, rows[i][k].text);
      EXPECT_EQ(cases.at(i).inputs[k].number, rows[i][k].number);
    }
}

TEST(Sampling, too_many_cases_are_refused_before_they_are_made) {
  io::SweepSpec spec;
  for (int k = 0; k < 4; ++k) spec.designs.push_back(design_of(SweepDesignKind::random, 1, 1000));
  EXPECT_THROW((void)make_cases(spec), std::runtime_error);
}

}  // namespace
}  // namespace bough::study
