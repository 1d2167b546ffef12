/// Dense kernels of a front against Eigen, and the law P A Q = L U.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <limits>
#include <numeric>
#include <random>

#include "../../src/solve/dense.hpp"

namespace bough::test {
namespace {

using Eigen::MatrixXd;

MatrixXd uniform(std::mt19937& random, int rows, int columns) {
  std::uniform_real_distribution<double> d(-1.0, 1.0);
  return MatrixXd::NullaryExpr(rows, columns, [&] { return d(random); });
}

struct Front {
  MatrixXd a;
  std::vector<int> rows, columns, row_from;
  solve::FrontMatrix matrix;
  Front(const MatrixXd& m, int full) : a(m), rows(static_cast<std::size_t>(full)) {
    std::iota(rows.begin(), rows.end(), 0);
    columns = row_from = rows;
    matrix = {a.data(), static_cast<int>(m.rows()), full, rows.data(), columns.data(), row_from.data()};
  }
};

/// Largest entry of P A Q - L U over the parts that must agree.
double defect(const MatrixXd& original, const Front& f, int pivots) {
  const int n = static_cast<int>(original.rows());
  MatrixXd permuted = original;
  for (std::size_t i = 0; i < f.rows.size(); ++i) permuted.row(static_cast<int>(i)) = original.row(f.row_from[i]);
  MatrixXd both = permuted;
  for (std::size_t j = 0; j < f.columns.size(); ++j) both.col(static_cast<int>(j)) = permuted.col(f.columns[j]);
  MatrixXd L = MatrixXd::Identity(n, n), U = f.a;
  for (int k = 0; k < pivots; ++k) {
    L.col(k).tail(n - k - 1) = f.a.col(k).tail(n - k - 1);
    U.col(k).tail(n - k - 1).setZero();
  }
  return (L * U - both).cwiseAbs().maxCoeff();
}

TEST(DenseKernels, ProductMatchesEigenForAllShapes) {
  std::mt19937 random(1);
  for (int m : {0, 1, 3, 7, 8, 16, 17, 33})
    for (int n : {0, 1, 3, 4, 5, 9})
      for (int k : {0, 1, 2, 31}) {
        const MatrixXd a = uniform(random, m, k), b = uniform(random, k, n);
        MatrixXd c = uniform(random, m, n);
        const MatrixXd expected = c - a * b;
        solve::subtract_product(m, n, k, a.data(), std::max(m, 1), b.data(), std::max(k, 1), c.data(), std::max(m, 1));
        if (c.size() == 0) continue;
        EXPECT_LE((c - expected).cwiseAbs().maxCoeff(), 1e-14 * (k + 1));
      }
}

TEST(DenseKernels, FactorsReproduceTheFrontForEverySizeAndSplit) {
  std::mt19937 random(2);
  for (int n : {1, 2, 5, 12, 31, 32, 33, 47, 48, 49, 64, 80, 81, 130})
    for (int full : {0, 1, n / 3, n / 2, n}) {
      if (full > n) continue;
      const MatrixXd a = uniform(random, n, n);
      Front f(a, full);
      const int pivots = solve::eliminate_with_threshold(f.matrix, {.threshold = 0.1, .least = 1e-9});
      ASSERT_GE(pivots, 0);
      EXPECT_LE(defect(a, f, pivots), 1e-13 * n)
          << n << " " << full << " " << pivots;  // growth 10 a pivot is allowed, never met
    }
}

TEST(DenseKernels, SaddlePointFrontsDelayNothingThatHasAPivot) {
  std::mt19937 random(3);
  for (int m : {6, 30, 60}) {  // [K G^T; G 0], K first: the zero diagonal fills before its turn
    const int r = m - 1;
    MatrixXd a = MatrixXd::Zero(m + r, m + r);
    a.topLeftCorner(m, m) = MatrixXd::Identity(m, m);
    a.bottomLeftCorner(r, m) = uniform(random, r, m);
    a.topRightCorner(m, r) = a.bottomLeftCorner(r, m).transpose();
    // multipliers first is the hard order: all of them are refused at first sight or take a row of K
    for (bool reversed : {false, true}) {
      const MatrixXd b = reversed ? MatrixXd(a.reverse()) : a;
      Front f(b, m + r);
      EXPECT_EQ(solve::eliminate_with_threshold(f.matrix, {.threshold = 0.01, .least = 1e-12}), m + r);
      EXPECT_LE(defect(b, f, m + r), 1e-11);
    }
  }
}

TEST(DenseKernels, ColumnsWithoutAPivotAreLeftWithAConsistentSchurComplement) {
  std::mt19937 random(4);
  for (int n : {10, 50, 100}) {
    MatrixXd a = uniform(random, n, n);
    const int full = n - 4;
    for (int j : {0, 3, full - 1}) a.col(j).head(full).setZero();  // fully summed rows have nothing in these columns
    Front f(a, full);
    const int pivots = solve::eliminate_with_threshold(f.matrix, {.threshold = 0.01, .least = 1e-9});
    EXPECT_EQ(pivots, full - 3);
    EXPECT_LE(defect(a, f, pivots), 1e-10);
  }
}

TEST(DenseKernels, CompletePivotingFindsTheRank) {
  std::mt19937 random(5);
  for (int n : {1, 4, 12, 40})
    for (int rank = 0; rank <= n; rank += std::max(1, n / 4)) {
      const MatrixXd a = uniform(random, n, rank) * uniform(random, rank, n);
      Front f(a, n);
      EXPECT_EQ(solve::eliminate_completely(f.matrix, 0, n, 1e-10), rank);
      EXPECT_LE(defect(a, f, n), 1e-10);
    }
}

TEST(DenseKernels, SubstitutionsInvertTheFactors) {
  std::mt19937 random(6);
  for (int n : {1, 7, 40}) {
    const MatrixXd a = uniform(random, n, n) + 3.0 * MatrixXd::Identity(n, n);
    Front f(a, n);
    ASSERT_EQ(solve::eliminate_with_threshold(f.matrix, {.threshold = 0.1, .least = 1e-9}), n);
    const Eigen::VectorXd b = uniform(random, n, 1);
    Eigen::VectorXd v(n), x(n);
    for (int i = 0; i < n; ++i) v(i) = b(f.row_from[static_cast<std::size_t>(i)]);
    solve::substitute_forward(f.a.data(), n, n, v.data());
    solve::substitute_backward(f.a.data(), n, n, v.data());
    for (int i = 0; i < n; ++i) x(f.columns[static_cast<std::size_t>(i)]) = v(i);
    EXPECT_LE((a * x - b).cwiseAbs().maxCoeff(), 1e-12);
  }
}

/// A symmetric front in three parts, its upper triangle poisoned: nothing may read it.
struct SymmetricFront {
  int size, full, lds;
  std::vector<double> a, s, d;
  std::vector<int> rows, columns, row_from;
  solve::FrontMatrix matrix;
  SymmetricFront(const MatrixXd& m, int fully_summed)
      : size(static_cast<int>(m.rows())),
        full(fully_summed),
        lds(size - full + 3),
        a(at((size + 5) * full + 1)),
        s(at(lds * (size - full) + 1)),
        d(at(2 * full + 2)),
        rows(at(full)) {
    std::iota(rows.begin(), rows.end(), 0);
    columns = row_from = rows;
    for (int j = 0; j < size; ++j)
      for (int i = 0; i < size; ++i) {
        const double value = i >= j ? m(i, j) : 1e30;
        if (j < full) a[at(j * (size + 5) + i)] = value;
        if (j >= full && i >= full) s[at((j - full) * lds + i - full)] = value;
      }
    matrix = {a.data(), size, full,     rows.data(), columns.data(), row_from.data(), size + 5,
              nullptr,  0,    s.data(), lds,         d.data()};
  }
  static std::size_t at(int i) { return static_cast<std::size_t>(i); }
  /// Largest entry of P A P^T - L D L^T over the lower triangle that was factored.
  double defect(const MatrixXd& original, int pivots) const {
    MatrixXd L = MatrixXd::Identity(size, size), D = MatrixXd::Zero(size, size);
    for (int j = 0; j < size; ++j)
      for (int i = j; i < size; ++i) {
        const double value = j < full ? a[at(j * (size + 5) + i)] : s[at((j - full) * lds + i - full)];
        if (j < pivots) {
          if (i > j) L(i, j) = value;
        } else {
          D(i, j) = D(j, i) = value;
        }
      }
    for (int k = 0; k < pivots; ++k) {
      D(k, k) = d[at(2 * k)];
      if (d[at(2 * k + 1)] != 0.0) D(k + 1, k) = D(k, k + 1) = d[at(2 * k + 1)];
    }
    Eigen::PermutationMatrix<Eigen::Dynamic> P(size);
    for (int i = 0; i < size; ++i) P.indices()(i < full ? row_from[at(i)] : i) = i;
    return (P * original * P.transpose() - L * D * L.transpose()).cwiseAbs().maxCoeff();
  }
};

MatrixXd symmetric(std::mt19937& random, int n) {
  const MatrixXd a = uniform(random, n, n);
  return a + a.transpose();
}

TEST(DenseKernels, SymmetricFactorsReproduceIndefiniteFronts) {
  std::mt19937 random(7);
  for (int n : {1, 2, 5, 12, 13, 31, 64, 97, 130, 250})
    for (int full : {0, 1, n / 3, n / 2, n})
      for (bool has_zero_diagonal : {false, true}) {
        MatrixXd a = symmetric(random, n);
        if (has_zero_diagonal) a.diagonal().setZero();
        SymmetricFront f(a, full);
        const int pivots = solve::eliminate_symmetric(f.matrix, {.threshold = 0.01, .least = 1e-9});
        EXPECT_EQ(pivots, n == 1 && has_zero_diagonal ? 0 : full - (full == 1 && has_zero_diagonal ? 1 : 0)) << n;
        EXPECT_LE(f.defect(a, pivots), 1e-11 * n) << n << " " << full;
      }
}

TEST(DenseKernels, SymmetricSaddlePointsAreSolvedInAnyOrder) {
  std::mt19937 random(8);
  for (int m : {6, 30, 60}) {
    const int r = m - 1, n = m + r;
    MatrixXd a = MatrixXd::Zero(n, n);
    a.topLeftCorner(m, m) = MatrixXd::Identity(m, m);
    a.bottomLeftCorner(r, m) = uniform(random, r, m);
    a.topRightCorner(m, r) = a.bottomLeftCorner(r, m).transpose();
    for (bool reversed : {false, true}) {
      const MatrixXd b = reversed ? MatrixXd(a.reverse()) : a;
      SymmetricFront f(b, n);
      ASSERT_EQ(solve::eliminate_symmetric(f.matrix, {.threshold = 0.01, .least = 1e-12}), n);
      EXPECT_LE(f.defect(b, n), 1e-11);
      const Eigen::VectorXd rhs = uniform(random, n, 1);
      Eigen::VectorXd v(n), x(n);
      for (int i = 0; i < n; ++i) v(i) = rhs(f.row_from[static_cast<std::size_t>(i)]);
      solve::substitute_forward(f.matrix, n, v.data());
      solve::substitute_backward(f.matrix, n, v.data());
      for (int i = 0; i < n; ++i) x(f.columns[static_cast<std::size_t>(i)]) = v(i);
      EXPECT_LE((b * x - rhs).cwiseAbs().maxCoeff(), 1e-9 * (1.0 + x.cwiseAbs().maxCoeff()));
    }
  }
}

TEST(DenseKernels, SymmetricUnknownsWithoutAPivotWait) {
  std::mt19937 random(9);
  for (int n : {10, 50, 100}) {
    MatrixXd a = symmetric(random, n);
    const int full = n - 4;
    for (int j : {0, 3, full - 1}) {  // they couple to the boundary alone
      a.col(j).head(full).setZero();
      a.row(j).head(full).setZero();
    }
    SymmetricFront f(a, full);
    const int pivots = solve::eliminate_symmetric(f.matrix, {.threshold = 0.01, .least = 1e-9});
    EXPECT_EQ(pivots, full - 3);
    EXPECT_LE(f.defect(a, pivots), 1e-10);
  }
}

TEST(DenseKernels, TilesOfLargeFrontsComeInAnyOrder) {
  static int calls = 0;
  const tree::Walker backwards{nullptr,
                               nullptr,
                               [](void*, std::int64_t count, std::int64_t grain, tree::Chunk chunk) {
                                 ++calls;
                                 for (std::int64_t i = (count - 1) / grain * grain; i >= 0; i -= grain)
                                   chunk.run(chunk.context, i, std::min(i + grain, count));
                               },
                               nullptr,
                               {},
                               2};
  std::mt19937 random(10);
  const int n = 1100, full = 500;
  const MatrixXd a = uniform(random, n, n), b = symmetric(random, n);
  Front one(a, full), other(a, full);
  const solve::PivotRule rule{.threshold = 0.01, .least = 1e-9};
  EXPECT_EQ(solve::eliminate_with_threshold(one.matrix, rule), full);
  EXPECT_EQ(solve::eliminate_with_threshold(other.matrix, rule, &backwards), full);
  EXPECT_EQ(one.a, other.a);
  SymmetricFront first(b, full), second(b, full);
  EXPECT_EQ(solve::eliminate_symmetric(first.matrix, rule), full);
  EXPECT_EQ(solve::eliminate_symmetric(second.matrix, rule, &backwards), full);
  const auto expect_equal_below = [](const std::vector<double>& x, const std::vector<double>& y, int columns, int ld,
                                     int rows) {  // entries above the diagonal are undefined
    for (int j = 0; j < columns; ++j) {
      const auto from = static_cast<std::ptrdiff_t>(j) * ld;
      ASSERT_TRUE(std::equal(x.begin() + from + j, x.begin() + from + rows, y.begin() + from + j)) << j;
    }
  };
  expect_equal_below(first.a, second.a, full, n + 5, n);
  expect_equal_below(first.s, second.s, n - full, first.lds, n - full);
  EXPECT_EQ(first.d, second.d);
  EXPECT_GE(calls, 4);
}

}  // namespace
}  // namespace bough::test
