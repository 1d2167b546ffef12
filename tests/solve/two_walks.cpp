/// A caller's work in the visits of the two walks of a solution: on the way up it may write what a visit reads, on the
/// way down it may read what the visit has solved for. Neither changes a bit.
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <limits>

#include "bough/schedule/threads.hpp"
#include "loops.hpp"
#include "solving.hpp"

namespace bough::test {
namespace {

/// The unknowns that each visit eliminates.
std::vector<std::vector<int>> unknowns_by_visit(const Solved& s, const solve::SolverVisits& visits) {
  std::vector<std::vector<int>> unknowns(static_cast<std::size_t>(visits.count()));
  for (std::size_t b = 0; b < visits.of_block.size(); ++b)
    for (auto u = s.tree.unknown_begin[b]; u < s.tree.unknown_begin[b + 1]; ++u)
      unknowns[static_cast<std::size_t>(visits.of_block[b])].push_back(static_cast<int>(u));
  return unknowns;
}

/// Two walks with work in all visits.
class TwoWalks {
 public:
  TwoWalks(Solved& s, const tree::Walker& walker)
      : s_(s), walker_(walker), visits_(s.solver.visits()), unknowns_(unknowns_by_visit(s, visits_)) {}

  /// The solution for b. Before a visit its entries of the right-hand side are not numbers.
  Eigen::VectorXd solve(const Eigen::VectorXd& b, bool factor, bool check) {
    constexpr double none = std::numeric_limits<double>::quiet_NaN();
    Eigen::VectorXd rhs = Eigen::VectorXd::Constant(b.size(), none), x = rhs, seen = rhs;
    std::vector<std::atomic<int>> up(unknowns_.size()), down(unknowns_.size());
    auto before = [&](int visit) {
      const auto v = static_cast<std::size_t>(visit);
      for (std::size_t below = 0; below < v; ++below)
        if (visits_.parent[below] == visit) {
          EXPECT_EQ(up[below], 1) << below;
        }
      ++up[v];
      for (const int u : unknowns_[v]) rhs[u] = b[u];
      if (factor)
        for (int k = visits_.batch_begin[v]; k < visits_.batch_begin[v + 1]; ++k)
          for (const int e : s_.solver.batches()[static_cast<std::size_t>(k)].element)
            if (e >= 0) write_element(s_.scene.elements[static_cast<std::size_t>(e)], s_.solver.element(e));
    };
    auto after = [&](int visit) {
      const auto v = static_cast<std::size_t>(visit);
      if (visits_.parent[v] >= 0) {
        EXPECT_EQ(down[static_cast<std::size_t>(visits_.parent[v])], 1);
      }
      ++down[v];
      for (const int u : unknowns_[v]) seen[u] = x[u];
    };
    if (factor)
      EXPECT_TRUE(s_.solver.factor(walker_, solve::make_visit_work(before), rhs.data()).ok());
    else
      s_.solver.condense(walker_, solve::make_visit_work(before), rhs.data());
    s_.report = s_.solver.substitute(walker_, rhs.data(), x.data(), check, solve::make_visit_work(after));
    for (std::size_t v = 0; v < up.size(); ++v) {
      EXPECT_EQ(up[v], 1) << v;
      EXPECT_EQ(down[v], 1) << v;
    }
    EXPECT_TRUE(same_bits(seen, x));
    return x;
  }

 private:
  Solved& s_;
  tree::Walker walker_;
  solve::SolverVisits visits_;
  std::vector<std::vector<int>> unknowns_;
};

void spoil_elements(Solved& s) {
  for (int e = 0; e < s.scene.graph.num_elements(); ++e) {
    const Eigen::MatrixXd& a = s.scene.elements[static_cast<std::size_t>(e)];
    write_element(Eigen::MatrixXd::Constant(a.rows(), a.cols(), 3.0), s.solver.element(e));
  }
}

TEST(TwoWalks, give_the_bits_of_a_solution_with_work_in_all_visits) {
  std::vector<Scene> scenes = make_all_families(17);
  scenes.push_back(make_chain(3, 40, 4));
  scenes.push_back(make_loops({.columns = 6}));  // dependent rows
  for (const Scene& scene : scenes)
    for (const int leaf : {0, 3, 1000})
      for (const int threads : {1, 3}) {
        SCOPED_TRACE(scene.name + ", leaves of " + std::to_string(leaf) + ", threads " + std::to_string(threads));
        const schedule::Threads pool(threads, 0.0);
        Solved s(scene, {.leaf_size = leaf}, {});
        ASSERT_TRUE(s.factor().ok());
        const Eigen::VectorXd b = s.random_rhs(3), c = s.random_rhs(4);
        const Eigen::VectorXd x = s.solve(b);
        const solve::SolveReport report = s.report;
        const Eigen::VectorXd y = s.solve(c);
        TwoWalks walks(s, pool.walker());
        for (const bool check : {true, false}) {
          EXPECT_TRUE(same_bits(walks.solve(b, false, check), x));
          if (check) {
            EXPECT_EQ(s.report.backward_error, report.backward_error);
            EXPECT_EQ(s.report.inconsistency, report.inconsistency);
          }
          spoil_elements(s);
          EXPECT_TRUE(same_bits(walks.solve(c, true, check), y));
        }
        spoil_elements(s);
        s.solver.rescale();  // takes all matrices, so that they are evaluated in a walk of their own
        EXPECT_TRUE(same_bits(walks.solve(b, true, true), x));
      }
}

/// A solution with another right-hand side in between does not spoil a later one.
TEST(TwoWalks, a_right_hand_side_is_condensed_again_after_another_solution) {
  const Scene scene = make_chain(3, 12, 3);
  Solved s(scene, {.leaf_size = 4}, {});
  ASSERT_TRUE(s.factor().ok());
  const Eigen::VectorXd b = s.random_rhs(3), x = s.solve(b);
  const tree::Walker walker = schedule::make_serial_walker();
  auto nothing = [](int) {};
  s.solver.condense(walker, solve::make_visit_work(nothing), b.data());
  s.solve(s.random_rhs(4));
  Eigen::VectorXd again(b.size());
  s.solver.substitute(walker, b.data(), again.data(), false);
  EXPECT_TRUE(same_bits(again, x));
}

}  // namespace
}  // namespace bough::test
