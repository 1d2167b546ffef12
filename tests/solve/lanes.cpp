/// Sub-domains in lockstep: the kernels of eight fronts against one front at a time, and whole solutions with and
/// without lanes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "../../src/solve/dense.hpp"
#include "../../src/solve/lane_kernels.hpp"
#include "../../src/solve/line_allocator.hpp"
#include "../../src/solve/transfers.hpp"
#include "solving.hpp"
#include "support/untrapped.hpp"

namespace bough::test {
namespace {

using solve::lanes_wide;

/// Eight fronts of n unknowns, e of them to eliminate, in the layout of the kernels, and the same column-major.
struct Fronts {
  int n, e;
  std::vector<double> factor, schur, ones;
  std::vector<std::vector<double>> alone;

  Fronts(int n_, int e_, unsigned seed) : n(n_), e(e_), alone(lanes_wide) {
    const int b = n - e;
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> entry(-1.0, 1.0);
    factor.assign(static_cast<std::size_t>(lanes_wide * e * (n + b)), 0.0);
    schur.assign(static_cast<std::size_t>(lanes_wide * b * b), 0.0);
    ones.assign(static_cast<std::size_t>(lanes_wide * n), 1.0);
    for (int l = 0; l < lanes_wide; ++l) {
      alone[static_cast<std::size_t>(l)].resize(static_cast<std::size_t>(n * n));
      for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) set(l, i, j, entry(random) + (i == j ? 4.0 : 0.0));
    }
  }
  double& at(int lane, int i, int j) {
    const int b = n - e;
    if (j < e) return factor[static_cast<std::size_t>((j * n + i) * lanes_wide + lane)];
    if (i < e) return factor[static_cast<std::size_t>((e * n + (j - e) * e + i) * lanes_wide + lane)];
    return schur[static_cast<std::size_t>(((j - e) * b + i - e) * lanes_wide + lane)];
  }
  void set(int lane, int i, int j, double value) {
    at(lane, i, j) = value;
    alone[static_cast<std::size_t>(lane)][static_cast<std::size_t>(j * n + i)] = value;
  }
  solve::LaneSet eliminate() {
    solve::Transfers none;
    return solve::eliminate_lanes(factor.data(), schur.data(), n, e, ones.data(), ones.data(), {}, none);
  }
  /// One lane's front by the scalar kernel, without exchanges (the diagonal dominates).
  std::vector<double> eliminated_alone(int lane) const {
    std::vector<double> a = alone[static_cast<std::size_t>(lane)];
    std::vector<int> rows(static_cast<std::size_t>(e)), columns = rows, from = rows;
    solve::FrontMatrix front{a.data(), n, e, rows.data(), columns.data(), from.data()};
    EXPECT_EQ(solve::eliminate_with_threshold(front, {.threshold = 1e-3, .least = 1e-10}), e);
    return a;
  }
};

/// The same fronts made symmetric, above the diagonal poison, and the right-hand sides of both.
TEST(Lanes, symmetric_kernels_give_the_factor_of_general_ones_and_read_nothing_above_the_diagonal) {
  constexpr double poison = 1e300;
  for (int e : {1, 2, 5, 6, 7, 11, 12, 18, 23})
    for (int b : {0, 1, 3, 6, 7, 12, 17}) {
      Fronts general(e + b, e, 11);
      const int n = e + b;
      for (int l = 0; l < lanes_wide; ++l)
        for (int j = 0; j < n; ++j)
          for (int i = 0; i < j; ++i) {
            // indefinite: some pivots are negative
            const double value = 0.5 * (general.at(l, i, j) + general.at(l, j, i));
            general.set(l, i, j, value);
            general.set(l, j, i, value);
          }
      for (int l = 0; l < lanes_wide; ++l)
        for (int j = 0; j < n; j += 3) general.set(l, j, j, -general.at(l, j, j));
      std::vector<double> factor(general.factor.begin(), general.factor.begin() + lanes_wide * n * e);
      std::vector<double> schur = general.schur;
      for (int j = 0; j < n; ++j)
        for (int i = 0; i < j; ++i)
          for (int l = 0; l < lanes_wide; ++l) {
            if (j < e) factor[static_cast<std::size_t>((j * n + i) * lanes_wide + l)] = poison;
            if (i >= e) schur[static_cast<std::size_t>(((j - e) * b + i - e) * lanes_wide + l)] = poison;
          }
      ASSERT_EQ(general.eliminate(), 0);
      const double* ones = general.ones.data();
      solve::Transfers none;
      ASSERT_EQ(solve::eliminate_lanes_symmetric(factor.data(), schur.data(), n, e, ones, ones, {}, none), 0);
      for (int l = 0; l < lanes_wide; ++l)
        for (int j = 0; j < n; ++j)
          for (int i = j; i < n; ++i) {
            const double value = j < e ? factor[static_cast<std::size_t>((j * n + i) * lanes_wide + l)]
                                       : schur[static_cast<std::size_t>(((j - e) * b + i - e) * lanes_wide + l)];
            EXPECT_NEAR(value, general.at(l, i, j), 1e-12) << e << ' ' << b << ' ' << l << ' ' << i << ' ' << j;
          }
      std::vector<double> v(static_cast<std::size_t>(lanes_wide * n)), w;
      for (std::size_t i = 0; i < v.size(); ++i) v[i] = std::sin(0.7 * static_cast<double>(i));
      w = v;
      solve::forward_lanes(factor.data(), n, e, v.data());
      solve::forward_lanes(general.factor.data(), n, e, w.data());
      solve::backward_lanes_symmetric(factor.data(), n, e, v.data());
      solve::backward_lanes(general.factor.data(), n, e, w.data());
      for (std::size_t i = 0; i < v.size(); ++i) EXPECT_NEAR(v[i], w[i], 1e-11) << e << ' ' << b;
    }
}

TEST(Lanes, kernels_give_the_factor_of_one_front_at_a_time) {
  for (int e : {1, 2, 5, 6, 7, 11, 12, 18, 23})
    for (int b : {0, 1, 3, 6, 12, 17}) {
      Fronts f(e + b, e, static_cast<unsigned>(100 * e + b));
      ASSERT_EQ(f.eliminate(), 0);
      for (int l = 0; l < lanes_wide; ++l) {
        const std::vector<double> a = f.eliminated_alone(l);
        for (int j = 0; j < f.n; ++j)
          for (int i = 0; i < f.n; ++i) {
            const double value = a[static_cast<std::size_t>(j * f.n + i)];
            const double expected = i == j && j < e ? 1.0 / value : value;  // lanes keep inverse pivots
            EXPECT_NEAR(f.at(l, i, j), expected, 1e-13)
                << e << "+" << b << " lane " << l << " (" << i << ", " << j << ")";
          }
      }
    }
}

TEST(Lanes, a_lane_without_a_pivot_is_told_and_changes_no_other) {
  for (int e : {6, 11, 17}) {
    Fronts good(e + 12, e, 7), bad = good;
    const int k = e - 2;  // a zero row in the eliminated part of lane 3, and a not-a-number in lane 5
    for (int j = 0; j < e; ++j) bad.set(3, k, j, 0.0);
    bad.set(5, 0, 0, std::nan(""));
    const auto failed = bad.eliminate();
    ASSERT_EQ(good.eliminate(), 0);
    EXPECT_EQ(failed, (1 << 3) | (1 << 5));
    for (int l : {0, 1, 2, 4, 6, 7})
      for (int j = 0; j < good.n; ++j)
        for (int i = 0; i < good.n; ++i) EXPECT_EQ(bad.at(l, i, j), good.at(l, i, j));
    for (double x : bad.schur) EXPECT_TRUE(std::isfinite(x));
    for (double x : bad.factor) EXPECT_TRUE(std::isfinite(x));
  }
}

TEST(Lanes, a_pivot_that_is_small_against_rows_of_the_boundary_is_refused) {
  Fronts f(18, 6, 11);
  f.set(2, 9, 4, 1e9);  // column 4, a boundary row
  EXPECT_EQ(f.eliminate(), 1 << 2);
}

TEST(Lanes, long_chains_go_in_lanes_and_give_the_solution_of_the_scalar_path) {
  for (int links : {24, 40, 67}) {
    const Scene scene = make_chain(3, links, 4);
    Solved with(scene, {.leaf_size = 5}, {.refinement_steps = 0});
    Solved without(scene, {.leaf_size = 5}, {.lanes = false, .refinement_steps = 0});
    ASSERT_TRUE(with.factor().ok());
    ASSERT_TRUE(without.factor().ok());
    EXPECT_GT(with.solver.counters().fronts_in_lanes, links);
    EXPECT_EQ(without.solver.counters().fronts_in_lanes, 0);
    const Eigen::VectorXd b = with.random_rhs(5), x = with.solve(b), y = without.solve(b);
    EXPECT_LE(with.report.backward_error, 1e-14);
    EXPECT_LE(with.scaled_difference(x, y), 1e-9);
  }
}

/// Packs of two or three sub-domains take longer than their fronts one by one. A matrix that turns out not to be
/// symmetric must find the groups of one that was never declared to be.
TEST(Lanes, packs_that_would_be_nearly_empty_are_split_whether_matrices_are_symmetric_or_not) {
  const Scene few = make_lattice(6, 8, 8), many = make_chain(6, 64, 4);
  for (const solve::Symmetry symmetry : {solve::Symmetry::general, solve::Symmetry::symmetric}) {
    EXPECT_EQ(Solved(few, {.leaf_size = 5}, {.symmetry = symmetry}).solver.counters().fronts_in_lanes, 0);
    EXPECT_GT(Solved(many, {.leaf_size = 5}, {.symmetry = symmetry}).solver.counters().fronts_in_lanes, 50);
  }
}

/// As if nothing had room in the caches: read ahead, and written past them.
TEST(Lanes, factors_that_exceed_the_caches_are_those_of_the_scalar_path_as_well) {
  Scene scene = make_chain(6, 600, 4);
  for (const auto symmetry : {solve::Symmetry::general, solve::Symmetry::symmetric}) {
    const tree::TreeOptions cut;
    if (symmetry == solve::Symmetry::symmetric)
      for (Eigen::MatrixXd& a : scene.elements) a = Eigen::MatrixXd(0.5 * (a + a.transpose()));
    Solved with(scene, cut, {.symmetry = symmetry, .near_bytes = 1, .refinement_steps = 0});
    Solved near(scene, cut, {.symmetry = symmetry, .near_bytes = std::int64_t{1} << 40, .refinement_steps = 0});
    Solved without(scene, cut, {.symmetry = symmetry, .lanes = false, .refinement_steps = 0});
    for (Solved* s : {&with, &near, &without}) ASSERT_TRUE(s->factor().ok());
    const Eigen::VectorXd b = with.random_rhs(5), x = with.solve(b), y = without.solve(b);
    EXPECT_EQ(near.solve(b), x);
    EXPECT_LE(with.report.backward_error, 1e-14);
    EXPECT_LE(with.scaled_difference(x, y), 1e-8);
    with.solver.trust_symmetry(symmetry != solve::Symmetry::general);
    Eigen::VectorXd again(b.size());
    ASSERT_TRUE(with.solver.factor(schedule::make_serial_walker(), {}, b.data()).ok());
    (void)with.solver.substitute(schedule::make_serial_walker(), b.data(), again.data(), true);
    EXPECT_EQ(x, again);
  }
}

/// Whatever is asked for between two steps, and however much waits.
TEST(Lanes, transfers_copy_all_that_waits_and_nothing_else) {
  constexpr std::int64_t packs = 700;
  std::vector<double, solve::LineAllocator<double>> from(packs * lanes_wide), to;
  for (std::size_t i = 0; i < from.size(); ++i) from[i] = static_cast<double>(i + 1);
  std::mt19937 random(3);
  for (int round = 0; round < 50; ++round) {
    to.assign(from.size(), 0.0);
    std::vector<double> expected(from.size(), 0.0);
    solve::Transfers transfers;
    for (std::int64_t at = 0; at < packs;) {
      const std::int64_t count = std::min<std::int64_t>(random() % 17, packs - at);  // none, now and then
      const double* source = from.data() + at * lanes_wide;
      if (random() % 3 == 0) {
        transfers.fetch(source, count);
      } else {
        transfers.write(source, count, to.data() + at * lanes_wide);
        std::copy(source, source + count * lanes_wide, expected.begin() + at * lanes_wide);
      }
      at += count;
      if (random() % 5 == 0) transfers.spread(1 + static_cast<int>(random() % 9));
      if (random() % 2 == 0) transfers.step();
      if (random() % 40 == 0) transfers.finish();
    }
    transfers.finish();
    solve::Transfers::end_writes();
    EXPECT_TRUE(std::equal(to.begin(), to.end(), expected.begin())) << round;
  }
}

TEST(Lanes, what_is_not_a_number_is_found_wherever_it_stands) {
  const Untrapped untrapped;
  const std::vector<double> ones(static_cast<std::size_t>(3 * lanes_wide), 1.0);
  for (std::size_t i = 0; i < ones.size(); ++i) {
    std::vector<double> v = ones;
    v[i] = std::nan("");
    EXPECT_FALSE(std::isfinite(solve::largest_scaled(v.data(), ones.data(), 3))) << i;
  }
  const Scene scene = make_parts(2, 9);  // not connected: the others' solutions stay finite
  for (bool lanes : {true, false}) {
    Solved s(scene, {.leaf_size = 3}, {.lanes = lanes, .refinement_steps = 0});
    ASSERT_TRUE(s.factor().ok());
    for (Eigen::Index i = 0; i < scene.num_unknowns(); i += 5) {
      Eigen::VectorXd b = s.random_rhs(3);
      b[i] = std::nan("");
      (void)s.solve(b);
      EXPECT_FALSE(s.report.finite) << i;
    }
  }
}

TEST(Lanes, a_right_hand_side_condensed_with_the_factor_gives_the_same_bits) {
  const Scene scene = make_chain(5, 40, 4);
  Solved s(scene, {.leaf_size = 5}, {});
  ASSERT_TRUE(s.factor().ok());
  const Eigen::VectorXd b = s.random_rhs(9), x = s.solve(b);
  Eigen::VectorXd y(b.size());
  ASSERT_TRUE(s.solver.factor(schedule::make_serial_walker(), {}, b.data()).ok());
  (void)s.solver.substitute(schedule::make_serial_walker(), b.data(), y.data(), true);
  EXPECT_EQ(x, y);
}

}  // namespace
}  // namespace bough::test
