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
  for (const auto& i : s.solver.interfaces(schedule::make_serial_walker()))
    o.condition = std::max(o.condition, i.condition);
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

}  // namespace
}  // namespace bough::test
