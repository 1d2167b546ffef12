#include <cmath>

#include "bough/motion/vectors_on.hpp"
#include "bough/step/advance.hpp"
#include "bough/step/residual_rate.hpp"
#include "drift.hpp"
#include "element_parts.hpp"
#include "first_order.hpp"
#include "start_parts.hpp"

namespace bough::step {

using lanes::Taylor;

namespace {

template <class G>
typename G::template Vector<double> part_on(const System& system, const std::vector<double>& x, std::size_t node) {
  return system.places().part_on<G>(x.data(), static_cast<int>(node));
}

constexpr double closed = 1e-13;  ///< relative constraint violation below which no further correction is made
constexpr double open =
    1e-9;  ///< a remaining violation above this, relative to the parts at the joint, means contradictory constraints
constexpr double apart = 1e-8;   ///< the same for rates of constraints, relative to the largest speed
constexpr double still = 1e-12;  ///< relative violation that a rate may cause in one step at rest: round-off of drives

/// Copies values by multiplier into the constraint rows of a vector of unknowns: to[unknown of multiplier m] = from(m).
template <class From>
void set_rows(const System& system, std::vector<double>& to, From&& from) {
  for (const UnknownPlaces::Multiplier& at : system.places().multipliers()) to[at.unknown] = from(at.multiplier);
}

/// Evaluates and factors the matrix of a start at the present positions.
std::optional<Trouble> factor_mass(System& system, const State& state, double step_size) {
  const elements::Slopes slopes = start_slopes(system, step_size);
  if (auto t = system.evaluate(state, slopes, true)) return t;
  return system.linear().factor(true, slopes);
}

/// Names the joints whose constraints contradict each other, for a message.
std::string contradicting(const System& system, int worst, const std::vector<int>& blocks) {
  std::string text = system.plan().joints.empty()
                         ? ""
                         : system.plan().joints[static_cast<std::size_t>(worst)].what + " '" +
                               system.plan().joints[static_cast<std::size_t>(worst)].name + "'";
  std::string others;
  int named = 0;
  for (int b : blocks) {
    const int j = system.linear().owners().joint(b);
    if (j < 0 || j == worst) continue;
    others += (named++ == 0 ? "" : ", ") + ("'" + system.plan().joints[static_cast<std::size_t>(j)].name + "'");
    if (named == 8) break;
  }
  if (named > 0) text += " contradicts " + others + " (their constraints depend on each other)";
  return text;
}

/// Largest entry of the vectors get(n) of all nodes, lengths relative to the size of the structure.
template <class G, class Get>
double largest_entry(const System& system, Get&& get) {
  double most = 0.0;
  for (std::size_t n = 0; n < system.plan().nodes.size(); ++n) {
    const typename G::template Vector<double> v = get(n);
    for (int i = 0; i < G::dof; ++i)
      most = std::max(most, std::abs(v[i]) / (i < G::translations ? system.plan().length_scale : 1.0));
  }
  return most;
}
/// Largest speed, lengths relative to the size of the structure [1/s].
double speed_scale(const System& system, const State& state) {
  return state.visit([&]<class G>(const NodesOn<G>& nodes) {
    return largest_entry<G>(system, [&](std::size_t n) { return nodes.motion[n].v; });
  });
}

/// Projects velocities to those that satisfy the constraints (with rates `offset` by multiplier, if given) and are
/// nearest in the mass metric. The mass matrix must be factored. `report` receives the size of the change.
std::optional<Trouble> project_velocities(System& system, State& state, const std::vector<double>* offset,
                                          StartReport* report, double step_size) {
  std::vector<double> rhs(system.places().size(), 0.0), x(system.places().size());
  std::vector<Taylor<double, 3>> series;
  system.constraints().series(state, nullptr, 0.0, series);
  set_rows(system, rhs, [&](std::size_t m) { return -series[m].c[1] + (offset != nullptr ? (*offset)[m] : 0.0); });
  if (auto t = system.linear().solve(rhs.data(), x.data())) return t;
  if (report != nullptr) {
    const double before = speed_scale(system, state);
    const double change = state.visit([&]<class G>(const NodesOn<G>&) {
      return largest_entry<G>(system, [&](std::size_t n) { return part_on<G>(system, x, n); });
    });
    report->velocity_change = change > 0.0 ? change / std::max(before, change) : 0.0;
    const elements::Slopes slopes = start_slopes(system, step_size);
    const double of_impulse = slopes.mass_only ? 1.0 : 1.0 / slopes.acceleration;
    for (const UnknownPlaces::Multiplier& at : system.places().multipliers())
      report->velocity_impulse = std::max(report->velocity_impulse, of_impulse * std::abs(x[at.unknown]));
    report->velocity_impulse = std::max(report->velocity_impulse, system.largest_held_impulse(state, x.data()));
  }
  state.change_all([&]<class G>(NodesOn<G>& nodes) {
    for (std::size_t n = 0; n < nodes.motion.size(); ++n) nodes.motion[n].v += part_on<G>(system, x, n);
  });
  return std::nullopt;
}

/// Computes G d by multiplier, d being a motion as a vector of unknowns. The present element matrices must contain G.
void eval_rates(System& system, const std::vector<double>& d, std::vector<double>& rates) {
  std::vector<double> product(system.places().size());
  system.linear().multiply(d.data(), product.data());
  rates.assign(static_cast<std::size_t>(system.plan().num_multipliers), 0.0);
  for (const UnknownPlaces::Multiplier& at : system.places().multipliers()) rates[at.multiplier] = product[at.unknown];
}

/// Sets dq, and if asked for dv/dt, of all nodes to zero.
void set_unmoved(State& state, bool with_accelerations) {
  state.change_all([&]<class G>(NodesOn<G>& nodes) {
    for (auto& n : nodes.motion) {
      n.dq = NodesOn<G>::Vector::zero();
      n.drift = {};
      if (with_accelerations) n.a = n.dq;
    }
  });
}

StartReport failed(const std::string& cause) {
  StartReport r;
  r.cause = cause;
  return r;
}

}  // namespace

std::optional<Trouble> set_normal_velocities(System& system, State& state, const std::vector<double>* d,
                                             double step_size) {
  if (auto t = factor_mass(system, state, step_size)) return t;
  std::vector<double> offset;
  if (d != nullptr) eval_rates(system, *d, offset);
  return project_velocities(system, state, d != nullptr ? &offset : nullptr, nullptr, step_size);
}

std::optional<Trouble> solve_accelerations(System& system, State& state, double step_size) {
  std::vector<double> rhs(system.places().size()), x(system.places().size());
  std::vector<Taylor<double, 3>> series;
  state.change_all([](auto& nodes) {
    for (auto& n : nodes.motion) n.a = std::decay_t<decltype(nodes)>::Vector::zero();
  });
  std::fill(state.multipliers.begin(), state.multipliers.end(), 0.0);
  system.signals().follow_motion(state);
  elements::Slopes slopes = start_slopes(system, step_size);
  if (slopes.mass_only) {
    if (auto t = system.evaluate(state, slopes, false)) return t;
  } else {
    slopes.velocity = 2.0 / step_size;
    slopes.acceleration = slopes.velocity * slopes.velocity;
    if (auto t = system.evaluate(state, slopes, true)) return t;
    if (auto t = system.linear().factor(true, slopes)) return t;
  }
  system.constraints().series(state, nullptr, 0.0, series);
  rhs = system.right_hand_side();
  if (!slopes.mass_only) {
    for (double& r : rhs) r *= slopes.acceleration;
    for (const std::size_t s : system.places().signals()) rhs[s] = 0.0;
  }
  set_rows(system, rhs, [&](std::size_t m) { return -2.0 * series[m].c[2]; });
  if (auto t = system.linear().solve(rhs.data(), x.data())) return t;
  state.change_all([&]<class G>(NodesOn<G>& nodes) {
    for (std::size_t n = 0; n < nodes.motion.size(); ++n) nodes.motion[n].a = part_on<G>(system, x, n);
  });
  for (const UnknownPlaces::Multiplier& at : system.places().multipliers())
    state.multipliers[at.multiplier] = slopes.mass_only ? x[at.unknown] : x[at.unknown] / slopes.acceleration;
  system.recover_multipliers(state);
  if (system.plan().signals_read_multipliers) system.signals().follow_motion(state);
  return std::nullopt;
}

StartReport make_consistent(System& system, State& state, bool fix_positions, double step_size) {
  return make_consistent_on(system, state, fix_positions, step_size, laws::Side::right);
}

StartReport make_consistent_on(System& system, State& state, bool fix_positions, double step_size, laws::Side side) {
  StartReport report;
  if (const auto t = system.set_time(state.time, side)) return failed(t->text);
  set_unmoved(state, true);
  system.signals().follow_motion(state);
  std::vector<double> rhs(system.places().size(), 0.0), x(system.places().size());
  int worst = 0;

  if (const auto t = factor_mass(system, state, step_size)) return failed(t->text);
  double gap = system.constraints().relative_violation(state, 0, &worst);
  report.gap = gap;
  report.open_joint = gap > 0.0 ? worst : -1;
  for (int k = 0; fix_positions && gap > closed && k < 30; ++k) {
    std::vector<Taylor<double, 3>> series;
    system.constraints().series(state, nullptr, 0.0, series);
    std::fill(rhs.begin(), rhs.end(), 0.0);
    set_rows(system, rhs, [&](std::size_t m) { return -series[m].c[0]; });
    if (const auto t = system.linear().solve(rhs.data(), x.data())) return failed(t->text);
    set_rows(system, x, [](std::size_t) { return 0.0; });  // the impulses of this projection are not reactions
    State trial = state;
    const double change = system.corrections().apply(trial, x.data());
    const double next = system.constraints().relative_violation(trial, 0, &worst);
    if (!(next < gap)) break;  // round-off prevents a smaller violation
    report.position_correction = std::max(report.position_correction, change);
    state = std::move(trial);
    gap = next;
    if (const auto t = factor_mass(system, state, step_size)) return failed(t->text);
  }
  const double disagreement = system.plan().disagreement();
  if (gap > std::max(open, disagreement)) {
    char text[80];
    std::snprintf(text, sizeof text, " cannot be closed at time %.6g: a gap of %.3g is left", state.time,
                  system.constraints().violation(state, 0));
    return failed(contradicting(system, worst, system.linear().solver().blocks_not_unique()) + text +
                  (fix_positions ? "" : "; what drives it jumps there"));
  }
  if (const auto t = place_massless(system, state, step_size)) return failed(t->text);
  set_unmoved(state, false);

  if (const auto t = turn_massless(system, state, step_size)) return failed(t->text);
  double speed = speed_scale(system, state);
  if (const auto t = project_velocities(system, state, nullptr, &report, step_size)) return failed(t->text);
  speed = std::max(speed, speed_scale(system, state));
  if (report.velocity_change * speed <= still / step_size) report.velocity_change = 0.0;
  if (system.constraints().relative_violation(state, 1, &worst) >
      std::max(apart, disagreement) * speed + still / step_size) {
    char text[80];
    std::snprintf(text, sizeof text, " cannot move as asked at time %.6g: a rate of %.3g is left", state.time,
                  system.constraints().violation(state, 1));
    return failed(contradicting(system, worst, system.linear().solver().blocks_not_unique()) + text);
  }

  if (const auto t = solve_accelerations(system, state, step_size)) return failed(t->text);
  report.ok = true;
  return report;
}

namespace {

/// Twist of the frame relative to which generalized-alpha describes a node, with two derivatives, in the node's axes.
template <class G>
struct FrameRates {
  typename G::template Vector<double> twist = G::template Vector<double>::zero(), twist_rate = twist, jerk = twist;
};
/// That of the step that begins with these nodes.
template <class G>
FrameRates<G> frame_of(System& system, const std::vector<typename G::template Translation<double>>& frames,
                       const NodesOn<G>& nodes, std::size_t n) {
  FrameRates<G> frame;
  if constexpr (G::turns) {
    const auto& choice = std::get<DriftChoice<G>>(system.work().drift_choice);
    if (choice.eights.empty()) return frame;
    const NodeOrder::Place at = system.node_order()->place(n);
    const auto& node = nodes.motion[n];
    const int assembly = choice.eights[at.eight].assembly[static_cast<std::size_t>(at.lane)];
    auto velocity = G::template Translation<double>::zero();
    if (assembly >= 0) velocity = frames[static_cast<std::size_t>(assembly)];
    const Drift<G, double> drift =
        drift_at<G, double>({node.R, G::template Translation<double>::zero()}, velocity, choice.fall);
    const auto rate = drift.rate(node.v), second = drift.second(node.v, node.a);
    for (int i = 0; i < G::translations; ++i) {
      frame.twist[i] = drift.velocity[i];
      frame.twist_rate[i] = rate[i];
      frame.jerk[i] = second[i];
    }
  }
  return frame;
}

}  // namespace

StartReport start_alpha(System& system, State& state, const StepOptions& options, double h) {
  const AlphaCoefficients c = make_alpha_coefficients(options.spectral_radius);
  const FirstOrderRule states(options.spectral_radius, h);
  set_unmoved(state, false);
  // (M + O(h^2) K) jerk + G^T lambda' = -(residual)',  G jerk = -Phi'''|_{jerk = 0}, with the step's own matrix:
  // modes faster than the step are filtered, smooth ones change by O(h) only.
  const double acceleration = (1.0 - c.alpha_m) / ((1.0 - c.alpha_f) * c.beta * h * h);
  // Rows take third derivatives of signals from their series: the unknown of a state is its second one.
  elements::Slopes slopes{c.gamma / (c.beta * h), acceleration, false, states.slope(), system.plan().signals_drive};
  std::vector<double> rate, rhs(system.places().size()), x(system.places().size());
  std::vector<Taylor<double, 3>> series;
  // Unknown is the part of v'' that is left relative to the frames of the first step, of which free flight has none.
  std::vector<double> frame_jerk(system.places().size(), 0.0), of_frames;
  state.change_all([&]<class G>(NodesOn<G>& nodes) {
    const auto& choice = std::get<DriftChoice<G>>(system.work().drift_choice);
    slopes.drifts = !choice.eights.empty();
    slopes.falls = choice.falls;
    auto& frames = std::get<DriftedStart<G>>(system.work().drifted).frames;
    find_frames<G>(choice, nodes, *system.node_order(), frames);
    for (std::size_t n = 0; n < nodes.motion.size(); ++n) {
      const FrameRates<G> frame = frame_of(system, frames, nodes, n);
      system.places().set_node_part(frame_jerk.data(), static_cast<int>(n), frame.jerk);
      if constexpr (G::turns) nodes.motion[n].drift = G::linear(frame.twist);
    }
  });
  evaluate_rate(system, state, rate, h, &frame_jerk);
  system.constraints().series(state, nullptr, h, series);
  std::vector<double> second_rates;
  std::vector<lanes::Taylor<double, 1>> law_rates = system.instant().rate_series();
  system.signals().add_rates(state, law_rates, second_rates);
  if (const auto t = system.evaluate(state, slopes, true)) return failed(t->text);
  if (const auto t = system.linear().factor(true, slopes)) return failed(t->text);
  for (std::size_t i = 0; i < rhs.size(); ++i) rhs[i] = -acceleration * rate[i];
  eval_rates(system, frame_jerk, of_frames);
  set_rows(system, rhs, [&](std::size_t m) { return -6.0 * series[m].c[3] - of_frames[m]; });
  if (const auto t = system.linear().solve(rhs.data(), x.data())) return failed(t->text);
  // In this scaling an unknown of a state is s'' times a ratio of slopes; other signals were differentiated already.
  SignalValues& signals = state.signals;
  for (std::size_t i = 0; i < signals.value.size(); ++i) {
    const bool is_state = system.plan().signals[i].is_state();
    const bool drives = i < system.places().signals().size();
    const double second = !is_state ? 0.0
                          : drives  ? states.slope() / acceleration * x[system.places().signals()[i]]
                                    : second_rates[i];
    signals.algorithmic[i] = signals.rate[i] + states.shift() * h * second;
    signals.trend[i] = h * second;
  }
  // Steady velocity error of the index-3 scheme in the constraints' normals: local error of dq against the Magnus
  // series of the motion,
  //   G delta = -h^2 G ((beta + shift/2 - 1/6) jerk - ad(v) a / 12).
  std::vector<double>& steady_error = rhs;
  state.change_all([&]<class G>(NodesOn<G>& nodes) {
    std::fill(steady_error.begin(), steady_error.end(), 0.0);
    const auto& frames = std::get<DriftedStart<G>>(system.work().drifted).frames;
    for (auto* known : {&nodes.algorithmic, &nodes.acceleration_trend, &nodes.trend_change})
      known->assign_zero(system.node_order());
    for (std::size_t n = 0; n < nodes.motion.size(); ++n) {
      const auto& node = nodes.motion[n];
      const typename NodesOn<G>::Vector jerk = part_on<G>(system, x, n);
      const FrameRates<G> frame = frame_of(system, frames, nodes, n);
      nodes.algorithmic.set(n, node.a + (c.shift() * h) * typename NodesOn<G>::Vector(jerk + frame.jerk));
      nodes.acceleration_trend.set(n, h * jerk);
      system.places().set_node_part(
          steady_error.data(), static_cast<int>(n),
          typename NodesOn<G>::Vector(
              (-h * h) *
              (c.error_of_increments() * jerk - (1.0 / 12.0) * motion::VectorsOn<G>::template bracket<double>(
                                                                   node.v - frame.twist, node.a - frame.twist_rate))));
    }
  });
  state.step_size = h;
  state.predictor_order = 1;
  state.local_error = state.increment = state.velocity_error = 0.0;
  state.multiplier_trend.assign(state.multipliers.size(), 0.0);
  state.multiplier_trend_change.assign(state.multipliers.size(), 0.0);
  state.multiplier_order = 0;
  StartReport report;
  report.ok = true;
  if (system.plan().num_multipliers == 0) return report;
  if (const auto t = set_normal_velocities(system, state, &steady_error, h)) return failed(t->text);
  return report;
}

StartReport change_step_size(System& system, State& state, const StepOptions& options, double h) {
  StartReport report;
  report.ok = true;
  if (h == state.step_size) return report;
  if (const auto t = system.set_time(state.time, laws::Side::right)) return failed(t->text);
  return start_alpha(system, state, options, h);
}

}  // namespace bough::step
