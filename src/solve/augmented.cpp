#include "bough/solve/augmented.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "bough/blocks/at.hpp"
#include "decompositions.hpp"
#include "dependent_rows.hpp"
#include "flexibility.hpp"
#include "reference/refine.hpp"
#include "subdomain_fronts.hpp"

namespace bough::solve {

namespace {

using Matrix = Eigen::MatrixXd;
using Vector = Eigen::VectorXd;

/// Pivots of the root below this are examined for dependent rows.
constexpr double suspect_pivot_of_root = 1e-6;

/// The interface of one sub-domain. Unknowns that its top front keeps: refused pivots first, then the boundary.
struct Interface {
  std::vector<int> tied;    ///< kept displacements of the boundary, which local multipliers tie to the interface mesh
  std::vector<int> passed;  ///< the other kept unknowns, which belong to the interface mesh
  std::vector<int> column;  ///< by kept unknown: its number in the whole system
  Matrix coupling;          ///< of the tied with the passed unknowns
  StiffenedInterface stiffened;
  Matrix flexibility;                   ///< F
  Eigen::PartialPivLU<Matrix> inverse;  ///< factor of F
  Vector load, moved, multipliers;      ///< condensed f; B A^-1 f; l
  bool failed = false;                  ///< not finite
  bool is_singular = false;             ///< F is, at this penalty
};

}  // namespace

struct Augmented::State {
  const tree::Tree& tree;
  SolveOptions options;
  ElementStore elements;
  Scales scales;
  bool scales_wanted = true;
  std::vector<ElementBatch> batches;
  SubdomainFronts fronts;
  std::vector<Interface> interfaces;  ///< by sub-domain
  std::vector<int> joints;            ///< elements with multipliers that are augmented
  std::vector<char> is_augmented;     ///< by block
  DependentRows dependent;
  RefineBuffers buffers;
  std::vector<double> load;  ///< scratch
  FactorStatus status;
  SolverCounters counters;

  State(const blocks::BlockGraph& graph, const tree::Tree& t, const SolveOptions& o)
      : tree(t),
        options(o),
        elements(graph, t),
        batches(elements.single_batches()),
        fronts(elements, t, true),
        interfaces(at(t.num_subdomains())),
        dependent(elements, scales, options),
        buffers(at(t.num_unknowns())),
        load(at(t.num_unknowns())) {
    for (auto* v : {&scales.row, &scales.column, &scales.weight}) v->assign(at(tree.num_unknowns()), 1.0);
    find_joints(graph);
    fronts.change_elements([this](int e, std::vector<double>& a) { augment(e, a); });
  }

  double s() const { return options.multiplier_scale; }

  /// Multipliers with one element, that are eliminated in the sub-domain of this element.
  void find_joints(const blocks::BlockGraph& graph) {
    std::vector<int> uses(at(graph.num_blocks()), 0);
    for (const int b : graph.element_blocks) ++uses[at(b)];
    is_augmented.assign(at(graph.num_blocks()), 0);
    for (int e = 0; e < graph.num_elements(); ++e) {
      bool any = false;
      for (int q = 0; q < elements.num_blocks_of(e); ++q) {
        const int b = elements.blocks_of(e)[q];
        if (graph.block_kind[at(b)] != blocks::BlockKind::multiplier || uses[at(b)] != 1) continue;
        if (tree.fronts[at(tree.front_of_block[at(b)])].subdomain != tree.leaf_of_element[at(e)]) continue;
        is_augmented[at(b)] = 1;
        any = true;
      }
      if (any) joints.push_back(e);
    }
  }

