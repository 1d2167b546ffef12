#include "bough/step/signal_series.hpp"

#include <algorithm>

#include "bough/blocks/at.hpp"
#include "bough/elements/reading.hpp"

namespace bough::step {

namespace {

using plan::SignalRule;

/// Whether a signal is made of others at the same instant.
bool is_made(const plan::SignalPlan& s) {
  return s.rule == SignalRule::function || s.rule == SignalRule::surface || s.rule == SignalRule::formula;
}

/// Value, rate and acceleration of a series at a time ahead.
laws::LawValue at_time(const lanes::Taylor<double, 3>& s, double t) {
  return {s.c[0] + t * (s.c[1] + t * (s.c[2] + t * s.c[3])), s.c[1] + t * (2.0 * s.c[2] + 3.0 * t * s.c[3]),
          2.0 * s.c[2] + 6.0 * t * s.c[3]};
}

}  // namespace

SignalSeries::SignalSeries(const plan::Plan& plan) : plan_(plan) {
  std::size_t most = 0;
  for (const plan::SignalPlan& s : plan.signals) most = std::max(most, s.inputs.size());
  motions_.resize(most);
}

laws::LawValue SignalSeries::along(const plan::SignalPlan& s, const Instant::Series& laws, double ahead) {
  for (std::size_t k = 0; k < s.inputs.size(); ++k) motions_[k] = at_time(laws[at(s.inputs[k])], ahead);
  if (s.rule == SignalRule::surface) return s.surface.along(motions_[0], motions_[1]);
  if (s.rule != SignalRule::function) return s.formula.along({motions_.data(), s.inputs.size()});
  const laws::LawValue& u = motions_[0];
  const laws::LawValue f = s.function.at(u.value, u.rate < 0.0 ? laws::Side::left : laws::Side::right);
  return {f.value, f.rate * u.rate, f.acceleration * u.rate * u.rate + f.rate * u.acceleration};
}

void SignalSeries::complete(const State& state, const elements::Field& field, double step_size, Instant::Series& laws) {
  for (std::size_t i = 0; i < plan_.signals.size(); ++i) {
    const plan::SignalPlan& s = plan_.signals[i];
    const double turns = s.joint < 0 ? 0.0 : state.turns[at(s.joint)];
    laws[at(s.law)] = s.rule == SignalRule::coordinate ? elements::eval_reading_series(s.reading, field, turns)
                                                       : lanes::Taylor<double, 3>(state.signals.value[i]);
  }
  const auto follow = [&] {
    for (const plan::SignalPlan& s : plan_.signals) {
      if (!is_made(s)) continue;
      const laws::LawValue f = along(s, laws, 0.0);
      lanes::Taylor<double, 3>& to = laws[at(s.law)];
      to.c[0] = f.value;
      to.c[1] = f.rate;
      to.c[2] = 0.5 * f.acceleration;
    }
  };
  for (int k = 0; k < 3; ++k) {  // x^(k+1) of states from the k-th derivatives of what their rates are made of
    follow();
    for (const plan::SignalPlan& s : plan_.signals) {
      if (!s.is_state() || !plan_.is_dynamic) continue;
      const laws::LawValue f = along(s, laws, 0.0);
      laws[at(s.law)].c[k + 1] = k == 0 ? f.value : k == 1 ? 0.5 * f.rate : f.acceleration / 6.0;
    }
  }
  follow();
  if (!(step_size > 0.0)) return;
  for (const plan::SignalPlan& s : plan_.signals)
    if (is_made(s))
      laws[at(s.law)].c[3] = (along(s, laws, step_size).acceleration - 2.0 * laws[at(s.law)].c[2]) / (6.0 * step_size);
}

}  // namespace bough::step
