#pragma once
/// The method as it is written: augmented sub-domains, their interface flexibilities, local Lagrange multipliers, and a
/// hierarchy of interface meshes.
#include <memory>
#include <span>
#include <vector>

#include "bough/blocks/block_graph.hpp"
#include "bough/solve/element_view.hpp"
#include "bough/solve/options.hpp"
#include "bough/solve/report.hpp"
#include "bough/tree/tree.hpp"
#include "bough/tree/walker.hpp"

namespace bough::solve {

/// The contract is that of AnySolver. In scaled variables, for each sub-domain i, with its tangent K, its load f, the
/// boundary B x that local multipliers l tie to the displacements L c of the interface mesh, and the penalty P:
///
///   V = s l^T (B x - L c) + 1/2 (B x - L c)^T P (B x - L c)
///   A = K + B^T P B                                     factored alone: one task
///   F = s^2 B A^-1 B^T                                  the interface flexibility
///   F l = s B A^-1 f + (F P / s - s I) L c              the local multipliers, which never leave the sub-domain
///   sum L^T S L c = sum L^T g                           the interface mesh, a structure again
///   S = s^2 F^-1 - P,   g = s^2 F^-1 B A^-1 f
///
/// The interface mesh is cut again, up to the root. Downward, c is known, l follows from the local system, and
///   x = A^-1 (f - s B^T l + B^T P L c).
/// Joints whose multipliers are eliminated in the sub-domain of their element are augmented as well: with its rows G,
/// [K + p G^T G, s G^T; s G, 0] has no zero pivot. Multipliers that move up the tree are unknowns of the interface mesh,
/// not of F, and so are pivots that were refused: what they hold has no flexibility.
///
/// P is penalty_factor times the interface's own stiffness |diag S|, unknown by unknown, so A is factored with its
/// boundary last. p is penalty_factor: constraint rows have norm 1 where motion has diagonals near 1. Beyond these
/// stiffnesses S = s^2 F^-1 - P loses a digit for each decade of the factor. Allocates in factor() and in solve().
class Augmented {
 public:
  Augmented(const blocks::BlockGraph& graph, const tree::Tree& tree, const SolveOptions& options = {});
  ~Augmented();
  Augmented(Augmented&&) noexcept;
  Augmented& operator=(Augmented&&) noexcept;

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
  void make_least(double* x) const;  ///< as of Hierarchical
  /// All interfaces but that of the root, which has none, after factor(). The condition is that of P^1/2 F P^1/2; NaN
  /// above `widest` unknowns. Dense singular values. keeps_matrices: those of interfaces up to this width.
  std::vector<InterfaceReport> interfaces(int widest, bool keeps_matrices = false) const;
  /// As of Hierarchical.
  std::span<const double> column_scale() const;
  std::span<const double> row_scale() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace bough::solve
