#include "bough/step/advance.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "bough/motion/vectors_on.hpp"
#include "element_parts.hpp"
#include "moving_nodes.hpp"
#include "newton_iteration.hpp"

namespace bough::step {

namespace {

/// Stores the largest of something in a range of eights.
void note_most(System& system, std::int64_t begin, std::int64_t end, double most) {
  std::vector<double>& all = system.work().eight_most;
  std::fill(all.begin() + begin, all.begin() + end, 0.0);
  all[static_cast<std::size_t>(begin)] = most;
}
double noted_most(System& system) {
  double most = 0.0;
  for (const double m : system.work().eight_most) most = std::max(most, m);
  return most;
}

template <class G>
Drifts<G> drifts_of(System& system) {
  return {std::get<DriftChoice<G>>(system.work().drift_choice), std::get<DriftedStart<G>>(system.work().drifted)};
}

/// The formulas of generalized-alpha applied to all nodes, for a step that begins at `start`.
struct AlphaStep {
  AlphaRule rule;
  const State& start;

  System& system;

  /// Applies a Newton correction to what a visit of the downward walk solves for: poses move, velocities and
  /// accelerations follow, multipliers grow.
  void apply_in_visit(int visit, State& state, const double* x) const {
    start.visit([&]<class G>(const NodesOn<G>& from) {
      NodesOn<G>& nodes = state.changing<G>();
      system.corrections().apply_in_visit<G>(
          visit, state, x, [&](std::int64_t begin, std::int64_t end, NodeChange<G>* changes) {
            note_most(system, begin, end,
                      correct_nodes(rule, drifts_of<G>(system), from, nodes, *system.node_order(),
                                    static_cast<std::size_t>(begin), static_cast<std::size_t>(end),
                                    system.places().increments(x), changes));
          });
    });
  }
  /// Signals and the rates of states.
  std::optional<Trouble> complete(State& state, const double* x) const {
    system.corrections().add_signals(state, x, 1.0);
    follow_states(system.plan(), state.signals);
    return judge_turn(state);
  }

  /// Signals that only observe, of the accepted state.
  void observe(State& state) const {
    system.signals().observe(state, rule.states.slope());
    follow_states(system.plan(), state.signals);
  }

  /// Predictor. It extrapolates dv/dt by the polynomial, of order 0, 1 or 2, that would have been most accurate in the
  /// last step; a_{n+1} and the other quantities follow from it. Multipliers are extrapolated likewise: with an
  /// up-to-date Jacobian the first solution would find them from any initial value, but with a stale one their error
  /// contracts only slowly. Writes all of `state`, its nodes in one pass.
  std::optional<Trouble> predict(State& state) const {
    state.step_size = start.step_size;
    system.corrections().predict_multipliers(start, state);
    state.turns = start.turns;
    predict_signals(system.plan(), state.signals);
    const NodeOrder& order = *system.node_order();
    system.work().eight_most.resize(order.eights().size());
    start.visit([&]<class G>(const NodesOn<G>& from) {
      NodesOn<G>& nodes = state.resize_as<G>(start);
      keep_held(from, nodes, order);
      const Drifts<G> drifts = drifts_of<G>(system);
      if (!drifts.choice.eights.empty()) find_frames<G>(drifts.choice, from, order, drifts.start.frames);
      auto some = [&](std::int64_t begin, std::int64_t end) {
        note_most(system, begin, end,
                  predict_nodes(rule, drifts, start.predictor_order, from, nodes, order,
                                static_cast<std::size_t>(begin), static_cast<std::size_t>(end)));
      };
      system.walker().for_each_chunk(order.by_visit().count(), eight_grain, tree::make_chunk(some));
    });
    return judge_turn(state);
  }

