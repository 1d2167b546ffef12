#include "bough/step/arc_length.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "newton.hpp"

namespace bough::step {

using motion::Vec6;

namespace {

constexpr double load_difference =
    1e-4;  ///< over which loads are differenced: exact where they are proportional to the factor
constexpr double least_alignment =
    0.5;  ///< cosine between a step and the tangent it set out along: less may be the way back
constexpr double divergence = 1e3;  ///< change of relative motions that no step along a path needs

}  // namespace

ArcLengthPath::ArcLengthPath(System& system, const StepOptions& options)
    : system_(system), options_(options), start_(make_initial_state(system.plan())) {
  load_.assign(system.num_unknowns(), 0.0);
  tangent_ = correction_ = x_ = load_;
  moved_.assign(system.plan().nodes.size(), Vec6<double>::zero());
  direction_ = moved_;
  scale_ = 1.0 / (system.plan().length_scale * system.plan().length_scale);
}

Vec6<double> ArcLengthPath::node_part(const std::vector<double>& x, std::size_t node) const {
  return system_.node_part(x.data(), static_cast<int>(node));
}

double ArcLengthPath::inner(const Vec6<double>& a, const Vec6<double>& b) const {
  return (scale_ * lanes::dot(lanes::linear_part(a), lanes::linear_part(b)) +
          lanes::dot(lanes::angular_part(a), lanes::angular_part(b))) /
         static_cast<double>(moved_.size());
}

double ArcLengthPath::square(const Vectors& v) const {
  double sum = 0.0;
  for (const Vec6<double>& x : v) sum += inner(x, x);
  return sum;
}

void ArcLengthPath::set_moved(const State& state) {
  for (std::size_t n = 0; n < moved_.size(); ++n) {
    const elements::NodeMotion &from = start_.nodes[n], &to = state.nodes[n];
    moved_[n] = motion::Se3::log(
        motion::relative(motion::PreciseFrame<double>{from.R, from.x}, motion::PreciseFrame<double>{to.R, to.x}));
  }
}

double ArcLengthPath::distance(const State& from, const State& to) const {
  double sum = 0.0;
  for (std::size_t n = 0; n < from.nodes.size(); ++n) {
    const elements::NodeMotion &a = from.nodes[n], &b = to.nodes[n];
    const Vec6<double> d = motion::Se3::log(
        motion::relative(motion::PreciseFrame<double>{a.R, a.x}, motion::PreciseFrame<double>{b.R, b.x}));
    sum += inner(d, d);
  }
  return std::sqrt(sum);
}

/// By the tangents at both ends of a very short step.
double ArcLengthPath::choose_first_step(const State& state) {
  constexpr double longest = 0.05, probe = 1e-5, shortest = 1e-6;
  constexpr double most_turn = 0.25;  // rad, of the direction
  constexpr double most_loss = 0.5;   // of the slope
  const Vectors direction = direction_;
  const double slope = slope_;
  State near = state;
  double step = longest;
  if (advance(near, probe).converged && !set_tangent(near)) {
    double change = 0.0;
    for (std::size_t n = 0; n < direction.size(); ++n) {
      const Vec6<double> d = direction_[n] - direction[n];
      change += inner(d, d);
    }
    const double turn = std::sqrt(change) / probe, loss = std::abs(slope_ - slope) / (probe * std::abs(slope));
    step = std::clamp(std::min(most_turn / std::max(turn, most_turn), most_loss / std::max(loss, most_loss)), shortest,
                      longest);
  }
  direction_ = direction;
  static_cast<void>(set_tangent(state));
  return step;
}

/// tangent_ = K^-1 (-dR/df), with K factored and R evaluated at this load factor; leaves the loads of the load factor set.
std::optional<Trouble> ArcLengthPath::solve_load(const State& state, double load_factor) {
  for (std::size_t i = 0; i < load_.size(); ++i) load_[i] = system_.residual()[i];
  const double step = load_difference * std::max(1.0, std::abs(load_factor));
  if (auto t = system_.set_time(load_factor + step)) return t;
  if (auto t = system_.evaluate(state, {}, false)) return t;
  for (std::size_t i = 0; i < load_.size(); ++i) load_[i] = (load_[i] - system_.residual()[i]) / step;
  if (auto t = system_.set_time(load_factor)) return t;
  return system_.solve(load_.data(), tangent_.data());
}

std::optional<Trouble> ArcLengthPath::set_tangent(const State& state) {
  if (auto t = system_.set_time(state.time)) return t;
  if (auto t = system_.evaluate(state, {}, true)) return t;
  if (auto t = system_.factor(true, {})) return t;
  if (auto t = solve_load(state, state.time)) return t;
  double length = 0.0, along = 0.0;
  for (std::size_t n = 0; n < moved_.size(); ++n) {
    const Vec6<double> x = node_part(tangent_, n);
    length += inner(x, x);
    along += inner(x, direction_[n]);
  }
  if (!(length > 0.0) || !std::isfinite(length))
    return Trouble{"the load factor moves nothing: there is no path of equilibria to follow"};
  slope_ = (has_direction_ && along < 0.0 ? -1.0 : 1.0) / std::sqrt(length);
  for (double& x : tangent_) x *= slope_;  // a unit of path
  has_direction_ = true;
  for (std::size_t n = 0; n < moved_.size(); ++n) direction_[n] = node_part(tangent_, n);
  x_ = tangent_;
  return std::nullopt;
}

StepReport ArcLengthPath::follow(State& state, double length) {
  StepReport report;
  const auto fail = [&report](const std::string& cause) {
    report.converged = false;
    report.cause = cause;
    return report;
  };
  for (elements::NodeMotion& n : state.nodes) n.dq = n.v = n.a = Vec6<double>::zero();
  state.time = start_.time + length * slope_;
  state.unsettled.clear();
  system_.apply_along_tree(state, x_.data(), length);
  double previous = 0.0, change_of_load = std::abs(length * slope_);
  for (int k = 0;; ++k) {
    if (const auto t = system_.set_time(state.time)) return fail(t->text);
    if (const auto t = system_.evaluate(state, {}, true)) return fail(t->text);
    report.residual = system_.residual_size();
    if (k > 0) {
      const bool still = report.change < options_.tolerance &&
                         change_of_load < options_.tolerance * std::max(1.0, std::abs(state.time));
      report.converged = still && is_small(system_, report.residual, options_.tolerance);
      const bool stalled = k > 1 && report.change > 0.3 * previous;
      if (still && !report.converged && (stalled || report.change == 0.0))
        report.converged = report.at_floor = is_at_floor(system_, report.residual, options_.tolerance);
      if (report.converged) break;
      if (k >= options_.max_iterations)
        return fail("no convergence in " + std::to_string(k) +
                    " iterations: " + describe(system_, report.residual, options_.tolerance));
    }
    if (const auto t = system_.factor(k == 0, {})) return fail(t->text);
    for (std::size_t i = 0; i < correction_.size(); ++i) load_[i] = -system_.residual()[i];
    if (const auto t = system_.solve(load_.data(), correction_.data())) return fail(t->text);
    if (const auto t = solve_load(state, state.time)) return fail(t->text);
    set_moved(state);
    double by_load = 0.0, by_residual = 0.5 * (length * length - square(moved_));
    for (std::size_t n = 0; n < moved_.size(); ++n) {
      by_load += inner(moved_[n], motion::Se3::inverse_tangent_times(moved_[n], node_part(tangent_, n)));
      by_residual -= inner(moved_[n], motion::Se3::inverse_tangent_times(moved_[n], node_part(correction_, n)));
    }
    if (by_load == 0.0 || !std::isfinite(by_residual)) return fail("the step along the path has no direction");
    const double df = by_residual / by_load;
    for (std::size_t i = 0; i < correction_.size(); ++i) correction_[i] += df * tangent_[i];
    previous = report.change;
    report.change = system_.relative_size(state, correction_.data());
    change_of_load = std::abs(df);
    if (report.iterations < StepReport::remembered_changes)
      report.change_list[static_cast<std::size_t>(report.iterations)] = report.change;
    ++report.iterations;
    if (!std::isfinite(report.change)) return fail("the iteration left finite numbers");
    if (report.change > divergence)
      return fail("the iteration diverges: " + describe(system_, report.residual, options_.tolerance));
    system_.apply_along_tree(state, correction_.data(), 1.0);
    state.time += df;
  }
  set_moved(state);
  double along = 0.0;
  for (std::size_t n = 0; n < moved_.size(); ++n) along += inner(moved_[n], direction_[n]);
  if (along < least_alignment * length) return fail("the path bends sharply, or the step turned back");
  if (const auto t = check_shape(system_, state)) return fail(t->text);
  system_.settle(state);
  return report;
}

StepReport ArcLengthPath::advance(State& state, double length) {
  start_ = state;
  StepReport report = follow(state, length);
  if (!report.converged) std::swap(state, start_);
  return report;
}

}  // namespace bough::step
