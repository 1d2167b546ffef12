#include "bough/step/step_control.hpp"

#include <algorithm>
#include <cmath>

namespace bough::step {

namespace {

constexpr double least_trend = 0.5;  ///< E fluctuates with vibrations: a rise by more than a factor of 2 counts as 2
constexpr double forgetting = 0.85;  ///< per step: a large E in the past must not prevent growth forever
constexpr double tiny = 1e-10;       ///< lower bound on E; the change of h is limited long before

}  // namespace

double StepController::ratio(const LocalError& error) const {
  return std::max({error.relative_motion() / std::pow(tolerance_, 1.5), error.relative_velocity() / tolerance_,
                   error.relative_state() / std::pow(tolerance_, 1.5),
                   error.relative_energy() / std::pow(tolerance_, 1.5)});
}

double StepController::after_accepted(double ratio, double h) {
  const double now = std::max(ratio, tiny), before = previous_ > 0.0 ? previous_ : now;
  previous_ = now;
  most_ = std::max(forgetting * most_, now);
  ++since_change_;
  const auto factor = [](double E, double trend) {
    return std::clamp(std::pow(safety / E, integral) * std::pow(trend, proportional), least_factor, largest_factor);
  };
  double next = factor(now, std::max(least_trend, before / now));
  if (next >= dead_below) {
    next = factor(most_, 1.0);
    const bool may_grow = since_change_ >= (most_ < far_below ? 1 : steps_to_grow);
    if (next <= dead_above || !may_grow) return h;
  }
  most_ = 0.0;
  since_change_ = 0;
  return next * h;
}

double StepController::after_rejected(double ratio, double h) {
  restart();
  return std::clamp(std::cbrt(safety / ratio), least_factor, dead_below) * h;
}

double StepController::after_failure(double h) {
  restart();
  since_change_ = steps_to_grow - steps_held;
  return 0.5 * h;
}

}  // namespace bough::step
