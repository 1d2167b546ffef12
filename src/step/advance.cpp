#include "bough/step/advance.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <utility>

#include "newton.hpp"
#include "system_parts.hpp"

namespace bough::step {

using motion::Vec6;

namespace {

constexpr double largest_turn =
    2.8;  ///< rotation of a node in one step [rad]: below pi, where the logarithm is no longer unique

bool turns_far(const elements::NodeMotion& node) {
  const motion::Vec3<double> turn = lanes::angular_part(node.dq);
  return lanes::dot(turn, turn) > largest_turn * largest_turn;
}

/// Velocities and accelerations that belong to dq by the integrator's formulas.
struct Integrator {
  AlphaCoefficients c;
  double h;
  const State& start;

  elements::Slopes slopes() const {
    return {c.gamma / (c.beta * h), (1.0 - c.alpha_m) / ((1.0 - c.alpha_f) * c.beta * h * h), false};
  }

  ///   a_{n+1} = (dq - h v_n) / (beta h^2) - (1/2 - beta)/beta a_n,  v_{n+1} = v_n + h ((1 - gamma) a_n + gamma a_{n+1}),
  ///   dv/dt_{n+1} = ((1 - alpha_m) a_{n+1} + alpha_m a_n - alpha_f dv/dt_n) / (1 - alpha_f)
  std::optional<Trouble> follow(const System& system, State& state) const {
    const double of_dq = 1.0 / (c.beta * h * h), of_a = (0.5 - c.beta) / c.beta, share = 1.0 / (1.0 - c.alpha_f);
    std::atomic<bool> turned_far = false;
    auto by_node = [&](std::int64_t begin, std::int64_t end) {
      for (auto n = static_cast<std::size_t>(begin); n < static_cast<std::size_t>(end); ++n) {
        elements::NodeMotion& node = state.nodes[n];
        const Vec6<double>&v = start.nodes[n].v, &a = start.nodes[n].a, &algorithmic = start.algorithmic[n];
        const Vec6<double> next = of_dq * (node.dq - h * v) - of_a * algorithmic;
        node.v = v + h * ((1.0 - c.gamma) * algorithmic + c.gamma * next);
        node.a = share * ((1.0 - c.alpha_m) * next + c.alpha_m * algorithmic - c.alpha_f * a);
        state.algorithmic[n] = next;
        if (turns_far(node)) turned_far = true;
      }
    };
    system.walker().for_each_chunk(static_cast<std::int64_t>(state.nodes.size()), block_grain,
                                   tree::make_chunk(by_node));
    if (!turned_far) return std::nullopt;
    const auto far = std::find_if(state.nodes.begin(), state.nodes.end(), turns_far);
    return Trouble{"'" + system.plan().nodes[static_cast<std::size_t>(far - state.nodes.begin())].name +
                   "' turns by nearly half a turn in one step"};
  }

  /// Predictor: dv/dt changes as it did over the last step, or stays where that would have been nearer; a_{n+1} follows. Multipliers stay:
  /// the first solution finds them, whatever they were. Writes all of `state` in one pass over the start.
  void predict(State& state) const {
    state.step_size = start.step_size;
    state.multipliers = start.multipliers;
    const double trend = start.follows_trend ? 1.0 : 0.0;
    state.turns = start.turns;
    state.nodes.resize(start.nodes.size());
    state.rotation.resize(start.nodes.size());
    state.algorithmic.resize(start.nodes.size());
    const std::size_t count = start.nodes.size();
    Vec6<double> eta[nodes_in_lanes];
    for (std::size_t n = 0; n < count; n += nodes_in_lanes) {
      const std::size_t some = std::min(nodes_in_lanes, count - n);
      for (std::size_t i = 0; i < some; ++i) {
        const elements::NodeMotion& from = start.nodes[n + i];
        const Vec6<double>& algorithmic = start.algorithmic[n + i];
        const Vec6<double> next =
            (1.0 / (1.0 - c.alpha_m)) *
            (from.a + (trend * (1.0 - c.alpha_f)) * start.acceleration_trend[n + i] - c.alpha_m * algorithmic);
        eta[i] = h * from.v + (h * h) * ((0.5 - c.beta) * algorithmic + c.beta * next);
        state.nodes[n + i] = from;
        state.nodes[n + i].dq = eta[i];
        state.rotation[n + i] = start.rotation[n + i];
      }
      move_nodes(state, n, some, eta, false);
    }
  }
};

/// What the next predictor goes by. Angular accelerations count by the arm that turns them into linear ones.
void note_trend(const System& system, const State& start, State& state) {
  const double arm = system.moment_arm();
  double from_start = 0.0, from_trend = 0.0;
  state.acceleration_trend.resize(state.nodes.size());
  for (std::size_t n = 0; n < state.nodes.size(); ++n) {
    const Vec6<double> now = state.nodes[n].a - start.nodes[n].a;
    const Vec6<double> turn = now - start.acceleration_trend[n];
    const auto size = [arm](const Vec6<double>& a) {
      return lanes::dot(lanes::linear_part(a), lanes::linear_part(a)) +
             arm * arm * lanes::dot(lanes::angular_part(a), lanes::angular_part(a));
    };
    from_start += size(now);
    from_trend += size(turn);
    state.acceleration_trend[n] = now;
  }
  state.follows_trend = from_trend < from_start;
}

Integrator make_rule(const StepOptions& options, const State& start) {
  return {make_alpha_coefficients(options.spectral_radius), start.step_size, start};
}

/// The predicted state, its laws and velocities.
std::optional<Trouble> enter(System& system, State& state, const Integrator& rule, double end_time) {
  if (auto t = system.set_time(end_time, laws::Side::left)) return t;
  rule.predict(state);
  state.time = end_time;
  return rule.follow(system, state);
}

StepReport try_step(System& system, State& state, const StepOptions& options, const Integrator& rule, double end_time) {
  StepReport report;
  const auto fail = [&report](const Trouble& t) {
    report.converged = false;
    report.cause = t.text;
    return report;
  };
  if (const auto t = enter(system, state, rule, end_time)) return fail(*t);
  report = iterate(system, state, options, rule.slopes(), [&](State& s) { return rule.follow(system, s); });
  if (!report.converged) return report;
  if (const auto t = check_shape(system, state)) return fail(*t);
  note_trend(system, rule.start, state);
  system.recover_multipliers(state);
  return report;
}

}  // namespace

std::optional<Trouble> predict(System& system, State& state, const StepOptions& options, double end_time,
                               elements::Slopes& slopes) {
  const State start = state;
  const Integrator rule = make_rule(options, start);
  slopes = rule.slopes();
  return enter(system, state, rule, end_time);
}

StepReport advance(System& system, State& state, const StepOptions& options, double end_time) {
  State& start = system.work().start;
  std::swap(state, start);
  StepReport report = try_step(system, state, options, make_rule(options, start), end_time);
  if (!report.converged) std::swap(state, start);
  return report;
}

}  // namespace bough::step
