#pragma once
/// Dependent constraint rows of solvers that leave some unknowns without a pivot: null vectors of the whole matrix,
/// dense, found by products with the element matrices themselves. Internal to solve.
#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <vector>

#include "bough/solve/options.hpp"
#include "bough/solve/report.hpp"
#include "element_store.hpp"

namespace bough::solve {

/// What a solver does with the unknowns that are left without a pivot. All vectors are scaled and of the whole system.
struct RemainingUnknowns {
  /// One vector for each of them, which the matrix (left: its transpose) maps nearly to zero.
  std::function<void(Eigen::MatrixXd& right, Eigen::MatrixXd* left)> candidates;
  /// The solution with the remaining unknowns at zero.
  std::function<void(const double* b, double* x)> solve;
  /// Eliminates all of them but so many, and returns how many are left.
  std::function<int(int)> eliminate_all_but;
};

class DependentRows {
 public:
  DependentRows(const ElementStore& elements, const Scales& scales, const SolveOptions& options);

  void forget() { right_.resize(0, 0), left_.resize(0, 0); }
  /// Finds the null vectors of the matrix, orthonormal, and sets the deficiency and, if motion is part of them, the
  /// outcome.
  void decide(const tree::Walker& walker, const RemainingUnknowns& remaining, FactorStatus& status);
  /// Takes the part out of a right-hand side by which dependent rows contradict each other, and reports it.
  void make_consistent(double* b, SolveReport& report) const;
  /// Takes the part out of a scaled solution that no equation sees: multipliers become those of least norm.
  void make_least(double* x) const;
  void make_least_unscaled(double* x) const;
  /// Blocks whose multipliers are not unique.
  std::vector<int> blocks() const;
  std::size_t num_doubles() const { return static_cast<std::size_t>(right_.size() + left_.size()); }

 private:
  void sharpen(const tree::Walker& walker, const RemainingUnknowns& remaining, Eigen::MatrixXd& candidates) const;
  int count(const tree::Walker& walker, const Eigen::MatrixXd& candidates) const;
  void find(const tree::Walker& walker, const RemainingUnknowns& remaining, FactorStatus& status);

  const ElementStore& elements_;
  const Scales& scales_;
  const SolveOptions& options_;
  std::vector<std::uint8_t> is_constraint_;  ///< by unknown
  Eigen::MatrixXd right_, left_;             ///< columns
};

}  // namespace bough::solve
