/// Statics by arc length along a path of equilibria.
#include "load_path.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace bough::run {

namespace {

constexpr int wanted_iterations =
    5;  ///< the next length is scaled by the square root of this over the iterations (Ramm 1981)
constexpr double shortest_part = 0.5, longest_part = 1.5;
constexpr double close = 1e-4;       ///< accepted error of the load factor of a limit point that is not located
constexpr double usual_step = 0.05;  ///< usual length of a step where the path bends little [-]
constexpr double sharp = 1e-5;       ///< relative tolerance of slopes at limit points; load factors have its square
constexpr double known = 1e-7;       ///< tolerance of load factors where the stiffness has no factorization

}  // namespace

/// Whether the load factor passes its final value between two equilibria, given the number of limit points so far.
bool LoadPath::passes_end(double from, double to, std::size_t limit_points) const {
  const scene::ArcLength& arc = *options_.arc_length;
  const double end = arc.end_load_factor;
  return arc.end_at_limit_point == 0 && static_cast<int>(limit_points) >= arc.after_limit_points &&
         (from - end) * (to - end) <= 0.0 && from != end;
}

/// Finds the equilibrium at the final load factor, which is passed between two places of the step.
PathPoint LoadPath::find_end(PathPlace from, PathPlace to, const step::State& beyond) {
  const double end = options_.arc_length->end_load_factor;
  from.value = from.load_factor - end;
  to.value = to.load_factor - end;
  PathPoint point;
  point.is_located = to.value == 0.0;
  point.distance = to.distance;
  point.state = beyond;
  if (!point.is_located) {
    PathSearch search = make_search();
    point = search.find(from, to, 1e-6 * std::max(1.0, std::abs(end)),
                        [end](const step::State& s) { return s.time - end; });
  }
  step::State state = point.is_located || point.is_near ? point.state : beyond;
  const step::StepReport report = step::equilibrate(system_, state, options_, end);
  account().newton_iterations() += report.iterations;
  if (!report.converged && point.cause.empty()) point.cause = report.cause;
  point.is_located = report.converged;
  point.state = report.converged ? state : beyond;
  return point;
}

/// Finds the limit point between two places of a step, whose `value` is the slope of the path. noise: uncertainty of
/// load factors.
void LoadPath::locate_limit(PathPlace from, PathPlace to, double noise, Step& step) {
  const double length = to.distance, slope_before = from.value;
  PathSearch search = make_search();
  const double tolerance = sharp * std::max(std::abs(to.value), std::abs(slope_before));
  step.limit = search.find(from, to, tolerance, [&](const step::State&) { return path_->slope(); });
  PathPoint& limit = *step.limit;
  if (!limit.is_near) {
    const bool is_end = std::abs(to.value) <= std::abs(slope_before);
    limit.distance = is_end ? length : 0.0;
    limit.state = is_end ? step.end : start_;
    limit.value = is_end ? to.value : slope_before;
    limit.width = length;
  }
  const double size = std::max(1.0, std::abs(limit.state.time));
  limit.is_passed = limit.is_near && std::abs(limit.extreme.time - limit.state.time) > noise;
  if (limit.is_passed) {
    limit.state = limit.extreme;
    limit.cause = "the slope of the path is lost in round-off there; this is the load factor of the equilibrium " +
                  std::string("that comes nearest to it");
  }
  // The load changes by at most |slope| times width between the nearest equilibrium and the limit point.
  limit.is_located = !limit.is_passed && (limit.is_located || std::abs(limit.value) * limit.width <= known * size);
  // Otherwise the load factor is estimated by the parabola through the first place with the slopes at both.
  const double parabola = from.load_factor + 0.5 * length * slope_before * slope_before / (slope_before - to.value);
  limit.load_factor = limit.is_located || limit.is_passed ? limit.state.time : parabola;
}

