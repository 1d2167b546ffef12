#pragma once
/// The monolithic oracles beside KLU: the same matrix, assembled to one sparse matrix and factored by another library.
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "bough/blocks/block_graph.hpp"
#include "bough/solve/element_view.hpp"
#include "bough/solve/options.hpp"
#include "bough/solve/report.hpp"
#include "bough/tree/walker.hpp"

namespace bough::solve {

/// The library that factors the sparse matrix.
enum class Library {
  sparse_lu,  ///< Eigen's SparseLU: supernodal, partial pivoting, COLAMD [Demmel et al. 1999]. Always available.
  umfpack,    ///< UMFPACK: unsymmetric multifrontal [Davis 2004]. GPL: only in builds with BOUGH_WITH_GPL.
  cholmod,  ///< CHOLMOD: L D L^T [Chen et al. 2008]; symmetric matrices only. GPL: only in builds with BOUGH_WITH_GPL.
};

/// The contract is that of AnySolver, serial; allocates in factor().
///
/// Dependent constraint rows: if two inverse iterations find a vector of multipliers only that the matrix maps nearly
/// to zero, the multipliers get a diagonal -d^2 (d^2 = 1e-7 in scaled variables, 1e-10 for CHOLMOD), and the solution
/// is refined with the true matrix; the limit is the solution with least multipliers. The deficiency is then unknown
/// (-1).
/// CHOLMOD always factors that quasi-definite matrix, which needs no pivoting [Vanderbei 1995]; a matrix that is not
/// symmetric to 1e-9 is refused with FactorOutcome::unsymmetric.
class SparseOracle {
 public:
  /// False if this build does not include the library; factor() then returns FactorOutcome::backend.
  static bool available(Library library);
  static std::string_view name_of(Library library);

  SparseOracle(const blocks::BlockGraph& graph, const tree::Tree& tree, Library library,
               const SolveOptions& options = {});
  ~SparseOracle();
  SparseOracle(SparseOracle&&) noexcept;
  SparseOracle& operator=(SparseOracle&&) noexcept;

  ElementView element(int id);
  ConstElementView element(int id) const;
  std::span<const ElementBatch> batches() const;
  void rescale();
  [[nodiscard]] FactorStatus factor(const tree::Walker& walker);
  [[nodiscard]] SolveReport solve(const tree::Walker& walker, const double* rhs, double* x);
  void multiply(const tree::Walker& walker, const double* x, double* y) const;
  const FactorStatus& last_status() const;
  SolverCounters counters() const;
  std::vector<int> blocks_not_unique() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace bough::solve
