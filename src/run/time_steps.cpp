#include "time_steps.hpp"

#include <algorithm>
#include <cstdio>

#include "bough/io/number_text.hpp"
#include "bough/step/find_equilibrium.hpp"
#include "bough/step/growing_vibration.hpp"
#include "effective_options.hpp"
#include "given_velocities.hpp"
#include "not_judged.hpp"
#include "stability_watch.hpp"
#include "trust.hpp"

namespace bough::run {

namespace {

bool shows_reactions(const plan::Plan& plan) {
  return std::any_of(plan.sensors.begin(), plan.sensors.end(),
                     [](const plan::SensorPlan& s) { return s.sensor.kind == scene::SensorKind::joint_reaction; });
}

}  // namespace

TimeSteps::TimeSteps(const Parts& parts)
    : Analysis(parts),
      integrator_(step::make_integrator(parts.system, parts.scene.solver, parts.options)),
      breaks_(parts.plan, parts.scene.analysis) {
  const bool checks = scene_.output.checks;
  if (options_.integrator != scene::Integrator::generalized_alpha) return;
  if (options_.step_control || checks) local_error_.emplace(system_, options_, scene_.analysis.end_time);
  if (local_error_ && checks && !options_.single_solution && shows_reactions(plan_)) reactions_.emplace(system_);
  if (recording_.error_watch() == nullptr || !recording_.error_watch()->has_columns()) return;
  seen_.emplace(plan_).see(plan_, state_);  // a step does not allocate
  for (auto* values : {&values_before_, &values_now_, &values_displaced_})
    values->reserve(summary().header.columns.size());
}

bool TimeSteps::begin() {
  if (scene_.analysis.start == scene::StartKind::equilibrium && !begin_in_equilibrium()) return false;
  return begin_next_stretch();
}

bool TimeSteps::begin_in_equilibrium() {
  const step::EquilibriumReport rest = step::find_equilibrium(system_, state_, options_, scene_.analysis.step_size);
  account().newton_iterations() += rest.iterations;
  if (!rest.found) return fail("there is no equilibrium to start from: " + rest.cause);
  char text[200];
  std::snprintf(text, sizeof text,
                "the start was moved to the equilibrium under the loads of time 0, by up to %.3g of the size of the "
                "structure, or rad (%d steps, %d Newton iterations)",
                rest.moved, rest.steps, rest.iterations);
  note(text);
  note_unstable_start();
  return true;
}

/// A structure that was placed exactly in an unstable equilibrium stays there; nothing else in the run would tell.
void TimeSteps::note_unstable_start() {
  if (system_.evaluate(state_, {}, true)) return;
  step::Stability stability(system_);
  const step::StabilityLook look = stability.look_closely();
  if (!look.is_known || look.unstable == 0) return;
  if (const auto mode = stability.find_mode(state_))
    note("the equilibrium in which the run starts is unstable: the slightest disturbance grows, in which " +
         StabilityWatch::describe(plan_, *mode));
}

bool TimeSteps::begin_next_stretch() {
  begin_ = end_;
  const bool is_begun = breaks_.next(begin_, end_) ? begin_stretch() : fail(breaks_.fault());
  is_begun_ = true;
  if (!is_begun) recording_.end_stretch(state_);
  return is_begun;
}

bool TimeSteps::begin_rest_of_stretch() {
  recording_.end_stretch(state_);
  begin_ = state_.time;
  const bool is_begun = begin_stretch();
  has_jump_ = false;
  return is_begun;
}

bool TimeSteps::take_step() {
  if (is_stretch_done()) {
    has_jump_ = false;  // a new stretch begins with the inputs that it finds
    if (!begin_next_stretch()) return false;
  } else if (has_jump_ && !begin_rest_of_stretch()) {
    return false;
  }
  const bool goes_on = step_within_stretch();
  if (!goes_on || is_stretch_done()) recording_.end_stretch(state_);
  return goes_on;
}

bool TimeSteps::start_integrator(double step_size) {
  Conservation& conservation = recording_.conservation();
  if (reactions_) reactions_->restart();
  results::Energies before;
  if (!is_first() && conservation.has_balance()) before = conservation.energies().eval(system_, state_);
  const step::StartReport consistent = step::make_consistent(system_, state_, is_first(), step_size);
  if (!consistent.ok) return fail(consistent.cause);
  account().watch_dependent_rows(state_.time);
  if (is_first() && consistent.position_correction > 1e-9) note_moved_start(consistent);
  if (is_first()) {
    summary().changed_velocities = changed_velocities(plan_, state_);
    if (!summary().changed_velocities.empty()) note(describe(summary().changed_velocities));
  }
  if (consistent.velocity_change > 1e-9) {
    char text[160];
    std::snprintf(
        text, sizeof text,
        "velocities were made consistent with joints and drives at time %.6g by impulses of up to %.3g N s (N m s)",
        state_.time, consistent.velocity_impulse);
    note(text);
  }
  if (is_first()) {
    conservation.begin(state_);
    record(0, false);
    if (options_.integrator == scene::Integrator::bdf) choose_bdf_order(step_size);
  } else {
    conservation.jump(before, state_);
    recording_.add_figures(state_);
  }
  const step::StartReport started = integrator_->start(state_, options_, step_size);
  return started.ok || fail(started.cause);
}

/// With order 3, some undamped vibrations grow. If the scene has such a vibration and does not request order 3, order 2
/// is used.
void TimeSteps::choose_bdf_order(double step_size) {
  if (options_.bdf_order == 2) return;
  const auto vibration = step::find_growing_vibration(system_, state_, step_size);
  if (vibration) {
    const std::string cause = "'" + plan_.nodes[static_cast<std::size_t>(vibration->node)].name +
                              "' takes part in an undamped vibration of " + io::rounded_text(vibration->frequency, 3) +
                              " rad/s, " + io::rounded_text(vibration->steps_a_period, 2) +
                              " steps a period, which backward differences of order 3 make grow";
    if (options_.bdf_order == 3) {
      summary().instability = cause + ": take \"bdf_order\": 2 or generalized_alpha";
      note(summary().instability);
    } else {
      note("backward differences of order 2 are taken: " + cause);
    }
  }
  options_.bdf_order = vibration && summary().instability.empty() ? 2 : 3;
  if (options_.bdf_order == 2) integrator_ = step::make_integrator(system_, scene_.solver, options_);
  summary().options = effective_options(scene_, options_);
}

void TimeSteps::note_moved_start(const step::StartReport& consistent) {
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

bool TimeSteps::watch_reactions() {
  if (!reactions_ || !reactions_->wants_look(state_, summary().checks.local_error_sum)) return true;
  const auto t = reactions_->look(system_, state_);
  return !t || fail(t->text);
}

bool TimeSteps::set_step_size(double size) {
  const step::StartReport changed = integrator_->change_step_size(state_, options_, size);
  return changed.ok || fail(changed.cause);
}

void TimeSteps::keep_or_restore(bool is_first_failure) {
  if (is_first_failure)
    tried_ = state_;
  else
    state_ = tried_;
}

void TimeSteps::add_error(double duration, double size) {
  records::Checks& checks = summary().checks;
  checks.local_error_known = true;
  recording_.gate().look_at("the local error of a step", local_error_->relative_motion(), state_.time);
  recording_.gate().look_at("the local error of velocities", local_error_->relative_velocity(), state_.time);
  checks.local_error_max = std::max(checks.local_error_max, local_error_->relative_motion());
  checks.local_error_max_velocity = std::max(checks.local_error_max_velocity, local_error_->relative_velocity());
  checks.local_error_sum += local_error_->relative_motion() * duration / size;
}

void TimeSteps::see_before_look() {
  if (!seen_) return;
  seen_->see(plan_, state_);
  seen_->eval(system_, values_before_);
}

void TimeSteps::watch_errors(double norm) {
  if (!seen_) return;
  seen_->see(plan_, state_);
  seen_->eval(system_, values_now_);
  for (const int node : seen_->nodes()) local_error_->displace(static_cast<std::size_t>(node), seen_->motion(node));
  seen_->eval(system_, values_displaced_);
  recording_.error_watch()->look(values_before_, values_now_, values_displaced_, norm, last_step_);
}

void TimeSteps::sum_up() {
  if (reactions_) summary().unsure_reactions = reactions_->found();
}

void TimeSteps::add_doubts() {
  if (!reactions_) return;
  if (const std::string wrong = reactions_->misplaced(); !wrong.empty()) summary().doubts.push_back({"error", wrong});
}

std::string TimeSteps::not_judged() const {
  return error_not_judged(plan_, options_, scene_.output.checks, summary().sensor_errors);
}

}  // namespace bough::run
