#include "bough/step/constraints.hpp"

#include <algorithm>
#include <cmath>

#include "bough/elements/rows.hpp"
#include "element_parts.hpp"

namespace bough::step {

namespace {

constexpr std::int64_t joint_grain = 64;

const elements::Joint& element_of(const plan::Plan& plan, std::size_t joint) {
  const plan::ElementPlace place = plan.directory[static_cast<std::size_t>(plan.joints[joint].element)];
  return plan::array_of<elements::Joint>(plan.elements)[static_cast<std::size_t>(place.index)];
}

Violations largest(const Violations& a, const Violations& b) {
  const bool b_is_wider = b.relative_position > a.relative_position,
             b_is_faster = b.relative_velocity > a.relative_velocity;
  return {std::max(a.position, b.position),         b_is_wider ? b.relative_position : a.relative_position,
          std::max(a.velocity, b.velocity),         b_is_faster ? b.relative_velocity : a.relative_velocity,
          b_is_wider ? b.open_joint : a.open_joint, b_is_faster ? b.fast_joint : a.fast_joint};
}

}  // namespace

Constraints::Constraints(const plan::Plan& plan, const Instant& instant, const tree::Walker& walker)
    : plan_(plan), instant_(instant), walker_(walker), signals_(plan) {
  series_.resize(static_cast<std::size_t>(plan.num_multipliers));
  for (std::size_t j = 0; j < plan.joints.size(); ++j)
    if (!is_idle_joint(plan, static_cast<int>(j)))
      for (const elements::Port& port : element_of(plan, j).ports)
        if (port.node != elements::ground) nodes_.push_back(port.node);
  std::sort(nodes_.begin(), nodes_.end());
  nodes_.erase(std::unique(nodes_.begin(), nodes_.end()), nodes_.end());
  if (!plan.signals_drive) return;
  laws_.resize(plan.laws.size());
  law_rates_.resize(plan.laws.size());
}

const Instant::Series& Constraints::laws_of(const State& state, const elements::Field& field, double step_size) const {
  const Instant::Series& laws = instant_.series(step_size);
  if (!plan_.signals_drive) return laws;
  laws_ = laws;
  signals_.complete(state, field, step_size, laws_);
  return laws_;
}

void Constraints::series(const State& state, const motion::Vec6<double>* jerk, double step_size,
                         std::vector<lanes::Taylor<double, 3>>& out) const {
  elements::Field f = instant_.field(state);
  if (step_size > 0.0 && !plan_.frames.empty()) f.carriers = instant_.frame_series(step_size).in_ground.data();
  const Instant::Series& laws = laws_of(state, f, step_size);
  out.resize(static_cast<std::size_t>(plan_.num_multipliers));
  for (std::size_t j = 0; j < plan_.joints.size(); ++j)
    elements::evaluate_constraint_series(element_of(plan_, j), f, jerk, laws.data(), state.turns[j],
                                         out.data() + plan_.joints[j].multiplier_begin);
}

Violations Constraints::violations(const State& state) const {
  using T = lanes::Taylor<double, 1>;
  // Signals may read any node.
  const elements::Field f =
      plan_.signals_drive ? instant_.field(state) : instant_.field_of(state, nodes_, motions_, &walker_);
  if (plan_.signals_drive) {
    const Instant::Series& series = laws_of(state, f, 0.0);
    for (std::size_t i = 0; i < series.size(); ++i) {
      law_rates_[i].c[0] = series[i].c[0];
      law_rates_[i].c[1] = series[i].c[1];
    }
  }
  const std::vector<T>& laws = plan_.signals_drive ? law_rates_ : instant_.rate_series();
  const auto count = static_cast<std::int64_t>(plan_.joints.size());
  parts_.assign(static_cast<std::size_t>((count + joint_grain - 1) / joint_grain), {});
  auto by_joint = [&](std::int64_t begin, std::int64_t end) {
    Violations& most = parts_[static_cast<std::size_t>(begin / joint_grain)];
    T rows[elements::max_rows];
    for (auto j = static_cast<std::size_t>(begin); j < static_cast<std::size_t>(end); ++j) {
      if (is_idle_joint(plan_, static_cast<int>(j))) continue;  // no motion changes its rows, which the start closed
      const elements::Joint& e = element_of(plan_, j);
      elements::evaluate_constraint_rates(e, f, laws.data(), state.turns[j], rows);
      for (int row = 0; row < e.num_rows; ++row) {
        const double length = elements::is_length(e.rows[row].kind) ? plan_.joints[j].length : 1.0;
        const double gap = std::abs(rows[row].c[0]), rate = std::abs(rows[row].c[1]);
        const int joint = static_cast<int>(j);
        most = largest(most, {gap, gap / length, rate, rate / length, joint, joint});
      }
    }
  };
  walker_.for_each_chunk(count, joint_grain, tree::make_chunk(by_joint));
  Violations most;
  for (const Violations& part : parts_) most = largest(most, part);
  return most;
}

double Constraints::largest_violation(const State& state, int order, bool is_relative, int* joint) const {
  series(state, nullptr, 0.0, series_);
  double most = 0.0;
  for (std::size_t j = 0; j < plan_.joints.size(); ++j) {
    const elements::Joint& e = element_of(plan_, j);
    for (int row = 0; row < e.num_rows; ++row) {
      const auto multiplier = static_cast<std::size_t>(plan_.joints[j].multiplier_begin + row);
      const double length = is_relative && elements::is_length(e.rows[row].kind) ? plan_.joints[j].length : 1.0;
      const double value = std::abs(series_[multiplier].c[order]) / length;
      if (value > most) {
        most = value;
        if (joint != nullptr) *joint = static_cast<int>(j);
      }
    }
  }
  return most;
}

double Constraints::violation(const State& state, int order, int* joint) const {
  return largest_violation(state, order, false, joint);
}

double Constraints::relative_violation(const State& state, int order, int* joint) const {
  return largest_violation(state, order, true, joint);
}

}  // namespace bough::step