 private:
  /// Rates of states as functions of their values.
  void follow_states(const plan::Plan& plan, SignalValues& now) const {
    const SignalValues& from = start.signals;
    for (std::size_t i = 0; i < plan.signals.size(); ++i) {
      if (!plan.signals[i].is_state()) continue;
      now.algorithmic[i] = rule.states.algorithmic(now.value[i], from.value[i], from.algorithmic[i]);
      now.rate[i] = rule.states.rate(now.algorithmic[i], from.algorithmic[i], from.rate[i]);
    }
  }
  /// Rates of states and values of other signals go on to change as they did in the last step.
  void predict_signals(const plan::Plan& plan, SignalValues& now) const {
    const SignalValues& from = start.signals;
    now = from;
    for (std::size_t i = 0; i < plan.signals.size(); ++i)
      now.value[i] = plan.signals[i].is_state() ? rule.states.predict(from.rate[i] + from.trend[i], from.value[i],
                                                                      from.algorithmic[i], from.rate[i])
                                                : from.value[i] + from.trend[i];
    follow_states(plan, now);
  }
  /// Reports a node whose increment turns too far.
  std::optional<Trouble> judge_turn(const State& state) const {
    if (noted_most(system) <= largest_turn * largest_turn) return std::nullopt;
    return state.visit([&]<class G>(const NodesOn<G>& nodes) -> std::optional<Trouble> {
      const auto far = std::find_if(nodes.motion.begin(), nodes.motion.end(), [](const auto& node) {
        return motion::VectorsOn<G>::template angular_square<double>(node.dq) > largest_turn * largest_turn;
      });
      if (far == nodes.motion.end()) return std::nullopt;
      return Trouble{"'" + system.plan().nodes[static_cast<std::size_t>(far - nodes.motion.begin())].name +
                     "' turns by nearly half a turn in one step"};
    });
  }
};

/// Stores what the next step needs: changes of accelerations for the predictor, the errors of the
/// predictors, and the local error, which limits Newton's iteration. The moment arm converts angular to linear
/// accelerations.
void note_end(System& system, const AlphaRule& rule, const State& start, State& state) {
  const double arm = system.moment_arm(), per_length = 1.0 / system.plan().length_scale;
  std::vector<Workspace::StepEnd>& parts = system.work().step_ends;
  const std::int64_t count = system.node_order()->by_visit().count();
  parts.resize(static_cast<std::size_t>((count + eight_grain - 1) / eight_grain));
  system.work().misses.resize(system.plan().nodes.size());
  state.change_all([&]<class G>(NodesOn<G>& nodes) {
    auto some = [&](std::int64_t begin, std::int64_t end) {
      parts[static_cast<std::size_t>(begin / eight_grain)] =
          finish_nodes(rule, drifts_of<G>(system), arm, per_length, start.on<G>(), nodes, *system.node_order(),
                       static_cast<std::size_t>(begin), static_cast<std::size_t>(end), system.work().misses.data());
    };
    system.walker().for_each_chunk(count, eight_grain, tree::make_chunk(some));
  });
}

/// Combines the values of all chunks in Workspace::step_ends into the state.
void note_whole_end(System& system, const AlphaRule& rule, const State& start, State& state) {
  Workspace::StepEnd whole;
  for (const Workspace::StepEnd& part : system.work().step_ends) {
    whole.error = std::max(whole.error, part.error);
    whole.increment = std::max(whole.increment, part.increment);
    whole.of_change = std::max(whole.of_change, part.of_change);
  }
  Misses misses{};  // summed in the order of nodes, which no number of threads changes
  for (const Misses& of_node : system.work().misses)
    for (std::size_t k = 0; k < misses.size(); ++k) misses[k] += of_node[k];
  state.predictor_order = least_missed(misses);
  state.local_error = whole.error;
  state.increment = whole.increment;
  state.velocity_error = rule.velocity_error(whole.of_change);
  system.corrections().note_multipliers(start, state);
  for (std::size_t i = 0; i < state.signals.value.size(); ++i)
    state.signals.trend[i] = system.plan().signals[i].is_state() ? state.signals.rate[i] - start.signals.rate[i]
                                                                 : state.signals.value[i] - start.signals.value[i];
}

/// check_shape, unless no element can be past a limit: a relative rotation changes by no more than its two nodes turn.
std::optional<Trouble> check_shape_after(System& system, const State& start, State& state) {
  state.shape_margin = start.shape_margin - 2.0 * std::sqrt(noted_most(system));
  return state.shape_margin > 0.0 ? std::nullopt : check_shape(system, state);
}

AlphaStep make_rule(System& system, const StepOptions& options, const State& start) {
  AlphaRule rule{make_alpha_coefficients(options.spectral_radius), start.step_size,
                 FirstOrderRule(options.spectral_radius, start.step_size)};
  std::visit(
      [&]<class G>(const DriftChoice<G>& choice) {
        rule.drifts = !choice.eights.empty();
        rule.falls = choice.falls;
      },
      system.work().drift_choice);
  return {rule, start, system};
}

/// Sets the laws of `end_time` and the predicted state.
std::optional<Trouble> enter(System& system, State& state, const AlphaStep& step, double end_time, laws::Side side) {
  if (auto t = system.set_time(end_time, side)) return t;
  state.time = end_time;
  return step.predict(state);
}

StepReport try_step(System& system, State& state, const State& start, const StepOptions& options, double end_time,
                    laws::Side side) {
  const AlphaStep step = make_rule(system, options, start);
  StepReport report;
  const auto fail = [&](const Trouble& t) {
    report.converged = false;
    report.cause = t.text;
    return report;
  };
  if (const auto t = enter(system, state, step, end_time, side)) return fail(*t);
  report = iterate(system, state, options, make_goal(start, options.tolerance), step.rule.slopes(), step);
  if (!report.converged) return report;
  system.recover_multipliers(state);
  step.observe(state);
  note_end(system, step.rule, start, state);
  note_whole_end(system, step.rule, start, state);
  if (const auto t = check_shape_after(system, start, state)) return fail(*t);
  return report;
}

}  // namespace

std::optional<Trouble> predict(System& system, State& state, const StepOptions& options, double end_time,
                               elements::Slopes& slopes) {
  const State start = state;
  const AlphaStep step = make_rule(system, options, start);
  slopes = step.rule.slopes();
  return enter(system, state, step, end_time, laws::Side::left);
}

StepReport advance(System& system, State& state, const StepOptions& options, double end_time, laws::Side side) {
  state.visit([&]<class G>(const NodesOn<G>&) {
    NodesOn<G>& nodes = state.changing<G>();  // no node moves: what is known of them still holds
    for (auto* known : {&nodes.algorithmic, &nodes.acceleration_trend, &nodes.trend_change})
      known->arrange(system.node_order());
  });
  State& start = system.work().start;
  std::swap(state, start);
  StepReport report = try_step(system, state, start, options, end_time, side);
  if (!report.converged) std::swap(state, start);
  return report;
}

}  // namespace bough::step
