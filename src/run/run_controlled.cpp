/// Steps of chosen sizes, and the local errors of steps of any size.
#include <algorithm>
#include <cmath>

#include "bough/results/observe.hpp"
#include "run.hpp"

namespace bough::run {

namespace {

constexpr long most_between_looks = 32, looks_at_least = 16;  ///< looks of two steps each; in a run
constexpr long controlled_looks = 8;                          ///< accepted steps between two looks at sensors
constexpr double worth_a_look =
    1.5;  ///< an unfiltered error above this many times the largest at a look so far is looked at
constexpr double default_part = 0.02;   ///< of the end time: largest step where none is given
constexpr int most_rejections = 12;     ///< in a row
constexpr double fitting_slack = 1e-9;  ///< a stretch is this much longer than whole steps only by round-off

/// Whole number of steps up to `size` that fill `duration`.
long steps_to_fill(double duration, double size) {
  constexpr double most_steps = 1e18;  // that a long can count; a size that is none makes as many
  const double steps = std::ceil(duration / size - fitting_slack);
  return std::max(1L, static_cast<long>(steps < most_steps ? steps : most_steps));
}

}  // namespace

long looks_every(double steps) {
  return static_cast<long>(std::clamp(steps / looks_at_least, 2.0, static_cast<double>(most_between_looks)));
}

/// Times of expected figures, and those asked for, within a stretch, and its end: steps end there.
std::vector<double> Run::stops_between(double begin, double end) const {
  const double least = 1e-9 * (end - begin);
  std::vector<double> stops;
  for (const std::vector<double>* times : {&figures_.times(), &stops_})
    for (const double t : *times)
      if (t > begin + least && t < end - least) stops.push_back(t);
  std::sort(stops.begin(), stops.end());
  stops.erase(std::unique(stops.begin(), stops.end(), [&](double a, double b) { return b - a <= least; }), stops.end());
  stops.push_back(end);
  return stops;
}

bool Run::run_controlled_segment(double begin, double end, double total_end) {
  const scene::StepControl& control = *options_.step_control;
  const double largest = control.largest_step > 0.0 ? control.largest_step : default_part * total_end;
  if (begin == 0.0) wanted_size_ = scene_.analysis.step_size;
  const std::vector<double> stops = stops_between(begin, end);
  wanted_size_ = std::min(wanted_size_, largest);
  const double first =
      (stops.front() - begin) / static_cast<double>(steps_to_fill(stops.front() - begin, wanted_size_));
  if (!start_segment(first, begin == 0.0)) return false;
  local_error_->restart();
  controller_->restart();
  return std::all_of(stops.begin(), stops.end(), [&](double stop) { return take_controlled_steps(stop, total_end); });
}

/// Steps to `stop`. Times are begin + k h since the last change of size; sizes divide what is left of the way.
bool Run::take_controlled_steps(double stop, double total_end) {
  const scene::StepControl& control = *options_.step_control;
  const double largest = control.largest_step > 0.0 ? control.largest_step : default_part * total_end;
  double begin = state_.time;
  long steps = steps_to_fill(stop - begin, std::min(wanted_size_, largest)), done = 0;
  double size = (stop - begin) / static_cast<double>(steps);
  int rejections = 0;
  const auto change = [&](double wanted) {
    wanted_size_ = std::min(wanted, largest);
    begin = state_.time;
    steps = steps_to_fill(stop - begin, wanted_size_);
    size = (stop - begin) / static_cast<double>(steps);
    done = 0;
  };
  while (done < steps) {
    if (size != state_.step_size) ++summary_.steps.size_changes;
    if (!set_step_size(size)) return false;
    const bool is_last = done + 1 == steps;
    const double target = is_last ? stop : begin + static_cast<double>(done + 1) * size;
    if (!may_try(target)) return false;
    const step::StepReport report = integrator_->advance(state_, options_, target);
    if (report.converged && !measure_controlled()) return false;
    const double ratio = report.converged ? controller_->ratio(*local_error_) : 0.0;
    if (!report.converged || !(ratio <= 1.0)) {
      if (report.converged) {
        state_ = system_.work().start;
        ++summary_.steps.rejected_for_error;
      }
      keep_or_restore(rejections == 0);
      const std::string cause =
          report.converged ? local_error_->describe(system_.plan(), control.tolerance) : report.cause;
      reject(report, cause);
      const double before = size;
      change(report.converged ? controller_->after_rejected(ratio, size) : controller_->after_failure(size));
      if (++rejections > most_rejections)
        return fail("the step at time " + std::to_string(state_.time) + " fails down to a step size of " +
                    std::to_string(before) + ": " + cause);
      continue;
    }
    rejections = 0;
    add_error(size, size);
    last_step_ = size;
    if (wanted_size_ >= largest)
      limit_watch_->count_largest();
    else
      limit_watch_->count(local_error_->limit(control.tolerance));
    if (error_watch_) error_watch_->pass(local_error_->relative_motion());
    if (++steps_since_look_ == controlled_looks) watch_errors(local_error_->relative_motion());
    if (steps_since_look_ == controlled_looks - 1) see_before_look();
    steps_since_look_ %= controlled_looks;
    local_error_->accept(state_);
    if (!accept_controlled(report, target == total_end)) return false;
    ++done;
    const double next = controller_->after_accepted(ratio, size);
    if (done < steps && next != size && std::min(next, largest) != size) {
      const long fitting = steps_to_fill(stop - state_.time, std::min(next, largest));
      if (next < size || fitting < steps - done) change(next);
    } else if (done == steps) {
      wanted_size_ = next < size ? next : std::max(next, wanted_size_);
    }
  }
  return true;
}

/// The local errors of the step just taken.
bool Run::measure_controlled() {
  if (const auto t = local_error_->measure(system_, state_)) return fail(t->text);
  if (energy_error_) {
    local_error_->disturb(state_, displaced_);
    local_error_->set_energy_error(energy_error_->eval(system_, state_, displaced_, energy_meter_));
  }
  return true;
}

/// What every accepted step goes through.
bool Run::accept_controlled(const step::StepReport& report, bool is_last) {
  count(report);
  if (!plan_.joints.empty()) step::accept_turns(system_, state_);
  if (reactions_ && !watch_reactions()) return false;
  if (has_balance()) work_meter_.add(system_, state_, last_step_);
  record(report.iterations, is_last);
  return report_progress(report, scene_.analysis.end_time);
}

/// The last measured error stands for all steps of this duration.
void Run::add_error(double duration, double size) {
  records::Checks& checks = summary_.checks;
  checks.local_error_known = true;
  gate_.look_at("the local error of a step", local_error_->relative_motion(), state_.time);
  gate_.look_at("the local error of velocities", local_error_->relative_velocity(), state_.time);
  checks.local_error_max = std::max(checks.local_error_max, local_error_->relative_motion());
  checks.local_error_max_velocity = std::max(checks.local_error_max_velocity, local_error_->relative_velocity());
  checks.local_error_sum += local_error_->relative_motion() * duration / size;
}

/// Sensors at the start of the step that is looked at.
void Run::see_before_look() {
  if (!error_watch_ || !error_watch_->has_columns()) return;
  results::eval_motion_sensors(system_, state_, values_before_);
}

/// What the local error of the last step, measured just now, is in the sensors. norm: what the watch was told of this
/// step.
void Run::watch_errors(double norm) {
  if (!error_watch_ || !error_watch_->has_columns()) return;
  results::eval_motion_sensors(system_, state_, values_now_);
  local_error_->displace(state_, displaced_);
  results::eval_motion_sensors(system_, displaced_, values_displaced_);
  error_watch_->look(values_before_, values_now_, values_displaced_, norm, last_step_);
}

/// At fixed steps: local errors of two steps in a row (the second tells that of velocities), at least each 32 steps
/// and where they rise: a solution and two evaluations in one of 16 steps.
bool Run::look_at_error() {
  const bool is_second = looking_;
  const double unfiltered = state_.local_error;
  if (error_watch_) error_watch_->pass(unfiltered);
  if (!is_second) {
    if (++steps_since_look_ < looks_every_ && unfiltered <= worth_a_look * unfiltered_looked_) return true;
    unfiltered_looked_ = std::max(unfiltered_looked_, unfiltered);
    local_error_->restart();
  }
  steps_since_look_ = 0;
  looking_ = !is_second;
  if (const auto t = local_error_->measure(system_, state_)) return fail(t->text);
  add_error(state_.time - looked_at_, last_step_);
  if (is_second)
    watch_errors(unfiltered);
  else
    see_before_look();
  local_error_->accept(state_);
  looked_at_ = state_.time;
  return true;
}

}  // namespace bough::run
