#pragma once
/// Signals as functions of time along the motion of a state, as far as they drive rows of joints: their rates and
/// accelerations are what rows are differentiated by at a start.
#include <vector>

#include "bough/step/instant.hpp"

namespace bough::step {

class SignalSeries {
 public:
  explicit SignalSeries(const plan::Plan& plan);

  /// Completes the series of all laws by those of signals. Exact up to the second derivative for signals that can drive
  /// rows: they follow from states, time and inputs, and the rates of those states also from positions. The third is
  /// that of states; of others it is a one-sided difference over `step_size`, as that of laws is, and 0 where that is
  /// 0. Signals that follow from rates or forces are taken as constant. Does not allocate.
  void complete(const State& state, const elements::Field& field, double step_size, Instant::Series& laws);

 private:
  laws::LawValue along(const plan::SignalPlan& signal, const Instant::Series& laws, double ahead);

  const plan::Plan& plan_;
  std::vector<laws::LawValue> motions_;  ///< scratch: of the inputs of one signal
};

}  // namespace bough::step
