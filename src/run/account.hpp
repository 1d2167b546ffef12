#pragma once
/// The account of a run: its summary, updated with every step.
#include <algorithm>
#include <limits>
#include <string>
#include <unordered_map>

#include "bough/records/run.hpp"
#include "bough/solve/hierarchical.hpp"
#include "bough/step/advance.hpp"
#include "bough/step/system.hpp"

namespace bough::run {

/// Counts the steps of a run, and keeps its status and notes. It also keeps events during the run: linearly dependent
/// constraint rows, residuals at the round-off floor, the first rejected step.
class Account {
 public:
  /// Keeps the reference.
  explicit Account(const step::System& system) : system_(system) {}

  records::Summary& summary() { return summary_; }
  const records::Summary& summary() const { return summary_; }

  void checkpoint(records::Archive& archive) {
    archive(summary_, repeated_, largest_force_, unbalanced_force_, first_rejection_, not_unique_, last_dependent_rows_,
            dependent_rows_, least_dependent_rows_, dependent_since_);
  }

  /// Sets the status to failed. Always returns false, so that callers can return the result.
  bool fail(const std::string& cause);
  /// Sets the status to interrupted. Always returns false.
  bool interrupt(const std::string& cause);
  /// Asks to be interrupted for this cause after the present step; why_to_stop: empty: nobody did.
  void ask_to_stop(const std::string& cause) { why_to_stop_ = cause; }
  const std::string& why_to_stop() const { return why_to_stop_; }
  /// Adds a note, unless the summary has it already. Notes that differ in numbers alone are two: the first, and how many
  /// followed with the last of them.
  void note(const std::string& text);

  /// Counts an attempted step from or to this state: as accepted if it converged, else as rejected.
  void count(const step::StepReport& report, const step::State& state);
  /// Counts an attempted step from this state as rejected, whether it converged or not.
  void reject(const step::StepReport& report, const step::State& state, const std::string& cause);
  /// Counter of Newton iterations, for equilibria that are not steps of their own.
  long& newton_iterations() { return summary_.steps.newton_iterations; }

  /// Records the largest and the smallest rank deficiency of the factorizations of accepted steps, and the reactions
  /// that are not unique at the largest.
  void watch_dependent_rows(double time);
  /// The same by the factorization of another solver, for runs whose own does not know the rank.
  void watch_dependent_rows(double time, const solve::Hierarchical& solver);
  /// Adds rows that the plan has omitted: how many depend on others with all rows, at the end of the run, and which
  /// reactions are not unique for that.
  void see_rows_in_space(int dependent, const std::string& groups);
  int dependent_rows() const { return dependent_rows_; }

  /// Notes at the end of a run: on constraint rows that depend on others; then on steps and factors.
  void note_dependent_rows();
  void note_steps();
  /// Largest unbalanced force of steps accepted at the round-off floor, relative to the largest force of the run, which
  /// is at least `least_force` [N].
  double unbalanced_at_floor(double least_force) const {
    return largest_force_ > 0.0 ? unbalanced_force_ / std::max(largest_force_, least_force) : 0.0;
  }

 private:
  void watch_floor(const step::StepReport& report);
  template <class Solver>
  void note_rank(double time, const Solver& solver);

  struct Repeated {
    long count = 0;
    std::size_t place = 0;  ///< of the note of all but the first, among the notes
  };

  const step::System& system_;
  records::Summary summary_;
  std::unordered_map<std::string, Repeated> repeated_;   ///< by notes without their numbers
  double largest_force_ = 0.0, unbalanced_force_ = 0.0;  ///< in accepted steps; in those at the round-off floor [N]
  std::string first_rejection_, not_unique_, why_to_stop_;
  int last_dependent_rows_ = 0, dependent_rows_ = 0, least_dependent_rows_ = std::numeric_limits<int>::max();
  double dependent_since_ = 0.0;  ///< time or load factor at which the largest number was met first
};

}  // namespace bough::run
