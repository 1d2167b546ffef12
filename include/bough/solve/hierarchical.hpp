#pragma once
/// The hierarchical direct solver: sub-domains are condensed to their interfaces level by level, followed by
/// back-substitution.
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

/// Functions without a comment are those of AnySolver, which states the contract.
///
///   S_i = A_BB - A_BI A_II^-1 A_IB,   g_i = b_B - A_BI A_II^-1 b_I         upward, sub-domain i, interface B,
///     interior I
///   x_I = A_II^-1 (b_I - A_IB x_B),   l_i = (g_i - S_i x_B) / s            downward; l_i: its local multipliers
///
/// Elimination is done in scaled variables D_r A D_c (powers of two).
class Hierarchical {
 public:
  Hierarchical(const blocks::BlockGraph& graph, const tree::Tree& tree, const SolveOptions& options = {});
  ~Hierarchical();
  Hierarchical(Hierarchical&&) noexcept;
  Hierarchical& operator=(Hierarchical&&) noexcept;

  ElementView element(int id);
  ConstElementView element(int id) const;
  std::span<const ElementBatch> batches() const;
  void rescale();

  /// Factorizations for which the sizes serve that are measured where a solution is checked: matrices whose sizes have
  /// drifted get new scales in the next factorization.
  static constexpr std::int64_t measurement_serves = 8;

  /// The visits of the walks. They do not change.
  SolverVisits visits() const;

  /// For matrices declared symmetric. mirrored: the caller promises that every entry of the element matrices and its
  /// mirror image have the same bits. Factorizations then read one of the two and compare them only when they compute
  /// scales. False (the default): every factorization compares them.
  void trust_symmetry(bool mirrored);

  /// Assembles, factors and condenses all sub-domains. Allocates only if delayed pivots enlarge a front, if fronts
  /// leave lanes for the first time, or if rows are dependent. `before` writes the element matrices of
  /// each visit; where scales are computed, which takes all matrices, in a walk of its own. With `rhs` (num_unknowns),
  /// whose entries a visit eliminates `before` may write, too, the right-hand side is condensed in the same visits,
  /// while a front is in the cache; substitute() then solves.
  [[nodiscard]] FactorStatus factor(const tree::Walker& walker, VisitWork before = {}, const double* rhs = nullptr);

  /// Condenses a right-hand side upward with the last factorization; `before` writes the entries that each visit
  /// eliminates. Precondition: factor() was ok.
  void condense(const tree::Walker& walker, VisitWork before, const double* rhs);

  /// Solves for the right-hand side that was condensed last, which has not changed since. `after` runs in the visits
  /// that substitute, or in a walk of its own after a solution that has to be completed first: with check, by backward
  /// error and refinement, or where rows are dependent. x may be rhs. Precondition: it was condensed by the last
  /// call of factor(.., rhs) or condense(), and nothing was solved since.
  SolveReport substitute(const tree::Walker& walker, const double* rhs, double* x, bool check, VisitWork after = {});

  /// Calls `work` in an upward walk that does nothing else.
  void visit_all(const tree::Walker& walker, VisitWork work) const;

  [[nodiscard]] SolveReport solve(const tree::Walker& walker, const double* rhs, double* x);

  /// As solve(), without backward error and refinement regardless of SolveOptions::check, which saves a product with A.
  /// Dependent rows are still checked.
  [[nodiscard]] SolveReport solve_unchecked(const tree::Walker& walker, const double* rhs, double* x);

  void multiply(const tree::Walker& walker, const double* x, double* y) const;

  const FactorStatus& last_status() const;
  /// How the values are factored. Values declared symmetric that are not are factored as general ones from then on. The
  /// factorization that finds this is repeated within the same factor(), in storage allocated there once.
  const SymmetryReport& symmetry() const;
  SolverCounters counters() const;
  /// Inertia of the last factorization; `negative` is that of the symmetric part of A, if it differs little from A.
  /// Preconditions: SolveOptions::inertia, factor() was ok. Allocates only if rows were exchanged or the root is
  /// singular.
  Inertia inertia();
  /// Interfaces of all sub-domains but the root, in order. Only factors are kept, so this repeats the last
  /// factorization and looks at each Schur complement at the end of its visit. Factors are the same afterwards; a
  /// right-hand side that was condensed is not kept.
  /// Condition numbers are computed for interfaces with at most `widest` unknowns (dense singular values, for reports;
  /// allocates) and are NaN for others; so are their matrices, if they are kept. flops: of the sub-domain's own fronts;
  /// seconds are not measured. Precondition: factor() was ok, and the element matrices are still those.
  std::vector<InterfaceReport> interfaces(const tree::Walker& walker, int widest = std::numeric_limits<int>::max(),
                                          bool keeps_matrices = false);
  std::vector<int> blocks_not_unique() const;
  /// Takes out of multipliers, which other solutions may have summed up, what no equation sees by the null vectors of
  /// the last factorization: those of least norm remain. x: by unknown, zero but for multipliers, of which alone the
  /// result may be used.
  void make_least(double* x);
  /// Scale of every unknown and of every row (powers of two): scaled A = row_scale A column_scale.
  std::span<const double> column_scale() const;
  std::span<const double> row_scale() const;
  const tree::Tree& tree() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace bough::solve
