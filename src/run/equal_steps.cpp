#include <algorithm>
#include <cmath>

#include "time_steps.hpp"

namespace bough::run {

namespace {

constexpr double most_between_looks = 32.0,
                 looks_at_least = 16.0;  ///< steps between measurements; measurements in a run
constexpr double worth_a_look = 1.5;  ///< growth of the unfiltered error over its maximum that triggers a measurement

}  // namespace

EqualSteps::EqualSteps(const Parts& parts) : TimeSteps(parts) {
  const double steps = scene_.analysis.end_time / scene_.analysis.step_size;
  if (recording_.error_watch() != nullptr)
    looks_every_ = static_cast<long>(std::clamp(steps / looks_at_least, 2.0, most_between_looks));
}

bool EqualSteps::begin_stretch() {
  looking_ = false;  // errors are not compared across a start
  looked_at_ = std::max(looked_at_, start_);
  const double wanted = scene_.analysis.step_size;
  steps_ = std::max(1L, static_cast<long>(std::ceil((end_ - begin_) / wanted - 1e-9)));
  size_ = (end_ - begin_) / static_cast<double>(steps_);
  level_ = easy_ = 0;
  done_ = 0;
  return start_integrator(size_);
}

bool EqualSteps::step_within_stretch() {
  for (int failures = 0;; ++failures) {
    const double size = size_ / static_cast<double>(1L << level_);
    if (!set_step_size(size)) return false;
    const bool ends_stretch = done_ + 1 == steps_ << level_;
    const double target = ends_stretch ? end_ : begin_ + static_cast<double>(done_ + 1) * size;
    if (!may_try(target)) return false;
    const step::StepReport report = integrator_->advance(state_, options_, target);
    count(report);
    if (report.converged) return accept(report, size, target == scene_.analysis.end_time);
    if (!cut(report, size)) return false;
    keep_or_restore(failures == 0);
  }
}

/// Halves the size of further steps. Returns false if the limit of cuts is reached.
bool EqualSteps::cut(const step::StepReport& report, double size) {
  constexpr long most_parts = 1L << 62;  // number of parts of a stretch that fits a long
  easy_ = 0;
  if (++level_ > options_.max_cuts || (steps_ << (level_ - 1)) > most_parts / 2)
    return fail("the step at time " + std::to_string(state_.time) + " fails down to a step size of " +
                std::to_string(size) + ": " +
                (summary().instability.empty() ? "" : summary().instability + "; it ended in this: ") + report.cause +
                (vibrations_.seen() ? "; " + std::string(undamped) : ""));
  done_ *= 2;
  return true;
}

/// Checks and records an accepted step, and doubles the step size after four easy steps.
bool EqualSteps::accept(const step::StepReport& report, double size, bool is_last) {
  ++done_;
  last_step_ = size;
  laws_.pass(state_.time - size, state_.time);
  if (options_.single_solution && summary().steps.accepted == 1)
    note("one linear solution per step: residuals are not driven to the tolerance");
  if (!plan_.joints.empty()) step::accept_turns(system_, state_);
  if (!watch_reactions()) return false;
  if (watches_error() && !look_at_error()) return false;
  if (!carry_error(nullptr)) return false;
  recording_.conservation().add_step(state_, size);
  const bool goes_on = !is_variational() || watch_vibrations();
  record(report.iterations, is_last || !goes_on);
  if (!goes_on) return false;
  report_progress(report, scene_.analysis.end_time);
  if (level_ > 0 && done_ % 2 == 0 && ++easy_ >= 4 && report.iterations <= options_.max_iterations / 2) {
    done_ /= 2;
    --level_;
    easy_ = 0;
  }
  return true;
}

bool EqualSteps::watch_vibrations() {
  if (const auto text = vibrations_.look(*integrator_, state_.time)) note(*text);
  if (!vibrations_.seen()) return true;
  recording_.conservation().compare(state_);
  const double round_off = recording_.conservation().energy_round_off(options_, scene_.analysis.end_time);
  const auto cause = vibrations_.judge(recording_.conservation().balance(), round_off, state_.time);
  return !cause || fail(*cause);
}

/// Measures the local errors of two consecutive steps; the second gives the error of velocities. This is done at least
/// every 32 steps and whenever the unfiltered error rises. It costs a solution and two evaluations in one of 16 steps.
bool EqualSteps::look_at_error() {
  const bool is_second = looking_;
  const double unfiltered = state_.local_error;
  if (recording_.error_watch() != nullptr) recording_.error_watch()->pass(unfiltered);
  if (!is_second) {
    if (++since_look_ < looks_every_ && unfiltered <= worth_a_look * unfiltered_looked_) return true;
    unfiltered_looked_ = std::max(unfiltered_looked_, unfiltered);
    local_error_->restart();
  }
  since_look_ = 0;
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
