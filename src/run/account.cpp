#include "account.hpp"

#include <algorithm>
#include <charconv>
#include <stdexcept>

#include "bough/io/number_text.hpp"
#include "dependent_rows.hpp"

namespace bough::run {

using records::RunStatus;

bool Account::fail(const std::string& cause) {
  summary_.status = RunStatus::failed;
  summary_.cause = cause;
  return false;
}

bool Account::interrupt(const std::string& cause) {
  summary_.status = RunStatus::interrupted;
  summary_.cause = cause;
  return false;
}

namespace {

/// A text in which every number is the same sign: what notes of one kind have in common.
std::string without_numbers(const std::string& text) {
  std::string kind;
  const char* const end = text.data() + text.size();
  for (const char* at = text.data(); at != end;) {
    double number = 0.0;
    const bool is_number = *at >= '0' && *at <= '9';
    kind += is_number ? '#' : *at;
    at = is_number ? std::from_chars(at, end, number).ptr : at + 1;
  }
  return kind;
}

}  // namespace

void Account::note(const std::string& text) {
  std::vector<std::string>& notes = summary_.notes;
  if (std::find(notes.begin(), notes.end(), text) != notes.end()) return;
  const auto [known, is_new] = repeated_.try_emplace(without_numbers(text));
  Repeated& kind = known->second;
  ++kind.count;
  if (is_new) {
    notes.push_back(text);
  } else if (kind.count == 2) {
    kind.place = notes.size();
    notes.push_back(text);
  } else {
    notes[kind.place] = std::to_string(kind.count - 1) + " more times with other numbers, the last time: " + text;
  }
}

void Account::count(const step::StepReport& report, const step::State& state) {
  if (!report.converged) return reject(report, state, report.cause);
  ++summary_.steps.accepted;
  summary_.steps.newton_iterations += report.iterations;
  watch_floor(report);
  watch_dependent_rows(state.time);
}

void Account::reject(const step::StepReport& report, const step::State& state, const std::string& cause) {
  if (cause.empty()) throw std::logic_error("a step was rejected without a cause");
  ++summary_.steps.rejected;
  summary_.steps.newton_iterations += report.iterations;
  if (first_rejection_.empty())
    first_rejection_ = "the first rejected step was that from " + std::to_string(state.time) + ": " + cause;
}

/// The unbalanced force at the round-off floor is compared with the largest force of the run, because at rest the step
/// itself has no forces to compare with.
void Account::watch_floor(const step::StepReport& report) {
  const step::ResidualSize& r = report.residual;
  const double arm = system_.moment_arm();
  largest_force_ = std::max({largest_force_, r.force_scale, r.moment_scale / arm});
  if (!report.at_floor) return;
  summary_.checks.round_off_floor_reached = true;
  ++summary_.checks.steps_at_floor;
  unbalanced_force_ = std::max({unbalanced_force_, r.force, r.moment / arm});
}

template <class Solver>
void Account::note_rank(double time, const Solver& solver) {
  const int deficiency = solver.last_status().deficiency;
  if (deficiency < 0) return;  // unknown
  last_dependent_rows_ = deficiency;
  least_dependent_rows_ = std::min(least_dependent_rows_, deficiency);
  if (deficiency <= dependent_rows_) return;
  dependent_rows_ = deficiency;
  dependent_since_ = time;
  not_unique_ = dependent_groups_text(system_, solver.blocks_not_unique());
}

void Account::watch_dependent_rows(double time) { note_rank(time, system_.linear().solver()); }
void Account::watch_dependent_rows(double time, const solve::Hierarchical& solver) { note_rank(time, solver); }

void Account::see_rows_in_space(int dependent, const std::string& groups) {
  const bool is_rank_known = least_dependent_rows_ <= dependent_rows_;
  const int hidden = dependent - last_dependent_rows_;
  if (!is_rank_known || hidden <= 0) return;
  least_dependent_rows_ += hidden;
  dependent_rows_ += hidden;
  not_unique_ = groups;
}

/// Rows that are dependent throughout the run do not affect the motion. If rows become dependent only at times, the
/// rank of the constraints drops there: the mechanism then has more degrees of freedom than elsewhere, and the
/// equations do not determine how the motion continues.
void Account::note_dependent_rows() {
  if (dependent_rows_ <= 0) return;
  const bool is_dynamic = system_.plan().is_dynamic;
  std::string text = std::to_string(dependent_rows_) + " constraint row(s) depend on others";
  if (least_dependent_rows_ < dependent_rows_)
    text += (is_dynamic ? " at time " : " at load factor ") + io::rounded_text(dependent_since_, 6) + ", and " +
            std::to_string(std::max(0, least_dependent_rows_)) +
            " elsewhere: the mechanism passes a singular position, where it can go on in more than one way, and the "
            "reactions of these are not unique: ";
  else if (is_dynamic)
    text += ": the motion is unique, the reactions of these are not: ";
  else
    text += ": the reactions of these are not unique: ";
  note(text + not_unique_);
}

void Account::note_steps() {
  if (!first_rejection_.empty() && summary_.status != RunStatus::failed) note(first_rejection_);
  if (system_.plan().took("symmetric") && !system_.linear().takes_symmetric_parts())
    note("the symmetric parts of tangents were given up for whole ones: Newton's iteration had slowed down");
  if (summary_.checks.round_off_floor_reached)
    note("some steps were accepted at the round-off floor of the residual, above the tolerance asked for");
}

}  // namespace bough::run
