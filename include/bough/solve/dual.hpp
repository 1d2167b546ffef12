#pragma once
/// The forms with global multipliers: leaves of the tree torn apart, neighbours' copies of shared unknowns tied to
/// each other directly.
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

/// Which interface unknowns keep a place of their own, the interface mesh.
enum class DualForm {
  global,  ///< none: sub-domains are tied to each other alone [Farhat, Roux 1991].
  hybrid,  ///< cross points (three sub-domains or more) and one node at least for each sub-domain; the rest is tied globally.
};

enum class InterfaceSolution {
  direct,     ///< dense LU.
  iterative,  ///< conjugate gradients where the interface problem is symmetric, else GMRES; for comparison.
};

struct DualOptions {
  DualForm form = DualForm::global;
  InterfaceSolution solution = InterfaceSolution::direct;
};

/// Same contract as Hierarchical. With A_i sub-domain i condensed to its boundary, B_i the signed ties, l the global
/// multipliers (ties are not redundant: m copies have m - 1), w_i the unknowns of i that keep their place,
///
///   x_i = A_i^+ (f_i - B_i^T l) + R_i w_i,         sum_i B_i x_i = 0
///   [ T  G_Q^T ] [w]   [ e ]     F = sum B_i A_i^+ B_i^T   G_R = sum B_i R_i   e = sum Q_i^T f_i
///   [-G_R  F   ] [l] = [ d ]     T = sum Q_i^T A_i R_i     G_Q = sum B_i Q_i   d = sum B_i A_i^+ f_i
///
/// A_i^+ inverts the part of A_i that pivots of at least 1e-6 span; what is left over, exactly or nearly floating
/// (rigid-body modes, mechanisms, dependent joint rows), becomes part of w with its true remainder T. Nothing is
/// regularised and no rank is decided in a sub-domain. Hybrid: the unknowns of the interface mesh are in w too, so T
/// is the coarse problem; it is eliminated first, and (F + G_R T^-1 G_Q^T) l = d + G_R T^-1 e stands in the global
/// multipliers alone.
///
/// The interface problem is dense and not cut again: cost grows with the cube of the number of ties. Allocates in
/// factor().
class Dual {
 public:
  /// Preconditions: tree made from this graph; problems_in(options) empty.
  Dual(const blocks::BlockGraph& graph, const tree::Tree& tree, const DualOptions& form,
       const SolveOptions& options = {});
  ~Dual();
  Dual(Dual&&) noexcept;
  Dual& operator=(Dual&&) noexcept;

  ElementView element(int id);
  ConstElementView element(int id) const;
  std::span<const ElementBatch> batches() const;
  void rescale();
  /// Iterative: the rank is not looked at, FactorStatus::deficiency is -1.
  [[nodiscard]] FactorStatus factor(const tree::Walker& walker, Prepare prepare = {});
  /// Iterative: SolveReport::interface_iterations; interface_converged is false where the iteration gave up.
  [[nodiscard]] SolveReport solve(const tree::Walker& walker, const double* rhs, double* x);
  void multiply(const tree::Walker& walker, const double* x, double* y) const;
  const FactorStatus& last_status() const;
  SolverCounters counters() const;
  std::vector<int> blocks_not_unique() const;
  /// The one interface problem (subdomain: the root), after factor(). Its condition is that of the flexibility F,
  /// hybrid: of F + G_R T^-1 G_Q^T, with unit diagonal, on the multipliers that leave floating sub-domains at rest;
  /// NaN above 300 ties. Dense singular values.
  std::vector<InterfaceReport> interfaces() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace bough::solve