  /// Calls body(i, k, u, v) for each row i of motion and each augmented multiplier k of an element, of the unknowns u
  /// and v.
  template <class Body>
  void for_joint(int e, Body&& body) const {
    const blocks::BlockGraph& graph = elements.graph();
    int k = 0;
    for (int q = 0; q < elements.num_blocks_of(e); ++q) {
      const int b = elements.blocks_of(e)[q];
      for (int r = 0; r < graph.block_size[at(b)]; ++r, ++k) {
        if (is_augmented[at(b)] == 0) continue;
        int i = 0;
        for (int p = 0; p < elements.num_blocks_of(e); ++p) {
          const int other = elements.blocks_of(e)[p];
          for (int d = 0; d < graph.block_size[at(other)]; ++d, ++i)
            if (graph.block_kind[at(other)] == blocks::BlockKind::motion)
              body(i, k, at(tree.unknown_begin[at(other)] + d), at(tree.unknown_begin[at(b)] + r));
        }
      }
    }
  }

  /// a <- T_l a T_r, T_l = [I, p G^T; 0, s I], T_r = [I, 0; 0, s I], rows by rows.
  void augment(int e, std::vector<double>& a) const {
    if (!std::binary_search(joints.begin(), joints.end(), e)) return;
    const auto n = at(elements.size_of(e));
    const std::vector<double> given = a;
    std::vector<char> is_multiplier(n, 0);
    for_joint(e, [&](int i, int k, std::size_t, std::size_t) {
      is_multiplier[at(k)] = 1;
      const double share = options.penalty_factor * given[at(i) * n + at(k)];
      for (std::size_t j = 0; j < n; ++j) a[at(i) * n + j] += share * given[at(k) * n + j];
    });
    for (std::size_t k = 0; k < n; ++k) {
      if (is_multiplier[k] == 0) continue;
      for (std::size_t j = 0; j < n; ++j) {
        a[k * n + j] *= s();
        a[j * n + k] *= s();
      }
    }
  }
  /// p G^T of element e, scaled.
  double penalty_row(int e, int i, int k, std::size_t u, std::size_t v) const {
    return options.penalty_factor * scales.row[u] * elements.view(e)[i * elements.size_of(e) + k] * scales.column[v];
  }
  /// b <- T_l b
  void augment_load(double* b) const {
    for (const int e : joints)
      for_joint(e, [&](int i, int k, std::size_t u, std::size_t v) { b[u] += penalty_row(e, i, k, u, v) * b[v]; });
    scale_multipliers(b);
  }
  /// y <- T_l^T y
  void augment_left(double* y) const {
    scale_multipliers(y);
    for (const int e : joints)
      for_joint(e, [&](int i, int k, std::size_t u, std::size_t v) { y[v] += penalty_row(e, i, k, u, v) * y[u]; });
  }
  /// T_r
  void scale_multipliers(double* x) const {
    for (int b = 0; b < elements.graph().num_blocks(); ++b)
      if (is_augmented[at(b)] != 0)
        for (std::int64_t u = tree.unknown_begin[at(b)]; u < tree.unknown_begin[at(b) + 1]; ++u) x[u] *= s();
  }

  /// One task: A, F and S of a sub-domain.
  void factor_subdomain(tree::SubdomainId id) {
    Interface& f = interfaces[at(id)];
    f.is_singular = false;
    f.failed = !fronts.factor(id, scales, {options.pivot_threshold, options.tiny_pivot});
    if (f.failed || id == tree.root()) return;
    name_kept(id, f);
    const auto n = static_cast<Eigen::Index>(f.tied.size());
    Matrix S(n, n);
    f.coupling.resize(n, static_cast<Eigen::Index>(f.passed.size()));
    for (Eigen::Index i = 0; i < n; ++i) {
      for (Eigen::Index j = 0; j < n; ++j) S(i, j) = fronts.condensed(id, f.tied[at(i)], f.tied[at(j)]);
      for (Eigen::Index j = 0; j < f.coupling.cols(); ++j)
        f.coupling(i, j) = fronts.condensed(id, f.tied[at(i)], f.passed[at(j)]);
    }
    f.stiffened = stiffen(S, options.penalty_factor);
    if (n == 0) return;
    const double s2 = s() * s();
    f.flexibility = s2 * f.stiffened.factor.inverse();
    f.inverse.compute(f.flexibility);
    Matrix condensed = s2 * f.inverse.inverse();
    condensed.diagonal() -= f.stiffened.penalty;
    f.failed = f.is_singular = !condensed.allFinite();
    for (Eigen::Index i = 0; i < n && !f.failed; ++i)
      for (Eigen::Index j = 0; j < n; ++j) fronts.condensed(id, f.tied[at(i)], f.tied[at(j)]) = condensed(i, j);
    f.load = f.moved = f.multipliers = Vector::Zero(n);
  }