/// Computes the tangent at the end of the step just taken, and finds the limit point and the end of the run in it, if
/// there are any. Returns the reason to reject the step and repeat it with a shorter length, or an empty text. The last
/// try accepts the nearest known equilibria in place of points that are not found.
std::string LoadPath::look_at_step(double length, bool is_last_try, Step& step) {
  const scene::ArcLength& arc = *options_.arc_length;
  const double slope_before = path_->slope();
  step = {};
  path_->accept();
  if (const auto t = path_->set_tangent(state_)) return t->text;
  step.end = state_;
  PathPlace from{0.0, slope_before, start_.time};
  const PathPlace to{length, path_->slope(), state_.time};
  const double change = to.load_factor - from.load_factor;
  const double noise = 10.0 * options_.tolerance * std::max(1.0, std::abs(to.load_factor));  // left by iterations
  if (slope_before * to.value > 0.0 && slope_before * change < 0.0 && std::abs(change) > noise)
    return "the load changed against the slope of the path at both ends of the step: it came to another branch";
  std::size_t passed = summary().limit_points.size();
  if (slope_before * to.value < 0.0) {
    locate_limit(from, to, noise, step);
    const PathPoint& limit = *step.limit;
    const double size = std::max(1.0, std::abs(limit.state.time));
    const bool is_close = limit.is_passed || std::abs(limit.load_factor - limit.state.time) <= close * size;
    if (!limit.is_located && !is_close && !is_last_try) return "the limit point in it was not met: " + limit.cause;
    const PathPlace turn{limit.distance, 0.0, limit.state.time};
    if (passes_end(from.load_factor, turn.load_factor, passed)) step.stop = find_end(from, turn, limit.state);
    from = turn;
    ++passed;
  }
  const bool is_done = step.stop || (arc.end_at_limit_point > 0 && arc.end_at_limit_point == static_cast<int>(passed));
  if (!is_done && passes_end(from.load_factor, to.load_factor, passed)) {
    step.stop = find_end(from, to, step.end);
    step.stops_after_limit = step.limit.has_value();
  }
  if (step.stop && !step.stop->is_located && !is_last_try)
    return "the equilibrium at the last load factor was not met: " + step.stop->cause;
  state_ = step.last();
  if (step.limit || step.stop)
    if (const auto t = path_->set_tangent(state_)) return step.stop ? "" : t->text;
  return look_at_stability(step.stop && step.stop->is_located ? step.stop->distance : length, is_last_try, step);
}

/// Finds the equilibria at requested load factors between two places of the present step, and evaluates the figures
/// there. A figure whose equilibrium is not found gets the cause instead of a value. Returns whether the state was
/// changed.
bool LoadPath::look_within(PathPlace from, PathPlace to) {
  bool has_moved = false;
  PathSearch search = make_search();
  for (const double time : recording_.figures().times()) {
    from.value = from.load_factor - time;
    to.value = to.load_factor - time;
    if (from.value * to.value >= 0.0) continue;
    if (recording_.figures().is_same(time, from.load_factor) || recording_.figures().is_same(time, to.load_factor))
      continue;
    has_moved = true;
    const PathPoint point = search.find(from, to, 1e-6 * std::max(1.0, std::abs(time)),
                                        [time](const step::State& s) { return s.time - time; });
    if (!point.is_near) {
      recording_.figures().note_missing(time, "no equilibrium within a step of the path: " + point.cause);
      continue;
    }
    state_ = point.state;
    const step::StepReport report = step::equilibrate(system_, state_, options_, time);
    account().newton_iterations() += report.iterations;
    if (!report.converged) {
      recording_.figures().note_missing(time, "no equilibrium at this load factor: " + report.cause);
      continue;
    }
    if (!plan_.joints.empty()) step::accept_turns(system_, state_);
    recording_.add_figures(state_);
  }
  return has_moved;
}

/// Lists the limit point of a step in the summary and records a row there.
void LoadPath::accept_limit_point(const PathPoint& limit, bool is_maximum, int iterations) {
  const double end_of_step = last_step_;
  state_ = limit.state;
  summary().limit_points.push_back({limit.load_factor, is_maximum, limit.is_located});
  is_done_ = options_.arc_length->end_at_limit_point == static_cast<int>(summary().limit_points.size());
  if (!limit.is_located)
    note("a limit point of the load was passed but not met, its load factor " + std::to_string(limit.load_factor) +
         (limit.is_passed ? ": " : " is that of a parabola through equilibria on both sides of it: ") + limit.cause);
  last_step_ = limit.distance;
  if (!plan_.joints.empty()) step::accept_turns(system_, state_);
  if (limit.is_near || is_done_) record(iterations, is_done_);
  last_step_ = end_of_step;
}

