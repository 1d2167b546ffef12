#include "bough/solve/reference/monolithic.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "bough/blocks/at.hpp"
#include "refine.hpp"
#include "sparse_matrix.hpp"
#ifdef BOUGH_HAS_KLU
#include <klu.h>
#endif

namespace bough::solve {

namespace {

/// d^2 in scaled variables, subtracted from the multipliers' diagonal if rows depend on each other. Refinement with the
/// true system contracts by about d^2 per step. Round-off along null vectors is eps / d^2, which a larger d^2 reduces
/// at the cost of some more steps.
constexpr double regularisation = 1e-4;
/// If a row nearly depends on others, at a distance below the square root of the above, refinement stalls; then this
/// value is used.
constexpr double weak_regularisation = 1e-7;
[[maybe_unused]] constexpr int most_refinements = 10;  ///< if regularised
constexpr double refined_enough =
    5e-16;  ///< backward error of an oracle: KLU's pivots of 1e-3 of their column may leave more
[[maybe_unused]] constexpr double least_rcond =
    1e-11;  ///< of the pivots: below, rows count as dependent; otherwise errors of 1e-5 could remain undetected
}  // namespace

struct Monolithic::State {
  State(const blocks::BlockGraph& graph, const tree::Tree& t, const SolveOptions& o);
  ~State();
  State(const State&) = delete;
  State& operator=(const State&) = delete;

  void assemble(double lowered) { sparse.assemble(elements, scales, lowered); }
  void solve_scaled(double* b);  ///< in place
  bool factor_values(bool fresh);

