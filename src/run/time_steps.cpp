#include "time_steps.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "bough/io/number_text.hpp"
#include "bough/step/find_equilibrium.hpp"
#include "bough/step/growing_vibration.hpp"
#include "effective_options.hpp"
#include "given_velocities.hpp"
#include "not_judged.hpp"
#include "stability_watch.hpp"
#include "trust.hpp"
#include "turning_start.hpp"

namespace bough::run {

namespace {

bool shows_reactions(const plan::Plan& plan) {
  return std::any_of(plan.sensors.begin(), plan.sensors.end(),
                     [](const plan::SensorPlan& s) { return s.sensor.kind == scene::SensorKind::joint_reaction; });
}

/// Whether a state has a node, a body or a beam.
bool has(const records::StoredState& state, const std::string& name) {
  return std::any_of(state.parts.begin(), state.parts.end(), [&](const auto& p) { return p.name == name; }) ||
         std::any_of(state.beams.begin(), state.beams.end(), [&](const auto& b) { return b.name == name; });
}

/// "'a', 'b' and 3 more parts"
std::string names_of(const std::vector<std::string>& names) {
  constexpr std::size_t most = 5;
  std::string text;
  for (std::size_t i = 0; i < std::min(most, names.size()); ++i) text += (i > 0 ? ", '" : "'") + names[i] + "'";
  return names.size() > most ? text + " and " + std::to_string(names.size() - most) + " more parts" : text;
}

}  // namespace

TimeSteps::TimeSteps(const Parts& parts)
    : Analysis(parts),
      laws_(parts.plan),
      integrator_(step::make_integrator(parts.system, parts.scene.solver, parts.options)),
      breaks_(parts.plan, parts.scene.analysis),
      hidden_(parts.scene) {
  const bool checks = scene_.output.checks;
  if (options_.integrator != scene::Integrator::generalized_alpha) return;
  if (options_.step_control || checks) local_error_.emplace(system_, options_, scene_.analysis.end_time);
  if (local_error_ && checks && !options_.single_solution && shows_reactions(plan_)) reactions_.emplace(system_);
  if (recording_.error_watch() == nullptr || !recording_.error_watch()->has_columns()) return;
  seen_.emplace(plan_).see(plan_, state_);  // a step does not allocate
  for (auto* values : {&values_before_, &values_now_, &values_displaced_})
    values->reserve(summary().header.columns.size());
  const double duration = scene_.analysis.end_time;
  if (local_error_ && !options_.single_solution && CarriedError::pays(system_, duration / scene_.analysis.step_size))
    carried_.emplace(system_, scene_.solver, options_, duration, state_);
}

bool TimeSteps::begin() {
  if (asked_.from && !begin_from(*asked_.from)) return false;
  if (scene_.analysis.start == scene::StartKind::equilibrium && !begin_in_equilibrium()) return false;
  return begin_next_stretch();
}

/// Time goes on from that of the state, since laws, drives and frames are functions of it.
bool TimeSteps::begin_from(const records::StoredState& from) {
  start_ = begin_ = end_ = start_time(from);
  state_.time = start_;
  if (const auto trouble = system_.set_time(start_)) return fail(trouble->text);
  const results::NamedParts::Taken taken = results::NamedParts(scene_, plan_).take(from, system_, state_);
  if (!taken.refusal.empty()) return fail("the scene cannot start from this state: " + taken.refusal);
  if (carried_) carried_->span(start_, scene_.analysis.end_time);
  note("the run starts from the state of another one at " +
       std::string(from.runs_over_load ? "load factor " : "time ") + io::rounded_text(from.time, 6) +
       ", with its places and velocities");
  if (!taken.as_scene.empty())
    note("the state does not have " + names_of(taken.as_scene) + ": they start as the scene says");
  if (!taken.left.empty()) note("the scene does not have " + names_of(taken.left) + " of the state");
  asked_nodes_ = step::nodes_in_space(plan_, state_);
  return true;
}

bool TimeSteps::begin_in_equilibrium() {
  const std::optional<scene::Spin> spin = spin_at_start(scene_, plan_);
  if (!spin && scene_.analysis.frame.empty())
    if (const auto frames = scene::velocities_of_frames(scene_, scene::Poses(scene_)); !frames || !frames->empty())
      return fail(
          "there is no equilibrium to start from: frames turn at time 0, and not all of the structure can turn with "
          "them; describe the analysis in that frame, or leave out start");
  const step::EquilibriumReport rest =
      spin ? find_turning_equilibrium(scene_, plan_, *spin, options_, state_)
           : step::find_equilibrium(system_, state_, options_, scene_.analysis.step_size);
  account().newton_iterations() += rest.iterations;
  if (!rest.found) return fail("there is no equilibrium to start from: " + rest.cause);
  char text[200];
  std::snprintf(text, sizeof text,
                "the start was moved to the equilibrium under the loads of time 0, by up to %.3g of the size of the "
                "structure, or rad (%d steps, %d Newton iterations)",
                rest.moved, rest.steps, rest.iterations);
  note(text);
  if (spin)
    note("all turns at " + io::rounded_text(spin->rate, 6) +
         " rad/s about one axis at the start: the equilibrium is that relative to this rotation, with its centrifugal "
         "forces");
  else
    note_unstable_start();
  asked_nodes_ = step::nodes_in_space(plan_, state_);
  return true;
}

/// A structure that was placed exactly in an unstable equilibrium stays there; nothing else in the run would tell. A
/// note is enough in motions that the run has: what disturbs it there shows. What is left out is never disturbed.
void TimeSteps::note_unstable_start() {
  if (HiddenMotions::are_in(plan_)) {
    const HiddenMotions::Look look = hidden_.look(plan_, state_, std::nullopt);
    starts_unstable_ = !look.mode.empty();
    hidden_mode_ = look.mode;
  }
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
  if (goes_on && has_hidden()) look_at_hidden();
  if (!goes_on || is_stretch_done()) recording_.end_stretch(state_);
  return goes_on;
}

void TimeSteps::stop() {
  if (!is_stretch_done()) recording_.end_stretch(state_);
}

void TimeSteps::checkpoint(records::Archive& archive) {
  Analysis::checkpoint(archive);
  if (archive.is_reading()) integrator_ = step::make_integrator(system_, scene_.solver, options_);
  archive(start_, begin_, end_, local_error_, carried_, laws_, vibrations_, *integrator_, breaks_, hidden_looks_,
          hidden_known_, hidden_unstable_, starts_unstable_, was_unstable_, ends_unstable_, hidden_mode_, is_begun_,
          is_followed_, has_jump_, reactions_, values_before_, values_now_, values_displaced_, seen_);
}

bool TimeSteps::start_integrator(double step_size) {
  Conservation& conservation = recording_.conservation();
  if (reactions_) reactions_->restart();
  results::Energies before;
  if (!is_first() && conservation.has_balance()) before = conservation.energies().eval(system_, state_);
  const step::StartReport consistent = step::make_consistent(system_, state_, is_first(), step_size);
  if (!consistent.ok) return fail(consistent.cause);
  account().watch_dependent_rows(state_.time);
  constexpr double left_open = 1e-4;  // above what integrators leave open in a run
  if (is_first() && asked_.from && consistent.open_joint >= 0 && consistent.gap > left_open)
    return fail("the scene cannot start from this state: '" +
                plan_.joints[static_cast<std::size_t>(consistent.open_joint)].name + "' is open there by " +
                io::rounded_text(consistent.gap, 3) +
                " of the size of the parts that meet in it (or rad); leave it out, or drive it to where the state has "
                "it");
  if (is_first() && consistent.position_correction > 1e-9) note_moved_start(consistent);
  if (is_first()) {
    summary().changed_velocities = changed_velocities(plan_, state_, asked_nodes_);
    if (asked_.from)
      std::erase_if(summary().changed_velocities, [&](const auto& changed) { return has(*asked_.from, changed.of); });
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
  if (carried_) carried_->restart(state_.time);
  is_followed_ = false;
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

/// Loads may make what the plan has left out unstable, as a beam that buckles sideways: the run would stay in its plane.
/// Looks at the ends of equal parts of the run. Beams alone buckle, and the tangent tells of stability only where nothing
/// but they moves: a mechanism or a body in flight is no equilibrium.
bool TimeSteps::has_hidden() const {
  return HiddenMotions::are_in(plan_) && !plan_.beams.empty() && plan_.mobility.degrees_of_freedom() == 0;
}

void TimeSteps::look_at_hidden() {
  constexpr double steps_a_look = 100.0, most_looks = 8.0;
  const double end = scene_.analysis.end_time;
  const double looks = std::clamp(std::floor(end / scene_.analysis.step_size / steps_a_look), 1.0, most_looks);
  if (state_.time < end * (static_cast<double>(hidden_looks_) + 1.0) / looks * (1.0 - 1e-9)) return;
  hidden_looks_ = static_cast<int>(state_.time / end * looks * (1.0 + 1e-9));
  const HiddenMotions::Look look = hidden_.look(plan_, state_, std::nullopt);
  if (!look.is_known) return;
  ++hidden_known_;
  was_unstable_ = ends_unstable_;
  ends_unstable_ = !look.mode.empty();
  if (!ends_unstable_) return;
  ++hidden_unstable_;
  hidden_mode_ = look.mode;
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

bool TimeSteps::carry_error(const step::LocalError* local) {
  if (!carried_) return true;
  const bool is_near = carried_->is_near();
  bool is_carried = false;
  const auto t = local != nullptr ? carried_->pass(state_, *local, is_carried) : carried_->pass(state_, is_carried);
  if (t) return fail(t->text);
  if (is_near) {
    seen_->see(plan_, state_);
    seen_->eval(system_, values_now_);
    recording_.error_watch()->follow(values_now_, is_followed_);
  }
  is_followed_ = is_near;
  if (!is_carried) return true;
  const double left = (scene_.analysis.end_time - state_.time) / last_step_;
  carried_->choose_stride(state_, recording_.error_watch()->turn(), left);
  const double size = carried_->transport().size();
  if (!std::isfinite(size)) {
    recording_.error_watch()->carry(values_now_, values_displaced_, -1.0);
    return true;
  }
  const double share = size > 0.0 ? ErrorWatch::small / size : 0.0;
  for (const int node : seen_->nodes())
    carried_->transport().displace(share, static_cast<std::size_t>(node), seen_->motion(node));
  seen_->eval(system_, values_displaced_);
  recording_.error_watch()->carry(values_now_, values_displaced_, share);
  return true;
}

void TimeSteps::end_errors() {
  if (carried_ && carried_->is_resolved()) recording_.error_watch()->take_carried(carried_->certain_part());
}

void TimeSteps::sum_up() {
  if (reactions_) summary().unsure_reactions = reactions_->found();
}

void TimeSteps::add_doubts() {
  // A moment of it is not enough: vibrations may pass through states that would be unstable if they lasted.
  const bool lasts =
      hidden_unstable_ > 0 && (2 * hidden_unstable_ >= hidden_known_ || (ends_unstable_ && was_unstable_));
  if (lasts || starts_unstable_)
    summary().doubts.push_back(
        {"stability", std::string(starts_unstable_ ? "the equilibrium in which the run starts" : "the motion") +
                          " is unstable " + HiddenMotions::where(plan_) +
                          ", which the plan leaves out of the motions: " + hidden_mode_ +
                          "; give it a small imperfection or a small load in that direction to see where it goes"});
  if (const std::string unseen = laws_.text(); !unseen.empty()) summary().doubts.push_back({"error", unseen});
  if (!reactions_) return;
  if (const std::string wrong = reactions_->misplaced(); !wrong.empty()) summary().doubts.push_back({"error", wrong});
}

std::string TimeSteps::not_judged() const {
  const bool is_hidden = HiddenMotions::are_in(plan_) && !plan_.beams.empty() && hidden_known_ == 0;
  return one_line(
      {asked_.measured.time ? "" : error_not_judged(plan_, options_, scene_.output.checks, summary().sensor_errors),
       plan_.beams.empty() || asked_.measured.mesh ? "" : the_mesh,
       is_hidden ? "stability " + HiddenMotions::where(plan_) + " is not examined" : ""});
}

}  // namespace bough::run