/// Takes an accepted step of the present length or, after cuts, a shorter one. Counts the cuts. Returns false if the
/// run ends.
bool LoadPath::try_step(Step& step, step::StepReport& report, int& cuts) {
  for (;; ++cuts) {
    if (!may_try(state_.time + length_ * path_->slope())) return false;
    report = path_->advance(state_, length_);
    const bool had_converged = report.converged;
    if (had_converged) report.cause = look_at_step(length_, cuts == options_.max_cuts, step);
    report.converged = report.cause.empty();
    if (report.converged) return true;
    state_ = start_;
    count(report);
    if (cuts == options_.max_cuts)
      return fail("the path cannot be followed from load factor " + std::to_string(state_.time) + ": " + report.cause);
    length_ *= 0.5;
    if (!had_converged) continue;
    path_->set_direction(direction_);
    if (const auto t = path_->set_tangent(state_)) return fail(t->text);
  }
}

bool LoadPath::begin() {
  const scene::ArcLength& arc = *options_.arc_length;
  const step::StepReport start = step::equilibrate(system_, state_, options_, 0.0);
  if (!start.converged) return fail("no equilibrium without loads: " + start.cause);
  path_.emplace(system_, options_);
  if (const auto t = path_->set_tangent(state_)) return fail(t->text);
  stability_.look(state_);
  record(0, false);
  length_ = arc.step > 0.0 ? arc.step : path_->choose_first_step(state_);
  return true;
}

void LoadPath::come_back() {
  Analysis::come_back();
  if (const auto t = path_->set_tangent(state_)) throw std::logic_error(t->text);  // it existed when saved
}

/// Takes one step and records the limit point within it and its end, or the end of the run if that lies in it.
bool LoadPath::take_step() {
  const scene::ArcLength& arc = *options_.arc_length;
  if (summary().steps.accepted >= arc.max_steps)
    return fail("the path did not come to its end in " + std::to_string(arc.max_steps) + " steps, at load factor " +
                std::to_string(state_.time));
  const double largest = arc.largest_step > 0.0 ? arc.largest_step : 4.0 * (arc.step > 0.0 ? arc.step : usual_step);
  start_ = state_;
  direction_ = path_->direction();
  start_look_ = stability_.last();
  const double slope_before = path_->slope();
  step::StepReport report;
  Step step;
  int cuts = 0;
  if (!try_step(step, report, cuts)) return false;
  count(report);
  PathPlace from{0.0, 0.0, start_.time};
  bool has_moved = false;
  if (step.limit && (!step.stop || step.stops_after_limit)) {
    const PathPlace turn{step.limit->distance, 0.0, step.limit->state.time};
    has_moved = look_within(from, turn);
    accept_limit_point(*step.limit, slope_before > 0.0, report.iterations);
    from = turn;
  }
  if (is_done_) return true;
  for (records::Bifurcation& b : step.bifurcations) accept_bifurcation(std::move(b));
  const double distance = step.stop && step.stop->is_located ? step.stop->distance : length_;
  has_moved = look_within(from, {distance, 0.0, step.last().time}) || has_moved;
  state_ = step.last();
  if (has_moved)
    if (const auto t = path_->set_tangent(state_); t && !step.stop) return fail(t->text);
  last_step_ = length_;
  if (step.stop) {
    is_done_ = true;
    if (!step.stop->is_located)
      note("the load factor passes " + std::to_string(arc.end_load_factor) + " between two equilibria, but none was " +
           "found there: the run ends at " + std::to_string(state_.time) + ". " + step.stop->cause);
  }
  if (!plan_.joints.empty()) step::accept_turns(system_, state_);
  stability_.look(state_, has_moved ? std::nullopt : step.look);
  record(report.iterations, is_done_);
  length_ *= std::clamp(std::sqrt(static_cast<double>(wanted_iterations) / report.iterations), shortest_part,
                        cuts > 0 ? 1.0 : longest_part);
  length_ = std::min(length_, largest);
  report_progress(report, arc.end_load_factor);
  return true;
}

}  // namespace bough::run
