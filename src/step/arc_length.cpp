#include "bough/step/arc_length.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "newton.hpp"
#include "settle.hpp"

namespace bough::step {

using motion::Vec6;

namespace {

constexpr double load_difference =
    1e-4;  ///< difference of load factors for dR/df; exact if loads are proportional to the factor
constexpr double least_alignment =
    0.5;  ///< least cosine between a step and its initial tangent; below, the step may have turned back
constexpr double at_rest = 1e-10;    ///< an unknown moves if it exceeds this part of the largest motion
constexpr double no_digits = 1e-12;  ///< a determinant below this part of its terms may be zero
constexpr double divergence = 1e3;   ///< a larger change of relative motions means divergence

}  // namespace

ArcLengthPath::ArcLengthPath(System& system, const StepOptions& options)
    : system_(system), options_(options), start_(make_initial_state(system.plan())) {
  load_.assign(system.places().size(), 0.0);
  tangent_ = correction_ = x_ = by_spring_ = load_;
  moved_.assign(system.plan().nodes.size(), Vec6<double>::zero());
  direction_ = moved_;
  scale_ = 1.0 / (system.plan().length_scale * system.plan().length_scale);
}

Vec6<double> ArcLengthPath::node_part(const std::vector<double>& x, std::size_t node) const {
  return system_.places().node_part(x.data(), static_cast<int>(node));
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

Vec6<double> ArcLengthPath::way_between(const State& from, const State& to, std::size_t node) const {
  const elements::NodeMotion &a = nodes_in_space(system_.plan(), from)[node],
                             &b = nodes_in_space(system_.plan(), to)[node];
  return motion::Se3::log(
      motion::relative(motion::PreciseFrame<double>{a.R, a.x}, motion::PreciseFrame<double>{b.R, b.x}));
}

void ArcLengthPath::set_moved(const State& state) {
  for (std::size_t n = 0; n < moved_.size(); ++n) moved_[n] = way_between(start_, state, n);
}

double ArcLengthPath::distance(const State& from, const State& to) const {
  double sum = 0.0;
  for (std::size_t n = 0; n < moved_.size(); ++n) {
    const Vec6<double> d = way_between(from, to, n);
    sum += inner(d, d);
  }
  return std::sqrt(sum);
}

/// Estimates the curvature of the path from the tangents at both ends of a very short step.
double ArcLengthPath::choose_first_step(const State& state) {
  constexpr double longest = 0.05, probe = 1e-5, shortest = 1e-6;
  constexpr double most_turn = 0.25;  // change of the direction over the first step [rad]
  constexpr double most_loss = 0.5;   // relative change of the slope df/ds over the first step
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

/// Chooses a spring on one unknown, the one without a pivot, so that K + k e e^T is regular at a limit point. The
/// stiffness k is of the size of the loads over the motions that they cause, so that it costs no digits.
std::optional<ArcLengthPath::Spring> ArcLengthPath::find_spring(const solve::FactorStatus& status) const {
  if (!has_direction_ || status.outcome != solve::FactorOutcome::singular || status.block < 0) return std::nullopt;
  const blocks::BlockGraph& g = system_.plan().graph;
  const auto size_of = [&](int block) { return g.block_size[static_cast<std::size_t>(block)]; };
  Spring spring;
  spring.unknown = static_cast<std::size_t>(system_.places().block_begin(status.block) + status.local);
  double work = 0.0, largest = 0.0;
  for (std::size_t i = 0; i < x_.size(); ++i) {
    work += std::abs(load_[i] * x_[i]);
    largest = std::max(largest, std::abs(x_[i]));
  }
  const double moved = std::abs(x_[spring.unknown]);
  if (!(moved > at_rest * largest) || !(work > 0.0)) return std::nullopt;  // bifurcation: it does not move here
  spring.stiffness = work / (moved * moved);
  for (int e = 0; e < g.num_elements(); ++e) {
    std::int64_t size = 0, row = -1;
    for (std::int64_t k = g.element_begin[static_cast<std::size_t>(e)];
         k < g.element_begin[static_cast<std::size_t>(e) + 1]; ++k) {
      const int block = g.element_blocks[static_cast<std::size_t>(k)];
      if (block == status.block) row = size + status.local;
      size += size_of(block);
    }
    if (row < 0) continue;
    spring.element = e;
    spring.entry = row * size + row;
    return spring;
  }
  return std::nullopt;
}

/// Factors K or, if K is singular, K + k e e^T. In the second case also solves for the right-hand side k e.
std::optional<Trouble> ArcLengthPath::factor(bool rescale) {
  spring_.reset();
  const auto trouble = system_.linear().factor(rescale, {});
  if (!trouble) return std::nullopt;
  spring_ = find_spring(system_.linear().solver().last_status());
  if (!spring_) return trouble;
  double& entry = system_.linear().solver().element(spring_->element)[spring_->entry];
  spring_->entry_without = entry;
  entry += spring_->stiffness;
  if (system_.linear().factor(true, {})) return trouble;
  std::fill(load_.begin(), load_.end(), 0.0);
  load_[spring_->unknown] = spring_->stiffness;
  return system_.linear().solve(load_.data(), by_spring_.data());
}

/// Restores the element matrices as evaluated. The factorization with the spring is kept.
void ArcLengthPath::take_spring_out() {
  if (spring_) system_.linear().solver().element(spring_->element)[spring_->entry] = spring_->entry_without;
}

/// Computes tangent_ = K^-1 (-dR/df). K (with its spring) must be factored and R evaluated at this load factor. On
/// return the laws are set to the load factor.
std::optional<Trouble> ArcLengthPath::solve_load(const State& state, double load_factor) {
  load_ = system_.right_hand_side();
  const double step = load_difference * std::max(1.0, std::abs(load_factor));
  if (auto t = system_.set_time(load_factor + step)) return t;
  if (auto t = system_.evaluate(state, {}, false)) return t;
  for (std::size_t i = 0; i < load_.size(); ++i) load_[i] = (system_.right_hand_side()[i] - load_[i]) / step;
  if (auto t = system_.set_time(load_factor)) return t;
  return system_.linear().solve(load_.data(), tangent_.data());
}

std::optional<Trouble> ArcLengthPath::set_tangent(const State& state) {
  if (auto t = system_.set_time(state.time)) return t;
  if (auto t = system_.evaluate(state, {}, true)) return t;
  if (auto t = factor(true)) return t;
  if (auto t = solve_load(state, state.time)) return t;
  double load = 1.0;  // change of the load factor that belongs to tangent_
  if (spring_) {
    load = 1.0 - by_spring_[spring_->unknown];
    const double moved = tangent_[spring_->unknown];
    for (std::size_t i = 0; i < tangent_.size(); ++i) tangent_[i] = load * tangent_[i] + moved * by_spring_[i];
    take_spring_out();
  }
  double length = 0.0, along = 0.0;
  for (std::size_t n = 0; n < moved_.size(); ++n) {
    const Vec6<double> x = node_part(tangent_, n);
    length += inner(x, x);
    along += inner(x, direction_[n]);
  }
  if (!(length > 0.0) || !std::isfinite(length))
    return Trouble{"the load factor moves nothing: there is no path of equilibria to follow"};
  const double unit = (has_direction_ && along < 0.0 ? -1.0 : 1.0) / std::sqrt(length);
  slope_ = unit * load;
  for (double& x : tangent_) x *= unit;
  has_direction_ = true;
  for (std::size_t n = 0; n < moved_.size(); ++n) direction_[n] = node_part(tangent_, n);
  x_ = tangent_;
  return std::nullopt;
}

/// Sets correction_ = x_R + df x_f, where x_R is correction_ and x_f is tangent_, so that the step has the given
/// length. Returns df, or nothing if the equations are singular. The spring is eliminated: with K' = K + k e e^T
/// and K' x_e = k e
///   x = x_R + df x_f + xi x_e,   xi = x . e,
/// These are two equations for df and xi, regular at a limit point.
std::optional<double> ArcLengthPath::keep_length(double length) {
  double by_load = 0.0, by_spring = 0.0, left = 0.5 * (length * length - square(moved_));
  for (std::size_t n = 0; n < moved_.size(); ++n) {
    const auto along = [&](const std::vector<double>& x) {
      return inner(moved_[n], motion::inverse_tangent_times(moved_[n], node_part(x, n)));
    };
    by_load += along(tangent_);
    left -= along(correction_);
    if (spring_) by_spring += along(by_spring_);
  }
  if (by_load == 0.0 && !spring_) return std::nullopt;
  double df = 0.0, xi = 0.0;
  if (!spring_) {
    df = left / by_load;
  } else {
    const double loose = 1.0 - by_spring_[spring_->unknown], x_f = tangent_[spring_->unknown],
                 x_R = correction_[spring_->unknown];
    const double one = by_load * loose, other = by_spring * x_f, determinant = one + other;
    if (std::abs(determinant) <= no_digits * std::max(std::abs(one), std::abs(other))) return std::nullopt;
    df = (left * loose - by_spring * x_R) / determinant;
    xi = (by_load * x_R + left * x_f) / determinant;
  }
  if (!std::isfinite(df) || !std::isfinite(xi)) return std::nullopt;
  for (std::size_t i = 0; i < correction_.size(); ++i) correction_[i] += df * tangent_[i];
  if (spring_)
    for (std::size_t i = 0; i < correction_.size(); ++i) correction_[i] += xi * by_spring_[i];
  return df;
}

StepReport ArcLengthPath::follow(State& state, double length) {
  StepReport report;
  const auto fail = [&report](const std::string& cause) {
    report.converged = false;
    report.cause = cause;
    return report;
  };
  set_at_rest(state);
  state.time = start_.time + length * slope_;
  state.unsettled.clear();
  system_.corrections().apply_along_tree(state, x_.data(), length);
  double previous = 0.0, change_of_load = std::abs(length * slope_);
  for (int k = 0;; ++k) {
    if (const auto t = system_.set_time(state.time)) return fail(t->text);
    if (const auto t = system_.evaluate(state, {}, true)) return fail(t->text);
    report.residual = residual_of(system_);
    if (k > 0) {
      const bool still = report.change < options_.tolerance &&
                         change_of_load < options_.tolerance * std::max(1.0, std::abs(state.time));
      report.converged = still && is_small(system_, report.residual, options_.tolerance);
      // Iterations beyond the tolerance would make the next steps shorter, so round-off ends the iteration here.
      if (still && !report.converged && may_be_round_off(k, report.change, previous, options_.tolerance))
        report.converged = report.at_floor = is_at_floor(system_, report.residual, options_.tolerance);
      if (report.converged) break;
      if (k >= options_.max_iterations)
        return fail("no convergence in " + std::to_string(k) +
                    " iterations: " + describe(system_, report.residual, options_.tolerance));
    }
    if (const auto t = factor(k == 0)) return fail(t->text);
    load_ = system_.right_hand_side();
    if (const auto t = system_.linear().solve(load_.data(), correction_.data())) return fail(t->text);
    if (const auto t = solve_load(state, state.time)) return fail(t->text);
    set_moved(state);
    const auto df = keep_length(length);
    if (!df) return fail("the step along the path has no direction");
    previous = report.change;
    report.change = system_.corrections().relative_size(state, correction_.data());
    change_of_load = std::abs(*df);
    if (report.iterations < StepReport::remembered_changes)
      report.change_list[static_cast<std::size_t>(report.iterations)] = report.change;
    ++report.iterations;
    if (!std::isfinite(report.change)) return fail("the iteration left finite numbers");
    if (report.change > divergence)
      return fail("the iteration diverges: " + describe(system_, report.residual, options_.tolerance));
    system_.corrections().apply_along_tree(state, correction_.data(), 1.0);
    system_.make_least(state);
    state.time += *df;
  }
  set_moved(state);
  double along = 0.0;
  for (std::size_t n = 0; n < moved_.size(); ++n) along += inner(moved_[n], direction_[n]);
  if (along < least_alignment * length) return fail("the path bends sharply, or the step turned back");
  if (const auto t = check_shape(system_, state)) return fail(t->text);
  if (const auto t = check_closed(system_, state)) return fail(t->text);
  settle(system_, state);
  return report;
}

StepReport ArcLengthPath::advance(State& state, double length) {
  start_ = state;
  StepReport report = follow(state, length);
  if (!report.converged) std::swap(state, start_);
  return report;
}

}  // namespace bough::step
