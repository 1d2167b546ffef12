/// Chains of rigid bodies whose masses differ by up to 1e12: no row depends, and the solution is that of extended
/// precision. Rows that do depend are found among them.
#include <gtest/gtest.h>

#include <cstdio>

#include "solving.hpp"

namespace bough::test {
namespace {

Scene make_uneven_chain(unsigned seed, int links, int rows, double decades, bool with_copy) {
  SceneMaker m(seed, 1e-3);
  int last = -1;
  for (int l = 0; l < links; ++l) {
    const int body = m.add_node();
    if (last < 0)
      m.add_joint({body}, 5);
    else
      m.add_joint({last, body}, rows);
    if (with_copy && l == links / 2) m.add_joint_again(m.last_element(), 2);
    m.add_body(body, std::pow(10.0, m.uniform(-decades, 0.0)));
    last = body;
  }
  return m.finish("uneven rigid chain");
}

/// Largest difference to a refined solution in extended precision, in scaled variables over the largest.
double error_of(Solved& s, const Eigen::VectorXd& b, const Eigen::VectorXd& x) {
  using Matrix = Eigen::Matrix<long double, Eigen::Dynamic, Eigen::Dynamic>;
  using Vector = Eigen::Matrix<long double, Eigen::Dynamic, 1>;
  const auto n = static_cast<Eigen::Index>(x.size());
  const Eigen::Map<const Eigen::VectorXd> rows(s.solver.row_scale().data(), n),
      columns(s.solver.column_scale().data(), n);
  const Matrix A = s.scaled_dense().cast<long double>();
  const Vector scaled = b.cwiseProduct(rows).cast<long double>();
  const Eigen::PartialPivLU<Matrix> lu(A);
  Vector exact = lu.solve(scaled);
  exact += lu.solve(scaled - A * exact);
  const Vector mine = x.cwiseQuotient(columns).cast<long double>();
  return static_cast<double>((mine - exact).cwiseAbs().maxCoeff() / exact.cwiseAbs().maxCoeff());
}

TEST(LightBodies, no_row_of_a_chain_looks_dependent_whatever_its_masses) {
  for (const int rows : {5, 6})
    for (const double decades : {0.0, 4.0, 8.0, 12.0}) {
      double worst = 0.0, backward = 0.0;
      for (unsigned seed = 100; seed < 140; ++seed) {
        const Scene scene = make_uneven_chain(seed, 4 + static_cast<int>(seed % 12), rows, decades, false);
        Solved s(scene, {}, {});
        const solve::FactorStatus status = s.factor();
        ASSERT_TRUE(status.ok()) << rows << " rows, 1e-" << decades << ", seed " << seed;
        EXPECT_EQ(status.deficiency, 0) << rows << " rows, 1e-" << decades << ", seed " << seed;
        const Eigen::VectorXd b = s.random_rhs(3);
        worst = std::max(worst, error_of(s, b, s.solve(b)) / condition_of(s.scaled_dense()));
        backward = std::max(backward, s.report.backward_error);
      }
      std::printf("  %d rows, masses from 1e-%g: error over condition %.1e, backward error %.1e\n", rows, decades,
                  worst, backward);
      EXPECT_LE(worst, 1e-14) << decades;
      EXPECT_LE(backward, 1e-14) << decades;
    }
}

TEST(LightBodies, rows_that_do_depend_are_found_among_them) {
  for (const double decades : {0.0, 4.0, 8.0, 12.0})
    for (unsigned seed = 100; seed < 130; ++seed) {
      const Scene scene = make_uneven_chain(seed, 4 + static_cast<int>(seed % 12), 5, decades, true);
      Solved s(scene, {}, {});
      const solve::FactorStatus status = s.factor();
      ASSERT_TRUE(status.ok()) << "1e-" << decades << ", seed " << seed;
      EXPECT_EQ(status.deficiency, 2) << "1e-" << decades << ", seed " << seed;
    }
}

}  // namespace
}  // namespace bough::test