  void name_kept(tree::SubdomainId id, Interface& f) const {
    f.tied.clear();
    f.passed.clear();
    f.column.clear();
    for (int i = 0; i < fronts.num_refused(id); ++i) {
      f.passed.push_back(i);
      f.column.push_back(fronts.refused_columns(id)[i]);
    }
    for (const int b : tree.boundary_blocks(tree.fronts[at(tree.subdomains[at(id)].top())]))
      for (std::int64_t u = tree.unknown_begin[at(b)]; u < tree.unknown_begin[at(b) + 1]; ++u) {
        auto& to = elements.graph().block_kind[at(b)] == blocks::BlockKind::motion ? f.tied : f.passed;
        to.push_back(static_cast<int>(f.column.size()));
        f.column.push_back(static_cast<int>(u));
      }
  }

  /// g of a sub-domain, from its load.
  void condense_load(tree::SubdomainId id, const double* b) {
    double* kept = fronts.forward(id, b);
    Interface& f = interfaces[at(id)];
    if (f.tied.empty()) return;
    for (std::size_t i = 0; i < f.tied.size(); ++i) f.load(static_cast<Eigen::Index>(i)) = kept[f.tied[i]];
    f.moved = f.stiffened.factor.solve(f.load);
    const Vector g = s() * s() * f.inverse.solve(f.moved);
    for (std::size_t i = 0; i < f.tied.size(); ++i) kept[f.tied[i]] = g(static_cast<Eigen::Index>(i));
  }

  /// From the interface mesh to the multipliers and the displacements of a sub-domain.
  void recover(tree::SubdomainId id, double* x) {
    Interface& f = interfaces[at(id)];
    if (id == tree.root()) return fronts.backward(id, x);
    const int refused = fronts.num_refused(id);
    std::vector<double> own;  // the boundary's own displacements, and multipliers of the mesh
    for (std::size_t k = at(refused); k < f.column.size(); ++k) own.push_back(x[f.column[k]]);
    if (!f.tied.empty()) {
      const auto n = static_cast<Eigen::Index>(f.tied.size());
      Vector c(n), held(f.coupling.cols());
      for (Eigen::Index i = 0; i < n; ++i) c(i) = x[f.column[at(f.tied[at(i)])]];
      for (Eigen::Index j = 0; j < held.size(); ++j) held(j) = x[f.column[at(f.passed[at(j)])]];
      const Vector pulled = f.stiffened.penalty.cwiseProduct(c) - f.coupling * held;
      f.multipliers = f.inverse.solve(s() * f.moved + f.flexibility * (pulled / s()) - s() * c);
      const Vector boundary = f.stiffened.factor.solve(f.load - s() * f.multipliers + pulled);
      for (Eigen::Index i = 0; i < n; ++i) own[at(f.tied[at(i)] - refused)] = boundary(i);
    }
    fronts.backward(id, x, own.data());
  }

  void solve_scaled(const tree::Walker& walker, const double* b, double* x) {
    std::copy(b, b + tree.num_unknowns(), load.begin());
    augment_load(load.data());
    auto up = [&](tree::SubdomainId id) { condense_load(id, load.data()); };
    walker.walk_up(tree, tree::make_visit(up, tree::Work::forward));
    std::fill(x, x + tree.num_unknowns(), 0.0);
    auto down = [&](tree::SubdomainId id) { recover(id, x); };
    walker.walk_down(tree, tree::make_visit(down, tree::Work::backward));
    scale_multipliers(x);
    dependent.make_least(x);
  }

