#include "carried_error.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "bough/schedule/serial.hpp"

namespace bough::run {

namespace {

constexpr double share = 0.02;       ///< of the time of a run that errors may cost
constexpr double always = 0.005;     ///< seconds, by the model of steps, that they may cost in any case
constexpr double of_start = 24.0;    ///< cost of a system and a solver of its own, in steps of the error
constexpr double turn_a_step = 0.2;  ///< of vibrations, in one step of the error [rad]: 30 steps a period
constexpr double spin_a_step = 0.1;  ///< of nodes, in one step of the error [rad]
constexpr double excess = 2.0;       ///< by how much errors of that turn grow too fast, over (w h)^2 and the turn
constexpr double most_turn = 1.0;    ///< of vibrations: above this a step of the error does not resolve them [rad]
constexpr double most_spin = 0.25;   ///< the same of nodes
constexpr long most_stride = 128;
constexpr double fewest = 24.0;  ///< steps of the error in a run: fewer tell nothing

/// Relative error of periods over the square of the turn in a step, of generalized-alpha with the transport's spectral
/// radius.
constexpr double period_error = 0.088;
constexpr double tolerance_share = 1e-3;  ///< of accelerations, that Newton's iteration leaves open

struct Costs {
  double step, carried;
};
Costs costs_of(const step::System& system) {
  const step::StepCost c = step::estimate_step_cost(system);
  const double solution = c.residual + c.solve;
  return {3.0 * (solution + c.update) + c.end, c.tangent + c.factor + 5.0 * solution};
}

bool has_loops(const plan::Plan& plan) {
  return std::any_of(plan.mobility.parts.begin(), plan.mobility.parts.end(),
                     [](const plan::MobilityPart& part) { return part.closing_rows > 0; });
}

}  // namespace

bool CarriedError::pays(const step::System& system, double steps) {
  const Costs c = costs_of(system);
  return steps * share * c.step + always >= (of_start + std::min(steps, fewest)) * c.carried;
}

CarriedError::CarriedError(step::System& system, const scene::Solver& solver, const step::StepOptions& options,
                           double duration, const step::State& start)
    : system_(system),
      local_(system, options, duration),
      transport_(system.plan(), solver, schedule::make_serial_walker(), start),
      duration_(duration),
      middle_(0.5 * duration) {
  const Costs c = costs_of(system);
  left_open_ = tolerance_share * options.tolerance;
  budget_ = always / c.carried;
  cost_ = c.carried / c.step;
  // Loops of joints come close to positions in which constraints depend on each other. The tangent is not right there,
  // and no growth is certain.
  if (has_loops(system.plan())) too_much_ = std::numeric_limits<double>::infinity();
}

void CarriedError::restart(double time) {
  transport_.restart(time);
  local_.restart();
  last_velocity_.clear();
  has_first_ = false;
  since_ = 0;
}

/// Where constraints come to depend on each other, reactions have a pole, and their values at the ends of steps are
/// those of chance. In the tangent they would push the error about.
bool CarriedError::is_at_peak(const step::State& state) {
  constexpr double peak = 4.0, part = 0.05;
  constexpr long most_waits = 8;  // steps
  double most = 0.0;
  for (const double m : state.multipliers) most = std::max(most, std::abs(m));
  const bool is_peak = reaction_ > 0.0 && most > peak * reaction_;
  reaction_ = reaction_ > 0.0 ? (1.0 - part) * reaction_ + part * most : most;
  return is_peak && since_ < stride_ + most_waits;
}

std::optional<step::Trouble> CarriedError::pass(const step::State& state, bool& is_carried) {
  is_carried = false;
  ++since_;
  const bool waits = is_at_peak(state);
  if (since_ + 1 < stride_) return std::nullopt;
  if (!has_first_) local_.restart();
  if (auto t = local_.measure(system_, state)) return t;
  if (since_ >= stride_ && !waits) {
    if (auto t = carry(state)) return t;
    add(state, local_, static_cast<double>(since_));
    is_carried = true;
    since_ = 0;
  }
  local_.accept(state);
  has_first_ = since_ > 0 || stride_ < 2;
  return std::nullopt;
}

std::optional<step::Trouble> CarriedError::pass(const step::State& state, const step::LocalError& local,
                                                bool& is_carried) {
  is_carried = ++since_ >= stride_ && !is_at_peak(state);
  if (is_carried) {
    if (auto t = carry(state)) return t;
    since_ = 0;
  }
  add(state, local, 1.0);
  return std::nullopt;
}

std::optional<step::Trouble> CarriedError::carry(const step::State& state) {
  budget_ -= 0.5;
  if (auto t = transport_.carry(state)) return t;
  budget_ -= 0.1 * transport_.num_solutions();  // one is about a tenth of such a step
  if (has_leapt(state)) {
    too_much_ = std::numeric_limits<double>::infinity();
    has_leapt_late_ = has_leapt_late_ || state.time > middle_;
  }
  largest_ = std::max(largest_, transport_.size());
  if (state.time <= middle_) largest_early_ = largest_;
  return std::nullopt;
}

/// An impact within a long step of the error changes velocities by other than the mean of the accelerations at its ends.
/// The tangent there is that of before or after it, or of its middle all the time, and what the error then grows by is
/// not the motion's.
bool CarriedError::has_leapt(const step::State& state) {
  constexpr double leap = 0.25;    // of the change; a vibration of 1.7 rad a step is off by that
  constexpr double little = 1e-3;  // of the largest change: what is left of a motion that has died out is round-off
  const std::vector<elements::NodeMotion>& nodes = nodes_in_space(system_.plan(), state);
  const double h = state.time - last_time_, length = system_.plan().length_scale;
  const bool looks = stride_ > 1 && last_velocity_.size() == nodes.size() && h > 0.0;
  last_velocity_.resize(nodes.size());
  last_acceleration_.resize(nodes.size());
  double off = 0.0, all = 0.0;
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    const motion::Mat3<double>& R = nodes[n].R;
    const motion::Vec3<double> u = lanes::linear_part(nodes[n].v), w = lanes::angular_part(nodes[n].v);
    const motion::Vec6<double> v = lanes::join(motion::Vec3<double>(R * u), motion::Vec3<double>(length * (R * w)));
    const motion::Vec3<double> a = lanes::linear_part(nodes[n].a) + lanes::cross(w, u);
    const motion::Vec6<double> rate =
        lanes::join(motion::Vec3<double>(R * a), motion::Vec3<double>(length * (R * lanes::angular_part(nodes[n].a))));
    if (looks) {
      const motion::Vec6<double> change = v - last_velocity_[n], first = (0.5 * h) * last_acceleration_[n],
                                 second = (0.5 * h) * rate, gap = change - first - second;
      off += lanes::dot(gap, gap);
      all += lanes::dot(change, change) + lanes::dot(first, first) + lanes::dot(second, second);
    }
    last_velocity_[n] = v;
    last_acceleration_[n] = rate;
  }
  last_time_ = state.time;
  most_change_ = std::max(most_change_, all);
  return off > leap * leap * all && all > little * little * most_change_;
}

