#pragma once
/// The hierarchical direct solver: sub-domains condensed to their interfaces, level by level, then substituted back.
#include <limits>
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

/// Solves A x = b, A = sum of dense element matrices over the blocks of a graph, generally unsymmetric with symmetric
/// structure.
///
///   S_i = A_BB - A_BI A_II^-1 A_IB,   g_i = b_B - A_BI A_II^-1 b_I         upward, sub-domain i, interface B,
///     interior I
///   x_I = A_II^-1 (b_I - A_IB x_B),   l_i = (g_i - S_i x_B) / s            downward; l_i: its local multipliers
///
/// Everything is eliminated in scaled variables D_r A D_c (powers of two). The graph and the tree must outlive the
/// solver.
class Hierarchical {
 public:
  /// Sizes all storage; computes nothing. Preconditions: tree made from this graph; problems_in(options) empty.
  Hierarchical(const blocks::BlockGraph& graph, const tree::Tree& tree, const SolveOptions& options = {});
  ~Hierarchical();
  Hierarchical(Hierarchical&&) noexcept;
  Hierarchical& operator=(Hierarchical&&) noexcept;

  /// Where the assembler writes an element matrix. Values stay until overwritten; elements of a leaf lie next to each
  /// other. Zero at the start.
  ElementView element(int id);
  ConstElementView element(int id) const;

  /// All elements in the order in which factor() takes them, equal ones of sub-domains in lockstep together.
  std::span<const ElementBatch> batches() const;

  /// Take the scales anew from the element matrices at the next factor(). The first one always does. With a Prepare
  /// the scales are those of the matrices present before it runs, so call rescale() after the element matrices have
  /// been evaluated once.
  void rescale();

  /// Where symmetry is declared. mirrored: whoever wrote the element matrices wrote every entry and its mirror image
  /// with the same bits; factorizations then read one of the two and compare none, except those that take scales.
  /// False (the default): every factorization compares.
  void trust_symmetry(bool mirrored);

  /// Assemble, factor and condense all sub-domains. Allocates only where delayed pivots enlarge a front, where fronts
  /// leave lanes or registers for the first time, or rows are dependent. With `rhs` (num_unknowns) the right-hand
  /// side is condensed in the same visits, while a front is in the cache; finish() then solves, until when it must
  /// last. SolveOptions::partial: sub-domains in which nothing `changed`, nor below them, stay as they are, and no
  /// Prepare is called for them; all bits are those of a whole factorization. After rescale() and after a failure
  /// everything is done anew.
  [[nodiscard]] FactorStatus factor(const tree::Walker& walker, Prepare prepare = {}, const double* rhs = nullptr,
                                    Changed changed = {});

  /// Solve for the right-hand side that factor() took along: what is left of solve(). Precondition: factor(.., rhs)
  /// ok, nothing solved since.
  [[nodiscard]] SolveReport finish(const tree::Walker& walker, double* x);

  /// Solve with the last factorization. rhs, x: num_unknowns, in the order of the blocks; may be the same array.
  /// Precondition: factor() ok. Dependent constraint rows: the multipliers are those of least norm (each measured
  /// against its constraint row, free of units).
  [[nodiscard]] SolveReport solve(const tree::Walker& walker, const double* rhs, double* x);

  /// The same without backward error and refinement, whatever SolveOptions::check says: saves a product with A.
  /// Dependent rows are checked.
  [[nodiscard]] SolveReport solve_unchecked(const tree::Walker& walker, const double* rhs, double* x);

  /// y = A x with the element matrices present now (unscaled). y must not be x. No allocation.
  void multiply(const tree::Walker& walker, const double* x, double* y) const;

  const FactorStatus& last_status() const;
  /// How the values are factored. Declared symmetric and found not to be: general from that factorization on, which
  /// is then done a second time within the same factor(), in storage allocated there once.
  const SymmetryReport& symmetry() const;
  SolverCounters counters() const;
  /// Of the last factorization; `negative` is that of the symmetric part of A where it differs little from A.
  /// Preconditions: SolveOptions::inertia, factor() ok. Allocates only where rows were exchanged, the root is singular.
  Inertia inertia();
  /// Interfaces of all sub-domains but the root, in order; computes condition numbers (dense singular values: for
  /// reports, allocates) of those with at most `widest` unknowns, NaN for others. flops: of the sub-domain's own
  /// fronts; seconds are not measured here.
  std::vector<InterfaceReport> interfaces(int widest = std::numeric_limits<int>::max()) const;
  /// Local multipliers l_i of a sub-domain in the solution for a right-hand side (num_unknowns; solved for anew):
  /// generalised interface forces in the units of the right-hand side (times 1/s), one per unknown of its boundary
  /// blocks, in that order. Precondition: factor() ok.
  std::vector<double> local_multipliers(tree::SubdomainId subdomain, const double* rhs) const;
  /// Blocks whose multipliers are not unique (they take part in a null vector), ascending. Empty without deficiency.
  std::vector<int> blocks_not_unique() const;
  /// Scale of every unknown and of every row (powers of two): scaled A = row_scale A column_scale.
  std::span<const double> column_scale() const;
  std::span<const double> row_scale() const;
  const tree::Tree& tree() const;

 private:
  struct State;
  const Hierarchical& reporting_solver() const;
  std::unique_ptr<State> state_;
};

}  // namespace bough::solve
