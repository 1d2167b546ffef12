#include "bough/step/element_evaluation.hpp"

#include <algorithm>
#include <array>
#include <type_traits>

#include "element_parts.hpp"
#include "lane_batches.hpp"
#include "reduced_elements.hpp"
#include "signal_columns.hpp"
#include "trimmed_elements.hpp"

namespace bough::step {

namespace {

/// Of the reference axis, where an element has one.
template <class E>
double length_of(const E& e, double fallback) {
  if constexpr (E::data_axes == elements::DataAxes::section) return e.length;
  return fallback;
}

/// Number of unknowns of an element in the linear system.
int num_unknowns_of(const plan::Plan& plan, std::size_t element) {
  int n = 0;
  const blocks::BlockGraph& g = plan.graph;
  for (std::int64_t k = g.element_begin[element]; k < g.element_begin[element + 1]; ++k)
    n += g.block_size[static_cast<std::size_t>(g.element_blocks[static_cast<std::size_t>(k)])];
  return n;
}

}  // namespace

ElementLengths measure_elements(const plan::Plan& plan) {
  ElementLengths lengths;
  lengths.of_element.resize(plan.directory.size());
  for (std::size_t e = 0; e < plan.directory.size(); ++e)
    plan::with_element(plan.elements, plan.directory[e], [&](const auto& element) {
      lengths.of_element[e] = length_of(element, plan.length_scale);
      if constexpr (std::decay_t<decltype(element)>::data_axes == elements::DataAxes::section)
        lengths.moment_arm = std::max(lengths.moment_arm, element.length);
    });
  if (lengths.moment_arm == 0.0) lengths.moment_arm = plan.length_scale;
  return lengths;
}

ElementEvaluation::ElementEvaluation(const plan::Plan& plan, const Instant& instant, const TrimmedElements* trimmed,
                                     ResidualSums& sums, LinearSolution& linear, const tree::Walker& walker)
    : plan_(plan), instant_(instant), trimmed_(trimmed), sums_(sums), linear_(linear), walker_(walker) {
  plan.with_group([&]<class G>() {
    auto lanes = std::make_unique<LaneBatches<G>>();
    lanes->make(plan, linear.solver().batches(), linear.visits(), trimmed);
    lanes_ = std::move(lanes);
  });
}

ElementEvaluation::~ElementEvaluation() = default;

void ElementEvaluation::take_frames() {
  if (!plan_.frames.empty()) std::get<LanesOn<motion::Se3>>(lanes_)->set_frames(instant_.frames());
}

template <class G>
void ElementEvaluation::evaluate_alone(std::size_t id, const State& state, const elements::FieldOn<G, double>& f,
                                       const ElementResults& to) {
  if (trimmed_ && trimmed_->leaves_out(id)) return;
  const int j = plan_.joint_of_element[id];
  if (is_idle_joint(plan_, j)) return;
  std::array<double, elements::max_rows> scratch;
  const double* multipliers = nullptr;
  double turns = 0.0;
  if (j >= 0) {
    multipliers = multipliers_on<G>(plan_.joints[static_cast<std::size_t>(j)], state, scratch.data());
    turns = state.turns[static_cast<std::size_t>(j)];
  }
  plan::with_element(plan::arrays_on<G>(plan_), plan_.directory[id], [&](const auto& e) {
    std::array<double, most_unknowns> residual, magnitude;
    std::array<double, most_unknowns * most_unknowns> tangent_entries;
    const solve::ElementView view = to.want_tangents() ? to.tangent_of(static_cast<int>(id)) : solve::ElementView{};
    const std::span<const int> signals = plan::signals_of(plan_, id);
    const bool is_direct = view.stride == 1 && signals.empty() && !(trimmed_ && trimmed_->trims(id));
    elements::evaluate(e, f, multipliers, turns, residual.data(),
                       !to.want_tangents() ? nullptr
                       : is_direct         ? view.first
                                           : tangent_entries.data());
    const int n = elements::num_unknowns(e), num_signals = static_cast<int>(signals.size());
    elements::eval_magnitude(e, f, residual.data(), magnitude.data());
    for (int i = n; i < n + num_signals; ++i)
      residual[static_cast<std::size_t>(i)] = magnitude[static_cast<std::size_t>(i)] = 0.0;
    sums_.set_parts(id, residual.data(), magnitude.data());
    if (num_signals > 0 && to.want_tangents()) {
      std::array<double, most_unknowns * most_unknowns> extended;
      add_signal_columns(n, num_signals, tangent_entries.data(), extended.data(), [&](int s, double* column) {
        const plan::SignalPlan& signal = plan_.signals[static_cast<std::size_t>(signals[static_cast<std::size_t>(s)])];
        if (f.slopes.mass_only)  // signals stand still with the motion
          std::fill(column, column + n, 0.0);
        else
          elements::evaluate_law_slope(e, f, multipliers, turns, signal.law, column);
        if (f.slopes.holds_drives) std::fill(column + n - elements::num_multipliers(e), column + n, 0.0);
      });
      for (int s = 0; s < num_signals && !f.slopes.mass_only; ++s) {
        const plan::SignalPlan& signal = plan_.signals[static_cast<std::size_t>(signals[static_cast<std::size_t>(s)])];
        if (signal.joint != j || signal.row_in_block < 0) continue;
        const int all = n + num_signals, column = n - elements::num_multipliers(e) + signal.row_in_block;
        extended[static_cast<std::size_t>((n + s) * all + column)] = 1.0;  // of s - (... - multiplier)
      }
      write_matrix(
          trimmed_, id, n + num_signals, [&](int i) { return extended[static_cast<std::size_t>(i)]; }, view);
      return;
    }
    if (to.want_tangents() && !is_direct)
      write_matrix(
          trimmed_, id, n, [&](int i) { return tangent_entries[static_cast<std::size_t>(i)]; }, view);
  });
}

void ElementEvaluation::begin(const State& state, const elements::Slopes& slopes, bool tangent) {
  if (tangent) linear_.begin_matrices(linear_.takes_symmetric_parts());
  state_ = &state;
  with_tangents_ = tangent;
  state.visit([&]<class G>(const NodesOn<G>&) { field_.emplace<FieldOf<G>>(instant_.field_on<G>(state, slopes)); });
}

void ElementEvaluation::evaluate_visit(int visit) {
  std::visit(
      [&]<class G>(const std::unique_ptr<LaneBatches<G>>& lanes) {
        const FieldOf<G>& field = std::get<FieldOf<G>>(field_);
        lanes->by_visit().for_each(walker_, visit, batch_grain, [&](std::int64_t begin, std::int64_t end) {
          evaluate_batches<G>(field, begin, end);
        });
      },
      lanes_);
}

void ElementEvaluation::evaluate_as_seen(const State& state) {
  const elements::Field f = instant_.field(state);
  auto by_element = [&](std::int64_t begin, std::int64_t end) {
    std::array<double, most_unknowns> residual, reduced;
    for (auto id = static_cast<std::size_t>(begin); id < static_cast<std::size_t>(end); ++id) {
      if (trimmed_ && trimmed_->leaves_out(id)) continue;
      const plan::JointPlan* const joint = plan_.joint_of(id);
      const double* multipliers = joint == nullptr ? nullptr : state.multipliers.data() + joint->multiplier_begin;
      const double turns = joint == nullptr ? 0.0 : state.turns[static_cast<std::size_t>(plan_.joint_of_element[id])];
      reduced.fill(0.0);
      plan::with_element(plan_.elements, plan_.directory[id], [&](const auto& e) {
        elements::evaluate(e, f, multipliers, turns, residual.data(), nullptr);
        reduce_vector(plan_.unknowns, e, joint, residual.data(), reduced.data());
        sums_.set_parts(id, reduced.data(), nullptr);
      });
    }
  };
  walker_.for_each_chunk(static_cast<std::int64_t>(plan_.directory.size()), element_grain,
                         tree::make_chunk(by_element));
}

void ElementEvaluation::set_matrix(int element, int num_unknowns, const double* entries) {
  const solve::ElementView view = linear_.solver().element(element);
  for_each_kept(trimmed_, static_cast<std::size_t>(element), num_unknowns,
                [&](std::int64_t place, int i) { view[place] = entries[i]; });
}

void ElementEvaluation::add_matrix(int element, int num_unknowns, const double* entries) {
  const solve::ElementView view = linear_.solver().element(element);
  for_each_kept(trimmed_, static_cast<std::size_t>(element), num_unknowns,
                [&](std::int64_t place, int i) { view[place] += entries[i]; });
}

void ElementEvaluation::symmetrise(const solve::ElementBatch& batch) {
  for (int id : batch.element) {
    if (id < 0) continue;
    const int n = num_unknowns_of(plan_, static_cast<std::size_t>(id));
    const solve::ElementView view = linear_.solver().element(id);
    for (int i = 1; i < n; ++i)
      for (int j = 0; j < i; ++j) view[i * n + j] = view[j * n + i] = 0.5 * (view[i * n + j] + view[j * n + i]);
  }
}

template <class G>
void ElementEvaluation::evaluate_batches(const elements::FieldOn<G, double>& field, std::int64_t begin,
                                         std::int64_t end) {
  const LaneBatches<G>& lanes = *std::get<LanesOn<G>>(lanes_);
  const std::span<const solve::ElementBatch> batches = lanes.batches();
  const ElementResults results{sums_.parts(), sums_.begins(), with_tangents_ ? &linear_.solver() : nullptr};
  for (auto batch = static_cast<std::size_t>(begin); batch < static_cast<std::size_t>(end); ++batch) {
    if (lanes.holds(batch))
      lanes.evaluate(batch, *state_, field, results);
    else
      for (int id : batches[batch].element)
        if (id >= 0) evaluate_alone(static_cast<std::size_t>(id), *state_, field, results);
    if (with_tangents_ && linear_.takes_symmetric_parts()) symmetrise(batches[batch]);
  }
}

solve::ConstElementView ElementEvaluation::matrix_of(int element, std::vector<std::int64_t>& unknowns) const {
  unknowns.clear();
  const auto e = static_cast<std::size_t>(element);
  const blocks::BlockGraph& g = plan_.graph;
  for (std::int64_t k = g.element_begin[e]; k < g.element_begin[e + 1]; ++k) {
    const int block = g.element_blocks[static_cast<std::size_t>(k)];
    const std::vector<std::int64_t>& begin = linear_.tree().unknown_begin;
    for (std::int64_t u = begin[static_cast<std::size_t>(block)]; u < begin[static_cast<std::size_t>(block) + 1]; ++u)
      unknowns.push_back(u);
  }
  return linear_.solver().element(element);
}

}  // namespace bough::step
