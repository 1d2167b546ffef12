#include "bough/solve/reference/sparse_oracle.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>
#include <variant>

#include "bough/blocks/at.hpp"
#include "refine.hpp"
#include "sparse_matrix.hpp"

namespace bough::solve {

namespace {

/// d^2 in scaled variables: refinement contracts by about d^2 per step, and errors along null vectors are eps / d^2;
/// the value balances both.
constexpr double sparse_regularisation = 1e-7;
/// CHOLMOD also refines regular matrices, and must converge for soft constraints: a smaller value and more steps.
constexpr double cholmod_regularisation = 1e-10;
constexpr int cholmod_steps = 30;
/// Growth |A^-1 v| / |v| above which rows may depend, and above which the matrix is singular, in scaled variables.
constexpr double suspect_growth = 1e12, singular_growth = 1e15;
/// Largest asymmetry of the scaled matrix for L D L^T, which refinement corrects.
constexpr double most_asymmetry = 1e-9;
}  // namespace

struct SparseOracle::State {
  State(const blocks::BlockGraph& graph, const tree::Tree& t, Library l, const SolveOptions& o)
      : tree(t),
        library(l),
        options(o),
        elements(graph, t),
        batches(elements.single_batches()),
        sparse(elements),
        buffers(at(t.num_unknowns())),
        probe(at(t.num_unknowns())),
        response(at(t.num_unknowns())) {
    for (auto* v : {&scales.row, &scales.column, &scales.weight}) v->assign(at(tree.num_unknowns()), 1.0);
#ifdef BOUGH_HAS_GPL
    if (library == Library::umfpack) backend.emplace<Umfpack>();
    if (library == Library::cholmod) backend.emplace<Cholmod>();
#endif
  }
  bool factor_lowered(double lowered);
  double eval_growth(std::size_t& largest);
  bool has_motion_in_response() const;
  double eval_inconsistency(const tree::Walker& walker, const double* rhs, const double* x);

