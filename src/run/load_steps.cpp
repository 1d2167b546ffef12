#include "load_steps.hpp"

#include <algorithm>

#include "bough/io/number_text.hpp"
#include "branch_check.hpp"

namespace bough::run {

LoadSteps::LoadSteps(const Parts& parts) : Statics(parts), num_steps_(std::max(1, parts.scene.analysis.load_steps)) {
  begin_load_step();
}

void LoadSteps::begin_load_step() {
  from_ = static_cast<double>(step_) / num_steps_;
  stops_ = stops_between(from_, from_ + 1.0 / num_steps_);
  next_stop_ = 0;
}

int LoadSteps::most_cuts() const {
  constexpr int more = 14;
  return options_.max_cuts + (options_.max_cuts == scene::Analysis{}.max_cuts ? more : 0);
}

/// What may help; nothing does where the tangent has no factor, since loads move what no stiffness holds.
std::string LoadSteps::ways_on() const {
  if (!plan_.mobility.free.empty() && !system_.linear().has_factor({})) return {};
  return "; tried were " + std::to_string(num_steps_) + (num_steps_ == 1 ? " load step" : " load steps") + ", halved " +
         std::to_string(most_cuts()) +
         " times. Ways on: \"arc_length\": {} follows the path past a limit point of the "
         "load; dynamics with \"start\": \"equilibrium\" finds a stable shape from a first shape that is far from it; "
         "a larger number of \"load_steps\" or \"max_cuts\" takes smaller steps";
}

void LoadSteps::add_notes() {
  if (most_level_ > options_.max_cuts)
    note("a load step was halved " + std::to_string(most_level_) + " times from load factor " +
         io::rounded_text(most_cut_at_, 6) + " on, beyond the usual " + std::to_string(options_.max_cuts) +
         ", since Newton's method found no equilibrium from the shape there: a first shape nearer to it, "
         "\"arc_length\" or dynamics with \"start\": \"equilibrium\" takes fewer steps");
}

bool LoadSteps::begin() {
  if (const auto t = system_.set_time(0.0)) return fail(t->text);
  record(0, false);
  return true;
}

void LoadSteps::add_doubts() {
  Statics::add_doubts();
  if (jumps_.empty()) return;
  const std::string text = jumps_ +
                           " the structure jumped to another branch of equilibria: smaller load steps do not "
                           "make the motion between them smaller";
  if (scene_.analysis.unstable)
    note(text);
  else
    summary().doubts.push_back(
        {"stability", text + "; \"arc_length\" in /analysis follows the path, dynamics tell where it really leads"});
}

bool LoadSteps::take_step() {
  const double stop = stops_[next_stop_];
  const bool is_whole = stops_.size() == 1, is_last = step_ + 1 == num_steps_ && next_stop_ + 1 == stops_.size();
  const double width = is_whole ? 1.0 / num_steps_ : stop - from_;
  for (;;) {
    const bool is_end = is_last && part_ + 1 == (1L << level_);
    const double target =
        is_end ? 1.0 : from_ + width * static_cast<double>(part_ + 1) / static_cast<double>(1L << level_);
    if (!may_try(target)) return false;
    const double before = state_.time;
    before_ = state_;
    const step::StepReport report = step::equilibrate(system_, state_, options_, target);
    count(report);
    if (!report.converged) {
      if (++level_ > most_cuts())
        return fail("no equilibrium at load factor " + io::rounded_text(target, 12) + ": " + report.cause + ways_on());
      part_ *= 2;
      continue;
    }
    stability_.look(state_);
    if (may_have_jumped(report) && has_jumped(system_, options_, before_, state_, account().newton_iterations()))
      jumps_ += (jumps_.empty() ? "from load factor " : ", and from ") + io::rounded_text(before, 6) + " to " +
                io::rounded_text(target, 6);
    last_step_ = target - before;
    if (level_ > most_level_) {
      most_level_ = level_;
      most_cut_at_ = before;
    }
    if (!plan_.joints.empty()) step::accept_turns(system_, state_);
    ++part_;
    while (level_ > 0 && part_ % 2 == 0) {
      part_ /= 2;
      --level_;
    }
    record(report.iterations, target == 1.0);
    if (part_ == (1L << level_)) {
      part_ = 0;
      from_ = stop;
      if (++next_stop_ == stops_.size() && ++step_ < num_steps_) begin_load_step();
    }
    report_progress(report, 1.0);
    return true;
  }
}

}  // namespace bough::run
