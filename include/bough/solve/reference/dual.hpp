#pragma once
/// The forms with global multipliers: the leaves of the tree are separated, and constraints tie the neighbours' copies
/// of shared unknowns to each other.
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

/// The interface unknowns that remain unknowns of an interface mesh.
enum class DualForm {
  global,  ///< none: sub-domains are tied only to each other [Farhat, Roux 1991].
  /// Cross points (three sub-domains or more) and at least one node of each sub-domain; the others are tied globally.
  hybrid,
};

enum class InterfaceSolution {
  direct,     ///< dense LU.
  iterative,  ///< conjugate gradients if the interface problem is symmetric, else GMRES; for comparison.
};

struct DualOptions {
  DualForm form = DualForm::global;
  InterfaceSolution solution = InterfaceSolution::direct;
};

/// The contract is that of AnySolver.
///
/// With A_i sub-domain i condensed to its boundary, B_i the signed ties, l the global multipliers (ties are not
/// redundant: m copies have m - 1), w_i the unknowns of i in the interface mesh,
///
///   x_i = A_i^+ (f_i - B_i^T l) + R_i w_i,         sum_i B_i x_i = 0
///   [ T  G_Q^T ] [w]   [ e ]     F = sum B_i A_i^+ B_i^T   G_R = sum B_i R_i   e = sum Q_i^T f_i
///   [-G_R  F   ] [l] = [ d ]     T = sum Q_i^T A_i R_i     G_Q = sum B_i Q_i   d = sum B_i A_i^+ f_i
///
/// A_i^+ inverts the part of A_i that pivots of at least 1e-6 span. The remaining, exactly or nearly floating motions
/// (rigid-body modes, mechanisms, dependent joint rows) become part of w with their true matrix T. Nothing is
/// regularised and no rank is decided in a sub-domain. Hybrid: w contains the unknowns of the interface mesh as well,
/// so T is the coarse problem. It is eliminated first, which leaves (F + G_R T^-1 G_Q^T) l = d + G_R T^-1 e for the
/// global multipliers.
///
/// The interface problem is dense and not subdivided further: its cost grows with the cube of the number of ties.
/// Allocates in factor().
class Dual {
 public:
  Dual(const blocks::BlockGraph& graph, const tree::Tree& tree, const DualOptions& form,
       const SolveOptions& options = {});
  ~Dual();
  Dual(Dual&&) noexcept;
  Dual& operator=(Dual&&) noexcept;

  ElementView element(int id);
  ConstElementView element(int id) const;
  std::span<const ElementBatch> batches() const;
  void rescale();
  /// Iterative: the rank is not determined, FactorStatus::deficiency is -1.
  [[nodiscard]] FactorStatus factor(const tree::Walker& walker);
  /// Iterative: sets SolveReport::interface_iterations; interface_converged is false if the iteration did not converge.
  [[nodiscard]] SolveReport solve(const tree::Walker& walker, const double* rhs, double* x);
  void multiply(const tree::Walker& walker, const double* x, double* y) const;
  const FactorStatus& last_status() const;
  SolverCounters counters() const;
  std::vector<int> blocks_not_unique() const;
  void make_least(double* x) const;  ///< as of Hierarchical
  /// The one interface problem (subdomain: the root), after factor(). Its condition is that of the flexibility F,
  /// hybrid: of F + G_R T^-1 G_Q^T, with unit diagonal, on the multipliers that leave floating sub-domains at rest;
  /// NaN above 300 ties. Dense singular values.
  std::vector<InterfaceReport> interfaces() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace bough::solve
