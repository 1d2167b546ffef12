#pragma once
/// One of the linear solvers behind a common interface, so that a caller can store it without a template.
#include <span>
#include <utility>
#include <variant>
#include <vector>

#include "bough/solve/augmented.hpp"
#include "bough/solve/hierarchical.hpp"
#include "bough/solve/reference/dual.hpp"
#include "bough/solve/reference/monolithic.hpp"
#include "bough/solve/reference/sparse_oracle.hpp"

namespace bough::solve {

/// One of the solvers, and the contract of them all: they solve A x = b, A = sum of dense element matrices over the
/// blocks of a graph, generally unsymmetric with symmetric structure. Their constructors size storage and compute
/// nothing; the tree is made from this graph, problems_in(options) is empty, and both must outlive the solver.
class AnySolver {
 public:
  AnySolver(Hierarchical solver) : solver_(std::move(solver)) {}
  AnySolver(Monolithic solver) : solver_(std::move(solver)) {}
  AnySolver(SparseOracle solver) : solver_(std::move(solver)) {}
  AnySolver(Dual solver) : solver_(std::move(solver)) {}
  AnySolver(Augmented solver) : solver_(std::move(solver)) {}

  /// The memory to which the assembler writes an element matrix, initially zero. Values stay until they are
  /// overwritten; elements of a leaf are adjacent.
  ElementView element(int id) {
    return std::visit([&](auto& s) { return s.element(id); }, solver_);
  }
  ConstElementView element(int id) const {
    return std::visit([&](const auto& s) { return s.element(id); }, solver_);
  }
  /// All elements in the order in which factor() assembles them; equal elements of sub-domains in lockstep form one
  /// batch.
  std::span<const ElementBatch> batches() const {
    return std::visit([](auto& s) { return s.batches(); }, solver_);
  }
  /// Computes the scales anew from the element matrices in the next factor(). The first factor() always does.
  void rescale() {
    std::visit([](auto& s) { s.rescale(); }, solver_);
  }
  /// See Hierarchical, whose walks have visits; the others have one, before or after all of their work.
  void trust_symmetry(bool mirrored) {
    if (auto* s = std::get_if<Hierarchical>(&solver_)) s->trust_symmetry(mirrored);
  }
  [[nodiscard]] FactorStatus factor(const tree::Walker& walker, VisitWork before = {}, const double* rhs = nullptr) {
    if (auto* s = std::get_if<Hierarchical>(&solver_)) return s->factor(walker, before, rhs);
    if (before) before(0);
    return std::visit([&](auto& s) { return s.factor(walker); }, solver_);
  }
  /// num_blocks: of the graph.
  SolverVisits visits(int num_blocks) const {
    if (const auto* s = std::get_if<Hierarchical>(&solver_)) return s->visits();
    return {{-1}, {0, static_cast<int>(batches().size())}, std::vector<int>(static_cast<std::size_t>(num_blocks), 0)};
  }
  void visit_all(const tree::Walker& walker, VisitWork work) const {
    if (const auto* s = std::get_if<Hierarchical>(&solver_))
      s->visit_all(walker, work);
    else
      work(0);
  }
  void condense(const tree::Walker& walker, VisitWork before, const double* rhs) {
    if (auto* s = std::get_if<Hierarchical>(&solver_))
      s->condense(walker, before, rhs);
    else
      before(0);
  }
  SolveReport substitute(const tree::Walker& walker, const double* rhs, double* x, bool check, VisitWork after = {}) {
    if (auto* s = std::get_if<Hierarchical>(&solver_)) return s->substitute(walker, rhs, x, check, after);
    const SolveReport report = solve(walker, rhs, x, check);
    if (after) after(0);
    return report;
  }
  /// Solves with the last factorization. rhs, x: num_unknowns, in the order of the blocks; may be the same array.
  /// Precondition: factor() was ok. If constraint rows are dependent, the multipliers are those of least norm (each
  /// measured relative to its constraint row, without units). check = false: solvers that support it omit the backward
  /// error (NaN) and iterative refinement.
  [[nodiscard]] SolveReport solve(const tree::Walker& walker, const double* rhs, double* x, bool check = true) {
    return std::visit(
        [&](auto& s) {
          if constexpr (requires { s.solve_unchecked(walker, rhs, x); })
            if (!check) return s.solve_unchecked(walker, rhs, x);
          return s.solve(walker, rhs, x);
        },
        solver_);
  }
  /// y = A x with the present element matrices (unscaled). y must not be x. No allocation.
  void multiply(const tree::Walker& walker, const double* x, double* y) const {
    std::visit([&](auto& s) { s.multiply(walker, x, y); }, solver_);
  }
  const FactorStatus& last_status() const {
    return std::visit([](auto& s) -> const FactorStatus& { return s.last_status(); }, solver_);
  }
  /// Unknown (default values) for solvers other than the hierarchical one.
  Inertia inertia() {
    auto* s = std::get_if<Hierarchical>(&solver_);
    return s != nullptr && s->last_status().ok() ? s->inertia() : Inertia{};
  }
  SolverCounters counters() const {
    return std::visit([](auto& s) { return s.counters(); }, solver_);
  }
  /// Blocks whose multipliers are not unique (they take part in a null vector), ascending. Empty without deficiency,
  /// and where it is not determined.
  std::vector<int> blocks_not_unique() const {
    return std::visit([](auto& s) { return s.blocks_not_unique(); }, solver_);
  }
  /// As of Hierarchical; forms that choose no multipliers where rows depend leave x as it is.
  void make_least(double* x) {
    std::visit(
        [x](auto& s) {
          if constexpr (requires { s.make_least(x); }) s.make_least(x);
        },
        solver_);
  }
  /// The interfaces of the forms that have a tree of them, as of Hierarchical; of others none.
  std::vector<InterfaceReport> interfaces(const tree::Walker& walker, int widest, bool keeps_matrices = false) {
    if (auto* s = std::get_if<Augmented>(&solver_)) return s->interfaces(widest, keeps_matrices);
    if (auto* s = std::get_if<Hierarchical>(&solver_)) return s->interfaces(walker, widest, keeps_matrices);
    return {};
  }
  /// Scales of columns and of rows of the forms that have interfaces; of others none.
  std::span<const double> column_scale() const {
    if (const auto* s = std::get_if<Augmented>(&solver_)) return s->column_scale();
    if (const auto* s = std::get_if<Hierarchical>(&solver_)) return s->column_scale();
    return {};
  }
  std::span<const double> row_scale() const {
    if (const auto* s = std::get_if<Augmented>(&solver_)) return s->row_scale();
    if (const auto* s = std::get_if<Hierarchical>(&solver_)) return s->row_scale();
    return {};
  }
  /// The hierarchical solver, or null if another one is stored.
  const Hierarchical* hierarchical() const { return std::get_if<Hierarchical>(&solver_); }
  Hierarchical* hierarchical() { return std::get_if<Hierarchical>(&solver_); }
  /// The form with global multipliers, or null if another solver is stored.
  const Dual* dual() const { return std::get_if<Dual>(&solver_); }
  /// The form with augmented sub-domains, or null if another solver is stored.
  const Augmented* augmented() const { return std::get_if<Augmented>(&solver_); }

 private:
  std::variant<Hierarchical, Monolithic, SparseOracle, Dual, Augmented> solver_;
};

}  // namespace bough::solve
