/// Matrices without a scene: the blocks and elements found from a pattern are the matrix, and every method solves what
/// dense LU solves.
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <optional>
#include <random>
#include <stdexcept>
#include <string>

#include "../../benchmarks/support/matrix_file.hpp"
#include "bough/schedule/serial.hpp"
#include "bough/solve/matrix_blocks.hpp"
#include "bough/solve/matrix_solver.hpp"

namespace bough::test {
namespace {

using blocks::BlockKind;
using solve::MatrixMethod;
using solve::MatrixSolver;
using solve::SparseColumns;
using solve::Symmetry;

std::size_t at(std::int64_t i) { return static_cast<std::size_t>(i); }

using Lists = std::vector<std::vector<int>>;

/// A file that is removed at the end.
class File {
 public:
  explicit File(const std::string& text)
      : path_(std::filesystem::temp_directory_path() /
              ("bough_matrix_" + std::to_string(std::random_device{}()) + ".mtx")) {
    std::ofstream(path_) << text;
  }
  ~File() { std::filesystem::remove(path_); }
  File(const File&) = delete;
  File& operator=(const File&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

Eigen::MatrixXd dense(const SparseColumns& a) {
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(a.n, a.n);
  for (int j = 0; j < a.n; ++j)
    for (int k = a.column_begin[at(j)]; k < a.column_begin[at(j) + 1]; ++k) out(a.row[at(k)], j) += a.value[at(k)];
  return out;
}

/// The sum of the element matrices, in the order of the matrix.
Eigen::MatrixXd sum_of_elements(const SparseColumns& a, const solve::MatrixBlocks& b) {
  std::vector<int> unknown_at(b.place.size());
  for (std::size_t i = 0; i < b.place.size(); ++i) unknown_at[at(b.place[i])] = static_cast<int>(i);
  Lists unknowns(at(b.graph.num_elements()));
  for (std::size_t e = 0; e < unknowns.size(); ++e)
    for (auto k = b.graph.element_begin[e]; k < b.graph.element_begin[e + 1]; ++k) {
      const int block = b.graph.element_blocks[at(k)];
      for (int u = b.unknown_begin[at(block)]; u < b.unknown_begin[at(block) + 1]; ++u)
        unknowns[e].push_back(unknown_at[at(u)]);
    }
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(a.n, a.n);
  for (std::size_t k = 0; k < a.value.size(); ++k) {
    const std::vector<int>& of = unknowns[at(b.element[k])];
    const auto n = static_cast<std::int64_t>(of.size());
    out(of[at(b.offset[k] / n)], of[at(b.offset[k] % n)]) += a.value[k];
  }
  return out;
}

struct Solved {
  bool ok = false;
  MatrixMethod method = MatrixMethod::tree;
  double backward_error = 1.0;
  std::string findings;
  Eigen::VectorXd x;
};

Solved solve_with(MatrixSolver& solver, const SparseColumns& a, const Eigen::VectorXd& b) {
  const tree::Walker walker = schedule::make_serial_walker();
  Solved out;
  out.x = b;
  out.ok = solver.factor(walker, a.value);
  if (out.ok) out.backward_error = solver.solve(walker, b.data(), out.x.data()).backward_error;
  out.method = solver.method();
  out.findings = solver.findings();
  return out;
}

Solved solve_once(const SparseColumns& a, Symmetry symmetry, std::optional<MatrixMethod> method = {}) {
  MatrixSolver solver(schedule::make_serial_walker(), a, symmetry, method);
  return solve_with(solver, a, dense(a) * Eigen::VectorXd::Ones(a.n));
}

constexpr MatrixMethod methods[] = {MatrixMethod::tree, MatrixMethod::ldlt, MatrixMethod::lu};

SparseColumns sparse(const Eigen::MatrixXd& a) {
  SparseColumns out;
  out.n = static_cast<int>(a.rows());
  out.column_begin.assign(1, 0);
  for (int j = 0; j < out.n; ++j) {
    for (int i = 0; i < out.n; ++i)
      if (a(i, j) != 0.0) {
        out.row.push_back(i);
        out.value.push_back(a(i, j));
      }
    out.column_begin.push_back(out.num_entries());
  }
  return out;
}

/// Three unknowns a node, elements of four nodes on a grid, two nodes tied by two rows of multipliers: what a program
/// of mechanics would write, its unknowns shuffled.
SparseColumns make_grid(int n, bool is_symmetric, std::vector<int>& order) {
  const int motions = 3 * n * n, size = motions + 2;
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  order.resize(at(size));
  for (int i = 0; i < size; ++i) order[at(i)] = i;
  std::shuffle(order.begin(), order.end(), random);
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(size, size);
  const auto add = [&](const std::vector<int>& unknowns, double diagonal) {
    for (int i : unknowns)
      for (int j : unknowns) a(order[at(i)], order[at(j)]) += (i == j ? diagonal : 0.0) + uniform(random);
  };
  for (int r = 0; r + 1 < n; ++r)
    for (int c = 0; c + 1 < n; ++c) {
      std::vector<int> unknowns;
      for (int node : {r * n + c, r * n + c + 1, (r + 1) * n + c, (r + 1) * n + c + 1})
        for (int k = 0; k < 3; ++k) unknowns.push_back(3 * node + k);
      add(unknowns, 20.0);
    }
  for (int row = 0; row < 2; ++row)
    for (int k = 0; k < 3; ++k)
      for (int node : {0, n * n - 1})
        a(order[at(motions + row)], order[at(3 * node + k)]) = a(order[at(3 * node + k)], order[at(motions + row)]) =
            uniform(random);
  if (is_symmetric) a = Eigen::MatrixXd(0.5 * (a + a.transpose()));
  return sparse(a);
}

TEST(Matrices, NodesElementsAndMultipliersOfAGridAreFoundAgainAndSolved) {
  for (const bool is_symmetric : {true, false}) {
    constexpr int n = 9;
    std::vector<int> order;
    const SparseColumns matrix = make_grid(n, is_symmetric, order);
    const solve::MatrixBlocks found = solve::find_blocks(matrix);
    const Eigen::MatrixXd a = dense(matrix);
    EXPECT_EQ(sum_of_elements(matrix, found), a);  // every entry is in one element
    // Inner nodes are blocks of three; the two rows are one block of multipliers.
    const blocks::BlockGraph& graph = found.graph;
    EXPECT_EQ(std::count(graph.block_size.begin(), graph.block_size.end(), 3), n * n);
    ASSERT_EQ(graph.num_blocks(), n * n + 1);
    const auto multiplier = std::find(graph.block_kind.begin(), graph.block_kind.end(), BlockKind::multiplier);
    ASSERT_NE(multiplier, graph.block_kind.end());
    EXPECT_EQ(graph.block_size[at(multiplier - graph.block_kind.begin())], 2);
    EXPECT_LE(2 * graph.num_elements(), 3 * (n - 1) * (n - 1));  // the cells, and half as many others at most

    Eigen::VectorXd b(a.rows());
    for (Eigen::Index i = 0; i < b.size(); ++i) b[i] = std::sin(static_cast<double>(i));
    const Eigen::VectorXd expected = a.partialPivLu().solve(b);
    for (const MatrixMethod m : methods) {
      if (m == MatrixMethod::ldlt && !is_symmetric) continue;
      MatrixSolver solver(schedule::make_serial_walker(), matrix,
                          is_symmetric ? Symmetry::symmetric : Symmetry::general, m);
      const Solved s = solve_with(solver, matrix, b);
      ASSERT_TRUE(s.ok) << name_of(m);
      EXPECT_EQ(s.findings, "");
      EXPECT_LE((s.x - expected).cwiseAbs().maxCoeff(), 1e-10 * expected.cwiseAbs().maxCoeff()) << name_of(m);
    }
  }
}

/// Zeros on the diagonal next to each other, rows without any entry beside the diagonal, and an unsymmetric pattern.
TEST(Matrices, PatternsThatNoStructureHasAreSolvedAsWell) {
  const File file(
      "%%MatrixMarket matrix coordinate real general\n% a comment\n\n6 6 10\n"
      "1 2 1.0\n2 1 1.5\n2 3 0.5\n3 2 -1.0\n3 3 4.0\n4 4 2e0\n5 6 3.0\n6 5 2.0\n1 3 0.25\n6 6 0.0\n");
  const SparseColumns a = bench::read_matrix_file(file.path()).matrix;
  EXPECT_EQ(a.num_entries(), 9);  // the zero is left out
  EXPECT_EQ(sum_of_elements(a, solve::find_blocks(a)), dense(a));
  for (const MatrixMethod m : {MatrixMethod::tree, MatrixMethod::lu}) {
    const Solved s = solve_once(a, Symmetry::general, m);
    ASSERT_TRUE(s.ok) << name_of(m);
    EXPECT_LE((s.x - Eigen::VectorXd::Ones(6)).cwiseAbs().maxCoeff(), 1e-13) << name_of(m);
  }
}

/// Sparse matrices at random, definite, indefinite and without symmetry, with zeros on the diagonal: every method, and
/// the one that is chosen, has a backward error of round-off, whatever values come later.
TEST(Matrices, MethodsAgreeOnMatricesAtRandom) {
  std::mt19937 random(17);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  constexpr int trials = 40;
  int tried = 0;
  for (int trial = 0; trial < trials; ++trial) {
    const int n = 20 + static_cast<int>(random() % 60);
    const bool is_symmetric = trial % 3 != 2, is_definite = trial % 3 == 0;
    Eigen::MatrixXd pattern = Eigen::MatrixXd::Identity(n, n);
    for (int k = 0; k < 3 * n; ++k) {
      const auto i = static_cast<Eigen::Index>(random() % at(n)), j = static_cast<Eigen::Index>(random() % at(n));
      pattern(i, j) = 1.0;
      if (is_symmetric) pattern(j, i) = 1.0;
    }
    if (!is_definite)
      for (int i = 1; i < n; i += 5) pattern(i, i) = 0.0;
    const auto fill = [&] {
      Eigen::MatrixXd a = pattern;
      for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) a(i, j) *= uniform(random);
      if (is_symmetric) a = Eigen::MatrixXd(a + a.transpose());
      if (is_definite) a.diagonal().array() += a.cwiseAbs().rowwise().sum().maxCoeff();
      return a;
    };
    const Symmetry symmetry = is_symmetric ? Symmetry::symmetric : Symmetry::general;
    const SparseColumns first = sparse(fill());
    std::vector<std::optional<MatrixMethod>> wanted{std::nullopt, MatrixMethod::tree, MatrixMethod::lu};
    if (is_symmetric) wanted.emplace_back(MatrixMethod::ldlt);
    for (const auto& m : wanted) {
      MatrixSolver solver(schedule::make_serial_walker(), first, symmetry, m);
      for (int again = 0; again < 3; ++again) {
        const SparseColumns a = again == 0 ? first : sparse(fill());
        ASSERT_EQ(a.row, first.row);
        const Eigen::VectorXd ones = Eigen::VectorXd::Ones(n), b = dense(a) * ones;
        const Eigen::VectorXd singular = Eigen::JacobiSVD<Eigen::MatrixXd>(dense(a)).singularValues();
        if (singular(n - 1) < 1e-10 * singular(0)) continue;
        ++tried;
        const Solved s = solve_with(solver, a, b);
        ASSERT_TRUE(s.ok) << trial << ": " << s.findings;
        // Ten times what calls for a refinement; the second bound, by another norm of the same, leaves twice that.
        EXPECT_LE(s.backward_error, 1e-13) << trial << ": " << name_of(s.method);
        EXPECT_LE((dense(a) * s.x - b).cwiseAbs().maxCoeff(),
                  2e-13 * (dense(a).cwiseAbs().rowwise().sum().maxCoeff() * s.x.cwiseAbs().maxCoeff() +
                           b.cwiseAbs().maxCoeff()));
      }
    }
  }
  EXPECT_GT(tried, 3 * trials);
}

/// Elimination without pivoting loses all digits where a pivot is small by its value: another method takes over.
TEST(Matrices, AMethodThatIsNotSoundForTheValuesIsReplaced) {
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(40, 40);
  for (int i = 0; i < 40; i += 2) {
    a(i, i) = 1e-18;
    a(i, i + 1) = a(i + 1, i) = 1.0;
    a(i + 1, i + 1) = -1e-18;
    if (i > 0) a(i, i - 1) = a(i - 1, i) = 0.25;
  }
  const SparseColumns matrix = sparse(a);
  MatrixSolver solver(schedule::make_serial_walker(), matrix, Symmetry::symmetric, MatrixMethod::ldlt);
  const Solved s = solve_with(solver, matrix, a * Eigen::VectorXd::Ones(40));
  ASSERT_TRUE(s.ok);
  EXPECT_LE(s.backward_error, 1e-13);
  const Solved chosen = solve_once(matrix, Symmetry::symmetric);
  ASSERT_TRUE(chosen.ok);
  EXPECT_LE((chosen.x - Eigen::VectorXd::Ones(40)).cwiseAbs().maxCoeff(), 1e-12);
}

/// A chain in which every unknown has one of its neighbours is factored one entry after the other; full blocks are not.
TEST(Matrices, TheMethodFollowsThePattern) {
  constexpr int n = 400;
  Eigen::MatrixXd chain = Eigen::MatrixXd::Zero(n, n);
  for (int i = 0; i < n; ++i) {
    chain(i, i) = 2.5;
    if (i > 0) chain(i, i - 1) = -1.0;
    if (i + 1 < n) chain(i, i + 1) = -1.0;
  }
  EXPECT_EQ(solve_once(sparse(chain), Symmetry::symmetric).method, MatrixMethod::ldlt);
  const bool has_lu =
      MatrixSolver(schedule::make_serial_walker(), sparse(chain), Symmetry::general, MatrixMethod::lu).method() ==
      MatrixMethod::lu;
  EXPECT_EQ(solve_once(sparse(chain), Symmetry::general).method, has_lu ? MatrixMethod::lu : MatrixMethod::tree);
  Eigen::MatrixXd full = Eigen::MatrixXd::Random(n, n);
  full.diagonal().array() += 30.0;
  EXPECT_EQ(solve_once(sparse(full), Symmetry::general).method, MatrixMethod::tree);
}

TEST(Matrices, ASymmetricFileStandsForBothTriangles) {
  const File definite("%%MatrixMarket matrix coordinate real symmetric\n2 2 3\n1 1 2\n2 1 1\n2 2 2\n");
  const bench::Problem p = bench::make_problem(definite.path());
  EXPECT_TRUE(p.is_symmetric());
  EXPECT_TRUE(p.is_definite);
  EXPECT_EQ(dense(p.matrix), (Eigen::MatrixXd(2, 2) << 2.0, 1.0, 1.0, 2.0).finished());
  EXPECT_EQ(p.rhs, (std::vector<double>{3.0, 3.0}));
  const File indefinite("%%MatrixMarket matrix coordinate integer symmetric\n2 2 3\n1 1 2\n2 1 3\n2 2 2\n");
  EXPECT_FALSE(bench::make_problem(indefinite.path()).is_definite);
}

TEST(Matrices, ASingularMatrixIsFoundToBeSo) {
  Eigen::MatrixXd a = Eigen::MatrixXd::Identity(3, 3);
  a(0, 1) = a(1, 0) = -1.0;
  const Solved s = solve_once(sparse(a), Symmetry::symmetric);
  EXPECT_FALSE(s.ok);
  EXPECT_EQ(s.findings.substr(0, 8), "singular");
  // Such a matrix speaks against no method: other values of the pattern are factored as if it had not been.
  MatrixSolver solver(schedule::make_serial_walker(), sparse(a), Symmetry::symmetric);
  EXPECT_FALSE(solve_with(solver, sparse(a), Eigen::VectorXd::Ones(3)).ok);
  a(0, 0) = 3.0;
  const Solved regular = solve_with(solver, sparse(a), a * Eigen::VectorXd::Ones(3));
  EXPECT_TRUE(regular.ok);
  EXPECT_EQ(regular.findings, "");
  EXPECT_LE((regular.x - Eigen::VectorXd::Ones(3)).cwiseAbs().maxCoeff(), 1e-14);
  a(0, 1) = a(1, 0) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(solve_once(sparse(a), Symmetry::symmetric).findings, "a number is not finite");
}

#ifdef BOUGH_HAS_KLU
/// An order is found if and only if there is one among all of them, tried one by one.
TEST(Matrices, RowsArePermutedToADiagonalWithoutZeros) {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  int possible = 0;
  constexpr int trials = 200;
  for (int trial = 0; trial < trials; ++trial) {
    constexpr int n = 6;
    Eigen::MatrixXd a = Eigen::MatrixXd::Zero(n, n);
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j)
        if (uniform(random) < 0.3) a(i, j) = 1.0 + uniform(random);
    const auto is_full = [](const Eigen::MatrixXd& m) { return (m.diagonal().array() != 0.0).all(); };
    std::vector<int> order{0, 1, 2, 3, 4, 5};
    bool exists = false;
    do {
      exists = exists || is_full(a(order, Eigen::all));
    } while (std::next_permutation(order.begin(), order.end()));
    const std::vector<int> place = solve::rows_of_full_diagonal(sparse(a));
    ASSERT_EQ(!place.empty(), exists);
    if (!exists) continue;
    ++possible;
    Eigen::MatrixXd b = Eigen::MatrixXd::Zero(n, n);
    for (int i = 0; i < n; ++i) b.row(place[at(i)]) += a.row(i);
    EXPECT_TRUE(is_full(b));
    EXPECT_TRUE(std::is_permutation(place.begin(), place.end(), order.begin()));
  }
  EXPECT_GT(possible, trials / 10);
  EXPECT_LT(possible, trials - trials / 10);
}

/// Equations in an arbitrary order, zeros on the diagonal.
TEST(Matrices, EquationsInAnyOrderAreSolved) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  constexpr int n = 60;
  Eigen::MatrixXd a = Eigen::MatrixXd::Zero(n, n);
  std::vector<int> row_of(n);
  for (int i = 0; i < n; ++i) row_of[at(i)] = i;
  std::shuffle(row_of.begin(), row_of.end(), random);
  for (int i = 0; i < n; ++i) {
    a(row_of[at(i)], i) = 4.0;
    for (int k = 0; k < 3; ++k) a(row_of[at(i)], static_cast<int>(random() % n)) += uniform(random);
    a.row(row_of[at(i)]) *= std::pow(10.0, static_cast<double>(i % 7));
  }
  const SparseColumns matrix = sparse(a);
  ASSERT_LT(solve::pattern_symmetry(matrix), 0.5);
  ASSERT_FALSE((a.diagonal().array() != 0.0).all());
  for (const MatrixMethod m : {MatrixMethod::tree, MatrixMethod::lu}) {
    const Solved s = solve_once(matrix, Symmetry::general, m);
    ASSERT_TRUE(s.ok) << name_of(m);
    EXPECT_LE((s.x - Eigen::VectorXd::Ones(n)).cwiseAbs().maxCoeff(), 1e-12) << name_of(m);
  }
}
#endif

TEST(Matrices, WhatIsWrongWithAFileIsToldWithItsLine) {
  const auto complaint = [](const std::string& text) -> std::string {
    const File file(text);
    try {
      (void)bench::read_matrix_file(file.path());
    } catch (const std::runtime_error& e) {
      const std::string what = e.what();
      return what.substr(file.path().string().size());
    }
    return "";
  };
  const std::string head = "%%MatrixMarket matrix coordinate real general\n";
  EXPECT_EQ(complaint(""), ":1: the file is empty");
  EXPECT_NE(complaint("%%MatrixMarket matrix array real general\n").find(":1: expected"), std::string::npos);
  EXPECT_NE(complaint("%%MatrixMarket matrix coordinate complex general\n").find(":1: expected"), std::string::npos);
  EXPECT_NE(complaint(head + "% c\n2 3 1\n").find(":3: expected"), std::string::npos);
  EXPECT_NE(complaint(head + "2 2 1\n3 1 1.0\n").find(":3: expected row"), std::string::npos);
  EXPECT_NE(complaint(head + "2 2 1\n1 1 x\n").find(":3: expected row"), std::string::npos);
  EXPECT_NE(complaint(head + "2 2 2\n1 1 1.0\n").find(":4: the file ends, expected an entry"), std::string::npos);
  EXPECT_THROW((void)bench::read_matrix_file("no_such_file.mtx"), std::runtime_error);
}

}  // namespace
}  // namespace bough::test
