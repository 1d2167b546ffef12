/// The hierarchical solution against dense LU with full pivoting, over scenes, leaf sizes and depths.
#include <gtest/gtest.h>

#include <algorithm>

#include "solving.hpp"

namespace bough::test {
namespace {

// Forward errors are judged in scaled variables against eps * condition; backward errors need no condition number.
constexpr double backward_bar = 5e-15;  // some eps; the growth that a threshold of 1e-3 allows is not met in practice

TEST(Solve, MatchesDenseLuForEveryLeafSizeOnEveryFamily) {
  for (const Scene& scene : make_all_families(11)) {
    const int elements = scene.graph.num_elements();
    for (int leaf = 1; leaf <= elements; leaf = leaf < 6 ? leaf + 1 : leaf + std::max(1, elements / 7))
      expect_matches_dense(scene, {.leaf_size = leaf}, backward_bar);
    expect_matches_dense(scene, {.leaf_size = elements}, backward_bar);
  }
}

TEST(Solve, MatchesDenseLuForEveryDepth) {
  for (const Scene& scene : make_all_families(23))
    for (int depth = 0; depth <= 6; ++depth) expect_matches_dense(scene, {.depth = depth}, backward_bar);
}

TEST(Solve, MatchesDenseLuOnManySeedsWithLeavesOfOneElement) {
  for (unsigned seed = 100; seed < 112; ++seed)
    for (const Scene& scene : make_all_families(seed)) expect_matches_dense(scene, {.leaf_size = 1}, backward_bar);
}

TEST(Solve, MatchesDenseLuOnALargerLattice) { expect_matches_dense(make_lattice(5, 8, 9), {}, backward_bar); }

TEST(Solve, HandlesSizesZeroToThree) {
  expect_matches_dense(SceneMaker(1).finish("empty"), {}, backward_bar);
  for (int n = 1; n <= 3; ++n) {
    SceneMaker m(static_cast<unsigned>(n));
    m.add_body(m.add_node(n));
    expect_matches_dense(m.finish("one"), {}, backward_bar);
  }
}

TEST(Solve, MultiplyIsTheAssembledMatrix) {
  for (const Scene& scene : make_all_families(3)) {
    Solved s(scene, {}, {});
    const Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(scene.num_unknowns(), -1.0, 2.0);
    Eigen::VectorXd y(x.size());
    s.solver.multiply(schedule::make_serial_walker(), x.data(), y.data());
    const Eigen::MatrixXd A = scene.dense();
    // each entry: rounding of its own row sum
    EXPECT_TRUE(((y - A * x).array().abs() <= 1e-13 * (A.cwiseAbs() * x.cwiseAbs()).array() + 1e-300).all())
        << scene.name;
  }
}

TEST(Solve, MonolithicGivesTheSameSolution) {
  if (!solve::Monolithic::available()) GTEST_SKIP() << "built without KLU";
  for (const Scene& scene : make_all_families(31)) {
    Solved s(scene, {}, {});
    ASSERT_TRUE(s.factor().ok());
    const Eigen::VectorXd b = s.random_rhs(7), x = s.solve(b);
    solve::Monolithic klu(scene.graph, s.tree);
    write_elements(scene, klu);
    ASSERT_TRUE(klu.factor(schedule::make_serial_walker()).ok());
    Eigen::VectorXd y(b.size());
    const auto report = klu.solve(schedule::make_serial_walker(), b.data(), y.data());
    EXPECT_LE(report.backward_error, backward_bar) << scene.name;
    EXPECT_LE(s.scaled_difference(x, y), 1e-9) << scene.name;  // eps times a condition number of up to 1e6
  }
}

}  // namespace
}  // namespace bough::test
