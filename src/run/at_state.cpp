#include "at_state.hpp"

namespace bough::run {

bool AtState::begin() {
  const std::string cause = about_.find();
  account().newton_iterations() += about_.iterations();
  if (!cause.empty()) return fail(cause);
  tell_notes();
  record(0, true);
  return true;
}

bool AtState::take_step() {
  if (!may_try(0.0)) return false;
  step::Linearisation linear(system_);
  if (const std::string cause = about_.linearise(linear); !cause.empty()) return fail(cause);
  if (!look(linear)) return false;
  step::StepReport reached;
  reached.converged = true;
  count(reached);
  is_done_ = true;
  return true;
}

void AtState::tell_notes() {
  for (const std::string& text : about_.take_notes()) note(text);
}

void AtState::add_doubts() {
  for (const std::string& text : about_.doubts()) summary().doubts.push_back({"state", text});
}

}  // namespace bough::run
