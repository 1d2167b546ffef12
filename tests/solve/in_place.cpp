/// Right-hand sides are read where they are and solutions written where they are asked for: the same bits whether
/// these are one array or two, and whatever the solver looks at afterwards.
#include <gtest/gtest.h>

#include <bit>
#include <cstdint>
#include <string>

#include "solving.hpp"

namespace bough::test {
namespace {

/// By their bits: what was not measured is not a number.
void expect_same(const solve::SolveReport& a, const solve::SolveReport& b) {
  const auto bits = [](double x) { return std::bit_cast<std::uint64_t>(x); };
  EXPECT_EQ(bits(a.backward_error), bits(b.backward_error));
  EXPECT_EQ(bits(a.inconsistency), bits(b.inconsistency));
  EXPECT_EQ(bits(a.inconsistent_amount), bits(b.inconsistent_amount));
  EXPECT_EQ(bits(a.rank_error), bits(b.rank_error));
  EXPECT_EQ(bits(a.growth), bits(b.growth));
  EXPECT_EQ(a.refinement_steps, b.refinement_steps);
  EXPECT_EQ(a.finite, b.finite);
}

void expect_same_in_place(const Scene& scene, const tree::TreeOptions& tree_options,
                          const solve::SolveOptions& options) {
  SCOPED_TRACE(scene.name + ", leaves of " + std::to_string(tree_options.leaf_size) + ", check " +
               std::to_string(static_cast<int>(options.check)) + ", refined " +
               std::to_string(options.refinement_steps));
  const tree::Walker walker = schedule::make_serial_walker();
  Solved s(scene, tree_options, options);
  ASSERT_TRUE(s.factor().ok());
  const Eigen::VectorXd b = s.random_rhs(3);  // of no solution where rows depend
  const Eigen::VectorXd apart = s.solve(b);
  const solve::SolveReport report = s.report;
  EXPECT_TRUE(apart.allFinite());

  Eigen::VectorXd both = b;
  expect_same(s.solver.solve(walker, both.data(), both.data()), report);
  EXPECT_TRUE(same_bits(both, apart));
  both = b;
  (void)s.solver.solve_unchecked(walker, both.data(), both.data());
  if (options.refinement_steps == 0) {
    EXPECT_TRUE(same_bits(both, apart));
  }

  Eigen::VectorXd x(b.size());
  ASSERT_TRUE(s.solver.factor(walker, {}, b.data()).ok());
  expect_same(s.solver.substitute(walker, b.data(), x.data(), true), report);
  EXPECT_TRUE(same_bits(x, apart));
  both = b;
  ASSERT_TRUE(s.solver.factor(walker, {}, both.data()).ok());
  expect_same(s.solver.substitute(walker, both.data(), both.data(), true), report);
  EXPECT_TRUE(same_bits(both, apart));
}

TEST(InPlace, SolutionsAndReportsAreTheSame) {
  for (const bool twice : {false, true})
    for (const int leaf : {1, 8, 1000})
      for (const bool lanes : {false, true})
        for (const auto check : {solve::SolveCheck::none, solve::SolveCheck::backward_error})
          for (const int refinements : {0, 2})
            expect_same_in_place(
                make_hinged_beams(7, 20, twice ? 3 : 0), {.leaf_size = leaf},
                {.lanes = lanes, .check = check, .refinement_steps = refinements, .refinement_above = 0.0});
}

/// Springs in a row that are held by a very soft one alone: the root's pivots are so small that the matrix is looked
/// at for dependence and found good.
TEST(InPlace, SolutionsAreTheSameWhereSmallPivotsHaveBeenLookedAt) {
  SceneMaker m(9);
  int end = m.add_node();
  m.add_body(end);
  for (int i = 0; i < 40; ++i) {
    const int next = m.add_node();
    m.add_beam({end, next});
    end = next;
  }
  Scene scene = m.finish("nearly free row");
  const Eigen::MatrixXd one = Eigen::MatrixXd::Identity(6, 6);
  for (Eigen::MatrixXd& a : scene.elements) {
    if (a.rows() == 6)
      a = 1e-6 * one;
    else
      a << one, -one, -one, one;
  }
  for (const bool lanes : {false, true})
    for (const int leaf : {1, 4, 1000})
      expect_same_in_place(scene, {.leaf_size = leaf},
                           {.lanes = lanes, .check = solve::SolveCheck::none, .refinement_steps = 0});
}

}  // namespace
}  // namespace bough::test
