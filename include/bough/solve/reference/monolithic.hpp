#pragma once
/// The monolithic oracle: the same matrix, assembled to one sparse matrix and factored by KLU.
#include <memory>
#include <span>
#include <vector>

#include "bough/blocks/block_graph.hpp"
#include "bough/solve/element_view.hpp"
#include "bough/solve/options.hpp"
#include "bough/solve/report.hpp"
#include "bough/tree/walker.hpp"

namespace bough::solve {

/// The contract is that of AnySolver, serial.
///
/// Dependent constraint rows: if the factorization is singular or nearly so, the multipliers get a diagonal -d^2 (d^2 =
/// 1e-4 in scaled variables, 1e-7 if rows are nearly dependent), and the solution is refined with the true matrix; the
/// limit is the solution with least multipliers. The deficiency is then unknown (-1).
class Monolithic {
 public:
  static bool
  available();  ///< false if the library was built without KLU; factor() then returns FactorOutcome::backend.

  Monolithic(const blocks::BlockGraph& graph, const tree::Tree& tree, const SolveOptions& options = {});
  ~Monolithic();
  Monolithic(Monolithic&&) noexcept;
  Monolithic& operator=(Monolithic&&) noexcept;

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
