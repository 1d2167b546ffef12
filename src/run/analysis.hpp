#pragma once
/// How a run goes from state to state: an analysis takes accepted steps, one a call, each with its row.
#include <memory>
#include <vector>

#include "bough/run/simulate.hpp"
#include "bough/step/advance.hpp"
#include "recording.hpp"

namespace bough::run {

/// What an analysis works on; all of it outlives the analysis.
struct Parts {
  const scene::Scene& scene;
  step::StepOptions& options;
  const plan::Plan& plan;
  step::System& system;
  step::State& state;  ///< the last accepted one, between steps
  Recording& recording;
  const SimulateOptions& asked;  ///< callbacks and stops
  const ProgressCallback& progress;
};

/// Base of the analyses. Verbs that return bool say whether the run goes on: where it does not, the account has the
/// status and the cause. A copy goes on from where the original was, on the same parts.
class Analysis {
 public:
  virtual ~Analysis() = default;
  virtual std::unique_ptr<Analysis> clone() const = 0;

  /// Comes to the first equilibrium or the consistent start, and records it.
  [[nodiscard]] virtual bool begin() = 0;
  /// Takes one accepted step, after as many rejected attempts as it needs. Not to be called once is_done().
  [[nodiscard]] virtual bool take_step() = 0;
  virtual bool is_done() const = 0;
  /// The state was taken back to where this copy was made: makes anew what the system keeps for the next step.
  virtual void come_back();

  /// What the analysis alone can tell at the end of a run: notes; figures of the summary by which it is judged;
  /// doubts beside those that the summary gives rise to.
  virtual void add_notes() {}
  virtual void sum_up() {}
  virtual void add_doubts() {}

 protected:
  explicit Analysis(const Parts& parts);
  Analysis(const Analysis&) = default;

  Account& account() { return recording_.account(); }
  records::Summary& summary() { return recording_.summary(); }
  bool fail(const std::string& cause) { return account().fail(cause); }
  void note(const std::string& text) { account().note(text); }
  /// Counts an attempt at the present state.
  void count(const step::StepReport& report) { account().count(report, state_); }
  /// Records the present state, after a step of `last_step_`.
  void record(int iterations, bool is_last) { recording_.record(state_, last_step_, iterations, is_last); }
  /// Asks the caller before an attempt of a step to `target`, and tells of an accepted one on the way to `end`.
  bool may_try(double target);
  bool report_progress(const step::StepReport& report, double end);
  /// Times of expected figures, and those asked for, within a stretch, and its end: steps end there.
  std::vector<double> stops_between(double begin, double end) const;
  void accept_turns() {
    if (!plan_.joints.empty()) step::accept_turns(system_, state_);
  }

  const Parts parts_;
  const scene::Scene& scene_;
  step::StepOptions& options_;
  const plan::Plan& plan_;
  step::System& system_;
  step::State& state_;
  Recording& recording_;
  double last_step_ = 0.0;  ///< size of the last accepted step, in time, load factor or along the path
};

/// The analysis that the scene asks for.
std::unique_ptr<Analysis> make_analysis(const Parts& parts);

/// A pointer that copies what it points to, by its clone().
template <class T>
class Cloned {
 public:
  Cloned() = default;
  Cloned(std::unique_ptr<T> p) : p_(std::move(p)) {}
  Cloned(const Cloned& other) : p_(other.p_ ? other.p_->clone() : nullptr) {}
  Cloned(Cloned&&) noexcept = default;
  Cloned& operator=(Cloned other) noexcept {
    p_ = std::move(other.p_);
    return *this;
  }
  T* operator->() const { return p_.get(); }
  T& operator*() const { return *p_; }

 private:
  std::unique_ptr<T> p_;
};

}  // namespace bough::run
