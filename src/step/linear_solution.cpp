#include "bough/step/linear_solution.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "make_solver.hpp"

namespace bough::step {

using motion::Vec6;

BlockOwners::BlockOwners(const plan::Plan& plan)
    : plan_(plan), joints_(static_cast<std::size_t>(plan.graph.num_blocks()), -1), nodes_(joints_), signals_(joints_) {
  for (std::size_t s = 0; s < plan::driving_signals(plan).size(); ++s)
    signals_[static_cast<std::size_t>(plan.signals[s].block)] = static_cast<int>(s);
  for (std::size_t j = 0; j < plan.joints.size(); ++j)
    if (plan.joints[j].block >= 0) joints_[static_cast<std::size_t>(plan.joints[j].block)] = static_cast<int>(j);
  for (std::size_t n = 0; n < plan.nodes.size(); ++n)
    if (plan.block_of_node[n] >= 0) nodes_[static_cast<std::size_t>(plan.block_of_node[n])] = static_cast<int>(n);
}

std::string BlockOwners::name(int block) const {
  if (signal(block) >= 0) return "signal '" + plan_.signals[static_cast<std::size_t>(signal(block))].name + "'";
  if (joint(block) < 0) return "'" + plan_.nodes[static_cast<std::size_t>(node(block))].name + "'";
  const plan::JointPlan& j = plan_.joints[static_cast<std::size_t>(joint(block))];
  return j.what + " '" + j.name + "'";
}

namespace {

/// Visits in the order of an upward walk of one thread, in runs with at least so many batches of elements. The first
/// visit of a run stands for all: on the way up it comes before the others, on the way down after them.
solve::SolverVisits in_runs(solve::SolverVisits visits) {
  constexpr int least_batches = 64;
  std::vector<int> first_of(visits.parent.size());
  std::vector<int> batch_begin = visits.batch_begin;
  int first = 0;
  for (int v = 0; v < visits.count(); ++v) {
    const auto at = static_cast<std::size_t>(v);
    first_of[at] = first;
    visits.parent[at] = v + 1 < visits.count() ? v + 1 : -1;
    if (v > first) batch_begin[at] = -1;  // its batches belong to the first of the run
    if (visits.batch_begin[at + 1] - visits.batch_begin[static_cast<std::size_t>(first)] >= least_batches)
      first = v + 1;
  }
  for (std::size_t v = visits.parent.size(); v-- > 0;)
    if (batch_begin[v] < 0) batch_begin[v] = batch_begin[v + 1];
  visits.batch_begin = std::move(batch_begin);
  for (int& visit : visits.of_block) visit = first_of[static_cast<std::size_t>(visit)];
  return visits;
}

}  // namespace

LinearSolution::LinearSolution(const plan::Plan& plan, const scene::Solver& solver, const tree::Walker& walker,
                               CpuClock& clock, WorkCounts& counts)
    : plan_(plan),
      owners_(plan),
      walker_(walker),
      clock_(clock),
      counts_(counts),
      tree_(std::make_unique<tree::Tree>(tree::make_tree(plan.graph, make_tree_options(plan, solver)))),
      solver_(make_solver(plan, *tree_, solver)),
      visits_(solver_->visits(plan.graph.num_blocks())),
      takes_symmetric_parts_(plan.took("symmetric")) {
  good_ = make_solve_options(plan, solver).refinement_above;
  if (walker.threads == 1) visits_ = in_runs(std::move(visits_));
  element_begin_.push_back(0);
  const std::span<const solve::ElementBatch> batches = std::as_const(*solver_).batches();
  for (std::size_t v = 0; v < visits_.parent.size(); ++v) {
    for (int b = visits_.batch_begin[v]; b < visits_.batch_begin[v + 1]; ++b)
      for (const int id : batches[static_cast<std::size_t>(b)].element)
        if (id >= 0) elements_.push_back(id);
    element_begin_.push_back(elements_.size());
  }
}

std::span<const int> LinearSolution::elements_of_visit(int visit) const {
  const auto v = static_cast<std::size_t>(visit);
  return {elements_.data() + element_begin_[v], element_begin_[v + 1] - element_begin_[v]};
}

void LinearSolution::begin_matrices(bool are_symmetric) {
  solver_->trust_symmetry(are_symmetric);
  is_of_matrices_ = false;
  ++num_matrices_;
}

bool LinearSolution::has_factor(const elements::Slopes& s) const {
  return is_factored_ && s.velocity == factored_.velocity && s.acceleration == factored_.acceleration &&
         s.rate == factored_.rate && s.mass_only == factored_.mass_only && s.holds_drives == factored_.holds_drives;
}

void LinearSolution::note_service(int solutions) {
  service_cost_ += solutions;
  is_worn_ = solutions * ++iterations_served_ >= service_cost_;
}

std::optional<Trouble> LinearSolution::factor(bool rescale, const elements::Slopes& slopes, solve::VisitWork before,
                                              const double* rhs) {
  PhaseTimer timer{clock_, counts_.factor};
  const bool is_like_the_last = !rescale && has_factor(slopes);
  if (!is_like_the_last) solver_->rescale();
  const bool was_trusted = is_trusted_ && is_like_the_last && last_solution_.backward_error <= 0.1 * good_;
  is_factored_ = is_trusted_ = false;
  contraction_ = 1.0;
  service_cost_ = renewal_cost_;
  iterations_served_ = 0;
  is_worn_ = false;
  ++counts_.factorizations;
  const solve::FactorStatus status = solver_->factor(walker_, before, rhs);
  if (remembers_) note_scales(!is_like_the_last);
  if (status.ok()) {
    factored_ = slopes;
    is_factored_ = is_of_matrices_ = true;
    is_trusted_ = was_trusted && status.delayed_pivots == 0 && status.deficiency == 0;
    return std::nullopt;
  }
  if (status.outcome == solve::FactorOutcome::not_finite) return Trouble{"a tangent is not finite"};
  if (const char* why = explain_backend(status.outcome)) return Trouble{why};
  const char* advice = slopes.mass_only ? "; every part that can move needs inertia or has to be held by a joint" : "";
  return Trouble{explain_singular(status) + advice};
}

/// Explains a singular matrix by the free or massless motions that the plan has found, or else by the unknown that has
/// no pivot.
std::string LinearSolution::explain_singular(const solve::FactorStatus& status) const {
  std::string text = "the linear system is singular";
  const plan::Mobility& mobility = plan_.mobility;
  const std::vector<std::string>& known = mobility.free.empty() ? mobility.massless : mobility.free;
  for (const std::string& motion : known) text += (&motion == &known.front() ? ": " : "; ") + motion;
  if (!known.empty() || status.block < 0) return text;
  static const char* const axes[] = {"displacement along axis 1", "displacement along axis 2",
                                     "displacement along axis 3", "rotation about axis 1",
                                     "rotation about axis 2",     "rotation about axis 3"};
  text += owners_.signal(status.block) < 0 ? ": nothing holds " : ": nothing determines ";
  text += owners_.name(status.block);
  const int node = owners_.node(status.block);
  if (node >= 0 && status.local >= 0 && status.local < plan_.unknowns.count_of(static_cast<std::size_t>(node))) {
    std::array<double, 6> unit{};
    unit[static_cast<std::size_t>(status.local)] = 1.0;
    const Vec6<double> eta = plan_.unknowns.expanded(unit.data(), static_cast<std::size_t>(node));
    int largest = 0;
    for (int i = 1; i < 6; ++i)
      if (std::abs(eta[i]) > std::abs(eta[largest])) largest = i;
    text += std::string(" (") + axes[largest] + " of its own frame has the largest share)";
  }
  return text + ", or it is held some 1e16 times more softly than its neighbours hold each other";
}

/// The solver takes new scales where it is told to, and where it has found that entries have drifted.
void LinearSolution::note_scales(bool are_new) {
  made_of_.factor = num_matrices_;
  ++made_of_.factors;
  if (const solve::Hierarchical* solver = solver_->hierarchical()) {
    const std::span<const double> scales = solver->column_scale();
    are_new = are_new || !std::equal(scales.begin(), scales.end(), scales_.begin(), scales_.end());
    if (are_new) scales_.assign(scales.begin(), scales.end());
  }
  if (!are_new) return;
  made_of_.scales = num_matrices_;
  made_of_.measured = -1;
  made_of_.next_measured = 0;
}

void LinearSolution::note_checked() {
  if (made_of_.factors < made_of_.next_measured) return;
  made_of_.measured = num_matrices_;
  made_of_.next_measured = made_of_.factors + measurement_serves;
}

void LinearSolution::factor_again() {
  static_cast<void>(solver_->factor(walker_));
  if (const solve::Hierarchical* solver = solver_->hierarchical())
    scales_.assign(solver->column_scale().begin(), solver->column_scale().end());
}

void LinearSolution::check_again() {
  const std::vector<double> rhs(static_cast<std::size_t>(tree_->num_unknowns()), 1.0);
  std::vector<double> x(rhs.size());
  static_cast<void>(solver_->solve(walker_, rhs.data(), x.data()));
}

void LinearSolution::condense(solve::VisitWork before, const double* rhs) {
  PhaseTimer timer{clock_, counts_.assemble};
  solver_->condense(walker_, before, rhs);
}

bool LinearSolution::may_skip_check() {
  return is_trusted_ && solver_->hierarchical() != nullptr && ++unchecked_ < check_every;
}

std::optional<Trouble> LinearSolution::solve(const double* rhs, double* x, bool check) {
  PhaseTimer timer{clock_, counts_.solve};
  ++counts_.solutions;
  if (!check) {  // of an observer: neither the schedule of checks nor the trust in the factor may change by it
    static_cast<void>(solver_->solve(walker_, rhs, x, false));
    if (remembers_ && solver_->last_status().deficiency > 0) note_checked();  // checked all the same
    return std::nullopt;  // the caller notices a solution that is not finite
  }
  return find_trouble(solver_->solve(walker_, rhs, x));
}

std::optional<Trouble> LinearSolution::substitute(const double* rhs, double* x, solve::VisitWork after) {
  PhaseTimer timer{clock_, counts_.solve};
  ++counts_.solutions;
  const bool check = !may_skip_check();
  const solve::SolveReport solution = solver_->substitute(walker_, rhs, x, check, after);
  return check ? find_trouble(solution) : std::nullopt;
}

std::optional<Trouble> LinearSolution::find_trouble(const solve::SolveReport& solution) {
  unchecked_ = 0;
  ++counts_.checks;
  if (remembers_) note_checked();
  last_solution_ = solution;
  is_trusted_ = last_solution_.backward_error <= good_ && last_solution_.refinement_steps == 0;
  if (!last_solution_.interface_converged)
    return Trouble{"the iteration on the interface problem gave up after " +
                   std::to_string(last_solution_.interface_iterations) +
                   " iterations: choose \"direct\" for /solver/interface_solution, or another /solver/form"};
  if (!last_solution_.finite) return Trouble{"the solution of the linear system is not finite"};
  if (last_solution_.backward_error > counts_.backward_error_max)
    counts_.backward_error_max = last_solution_.backward_error;
  counts_.rank_error_max = std::max(counts_.rank_error_max, last_solution_.rank_error);
  return std::nullopt;
}

}  // namespace bough::step
