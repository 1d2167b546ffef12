/// System: moving the nodes, and time derivatives along a motion.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "bough/elements/rows.hpp"
#include "bough/step/system.hpp"
#include "held_nodes.hpp"
#include "moving_nodes.hpp"
#include "reduced_elements.hpp"
#include "system_parts.hpp"

namespace bough::step {

using motion::Vec6;

void System::find_pairs() {
  int lane = elements::num_lanes;
  const auto add = [&](int a, int b, double per_length) {
    if (lane == elements::num_lanes) {
      lane = 0;
      pairs_.emplace_back();
    }
    PairLanes& pairs = pairs_.back();
    for (int l = lane++; l < elements::num_lanes; ++l) {
      pairs.a[l] = a;
      pairs.b[l] = b;
      pairs.per_length.set(l, per_length);
    }
  };
  for (std::size_t id = 0; id < plan_.directory.size(); ++id)
    plan::with_element(plan_.elements, plan_.directory[id], [&](const auto& e) {
      const double per_length = 1.0 / element_length_[id];
      const int first = e.ports[0].node == elements::ground ? -1 : e.ports[0].node;
      constexpr int num_ports = std::decay_t<decltype(e)>::num_ports;
      if (num_ports == 1 && first >= 0) add(-1, first, per_length);
      for (int p = 1; p < num_ports; ++p)
        if (e.ports[p].node != elements::ground) add(first, e.ports[p].node, per_length);
    });
  chunk_max_.resize((pairs_.size() + pair_grain - 1) / pair_grain);
}

IncrementsOf System::increments() const { return {plan_.unknowns, node_begin_.data()}; }

namespace {
constexpr std::int64_t joint_grain = 64;

Violations largest(const Violations& a, const Violations& b) {
  const bool b_is_wider = b.relative_position > a.relative_position,
             b_is_faster = b.relative_velocity > a.relative_velocity;
  return {std::max(a.position, b.position),         b_is_wider ? b.relative_position : a.relative_position,
          std::max(a.velocity, b.velocity),         b_is_faster ? b.relative_velocity : a.relative_velocity,
          b_is_wider ? b.open_joint : a.open_joint, b_is_faster ? b.fast_joint : a.fast_joint};
}

}  // namespace

double System::relative_size(const State& state, const double* x) const {
  state.visit([&](const auto& nodes) {
    auto by_pair = [&](std::int64_t begin, std::int64_t end) {
      const std::span<const PairLanes> some(pairs_.data() + begin, static_cast<std::size_t>(end - begin));
      chunk_max_[static_cast<std::size_t>(begin / pair_grain)] = largest_change(nodes, some, x, increments());
    };
    walker_.for_each_chunk(static_cast<std::int64_t>(pairs_.size()), pair_grain, tree::make_chunk(by_pair));
  });
  double most = 0.0;
  for (double size : chunk_max_) most = std::max(most, size);
  return std::sqrt(most);
}

void System::add_multipliers(State& state, const double* x, double factor) const {
  for (const MultiplierPlace& at : multiplier_places_) state.multipliers[at.multiplier] += factor * x[at.unknown];
}

void System::predict_multipliers(const State& start, State& state) const {
  state.multipliers = start.multipliers;
  if (start.multiplier_order == 0) return;
  const double of_change = start.multiplier_order == 2 ? 1.0 : 0.0;
  for (const MultiplierPlace& at : multiplier_places_)
    state.multipliers[at.multiplier] +=
        start.multiplier_trend[at.multiplier] + of_change * start.multiplier_trend_change[at.multiplier];
}

void System::note_multipliers(const State& start, State& state) const {
  Workspace::Misses misses{};
  state.multiplier_trend.resize(state.multipliers.size());
  state.multiplier_trend_change.resize(state.multipliers.size());
  for (const MultiplierPlace& at : multiplier_places_) {
    const std::size_t m = at.multiplier;
    const double now = state.multipliers[m] - start.multipliers[m], of_trend = now - start.multiplier_trend[m];
    const double weight = is_length_[at.unknown] != 0 ? 1.0 : 1.0 / moment_arm_;  // moments count as forces at the arm
    const double missed[] = {now, of_trend, of_trend - start.multiplier_trend_change[m]};
    for (std::size_t k = 0; k < misses.size(); ++k) misses[k] += (weight * missed[k]) * (weight * missed[k]);
    state.multiplier_trend[m] = now;
    state.multiplier_trend_change[m] = of_trend;
  }
  state.multiplier_order = least_missed(misses);
}

double System::apply(State& state, const double* x) {
  PhaseTimer timer{clock_, counts_.update};
  const double change = relative_size(state, x);
  state.change_all([&](auto& nodes) {
    auto by_node = [&](std::int64_t begin, std::int64_t end) {
      move_nodes(nodes, static_cast<std::size_t>(begin), static_cast<std::size_t>(end), x, increments());
    };
    walker_.for_each_chunk(static_cast<std::int64_t>(nodes.motion.size()), block_grain, tree::make_chunk(by_node));
  });
  if (plan_.num_multipliers > 0) add_multipliers(state, x, 1.0);
  return change;
}

void System::settle(State& state) {
  find_unsettled(state);
  recover_multipliers(state);
}

void System::recover_multipliers(State& state, const std::vector<Vec6<double>>* more) const {
  // In statics by elements in space, as sensors see them: what is unsettled belongs to their residuals.
  if (held_) held_->recover_multipliers(*this, state, more, state.is_planar() && plan_.is_dynamic);
}

double System::largest_held_impulse(const State& state, const double* x) const {
  return held_ ? held_->largest_impulse(*this, state, x) : 0.0;
}

/// Sum of the residuals of elements in space, as sensors see them, in the unknowns of the plane; false where it is not
/// finite. Nodes keep more digits in the plane than they have in space, so elements answer with other forces there.
bool System::sum_as_seen(const State& state, std::vector<double>& sum) {
  const elements::Field f = field(state);
  auto by_element = [&](std::int64_t begin, std::int64_t end) {
    std::array<double, most_unknowns> residual;
    for (auto id = static_cast<std::size_t>(begin); id < static_cast<std::size_t>(end); ++id) {
      if (held_ && held_->leaves_out(id)) continue;
      const plan::JointPlan* const joint = joint_plan_of(id);
      const double* multipliers = joint == nullptr ? nullptr : state.multipliers.data() + joint->multiplier_begin;
      const double turns = joint == nullptr ? 0.0 : state.turns[static_cast<std::size_t>(joint_of_element_[id])];
      plan::with_element(plan_.elements, plan_.directory[id], [&](const auto& e) {
        elements::evaluate(e, f, multipliers, turns, residual.data(), nullptr);
        reduce_vector(plan_.unknowns, e, joint, residual.data(), seen_parts_.data() + element_begin_[id]);
      });
    }
  };
  walker_.for_each_chunk(static_cast<std::int64_t>(plan_.directory.size()), element_grain,
                         tree::make_chunk(by_element));
  std::fill(sum.begin(), sum.end(), 0.0);
  for (std::size_t id = 0; id < plan_.directory.size(); ++id) {
    if (held_ && held_->leaves_out(id)) continue;
    const double* from = seen_parts_.data() + element_begin_[id];
    for_each_part(plan_, id, joint_of_element_[id], [&](int block, int size, int) {
      for (int i = 0; i < size && block >= 0; ++i) sum[static_cast<std::size_t>(block_begin(block) + i)] += from[i];
      from += size;
    });
  }
  return std::all_of(sum.begin(), sum.end(), [](double x) { return std::isfinite(x); });
}

void System::find_unsettled(State& state) {
  state.unsettled.clear();
  // Without tangents: the kernel that sensors evaluate, bit by bit. The matrices stay those of the last evaluation.
  if (state.is_planar()) {
    if (!sum_as_seen(state, work_.rhs)) return;
  } else {
    if (evaluate(state, {}, false)) return;
    work_.rhs = residual_;
  }
  for (double& r : work_.rhs) r = -r;
  if (!linear_.is_of_matrices() && linear_.factor(false, {})) return;
  if (linear_.solve(work_.rhs.data(), work_.x.data())) return;
  for (State* s : {&state, &work_.start, &work_.before})
    s->unsettled.reserve(plan_.nodes.size());  // copies take no memory then
  state.unsettled.resize(plan_.nodes.size());
  for (std::size_t n = 0; n < plan_.nodes.size(); ++n)
    state.unsettled[n] = node_part(work_.x.data(), static_cast<int>(n));
  add_multipliers(state, work_.x.data(), 1.0);
}

void System::evaluate_rate(const State& state, std::vector<double>& rate, double step_size) {
  rate.assign(num_unknowns(), 0.0);
  state.visit([&]<class G>(const NodesOn<G>&) { add_rates<G>(state, step_size, rate); });
}

template <class G>
void System::add_rates(const State& state, double step_size, std::vector<double>& rate) {
  using T = lanes::Taylor<double, 1>;
  elements::FieldOn<G, double> f = field_on<G>(state);
  const std::vector<T>& laws = instant_.rate_series();
  const T strength = laws[static_cast<std::size_t>(plan_.gravity_law)];
  motion::Vec3<T> gravity;
  for (int k = 0; k < 3; ++k) gravity[k] = plan_.gravity[k] * strength;
  if constexpr (G::has_moving_frames) {
    if (!plan_.frames.empty()) {
      const plan::FrameMotions& frames = instant_.frame_series(step_size);
      f.carriers = frames.in_ground.data();
      if (f.observer != nullptr) {
        f.observer = &frames.observer;
        motion::Vec3<T> turning = lanes::cast<T>(lanes::angular_part(f.observer->twist));
        gravity = lanes::cast<T>(lanes::transpose_times(f.observer->pose.R, plan_.gravity));
        for (int k = 0; k < 3; ++k) gravity[k].c[1] = -lanes::cross(turning, gravity)[k].c[0];  // (R^T g)' = -w x R^T g
        gravity = strength * gravity;
      }
    }
  }
  elements::SurroundingsOn<G, T> around;
  if constexpr (G::has_moving_frames)
    around.gravity = gravity;
  else
    around.gravity = motion::plane_part(lanes::transpose_times(lanes::cast<T>(plan_.planar->axes), gravity));
  around.laws = laws.data();
  around.has_inertia = plan_.is_dynamic;
  around.nodes_turn = f.around.nodes_turn;
  std::array<double, most_unknowns> part, reduced;
  std::array<double, elements::max_rows> scratch;
  for (std::size_t e = 0; e < plan_.directory.size(); ++e) {
    part.fill(0.0);
    const int j = joint_of_element_[e];
    const plan::JointPlan* const joint = joint_plan_of(e);
    const double* multipliers = joint == nullptr ? nullptr : multipliers_on<G>(*joint, state, scratch.data());
    const double turns = joint == nullptr ? 0.0 : state.turns[static_cast<std::size_t>(j)];
    const double* from = part.data();
    plan::with_element(plan::arrays_on<G>(plan_), plan_.directory[e], [&](const auto& element) {
      elements::evaluate_rate(element, f, around, multipliers, turns, part.data());
      if constexpr (G::has_moving_frames)
        if (are_elements_reduced(plan_)) {
          reduce_vector(plan_.unknowns, element, joint, part.data(), reduced.data());
          from = reduced.data();
        }
    });
    for_each_part(plan_, e, j, [&](int block, int size, int) {
      for (int i = 0; i < size && block >= 0; ++i) rate[static_cast<std::size_t>(block_begin(block) + i)] += from[i];
      from += size;
    });
  }
}

void System::constraint_series(const State& state, const Vec6<double>* jerk, double step_size,
                               std::vector<lanes::Taylor<double, 3>>& out) const {
  elements::Field f = field(state);
  if (step_size > 0.0 && !plan_.frames.empty()) f.carriers = instant_.frame_series(step_size).in_ground.data();
  const Instant::Series& laws = instant_.series(step_size);
  out.resize(static_cast<std::size_t>(plan_.num_multipliers));
  for (std::size_t j = 0; j < plan_.joints.size(); ++j)
    plan::with_element(plan_.elements, plan_.directory[static_cast<std::size_t>(plan_.joints[j].element)],
                       [&](const auto& e) {
                         if constexpr (std::decay_t<decltype(e)>::role == elements::Role::joint)
                           elements::evaluate_constraint_series(e, f, jerk, laws.data(), state.turns[j],
                                                                out.data() + plan_.joints[j].multiplier_begin);
                       });
}

Violations System::constraint_violations(const State& state) const {
  using T = lanes::Taylor<double, 1>;
  const elements::Field f = field(state);
  const std::vector<T>& laws = instant_.rate_series();
  const auto& joints = plan::array_of<elements::Joint>(plan_.elements);
  const auto count = static_cast<std::int64_t>(plan_.joints.size());
  violation_parts_.assign(static_cast<std::size_t>((count + joint_grain - 1) / joint_grain), {});
  auto body = [&](std::int64_t begin, std::int64_t end) {
    Violations& most = violation_parts_[static_cast<std::size_t>(begin / joint_grain)];
    T rows[elements::max_rows];
    for (auto j = static_cast<std::size_t>(begin); j < static_cast<std::size_t>(end); ++j) {
      const elements::Joint& e =
          joints[static_cast<std::size_t>(plan_.directory[static_cast<std::size_t>(plan_.joints[j].element)].index)];
      elements::evaluate_constraint_rates(e, f, laws.data(), state.turns[j], rows);
      for (int row = 0; row < e.num_rows; ++row) {
        const double length = elements::is_length(e.rows[row].kind) ? plan_.joints[j].length : 1.0;
        const double gap = std::abs(rows[row].c[0]), rate = std::abs(rows[row].c[1]);
        const int joint = static_cast<int>(j);
        most = largest(most, {gap, gap / length, rate, rate / length, joint, joint});
      }
    }
  };
  walker_.for_each_chunk(count, joint_grain, tree::make_chunk(body));
  Violations most;
  for (const Violations& part : violation_parts_) most = largest(most, part);
  return most;
}

double System::largest_violation(const State& state, int order, bool is_relative, int* joint) const {
  std::vector<lanes::Taylor<double, 3>>& series = row_series_;
  constraint_series(state, nullptr, 0.0, series);
  double most = 0.0;
  // All rows, those that hold by themselves as well.
  for (std::size_t j = 0; j < plan_.joints.size(); ++j) {
    const auto& e = plan::array_of<elements::Joint>(plan_.elements)[static_cast<std::size_t>(
        plan_.directory[static_cast<std::size_t>(plan_.joints[j].element)].index)];
    for (int row = 0; row < e.num_rows; ++row) {
      const auto multiplier = static_cast<std::size_t>(plan_.joints[j].multiplier_begin + row);
      const double length = is_relative && elements::is_length(e.rows[row].kind) ? plan_.joints[j].length : 1.0;
      const double value = std::abs(series[multiplier].c[order]) / length;
      if (value > most) {
        most = value;
        if (joint != nullptr) *joint = static_cast<int>(j);
      }
    }
  }
  return most;
}

double System::constraint_violation(const State& state, int order, int* joint) const {
  return largest_violation(state, order, false, joint);
}

double System::relative_violation(const State& state, int order, int* joint) const {
  return largest_violation(state, order, true, joint);
}

}  // namespace bough::step
