#include "bough/step/corrections.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include "element_parts.hpp"
#include "moving_nodes.hpp"

namespace bough::step {

int least_missed(const Misses& misses) {
  return static_cast<int>(std::min_element(misses.begin(), misses.end()) - misses.begin());
}

Corrections::Corrections(const plan::Plan& plan, const UnknownPlaces& places, const Instant& instant,
                         const ElementLengths& lengths, const tree::Walker& walker, CpuClock& clock, WorkCounts& counts)
    : plan_(plan),
      places_(places),
      instant_(instant),
      lengths_(lengths),
      walker_(walker),
      clock_(clock),
      counts_(counts) {
  if (!plan.is_dynamic) motion_tree_ = make_motion_tree(plan);
  find_pairs();
}

Corrections::~Corrections() = default;

void Corrections::find_pairs() {
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
      const double per_length = 1.0 / lengths_.of_element[id];
      const int first = e.ports[0].node == elements::ground ? -1 : e.ports[0].node;
      constexpr int num_ports = std::decay_t<decltype(e)>::num_ports;
      if (num_ports == 1 && first >= 0) add(-1, first, per_length);
      for (int p = 1; p < num_ports; ++p)
        if (e.ports[p].node != elements::ground) add(first, e.ports[p].node, per_length);
    });
  chunk_max_.resize((pairs_.size() + pair_grain - 1) / pair_grain);
}

double Corrections::relative_size(const State& state, const double* x) const {
  state.visit([&](const auto& nodes) {
    auto by_pair = [&](std::int64_t begin, std::int64_t end) {
      const std::span<const PairLanes> some(pairs_.data() + begin, static_cast<std::size_t>(end - begin));
      chunk_max_[static_cast<std::size_t>(begin / pair_grain)] = largest_change(nodes, some, places_.increments(x));
    };
    walker_.for_each_chunk(static_cast<std::int64_t>(pairs_.size()), pair_grain, tree::make_chunk(by_pair));
  });
  double most = 0.0;
  for (double size : chunk_max_) most = std::max(most, size);
  return std::sqrt(most);
}

void Corrections::add_multipliers(State& state, const double* x, double factor) const {
  for (const UnknownPlaces::Multiplier& at : places_.multipliers())
    state.multipliers[at.multiplier] += factor * x[at.unknown];
  for (std::size_t i = 0; i < places_.signals().size(); ++i) state.signals.value[i] += factor * x[places_.signals()[i]];
}

void Corrections::predict_multipliers(const State& start, State& state) const {
  state.multipliers = start.multipliers;
  if (start.multiplier_order == 0) return;
  const double of_change = start.multiplier_order == 2 ? 1.0 : 0.0;
  for (const UnknownPlaces::Multiplier& at : places_.multipliers())
    state.multipliers[at.multiplier] +=
        start.multiplier_trend[at.multiplier] + of_change * start.multiplier_trend_change[at.multiplier];
}

void Corrections::note_multipliers(const State& start, State& state) const {
  Misses misses{};
  state.multiplier_trend.resize(state.multipliers.size());
  state.multiplier_trend_change.resize(state.multipliers.size());
  for (const UnknownPlaces::Multiplier& at : places_.multipliers()) {
    const std::size_t m = at.multiplier;
    const double now = state.multipliers[m] - start.multipliers[m], of_trend = now - start.multiplier_trend[m];
    const double weight = at.is_of_length ? 1.0 : 1.0 / lengths_.moment_arm;  // moments count as forces at the arm
    const double missed[] = {now, of_trend, of_trend - start.multiplier_trend_change[m]};
    for (std::size_t k = 0; k < misses.size(); ++k) misses[k] += (weight * missed[k]) * (weight * missed[k]);
    state.multiplier_trend[m] = now;
    state.multiplier_trend_change[m] = of_trend;
  }
  state.multiplier_order = least_missed(misses);
}

void Corrections::move(State& state, const double* x) const {
  state.change_all([&](auto& nodes) {
    auto by_node = [&](std::int64_t begin, std::int64_t end) {
      move_nodes(nodes, static_cast<std::size_t>(begin), static_cast<std::size_t>(end), places_.increments(x));
    };
    walker_.for_each_chunk(static_cast<std::int64_t>(nodes.motion.size()), block_grain, tree::make_chunk(by_node));
  });
  if (plan_.num_multipliers > 0 || !plan_.signals.empty()) add_multipliers(state, x, 1.0);
}

double Corrections::apply(State& state, const double* x) {
  PhaseTimer timer{clock_, counts_.update};
  const double change = relative_size(state, x);
  move(state, x);
  return change;
}

}  // namespace bough::step
