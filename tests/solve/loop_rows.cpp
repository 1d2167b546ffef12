/// Dependent rows of loops, which are decided in the fronts in which the loops close.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "loops.hpp"
#include "solving.hpp"

namespace bough::test {
namespace {

std::vector<LoopOptions> make_cases() {
  return {{.columns = 6},
          {.columns = 6, .tilt = 0.02, .own_inertia = 0.0},
          {.columns = 5, .long_bar = true},
          {.columns = 3, .floors = 3},
          {.columns = 4, .floors = 2, .own_inertia = 0.0, .long_bar = true}};
}

/// Minimum-norm solution. exact: each multiplier is measured relative to the exact norm of its constraint row;
/// otherwise to the norm rounded to a power of two, and only its motion is unique.
Eigen::VectorXd least_solution(const Solved& s, const Eigen::VectorXd& b, bool is_exact) {
  const Eigen::Map<const Eigen::VectorXd> row(s.solver.row_scale().data(), b.size()),
      column(s.solver.column_scale().data(), b.size());
  const Eigen::VectorXd exact = is_exact ? exact_column_scale(s) : Eigen::VectorXd(column);
  const Eigen::MatrixXd A = row.asDiagonal() * s.scene.dense() * exact.asDiagonal();
  return exact.cwiseProduct(test::least_solution(A, row.cwiseProduct(b), 1e-12));
}

int num_singular_values_below(const Eigen::MatrixXd& A, double limit) {
  return static_cast<int>((singular_values(A).array() < limit).count());
}

Eigen::VectorXd consistent_rhs(const Solved& s, unsigned seed) {
  const Eigen::MatrixXd A = s.scaled_dense();
  const Eigen::VectorXd b = A * SceneMaker(seed).uniform_matrix(static_cast<int>(A.rows()), 1).col(0);
  return b.cwiseQuotient(Eigen::Map<const Eigen::VectorXd>(s.solver.row_scale().data(), A.rows()));
}

/// Half of the limit for random matrices, 30 n 2^-53 |A| |x|, since the right-hand side is about as large as |A| |x|.
double backward_bar(const Scene& scene) { return 15.0 * scene.num_unknowns() * 0x1p-53; }

TEST(LoopRows, MultipliersAreTheLeastOnesForAnyTreeAndForm) {
  for (const LoopOptions& options : make_cases())
    for (const int leaf : {1, 4, 1000})
      for (const bool lanes : {false, true})
        for (const auto symmetry : {solve::Symmetry::general, solve::Symmetry::symmetric}) {
          SCOPED_TRACE(testing::Message() << options.columns << " x " << options.floors << ", leaf " << leaf
                                          << ", lanes " << lanes << ", symmetry " << static_cast<int>(symmetry));
          const Scene scene = make_loops(options);
          Solved s(scene, {.leaf_size = leaf}, {.symmetry = symmetry, .lanes = lanes});
          const auto status = s.factor();
          ASSERT_TRUE(status.ok());
          EXPECT_EQ(status.deficiency, num_singular_values_below(s.scaled_dense(), 1e-12));
          EXPECT_GE(status.deficiency, 3 * options.columns * options.floors);
          const Eigen::VectorXd b = consistent_rhs(s, 5), x = s.solve(b);
          EXPECT_LE(s.report.backward_error, backward_bar(scene));
          EXPECT_LE(s.report.inconsistency, 1e-12);
          EXPECT_LE(s.report.rank_error, 1e-12);
          // Round-off times the condition of what does not depend, at most 1e6 here. Scales of rotations without
          // inertia come from neighbours, and exact ones are not known.
          const bool is_exact = options.own_inertia > 0.0;
          Eigen::VectorXd error = x - least_solution(s, b, is_exact);
          for (int k = 0; k < scene.graph.num_blocks() && !is_exact; ++k)
            if (scene.graph.block_kind[static_cast<std::size_t>(k)] == blocks::BlockKind::multiplier)
              error.segment(scene.first_unknown()[static_cast<std::size_t>(k)], 5).setZero();
          EXPECT_LE(s.scaled_difference(x - error, x), 1e-9);
        }
}

/// Nearly upright bars without inertia about their axes: rotations about these are held by joint rows that couple them
/// little. They borrow their scales, and must not pass them back to rotations that have inertia.
TEST(LoopRows, BarsWithoutInertiaAboutTheirAxesKeepTheScalesOfTheOthers) {
  for (const double tilt : {1e-4, 2e-3, 0.02, 0.3}) {
    const LoopOptions options{.columns = 8, .tilt = tilt, .own_inertia = 0.0};
    LoopOptions with_inertia = options;
    with_inertia.own_inertia = 0.01;
    const Scene thin = make_loops(options), thick = make_loops(with_inertia);
    Solved s(thin, {.leaf_size = 4}, {}), t(thick, {.leaf_size = 4}, {});
    EXPECT_EQ(s.factor().deficiency, 3 * options.columns) << tilt;
    EXPECT_EQ(t.factor().deficiency, 3 * options.columns) << tilt;
    for (int b = 0; b < thin.graph.num_blocks(); ++b) {
      if (thin.graph.block_kind[static_cast<std::size_t>(b)] != blocks::BlockKind::motion) continue;
      const auto u = static_cast<std::size_t>(thin.first_unknown()[static_cast<std::size_t>(b)]);
      for (const std::size_t k : {0u, 1u, 2u, 3u, 5u})
        EXPECT_EQ(s.solver.column_scale()[u + k], t.solver.column_scale()[u + k]) << "tilt " << tilt << ", block " << b;
    }
  }
}

/// Loops that are open by 1e-11 leave up to 1e-9 behind long null vectors: no pivot, in whatever front it appears.
TEST(LoopRows, OfLargeGridsAreAllFoundInEveryShape) {
  for (int k = 0; k < 16; ++k) {
    const LoopOptions options{.columns = 20, .floors = 4, .tilt = 0.002 * std::exp2(0.5 * k)};
    Scene scene = make_loops(options);
    SceneMaker numbers(static_cast<unsigned>(k + 1));
    for (Eigen::MatrixXd& a : scene.elements)
      if (a.rows() > 6)
        a.array() *=
            1.0 + 1e-11 * numbers.uniform_matrix(static_cast<int>(a.rows()), static_cast<int>(a.cols())).array();
    Solved s(scene, {}, {});
    ASSERT_TRUE(s.factor().ok());
    EXPECT_EQ(s.solver.last_status().deficiency, 3 * options.columns * options.floors) << "tilt " << options.tilt;
    s.solve(consistent_rhs(s, 3));
    EXPECT_LE(s.report.backward_error, backward_bar(scene)) << "tilt " << options.tilt;
  }
}

TEST(LoopRows, DelaysAndMemoryGrowLikeTheLoops) {
  const auto measure = [](int columns) {
    const Scene scene = make_loops({.columns = columns});
    Solved s(scene, {}, {});
    EXPECT_EQ(s.factor().deficiency, 3 * columns);
    s.solve(Eigen::VectorXd::Ones(scene.num_unknowns()));
    return std::pair{s.solver.last_status().delayed_pivots, s.solver.counters().memory_bytes};
  };
  const auto small = measure(80), large = measure(320);
  EXPECT_LE(large.first, 1.2 * 4 * small.first);
  EXPECT_LE(static_cast<double>(large.second), 1.2 * 4 * static_cast<double>(small.second));
}

TEST(LoopRows, ALoopThatContradictsItselfIsNamed) {
  const Scene scene = make_loops({.columns = 12});
  for (const int leaf : {2, 1000}) {
    Solved s(scene, {.leaf_size = leaf}, {});
    ASSERT_TRUE(s.factor().ok());
    const std::vector<int> blocks = s.solver.blocks_not_unique();
    EXPECT_EQ(blocks.size(), 13u + 24u);  // all pins
    Eigen::VectorXd b = consistent_rhs(s, 1);
    s.solve(b);
    EXPECT_LE(s.report.inconsistency, 1e-12);
    const int block = blocks[blocks.size() / 2];  // its last row: a rotation out of the plane
    const int row = scene.first_unknown()[static_cast<std::size_t>(block)] + 4;
    b(row) += 1e-3;
    s.solve(b);
    EXPECT_EQ(s.report.inconsistent_block, block);
    EXPECT_GT(s.report.inconsistent_amount, 1e-4);
    EXPECT_LT(s.report.inconsistent_amount, 1e-3);
    EXPECT_LE(s.report.backward_error, 1e-14) << "of the nearest right-hand side that has a solution";
    // It is the one whose part in the left null space is removed.
    const Eigen::MatrixXd A = s.scaled_dense();
    const Eigen::Map<const Eigen::VectorXd> scale(s.solver.row_scale().data(), b.size());
    const Eigen::VectorXd scaled = scale.cwiseProduct(b), left = scaled - A * test::least_solution(A, scaled, 1e-12);
    EXPECT_NEAR(s.report.inconsistency, left.norm() / scaled.norm(), 1e-6 * s.report.inconsistency);
  }
}

TEST(LoopRows, ThatDependOnlyNearlyAreJudgedByTheirSingularValues) {
  const LoopOptions aligned{.columns = 8};
  const int all = 3 * aligned.columns;
  for (const double off : {1e-15, 1e-13, 1e-12, 1e-11, 1e-9, 1e-7, 1e-3, 1e-2, 1e-1})
    for (const int leaf : {2, 1000}) {
      SCOPED_TRACE(testing::Message() << "off by " << off << ", leaf " << leaf);
      LoopOptions options = aligned;
      options.misaligned = off;
      const Scene scene = make_loops(options);
      Solved s(scene, {.leaf_size = leaf}, {});
      const auto status = s.factor();
      ASSERT_TRUE(status.ok());
      EXPECT_EQ(status.deficiency, num_singular_values_below(s.scaled_dense(), 1e-10));
      EXPECT_EQ(status.deficiency < all, off >= 1e-3);
      s.solve(consistent_rhs(s, 3));
      EXPECT_LE(s.report.backward_error, 1e-14);
      EXPECT_LE(s.report.rank_error, off < 1e-3 ? std::max(1e-14, 10.0 * off) : 1e-12);
    }
}

TEST(LoopRows, AJointThatIsAlignedAndNotAgainChangesTheRank) {
  const LoopOptions options{.columns = 8};
  LoopOptions off = options;
  off.misaligned = 0.1;
  const Scene aligned = make_loops(options), misaligned = make_loops(off);
  for (const tree::TreeOptions& cut : {tree::TreeOptions{.leaf_size = 2}, tree::TreeOptions{}})
    for (const bool lanes : {false, true}) {
      Solved s(aligned, cut, {.lanes = lanes});
      const int all = s.factor().deficiency;
      const Eigen::VectorXd b = consistent_rhs(s, 3), x = s.solve(b);
      write_elements(misaligned, s.solver);
      const int fewer = s.factor().deficiency;
      EXPECT_LT(fewer, all);
      s.solve(b);
      EXPECT_LE(s.report.backward_error, 1e-14);
      write_elements(aligned, s.solver);
      EXPECT_EQ(s.factor().deficiency, all);
      EXPECT_TRUE(same_bits(s.solve(b), x));
    }
}

TEST(LoopRows, AStructureThatIsHeldAfterwardsIsFactoredWithoutThem) {
  // All dependent rows get a diagonal, as soft joints have: nothing depends any more, and fronts return to their
  // lanes.
  const Scene rigid = make_loops({.columns = 8});
  Scene soft = rigid;
  for (Eigen::MatrixXd& a : soft.elements)
    if (a.rows() > 6) a.bottomRightCorner(5, 5) -= 1e-6 * Eigen::MatrixXd::Identity(5, 5);
  for (const tree::TreeOptions& cut : {tree::TreeOptions{.leaf_size = 2}, tree::TreeOptions{}}) {
    Solved s(rigid, cut, {});
    EXPECT_EQ(s.factor().deficiency, 24);
    write_elements(soft, s.solver);
    for (int k = 0; k < 2; ++k) {
      EXPECT_EQ(s.factor().deficiency, 0);
      const Eigen::VectorXd b = s.random_rhs(4);
      s.solve(b);
      EXPECT_LE(s.report.backward_error, 1e-14);
      EXPECT_EQ(s.report.inconsistency, 0.0);
    }
  }
}

TEST(LoopRows, APartThatIsNotHeldIsNamedBesideLoopsThatDepend) {
  Scene scene = make_loops({.columns = 6, .step = 1e-3});
  // The last coupler loses its inertia and one of its pins: nothing holds its rotation about the other.
  const int coupler = scene.graph.num_blocks() - 3;
  ASSERT_EQ(scene.graph.block_kind[static_cast<std::size_t>(coupler)], blocks::BlockKind::motion);
  for (int e = 0; e < scene.graph.num_elements(); ++e) {
    const auto begin = scene.graph.element_begin[static_cast<std::size_t>(e)],
               end = scene.graph.element_begin[static_cast<std::size_t>(e) + 1];
    if (scene.graph.element_blocks[static_cast<std::size_t>(begin)] == coupler && end == begin + 1)
      scene.elements[static_cast<std::size_t>(e)].setZero();
  }
  Eigen::MatrixXd& last = scene.elements.back();
  last.setZero();
  last.bottomRightCorner(5, 5).setIdentity();
  for (const int leaf : {2, 1000}) {
    Solved s(scene, {.leaf_size = leaf}, {});
    const auto status = s.factor();
    EXPECT_EQ(status.outcome, solve::FactorOutcome::singular);
    EXPECT_EQ(status.block, coupler);
  }
}

}  // namespace
}  // namespace bough::test
