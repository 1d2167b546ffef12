#pragma once
/// Factorizations of sparse matrices one entry after the other, by libraries. Internal to solve.
#include <Eigen/SparseCholesky>
#include <memory>
#include <span>
#include <vector>

#include "bough/solve/sparse_columns.hpp"

namespace bough::solve {

/// Time of a factorization and a solution, one entry after the other [s]: per column, entry of the matrix, entry of the
/// factors and flop, fitted as in matrix_solver.cpp.
inline double scalar_seconds(const SparseColumns& a, double entries, double flops) {
  return 3e-8 * a.n + 2e-9 * static_cast<double>(a.num_entries()) + 4e-9 * entries + 4.6e-10 * flops;
}

/// L D L^T of a symmetric matrix without pivoting, in a given order of elimination.
class ScalarLdlt {
 public:
  ScalarLdlt(const SparseColumns& a, const std::vector<int>& order);
  /// False: a pivot is zero or not finite.
  bool factor(std::span<const double> values);
  void solve(const double* b, double* x);
  double flops() const { return flops_; }
  double entries() const { return entries_; }
  double seconds() const { return seconds_; }  ///< expected: scalar_seconds()
  double pivot_ratio() const;                  ///< smallest magnitude of a pivot over the largest

 private:
  // The upper triangle in the order of elimination: Eigen then takes it as it is.
  using Matrix = Eigen::SparseMatrix<double, Eigen::ColMajor, int>;
  std::vector<int> place_, from_;  ///< by unknown: its place in the order; by entry: that of the matrix given
  Matrix upper_;
  Eigen::SimplicialLDLT<Matrix, Eigen::Upper, Eigen::NaturalOrdering<int>> factor_;
  Eigen::VectorXd work_;
  double flops_ = 0.0, entries_ = 0.0, seconds_ = 0.0;
};

/// Orders of elimination for it: approximate minimum degree, by Eigen.
std::vector<int> minimum_degree_order(const SparseColumns& a);

/// L U with partial pivoting by KLU, in the order of the columns that is expected to be the fastest: approximate minimum
/// degree of A + A^T or of A^T A, or the one given.
class ScalarLu {
 public:
  ScalarLu(const SparseColumns& a, const std::vector<int>& order);
  ~ScalarLu();
  ScalarLu(const ScalarLu&) = delete;
  ScalarLu& operator=(const ScalarLu&) = delete;
  static bool is_available();
  /// With the pivots of the last factorization where they can be used. False: singular.
  bool factor(const SparseColumns& a, bool with_new_pivots);
  void solve(const double* b, double* x);
  bool is_regular() const;  ///< the matrix given at first could be factored
  double flops() const;
  double seconds() const;  ///< expected: scalar_seconds()
  double pivot_ratio() const;
  double memory_bytes() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace bough::solve
