/// Statics along the path of equilibria.
#include <algorithm>
#include <cmath>

#include "run.hpp"

namespace bough::study {

using results::RunStatus;

namespace {

constexpr int wanted_iterations =
    5;  ///< a step that needs more makes the next shorter, by the square root of the ratio (Ramm 1981)
constexpr double shortest_part = 0.5, longest_part = 1.5;
constexpr double sharp = 1e-5;  ///< of slopes at limit points: the load factor is then known to the square of it
constexpr double aside = 1e-5;  ///< of a step: so far beside a point at which the stiffness is singular
constexpr int most_asides = 4;
constexpr int most_trials = 40;

}  // namespace

/// From the start of the present step to a distance along the path; the tangent there is set.
std::optional<step::Trouble> Run::go_to(double distance) {
  state_ = path_start_;
  if (auto t = path_->set_tangent(state_)) return t;
  const step::StepReport report = path_->advance(state_, distance);
  summary_.steps.newton_iterations += report.iterations;
  if (!report.converged) return step::Trouble{report.cause};
  path_->accept();
  return path_->set_tangent(state_);
}

/// Where a value changes its sign between two distances from the start of the present step; Illinois' regula falsi. At a limit point the
/// stiffness is singular and may have no factor: the path is then met a little beside.
template <class Value>
bool Run::find_on_path(double from, double to, double value_from, double value_to, double tolerance, double& distance,
                       Value&& value) {
  const double width = std::abs(to - from);
  for (int k = 0; k < most_trials; ++k) {
    distance = (from * value_to - to * value_from) / (value_to - value_from);
    auto trouble = go_to(distance);
    for (int i = 0; trouble && i < most_asides; ++i) {
      distance -= aside * width * static_cast<double>(1 << i);
      trouble = go_to(distance);
    }
    if (trouble) return fail("no equilibrium within a step of the path: " + trouble->text);
    const double now = value();
    if (std::abs(now) <= tolerance || std::abs(to - from) <= 1e-12 * width) return true;
    if ((now < 0.0) == (value_to < 0.0)) {
      value_from *= 0.5;
    } else {
      from = to;
      value_from = value_to;
    }
    to = distance;
    value_to = now;
  }
  return true;
}

/// The run ends between two distances of the present step where the load factor passes its last value there.
bool Run::end_within(double from, double to, double from_factor, double to_factor) {
  const scene::ArcLength& arc = *options_.arc_length;
  const double end = arc.end_load_factor;
  const bool passes = arc.end_at_limit_point == 0 &&
                      static_cast<int>(summary_.limit_points.size()) >= arc.after_limit_points &&
                      (from_factor - end) * (to_factor - end) <= 0.0 && from_factor != end;
  if (!passes) return true;
  path_done_ = true;
  double distance = to;
  if (to_factor != end &&
      !find_on_path(from, to, from_factor - end, to_factor - end, 1e-6 * std::max(1.0, std::abs(end)), distance,
                    [&] { return state_.time - end; }))
    return false;
  const step::StepReport report = step::equilibrate(system_, state_, options_, end);
  summary_.steps.newton_iterations += report.iterations;
  return report.converged || fail("no equilibrium at load factor " + std::to_string(end) + ": " + report.cause);
}

/// Finds the load factors at which figures are asked for between two distances of the present step, and looks at the equilibria there. True where
/// the state has moved. One that is not found is left out, and the figure says why.
bool Run::look_within(double from, double to, double from_factor, double to_factor) {
  bool has_moved = false;
  for (const double time : figures_.times()) {
    if ((from_factor - time) * (to_factor - time) >= 0.0) continue;
    if (figures_.is_same(time, from_factor) || figures_.is_same(time, to_factor)) continue;
    const std::string cause_before = summary_.cause;
    double distance = 0.0;
    has_moved = true;
    if (!find_on_path(from, to, from_factor - time, to_factor - time, 1e-6 * std::max(1.0, std::abs(time)), distance,
                      [&] { return state_.time - time; })) {
      figures_.note_missing(time, summary_.cause);
      summary_.cause = cause_before;
      continue;
    }
    const step::StepReport report = step::equilibrate(system_, state_, options_, time);
    summary_.steps.newton_iterations += report.iterations;
    if (!report.converged) {
      figures_.note_missing(time, "no equilibrium at this load factor: " + report.cause);
      continue;
    }
    if (!plan_.joints.empty()) step::accept_turns(system_, state_);
    figures_.add(system_, state_, energy_meter_);
  }
  return has_moved;
}

/// One step, the limit point within it, and the end of the run if that lies in it.
bool Run::take_path_step(double& length) {
  const scene::ArcLength& arc = *options_.arc_length;
  const double largest = arc.largest_step > 0.0 ? arc.largest_step : 4.0 * arc.step;
  path_start_ = state_;
  const double slope_before = path_->slope();
  step::StepReport report;
  int cuts = 0;
  for (;; ++cuts) {
    if (!may_try(state_.time + length * slope_before)) return false;
    report = path_->advance(state_, length);
    count(report, report.converged);
    if (report.converged) break;
    if (cuts == options_.max_cuts)
      return fail("the path cannot be followed from load factor " + std::to_string(state_.time) + ": " + report.cause);
    length *= 0.5;
  }
  path_->accept();
  if (const auto t = path_->set_tangent(state_)) return fail(t->text);
  double from = 0.0, from_factor = path_start_.time;
  const double to_factor = state_.time, slope = path_->slope();
  const step::State end_of_step = state_;
  if (slope_before * slope < 0.0) {
    double at = 0.0;
    const double tolerance = sharp * std::max(std::abs(slope), std::abs(slope_before));
    if (!find_on_path(0.0, length, slope_before, slope, tolerance, at, [&] { return path_->slope(); })) return false;
    const step::State limit = state_;
    const double limit_factor = state_.time;
    (void)look_within(0.0, at, from_factor, limit_factor);
    if (!end_within(0.0, at, from_factor, limit_factor)) return false;
    if (!path_done_) {
      state_ = limit;
      summary_.limit_points.push_back({limit_factor, slope_before > 0.0});
      path_done_ = arc.end_at_limit_point == static_cast<int>(summary_.limit_points.size());
      last_step_ = at;
      if (!plan_.joints.empty()) step::accept_turns(system_, state_);
      record(report.iterations, path_done_);
      if (path_done_) return true;
      from = at;
      from_factor = limit_factor;
    }
  }
  if (!path_done_) {
    const bool has_looked = look_within(from, length, from_factor, to_factor);
    const bool moved_away = has_looked || state_.time != to_factor;
    state_ = end_of_step;
    if (!end_within(from, length, from_factor, to_factor)) return false;
    if (moved_away && !path_done_)
      if (const auto t = path_->set_tangent(state_)) return fail(t->text);
  }
  last_step_ = length;
  if (!plan_.joints.empty()) step::accept_turns(system_, state_);
  record(report.iterations, path_done_);
  length *= std::clamp(std::sqrt(static_cast<double>(wanted_iterations) / report.iterations), shortest_part,
                       cuts > 0 ? 1.0 : longest_part);
  length = std::min(length, largest);
  return report_progress(report, arc.end_load_factor);
}

/// Steps of equal length along the path, shorter where they need many iterations, to where the load factor passes its last value or to a
/// limit point.
bool Run::run_path() {
  const scene::ArcLength& arc = *options_.arc_length;
  const step::StepReport start = step::equilibrate(system_, state_, options_, 0.0);
  if (!start.converged) return fail("no equilibrium without loads: " + start.cause);
  path_.emplace(system_, options_);
  if (const auto t = path_->set_tangent(state_)) return fail(t->text);
  record(0, false);
  double length = arc.step;
  while (!path_done_) {
    if (summary_.steps.accepted >= arc.max_steps)
      return fail("the path did not come to its end in " + std::to_string(arc.max_steps) + " steps, at load factor " +
                  std::to_string(state_.time));
    if (!take_path_step(length)) return false;
  }
  summary_.status = RunStatus::ok;
  return true;
}

}  // namespace bough::study
