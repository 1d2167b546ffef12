#include "bough/solve/matrix_solver.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <utility>
#include <vector>

#include "bough/blocks/at.hpp"
#include "bough/solve/front_cost.hpp"
#include "bough/solve/hierarchical.hpp"
#include "bough/solve/matrix_blocks.hpp"
#include "bough/tree/tree.hpp"
#include "scalar_factors.hpp"

namespace bough::solve {

namespace {

/// Below this fraction of mirrored entries the diagonal means nothing: rows are equations in any order. A choice:
/// structures have 1.
constexpr double least_symmetry = 0.5;

// Times in seconds, fitted to factorizations and solutions on one machine of fifteen matrices with 100 to 5400 unknowns:
// nos4, bcsstk09, 13 and 14, s3rmt3m3, nnc1374, steam1, orsirr_1, west0479 and reorientation_1 of the SuiteSparse Matrix
// Collection [Davis, Hu 2011, ACM TOMS 38(1)], blocks of solid elements, and tangents of another multibody program. On
// other machines their ratios count. On the tree they are those of fronts of a few unknowns, outside of lanes: per front,
// entry of its panels, flop, entry of an element, and per unknown that is passed to the parent times the unknowns of a
// front.
constexpr double per_front = 6.8e-7, per_panel = 1.05e-9, per_flop = 7.4e-11, per_element_entry = 1.3e-8,
                 per_delay = 5e-8;

/// Elements of a matrix, and what is eliminated on the tree.
struct OnTree {
  MatrixBlocks blocks;
  tree::Tree tree;
  std::unique_ptr<Hierarchical> solver;
  std::vector<int> row_place;  ///< by row: where the graph has it
  std::vector<double> load, solution;

  OnTree(const SparseColumns& a, Symmetry symmetry) {
    SparseColumns ordered = a;
    std::vector<int> new_row;
    if (symmetry == Symmetry::general && pattern_symmetry(a) < least_symmetry) new_row = rows_of_full_diagonal(a);
    std::vector<int> from(at(a.num_entries()));
    for (std::size_t k = 0; k < from.size(); ++k) from[k] = static_cast<int>(k);
    if (!new_row.empty())
      for (int j = 0; j < a.n; ++j) {
        const auto begin = at(a.column_begin[at(j)]), end = at(a.column_begin[at(j) + 1]);
        const auto row_of = [&](int k) { return new_row[at(a.row[at(k)])]; };
        std::sort(from.begin() + static_cast<std::ptrdiff_t>(begin), from.begin() + static_cast<std::ptrdiff_t>(end),
                  [&](int k, int l) { return row_of(k) < row_of(l); });
        for (std::size_t k = begin; k < end; ++k) ordered.row[k] = row_of(from[k]);
      }
    const MatrixBlocks found = find_blocks(ordered);
    blocks = found;
    for (std::size_t k = 0; k < from.size(); ++k) {
      blocks.element[at(from[k])] = found.element[k];
      blocks.offset[at(from[k])] = found.offset[k];
    }
    for (int i = 0; i < a.n; ++i) row_place.push_back(blocks.place[at(new_row.empty() ? i : new_row[at(i)])]);
    tree = tree::make_tree(blocks.graph);
    solver = std::make_unique<Hierarchical>(blocks.graph, tree,
                                            SolveOptions{.symmetry = symmetry, .check = SolveCheck::none});
    solver->trust_symmetry(symmetry == Symmetry::symmetric);
    load.resize(at(a.n));
    solution.resize(at(a.n));
  }
  OnTree(const OnTree&) = delete;
  OnTree& operator=(const OnTree&) = delete;

