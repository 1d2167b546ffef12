#include "bough/solve/reference/dual.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "bough/blocks/at.hpp"
#include "dual_state.hpp"

namespace bough::solve {

Dual::State::State(const blocks::BlockGraph& graph, const tree::Tree& t, const DualOptions& f, const SolveOptions& o)
    : tree(t),
      form(f),
      options(o),
      elements(graph, t),
      batches(elements.single_batches()),
      fronts(elements, t),
      dependent(elements, scales, options),
      buffers(at(t.num_unknowns())) {
  for (auto* v : {&scales.row, &scales.column, &scales.weight}) v->assign(at(tree.num_unknowns()), 1.0);
  tear(graph);
}

Dual::Dual(const blocks::BlockGraph& graph, const tree::Tree& tree, const DualOptions& form,
           const SolveOptions& options) {
  if (!problems_in(options).empty()) throw std::invalid_argument("Dual: " + problems_in(options).front());
  if (tree.unknown_begin.size() != graph.block_size.size() + 1 ||
      static_cast<int>(tree.element_order.size()) != graph.num_elements())
    throw std::invalid_argument("Dual: the tree was made from another graph");
  state_ = std::make_unique<State>(graph, tree, form, options);
}
Dual::~Dual() = default;
Dual::Dual(Dual&&) noexcept = default;
Dual& Dual::operator=(Dual&&) noexcept = default;

ElementView Dual::element(int id) { return state_->elements.view(id); }
ConstElementView Dual::element(int id) const { return std::as_const(state_->elements).view(id); }
std::span<const ElementBatch> Dual::batches() const { return state_->batches; }
void Dual::rescale() { state_->scales_wanted = true; }
const FactorStatus& Dual::last_status() const { return state_->status; }
void Dual::multiply(const tree::Walker& walker, const double* x, double* y) const {
  state_->elements.multiply(walker, x, y);
}

void Dual::State::visit_leaves(const tree::Walker& walker, bool up, const std::function<void(LeafInterface&)>& body) {
  auto visit = [&](tree::SubdomainId s) {
    if (const int leaf = leaf_of_subdomain[at(s)]; leaf >= 0) body(leaves[at(leaf)]);
  };
  if (up) {
    walker.walk_up(tree, tree::make_visit(visit));
  } else {
    walker.walk_down(tree, tree::make_visit(visit));
  }
}

/// x (scaled, zero before) from the interface: the boundary of every leaf, then the interiors.
void Dual::State::recover(const tree::Walker& walker, const Eigen::VectorXd& solution, double* x) {
  visit_leaves(walker, false, [&](LeafInterface& leaf) { recover_leaf(leaf, solution); });
  for (std::size_t i = 0; i < mesh.size(); ++i) x[mesh[i]] = solution(static_cast<int>(i));
  for (const LeafInterface& leaf : leaves) {
    const int refused = fronts.num_refused(leaf.id);
    for (int i = 0; i < leaf.size; ++i) {
      const int kept = leaf.order[at(i)];
      if (kept < refused) {
        x[fronts.refused_columns(leaf.id)[kept]] = leaf.x[at(i)];
      } else if (const BoundaryUnknown& u = leaf.boundary[at(kept - refused)]; u.coarse < 0) {
        x[u.unknown] += copies[at(u.unknown)] * leaf.x[at(i)];
      }
    }
  }
  visit_leaves(walker, false, [&](LeafInterface& leaf) { fronts.backward(leaf.id, x); });
}

void Dual::State::solve_scaled(const tree::Walker& walker, const double* b, double* x) {
  std::fill(x, x + tree.num_unknowns(), 0.0);
  visit_leaves(walker, true, [&](LeafInterface& leaf) { condense_load(leaf, b); });
  Eigen::VectorXd rhs = Eigen::VectorXd::Zero(coarse.size), solution = rhs;
  for (LeafInterface& leaf : leaves) add_interface_load(leaf, rhs);
  for (const int place : untouched) rhs(place) += b[mesh[at(place)]];
  solve_interface(rhs, solution);
  recover(walker, solution, x);
  dependent.make_least(x);
}

FactorStatus Dual::factor(const tree::Walker& walker) {
  State& s = *state_;
  s.status = {};
  if (s.scales_wanted) s.elements.eval_scales(s.scales, s.buffers.residual);
  s.scales_wanted = false;
  ++s.counters.factorizations;
  if (const int block = find_not_finite_block(s.elements); block >= 0) {
    s.status.outcome = FactorOutcome::not_finite;
    s.status.block = block;
    return s.status;
  }
  s.visit_leaves(walker, true, [&](LeafInterface& leaf) { s.factor_leaf(leaf); });
  for (const LeafInterface& leaf : s.leaves) {
    s.status.delayed_pivots += leaf.failed ? 0 : s.fronts.num_refused(leaf.id);
    if (!leaf.failed) continue;
    s.status.outcome = FactorOutcome::not_finite;
    s.status.front = s.tree.subdomains[at(leaf.id)].top();
    s.status.block = s.tree.blocks(s.tree.fronts[at(s.status.front)]).front();
    return s.status;
  }
  s.counters.delayed_pivots += s.status.delayed_pivots;
  s.factor_interface();
  if (s.form.solution == InterfaceSolution::direct) {
    s.decide_rank(walker);
  } else {
    s.status.deficiency = -1;
  }
  return s.status;
}

SolveReport Dual::solve(const tree::Walker& walker, const double* rhs, double* x) {
  State& s = *state_;
  SolveReport report;
  report.deficiency = s.status.deficiency;
  ++s.counters.solutions;
  s.iterations = 0;
  s.converged = true;
  std::vector<double> b(rhs, rhs + s.tree.num_unknowns());
  s.dependent.make_consistent(b.data(), report);
  solve_and_refine(walker, s.elements, s.scales, s.options, s.options.refinement_steps,
                   s.options.check == SolveCheck::backward_error, s.buffers, b.data(), x, report,
                   [&](const double* load, double* y) { s.solve_scaled(walker, load, y); });
  report.interface_iterations = s.iterations;
  report.interface_converged = s.converged;
  return report;
}

SolverCounters Dual::counters() const {
  const State& s = *state_;
  SolverCounters c = s.counters;
  std::size_t doubles = s.coarse.a.capacity() + s.interface.a.capacity() + at(s.reduced.size()) +
                        at(s.preconditioner.size()) + s.dependent.num_doubles();
  for (const LeafInterface& leaf : s.leaves)
    doubles += leaf.a.capacity() + at(leaf.flexibility.size() + leaf.right.size() + leaf.left.size());
  c.memory_bytes = s.elements.memory_bytes() + static_cast<std::int64_t>(doubles * sizeof(double));
  for (const tree::Subdomain& sub : s.tree.subdomains) c.factor_flops += sub.is_leaf() ? sub.flops : 0.0;
  c.factor_flops += s.coarse.flops() + s.interface.flops();
  return c;
}

std::vector<int> Dual::blocks_not_unique() const { return state_->dependent.blocks(); }

void Dual::make_least(double* x) const { state_->dependent.make_least_unscaled(x); }

std::vector<InterfaceReport> Dual::interfaces() const {
  const State& s = *state_;
  if (s.counters.factorizations == 0) return {};
  InterfaceReport report{.subdomain = s.tree.root(), .num_unknowns = s.num_ties()};
  report.num_coarse = s.num_coarse;
  for (const LeafInterface& leaf : s.leaves) report.num_floating += leaf.full - leaf.pivots;
  report.num_delayed = s.coarse.full - s.coarse.pivots;
  constexpr int widest_for_condition =
      300;  // dense singular values of wider problems would take longer than short runs
  report.condition =
      s.num_ties() <= widest_for_condition ? s.eval_condition() : std::numeric_limits<double>::quiet_NaN();
  const double product = 2.0 * static_cast<double>(s.interface.size) * s.interface.size;
  report.flops = s.coarse.flops() +
                 (s.form.solution == InterfaceSolution::direct ? s.interface.flops() : s.iterations * 2.0 * product);
  report.seconds = s.seconds;
  report.iterations = s.iterations;
  return {report};
}

}  // namespace bough::solve
