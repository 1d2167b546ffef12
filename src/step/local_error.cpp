#include <algorithm>
#include <cmath>

#include "bough/step/step_control.hpp"

namespace bough::step {

using motion::Vec6;

namespace {

double largest_of(const Vec6<double>& v, int begin) {
  return std::max({std::abs(v[begin]), std::abs(v[begin + 1]), std::abs(v[begin + 2])});
}

/// to = max(to, factor * lengths of `v`), linear and angular apart.
void include(double& linear, double& angular, const Vec6<double>& v, double factor) {
  linear = std::max(linear, factor * largest_of(v, 0));
  angular = std::max(angular, factor * largest_of(v, 3));
}

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

Vec6<double> LocalError::unfiltered_of(const State& start, const State& after, std::size_t node) const {
  const elements::NodeMotion &from = start.nodes[node], &to = after.nodes[node];
  return (constants_.position / after.step_size) * (to.a - from.a) - (1.0 / 12.0) * motion::cross6_times(to.v, to.a);
}

double LocalError::unfiltered(System& system, const State& after) const {
  const State& start = system.work().start;
  const double h3 = after.step_size * after.step_size * after.step_size;
  double length = 0.0, angle = 0.0;
  for (std::size_t n = 0; n < after.nodes.size(); ++n) include(length, angle, unfiltered_of(start, after, n), h3);
  return std::max(length / (least_.position + allowance_.position), angle / (least_.rotation + allowance_.rotation));
}

std::optional<Trouble> LocalError::measure(System& system, const State& after) {
  const double h = after.step_size, h3 = h * h * h;
  const State& start = system.work().start;
  std::vector<double>&rhs = system.work().rhs, &x = system.work().x;
  // Forces are linear in v': M e = R(v' + e) - R(v'), with an e of the size of v' so that the difference keeps its digits.
  const double c2 = (1.0 - alpha_.alpha_m) / ((1.0 - alpha_.alpha_f) * alpha_.beta * h * h);
  if (auto t = system.evaluate(after, {}, false)) return t;  // the last iteration need not have looked at it
  for (std::size_t i = 0; i < rhs.size(); ++i) rhs[i] = -system.residual()[i];
  shifted_ = after;
  for (std::size_t n = 0; n < shifted_.nodes.size(); ++n) shifted_.nodes[n].a += h * unfiltered_of(start, after, n);
  if (auto t = system.evaluate(shifted_, {}, false)) return t;
  for (std::size_t i = 0; i < rhs.size(); ++i) rhs[i] = c2 * (rhs[i] + system.residual()[i]);
  if (auto t = system.solve(rhs.data(), x.data())) return t;
  parts_ = {};
  step_ = h;
  const double between = 0.5 * (h + previous_step_);
  for (std::size_t n = 0; n < now_.size(); ++n) {
    now_[n] = (1.0 / h) * system.node_part(x.data(), static_cast<int>(n));
    include(parts_.position, parts_.rotation, now_[n], h3);
    if (has_previous_)
      include(parts_.velocity, parts_.angular_velocity, now_[n] - previous_[n],
              h3 * std::abs(constants_.velocity / constants_.position) / between);
  }
  return std::nullopt;
}

void LocalError::accept(const State& after) {
  std::swap(now_, previous_);
  previous_step_ = step_;
  has_previous_ = true;
  for (const elements::NodeMotion& n : after.nodes) include(speed_, spin_, n.v, 1.0);
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
