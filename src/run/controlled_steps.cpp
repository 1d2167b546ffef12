#include <algorithm>
#include <cmath>

#include "time_steps.hpp"

namespace bough::run {

namespace {

constexpr long steps_a_look = 8;        ///< accepted steps between two measurements of the errors of sensors
constexpr double default_part = 0.02;   ///< default of the largest step, relative to the end time
constexpr int most_rejections = 12;     ///< consecutive rejections before the run fails
constexpr double fitting_slack = 1e-9;  ///< relative to a step: an excess over whole steps that is round-off

/// Number of equal steps, each at most `size`, that fill `duration`.
long steps_to_fill(double duration, double size) {
  constexpr double most_steps = 1e18;  // fits a long; also the result if `size` is not a number
  const double steps = std::ceil(duration / size - fitting_slack);
  return std::max(1L, static_cast<long>(steps < most_steps ? steps : most_steps));
}

}  // namespace

ControlledSteps::ControlledSteps(const Parts& parts)
    : TimeSteps(parts),
      largest_(options_.step_control->largest_step > 0.0 ? options_.step_control->largest_step
                                                         : default_part * scene_.analysis.end_time),
      controller_(options_.step_control->tolerance),
      limit_watch_(plan_),
      wanted_size_(scene_.analysis.step_size) {
  if (!EnergyError::is_needed(plan_)) return;
  energy_error_.emplace(plan_, scene_.analysis.end_time, recording_.conservation().mass());
  disturbed_ = state_;  // a step does not allocate
}

bool ControlledSteps::begin_stretch() {
  stops_ = stops_between(begin_, end_);
  next_stop_ = 0;
  wanted_size_ = std::min(wanted_size_, largest_);
  const double way = stops_.front() - begin_;
  if (!start_integrator(way / static_cast<double>(steps_to_fill(way, wanted_size_)))) return false;
  local_error_->restart();
  controller_.restart();
  begin_way();
  return true;
}

/// Divides the remaining time to the next stop into equal steps.
void ControlledSteps::begin_way() {
  from_ = state_.time;
  const double way = stops_[next_stop_] - from_;
  steps_ = steps_to_fill(way, std::min(wanted_size_, largest_));
  size_ = way / static_cast<double>(steps_);
  done_ = 0;
  rejections_ = 0;
}

void ControlledSteps::change_size(double wanted) {
  const int rejections = rejections_;
  wanted_size_ = std::min(wanted, largest_);
  begin_way();
  rejections_ = rejections;
}

bool ControlledSteps::step_within_stretch() {
  for (;;) {
    if (size_ != state_.step_size) ++summary().steps.size_changes;
    if (!set_step_size(size_)) return false;
    const bool is_at_stop = done_ + 1 == steps_;
    const double target = is_at_stop ? stops_[next_stop_] : from_ + static_cast<double>(done_ + 1) * size_;
    if (!may_try(target)) return false;
    const step::StepReport report = integrator_->advance(state_, options_, target);
    if (report.converged && !measure()) return false;
    const double ratio = report.converged ? controller_.ratio(*local_error_) : 0.0;
    if (!report.converged || !(ratio <= 1.0)) {
      if (!reject(report, ratio)) return false;
      continue;
    }
    rejections_ = 0;
    last_step_ = size_;
    laws_.pass(state_.time - size_, state_.time);
    if (!watch_accepted()) return false;
    count(report);
    if (!plan_.joints.empty()) step::accept_turns(system_, state_);
    if (!watch_reactions()) return false;
    recording_.conservation().add_step(state_, last_step_);
    record(report.iterations, target == scene_.analysis.end_time);
    report_progress(report, scene_.analysis.end_time);
    choose_next_size(ratio);
    return true;
  }
}

/// Measures the local errors of the step just taken.
bool ControlledSteps::measure() {
  if (const auto t = local_error_->measure(system_, state_)) return fail(t->text);
  if (energy_error_) {
    local_error_->disturb(state_, disturbed_);
    local_error_->set_energy_error(
        energy_error_->eval(system_, state_, disturbed_, recording_.conservation().energies()));
  }
  return true;
}

/// Rejects an attempt that did not converge or whose local error is too large: restores the state and reduces the step
/// size.
bool ControlledSteps::reject(const step::StepReport& report, double ratio) {
  if (report.converged) {
    state_ = system_.work().start;
    ++summary().steps.rejected_for_error;
  }
  keep_or_restore(rejections_ == 0);
  const std::string cause =
      report.converged ? local_error_->describe(plan_, options_.step_control->tolerance) : report.cause;
  account().reject(report, state_, cause);
  const double before = size_;
  change_size(report.converged ? controller_.after_rejected(ratio, size_) : controller_.after_failure(size_));
  if (++rejections_ <= most_rejections) return true;
  return fail("the step at time " + std::to_string(state_.time) + " fails down to a step size of " +
              std::to_string(before) + ": " + cause);
}

/// Records the local errors of an accepted step, and which error limited its size.
bool ControlledSteps::watch_accepted() {
  add_error(size_, size_);
  if (wanted_size_ >= largest_)
    limit_watch_.count_largest();
  else
    limit_watch_.count(local_error_->limit(options_.step_control->tolerance));
  if (recording_.error_watch() != nullptr) recording_.error_watch()->pass(local_error_->relative_motion());
  if (++since_look_ == steps_a_look) watch_errors(local_error_->relative_motion());
  if (since_look_ == steps_a_look - 1) see_before_look();
  since_look_ %= steps_a_look;
  const bool is_carried = carry_error(&*local_error_);
  local_error_->accept(state_);
  return is_carried;
}

/// Changes the step size if it has to shrink, or if a larger one reduces the number of steps to the next stop.
void ControlledSteps::choose_next_size(double ratio) {
  ++done_;
  const double next = controller_.after_accepted(ratio, size_);
  if (done_ == steps_) {
    wanted_size_ = next < size_ ? next : std::max(next, wanted_size_);
    if (++next_stop_ < stops_.size()) begin_way();
  } else if (next != size_ && std::min(next, largest_) != size_) {
    const long fitting = steps_to_fill(stops_[next_stop_] - state_.time, std::min(next, largest_));
    if (next < size_ || fitting < steps_ - done_) change_size(next);
  }
}

void ControlledSteps::add_notes() {
  if (const auto text = limit_watch_.text(plan_, options_.step_control->tolerance)) note(*text);
}

}  // namespace bough::run