  const tree::Tree& tree;
  Library library;
  SolveOptions options;
  ElementStore elements;
  std::vector<ElementBatch> batches;
  SparseAssembly sparse;
  Scales scales;
  bool scales_wanted = true;
  bool regularised = false;
#ifdef BOUGH_HAS_GPL
  std::variant<EigenLu, Umfpack, Cholmod> backend;
#else
  std::variant<EigenLu> backend;
#endif
  RefineBuffers buffers;
  std::vector<double> probe, response;
  FactorStatus status;
  SolverCounters counters;
};

bool SparseOracle::State::factor_lowered(double lowered) {
  sparse.assemble(elements, scales, lowered);
  return std::visit([&](auto& b) { return b.factor(sparse.matrix()); }, backend);
}

/// Two inverse iterations from a random vector: a lower bound of |A^-1|, usually close to it. Infinite on overflow.
double SparseOracle::State::eval_growth(std::size_t& largest) {
  const std::size_t n = probe.size();
  std::uint32_t bits = 12345;
  for (double& p : probe) {
    bits = bits * 1664525u + 1013904223u;
    p = (bits >> 16) % 2 == 0 ? 1.0 : -1.0;
  }
  double growth = 0.0;
  for (int sweep = 0; sweep < 2; ++sweep) {
    if (!std::visit([&](auto& b) { return b.solve(probe.data(), response.data()); }, backend)) return INFINITY;
    growth = 0.0;
    for (std::size_t i = 0; i < n; ++i) {
      if (!std::isfinite(response[i])) return INFINITY;
      if (std::abs(response[i]) <= growth) continue;
      growth = std::abs(response[i]);
      largest = i;
    }
    if (growth == 0.0) return 0.0;
    for (std::size_t i = 0; i < n; ++i) probe[i] = response[i] / growth;
  }
  return growth;
}

/// Whether the vector that the matrix reduces most contains motion: then rows are not dependent, but the matrix is
/// ill-conditioned.
bool SparseOracle::State::has_motion_in_response() const {
  const auto& graph = elements.graph();
  double motion = 0.0, whole = 0.0;
  for (int b = 0; b < graph.num_blocks(); ++b)
    for (std::int64_t u = tree.unknown_begin[at(b)]; u < tree.unknown_begin[at(b) + 1]; ++u) {
      const double square = probe[at(u)] * probe[at(u)];  // the response over its size
      whole += square;
      if (graph.block_kind[at(b)] == blocks::BlockKind::motion) motion += square;
    }
  return motion > options.null_motion_tolerance * options.null_motion_tolerance * whole;
}

/// Share of b outside the range of A, 0 below 1e-8. It is relative to |b| alone, since the multipliers of contradicting
/// rows grow without bound.
double SparseOracle::State::eval_inconsistency(const tree::Walker& walker, const double* rhs, const double* x) {
  const auto errors = elements.eval_residual(walker, scales, x, rhs, buffers.residual.data());
  double left = 0.0, whole = 0.0;
  for (std::size_t i = 0; i < buffers.residual.size(); ++i) {
    left = std::max(left, std::abs(scales.row[i] * buffers.residual[i]));
    whole = std::max(whole, std::abs(scales.row[i] * rhs[i]));
  }
  return errors.normwise > 1e-13 && left > 1e-8 * whole ? left / whole : 0.0;
}

bool SparseOracle::available(Library library) {
#ifdef BOUGH_HAS_GPL
  return library == Library::sparse_lu || library == Library::umfpack || library == Library::cholmod;
#else
  return library == Library::sparse_lu;
#endif
}

std::string_view SparseOracle::name_of(Library library) {
  return library == Library::umfpack ? "umfpack" : library == Library::cholmod ? "cholmod" : "sparse_lu";
}

SparseOracle::SparseOracle(const blocks::BlockGraph& graph, const tree::Tree& tree, Library library,
                           const SolveOptions& options) {
  if (!problems_in(options).empty()) throw std::invalid_argument("SparseOracle: " + problems_in(options).front());
  state_ = std::make_unique<State>(graph, tree, library, options);
}
SparseOracle::~SparseOracle() = default;
SparseOracle::SparseOracle(SparseOracle&&) noexcept = default;
SparseOracle& SparseOracle::operator=(SparseOracle&&) noexcept = default;

ElementView SparseOracle::element(int id) { return state_->elements.view(id); }
ConstElementView SparseOracle::element(int id) const { return std::as_const(state_->elements).view(id); }
std::span<const ElementBatch> SparseOracle::batches() const { return state_->batches; }
void SparseOracle::rescale() { state_->scales_wanted = true; }
const FactorStatus& SparseOracle::last_status() const { return state_->status; }
void SparseOracle::multiply(const tree::Walker& walker, const double* x, double* y) const {
  state_->elements.multiply(walker, x, y);
}
std::vector<int> SparseOracle::blocks_not_unique() const { return {}; }

FactorStatus SparseOracle::factor(const tree::Walker& /*walker*/) {
  State& s = *state_;
  s.status = {};
  if (!available(s.library)) {
    s.status.outcome = FactorOutcome::backend;
    return s.status;
  }
  if (s.scales_wanted) s.elements.eval_scales(s.scales, s.buffers.residual);
  s.scales_wanted = false;
  ++s.counters.factorizations;
  if (const int block = find_not_finite_block(s.elements); block >= 0) {
    s.status.outcome = FactorOutcome::not_finite;
    s.status.block = block;
    return s.status;
  }
  if (s.tree.num_unknowns() == 0) return s.status;
  std::size_t largest = 0;
  s.regularised = s.library == Library::cholmod;
  if (!s.regularised) {
    if (s.factor_lowered(0.0)) {
      const double growth = s.eval_growth(largest);
      if (growth < suspect_growth || (growth < singular_growth && s.has_motion_in_response())) return s.status;
    }
    s.regularised = true;
  }
  const bool factored =
      s.factor_lowered(s.library == Library::cholmod ? cholmod_regularisation : sparse_regularisation);
  if (s.library == Library::cholmod && s.sparse.asymmetry() > most_asymmetry) {
    s.status.outcome = FactorOutcome::unsymmetric;
    return s.status;
  }
  s.status.deficiency = -1;
  if (!factored || s.eval_growth(largest) > singular_growth) {
    s.status.outcome = FactorOutcome::singular;
    s.status.block = s.tree.block_of_unknown(static_cast<std::int64_t>(largest));
    s.status.local = static_cast<int>(static_cast<std::int64_t>(largest) - s.tree.unknown_begin[at(s.status.block)]);
  }
  return s.status;
}

SolveReport SparseOracle::solve(const tree::Walker& walker, const double* rhs, double* x) {
  State& s = *state_;
  SolveReport report;
  report.deficiency = s.status.deficiency;
  ++s.counters.solutions;
  const int least = s.library == Library::cholmod ? cholmod_steps : s.regularised ? 8 : 0;
  const int most = std::max(least, s.options.refinement_steps);
  const bool check = s.options.check == SolveCheck::backward_error || s.regularised;
  solve_and_refine(walker, s.elements, s.scales, s.options, most, check, s.buffers, rhs, x, report,
                   [&](const double* b, double* y) {
                     if (s.tree.num_unknowns() > 0) std::visit([&](auto& k) { return k.solve(b, y); }, s.backend);
                   });
  if (s.regularised) report.inconsistency = s.eval_inconsistency(walker, rhs, x);
  return report;
}

SolverCounters SparseOracle::counters() const {
  const State& s = *state_;
  SolverCounters c = s.counters;
  c.memory_bytes = s.elements.memory_bytes() + s.sparse.memory_bytes();
  if (s.counters.factorizations > 0) {
    c.memory_bytes += std::visit([](const auto& b) { return b.memory_bytes(); }, s.backend);
    c.factor_flops = std::visit([](const auto& b) { return b.flops(); }, s.backend);
  }
  return c;
}

}  // namespace bough::solve