  void eval_candidates(Matrix& right, Matrix* left) {
    const tree::SubdomainId root = tree.root();
    const int k = fronts.num_refused(root);
    right.setZero(static_cast<Eigen::Index>(tree.num_unknowns()), k);
    if (left != nullptr) *left = right;
    for (tree::SubdomainId id = 0; id <= root; ++id) {
      fronts.clear_load(id);
      Interface& f = interfaces[at(id)];
      f.load.setZero();
      f.moved.setZero();
    }
    for (int v = 0; v < k; ++v) {
      double* x = right.col(v).data();
      x[fronts.refused_columns(root)[v]] = 1.0;
      for (tree::SubdomainId id = root; id >= 0; --id) recover(id, x);
      scale_multipliers(x);
      if (left == nullptr) continue;
      double* y = left->col(v).data();
      y[fronts.refused_rows(root)[v]] = 1.0;
      for (tree::SubdomainId id = root; id >= 0; --id) fronts.backward_left(id, y);
      augment_left(y);
    }
  }

  void decide_rank(const tree::Walker& walker) {
    const tree::SubdomainId root = tree.root();
    fronts.eliminate_completely(root, 0, suspect_pivot_of_root);
    if (fronts.num_refused(root) == 0) return dependent.forget();
    const RemainingUnknowns remaining{[&](Matrix& right, Matrix* left) { eval_candidates(right, left); },
                                      [&](const double* b, double* x) { solve_scaled(walker, b, x); },
                                      [&](int left) {
                                        fronts.eliminate_completely(root, left, std::numeric_limits<double>::min());
                                        return fronts.num_refused(root);
                                      }};
    dependent.decide(walker, remaining, status);
  }
};

Augmented::Augmented(const blocks::BlockGraph& graph, const tree::Tree& tree, const SolveOptions& options) {
  if (!problems_in(options).empty()) throw std::invalid_argument("Augmented: " + problems_in(options).front());
  if (tree.unknown_begin.size() != graph.block_size.size() + 1 ||
      static_cast<int>(tree.element_order.size()) != graph.num_elements())
    throw std::invalid_argument("Augmented: the tree was made from another graph");
  state_ = std::make_unique<State>(graph, tree, options);
}
Augmented::~Augmented() = default;
Augmented::Augmented(Augmented&&) noexcept = default;
Augmented& Augmented::operator=(Augmented&&) noexcept = default;

ElementView Augmented::element(int id) { return state_->elements.view(id); }
ConstElementView Augmented::element(int id) const { return std::as_const(state_->elements).view(id); }
std::span<const ElementBatch> Augmented::batches() const { return state_->batches; }
void Augmented::rescale() { state_->scales_wanted = true; }
const FactorStatus& Augmented::last_status() const { return state_->status; }
std::vector<int> Augmented::blocks_not_unique() const { return state_->dependent.blocks(); }

void Augmented::make_least(double* x) const { state_->dependent.make_least_unscaled(x); }
void Augmented::multiply(const tree::Walker& walker, const double* x, double* y) const {
  state_->elements.multiply(walker, x, y);
}

FactorStatus Augmented::factor(const tree::Walker& walker) {
  State& s = *state_;
  s.status = {};
  if (s.scales_wanted) s.elements.eval_scales(s.scales, s.buffers.residual, s.options.data_precision);
  s.scales_wanted = false;
  s.dependent.forget();
  ++s.counters.factorizations;
  if (const int block = find_not_finite_block(s.elements); block >= 0) {
    s.status.outcome = FactorOutcome::not_finite;
    s.status.block = block;
    return s.status;
  }
  auto visit = [&](tree::SubdomainId id) {
    bool is_ready = true;
    for (const tree::SubdomainId child : s.tree.children(s.tree.subdomains[at(id)]))
      is_ready = is_ready && !s.interfaces[at(child)].failed;
    s.interfaces[at(id)].failed = !is_ready;
    if (is_ready) s.factor_subdomain(id);
  };
  walker.walk_up(s.tree, tree::make_visit(visit, tree::Work::factor));
  for (tree::SubdomainId id = 0; id <= s.tree.root(); ++id) {
    if (s.interfaces[at(id)].failed) {
      const bool is_singular = s.interfaces[at(id)].is_singular;
      s.status.outcome = is_singular ? FactorOutcome::singular : FactorOutcome::not_finite;
      s.status.front = s.tree.subdomains[at(id)].top();
      const tree::Front& front = s.tree.fronts[at(s.status.front)];
      s.status.block = is_singular ? s.tree.boundary_blocks(front).front() : s.tree.blocks(front).front();
      return s.status;
    }
    if (id != s.tree.root()) s.status.delayed_pivots += s.fronts.num_refused(id);
  }
  s.counters.delayed_pivots += s.status.delayed_pivots;
  s.decide_rank(walker);
  return s.status;
}

SolveReport Augmented::solve(const tree::Walker& walker, const double* rhs, double* x) {
  State& s = *state_;
  SolveReport report;
  report.deficiency = s.status.deficiency;
  ++s.counters.solutions;
  std::vector<double> b(rhs, rhs + s.tree.num_unknowns());
  s.dependent.make_consistent(b.data(), report);
  solve_and_refine(walker, s.elements, s.scales, s.options, s.options.refinement_steps,
                   s.options.check == SolveCheck::backward_error, s.buffers, b.data(), x, report,
                   [&](const double* load, double* y) { s.solve_scaled(walker, load, y); });
  return report;
}

std::span<const double> Augmented::column_scale() const { return state_->scales.column; }
std::span<const double> Augmented::row_scale() const { return state_->scales.row; }

SolverCounters Augmented::counters() const {
  const State& s = *state_;
  SolverCounters c = s.counters;
  std::size_t doubles = s.fronts.num_doubles() + s.dependent.num_doubles();
  for (const Interface& f : s.interfaces)
    doubles += 3 * at(f.flexibility.size()) + at(f.coupling.size()) + 4 * at(f.stiffened.penalty.size());
  c.memory_bytes = s.elements.memory_bytes() + static_cast<std::int64_t>(doubles * sizeof(double));
  for (const tree::Subdomain& sub : s.tree.subdomains) {
    const double n = s.tree.fronts[at(sub.top())].num_boundary;
    c.factor_flops += sub.flops + 4.0 * n * n * n;
  }
  return c;
}

std::vector<InterfaceReport> Augmented::interfaces(int widest, bool keeps_matrices) const {
  const State& s = *state_;
  std::vector<InterfaceReport> reports;
  if (s.counters.factorizations == 0) return reports;
  for (tree::SubdomainId id = 0; id < s.tree.root(); ++id) {
    const Interface& f = s.interfaces[at(id)];
    InterfaceReport report{.subdomain = id, .level = s.tree.subdomains[at(id)].level};
    report.num_unknowns = static_cast<int>(f.column.size());
    report.num_delayed = s.fronts.num_refused(id);
    report.flops = s.tree.subdomains[at(id)].flops;
    const auto n = static_cast<int>(f.tied.size());
    if (n > widest) report.condition = std::numeric_limits<double>::quiet_NaN();
    if (n <= widest && !f.failed) {
      Matrix S(n, n);
      for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) S(i, j) = s.fronts.condensed(id, f.tied[at(i)], f.tied[at(j)]);
      const double unit = 1.0 / (s.options.multiplier_scale * s.options.multiplier_scale);
      report_flexibility(S, f.stiffened.penalty, unit * f.flexibility, keeps_matrices, report);
      for (int i = 0; keeps_matrices && i < n; ++i) report.matrices.unknowns.push_back(f.column[at(f.tied[at(i)])]);
    }
    reports.push_back(report);
  }
  return reports;
}

}  // namespace bough::solve
