#pragma once
/// One scene with its tree and solver, and the comparison with dense algebra.
#include <gtest/gtest.h>

#include <memory>

#include "bough/schedule/serial.hpp"
#include "bough/solve/hierarchical.hpp"
#include "bough/solve/reference/monolithic.hpp"
#include "random_scene.hpp"

namespace bough::test {

inline void write_element(const Eigen::MatrixXd& a, solve::ElementView view) {
  for (Eigen::Index i = 0; i < a.rows(); ++i)
    for (Eigen::Index j = 0; j < a.cols(); ++j) view[i * a.cols() + j] = a(i, j);
}

template <class Solver>
void write_elements(const Scene& scene, Solver& solver) {
  for (int e = 0; e < scene.graph.num_elements(); ++e) {
    const Eigen::MatrixXd& a = scene.elements[static_cast<std::size_t>(e)];
    write_element(a, solver.element(e));
  }
}

struct Solved {
  const Scene& scene;
  tree::Tree tree;
  solve::Hierarchical solver;
  solve::SolveReport report;

  Solved(const Scene& s, const tree::TreeOptions& tree_options, const solve::SolveOptions& options)
      : scene(s), tree(tree::make_tree(s.graph, tree_options)), solver(s.graph, tree, options) {
    write_elements(scene, solver);
  }

  solve::FactorStatus factor() { return solver.factor(schedule::make_serial_walker()); }
  Eigen::VectorXd solve(const Eigen::VectorXd& b) {
    Eigen::VectorXd x(b.size());
    report = solver.solve(schedule::make_serial_walker(), b.data(), x.data());
    return x;
  }
  /// Entries of order one in scaled rows.
  Eigen::VectorXd random_rhs(unsigned seed) const;
  /// max |x - y| / max |y| in scaled unknowns.
  double scaled_difference(const Eigen::VectorXd& x, const Eigen::VectorXd& y) const;
  /// D_r A D_c, dense.
  Eigen::MatrixXd scaled_dense() const;
};

/// Not a number is the same as itself.
bool same_bits(const Eigen::VectorXd& a, const Eigen::VectorXd& b);

/// Singular values, the largest first (floating-point traps masked: the decomposition overflows on purpose).
Eigen::VectorXd singular_values(const Eigen::MatrixXd& A);
/// Minimum-norm solution of a system whose rows may depend on each other, and the rank of its matrix; pivots below
/// `threshold` times the largest count as 0.
Eigen::VectorXd least_solution(const Eigen::MatrixXd& A, const Eigen::VectorXd& b, double threshold);
int rank_of(const Eigen::MatrixXd& A, double threshold);
Eigen::VectorXd solve_with_full_pivoting(const Eigen::MatrixXd& A, const Eigen::VectorXd& b);

/// Largest over smallest singular value.
double condition_of(const Eigen::MatrixXd& A);

/// Column scales before they are rounded to powers of two, from the definition (dense).
Eigen::VectorXd exact_column_scale(const Solved& s);

/// Factor, solve, and compare with Eigen's fully pivoted LU in scaled variables: the backward error stays below the
/// bar, the difference of the solutions below condition times it.
void expect_matches_dense(const Scene& scene, const tree::TreeOptions& tree_options, double backward_bar,
                          const solve::SolveOptions& options = {.refinement_steps = 0});

}  // namespace bough::test
