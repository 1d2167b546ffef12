#pragma once
/// The formulas of one step of generalized-alpha, for motion vectors in space or in a plane. Internal to step.
#include <cmath>

#include "bough/elements/evaluate.hpp"
#include "bough/step/options.hpp"
#include "first_order.hpp"

namespace bough::step {

/// One step of size h [s]: velocities and accelerations as functions of the increment dq, the predicted dq, and the
/// local error. V is a motion vector of doubles or packs.
struct AlphaRule {
  AlphaCoefficients c;
  double h;
  FirstOrderRule states;  ///< for states of signals
  bool drifts = false;    ///< nodes turn: the rule applies relative to frames that drift (drift.hpp)
  bool falls = false;     ///< these frames fall with gravity

  template <class V>
  struct Rates {
    V v, a, algorithmic;  ///< velocity, its derivative, a_n of the method
  };

  elements::Slopes slopes() const {
    return {c.gamma / (c.beta * h),
            (1.0 - c.alpha_m) / ((1.0 - c.alpha_f) * c.beta * h * h),
            false,
            states.slope(),
            false,
            drifts,
            falls};
  }

  /// Acceleration-like variable, velocity and acceleration at the end of the step as functions of dq:
  ///   a_{n+1} = (dq - h v_n) / (beta h^2) - (1/2 - beta)/beta a_n
  ///   v_{n+1} = v_n + h ((1 - gamma) a_n + gamma a_{n+1})
  ///   dv/dt_{n+1} = ((1 - alpha_m) a_{n+1} + alpha_m a_n - alpha_f dv/dt_n) / (1 - alpha_f)
  template <class V>
  Rates<V> follow(const V& dq, const V& v, const V& a, const V& algorithmic) const {
    const double of_dq = 1.0 / (c.beta * h * h), of_a = (0.5 - c.beta) / c.beta, share = 1.0 / (1.0 - c.alpha_f);
    const V next = of_dq * V(dq - h * v) - of_a * algorithmic;
    return {v + h * V((1.0 - c.gamma) * algorithmic + c.gamma * next),
            share * V((1.0 - c.alpha_m) * next + c.alpha_m * algorithmic - c.alpha_f * a), next};
  }

  /// Local error e_q of step_control.hpp without the filter for stiff parts. `change` is the change of dv/dt over the
  /// step, `bracket` is ad(v) dv/dt.
  template <class V>
  V local_error(const V& change, const V& bracket) const {
    return (h * h * c.error_of_increments()) * change - (h * h * h / 12.0) * bracket;
  }

  /// The change of dq that amounts to the local error e_v of velocities, again without the filter. `of_change`, the
  /// difference of the last two changes of dv/dt, estimates h^2 v'''. Velocities change with dq by gamma / (beta h).
  double velocity_error(double of_change) const {
    return h * h * (c.beta / c.gamma) * std::abs(c.error_of_velocities()) * of_change;
  }

  /// The increment dq of a step over which dv/dt changes by `change`.
  template <class V>
  V predict(const V& v, const V& a, const V& algorithmic, const V& change) const {
    const V next = (1.0 / (1.0 - c.alpha_m)) * V(a + (1.0 - c.alpha_f) * change - c.alpha_m * algorithmic);
    return h * v + (h * h) * V((0.5 - c.beta) * algorithmic + c.beta * next);
  }
};

/// Change of a quantity over the next step, extrapolated by the polynomial of order 0, 1 or 2 through its values at the
/// ends of past steps of the same size. `change` is its change over the last step, `of_change` the difference of the
/// last two changes.
template <class V>
V predicted_change(int order, const V& change, const V& of_change) {
  return order == 2 ? V(change + of_change) : order == 1 ? change : V::zero();
}

}  // namespace bough::step
