#pragma once
/// The account of a run: its summary, filled step by step.
#include <limits>
#include <string>

#include "bough/records/run.hpp"
#include "bough/step/advance.hpp"
#include "bough/step/system.hpp"

namespace bough::run {

/// Counts the steps of a run and keeps its status, its notes and what it met on the way: constraint rows that depend
/// on others, residuals at the floor of round-off, the first rejected step.
class Account {
 public:
  /// Keeps the reference.
  explicit Account(const step::System& system) : system_(system) {}

  records::Summary& summary() { return summary_; }
  const records::Summary& summary() const { return summary_; }

  /// Ends the run as failed. Always false, so that verbs can return it.
  bool fail(const std::string& cause);
  /// Ends the run as interrupted. Always false.
  bool interrupt(const std::string& cause);
  /// Adds a note, unless the summary has it already.
  void note(const std::string& text);

  /// Counts an attempt of a step from or to this state: as accepted where it converged, else as rejected.
  void count(const step::StepReport& report, const step::State& state);
  /// Counts an attempt from this state as rejected for a cause, whether it converged or not.
  void reject(const step::StepReport& report, const step::State& state, const std::string& cause);
  /// Counts linear solutions of equilibria that are no steps of their own.
  long& newton_iterations() { return summary_.steps.newton_iterations; }

  /// Keeps the largest and the least deficiency of the factors of accepted steps, with the reactions that were not
  /// unique at the largest.
  void watch_dependent_rows(double time);
  int dependent_rows() const { return dependent_rows_; }

  /// Notes at the end of a run: on constraint rows that depend on others; then on steps and factors.
  void note_dependent_rows();
  void note_steps();
  /// What accepted steps left unbalanced at the floor of round-off, over the largest force of the run.
  double unbalanced_at_floor() const { return largest_force_ > 0.0 ? unbalanced_force_ / largest_force_ : 0.0; }

 private:
  void watch_floor(const step::StepReport& report);

  const step::System& system_;
  records::Summary summary_;
  double largest_force_ = 0.0, unbalanced_force_ = 0.0;  ///< of accepted steps; of those at the floor of round-off [N]
  std::string first_rejection_, not_unique_;
  int dependent_rows_ = 0, least_dependent_rows_ = std::numeric_limits<int>::max();
  double dependent_since_ = 0.0;  ///< time or load factor at which the largest number was met first
};

}  // namespace bough::run
