/// Rotations without inertia at the start: sections of beams whose rotary inertia is zero.
#include "bough/step/residual_rate.hpp"
#include "first_order.hpp"
#include "start_parts.hpp"

namespace bough::step {

namespace {

constexpr double brief = 1e-3;  ///< tau over h

/// Velocities of all nodes, changed by a motion as a vector of unknowns.
void add_to_velocities(const System& system, State& state, const std::vector<double>& x) {
  state.change_all([&]<class G>(NodesOn<G>& nodes) {
    for (std::size_t n = 0; n < nodes.motion.size(); ++n)
      nodes.motion[n].v += system.places().part_on<G>(x.data(), static_cast<int>(n));
  });
}

}  // namespace

elements::Slopes start_slopes(const System& system, double step_size) {
  if (!system.plan().has_massless_rotations || !(step_size > 0.0)) return {0.0, 0.0, true};
  const double tau = brief * step_size;
  return {1.0 / step_size, 1.0 / (tau * tau), false, FirstOrderRule(0.0, tau).slope(), system.plan().signals_drive};
}

std::optional<Trouble> place_massless(System& system, State& state, double step_size) {
  const elements::Slopes slopes = start_slopes(system, step_size);
  if (slopes.mass_only) return std::nullopt;
  constexpr int most = 12;
  constexpr double small = 1e-13;  // relative motions that are round-off
  std::vector<double> x(system.places().size());
  double previous = 0.0;
  for (int k = 0; k < most; ++k) {
    system.signals().follow_motion(state);
    if (auto t = system.evaluate(state, slopes, true)) return t;
    if (auto t = system.linear().factor(k == 0, slopes)) return t;
    if (auto t = system.linear().solve(system.right_hand_side().data(), x.data())) return t;
    const double change = system.corrections().apply(state, x.data());
    if (change < small || (k > 2 && change > 0.5 * previous)) return std::nullopt;
    previous = change;
  }
  return std::nullopt;
}

std::optional<Trouble> turn_massless(System& system, State& state, double step_size) {
  const elements::Slopes slopes = start_slopes(system, step_size);
  if (slopes.mass_only) return std::nullopt;
  constexpr int refined = 2;  // the second solution takes back what masses moved in the first
  std::vector<double> rate, x(system.places().size());
  std::vector<lanes::Taylor<double, 3>> series;
  for (int k = 0; k < refined; ++k) {
    system.signals().follow_motion(state);
    evaluate_rate(system, state, rate, step_size);
    system.constraints().series(state, nullptr, 0.0, series);
    for (double& r : rate) r = -r;
    for (const std::size_t s : system.places().signals()) rate[s] = 0.0;
    for (const UnknownPlaces::Multiplier& at : system.places().multipliers())
      rate[at.unknown] = -series[at.multiplier].c[1];
    if (auto t = system.linear().solve(rate.data(), x.data())) return t;
    add_to_velocities(system, state, x);
  }
  return std::nullopt;
}

}  // namespace bough::step