  /// After a factorization, whose delayed pivots enlarge fronts.
  double seconds() const {
    const SolverCounters c = solver->counters();
    const double alone = tree.num_fronts() - static_cast<double>(c.fronts_in_lanes),
                 mean_front = c.panels_alone / std::max(c.columns_alone, 1.0);
    return front_cost::per_pack * static_cast<double>(c.packs_of_fronts) +
           front_cost::per_flop_of_pack * c.flops_of_packs + per_front * alone + per_panel * c.panels_alone +
           per_flop * (c.factor_flops - c.flops_in_lanes) + per_element_entry * element_entries() +
           per_delay * solver->last_status().delayed_pivots * mean_front;
  }
  double element_entries() const {
    double sum = 0.0;
    for (int e = 0; e < blocks.graph.num_elements(); ++e) {
      double size = 0.0;
      for (auto k = blocks.graph.element_begin[at(e)]; k < blocks.graph.element_begin[at(e) + 1]; ++k)
        size += blocks.graph.block_size[at(blocks.graph.element_blocks[at(k)])];
      sum += size * size;
    }
    return sum;
  }

  bool factor(const tree::Walker& walker, std::span<const double> values) {
    for (std::size_t k = 0; k < values.size(); ++k) solver->element(blocks.element[k])[blocks.offset[k]] = values[k];
    return solver->factor(walker).ok();
  }
  void solve(const tree::Walker& walker, const double* b, double* x) {
    for (std::size_t i = 0; i < load.size(); ++i) load[at(row_place[i])] = b[i];
    (void)solver->solve_unchecked(walker, load.data(), solution.data());
    for (std::size_t i = 0; i < load.size(); ++i) x[i] = solution[at(blocks.place[i])];
  }
  /// The order of elimination of the tree.
  std::vector<int> order() const {
    std::vector<int> unknown_at(load.size()), out;
    for (std::size_t i = 0; i < load.size(); ++i) unknown_at[at(blocks.place[i])] = static_cast<int>(i);
    for (const tree::Front& f : tree.fronts)
      for (const int b : tree.blocks(f).first(at(f.num_eliminated_blocks)))
        for (int u = blocks.unknown_begin[at(b)]; u < blocks.unknown_begin[at(b) + 1]; ++u)
          out.push_back(unknown_at[at(u)]);
    return out;
  }
  std::string findings() const {
    const FactorStatus& status = solver->last_status();
    if (status.outcome == FactorOutcome::singular) {
      const int place = blocks.unknown_begin[at(status.block)] + status.local;
      const auto found = std::find(blocks.place.begin(), blocks.place.end(), place) - blocks.place.begin();
      return "singular, " + std::to_string(status.deficiency) + " null vectors, most in unknown " +
             std::to_string(found + 1);
    }
    return status.deficiency > 0 ? std::to_string(status.deficiency) + " dependent rows" : "";
  }
};

bool has_full_diagonal(const SparseColumns& a) {
  for (int j = 0; j < a.n; ++j)
    if (!std::binary_search(a.row.begin() + a.column_begin[at(j)], a.row.begin() + a.column_begin[at(j) + 1], j))
      return false;
  return true;
}

/// Copies numbers; false if one of them is not finite. By their exponents, several at a time.
bool copy_finite(std::span<const double> from, std::vector<double>& to) {
  constexpr std::uint64_t exponent = 0x7ff0000000000000U;
  std::uint64_t largest = 0;
  double* const out = to.data();
  for (std::size_t k = 0; k < from.size(); ++k) {
    out[k] = from[k];
    largest = std::max(largest, std::bit_cast<std::uint64_t>(from[k]) & exponent);
  }
  return largest != exponent;
}

/// Pivots whose magnitudes differ by all digits.
std::string tell_pivots(double ratio, int n) {
  if (ratio >= n * std::numeric_limits<double>::epsilon()) return "";
  char text[80];
  std::snprintf(text, sizeof text, "singular or nearly so: the smallest pivot is %.1e of the largest", ratio);
  return text;
}

}  // namespace

const char* name_of(MatrixMethod method) {
  constexpr const char* names[] = {"tree", "ldlt", "lu"};
  return names[static_cast<int>(method)];
}

struct MatrixSolver::State {
  SparseColumns a;
  Symmetry symmetry;
  std::vector<MatrixCost> costs;
  std::size_t present = 0;  ///< method in use
  std::unique_ptr<OnTree> on_tree;
  std::unique_ptr<ScalarLdlt> ldlt;
  std::unique_ptr<ScalarLu> lu;
  std::vector<double> residual, correction, load;
  std::string findings;

