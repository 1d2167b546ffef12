#include <algorithm>
#include <cmath>

#include "bough/step/step_control.hpp"
#include "planar_step.hpp"

namespace bough::step {

using motion::Vec6;

namespace {

/// The largest magnitudes of each of six entries.
struct Largest {
  Vec6<double> most = Vec6<double>::zero();
  void include(const Vec6<double>& v) {
    for (int i = 0; i < 6; ++i) most[i] = std::max(most[i], std::abs(v[i]));
  }
  double linear() const { return std::max({most[0], most[1], most[2]}); }
  double angular() const { return std::max({most[3], most[4], most[5]}); }
};

}  // namespace

ErrorConstants make_error_constants(const AlphaCoefficients& c) {
  const double d = c.shift();
  const double kappa = 0.5 * (1.0 - c.alpha_f - (1.0 - c.alpha_m) * (1.0 + 2.0 * d) - d * d);
  return {c.beta + 0.5 * d - 1.0 / 6.0, kappa - 0.5 * d * d + 1.0 / 12.0};
}

LocalError::LocalError(const System& system, const StepOptions& options, double duration)
    : alpha_(make_alpha_coefficients(options.spectral_radius)) {
  constants_ = make_error_constants(alpha_);
  const double length = system.plan().length_scale;
  least_ = {length, 1.0, length / duration, 1.0 / duration};
  if (options.step_control) {
    const scene::StepControl& c = *options.step_control;
    allowance_ = {c.position_tolerance / c.tolerance, c.rotation_tolerance / c.tolerance,
                  c.velocity_tolerance / c.tolerance, c.angular_velocity_tolerance / c.tolerance};
  }
  now_.assign(system.plan().nodes.size(), Vec6<double>::zero());
  previous_ = now_;
  shifted_ = make_initial_state(system.plan());
}

Vec6<double> LocalError::unfiltered_of(const State& after, std::size_t node) const {
  const elements::NodeMotion& to = after.nodes[node];
  return (constants_.position / after.step_size) * after.acceleration_trend[node] -
         (1.0 / 12.0) * motion::cross6_times(to.v, to.a);
}

double LocalError::unfiltered(System& system, const State& after) const {
  const double h3 = after.step_size * after.step_size * after.step_size;
  const auto of_size = [&](double linear, double angular) {
    return std::max(h3 * linear / (least_.position + allowance_.position),
                    h3 * angular / (least_.rotation + allowance_.rotation));
  };
  if (PlanarStep* plane = system.planar_step()) {
    const std::array<double, 2> most = plane->largest_error(constants_.position / after.step_size, system.walker());
    return of_size(most[0], most[1]);
  }
  Largest error;
  for (std::size_t n = 0; n < after.nodes.size(); ++n) error.include(unfiltered_of(after, n));
  return of_size(error.linear(), error.angular());
}

std::optional<Trouble> LocalError::measure(System& system, const State& after) {
  const double h = after.step_size, h3 = h * h * h;
  std::vector<double>&rhs = system.work().rhs, &x = system.work().x;
  // Forces are linear in v': M e = R(v' + e) - R(v'), with an e of the size of v' so that the difference keeps its digits.
  const double c2 = (1.0 - alpha_.alpha_m) / ((1.0 - alpha_.alpha_f) * alpha_.beta * h * h);
  if (auto t = system.evaluate(after, {}, false)) return t;  // the last iteration need not have looked at it
  for (std::size_t i = 0; i < rhs.size(); ++i) rhs[i] = -system.residual()[i];
  shifted_ = after;
  for (std::size_t n = 0; n < shifted_.nodes.size(); ++n) shifted_.nodes[n].a += h * unfiltered_of(after, n);
  if (auto t = system.evaluate(shifted_, {}, false)) return t;
  for (std::size_t i = 0; i < rhs.size(); ++i) rhs[i] = c2 * (rhs[i] + system.residual()[i]);
  if (auto t = system.solve(rhs.data(), x.data())) return t;
  Largest error, change;
  for (std::size_t n = 0; n < now_.size(); ++n) {
    now_[n] = (1.0 / h) * system.node_part(x.data(), static_cast<int>(n));
    error.include(now_[n]);
    if (has_previous_) change.include(now_[n] - previous_[n]);
  }
  step_ = h;
  const double of_change = h3 * std::abs(constants_.velocity / constants_.position) / (0.5 * (h + previous_step_));
  parts_ = {h3 * error.linear(), h3 * error.angular(), of_change * change.linear(), of_change * change.angular()};
  return std::nullopt;
}

void LocalError::accept(const State& after) {
  std::swap(now_, previous_);
  previous_step_ = step_;
  has_previous_ = true;
  Largest velocity;
  for (const elements::NodeMotion& n : after.nodes) velocity.include(n.v);
  speed_ = std::max(speed_, velocity.linear());
  spin_ = std::max(spin_, velocity.angular());
}

double LocalError::relative_motion() const {
  return std::max(parts_.position / (least_.position + allowance_.position),
                  parts_.rotation / (least_.rotation + allowance_.rotation));
}

double LocalError::relative_velocity() const {
  return std::max(parts_.velocity / (std::max(least_.velocity, speed_) + allowance_.velocity),
                  parts_.angular_velocity / (std::max(least_.angular_velocity, spin_) + allowance_.angular_velocity));
}

}  // namespace bough::step
