/// Number of threads and timing never change a bit.
#include <gtest/gtest.h>

#include <cstring>

#include "bough/schedule/threads.hpp"
#include "loops.hpp"
#include "solving.hpp"

namespace bough::test {
namespace {

std::vector<double> run(const Scene& scene, const tree::Walker& walker, int leaf,
                        solve::Symmetry symmetry = solve::Symmetry::general) {
  Solved s(scene, {.leaf_size = leaf}, {.symmetry = symmetry, .refinement_steps = 2, .refinement_above = 0.0});
  EXPECT_TRUE(s.solver.factor(walker).ok());
  const Eigen::VectorXd b = s.random_rhs(5);
  std::vector<double> x(static_cast<std::size_t>(b.size()));
  const auto report = s.solver.solve(walker, b.data(), x.data());
  x.push_back(report.backward_error);
  x.push_back(s.solver.last_status().delayed_pivots);
  std::vector<double> y(x.size() - 2);
  s.solver.multiply(walker, x.data(), y.data());
  x.insert(x.end(), y.begin(), y.end());
  return x;
}

bool same_bits(const std::vector<double>& a, const std::vector<double>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0;
}

TEST(Threads, GiveTheSameBitsForAnyCountAndAnyTiming) {
  std::vector<Scene> scenes = make_all_families(41);
  scenes.push_back(make_chain(7, 20, 4));
  scenes.push_back(make_lattice(8, 7, 7));
  scenes.push_back(make_loops({.columns = 20, .long_bar = true}));  // many dependent rows
  for (const Scene& scene : scenes)
    for (int leaf : {0, 1, 5}) {
      const auto serial = run(scene, schedule::make_serial_walker(), leaf);
      for (int count : {1, 2, 3, 8}) {
        schedule::Threads threads(count, 0.0);  // grain 0: every sub-domain is a task
        EXPECT_TRUE(same_bits(serial, run(scene, threads.walker(), leaf))) << scene.name << " " << count;
        threads.set_random_delay(20, static_cast<unsigned>(count));
        EXPECT_TRUE(same_bits(serial, run(scene, threads.walker(), leaf))) << scene.name << " delayed " << count;
      }
    }
}

TEST(Threads, ShareLargeFrontsAndGiveTheSameBits) {
  Scene scene = make_lattice(9, 40, 40);
  using solve::Symmetry;
  for (const Symmetry symmetry : {Symmetry::general, Symmetry::symmetric}) {
    if (symmetry == Symmetry::symmetric)
      for (Eigen::MatrixXd& a : scene.elements) a = Eigen::MatrixXd(0.5 * (a + a.transpose()));
    const auto serial = run(scene, schedule::make_serial_walker(), 0, symmetry);
    for (int count : {2, 3}) {
      schedule::Threads threads(count);
      EXPECT_TRUE(same_bits(serial, run(scene, threads.walker(), 0, symmetry))) << count;
      threads.set_random_delay(20, static_cast<unsigned>(count));
      EXPECT_TRUE(same_bits(serial, run(scene, threads.walker(), 0, symmetry))) << "delayed " << count;
    }
  }
}

TEST(Threads, PrepareRunsOncePerLeafBeforeItsElementsAreUsed) {
  const Scene scene = make_chain(3, 12, 4);
  Solved reference(scene, {.leaf_size = 4}, {});
  ASSERT_TRUE(reference.factor().ok());
  schedule::Threads threads(3, 0.0);
  const tree::Tree tree = tree::make_tree(scene.graph, {.leaf_size = 4});
  solve::Hierarchical solver(scene.graph, tree);
  write_elements(scene, solver);
  ASSERT_TRUE(solver.factor(threads.walker()).ok());  // scales from the true matrices
  for (int e = 0; e < scene.graph.num_elements(); ++e)
    write_element(Eigen::MatrixXd::Zero(scene.elements[static_cast<std::size_t>(e)].rows(),
                                        scene.elements[static_cast<std::size_t>(e)].cols()),
                  solver.element(e));
  std::vector<int> seen(static_cast<std::size_t>(scene.graph.num_elements()), 0);
  const solve::SolverVisits visits = solver.visits();
  auto body = [&](int visit) {
    const auto v = static_cast<std::size_t>(visit);
    for (int p = visits.batch_begin[v]; p < visits.batch_begin[v + 1]; ++p)
      for (int e : solver.batches()[static_cast<std::size_t>(p)].element) {
        if (e < 0) continue;
        ++seen[static_cast<std::size_t>(e)];
        write_element(scene.elements[static_cast<std::size_t>(e)], solver.element(e));
      }
  };
  ASSERT_TRUE(solver.factor(threads.walker(), solve::make_visit_work(body)).ok());
  for (int count : seen) EXPECT_EQ(count, 1);
  const Eigen::VectorXd b = reference.random_rhs(1);
  Eigen::VectorXd x(b.size());
  (void)solver.solve(threads.walker(), b.data(), x.data());
  EXPECT_EQ(reference.solve(b), x);
}

}  // namespace
}  // namespace bough::test