  MatrixMethod method() const { return costs[present].method; }

  bool factor_with(MatrixMethod m, const tree::Walker& walker, bool with_new_pivots) {
    bool ok = false;
    switch (m) {
      case MatrixMethod::ldlt:
        ok = ldlt->factor(a.value);
        if (ok) findings = tell_pivots(ldlt->pivot_ratio(), a.n);
        return ok;
      case MatrixMethod::lu:
        ok = lu->factor(a, with_new_pivots);
        if (ok) findings = tell_pivots(lu->pivot_ratio(), a.n);
        return ok;
      case MatrixMethod::tree:
        break;
    }
    if (on_tree == nullptr) on_tree = std::make_unique<OnTree>(a, symmetry);
    ok = on_tree->factor(walker, a.value);
    findings = on_tree->findings();
    return ok;
  }
  /// Whether the method solves a system of the values given at first.
  bool is_sound(const tree::Walker& walker) {
    if (!factor_with(method(), walker, true)) return false;
    std::vector<double> b(at(a.n), 0.0), x(at(a.n), 0.0);
    for (std::size_t k = 0; k < a.value.size(); ++k) b[at(a.row[k])] += a.value[k];
    return solve(walker, b.data(), x.data()).backward_error <= largest_error;
  }
  void apply(const tree::Walker& walker, const double* b, double* x) {
    switch (method()) {
      case MatrixMethod::ldlt:
        return ldlt->solve(b, x);
      case MatrixMethod::lu:
        return lu->solve(b, x);
      case MatrixMethod::tree:
        return on_tree->solve(walker, b, x);
    }
  }
  /// The next method that factors the present values.
  bool factor_with_next(const tree::Walker& walker) {
    while (present + 1 < costs.size()) {
      ++present;
      if (factor_with(method(), walker, true)) return true;
    }
    return false;
  }
  Solution solve(const tree::Walker& walker, const double* b, double* x) {
    constexpr double refined_above = 1e-14;
    apply(walker, b, x);
    Solution report{.backward_error = solve::backward_error(a, x, b, residual)};
    if (report.backward_error <= refined_above || !std::isfinite(report.backward_error)) return report;
    const std::size_t n = at(a.n);
    correction.resize(n);
    apply(walker, residual.data(), correction.data());
    for (std::size_t i = 0; i < n; ++i) correction[i] += x[i];
    const double refined = solve::backward_error(a, correction.data(), b, residual);
    if (!(refined < report.backward_error)) return report;
    std::copy(correction.begin(), correction.end(), x);
    return {refined, 1};
  }
};

MatrixSolver::MatrixSolver(const tree::Walker& walker, const SparseColumns& a, Symmetry symmetry,
                           std::optional<MatrixMethod> given)
    : state_(std::make_unique<State>()) {
  State& s = *state_;
  s.a = a;
  if (!copy_finite(a.value, s.a.value)) std::fill(s.a.value.begin(), s.a.value.end(), 0.0);  // factored by no method
  s.symmetry = symmetry;
  s.on_tree = std::make_unique<OnTree>(a, symmetry);
  const std::vector<int> order = s.on_tree->order();
  if (symmetry == Symmetry::symmetric) {
    s.ldlt = std::make_unique<ScalarLdlt>(a, order);
    // Zeros on the diagonal have to be filled before they become pivots, which the order of the tree sees to.
    if (has_full_diagonal(a)) {
      auto other = std::make_unique<ScalarLdlt>(a, minimum_degree_order(a));
      if (other->seconds() < s.ldlt->seconds()) std::swap(s.ldlt, other);
    }
    s.costs.push_back({MatrixMethod::ldlt, s.ldlt->seconds()});
  }
  s.costs.push_back({MatrixMethod::tree, 0.0});
  if (ScalarLu::is_available()) {
    s.lu = std::make_unique<ScalarLu>(s.a, order);
    if (s.lu->is_regular()) s.costs.push_back({MatrixMethod::lu, s.lu->seconds()});
  }
  // The tree expects zeros on the diagonal to be multipliers that do not meet one another, and L D L^T pivots that need
  // no exchange. Partial pivoting expects nothing.
  for (s.present = 0; s.present < s.costs.size(); ++s.present) {
    const bool is_sound = s.is_sound(walker);
    MatrixCost& cost = s.costs[s.present];
    if (cost.method == MatrixMethod::tree) cost.seconds = s.on_tree->seconds();
    if (!is_sound) cost.seconds = std::numeric_limits<double>::infinity();
  }
  std::stable_sort(s.costs.begin(), s.costs.end(), [&](const MatrixCost& x, const MatrixCost& y) {
    if (given && (x.method == *given) != (y.method == *given)) return x.method == *given;
    return x.seconds < y.seconds;
  });
  s.present = 0;
  if (s.method() != MatrixMethod::tree) s.on_tree.reset();  // made again where it is needed
}

MatrixSolver::~MatrixSolver() = default;
MatrixSolver::MatrixSolver(MatrixSolver&&) noexcept = default;
MatrixSolver& MatrixSolver::operator=(MatrixSolver&&) noexcept = default;

bool MatrixSolver::factor(const tree::Walker& walker, std::span<const double> values) {
  State& s = *state_;
  s.findings.clear();
  if (!copy_finite(values, s.a.value)) {
    s.findings = "a number is not finite";
    return false;
  }
  const std::size_t before = s.present;
  if (s.factor_with(s.method(), walker, false) || s.factor_with_next(walker)) return true;
  s.present = before;  // a singular matrix speaks against no method
  return false;
}

MatrixSolver::Solution MatrixSolver::solve(const tree::Walker& walker, const double* b, double* x) {
  State& s = *state_;
  if (x == b) {
    s.load.assign(b, b + s.a.n);
    b = s.load.data();
  }
  Solution report = s.solve(walker, b, x);
  if (!(report.backward_error <= largest_error) && s.method() == MatrixMethod::lu &&
      s.factor_with(MatrixMethod::lu, walker, true))
    report = s.solve(walker, b, x);
  while (!(report.backward_error <= largest_error) && s.factor_with_next(walker)) report = s.solve(walker, b, x);
  return report;
}

void MatrixSolver::solve_unchecked(const tree::Walker& walker, const double* b, double* x) {
  state_->apply(walker, b, x);
}

MatrixMethod MatrixSolver::method() const { return state_->method(); }
std::span<const MatrixCost> MatrixSolver::costs() const { return state_->costs; }
std::string MatrixSolver::findings() const { return state_->findings; }

double MatrixSolver::factor_flops() const {
  const State& s = *state_;
  switch (s.method()) {
    case MatrixMethod::ldlt:
      return s.ldlt->flops();
    case MatrixMethod::lu:
      return s.lu->flops();
    case MatrixMethod::tree:
      break;
  }
  return s.on_tree->solver->counters().factor_flops;
}

double MatrixSolver::memory_bytes() const {
  const State& s = *state_;
  constexpr double per_entry = sizeof(double) + sizeof(int);
  double bytes = per_entry * static_cast<double>(s.a.num_entries());
  if (s.ldlt != nullptr) bytes += per_entry * s.ldlt->entries();
  if (s.lu != nullptr) bytes += s.lu->memory_bytes();
  if (s.on_tree != nullptr) bytes += static_cast<double>(s.on_tree->solver->counters().memory_bytes);
  return bytes;
}

}  // namespace bough::solve
