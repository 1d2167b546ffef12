/// Scaled variables: the condition number does not grow as the time step falls, and units do not matter.
#include <gtest/gtest.h>

#include <algorithm>

#include "solving.hpp"

namespace bough::test {
namespace {

TEST(Scaling, ConditionIsConstantBelowTheSmallestPeriod) {
  // The beams' fastest period is about 2 pi sqrt(0.1 / 1e8) = 2e-4 s.
  double reference = 0.0;
  for (double step = 1e-5; step > 1e-12; step *= 0.1) {
    const Scene scene = make_chain(1, 4, 3, step);
    Solved s(scene, {}, {});
    ASSERT_TRUE(s.factor().ok());
    const double condition = condition_of(s.scaled_dense());
    if (reference == 0.0) reference = condition;
    EXPECT_LE(condition, 2.0 * reference) << step;
    EXPECT_GE(condition, 0.5 * reference) << step;
    const Eigen::VectorXd b = s.random_rhs(1);
    s.solve(b);
    EXPECT_LE(s.report.backward_error, 1e-15) << step;
  }
  EXPECT_LE(reference, 1e4);
}

/// Products of numbers below the normal range have absolute errors of a unit in the last place of the smallest number,
/// which no solution can avoid: a small right-hand side is no reason to doubt it.
TEST(Scaling, ARightHandSideOfDenormalNumbersIsSolvedAsWellAsItCanBe) {
  for (const Scene& scene : make_all_families(3u, 1e-3)) {
    Solved s(scene, {}, {});
    ASSERT_TRUE(s.factor().ok()) << scene.name;
    const Eigen::VectorXd b = s.random_rhs(1);
    for (const double factor : {1e-290, 1e-300, 1e-310, 1e-320}) {
      s.solve(factor * b);
      EXPECT_LE(s.report.backward_error, 1e-13) << scene.name << ", " << factor;
      EXPECT_TRUE(s.report.finite);
    }
  }
}

/// All families, nodes between joints alone among them (the root of the tree of seed 42). At 1e-2 s stiffness rules,
/// below 1e-5 s inertia.
TEST(Scaling, ConditionDoesNotGrowAsTheStepFallsInAnyFamily) {
  for (unsigned seed : {2u, 41u, 60u}) {
    std::vector<double> most;  // at longer steps
    for (double step = 1e-2; step > 0.9e-9; step *= 0.1) {
      const std::vector<Scene> scenes = make_all_families(seed, step);
      most.resize(scenes.size(), 0.0);
      for (std::size_t f = 0; f < scenes.size(); ++f) {
        Solved s(scenes[f], {}, {});
        ASSERT_TRUE(s.factor().ok()) << scenes[f].name << ", step " << step;
        const double condition = condition_of(s.scaled_dense());
        if (most[f] > 0.0) {  // 2: scales are rounded to powers of two
          EXPECT_LE(condition, 2.0 * most[f]) << scenes[f].name << ", seed " << seed << ", step " << step;
        }
        EXPECT_LE(condition, 1e5) << scenes[f].name << ", seed " << seed << ", step " << step;
        most[f] = std::max(most[f], condition);
      }
    }
  }
}

/// Several nodes in a row without anything of their own: lending goes on through those that have borrowed.
TEST(Scaling, ARowOfNodesBetweenJointsBorrowsFromItsEnds) {
  double longest = 0.0;
  for (double step = 1e-2; step > 0.9e-9; step *= 0.1) {
    SceneMaker m(7, step);
    int end = m.add_node();
    m.add_joint({end}, 5);
    for (int k = 0; k < 4; ++k) {
      const int next = m.add_node();
      m.add_joint({end, next}, k % 2 == 0 ? 5 : 6);
      end = next;
    }
    const int tip = m.add_node();
    m.add_beam({end, tip});
    const Scene scene = m.finish("row of joints");
    Solved s(scene, {}, {});
    ASSERT_TRUE(s.factor().ok()) << step;
    const double condition = condition_of(s.scaled_dense());
    if (longest > 0.0) {
      EXPECT_LE(condition, 2.0 * longest) << step;
    }
    longest = std::max(longest, condition);
  }
}

TEST(Scaling, TheSameMatrixWithoutItIsHopeless) {
  EXPECT_GT(condition_of(make_chain(1, 4, 3, 1e-5).dense()), 1e12);  // so the test above tests something
}

TEST(Scaling, ScalesArePowersOfTwoAndLeaveDiagonalsAndRowsNearOne) {
  for (const Scene& scene : make_all_families(2)) {
    Solved s(scene, {}, {});
    ASSERT_TRUE(s.factor().ok());
    for (double scale : s.solver.column_scale()) {
      int exponent = 0;
      EXPECT_EQ(std::frexp(scale, &exponent), 0.5);
    }
    const Eigen::MatrixXd A = s.scaled_dense();
    const auto first = scene.first_unknown();
    for (int b = 0; b < scene.graph.num_blocks(); ++b)
      for (int u = first[static_cast<std::size_t>(b)]; u < first[static_cast<std::size_t>(b) + 1]; ++u) {
        const bool motion = scene.graph.block_kind[static_cast<std::size_t>(b)] == blocks::BlockKind::motion;
        const double size = motion ? A(u, u) : A.row(u).norm();
        EXPECT_GE(size, 0.3) << scene.name;  // rounding to powers of two: at most sqrt 2 on either side, twice
        EXPECT_LE(size, 2.1) << scene.name;
      }
  }
}

/// A hinge on the ground whose axes are a little out of line with those of its node must not look like a lever of its
/// unknowns: scaled by what they drag on, pivots would fail that are as good as those of an exact one.
TEST(Scaling, AJointToTheGroundOutOfLineScalesItsNodeLikeOneInLine) {
  const auto scales = [](double angle) {
    SceneMaker m(4);
    const int node = m.add_node(), other = m.add_node();
    m.add_beam({node, other});
    m.add_joint({node}, 5);
    Scene scene = m.finish("hinge");
    Eigen::MatrixXd& joint = scene.elements.back();
    Eigen::MatrixXd rows = Eigen::MatrixXd::Identity(5, 6);
    for (int i = 0; i < 5; ++i) rows(i, (i + 1) % 6) = angle;
    joint.setZero();
    joint.bottomLeftCorner(5, 6) = rows;
    joint.topRightCorner(6, 5) = rows.transpose();
    Solved s(scene, {}, {});
    EXPECT_TRUE(s.factor().ok());
    return std::vector<double>(s.solver.column_scale().begin(), s.solver.column_scale().end());
  };
  const std::vector<double> in_line = scales(0.0);
  for (const double angle : {1e-9, 1e-6, 1e-4}) EXPECT_EQ(scales(angle), in_line) << angle;
}

TEST(Scaling, ASecondFactorKeepsTheScalesUntilAskedOtherwise) {
  Scene scene = make_chain(1, 2, 2);
  Solved s(scene, {}, {});
  ASSERT_TRUE(s.factor().ok());
  const double before = s.solver.column_scale()[0];
  for (auto& e : scene.elements) e *= 1e6;
  write_elements(scene, s.solver);
  ASSERT_TRUE(s.factor().ok());
  EXPECT_EQ(s.solver.column_scale()[0], before);
  s.solver.rescale();
  ASSERT_TRUE(s.factor().ok());
  EXPECT_NE(s.solver.column_scale()[0], before);
  s.solve(s.random_rhs(1));
  EXPECT_LE(s.report.backward_error, 1e-15);
}

/// Rods without inertia about their axes: what rounding leaves on their diagonals must not determine scales.
TEST(Scaling, ADiagonalOfRoundOffIsNone) {
  const auto scales = [](double rest) {
    SceneMaker m(4);
    const int first = m.add_node(), second = m.add_node();
    m.add_beam({first, second});
    m.add_joint({first, second}, 5);
    Scene scene = m.finish("rods");
    Eigen::MatrixXd &beam = scene.elements.front(), &joint = scene.elements.back();
    const double largest = beam.diagonal().cwiseAbs().maxCoeff();
    for (const int spin : {3, 9}) {
      beam.row(spin).setZero();
      beam.col(spin).setZero();
      beam(spin, spin) = rest * largest;
    }
    joint.setZero();
    for (int i = 0; i < 5; ++i)
      joint(12 + i, i) = joint(i, 12 + i) = -(joint(12 + i, 6 + i) = joint(6 + i, 12 + i) = 1.0);
    Solved s(scene, {}, {});
    (void)s.factor();
    return std::vector<double>(s.solver.column_scale().begin(), s.solver.column_scale().end());
  };
  EXPECT_EQ(scales(1e-17), scales(0.0));
}

constexpr int measured_every = 8;  // factorizations

/// Thresholds hold for scaled entries near 1. Entries that leave this range are noticed when a solution is checked.
TEST(Scaling, MatricesThatDriftGetNewScales) {
  Scene scene = make_chain(1, 9, 2);
  Solved s(scene, {}, {});
  ASSERT_TRUE(s.factor().ok());
  s.solve(s.random_rhs(1));
  const double before = s.solver.column_scale()[0];
  const auto grow = [&](double factor) {
    for (auto& e : scene.elements)
      if (e.rows() == 12) e *= factor;  // beams
    write_elements(scene, s.solver);
    for (int k = 0; k <= measured_every; ++k) {
      ASSERT_TRUE(s.factor().ok());
      s.solve(s.random_rhs(2));
    }
  };
  grow(8.0);  // too little
  EXPECT_EQ(s.solver.column_scale()[0], before);
  grow(1e4);
  EXPECT_LT(s.solver.column_scale()[0], 0.1 * before);
}

/// The backward error is relative to the present matrix, whenever its scales were computed: with the norm of the former
/// one it would differ by 1000. Rounding differs with the scales, hence 30.
TEST(Scaling, BackwardErrorsAreThoseOfThePresentMatrix) {
  Scene scene = make_chain(1, 9, 2);
  for (const double factor : {1e-3, 1e3}) {
    Scene other = scene;
    for (auto& e : other.elements) e *= factor;
    Solved stale(scene, {}, {.check = solve::SolveCheck::backward_error, .refinement_steps = 0}),
        fresh(other, {}, {.check = solve::SolveCheck::backward_error, .refinement_steps = 0});
    ASSERT_TRUE(fresh.factor().ok());
    const Eigen::VectorXd b = fresh.random_rhs(1);
    fresh.solve(b);
    ASSERT_TRUE(stale.factor().ok());
    stale.solve(b);
    write_elements(other, stale.solver);
    for (int k = 0; k < measured_every; ++k) {
      ASSERT_TRUE(stale.factor().ok());
      stale.solve(b);
    }
    EXPECT_LT(stale.report.backward_error, 30.0 * fresh.report.backward_error) << factor;
    EXPECT_GT(stale.report.backward_error, fresh.report.backward_error / 30.0) << factor;
  }
}

TEST(Scaling, ExtremeStiffnessRatiosStaySolvable) {
  for (double ratio : {1e-12, 1e12}) {
    Scene scene = make_chain(3, 3, 4);
    for (std::size_t e = 0; e < scene.elements.size(); e += 3)
      if (scene.elements[e].rows() == 12) scene.elements[e] *= ratio;
    Solved s(scene, {}, {});
    ASSERT_TRUE(s.factor().ok()) << ratio;
    s.solve(s.random_rhs(1));
    EXPECT_LE(s.report.backward_error, 1e-15) << ratio;
  }
}

}  // namespace
}  // namespace bough::test
