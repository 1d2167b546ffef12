/// Dependent constraint rows: least multipliers against a complete orthogonal decomposition, what is reported, and
/// what is refused.
#include <gtest/gtest.h>

#include <algorithm>

#include "solving.hpp"

namespace bough::test {
namespace {

/// Beams between joints; some joints are said twice or three times. `again` receives the multiplier blocks that are
/// not unique.
Scene make_redundant(unsigned seed, int links, std::vector<int>& again, double step = 1e-3) {
  SceneMaker m(seed, step);
  int end = m.add_node();
  m.add_joint({end}, 6);
  for (int l = 0; l < links; ++l) {
    const int next = m.add_node();
    m.add_beam({end, next});
    end = m.add_node();
    const int multiplier = m.add_joint({next, end}, 5);
    if (l % 3 == 1) {
      again.push_back(multiplier);
      const int joint = m.last_element();
      again.push_back(m.add_joint_again(joint));
      if (l % 6 == 1) again.push_back(m.add_joint_again(joint));
    }
    m.add_body(end, 0.1);
  }
  std::sort(again.begin(), again.end());
  return m.finish("redundant");
}

/// A right-hand side in the range of the matrix.
Eigen::VectorXd consistent_rhs(const Solved& s, unsigned seed) {
  SceneMaker m(seed);
  const Eigen::MatrixXd A = s.scaled_dense();
  const Eigen::VectorXd b = A * m.uniform_matrix(static_cast<int>(A.rows()), 1).col(0);
  return b.cwiseQuotient(Eigen::Map<const Eigen::VectorXd>(s.solver.row_scale().data(), A.rows()));
}

int rank_deficiency(const Eigen::MatrixXd& A) { return static_cast<int>(A.rows()) - rank_of(A, 1e-11); }

TEST(DependentRows, SolutionHasLeastMultipliersAndUniqueMotion) {
  for (unsigned seed = 1; seed <= 4; ++seed)
    for (int leaf : {1, 3, 1000}) {
      std::vector<int> again;
      const Scene scene = make_redundant(seed, 8, again);
      Solved s(scene, {.leaf_size = leaf}, {});
      const auto status = s.factor();
      ASSERT_TRUE(status.ok());
      const Eigen::MatrixXd A = s.scaled_dense();
      EXPECT_EQ(status.deficiency, rank_deficiency(A));
      EXPECT_GT(status.deficiency, 0);
      const Eigen::VectorXd b = consistent_rhs(s, seed + 50), x = s.solve(b);
      EXPECT_LE(s.report.backward_error, 1e-14);
      EXPECT_LE(s.report.inconsistency, 1e-12);
      // Oracle: the null vectors have no motion part, so the least solution of all unknowns is the one of least
      // multipliers; the multipliers are measured against exact row norms, the scales are rounded: put the rounding
      // back before taking the least.
      const Eigen::VectorXd row = Eigen::Map<const Eigen::VectorXd>(s.solver.row_scale().data(), A.rows());
      const Eigen::VectorXd column = Eigen::Map<const Eigen::VectorXd>(s.solver.column_scale().data(), A.rows());
      const Eigen::VectorXd exact = exact_column_scale(s);
      const Eigen::MatrixXd rescaled = row.asDiagonal() * scene.dense() * exact.asDiagonal();
      const Eigen::VectorXd oracle = exact.cwiseProduct(least_solution(rescaled, row.cwiseProduct(b), 1e-11));
      EXPECT_LE(s.scaled_difference(x, oracle), 1e-9) << "seed " << seed << ", leaf " << leaf;
      EXPECT_EQ(s.solver.blocks_not_unique(), again);
      // The monolithic route gives the same.
      if (!solve::Monolithic::available()) continue;
      solve::Monolithic klu(scene.graph, s.tree);
      write_elements(scene, klu);
      ASSERT_TRUE(klu.factor(schedule::make_serial_walker()).ok());
      Eigen::VectorXd y(b.size());
      EXPECT_LE(klu.solve(schedule::make_serial_walker(), b.data(), y.data()).backward_error, 1e-12);
      EXPECT_LE(s.scaled_difference(y, oracle),
                1e-6);  // the regularisation 1e-10 over its smallest multiplier stiffness
    }
}

/// The same scene with each entry of the joints in `again` off by up to `by`, as where loops are nearly closed.
Scene loosened(Scene scene, const std::vector<int>& again, double by) {
  SceneMaker numbers(7);
  for (int e = 0; e < scene.graph.num_elements(); ++e) {
    const auto first = scene.graph.element_blocks.begin() + scene.graph.element_begin[static_cast<std::size_t>(e)],
               last = scene.graph.element_blocks.begin() + scene.graph.element_begin[static_cast<std::size_t>(e) + 1];
    if (std::none_of(first, last, [&](int b) { return std::binary_search(again.begin(), again.end(), b); })) continue;
    Eigen::MatrixXd& A = scene.elements[static_cast<std::size_t>(e)];
    A.array() *= 1.0 + by * numbers.uniform_matrix(static_cast<int>(A.rows()), static_cast<int>(A.cols())).array();
  }
  return scene;
}

TEST(DependentRows, ThatDependOnlyNearlyLeaveNoErrorInTheSolution) {
  for (unsigned seed = 1; seed <= 4; ++seed)
    for (double by : {1e-15, 1e-14, 1e-13, 1e-12, 1e-11})
      for (bool lanes : {false, true}) {
        SCOPED_TRACE(testing::Message() << "seed " << seed << ", off by " << by << ", lanes " << lanes);
        std::vector<int> again;
        const Scene exact_scene = make_redundant(seed, 8, again);
        Solved exact(exact_scene, {.leaf_size = 3}, {.lanes = lanes});
        const Scene loose = loosened(exact_scene, again, by);
        Solved s(loose, {.leaf_size = 3}, {.lanes = lanes});
        const int deficiency = exact.factor().deficiency;
        ASSERT_TRUE(s.factor().ok());
        EXPECT_EQ(s.solver.last_status().deficiency, deficiency);
        const Eigen::VectorXd b = consistent_rhs(s, seed + 50), x = s.solve(b), y = exact.solve(b);
        const double unknowns = static_cast<double>(b.size());
        EXPECT_LE(2.0 * s.report.backward_error, 30.0 * unknowns * 0x1p-53);
        EXPECT_LE(s.report.rank_error, 10.0 * by);
        EXPECT_LE(s.scaled_difference(x, y), 1e-6 + 1e6 * by) << "multipliers stay the least ones";
      }
}

TEST(DependentRows, LeastMultipliersDoNotDependOnUnits) {
  std::vector<int> again;
  const Scene scene = make_redundant(9, 5, again);
  // The same scene in other units of length: unknowns of one kind times c, multipliers' rows times d (not powers of
  // two).
  Scene other = scene;
  const auto first = scene.first_unknown();
  Eigen::VectorXd unit(scene.num_unknowns());
  for (int b = 0; b < scene.graph.num_blocks(); ++b)
    for (int i = 0; i < scene.graph.block_size[static_cast<std::size_t>(b)]; ++i)
      unit(first[static_cast<std::size_t>(b)] + i) =
          scene.graph.block_kind[static_cast<std::size_t>(b)] == blocks::BlockKind::multiplier ? 39.37
                                                                                               : (i < 3 ? 0.0254 : 1.0);
  for (int e = 0; e < scene.graph.num_elements(); ++e) {
    Eigen::VectorXd d(scene.elements[static_cast<std::size_t>(e)].rows());
    int k = 0;
    for (auto p = scene.graph.element_begin[static_cast<std::size_t>(e)];
         p < scene.graph.element_begin[static_cast<std::size_t>(e) + 1]; ++p) {
      const auto b = static_cast<std::size_t>(scene.graph.element_blocks[static_cast<std::size_t>(p)]);
      for (int i = 0; i < scene.graph.block_size[b]; ++i) d(k++) = unit(first[b] + i);
    }
    other.elements[static_cast<std::size_t>(e)] =
        d.asDiagonal() * scene.elements[static_cast<std::size_t>(e)] * d.asDiagonal();
  }
  Solved s(scene, {}, {}), t(other, {}, {});
  ASSERT_TRUE(s.factor().ok());
  ASSERT_TRUE(t.factor().ok());
  const Eigen::VectorXd b = consistent_rhs(s, 3);
  const Eigen::VectorXd x = s.solve(b), y = unit.cwiseProduct(t.solve(unit.cwiseProduct(b)));
  EXPECT_LE(s.scaled_difference(x, y), 1e-9);
}

TEST(DependentRows, InconsistentRightHandSideNamesAJointOfTheGroup) {
  std::vector<int> again;
  const Scene scene = make_redundant(2, 5, again);
  Solved s(scene, {}, {});
  ASSERT_TRUE(s.factor().ok());
  Eigen::VectorXd b = consistent_rhs(s, 1);
  const int row = scene.first_unknown()[static_cast<std::size_t>(again.back())];
  b(row) += 1.0 / s.solver.row_scale()[static_cast<std::size_t>(row)];
  s.solve(b);
  EXPECT_GT(s.report.inconsistency, 1e-3);
  EXPECT_TRUE(std::binary_search(again.begin(), again.end(), s.report.inconsistent_block))
      << s.report.inconsistent_block;
  EXPECT_GT(s.report.inconsistent_amount, 0.0);
}

TEST(DependentRows, RankMayChangeBetweenFactorizations) {
  std::vector<int> again;
  Scene scene = make_redundant(4, 4, again);
  Solved s(scene, {.leaf_size = 2}, {});
  ASSERT_TRUE(s.factor().ok());
  const int before = s.solver.last_status().deficiency;
  EXPECT_GT(before, 0);
  // The repeated joint becomes soft (its multipliers get a diagonal): no dependent rows any more; then rigid again.
  const auto first_again = scene.graph.element_begin;
  std::vector<Eigen::MatrixXd> rigid = scene.elements;
  for (int e = 0; e < scene.graph.num_elements(); ++e)
    for (auto k = first_again[static_cast<std::size_t>(e)]; k < first_again[static_cast<std::size_t>(e) + 1]; ++k) {
      const int b = scene.graph.element_blocks[static_cast<std::size_t>(k)];
      if (!std::binary_search(again.begin(), again.end(), b)) continue;
      const int rows = scene.graph.block_size[static_cast<std::size_t>(b)];
      scene.elements[static_cast<std::size_t>(e)].bottomRightCorner(rows, rows) -=
          1e-8 * Eigen::MatrixXd::Identity(rows, rows);
    }
  write_elements(scene, s.solver);
  ASSERT_TRUE(s.factor().ok());
  EXPECT_EQ(s.solver.last_status().deficiency, 0);
  scene.elements = rigid;
  write_elements(scene, s.solver);
  ASSERT_TRUE(s.factor().ok());
  EXPECT_EQ(s.solver.last_status().deficiency, before);
}

TEST(DependentRows, ARowWithoutEntriesIsDependentNotSingular) {
  SceneMaker m(1);
  const int a = m.add_node(), b = m.add_node();
  m.add_beam({a, b});
  m.add_joint({a, b}, 3);
  Scene scene = m.finish("empty row");
  auto& joint = scene.elements.back();
  joint.row(13).setZero();
  joint.col(13).setZero();
  Solved s(scene, {}, {});
  const auto status = s.factor();
  EXPECT_TRUE(status.ok());
  EXPECT_EQ(status.deficiency, 1);
  const Eigen::VectorXd x = s.solve(consistent_rhs(s, 1));
  EXPECT_EQ(x(13), 0.0);
}

}  // namespace
}  // namespace bough::test
