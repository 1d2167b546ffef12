/// The promise of the method: the condition of the interface flexibility tends to one as the penalty grows, and no
/// digit is paid for it.
#include <gtest/gtest.h>

#include "solving.hpp"

namespace bough::test {
namespace {

struct Outcome {
  double condition = 0.0, error = 0.0, backward = 0.0;
};

Outcome run(const Scene& scene, double factor, solve::Elimination elimination) {
  Solved s(scene, {.leaf_size = 6}, {.elimination = elimination, .penalty_factor = factor, .refinement_steps = 0});
  EXPECT_TRUE(s.factor().ok());
  Outcome o;
  for (const auto& i : s.solver.interfaces()) o.condition = std::max(o.condition, i.condition);
  Solved reference(scene, {.depth = 0}, {});
  EXPECT_TRUE(reference.factor().ok());
  const Eigen::VectorXd b = s.random_rhs(3);
  o.error = s.scaled_difference(s.solve(b), reference.solve(b));
  o.backward = s.report.backward_error;
  return o;
}

TEST(Penalty, FlatEliminationDoesNotDependOnThePenalty) {
  const Scene scene = make_chain(3, 6, 6);
  const double error = run(scene, 1.0, solve::Elimination::flat).error;
  for (double factor = 1e-6; factor < 2e12; factor *= 1e3) {
    const Outcome o = run(scene, factor, solve::Elimination::flat);
    EXPECT_EQ(o.error, error) << factor;     // bitwise: P is never added
    EXPECT_LE(o.backward, 2e-15) << factor;  // a few roundings an entry, 1.3e-15 measured
  }
}

TEST(Penalty, ConditionOfTheScaledFlexibilityTendsToOne) {
  const Scene scene = make_chain(4, 1, 40);  // one flexible body: no multipliers at interfaces
  double last = std::numeric_limits<double>::infinity();
  for (double factor = 1e-6; factor < 2e12; factor *= 1e3) {
    const double condition = run(scene, factor, solve::Elimination::flat).condition;
    EXPECT_LE(condition, last * (1.0 + 1e-6)) << factor;
    last = condition;
    // S is between 0 and a few times its own diagonal, so F P is between 1 / (1 + c / factor) and 1.
    if (factor < 1e6) continue;
    EXPECT_LE(condition, 1.0 + 20.0 / factor + 1e-9) << factor;
  }
  EXPECT_LE(last, 1.0 + 1e-9);
}

TEST(Penalty, AugmentedEliminationIsTheSameOnPaperAndLosesADigitPerDecade) {
  const Scene scene = make_chain(3, 6, 6);
  const Outcome flat = run(scene, 1.0, solve::Elimination::flat);
  EXPECT_LE(run(scene, 1.0, solve::Elimination::augmented).error, 1e4 * (flat.error + 1e-16));
  const double error_6 = run(scene, 1e6, solve::Elimination::augmented).backward;
  const double error_12 = run(scene, 1e12, solve::Elimination::augmented).backward;
  EXPECT_GT(error_12, 1e3 * error_6);  // six decades of penalty cost at least three digits (in the mean six)
  EXPECT_GT(error_12, 1e6 * flat.backward);
}

TEST(Penalty, LocalMultipliersAreTheForcesBetweenSubdomains) {
  // At every node of the interface mesh the local multipliers of all sub-domains that meet there and the loads that
  // were applied above balance: sum_i L_i^T l_i = 0 for an interior load. Here: the two children of the root, loads
  // inside the leaves only.
  const Scene scene = make_chain(5, 1, 24);
  Solved s(scene, {.depth = 1}, {.multiplier_scale = 4.0});
  ASSERT_TRUE(s.factor().ok());
  const auto& root = s.tree.subdomains.back();
  const auto children = s.tree.children(root);
  ASSERT_EQ(children.size(), 2u);
  const auto shared = s.tree.boundary_blocks(
      s.tree.fronts[static_cast<std::size_t>(s.tree.subdomains[static_cast<std::size_t>(children[0])].top())]);
  ASSERT_EQ(shared.size(), 1u);
  Eigen::VectorXd b = s.random_rhs(2);
  const int first = scene.first_unknown()[static_cast<std::size_t>(shared[0])];
  b.segment(first, 6).setZero();
  const Eigen::VectorXd x = s.solve(b);
  const auto l0 = s.solver.local_multipliers(children[0], b.data()),
             l1 = s.solver.local_multipliers(children[1], b.data());
  // Oracle: the residual of the elements of one side alone at the shared node.
  Eigen::VectorXd force = Eigen::VectorXd::Zero(6);
  for (int e : s.tree.elements(s.tree.subdomains[static_cast<std::size_t>(children[0])])) {
    const auto& a = scene.elements[static_cast<std::size_t>(e)];
    Eigen::VectorXd xe(a.cols());
    int k = 0, at = -1;
    for (auto p = scene.graph.element_begin[static_cast<std::size_t>(e)];
         p < scene.graph.element_begin[static_cast<std::size_t>(e) + 1]; ++p) {
      const auto blk = static_cast<std::size_t>(scene.graph.element_blocks[static_cast<std::size_t>(p)]);
      if (static_cast<int>(blk) == shared[0]) at = k;
      for (int i = 0; i < scene.graph.block_size[blk]; ++i) xe(k++) = x(scene.first_unknown()[blk] + i);
    }
    if (at >= 0) force -= a.middleRows(at, 6) * xe;
  }
  const double size = force.lpNorm<Eigen::Infinity>();
  for (int i = 0; i < 6; ++i) {
    EXPECT_NEAR(4.0 * l0[static_cast<std::size_t>(i)], force(i), 1e-10 * size);
    EXPECT_NEAR(l0[static_cast<std::size_t>(i)] + l1[static_cast<std::size_t>(i)], 0.0, 1e-10 * size);
  }
}

}  // namespace
}  // namespace bough::test
