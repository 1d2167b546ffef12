/// Matrices of files as problems of the benchmark: the blocks and elements found from a pattern are the matrix, and the
/// solver's solution is that of dense LU.
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <random>
#include <set>
#include <sstream>
#include <stdexcept>
#include <string>

#include "../../benchmarks/support/matrix_file.hpp"
#include "../../benchmarks/support/transversal.hpp"
#include "bough/schedule/serial.hpp"
#include "bough/solve/hierarchical.hpp"

namespace bough::test {
namespace {

using bench::Problem;
using blocks::BlockKind;

std::size_t at(std::int64_t i) { return static_cast<std::size_t>(i); }

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

Eigen::MatrixXd dense(const bench::SparseMatrix& a) {
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(a.n, a.n);
  for (int j = 0; j < a.n; ++j)
    for (int k = a.column_begin[at(j)]; k < a.column_begin[at(j) + 1]; ++k) out(a.row[at(k)], j) += a.value[at(k)];
  return out;
}

/// The sum of the element matrices, in the order of the matrix.
Eigen::MatrixXd sum_of_elements(const Problem& p) {
  std::vector<int> unknown_at(p.place.size());
  for (std::size_t i = 0; i < p.place.size(); ++i) unknown_at[at(p.place[i])] = static_cast<int>(i);
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(p.matrix.n, p.matrix.n);
  for (int e = 0; e < p.graph.num_elements(); ++e) {
    std::vector<int> unknowns;
    for (auto k = p.graph.element_begin[at(e)]; k < p.graph.element_begin[at(e) + 1]; ++k) {
      const int b = p.graph.element_blocks[at(k)];
      for (int u = p.unknown_begin[at(b)]; u < p.unknown_begin[at(b) + 1]; ++u) unknowns.push_back(unknown_at[at(u)]);
    }
    for (std::size_t i = 0; i < unknowns.size(); ++i)
      for (std::size_t j = 0; j < unknowns.size(); ++j)
        out(unknowns[i], unknowns[j]) += p.elements[at(e)][i * unknowns.size() + j];
  }
  return out;
}

Eigen::VectorXd solve_with_bough(const Problem& p, solve::FactorStatus& status) {
  const tree::Tree tree = tree::make_tree(p.graph);
  solve::Hierarchical solver(p.graph, tree,
                             {.symmetry = p.is_symmetric() ? solve::Symmetry::symmetric : solve::Symmetry::general});
  for (int e = 0; e < p.graph.num_elements(); ++e)
    for (std::size_t k = 0; k < p.elements[at(e)].size(); ++k)
      solver.element(e)[static_cast<std::int64_t>(k)] = p.elements[at(e)][k];
  const tree::Walker walker = schedule::make_serial_walker();
  status = solver.factor(walker);
  std::vector<double> work(p.rhs.size());
  for (std::size_t i = 0; i < work.size(); ++i) work[at(p.place[i])] = p.rhs[i];
  if (status.ok()) (void)solver.solve(walker, work.data(), work.data());
  Eigen::VectorXd x(p.matrix.n);
  for (std::size_t i = 0; i < work.size(); ++i) x[static_cast<Eigen::Index>(i)] = work[at(p.place[i])];
  return x;
}

bench::SparseMatrix sparse(const Eigen::MatrixXd& a) {
  bench::SparseMatrix out;
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
bench::SparseMatrix make_grid(int n, bool is_symmetric, std::vector<int>& order) {
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

TEST(MatrixFile, NodesElementsAndMultipliersOfAGridAreFoundAgainAndSolved) {
  for (const bool is_symmetric : {true, false}) {
    constexpr int n = 9;
    std::vector<int> order;
    Problem p;
    p.values = is_symmetric ? bench::Values::symmetric : bench::Values::unsymmetric;
    p.matrix = make_grid(n, is_symmetric, order);
    add_blocks(p);
    const Eigen::MatrixXd a = dense(p.matrix);
    EXPECT_EQ(sum_of_elements(p), a);  // every entry is in one element
    // Inner nodes are blocks of three; the two rows are one block of multipliers.
    EXPECT_EQ(std::count(p.graph.block_size.begin(), p.graph.block_size.end(), 3), n * n);
    ASSERT_EQ(p.graph.num_blocks(), n * n + 1);
    const auto multiplier = std::find(p.graph.block_kind.begin(), p.graph.block_kind.end(), BlockKind::multiplier);
    ASSERT_NE(multiplier, p.graph.block_kind.end());
    EXPECT_EQ(p.graph.block_size[at(multiplier - p.graph.block_kind.begin())], 2);
    EXPECT_LE(2 * p.graph.num_elements(), 3 * (n - 1) * (n - 1));  // the cells, and half as many others at most

    p.rhs.assign(at(p.matrix.n), 0.0);
    for (std::size_t i = 0; i < p.rhs.size(); ++i) p.rhs[i] = std::sin(static_cast<double>(i));
    solve::FactorStatus status;
    const Eigen::VectorXd x = solve_with_bough(p, status);
    ASSERT_TRUE(status.ok());
    EXPECT_EQ(status.deficiency, 0);
    const Eigen::VectorXd expected = a.partialPivLu().solve(Eigen::Map<const Eigen::VectorXd>(p.rhs.data(), x.size()));
    EXPECT_LE((x - expected).cwiseAbs().maxCoeff(), 1e-10 * expected.cwiseAbs().maxCoeff());
  }
}

/// Zeros on the diagonal next to each other, rows without any entry beside the diagonal, and an unsymmetric pattern.
TEST(MatrixFile, PatternsThatNoStructureHasAreSolvedAsWell) {
  const File file(
      "%%MatrixMarket matrix coordinate real general\n% a comment\n\n6 6 10\n"
      "1 2 1.0\n2 1 1.5\n2 3 0.5\n3 2 -1.0\n3 3 4.0\n4 4 2e0\n5 6 3.0\n6 5 2.0\n1 3 0.25\n6 6 0.0\n");
  const Problem p = bench::make_problem(file.path());
  EXPECT_FALSE(p.is_symmetric());
  EXPECT_EQ(p.matrix.num_entries(), 9);  // the zero is left out
  const Eigen::MatrixXd a = dense(p.matrix);
  EXPECT_EQ(sum_of_elements(p), a);
  solve::FactorStatus status;
  const Eigen::VectorXd x = solve_with_bough(p, status);
  ASSERT_TRUE(status.ok());
  EXPECT_LE((x - Eigen::VectorXd::Ones(6)).cwiseAbs().maxCoeff(), 1e-13);  // the right-hand side is A 1
}

TEST(MatrixFile, ASymmetricFileStandsForBothTriangles) {
  const File definite("%%MatrixMarket matrix coordinate real symmetric\n2 2 3\n1 1 2\n2 1 1\n2 2 2\n");
  const Problem p = bench::make_problem(definite.path());
  EXPECT_TRUE(p.is_symmetric());
  EXPECT_TRUE(p.is_definite);
  EXPECT_EQ(dense(p.matrix), (Eigen::MatrixXd(2, 2) << 2.0, 1.0, 1.0, 2.0).finished());
  EXPECT_EQ(p.rhs, (std::vector<double>{3.0, 3.0}));
  const File indefinite("%%MatrixMarket matrix coordinate integer symmetric\n2 2 3\n1 1 2\n2 1 3\n2 2 2\n");
  EXPECT_FALSE(bench::make_problem(indefinite.path()).is_definite);
}

TEST(MatrixFile, ASingularMatrixIsFoundToBeSo) {
  const File file("%%MatrixMarket matrix coordinate real symmetric\n3 3 4\n1 1 1\n2 1 -1\n2 2 1\n3 3 1\n");
  solve::FactorStatus status;
  (void)solve_with_bough(bench::make_problem(file.path()), status);
  EXPECT_EQ(status.outcome, solve::FactorOutcome::singular);
}

#ifdef BOUGH_HAS_KLU
/// An order is found if and only if there is one among all of them, tried one by one.
TEST(MatrixFile, RowsArePermutedToADiagonalWithoutZeros) {
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
    bench::SparseMatrix permuted = sparse(a);
    ASSERT_EQ(bench::permute_rows(permuted), exists);
    const Eigen::MatrixXd b = dense(permuted);
    if (!exists) {
      EXPECT_EQ(b, a);
      continue;
    }
    ++possible;
    EXPECT_TRUE(is_full(b));
    bool is_of_a = false;  // the rows are those of A
    std::sort(order.begin(), order.end());
    do {
      is_of_a = is_of_a || b == a(order, Eigen::all);
    } while (std::next_permutation(order.begin(), order.end()));
    EXPECT_TRUE(is_of_a);
  }
  EXPECT_GT(possible, trials / 10);
  EXPECT_LT(possible, trials - trials / 10);
}

/// Equations in an arbitrary order, zeros on the diagonal: the reader puts them in another one, and they are solved.
TEST(MatrixFile, EquationsInAnyOrderAreSolved) {
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
  std::string text = "%%MatrixMarket matrix coordinate real general\n";
  const bench::SparseMatrix entries = sparse(a);
  ASSERT_LT(bench::find_symmetry(entries), 0.5);
  std::ostringstream out;
  out.precision(17);
  out << n << ' ' << n << ' ' << entries.num_entries() << '\n';
  for (int j = 0; j < n; ++j)
    for (int k = entries.column_begin[at(j)]; k < entries.column_begin[at(j) + 1]; ++k)
      out << entries.row[at(k)] + 1 << ' ' << j + 1 << ' ' << entries.value[at(k)] << '\n';
  const File file(text + out.str());
  const Problem p = bench::make_problem(file.path());
  ASSERT_FALSE((a.diagonal().array() != 0.0).all());
  EXPECT_TRUE((dense(p.matrix).diagonal().array() != 0.0).all());
  solve::FactorStatus status;
  const Eigen::VectorXd x = solve_with_bough(p, status);
  ASSERT_TRUE(status.ok());
  EXPECT_LE((x - Eigen::VectorXd::Ones(n)).cwiseAbs().maxCoeff(), 1e-12);  // the right-hand side is A 1
}
#endif

TEST(MatrixFile, WhatIsWrongWithAFileIsToldWithItsLine) {
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
