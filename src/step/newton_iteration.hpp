#pragma once
/// Newton's method for a step in time, with a factor that serves over iterations and steps.
#include "newton.hpp"

namespace bough::step {

/// What Newton's iteration of one step knows and decides. The loop itself is `iterate`.
class NewtonIteration {
 public:
  NewtonIteration(System& system, const StepOptions& options, const IterationGoal& goal,
                  const elements::Slopes& slopes);

  /// Evaluates the residual, for the first correction with the tangent where a new factor is due.
  [[nodiscard]] std::optional<Trouble> evaluate(const State& state);
  /// Whether the residual just evaluated ends the iteration: the state is whole, or what is left of the residual is
  /// round-off.
  bool is_converged();
  /// Why the iteration is given up, if it is: too many corrections, or growing ones.
  std::optional<Trouble> give_up();
  /// Makes a new factor where the one at hand contracts too slowly, or does not belong to these slopes.
  [[nodiscard]] std::optional<Trouble> renew_factor(const State& state);
  /// Solves for the correction and applies it.
  [[nodiscard]] std::optional<Trouble> correct(State& state);
  /// Whether the correction just applied ends the iteration, since changes and residuals shrink on as they did, so
  /// that the residual which it leaves need not be evaluated.
  bool will_be_converged();

  /// The report of an iteration that has converged, or failed for a cause.
  const StepReport& converge();
  const StepReport& fail(const Trouble& trouble);

 private:
  int count() const { return report_.iterations; }
  bool is_settled_at(double error, double share = 1.0) const;
  bool is_noise_at(double expected) const;
  bool contracts_slowly() const;

  System& system_;
  const StepOptions& options_;
  const IterationGoal& goal_;
  const elements::Slopes& slopes_;
  StepReport report_;
  bool may_reuse_;
  double negligible_;      ///< change of relative motions that may be left
  bool fresh_;             ///< the next solution gets a new factor
  bool is_own_ = false;    ///< the factor at hand was made in this step
  int served_ = 0;         ///< solutions in this step with the factor at hand
  double previous_ = 0.0;  ///< the change before the last
  double size_ = 0.0;      ///< the residual's largest share
  double expected_ = 0.0;  ///< what the last solution was to leave of that
  /// Ratios of the last two changes and of the last two residuals. A factor that served before contracts as it did; of
  /// a new one nothing is known at first.
  double rate_, shrunk_ = 0.0;
  double contraction_;  ///< the last ratio of changes that is not round-off
};

/// Repeats: evaluate the residual, stop when converged, renew the factor where it is due, correct. `follow(state)`
/// brings velocities and accelerations along with the positions.
template <class Follow>
StepReport iterate(System& system, State& state, const StepOptions& options, const IterationGoal& goal,
                   const elements::Slopes& slopes, Follow&& follow) {
  NewtonIteration newton(system, options, goal, slopes);
  for (;;) {
    if (const auto t = newton.evaluate(state)) return newton.fail(*t);
    if (newton.is_converged()) return newton.converge();
    if (const auto t = newton.give_up()) return newton.fail(*t);
    if (const auto t = newton.renew_factor(state)) return newton.fail(*t);
    if (const auto t = newton.correct(state)) return newton.fail(*t);
    if (const std::optional<Trouble> t = follow(state)) return newton.fail(*t);
    if (newton.will_be_converged()) return newton.converge();
  }
}

}  // namespace bough::step
