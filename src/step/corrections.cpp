#include "bough/step/corrections.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "element_parts.hpp"
#include "moving_nodes.hpp"

namespace bough::step {

int least_missed(const Misses& misses) {
  return static_cast<int>(std::min_element(misses.begin(), misses.end()) - misses.begin());
}

Corrections::Corrections(const plan::Plan& plan, const UnknownPlaces& places, const Instant& instant,
                         const ElementLengths& lengths, const LinearSolution& linear,
                         std::shared_ptr<const NodeOrder> order, const tree::Walker& walker, CpuClock& clock,
                         WorkCounts& counts)
    : plan_(plan),
      places_(places),
      instant_(instant),
      lengths_(lengths),
      walker_(walker),
      clock_(clock),
      counts_(counts),
      order_(std::move(order)),
      multipliers_(places.multipliers()) {
  if (!plan.is_dynamic) motion_tree_ = make_motion_tree(plan);
  find_pairs(linear);
  std::vector<int> visit_of_unknown(places.size());
  for (int b = 0; b < places.num_blocks(); ++b)
    std::fill_n(visit_of_unknown.begin() + places.block_begin(b), places.block_size(b),
                linear.visits().of_block[static_cast<std::size_t>(b)]);
  const auto visit = [&](const UnknownPlaces::Multiplier& m) { return visit_of_unknown[m.unknown]; };
  std::stable_sort(multipliers_.begin(), multipliers_.end(),
                   [&](const auto& a, const auto& b) { return visit(a) < visit(b); });
  std::vector<int> of_multiplier;
  for (const UnknownPlaces::Multiplier& m : multipliers_) of_multiplier.push_back(visit(m));
  multipliers_by_visit_ = VisitRanges(of_multiplier, linear.visits().count());
  plan.with_group([&]<class G>() { changes_.emplace<ChangesOn<G>>(plan.nodes.size(), NodeChange<G>{}); });
}

Corrections::~Corrections() = default;

/// Element after element in the order of the visits that have their matrices; no eight pairs are those of two visits.
void Corrections::find_pairs(const LinearSolution& linear) {
  int lane = elements::num_lanes;
  std::vector<int> of_pairs;
  const auto add = [&](int visit, int a, int b, double per_length) {
    if (lane == elements::num_lanes || of_pairs.back() != visit) {
      lane = 0;
      pairs_.emplace_back();
      of_pairs.push_back(visit);
    }
    PairLanes& pairs = pairs_.back();
    for (int l = lane++; l < elements::num_lanes; ++l) {
      pairs.a[l] = a;
      pairs.b[l] = b;
      pairs.per_length.set(l, per_length);
    }
  };
  for (int v = 0; v < linear.visits().count(); ++v)
    for (const int element : linear.elements_of_visit(v)) {
      const auto id = static_cast<std::size_t>(element);
      if (id >= plan_.directory.size()) continue;  // the equation of a signal
      plan::with_element(plan_.elements, plan_.directory[id], [&](const auto& e) {
        const double per_length = 1.0 / lengths_.of_element[id];
        const int first = e.ports[0].node == elements::ground ? -1 : e.ports[0].node;
        constexpr int num_ports = std::decay_t<decltype(e)>::num_ports;
        if (num_ports == 1 && first >= 0) add(v, -1, first, per_length);
        for (int p = 1; p < num_ports; ++p)
          if (e.ports[p].node != elements::ground) add(v, first, e.ports[p].node, per_length);
      });
    }
  pairs_by_visit_ = VisitRanges(of_pairs, linear.visits().count());
  pair_sizes_.assign(pairs_.size(), 0.0);
}

template <class G>
void Corrections::measure_pairs(std::int64_t begin, std::int64_t end) {
  const std::span<const PairLanes> some(pairs_.data() + begin, static_cast<std::size_t>(end - begin));
  std::fill(pair_sizes_.begin() + begin + 1, pair_sizes_.begin() + end, 0.0);
  pair_sizes_[static_cast<std::size_t>(begin)] = largest_change(some, std::get<ChangesOn<G>>(changes_).data());
}
#define BOUGH_INSTANTIATE(G) template void Corrections::measure_pairs<G>(std::int64_t, std::int64_t);
BOUGH_FOR_EVERY_GROUP(BOUGH_INSTANTIATE)
#undef BOUGH_INSTANTIATE

void Corrections::note_held(const State& state) {
  const std::span<const NodeEight> held = order_->held_eights();
  if (held.empty()) return;
  state.visit([&]<class G>(const NodesOn<G>& nodes) {
    note_changes(nodes, held, places_.increments(nullptr), std::get<ChangesOn<G>>(changes_).data());
  });
}

double Corrections::applied_size() const {
  double most = 0.0;
  for (double size : pair_sizes_) most = std::max(most, size);
  return std::sqrt(most);
}

double Corrections::relative_size(const State& state, const double* x) {
  state.visit([&]<class G>(const NodesOn<G>& nodes) {
    NodeChange<G>* const changes = std::get<ChangesOn<G>>(changes_).data();
    const std::span<const NodeEight> eights = order_->eights();
    auto note = [&](std::int64_t begin, std::int64_t end) {
      note_changes(nodes, eights.subspan(static_cast<std::size_t>(begin), static_cast<std::size_t>(end - begin)),
                   places_.increments(x), changes);
    };
    walker_.for_each_chunk(static_cast<std::int64_t>(eights.size()), eight_grain, tree::make_chunk(note));
    auto measure = [this](std::int64_t begin, std::int64_t end) { measure_pairs<G>(begin, end); };
    walker_.for_each_chunk(static_cast<std::int64_t>(pairs_.size()), pair_grain, tree::make_chunk(measure));
  });
  return applied_size();
}

double Corrections::apply(State& state, const double* x) {
  PhaseTimer timer{clock_, counts_.update};
  const double change = relative_size(state, x);
  state.change_all([&]<class G>(NodesOn<G>& nodes) {
    const std::span<const NodeEight> eights = order_->eights();
    auto move = [&](std::int64_t begin, std::int64_t end) {
      move_nodes<G>(nodes, eights.subspan(static_cast<std::size_t>(begin), static_cast<std::size_t>(end - begin)),
                    places_.increments(x), nullptr);
    };
    walker_.for_each_chunk(static_cast<std::int64_t>(eights.size()), eight_grain, tree::make_chunk(move));
  });
  add_multipliers(state, x, 1.0);
  return change;
}

void Corrections::add_multipliers(State& state, const double* x, double factor, std::int64_t begin,
                                  std::int64_t end) const {
  for (auto m = static_cast<std::size_t>(begin); m < static_cast<std::size_t>(end); ++m)
    state.multipliers[multipliers_[m].multiplier] += factor * x[multipliers_[m].unknown];
}

void Corrections::add_multipliers(State& state, const double* x, double factor) const {
  add_multipliers(state, x, factor, 0, multipliers_by_visit_.count());
  add_signals(state, x, factor);
}

void Corrections::add_signals(State& state, const double* x, double factor) const {
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

}  // namespace bough::step