  const tree::Tree& tree;
  SolveOptions options;
  ElementStore elements;
  std::vector<ElementBatch> batches;
  Scales scales;
  bool scales_wanted = true;
  SparseAssembly sparse;
  std::vector<double> rhs, residual, work, x_scaled;
  bool regularised = false, weak = false;
  FactorStatus status;
  SolverCounters counters;
#ifdef BOUGH_HAS_KLU
  klu_common common{};
  klu_symbolic* symbolic = nullptr;
  klu_numeric* numeric = nullptr;
#endif
};

Monolithic::State::State(const blocks::BlockGraph& graph, const tree::Tree& t, const SolveOptions& o)
    : tree(t), options(o), elements(graph, t), batches(elements.single_batches()), sparse(elements) {
  const std::size_t n = at(tree.num_unknowns());
  for (auto* v : {&scales.row, &scales.column, &scales.weight}) v->assign(n, 1.0);
  for (auto* v : {&rhs, &residual, &work, &x_scaled}) v->assign(n, 0.0);
#ifdef BOUGH_HAS_KLU
  klu_defaults(&common);
  common.scale = 0;  // values are scaled already
  common.halt_if_singular = 1;
#endif
}

Monolithic::State::~State() {
#ifdef BOUGH_HAS_KLU
  klu_free_numeric(&numeric, &common);
  klu_free_symbolic(&symbolic, &common);
#endif
}

#ifdef BOUGH_HAS_KLU
/// Factors the values, with a new pivot order unless the old one can be used. False if singular or nearly so.
bool Monolithic::State::factor_values(bool fresh) {
  const int n = static_cast<int>(rhs.size());
  if (n == 0) return true;
  int *const begin = sparse.matrix().outerIndexPtr(), *const rows = sparse.matrix().innerIndexPtr();
  double* const values = sparse.matrix().valuePtr();
  if (symbolic == nullptr) symbolic = klu_analyze(n, begin, rows, &common);
  if (symbolic == nullptr) return false;
  const auto is_good = [&] {
    return common.status == KLU_OK && klu_rcond(symbolic, numeric, &common) != 0 && common.rcond > least_rcond;
  };
  if (!fresh && numeric != nullptr && klu_refactor(begin, rows, values, symbolic, numeric, &common) != 0 && is_good())
    return true;
  klu_free_numeric(&numeric, &common);
  numeric = klu_factor(begin, rows, values, symbolic, &common);
  return numeric != nullptr && is_good();
}

void Monolithic::State::solve_scaled(double* b) {
  const int n = static_cast<int>(rhs.size());
  if (n > 0) klu_solve(symbolic, numeric, n, 1, b, &common);
}
#else
bool Monolithic::State::factor_values(bool) { return false; }
void Monolithic::State::solve_scaled(double*) {}
#endif

bool Monolithic::available() {
#ifdef BOUGH_HAS_KLU
  return true;
#else
  return false;
#endif
}

Monolithic::Monolithic(const blocks::BlockGraph& graph, const tree::Tree& tree, const SolveOptions& options) {
  if (!problems_in(options).empty()) throw std::invalid_argument("Monolithic: " + problems_in(options).front());
  state_ = std::make_unique<State>(graph, tree, options);
}
Monolithic::~Monolithic() = default;
Monolithic::Monolithic(Monolithic&&) noexcept = default;
Monolithic& Monolithic::operator=(Monolithic&&) noexcept = default;

ElementView Monolithic::element(int id) { return state_->elements.view(id); }
ConstElementView Monolithic::element(int id) const { return std::as_const(state_->elements).view(id); }
std::span<const ElementBatch> Monolithic::batches() const { return state_->batches; }
void Monolithic::rescale() { state_->scales_wanted = true; }
const FactorStatus& Monolithic::last_status() const { return state_->status; }
void Monolithic::multiply(const tree::Walker& walker, const double* x, double* y) const {
  state_->elements.multiply(walker, x, y);
}
std::vector<int> Monolithic::blocks_not_unique() const { return {}; }

FactorStatus Monolithic::factor(const tree::Walker& /*walker*/) {
  State& s = *state_;
  s.status = {};
  if (!available()) {
    s.status.outcome = FactorOutcome::backend;
    return s.status;
  }
  if (s.scales_wanted) s.elements.eval_scales(s.scales, s.residual);
  s.scales_wanted = false;
  s.assemble(0.0);
  ++s.counters.factorizations;
  for (Eigen::Index k = 0; k < s.sparse.matrix().nonZeros(); ++k) {
    if (std::isfinite(s.sparse.matrix().valuePtr()[k])) continue;
    s.status.outcome = FactorOutcome::not_finite;
    s.status.block = s.tree.block_of_unknown(s.sparse.matrix().innerIndexPtr()[k]);
    return s.status;
  }
  const bool was_regularised = std::exchange(s.regularised, false);
  if (s.factor_values(was_regularised)) return s.status;
  s.regularised = true;
  s.weak = false;
  s.assemble(regularisation);
  s.status.deficiency = -1;
  if (!s.factor_values(true)) {
    s.status.outcome = FactorOutcome::singular;
#ifdef BOUGH_HAS_KLU
    const int column = s.common.singular_col;
    if (column >= 0 && column < static_cast<int>(s.rhs.size())) {
      s.status.block = s.tree.block_of_unknown(column);
      s.status.local = static_cast<int>(column - s.tree.unknown_begin[at(s.status.block)]);
    }
#endif
  }
  return s.status;
}

SolveReport Monolithic::solve(const tree::Walker& walker, const double* rhs, double* x) {
  State& s = *state_;
  const std::size_t n = s.rhs.size();
  SolveReport report;
  report.deficiency = s.status.deficiency;
  ++s.counters.solutions;
  std::copy(rhs, rhs + n, s.rhs.begin());
  const auto apply = [&](const std::vector<double>& b) {
    for (std::size_t i = 0; i < n; ++i) s.work[i] = s.scales.row[i] * b[i];
    s.solve_scaled(s.work.data());
    for (std::size_t i = 0; i < n; ++i) s.work[i] *= s.scales.column[i];
  };
  const auto refine = [&] {
    apply(s.rhs);
    std::copy(s.work.begin(), s.work.end(), s.x_scaled.begin());
    auto errors = s.elements.eval_residual(walker, s.scales, s.x_scaled.data(), s.rhs.data(), s.residual.data());
    const int most = s.regularised ? most_refinements : s.options.refinement_steps;
    for (int k = 0; errors.finite && errors.normwise > refined_enough && k < most; ++k) {
      apply(s.residual);
      for (std::size_t i = 0; i < n; ++i) s.work[i] += s.x_scaled[i];
      const auto refined = s.elements.eval_residual(walker, s.scales, s.work.data(), s.rhs.data(), s.residual.data());
      if (!(refined.normwise < errors.normwise)) break;
      errors = refined;
      std::swap(s.x_scaled, s.work);
      ++report.refinement_steps;
    }
    return errors;
  };
  if (s.options.check != SolveCheck::backward_error && !s.regularised) {
    apply(s.rhs);
    std::copy(s.work.begin(), s.work.end(), s.x_scaled.begin());
  } else {
    auto errors = refine();
    if (s.regularised && !s.weak && errors.finite && errors.normwise > s.options.refinement_above) {
      s.weak = true;
      s.assemble(weak_regularisation);
      if (s.factor_values(true)) {
        errors = refine();
      } else {  // use the stronger one again
        s.assemble(regularisation);
        if (s.factor_values(true)) errors = refine();
      }
    }
    report.backward_error = errors.normwise;
    report.finite = errors.finite;
    if (s.regularised && errors.normwise > 1e-8) report.inconsistency = errors.normwise;
  }
  std::copy(s.x_scaled.begin(), s.x_scaled.end(), x);
  return report;
}

SolverCounters Monolithic::counters() const {
  const State& s = *state_;
  SolverCounters c = s.counters;
  c.memory_bytes = s.elements.memory_bytes() + s.sparse.memory_bytes();
#ifdef BOUGH_HAS_KLU
  if (s.numeric != nullptr) {
    c.memory_bytes += static_cast<std::int64_t>(s.common.mempeak);
    c.factor_flops = s.common.flops;
  }
#endif
  return c;
}

}  // namespace bough::solve
