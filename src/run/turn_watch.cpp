#include "turn_watch.hpp"

#include <algorithm>
#include <cmath>
#include <type_traits>

namespace bough::run {

namespace {

using motion::Mat3;

/// Calls visit(numbers, count) for the rotation of each node and each moving frame.
template <class Visit>
void for_each_rotation(const step::System& system, const step::State& state, Visit&& visit) {
  state.visit([&](const auto& nodes) {
    using Group = typename std::decay_t<decltype(nodes)>::Group;
    if constexpr (std::is_same_v<Group, motion::Se3>) {
      for (const auto& node : nodes.motion) visit(node.R.m, 9);
    } else if constexpr (Group::turns) {
      for (const auto& node : nodes.motion) visit(node.R.v, 2);
    }
  });
  const std::size_t num_frames = system.plan().frames.size();
  if (num_frames == 0) return;
  const elements::Field field = system.instant().field(state);
  for (std::size_t k = 0; k < num_frames; ++k) visit(field.carriers[k].pose.R.m, 9);
}

}  // namespace

void TurnWatch::begin(const step::System& system, const step::State& state) {
  has_begun_ = true;
  from_.clear();
  least_cosine_ = 1.0;
  for_each_rotation(system, state, [this](const double* R, int count) { from_.insert(from_.end(), R, R + count); });
}

void TurnWatch::look(const step::System& system, const step::State& state) {
  const double* from = from_.data();
  for_each_rotation(system, state, [&](const double* R, int count) {
    double sum = 0.0;  // trace of A^T B, of the angle phi between both: 1 + 2 cos phi in space
    for (int k = 0; k < count; ++k) sum += from[k] * R[k];
    least_cosine_ = std::min(least_cosine_, count == 9 ? 0.5 * (sum - 1.0) : sum);
    from += count;
  });
}

double TurnWatch::turn() const {
  constexpr double round_off = 1e-12;
  return 1.0 - least_cosine_ < round_off ? 0.0 : std::acos(std::clamp(least_cosine_, -1.0, 1.0));
}

}  // namespace bough::run
