#pragma once
/// Interface of the analyses. An analysis advances the state; each call takes one accepted step and records it.
#include <memory>
#include <vector>

#include "bough/run/simulate.hpp"
#include "bough/step/advance.hpp"
#include "recording.hpp"

namespace bough::run {

/// The objects on which an analysis works. All of them must outlive it.
struct Parts {
  const scene::Scene& scene;
  step::StepOptions& options;
  const plan::Plan& plan;
  step::System& system;
  step::State& state;  ///< last accepted state, between steps
  Recording& recording;
  const SimulateOptions& asked;  ///< callbacks and requested stops
  const ProgressCallback& progress;
};

/// Base class of the analyses. Functions that return bool return whether the run continues; if not, the account holds
/// the status and the cause. A copy continues from the point that the original had reached, on the same parts.
class Analysis {
 public:
  virtual ~Analysis() = default;
  virtual std::unique_ptr<Analysis> clone() const = 0;

  /// Finds the first equilibrium or the consistent initial state, and records it.
  [[nodiscard]] virtual bool begin() = 0;
  /// Takes one accepted step, after as many rejected attempts as it needs. Not to be called once is_done().
  [[nodiscard]] virtual bool take_step() = 0;
  virtual bool is_done() const = 0;
  /// To be called after an input of the present state was changed: the next step begins as after a jump of a law.
  virtual void jump() {}
  /// To be called after the state was restored to the moment at which this copy was made. Recomputes what the system
  /// holds for the next step.
  virtual void come_back();
  /// To be called where the run stops after an accepted step that does not end it.
  virtual void stop() {}

  /// Writes or reads what the analysis keeps between two steps.
  virtual void checkpoint(records::Archive& archive) { archive(last_step_); }
  /// As step::Integrator.
  virtual bool write_matrices(long /*matrices*/) { return false; }

  /// Contributions of the analysis at the end of a run: notes, figures of the summary, and doubts in addition to those
  /// that follow from the summary.
  virtual void add_notes() {}
  /// Decides which estimates of errors hold, before they are taken.
  virtual void end_errors() {}
  /// TrustContext::errors_grow_in.
  virtual double errors_grow_in() const { return 0.0; }
  virtual void sum_up() {}
  virtual void add_doubts() {}
  /// What of its errors nothing in the run has judged, in words; empty: nothing.
  virtual std::string not_judged() const { return {}; }
  /// Whether one more Newton correction of the last state tells its error.
  virtual bool ends_in_correction() const { return true; }

 protected:
  explicit Analysis(const Parts& parts);
  Analysis(const Analysis&) = default;

  Account& account() { return recording_.account(); }
  records::Summary& summary() { return recording_.summary(); }
  const records::Summary& summary() const { return recording_.summary(); }
  bool fail(const std::string& cause) { return account().fail(cause); }
  void note(const std::string& text) { account().note(text); }
  /// Counts an attempt at the present state.
  void count(const step::StepReport& report) { account().count(report, state_); }
  /// Records the present state, after a step of size `last_step_`.
  void record(int iterations, bool is_last) { recording_.record(state_, last_step_, iterations, is_last); }
  /// Callbacks: whether a step to `target` may be attempted, and the report of an accepted step on the way to `end`,
  /// after which the run may be asked to stop.
  bool may_try(double target);
  void report_progress(const step::StepReport& report, double end);
  /// Times at which steps have to end within a stretch: those of expected figures, those requested, and the end of the
  /// stretch.
  std::vector<double> stops_between(double begin, double end) const;

  const scene::Scene& scene_;
  step::StepOptions& options_;
  const plan::Plan& plan_;
  step::System& system_;
  step::State& state_;
  Recording& recording_;
  const SimulateOptions& asked_;
  const ProgressCallback& progress_;
  double last_step_ = 0.0;  ///< size of the last accepted step, in time, load factor or along the path
};

/// Makes the analysis that the scene selects.
std::unique_ptr<Analysis> make_analysis(const Parts& parts);

/// A pointer that copies its object by clone().
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
