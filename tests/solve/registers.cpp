/// Small fronts row by row in registers: the kernels against sums, and leaves that leave them.
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "../../src/solve/register_kernels.hpp"
#include "../../src/solve/shared_numbers.hpp"
#include "bough/schedule/threads.hpp"
#include "solving.hpp"

namespace bough::test {
namespace {

enum class Values { general, symmetric, definite };

std::size_t at(std::ptrdiff_t i) { return static_cast<std::size_t>(i); }

/// One front with its right-hand side, eliminated.
struct Single {
  int n, e, step, schur_step;
  solve::LaneDoubles rows, factor, schur;
  std::vector<double> column, inverse_column, z, least;
  bool stands = false;

  Single(const Eigen::MatrixXd& A, const Eigen::VectorXd& b, int eliminated, Values values, double smallest = 1e-10,
         const Eigen::VectorXd& scale = {})
      : n(static_cast<int>(A.rows())),
        e(eliminated),
        step((n / 8 + 1) * 8),
        schur_step(((n - e) / 8 + 1) * 8),
        rows(at(n * step), 0.0),
        factor(at(e * (2 * n - e) + 8), 0.0),
        schur(at((n - e) * schur_step), 0.0),
        column(at(step), 0.0),
        inverse_column(at(e), 1.0),
        z(at(e), 0.0),
        least(at(e)) {
    const double unit = scale.size() == 0 ? 1.0 : 0.0;
    for (int i = 0; i < n; ++i) {
      column[at(i)] = unit + (unit > 0.0 ? 0.0 : scale[i]);
      for (int j = 0; j < n; ++j) rows[at(i * step + j)] = A(i, j);
      rows[at(i * step + step - 1)] = b[i];
    }
    for (int k = 0; k < e; ++k) {
      inverse_column[at(k)] = 1.0 / column[at(k)];
      least[at(k)] = smallest / (column[at(k)] * column[at(k)]);
    }
    stands = solve::eliminate_in_registers(n, e, values != Values::general,
                                           {column.data(), inverse_column.data(), least.data()}, 1e-3,
                                           {rows.data(), factor.data(), z.data(), schur.data()});
  }
};

Eigen::MatrixXd make_matrix(SceneMaker& m, int n, Values values) {
  Eigen::MatrixXd A = m.uniform_matrix(n, n);
  if (values != Values::general) A = Eigen::MatrixXd(A + A.transpose());
  if (values == Values::definite) return A * A.transpose() / n + Eigen::MatrixXd::Identity(n, n);
  for (int i = 0; i < n; ++i) A(i, i) += i % 3 == 1 ? -2.0 * n : 2.0 * n;
  return A;
}

TEST(Registers, EveryShapeIsEliminatedLikeADenseMatrix) {
  SceneMaker m(5);
  for (const Values values : {Values::general, Values::symmetric, Values::definite})
    for (int n = 1; n <= solve::largest_in_registers; ++n)
      for (int e = 0; e <= n; ++e) {
        SCOPED_TRACE("values " + std::to_string(static_cast<int>(values)) + ", " + std::to_string(e) + " of " +
                     std::to_string(n));
        const bool is_symmetric = values != Values::general;
        const Eigen::MatrixXd A = make_matrix(m, n, values);
        const Eigen::VectorXd b = m.uniform_matrix(n, 1).col(0);
        const Single f(A, b, e, values);
        ASSERT_TRUE(f.stands);
        const int r = n - e;
        const Eigen::MatrixXd inverse = A.topLeftCorner(e, e).inverse();
        const Eigen::MatrixXd S =
            A.bottomRightCorner(r, r) - A.bottomLeftCorner(r, e) * inverse * A.topRightCorner(e, r);
        const Eigen::VectorXd g = b.tail(r) - A.bottomLeftCorner(r, e) * inverse * b.head(e);
        const double bar = 1e-12 * n * std::max(1.0, A.cwiseAbs().maxCoeff());
        for (int i = 0; i < r; ++i) {
          for (int j = is_symmetric ? i : 0; j < r; ++j) EXPECT_NEAR(f.schur[at(i * f.schur_step + j)], S(i, j), bar);
          EXPECT_NEAR(f.schur[at(i * f.schur_step + f.schur_step - 1)], g[i], bar);
        }
        // Substitutions: the one within the elimination and the one of its own are the same bit by bit.
        std::vector<double> t(b.data(), b.data() + n);
        solve::forward_in_registers(f.factor.data(), n, e, is_symmetric, t.data());
        for (int k = 0; k < e; ++k) EXPECT_EQ(t[at(k)], f.z[at(k)]);
        for (int i = 0; i < r; ++i) EXPECT_EQ(t[at(e + i)], f.schur[at(i * f.schur_step + f.schur_step - 1)]);
        const Eigen::VectorXd x_b = m.uniform_matrix(std::max(r, 1), 1).col(0).head(r);
        Eigen::VectorXd x(e), y(n);
        solve::backward_in_registers(f.factor.data(), n, e, f.z.data(), x_b.data(), x.data());
        EXPECT_LE((x - inverse * (b.head(e) - A.topRightCorner(e, r) * x_b)).cwiseAbs().sum(), bar);
        y.tail(r) = x_b;
        solve::backward_left_in_registers(f.factor.data(), n, e, is_symmetric, y.data());
        EXPECT_LE((y.transpose() * A.leftCols(e)).cwiseAbs().sum(), bar);
      }
}

/// Pivots that are small or missing, and rows that grow, are refused; scales decide what is small.
TEST(Registers, PivotsAgainstTheRuleAreRefused) {
  SceneMaker m(6);
  const Eigen::VectorXd b = Eigen::VectorXd::Ones(14);
  const Eigen::MatrixXd A = make_matrix(m, 14, Values::definite);
  constexpr double nan = std::numeric_limits<double>::quiet_NaN(), infinite = std::numeric_limits<double>::infinity();
  for (const Values values : {Values::general, Values::symmetric, Values::definite}) {
    ASSERT_TRUE(Single(A, b, 11, values).stands);
    for (const int k : {0, 3, 7, 8, 10})
      for (const double bad : {0.0, 1e-12, nan, infinite}) {
        Eigen::MatrixXd B = A;
        B.row(k).setZero();
        B.col(k).setZero();
        B(k, k) = bad;
        EXPECT_FALSE(Single(B, b, 11, values).stands) << k << ", " << bad;
      }
    Eigen::MatrixXd B = A;
    B(4, 4) = -5.0;
    EXPECT_TRUE(Single(B, b, 11, values).stands);
    B = A;
    B(0, 0) = 1e-4;  // against entries of order one: rows would grow by 1e4
    B(0, 12) = B(12, 0) = 1.0;
    EXPECT_FALSE(Single(B, b, 11, values).stands);
    // Units of unknowns change nothing: D A D with scales 1 / D stands like A.
    Eigen::VectorXd D(14);
    for (int i = 0; i < 14; ++i) D[i] = std::ldexp(1.0, 7 * (i % 5) - 14);
    EXPECT_TRUE(Single(D.asDiagonal() * A * D.asDiagonal(), b, 11, values, 1e-10, D.cwiseInverse()).stands);
    EXPECT_FALSE(Single(D.asDiagonal() * B * D.asDiagonal(), b, 11, values, 1e-10, D.cwiseInverse()).stands);
  }
}

/// What nobody asked for in the place of a right-hand side decides nothing.
TEST(Registers, ARightHandSideThatIsNoNumberRefusesNoPivot) {
  SceneMaker m(7);
  for (const Values values : {Values::general, Values::symmetric, Values::definite}) {
    const Eigen::MatrixXd A = make_matrix(m, 12, values);
    const Eigen::VectorXd b = Eigen::VectorXd::Constant(12, std::numeric_limits<double>::quiet_NaN());
    const Single f(A, b, 6, values), good(A, Eigen::VectorXd::Ones(12), 6, values);
    ASSERT_TRUE(f.stands);
    for (int i = 0; i < 6; ++i)
      for (int j = values == Values::general ? 0 : i; j < 6; ++j)
        EXPECT_EQ(f.schur[at(i * 8 + j)], good.schur[at(i * 8 + j)]);
  }
}

Scene with_parts(Scene scene, solve::Symmetry symmetry) {
  if (symmetry == solve::Symmetry::symmetric)
    for (Eigen::MatrixXd& a : scene.elements) a = Eigen::MatrixXd(0.5 * (a + a.transpose()));
  return scene;
}

/// Beams in a row, without multipliers.
void add_row(SceneMaker& m, int end, int beams) {
  for (int i = 0; i < beams; ++i) {
    const int next = m.add_node();
    m.add_beam({end, next});
    m.add_body(next, 0.1);
    end = next;
  }
}

/// A threshold of pivots at which random chains stay in registers: what leaves them is the subject of another test.
constexpr double accepting = 1e-3;

TEST(Registers, ChainsForOneSolutionAreSweptAndMatchTheScalarPath) {
  for (const auto symmetry : {solve::Symmetry::general, solve::Symmetry::symmetric})
    for (const int links : {10, 33, 200}) {
      const Scene scene = with_parts(make_chain(3, links, 4), symmetry);
      Solved swept(scene, {.for_one_solution = true},
                   {.symmetry = symmetry, .pivot_threshold = accepting, .refinement_steps = 0});
      Solved scalar(scene, {.for_one_solution = true},
                    {.symmetry = symmetry, .lanes = false, .pivot_threshold = accepting, .refinement_steps = 0});
      ASSERT_TRUE(swept.factor().ok());
      ASSERT_TRUE(scalar.factor().ok());
      const solve::SolverCounters counters = swept.solver.counters();
      EXPECT_GT(counters.fronts_in_registers, 4 * links);
      EXPECT_EQ(counters.registers_left, 0);
      EXPECT_EQ(scalar.solver.counters().fronts_in_registers, 0);
      const Eigen::VectorXd b = swept.random_rhs(5), x = swept.solve(b), y = scalar.solve(b);
      EXPECT_LE(swept.report.backward_error, 1e-14);
      EXPECT_LE(swept.scaled_difference(x, y), 1e-8);
      // In the visits that factor, and by two threads: the same bits.
      const schedule::Threads threads(2, 0.0);
      Eigen::VectorXd again(b.size());
      ASSERT_TRUE(swept.solver.factor(threads.walker(), {}, b.data()).ok());
      (void)swept.solver.substitute(threads.walker(), b.data(), again.data(), true);
      EXPECT_TRUE(same_bits(x, again));
    }
}

/// Two hubs with free arms, joined by a bar.
Scene make_frame(unsigned seed, int arms, int beams) {
  SceneMaker m(seed);
  const int hub[2] = {m.add_node(), m.add_node()}, middle = m.add_node();
  for (const int h : hub) {
    m.add_beam({h, middle});
    for (int a = 0; a < arms; ++a) add_row(m, h, beams);
  }
  return m.finish("frame");
}

/// Where several children reach a row that has a right-hand side of its own, sums are taken in one order everywhere.
TEST(Registers, LeavesThatBranchGiveTheSameBitsInEveryVisit) {
  for (const auto symmetry : {solve::Symmetry::general, solve::Symmetry::symmetric})
    for (const int arms : {2, 3, 4}) {
      const Scene scene = with_parts(make_frame(8, arms, 6), symmetry);
      Solved s(scene, {.leaf_size = scene.graph.num_elements() / 2 + 1}, {.symmetry = symmetry, .refinement_steps = 0});
      ASSERT_TRUE(s.factor().ok());
      EXPECT_GT(s.solver.counters().fronts_in_registers, 4 * arms);
      const Eigen::VectorXd b = s.random_rhs(5), x = s.solve(b);
      EXPECT_LE(s.report.backward_error, 1e-14);
      const tree::Walker walker = schedule::make_serial_walker();
      Eigen::VectorXd again(b.size());
      ASSERT_TRUE(s.solver.factor(walker, {}, b.data()).ok());
      (void)s.solver.substitute(walker, b.data(), again.data(), true);
      EXPECT_TRUE(same_bits(x, again));
    }
}

/// Reports look at whole Schur complements; symmetric fronts in registers keep one triangle of them. Two eliminations
/// of well-conditioned matrices: round-off.
TEST(Registers, InterfacesAreReportedAsFromTheScalarPath) {
  for (const auto symmetry : {solve::Symmetry::general, solve::Symmetry::symmetric}) {
    const Scene scene = with_parts(make_chain(3, 33, 4), symmetry);
    Solved swept(scene, {.for_one_solution = true}, {.symmetry = symmetry});
    Solved scalar(scene, {.for_one_solution = true}, {.lanes = false});
    ASSERT_TRUE(swept.factor().ok());
    ASSERT_TRUE(scalar.factor().ok());
    ASSERT_GT(swept.solver.counters().fronts_in_registers, 100);
    const auto from_swept = swept.solver.interfaces(), from_scalar = scalar.solver.interfaces();
    ASSERT_EQ(from_swept.size(), from_scalar.size());
    for (std::size_t i = 0; i < from_swept.size(); ++i)
      EXPECT_NEAR(from_swept[i].condition, from_scalar[i].condition, 1e-12 * from_scalar[i].condition);
    const Eigen::VectorXd b = swept.random_rhs(5);
    const std::vector<double> l = swept.solver.local_multipliers(0, b.data()),
                              of_scalar = scalar.solver.local_multipliers(0, b.data());
    ASSERT_EQ(l.size(), of_scalar.size());
    double most = 0.0;
    for (const double value : of_scalar) most = std::max(most, std::abs(value));
    for (std::size_t i = 0; i < l.size(); ++i) EXPECT_NEAR(l[i], of_scalar[i], 1e-12 * most);
  }
}

/// A node without stiffness of its own leaves pivots that cannot stand: its half goes the pivoted way, the other one
/// stays, and back when it is mended.
TEST(Registers, ALeafWithoutAPivotGoesThePivotedWayAndComesBack) {
  const Scene scene = make_chain(4, 40, 4);
  Solved s(scene, {.for_one_solution = true}, {.pivot_threshold = accepting, .refinement_steps = 0});
  ASSERT_TRUE(s.factor().ok());
  const Eigen::VectorXd b = s.random_rhs(5), x = s.solve(b);
  // A node whose own stiffness and mass vanish has no pivot until its neighbours come.
  int spoilt = -1;
  for (int e = 0; e < scene.graph.num_elements() && spoilt < 0; ++e)
    if (scene.elements[at(e)].rows() == 12 && e > 20) spoilt = e;
  ASSERT_GE(spoilt, 0);
  Eigen::MatrixXd bad = scene.elements[at(spoilt)];
  bad.topLeftCorner(6, 6).setZero();
  bad.bottomRightCorner(6, 6).setZero();
  Scene other = scene;
  other.elements[at(spoilt)] = bad;
  for (int e = 0; e < scene.graph.num_elements(); ++e)  // nor anything from beside it
    if (e != spoilt && scene.graph.element_blocks[at(scene.graph.element_begin[at(e)])] ==
                           scene.graph.element_blocks[at(scene.graph.element_begin[at(spoilt)])])
      other.elements[at(e)].topLeftCorner(6, 6).setZero();
  for (int e = 0; e < scene.graph.num_elements(); ++e) write_element(other.elements[at(e)], s.solver.element(e));
  s.solver.rescale();
  ASSERT_TRUE(s.factor().ok());
  Solved dense(other, {.for_one_solution = true},
               {.lanes = false, .pivot_threshold = accepting, .refinement_steps = 0});
  ASSERT_TRUE(dense.factor().ok());
  const Eigen::VectorXd y = s.solve(b);
  EXPECT_LE(s.report.backward_error, 1e-13);
  EXPECT_LE(s.scaled_difference(y, dense.solve(b)), 1e-6);
  const auto left = s.solver.counters().registers_left;
  EXPECT_GE(left, 1);
  write_elements(scene, s.solver);
  s.solver.rescale();
  ASSERT_TRUE(s.factor().ok());
  EXPECT_EQ(s.solver.counters().registers_left, left);
  EXPECT_TRUE(same_bits(s.solve(b), x));
}

}  // namespace
}  // namespace bough::test
