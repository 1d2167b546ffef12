/// The promises of the method: the condition of the interface flexibility tends to one as the penalty grows; the form
/// that is eliminated flat pays nothing for it, the form as it is written a digit for each decade.
#include <gtest/gtest.h>

#include "bough/solve/augmented.hpp"
#include "solving.hpp"

namespace bough::test {
namespace {

struct Outcome {
  double error = 0.0, backward = 0.0;
  std::vector<solve::InterfaceReport> interfaces;
  double condition() const {
    double most = 1.0;
    for (const solve::InterfaceReport& i : interfaces) most = std::max(most, i.condition);
    return most;
  }
};

/// Factors and solves; the error is that against one sub-domain.
template <class Solver>
Outcome run(const Scene& scene, const tree::TreeOptions& tree_options, const solve::SolveOptions& options) {
  const tree::Tree tree = tree::make_tree(scene.graph, tree_options);
  const tree::Walker walker = schedule::make_serial_walker();
  Solver solver(scene.graph, tree, options);
  write_elements(scene, solver);
  EXPECT_TRUE(solver.factor(walker).ok()) << scene.name;
  Solved reference(scene, {.depth = 0}, {});
  EXPECT_TRUE(reference.factor().ok()) << scene.name;
  EXPECT_EQ(solver.last_status().deficiency, reference.solver.last_status().deficiency) << scene.name;
  const Eigen::VectorXd b = reference.random_rhs(3);
  Eigen::VectorXd x(b.size());
  Outcome o;
  o.backward = solver.solve(walker, b.data(), x.data()).backward_error;
  o.error = reference.scaled_difference(x, reference.solve(b));
  if constexpr (std::is_same_v<Solver, solve::Augmented>)
    o.interfaces = solver.interfaces(300);
  else
    o.interfaces = solver.interfaces(walker);
  return o;
}

TEST(Penalty, FlatEliminationDoesNotDependOnThePenalty) {
  const Scene scene = make_chain(3, 6, 6);
  const tree::TreeOptions cut{.leaf_size = 6};
  const double error = run<solve::Hierarchical>(scene, cut, {.refinement_steps = 0}).error;
  for (double factor = 1e-6; factor < 2e12; factor *= 1e3) {
    const Outcome o = run<solve::Hierarchical>(scene, cut, {.penalty_factor = factor, .refinement_steps = 0});
    EXPECT_EQ(o.error, error) << factor;     // bitwise: P is never added
    EXPECT_LE(o.backward, 2e-15) << factor;  // a few roundings an entry, 1.3e-15 measured
  }
}

TEST(Penalty, ConditionOfTheScaledFlexibilityTendsToOne) {
  const Scene scene = make_chain(4, 1, 40);  // one flexible body
  double last = std::numeric_limits<double>::infinity();
  for (double factor = 1e-6; factor < 2e12; factor *= 1e3) {
    const solve::SolveOptions options{.penalty_factor = factor};
    const double condition = run<solve::Augmented>(scene, {.leaf_size = 6}, options).condition();
    const double of_local = run<solve::Hierarchical>(scene, {.leaf_size = 6}, options).condition();
    EXPECT_LE(condition, last * (1.0 + 1e-6)) << factor;
    if (factor < 1e3) {
      EXPECT_NEAR(of_local / condition, 1.0, 1e-6) << factor << ": both report the same flexibility";
    }
    last = condition;
    // S is between 0 and a few times its own diagonal, so F P is between 1 / (1 + c / factor) and 1.
    if (factor < 1e6) continue;
    EXPECT_LE(condition, 1.0 + 20.0 / factor + 1e-9) << factor;
  }
  EXPECT_LE(last, 1.0 + 1e-9);
}

/// Chains, lattices, loops, joints between nodes alone: every family, cut finely.
TEST(Penalty, AugmentedSubdomainsGiveTheSolution) {
  for (unsigned seed : {1u, 2u, 41u})
    for (const Scene& scene : make_all_families(seed, 1e-3)) {
      SCOPED_TRACE(scene.name + ", seed " + std::to_string(seed));
      Solved whole(scene, {.depth = 0}, {});
      ASSERT_TRUE(whole.factor().ok());
      const Outcome flat = run<solve::Hierarchical>(scene, {.leaf_size = 3}, {});
      const double round_off =
          whole.solver.last_status().deficiency > 0 ? 1e-12 : 0x1p-53 * condition_of(whole.scaled_dense());
      for (const double factor : {1e-3, 1.0, 1e3}) {
        const Outcome o = run<solve::Augmented>(scene, {.leaf_size = 3}, {.penalty_factor = factor});
        EXPECT_LE(o.error, 100.0 * std::max(flat.error, round_off)) << factor;
        EXPECT_LE(o.backward, 1e-14) << factor;
      }
    }
}

/// With P = |diag S| the eigenvalues of P^-1/2 S P^-1/2 are between 0 and the number of unknowns n, where S is symmetric
/// and definite, and those of P^1/2 F P^1/2 between 1 / (1 + n) and 1.
TEST(Penalty, FlexibilitiesAreWellConditionedWithTheInterfacesOwnStiffness) {
  double worst = 1.0;
  int seen = 0, all = 0;
  for (unsigned seed : {1u, 2u, 41u})
    for (const Scene& general : make_all_families(seed, 1e-3)) {
      const Scene scene = make_symmetric(general);
      SCOPED_TRACE(scene.name + ", seed " + std::to_string(seed));
      for (const solve::InterfaceReport& i : run<solve::Augmented>(scene, {.leaf_size = 3}, {}).interfaces) {
        ++all;
        if (!i.is_definite) continue;
        EXPECT_LE(i.condition, i.num_unknowns + 1.0 + 1e-9) << i.num_unknowns << " unknowns";
        worst = std::max(worst, i.condition);
        ++seen;
      }
    }
  std::printf("| %d of %d interfaces definite | condition of P^1/2 F P^1/2 at most %.2f |\n", seen, all, worst);
  EXPECT_GT(seen, all / 2);
}

TEST(Penalty, AugmentedSubdomainsLoseADigitPerDecade) {
  const Scene scene = make_chain(3, 6, 6);
  const auto backward = [&](double factor) {
    return run<solve::Augmented>(scene, {.leaf_size = 6}, {.penalty_factor = factor, .refinement_steps = 0}).backward;
  };
  const double error_0 = backward(1.0), error_6 = backward(1e6), error_12 = backward(1e12);
  std::printf("| penalty factor 1, 1e6, 1e12 | backward error %.1e, %.1e, %.1e |\n", error_0, error_6, error_12);
  EXPECT_LT(error_0, 1e-14);
  EXPECT_GT(error_12, 1e3 * error_6);  // six decades of penalty cost at least three digits (in the mean six)
  EXPECT_LT(error_12, 1e-2);
}

}  // namespace
}  // namespace bough::test
