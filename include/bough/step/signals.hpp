#pragma once
/// Signals as unknowns (plan::SignalPlan): each has one equation, s - f = 0, or s' - f = 0 for a state, f being a
/// reading of the motion, a law of another signal or a formula of others. The equations are solved together with those
/// of motion, so that no signal lags behind the motion that it reads, and the tangent holds all derivatives.
#include <vector>

#include "bough/lanes/taylor.hpp"
#include "bough/step/instant.hpp"
#include "bough/step/linear_solution.hpp"
#include "bough/step/residual_sums.hpp"
#include "bough/step/unknown_places.hpp"

namespace bough::step {

class Signals {
 public:
  Signals(const plan::Plan& plan, const Instant& instant, const UnknownPlaces& places, LinearSolution& linear);

  /// Whether there are none that are unknowns of the system.
  bool are_none() const { return plan_.num_driving_signals == 0; }
  /// Writes the residuals of all equations to `sums` and, if `tangent`, their matrices to the solver. With
  /// Slopes::mass_only the unknown of a state is its rate and motions stand still: all signals follow from the present
  /// motion, so the matrices are ones on the diagonal.
  void evaluate(const State& state, const elements::Slopes& slopes, bool tangent, ResidualSums& sums);
  /// Computes all signals but the states, and the rates of states, from the motion and the states.
  void follow_motion(State& state);
  /// Computes the signals that only observe, of an accepted state. Their states solve s' = f with s' = slope s + c, of
  /// which the present value and rate tell c; slope 0: s' = 0. Does not touch what drives the motion. Allocates nothing.
  void observe(State& state, double slope) {
    if (static_cast<std::size_t>(plan_.num_driving_signals) < plan_.signals.size()) observe_all(state, slope);
  }
  /// Completes a series of all laws by the values of signals and their rates along the motion. second: receives the
  /// second derivatives of states, s'' = df/dt, by signal; zero for others.
  void add_rates(const State& state, std::vector<lanes::Taylor<double, 1>>& laws, std::vector<double>& second);

 private:
  /// Value of f and the sum of the magnitudes of its terms. Its derivatives are left in slopes_: by the increments of
  /// the nodes of both ports of a reading, or by the inputs.
  struct Value {
    double f = 0.0, magnitude = 0.0;
  };
  template <class G>
  Value eval(std::size_t signal, const State& state, const elements::FieldOn<G, double>& field);
  template <class G>
  double eval_rate(std::size_t signal, const State& state, const elements::FieldOn<G, double>& field,
                   const std::vector<lanes::Taylor<double, 1>>& laws);
  void put_matrix(std::size_t signal, const elements::Slopes& slopes);
  double size_of(const plan::SignalPlan& signal, double value, const elements::Slopes& slopes) const;
  double turns_of(const plan::SignalPlan& signal, const State& state) const;

  const plan::Plan& plan_;
  const Instant& instant_;
  const UnknownPlaces& places_;
  LinearSolution& linear_;
  template <class G>
  void follow(State& state, const elements::FieldOn<G, double>& field, std::size_t begin, std::size_t end);
  void observe_all(State& state, double slope);
  void add_observed_slopes(const plan::SignalPlan& signal, double* row) const;

  std::vector<double> inputs_, slopes_, row_;  ///< scratch, of one signal
  /// Signals that only observe: the nodes that they read, their states, and by signal the derivatives by these.
  std::vector<int> observed_nodes_;
  std::vector<std::size_t> observed_states_;
  std::vector<double> observed_slopes_, jacobian_, left_, residual_;
  std::vector<elements::NodeMotion> nodes_;  ///< scratch, in space
};

}  // namespace bough::step
