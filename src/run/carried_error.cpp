#include "carried_error.hpp"

#include <algorithm>
#include <cmath>

#include "bough/schedule/serial.hpp"

namespace bough::run {

namespace {

constexpr double share = 0.02;        ///< of the time of a run that errors may cost
constexpr double always = 0.03;       ///< seconds that they may cost in any case
constexpr double turn_a_step = 0.3;   ///< of the motion, in one step of the error [rad]: 20 steps a period
constexpr double most_turn = 1.0;     ///< above this a step of the error does not resolve the motion [rad]
constexpr double unresolved = 0.7;    ///< vibrations that turn farther in a step of the run are not resolved by it
constexpr long most_stride = 128;
constexpr double fewest = 24.0;       ///< steps of the error in a run: fewer tell nothing

constexpr double tolerance_share = 1e-3;  ///< of accelerations, that Newton's iteration leaves open

struct Costs {
  double step, carried;
};
Costs costs_of(const step::System& system) {
  const step::StepCost c = step::estimate_step_cost(system);
  const double solution = c.residual + c.solve;
  return {3.0 * (solution + c.update) + c.end, c.tangent + c.factor + 5.0 * solution};
}

}  // namespace

bool CarriedError::pays(const step::System& system, double steps) {
  const Costs c = costs_of(system);
  return steps * share * c.step + always >= std::min(steps, fewest) * c.carried;
}

CarriedError::CarriedError(step::System& system, const scene::Solver& solver, const step::StepOptions& options,
                           double duration, const step::State& start)
    : system_(system),
      local_(system, options, duration),
      transport_(system.plan(), solver, schedule::make_serial_walker(), start),
      duration_(duration) {
  const Costs c = costs_of(system);
  left_open_ = tolerance_share * options.tolerance;
  budget_ = always / c.carried;
  cost_ = c.carried / c.step;
}

void CarriedError::restart(double time) {
  transport_.restart(time);
  local_.restart();
  has_first_ = false;
  since_ = 0;
}

std::optional<step::Trouble> CarriedError::pass(const step::State& state, double steps_left, bool& is_carried) {
  is_carried = false;
  ++since_;
  if (since_ + 1 < stride_) return std::nullopt;
  if (!has_first_) local_.restart();
  if (auto t = local_.measure(system_, state)) return t;
  if (since_ >= stride_) {
    if (auto t = carry(state)) return t;
    add(state, local_, static_cast<double>(since_));
    choose_stride(state, local_, steps_left);
    is_carried = true;
    since_ = 0;
  }
  local_.accept(state);
  has_first_ = since_ > 0 || stride_ < 2;
  return std::nullopt;
}

std::optional<step::Trouble> CarriedError::pass(const step::State& state, const step::LocalError& local,
                                                double steps_left, bool& is_carried) {
  is_carried = ++since_ >= stride_;
  if (is_carried) {
    if (auto t = carry(state)) return t;
    since_ = 0;
  }
  add(state, local, 1.0);
  if (is_carried) choose_stride(state, local, steps_left);
  return std::nullopt;
}

std::optional<step::Trouble> CarriedError::carry(const step::State& state) {
  budget_ -= 1.0;
  ++num_steps_;
  if (auto t = transport_.carry(state)) return t;
  largest_ = std::max(largest_, transport_.size());
  if (state.time < 0.5 * duration_) largest_early_ = largest_;
  return std::nullopt;
}

double CarriedError::grows_in() const {
  constexpr double sensitive = 30.0;  // a power of time makes 4 to 8 of the two halves of a run
  if (!(largest_early_ > 0.0) || !(largest_ > sensitive * largest_early_)) return 0.0;
  return 0.5 * duration_ / std::log(largest_ / largest_early_);
}

void CarriedError::add(const step::State& state, const step::LocalError& local, double steps) {
  transport_.add(state, local, steps);
  transport_.disturb(state, steps * state.step_size * left_open_);
}

void CarriedError::choose_stride(const step::State& state, const step::LocalError& local, double steps_left) {
  const double h = state.step_size, spent = h * static_cast<double>(stride_);
  double most = 0.0, turn = 0.0, spin = 0.0;
  const double length = system_.plan().length_scale;
  const std::vector<elements::NodeMotion>& nodes = nodes_in_space(system_.plan(), state);
  const auto size = [length](const motion::Vec6<double>& v) {
    return std::max(length_of(lanes::linear_part(v)) / length, length_of(lanes::angular_part(v)));
  };
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    if (system_.places().node_begin(static_cast<int>(n)) < 0) continue;
    spin = std::max(spin, length_of(lanes::angular_part(nodes[n].v)));
    const step::LocalError::OfNode error = local.of_node(n);
    const double place = size(error.place);
    if (place <= most) continue;
    most = place;
    turn = size(error.change) / place;
  }
  if (turn > unresolved) turn = 0.0;
  turn = std::max(turn, h * spin);
  budget_ += share / cost_ * static_cast<double>(stride_);
  const double payable = std::max(budget_, 1.0) + share / cost_ * steps_left;
  const auto least = static_cast<long>(std::ceil(steps_left / payable));
  const auto wanted = static_cast<long>(std::min(turn > 0.0 ? turn_a_step / turn : 1e6, 1e6));
  all_ += spent;
  if (static_cast<double>(stride_) * turn > most_turn && stride_ > 1) unresolved_ += spent;
  stride_ = std::clamp(std::max(least, wanted), 1L, most_stride);
}

}  // namespace bough::run
