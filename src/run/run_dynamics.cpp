#include <algorithm>
#include <cmath>
#include <cstdio>

#include "bough/io/number_text.hpp"
#include "bough/results/observe.hpp"
#include "bough/step/growing_vibration.hpp"
#include "break_walk.hpp"
#include "effective_options.hpp"
#include "given_velocities.hpp"
#include "run.hpp"
#include "trust.hpp"

namespace bough::run {

using records::RunStatus;

bool Run::start_segment(double step_size, bool is_first) {
  if (reactions_) reactions_->restart();
  results::Energies before;
  if (!is_first && has_balance()) before = energy_meter_.eval(system_, state_);
  const step::StartReport consistent = step::make_consistent(system_, state_, is_first, step_size);
  if (!consistent.ok) return fail(consistent.cause);
  watch_dependent_rows();
  if (is_first && consistent.position_correction > 1e-9) note_moved_start(consistent);
  if (is_first) {
    summary_.changed_velocities = changed_velocities(plan_, state_);
    if (!summary_.changed_velocities.empty()) note(describe(summary_.changed_velocities));
  }
  if (consistent.velocity_change > 1e-9) {
    char text[160];
    std::snprintf(
        text, sizeof text,
        "velocities were made consistent with joints and drives at time %.6g by impulses of up to %.3g N s (N m s)",
        state_.time, consistent.velocity_impulse);
    note(text);
  }
  if (has_balance()) {
    const results::Energies now = energy_meter_.eval(system_, state_);
    work_meter_.begin(system_, state_);
    if (is_first)
      balance_.begin(now);
    else
      balance_.jump(before, now);
  }
  if (is_first)
    record(0, false);
  else
    figures_.add(system_, state_, energy_meter_);
  if (is_first && options_.integrator == scene::Integrator::bdf) choose_bdf_order(step_size);
  const step::StartReport started = integrator_->start(state_, options_, step_size);
  if (!started.ok) return fail(started.cause);
  return true;
}

/// Order 3 makes some undamped vibrations grow: where the scene has one and does not ask for this order, order 2 is
/// taken.
void Run::choose_bdf_order(double step_size) {
  if (options_.bdf_order == 2) return;
  const auto vibration = step::find_growing_vibration(system_, state_, step_size);
  if (vibration) {
    const std::string cause = "'" + plan_.nodes[static_cast<std::size_t>(vibration->node)].name +
                              "' takes part in an undamped vibration of " + io::rounded_text(vibration->frequency, 3) +
                              " rad/s, " + io::rounded_text(vibration->steps_a_period, 2) +
                              " steps a period, which backward differences of order 3 make grow";
    if (options_.bdf_order == 3) {
      summary_.instability = cause + ": take \"bdf_order\": 2 or generalized_alpha";
      note(summary_.instability);
    } else {
      note("backward differences of order 2 are taken: " + cause);
    }
  }
  options_.bdf_order = vibration && summary_.instability.empty() ? 2 : 3;
  if (options_.bdf_order == 2) integrator_ = step::make_integrator(system_, scene_.solver, options_);
  summary_.options = effective_options(scene_, options_);
}

void Run::note_moved_start(const step::StartReport& consistent) {
  char text[160];
  std::snprintf(text, sizeof text, "the start was moved by up to %.3g (relative) to close the joints",
                consistent.position_correction);
  std::string where;
  if (consistent.open_joint >= 0) {
    char gap[80];
    std::snprintf(gap, sizeof gap, "' was open by %.3g of the size of the parts that meet in it (or rad)",
                  consistent.gap);
    where = ": '" + plan_.joints[static_cast<std::size_t>(consistent.open_joint)].name + gap;
  }
  note(text + where);
}

bool Run::watch_reactions() {
  if (!reactions_->wants_look(state_, summary_.checks.local_error_sum)) return true;
  const auto t = reactions_->look(system_, state_);
  return t ? fail(t->text) : true;
}

bool Run::set_step_size(double size) {
  const step::StartReport changed = integrator_->change_step_size(state_, options_, size);
  return changed.ok ? true : fail(changed.cause);
}

/// A step that failed is tried again from where its first try set out: each change of size corrects velocities, and
/// where steps resolve nothing, corrections of corrections grow without bound.
void Run::keep_or_restore(bool is_first_failure) {
  if (is_first_failure)
    tried_ = state_;
  else
    state_ = tried_;
}

/// Steps of equal size from one breakpoint to the next; a step that fails is halved, and the size grows back after
/// four easy steps.
bool Run::run_segment(double begin, double end, double& total_end) {
  const double wanted = scene_.analysis.step_size;
  const long steps = std::max(1L, static_cast<long>(std::ceil((end - begin) / wanted - 1e-9)));
  const double h = (end - begin) / static_cast<double>(steps);
  int level = 0, easy = 0, failures = 0;  // these in a row
  long done = 0;                          // in units of h / 2^level
  if (!start_segment(h, begin == 0.0)) return false;
  while (done < (steps << level)) {
    const double size = h / static_cast<double>(1L << level);
    if (!set_step_size(size)) return false;
    const long next = done + 1;
    const double target = next == (steps << level) ? end : begin + static_cast<double>(next) * size;
    if (!may_try(target)) return false;
    const step::StepReport report = integrator_->advance(state_, options_, target);
    count(report);
    if (!report.converged) {
      easy = 0;
      constexpr long most_parts = 1L << 62;  // of a segment, which a long can count
      if (++level > options_.max_cuts || (steps << (level - 1)) > most_parts / 2)
        return fail("the step at time " + std::to_string(state_.time) + " fails down to a step size of " +
                    std::to_string(size) + ": " +
                    (summary_.instability.empty() ? "" : summary_.instability + "; it ended in this: ") + report.cause +
                    (vibrations_.seen() ? "; " + std::string(undamped) : ""));
      keep_or_restore(failures++ == 0);
      done *= 2;
      continue;
    }
    failures = 0;
    done = next;
    last_step_ = size;
    if (options_.single_solution && summary_.steps.accepted == 1)
      note("one linear solution per step: residuals are not driven to the tolerance");
    if (!plan_.joints.empty()) step::accept_turns(system_, state_);
    if (reactions_ && !watch_reactions()) return false;
    if (watches_error() && !look_at_error()) return false;
    if (has_balance()) work_meter_.add(system_, state_, size);
    const bool goes_on = !is_variational() || watch_vibrations();
    record(report.iterations, target == total_end || !goes_on);
    if (!goes_on) return false;
    if (!report_progress(report, total_end)) return false;
    if (level > 0 && done % 2 == 0 && ++easy >= 4 && report.iterations <= options_.max_iterations / 2) {
      done /= 2;
      --level;
      easy = 0;
    }
  }
  return true;
}

bool Run::run_dynamics() {
  const double end = scene_.analysis.end_time;
  BreakWalk breaks(plan_, scene_.analysis);
  for (double from = 0.0, to = 0.0; from < end; from = to) {
    if (!breaks.next(from, to)) return fail(breaks.fault());
    looking_ = false;  // errors across a start say nothing
    double last = end;
    const bool is_done = controller_ ? run_controlled_segment(from, to, last) : run_segment(from, to, last);
    figures_.end_stretch(system_, state_, energy_meter_);
    if (!is_done) return false;
  }
  summary_.status = RunStatus::ok;
  return true;
}

}  // namespace bough::run
