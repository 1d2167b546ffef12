#include "bough/solve/hierarchical.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include "bough/blocks/at.hpp"
#include "hierarchical_state.hpp"

namespace bough::solve {

std::vector<std::string> problems_in(const SolveOptions& o) {
  std::vector<std::string> problems;
  const auto need = [&](bool condition, const char* text) {
    if (!condition) problems.emplace_back(text);
  };
  need(o.penalty_factor > 0.0 && std::isfinite(o.penalty_factor), "penalty_factor: must be > 0");
  need(o.multiplier_scale > 0.0 && std::isfinite(o.multiplier_scale), "multiplier_scale: must be > 0");
  need(o.pivot_threshold > 0.0 && o.pivot_threshold <= 1.0, "pivot_threshold: must be in (0, 1]");
  need(o.tiny_pivot > 0.0 && o.tiny_pivot < 1.0, "tiny_pivot: must be in (0, 1)");
  need(o.rank_tolerance > 0.0 && o.rank_tolerance < 1.0, "rank_tolerance: must be in (0, 1)");
  need(o.data_precision >= 0.0 && o.data_precision <= 1e-3, "data_precision: must be in [0, 1e-3]");
  need(o.singular_tolerance > 0.0 && o.singular_tolerance < 1.0, "singular_tolerance: must be in (0, 1)");
  need(o.null_motion_tolerance > 0.0 && o.null_motion_tolerance < 1.0, "null_motion_tolerance: must be in (0, 1)");
  need(o.near_bytes >= 0, "near_bytes: must be >= 0");
  need(o.refinement_steps >= 0, "refinement_steps: must be >= 0");
  need(o.refinement_above >= 0.0, "refinement_above: must be >= 0");
  return problems;
}

void Hierarchical::State::lose_symmetry(const Asymmetry& found) {
  symmetry.used = Symmetry::general;
  symmetry.loss = SymmetryLoss::values;
  symmetry.element = found.element;
  symmetry.block = elements.blocks_of(found.element)[0];
  symmetry.difference = found.difference;
  LanePlan general = make_lane_plan(elements.graph(), tree, options.lanes);
  general.batches = std::move(lanes.batches);  // equal contents; callers refer to the old ones
  lanes = std::move(general);
  size_factors();
}

Hierarchical::Hierarchical(const blocks::BlockGraph& graph, const tree::Tree& tree, const SolveOptions& options) {
  if (!problems_in(options).empty()) throw std::invalid_argument("Hierarchical: " + problems_in(options).front());
  if (tree.unknown_begin.size() != graph.block_size.size() + 1 ||
      static_cast<int>(tree.element_order.size()) != graph.num_elements())
    throw std::invalid_argument("Hierarchical: the tree was made from another graph");
  state_ = std::make_unique<State>(graph, tree, options);
}

Hierarchical::~Hierarchical() = default;
Hierarchical::Hierarchical(Hierarchical&&) noexcept = default;
Hierarchical& Hierarchical::operator=(Hierarchical&&) noexcept = default;

ElementView Hierarchical::element(int id) { return state_->elements.view(id); }
ConstElementView Hierarchical::element(int id) const { return std::as_const(state_->elements).view(id); }
void Hierarchical::rescale() { state_->scales_wanted = true; }
void Hierarchical::trust_symmetry(bool mirrored) { state_->trusts_symmetry = mirrored; }
const SymmetryReport& Hierarchical::symmetry() const { return state_->symmetry; }
const FactorStatus& Hierarchical::last_status() const { return state_->status; }
std::span<const double> Hierarchical::column_scale() const { return state_->scales.column; }
std::span<const double> Hierarchical::row_scale() const { return state_->scales.row; }
const tree::Tree& Hierarchical::tree() const { return state_->tree; }
void Hierarchical::multiply(const tree::Walker& walker, const double* x, double* y) const {
  state_->elements.multiply(walker, x, y);
}

SolverVisits Hierarchical::visits() const {
  const State& s = *state_;
  SolverVisits visits;
  for (std::size_t g = 0; g < s.lanes.groups.size(); ++g) {
    visits.parent.push_back(s.lanes.walk.subdomains[g].parent);
    visits.batch_begin.push_back(s.lanes.groups[g].element_begin);
  }
  visits.batch_begin.push_back(static_cast<int>(s.lanes.batches.size()));
  visits.of_block.assign(at(s.elements.graph().num_blocks()), 0);
  for (int id = 0; id < s.tree.num_subdomains(); ++id) {
    const tree::Subdomain& sub = s.tree.subdomains[at(id)];
    for (tree::FrontId f = sub.front_begin; f < sub.front_end; ++f)
      for (const int b : s.tree.blocks(s.front(f)).first(at(s.front(f).num_eliminated_blocks)))
        visits.of_block[at(b)] = s.lanes.group_of_subdomain[at(id)];
  }
  return visits;
}

void Hierarchical::visit_all(const tree::Walker& walker, VisitWork work) const { state_->visit_all(walker, work); }
void Hierarchical::State::visit_all(const tree::Walker& walker, VisitWork work) const {
  auto visit = [&work](int group) { work(group); };
  walker.walk_up(lanes.walk, tree::make_visit(visit, tree::Work::evaluate));
}

FactorStatus Hierarchical::factor(const tree::Walker& walker, VisitWork before, const double* rhs) {
  return state_->factor_all(walker, before, rhs, {});
}

FactorStatus Hierarchical::State::factor_all(const tree::Walker& walker, VisitWork before, const double* rhs,
                                             VisitWork after) {
  status = {};
  visit_rhs = rhs;
  if (scales_wanted) {
    if (before) visit_all(walker, std::exchange(before, {}));
    elements.eval_scales(scales, residual, options.data_precision);
    next_measurement = 0;
    check_all_symmetric();
    if (is_symmetric()) scales.row = scales.column;  // equal except for the order of a sum
    for (std::size_t u = 0; u < inverse_column.size(); ++u) inverse_column[u] = 1.0 / scales.column[u];
    lane_scales.set(lanes, tree, scales);
    std::fill(leaves_to_root.begin(), leaves_to_root.end(), char{0});
    std::fill(leaving_lanes.begin(), leaving_lanes.end(), LaneSet{0});
  }
  scales_wanted = false;
  factor_walker = walker;
  auto visit = [&](int group) {
    factor_group(group, before);
    if (after) after(group);
  };
  mark = walker.mark;
  walker.walk_up(lanes.walk, tree::make_visit(visit, tree::Work::factor));
  if (is_symmetric()) {
    check_visits_symmetric();
    if (!is_symmetric()) {
      before = {};  // the element matrices are present
      walker.walk_up(lanes.walk, tree::make_visit(visit, tree::Work::factor));
    }
  }
  null_space.dimension = 0;
  null_space.took_vectors = false;
  while (!find_local_null_vectors()) {  // at most three times, see there
    before = {};
    walker.walk_up(lanes.walk, tree::make_visit(visit, tree::Work::factor));
  }
  ++counters.factorizations;
  for (tree::FrontId f : scalar_fronts) count_front(f);
  for (std::size_t i = 0; i < scalar_lanes.size(); ++i)
    for (int l = 0; scalar_lanes[i] != 0 && l < lanes_wide; ++l)
      if ((scalar_lanes[i] >> l & 1) != 0) {
        count_front(lanes.fronts[i].front[at(l)]);
        ++counters.lanes_left;
      }
  counters.delayed_pivots += status.delayed_pivots;
  if (status.ok()) decide_rank();
  if (status.ok()) find_null_space();
  // With dependent rows the right-hand side has to be made consistent first, and candidates of null vectors are
  // computed in the storage of the condensed one.
  is_condensed = rhs != nullptr && null_space.deficiency() == 0 && !null_space.took_vectors;
  if (is_condensed) forward_group(static_cast<int>(lanes.groups.size()) - 1);
  return status;
}

void Hierarchical::condense(const tree::Walker& walker, VisitWork before, const double* rhs) {
  State& s = *state_;
  s.is_condensed = s.null_space.deficiency() == 0;
  if (!s.is_condensed) return visit_all(walker, before);
  s.visit_rhs = rhs;
  s.mark = walker.mark;
  auto forward = [&s, &before](int group) {
    before(group);
    s.mark(tree::Stage::evaluate);
    s.forward_group(group);
  };
  walker.walk_up(s.lanes.walk, tree::make_visit(forward, tree::Work::forward));
}

void Hierarchical::State::check_all_symmetric() {
  for (int e = 0; is_symmetric() && e < elements.graph().num_elements(); ++e) {
    const Asymmetry found{e, elements.asymmetry_of(e, scales)};
    if (found.is_finite() && Asymmetry::shows(found.difference)) lose_symmetry(found);
  }
}

/// Findings of the visits. A number that is not finite may be above the diagonal, which no front reads; it gives no
/// information about symmetry.
void Hierarchical::State::check_visits_symmetric() {
  for (const Asymmetry& a : asymmetries) {
    if (a.element < 0) continue;
    if (a.is_finite()) {
      lose_symmetry(a);
    } else {
      status.outcome = FactorOutcome::not_finite;
      status.block = elements.blocks_of(a.element)[0];
    }
    return;
  }
}

/// Adds a front on the scalar path to status and counters.
void Hierarchical::State::count_front(tree::FrontId f) {
  const FrontData& d = data(f);
  if (d.failed && (status.outcome != FactorOutcome::not_finite || f < status.front)) {
    const auto blocks = tree.blocks(front(f));
    status.outcome = FactorOutcome::not_finite;
    status.front = f;
    status.block = blocks.empty() ? -1 : blocks.front();
  }
  if (d.delayed_in > 0) ++counters.enlarged_fronts;
  if (d.allocated) ++counters.enlarging_allocations;
  if (f + 1 < tree.num_fronts()) status.delayed_pivots += d.num_delayed();
}

SolveReport Hierarchical::substitute(const tree::Walker& walker, const double* rhs, double* x, bool check,
                                     VisitWork after) {
  State& s = *state_;
  SolveReport report;
  if (s.is_condensed && !check) {
    s.take(rhs, x, false);
    s.visit_rhs = rhs;
    s.back_substitute(walker, after);
    ++s.counters.solutions;
    return report;
  }
  s.take(rhs, x, s.checks());
  if (s.is_condensed) {
    s.visit_rhs = rhs;
    s.back_substitute(walker);
    report = s.check_solution(walker, {});
  } else {
    report = s.solve_given(walker);
  }
  if (!after) return report;
  auto visit = [&after](int group) { after(group); };
  walker.walk_down(s.lanes.walk, tree::make_visit(visit));
  return report;
}

SolveReport Hierarchical::solve(const tree::Walker& walker, const double* rhs, double* x) {
  State& s = *state_;
  s.take(rhs, x, s.checks());
  return s.solve_given(walker);
}

SolveReport Hierarchical::State::solve_given(const tree::Walker& walker) {
  SolveReport report;
  make_consistent(report);
  solve_into_x(walker, given);
  return check_solution(walker, report);
}

SolveReport Hierarchical::solve_unchecked(const tree::Walker& walker, const double* rhs, double* x) {
  State& s = *state_;
  if (s.null_space.deficiency() > 0) return solve(walker, rhs, x);
  s.take(rhs, x, false);
  s.solve_into_x(walker, rhs);
  ++s.counters.solutions;
  return {};
}

/// The solution is written directly to x_out. The right-hand side is copied only if it is changed, or overwritten
/// before it is read again.
void Hierarchical::State::take(const double* b, double* x_out, bool looks_again) {
  given = b;
  x = x_out;
  if (null_space.deficiency() == 0 && !(looks_again && b == x_out)) return;
  rhs.assign(b, b + residual.size());
  given = rhs.data();
}

/// Measures the matrices of the present factorization in its scales, which may be those of an earlier one. If they have
/// drifted, the next factorization computes new scales: thresholds of pivots and ranks hold for entries near 1. A
/// measurement reads all matrices, so it serves the next few factorizations, too.
void Hierarchical::State::measure_matrices(const tree::Walker& walker) {
  constexpr double largest_drift = 64.0;
  if (counters.factorizations < next_measurement) return;
  next_measurement = counters.factorizations + measurement_serves;
  const ElementStore::Sizes measured = elements.eval_sizes(walker, scales);
  norm = measured.norm;
  scales_wanted = scales_wanted || measured.drift > largest_drift;
}

/// The backward error of the solution in x, which is refined if required.
SolveReport Hierarchical::State::check_solution(const tree::Walker& walker, SolveReport report) {
  const std::size_t n = residual.size();
  report.deficiency = null_space.deficiency();
  ++counters.solutions;
  if (options.check == SolveCheck::none) return report;
  measure_matrices(walker);
  ElementStore::Errors errors = eval_residual(walker, given, report);
  leave_out_zeros(errors, report);
  // Refined solutions are compared in the norm of the present matrix.
  if (errors.finite && errors.normwise > options.refinement_above) errors = eval_met_residual(walker, report);
  while (errors.finite && errors.normwise > options.refinement_above &&
         report.refinement_steps < options.refinement_steps) {
    std::copy(x, x + n, correction.begin());
    solve_into_x(walker, residual.data());
    for (std::size_t i = 0; i < n; ++i) x[i] += correction[i];
    const double rank_error = report.rank_error;
    const ElementStore::Errors refined = eval_met_residual(walker, report);
    if (!(refined.normwise < errors.normwise)) {  // no further improvement: keep the better one
      report.rank_error = rank_error;
      std::copy(correction.begin(), correction.end(), x);
      break;
    }
    errors = refined;
    ++report.refinement_steps;
  }
  report.backward_error = errors.normwise;
  report.finite = errors.finite;
  return report;
}

SolverCounters Hierarchical::counters() const {
  const State& s = *state_;
  SolverCounters c = s.counters;
  std::size_t doubles = s.factor_pool.size() + s.schur_pool.size() + s.vector_pool.size() +
                        s.null_space.left.capacity() + s.null_space.right.capacity();
  for (const std::vector<double>* v :
       {&s.scales.row, &s.scales.column, &s.inverse_column, &s.scales.weight, &s.rhs, &s.residual, &s.correction})
    doubles += v->capacity();
  for (const Enlarged& e : s.enlarged) doubles += e.a.capacity() + e.vector.capacity();
  for (const LaneDoubles* pool : {&s.lane_scratch, &s.lane_tops, &s.lane_factors, &s.lane_vectors})
    doubles += pool->size();
  c.memory_bytes = static_cast<std::int64_t>(doubles * sizeof(double) + s.index_pool.size() * sizeof(int)) +
                   s.elements.memory_bytes() + s.lane_scales.memory_bytes() + s.null_space.local_right.memory_bytes() +
                   s.null_space.local_left.memory_bytes();
  for (const LaneFront& f : s.lanes.fronts)
    for (tree::FrontId id : f.front) c.fronts_in_lanes += id != tree::none ? 1 : 0;
  return c;
}

std::span<const ElementBatch> Hierarchical::batches() const { return state_->lanes.batches; }

void Hierarchical::make_least(double* x) {
  State& s = *state_;
  if (s.null_space.deficiency() == 0) return;
  double* const present = std::exchange(s.x, x);
  s.project_multipliers();
  s.x = present;
}

std::vector<int> Hierarchical::blocks_not_unique() const {
  const State& s = *state_;
  const std::size_t n = s.residual.size();
  std::vector<double> largest(n, 0.0);
  for (int v = 0; v < s.null_space.dimension; ++v)
    for (std::size_t i = 0; i < n; ++i) largest[i] = std::max(largest[i], std::abs(s.null_space.right[at(v) * n + i]));
  const NullVectors& local = s.null_space.local_right;
  for (const NullVectors::Group& g : local.groups())
    for (int v = 0; v < g.count; ++v) {
      const std::span<const int> unknowns = local.unknowns(g);
      double square = 0.0;
      for (std::size_t k = 0; k < unknowns.size(); ++k)
        square += std::pow(local.values(g, static_cast<std::int64_t>(k))[v], 2);
      for (std::size_t k = 0; k < unknowns.size(); ++k) {
        double& here = largest[at(unknowns[k])];
        here = std::max(here, std::abs(local.values(g, static_cast<std::int64_t>(k))[v]) / std::sqrt(square));
      }
    }
  std::vector<int> blocks;
  for (int b = 0; b < s.elements.graph().num_blocks(); ++b) {
    const auto begin = largest.begin() + s.tree.unknown_begin[at(b)],
               end = largest.begin() + s.tree.unknown_begin[at(b) + 1];
    if (std::any_of(begin, end, [](double share) { return share > 1e-8; })) blocks.push_back(b);
  }
  return blocks;
}

}  // namespace bough::solve
