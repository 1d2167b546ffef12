#pragma once
/// A direct solver for a sparse matrix of any origin, which has no scene and no elements.
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "bough/solve/options.hpp"
#include "bough/solve/sparse_columns.hpp"
#include "bough/tree/walker.hpp"

namespace bough::solve {

/// How a matrix is factored.
enum class MatrixMethod {
  tree,  ///< Hierarchical, on blocks and elements found from the pattern: where unknowns come in blocks, or fill is large
  ldlt,  ///< symmetric matrices without large fill: one entry after the other, without pivoting, by Eigen's
         ///< SimplicialLDLT in the best of two orders. Its solutions are checked.
  lu,    ///< others without large fill: one entry after the other, by KLU
};

/// What a method is expected to take, from its symbolic analysis.
struct MatrixCost {
  MatrixMethod method = MatrixMethod::tree;
  double seconds = 0.0;  ///< of a factorization and a solution on the machine of the fit, whose ratios count; infinite:
                         ///< its solution of a first system was none
};

/// A x = b for one pattern and many values. The method is the one that the analysis of the pattern expects to be the
/// fastest. One that cannot factor the values, or whose solution has a backward error above largest_error, is replaced
/// by the next one for good.
class MatrixSolver {
 public:
  /// a: the pattern (n >= 1) without entries that are zero, and values with which methods can be tried. symmetry: of all values
  /// to come. method: the first one, instead of that expected to be the fastest.
  MatrixSolver(const tree::Walker& walker, const SparseColumns& a, Symmetry symmetry,
               std::optional<MatrixMethod> method = {});
  ~MatrixSolver();
  MatrixSolver(MatrixSolver&&) noexcept;
  MatrixSolver& operator=(MatrixSolver&&) noexcept;

  /// Factors a matrix of the pattern, whose values are in the order of SparseColumns. False: no method could, or a number
  /// is not finite (findings()).
  [[nodiscard]] bool factor(const tree::Walker& walker, std::span<const double> values);

  struct Solution {
    double backward_error = 0.0;  ///< as backward_error(), of the solution returned
    int refinement_steps = 0;
  };
  /// x = A^-1 b, refined once where the backward error is above 1e-14. x may be b. Precondition: factor() was true.
  Solution solve(const tree::Walker& walker, const double* b, double* x);

  /// The same with the present method, without backward error, refinement and replacement. A method was tried on the
  /// values given at first.
  void solve_unchecked(const tree::Walker& walker, const double* b, double* x);

  MatrixMethod method() const;
  std::span<const MatrixCost> costs() const;  ///< of the methods compared, the chosen one first
  std::string findings() const;               ///< of the last factorization: singular, or nearly so; empty: nothing
  double factor_flops() const;                ///< of a factorization, as the analysis expects
  double memory_bytes() const;

  /// A backward error above this is no solution.
  static constexpr double largest_error = 1e-10;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

const char* name_of(MatrixMethod method);

}  // namespace bough::solve
