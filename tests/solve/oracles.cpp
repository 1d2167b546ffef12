/// The monolithic oracles beside KLU give the hierarchical solution, say what they cannot do, and agree where rows
/// depend.
#include <gtest/gtest.h>

#include "bough/solve/any_solver.hpp"
#include "solving.hpp"

namespace bough::test {
namespace {

using solve::Library;

std::vector<Library> available_libraries() {
  std::vector<Library> list;
  for (const Library l : {Library::sparse_lu, Library::umfpack, Library::cholmod})
    if (solve::SparseOracle::available(l)) list.push_back(l);
  return list;
}

/// CHOLMOD solves symmetric matrices only.
Scene suited(Scene scene, Library library) {
  if (library == Library::cholmod)
    for (Eigen::MatrixXd& e : scene.elements) e = (0.5 * (e + e.transpose())).eval();
  return scene;
}

Scene make_redundant_pair(unsigned seed) {
  SceneMaker m(seed);
  const int a = m.add_node(), b = m.add_node(), c = m.add_node();
  m.add_joint({a}, 6);
  m.add_beam({a, b});
  m.add_joint({b, c}, 5);
  m.add_joint_again(m.last_element());
  m.add_body(c);
  return m.finish("redundant pair");
}

TEST(Oracles, SparseLuIsAlwaysThere) { EXPECT_TRUE(solve::SparseOracle::available(Library::sparse_lu)); }

TEST(Oracles, GiveTheHierarchicalSolution) {
  for (const Library library : available_libraries())
    for (const double step : {1e-2, 1e-3})
      for (const Scene& raw : make_all_families(41, step)) {
        const Scene scene = suited(raw, library);
        const std::string what = scene.name + ", " + std::string(solve::SparseOracle::name_of(library));
        Solved s(scene, {}, {});
        ASSERT_TRUE(s.factor().ok()) << what;
        const Eigen::VectorXd b = s.random_rhs(7), x = s.solve(b);
        solve::AnySolver oracle(solve::SparseOracle(scene.graph, s.tree, library));
        write_elements(scene, oracle);
        ASSERT_TRUE(oracle.factor(schedule::make_serial_walker()).ok()) << what;
        Eigen::VectorXd y(b.size());
        const auto report = oracle.solve(schedule::make_serial_walker(), b.data(), y.data());
        // CHOLMOD converges slowly where constraints are soft (the tree: a condition of 1e8).
        EXPECT_LE(report.backward_error, library == Library::cholmod ? 1e-12 : 1e-14) << what;
        EXPECT_LE(s.scaled_difference(x, y), condition_of(s.scaled_dense()) * (report.backward_error + 1e-15)) << what;
      }
}

TEST(Oracles, DependentRowsGiveLeastMultipliers) {
  for (const Library library : available_libraries()) {
    const Scene scene = suited(make_redundant_pair(3), library);
    Solved s(scene, {}, {});
    ASSERT_TRUE(s.factor().ok());
    ASSERT_EQ(s.solver.last_status().deficiency, 5);
    const Eigen::MatrixXd A = s.scaled_dense();
    const Eigen::VectorXd row = Eigen::Map<const Eigen::VectorXd>(s.solver.row_scale().data(), A.rows());
    const Eigen::VectorXd b = (A * SceneMaker(5).uniform_matrix(scene.num_unknowns(), 1).col(0)).cwiseQuotient(row);
    const Eigen::VectorXd x = s.solve(b);
    solve::SparseOracle oracle(scene.graph, s.tree, library);
    write_elements(scene, oracle);
    const auto status = oracle.factor(schedule::make_serial_walker());
    ASSERT_TRUE(status.ok());
    EXPECT_EQ(status.deficiency, -1);
    Eigen::VectorXd y(b.size());
    const auto report = oracle.solve(schedule::make_serial_walker(), b.data(), y.data());
    EXPECT_LE(report.backward_error, 1e-13);
    EXPECT_EQ(report.inconsistency, 0.0);
    EXPECT_LE(s.scaled_difference(y, x), 1e-5);  // some eps / d^2 in the null directions, d^2 >= 1e-10
    Eigen::VectorXd contradicting = b;           // the two copies of the joint disagree
    contradicting(scene.num_unknowns() - 1) += 1.0 / row(scene.num_unknowns() - 1);
    EXPECT_GT(oracle.solve(schedule::make_serial_walker(), contradicting.data(), y.data()).inconsistency, 1e-8);
  }
}

TEST(Oracles, AFloatingStructureIsSingularAndNamed) {
  for (const Library library : available_libraries()) {
    SceneMaker m(4, 0.0);
    const int a = m.add_node(), b = m.add_node(), c = m.add_node(), d = m.add_node();
    m.add_joint({a}, 6);
    m.add_beam({a, b}, 0.0);
    m.add_beam({c, d}, 0.0);
    const Scene scene = m.finish("floating");
    Solved s(scene, {}, {});
    solve::SparseOracle oracle(scene.graph, s.tree, library);
    write_elements(scene, oracle);
    const auto status = oracle.factor(schedule::make_serial_walker());
    EXPECT_EQ(status.outcome, solve::FactorOutcome::singular);
    EXPECT_TRUE(status.block == c || status.block == d) << status.block;
  }
}

TEST(Oracles, WhatIsMissingOrUnsuitedIsTold) {
  const Scene scene = make_chain(1, 2, 2);  // a few per cent unsymmetric
  Solved s(scene, {}, {});
  for (const Library library : {Library::umfpack, Library::cholmod}) {
    solve::SparseOracle oracle(scene.graph, s.tree, library);
    write_elements(scene, oracle);
    const auto outcome = oracle.factor(schedule::make_serial_walker()).outcome;
    if (!solve::SparseOracle::available(library)) {
      EXPECT_EQ(outcome, solve::FactorOutcome::backend);
    } else if (library == Library::cholmod) {
      EXPECT_EQ(outcome, solve::FactorOutcome::unsymmetric);
    } else {
      EXPECT_EQ(outcome, solve::FactorOutcome::ok);
    }
  }
}

}  // namespace
}  // namespace bough::test