double CarriedError::grows_in() const {
  constexpr double sensitive = 30.0;  // a power of time makes 4 to 8 of the two halves of a run
  // Errors grow by steps that do not see the motion, which tells nothing of it.
  if (has_leapt_late_ || unresolved_ > unresolved_share * all_) return 0.0;
  if (!(largest_early_ > 0.0) || !(largest_ > sensitive * largest_early_)) return 0.0;
  return 0.5 * duration_ / std::log(largest_ / largest_early_);
}

void CarriedError::add(const step::State& state, const step::LocalError& local, double steps) {
  added_ += transport_.add(state, local, steps);
  transport_.disturb(state, steps * state.step_size * left_open_);
}

void CarriedError::choose_stride(const step::State& state, double turn, double steps_left) {
  const double h = state.step_size, spent = h * static_cast<double>(stride_);
  double spin = 0.0;
  const std::vector<elements::NodeMotion>& nodes = nodes_in_space(system_.plan(), state);
  for (std::size_t n = 0; n < nodes.size(); ++n)
    if (system_.places().node_begin(static_cast<int>(n)) >= 0)
      spin = std::max(spin, length_of(lanes::angular_part(nodes[n].v)));
  const double spun = spent * spin;
  too_much_ += excess * spun * spun * spun;
  budget_ += share / cost_ * static_cast<double>(stride_);
  const double payable = std::max(budget_, 1.0) + share / cost_ * steps_left;
  const auto least = static_cast<long>(std::ceil(steps_left / payable));
  const double steps = std::min(turn_a_step / std::max(turn, 1e-9), spin_a_step / std::max(h * spin, 1e-9));
  const auto wanted = static_cast<long>(std::min(steps, 1e6));
  all_ += spent;
  const double turned = static_cast<double>(stride_) * turn;
  detuned_ += period_error * turned * (turned * turned - turn * turn);
  if ((stride_ > 1 && (turned > most_turn || spun > most_spin)) || !transport_.is_solved()) unresolved_ += spent;
  // Even steps as small as those of the run turn too far: what the rule adds to the error there is not certain.
  if (spun > most_spin) too_much_ = std::numeric_limits<double>::infinity();
  const long smooth = std::clamp(wanted, stride_ / 2, stride_ + 1 + stride_ / 4);  // jumps of the size leave their mark
  stride_ = std::clamp(std::max(least, smooth), 1L, most_stride);
}

}  // namespace bough::run
