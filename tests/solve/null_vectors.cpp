/// Projections along vectors with few entries, against dense algebra.
#include "../../src/solve/null_vectors.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <random>

namespace bough::test {
namespace {

using solve::NullVectors;
using solve::SparseRows;

/// A binary tree of groups in postorder; each has its own unknowns, where its vectors have the identity, and shares
/// others with a chain of groups below it.
struct Groups {
  static constexpr int levels = 5, own = 3, shared = 4;
  NullVectors vectors;
  Eigen::MatrixXd Z;
  Eigen::VectorXd weight;

  explicit Groups(double length) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> uniform(-1.0, 1.0);
    const int groups = (1 << levels) - 1, n = groups * (own + shared);
    Z = Eigen::MatrixXd::Zero(n, groups * own);
    weight = Eigen::VectorXd::NullaryExpr(n, [&] { return 1.0 + 0.5 * uniform(random); });
    SparseRows rows(NullVectors::most);
    rows.resize(n);
    int next = 0;
    const auto add = [&](auto&& self, int level) -> std::vector<int> {  // returns the groups of a way down
      std::vector<int> below;
      if (level + 1 < levels) {
        self(self, level + 1);
        below = self(self, level + 1);
      }
      const int g = next++, first = g * (own + shared);
      rows.clear();
      for (int v = 0; v < own; ++v) rows.at(first + v)[v] = Z(first + v, g * own + v) = 1.0;
      std::vector<int> overlapping = below;
      overlapping.push_back(g);
      for (const int other : overlapping)
        for (int k = 0; k < shared; ++k)
          for (int v = 0; v < own; ++v) {
            const int u = other * (own + shared) + own + k;
            rows.at(u)[v] = Z(u, g * own + v) = length * uniform(random);
          }
      vectors.add(g, own, rows, weight.data(), below);
      return overlapping;
    };
    add(add, 0);
  }
};

TEST(NullVectors, ProjectLikeDenseLeastSquares) {
  for (const double length : {1.0, 1e2, 1e4}) {
    Groups g(length);
    ASSERT_TRUE(g.vectors.factor());
    const Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(g.Z.rows(), -1.0, 2.0);
    Eigen::VectorXd projected = x;
    g.vectors.project([&](int u) { return projected(u) * g.weight(u) * g.weight(u); },
                      [&](int u, double part) { projected(u) -= part; });
    const Eigen::MatrixXd weighted = g.weight.asDiagonal() * g.Z;
    const Eigen::VectorXd c = weighted.colPivHouseholderQr().solve(g.weight.cwiseProduct(x));
    // Round-off times the condition of Z.
    EXPECT_LE((projected - (x - g.Z * c)).lpNorm<Eigen::Infinity>(), 1e-13 * length) << length;
    EXPECT_LE((weighted.transpose() * g.weight.cwiseProduct(projected)).lpNorm<Eigen::Infinity>(), 1e-11 * length)
        << length;
  }
}

TEST(NullVectors, ThatAgreeAreRefused) {
  SparseRows rows(NullVectors::most);
  rows.resize(8);
  NullVectors vectors;
  for (int g = 0; g < 2; ++g) {
    rows.clear();
    for (int u = 0; u < 8; ++u) rows.at(u)[0] = 1.0 + u;
    const std::vector<int> earlier(static_cast<std::size_t>(g), 0);
    vectors.add(g, 1, rows, nullptr, earlier);
  }
  EXPECT_FALSE(vectors.factor());
}

}  // namespace
}  // namespace bough::test
