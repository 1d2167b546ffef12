#pragma once
/// Newton's method for one step in time. A factorization of the Jacobian is reused over iterations and steps.
#include "newton.hpp"

namespace bough::step {

/// The state and the decisions of Newton's iteration in one step: convergence, divergence, and when the Jacobian is
/// factored anew. The loop itself is `iterate`.
class NewtonIteration {
 public:
  NewtonIteration(System& system, const StepOptions& options, const IterationGoal& goal,
                  const elements::Slopes& slopes);

  /// Evaluates the residual and, if factors may be reused, condenses the right-hand side. Before the first correction
  /// it also evaluates and factors the tangents if a new factorization is due.
  [[nodiscard]] std::optional<Trouble> evaluate(const State& state);
  /// Whether the residual just evaluated ends the iteration: it and the expected next correction are small enough, or
  /// the residual is round-off.
  bool is_converged();
  /// The reason to abandon the iteration, if there is one: too many corrections, or corrections that grow.
  std::optional<Trouble> give_up();
  /// Evaluates and factors the Jacobian anew, in another upward walk, if the present factorization contracts too slowly
  /// or was made with other slopes.
  [[nodiscard]] std::optional<Trouble> renew_factor(const State& state);
  /// Solves the linear system for the Newton correction in a downward walk, whose visits apply it by `correct(visit)`,
  /// and takes its size.
  [[nodiscard]] std::optional<Trouble> solve(solve::VisitWork correct);
  /// Whether the iteration ends with the correction just applied: the residual that it leaves, predicted from the rates
  /// at which corrections and residuals have shrunk, is small enough and need not be evaluated.
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
  double negligible_;      ///< remaining change of relative motions that is neglected
  bool fresh_;             ///< the next solution needs a new factorization
  bool is_own_ = false;    ///< the present factorization was made in this step
  int served_ = 0;         ///< solutions in this step with the present factorization
  double previous_ = 0.0;  ///< size of the correction before the last
  double size_ = 0.0;      ///< relative size of the residual (largest_share)
  double expected_ = 0.0;  ///< prediction of size_ after the last correction
  /// Ratios of the last two corrections and of the last two residuals. The initial rate of a factorization from an
  /// earlier step is the one observed there; that of a new factorization is unknown (1).
  double rate_, shrunk_ = 0.0;
  double contraction_;  ///< last ratio of corrections above round-off
};

/// Newton's loop: evaluate the residual, stop when converged, factor anew where that is due, solve, correct. An
/// iteration is two walks over the sub-domains. On the way up each evaluates its elements and condenses its right-hand
/// side, or its matrix as well; on the way down it gets its part x of the solution and applies it by
/// `correction.apply_in_visit(visit, state, x)`: nodes move, velocities and accelerations follow by the formulas of the
/// integrator, multipliers grow. `correction.complete(state, x)` does what is left and judges the result.
template <class Correction>
StepReport iterate(System& system, State& state, const StepOptions& options, const IterationGoal& goal,
                   const elements::Slopes& slopes, const Correction& correction) {
  NewtonIteration newton(system, options, goal, slopes);
  const PhaseChain chain(system.clock());
  system.corrections().note_held(state);
  const double* const x = system.work().x.data();
  auto correct = [&](int visit) { correction.apply_in_visit(visit, state, x); };
  for (;;) {
    if (const auto t = newton.evaluate(state)) return newton.fail(*t);
    if (newton.is_converged()) return newton.converge();
    if (const auto t = newton.give_up()) return newton.fail(*t);
    if (const auto t = newton.renew_factor(state)) return newton.fail(*t);
    state.begin_change();
    if (const auto t = newton.solve(solve::make_visit_work(correct))) return newton.fail(*t);
    if (const std::optional<Trouble> t = correction.complete(state, x)) return newton.fail(*t);
    system.make_least(state);
    if (newton.will_be_converged()) return newton.converge();
  }
}

}  // namespace bough::step
