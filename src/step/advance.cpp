#include "bough/step/advance.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "newton.hpp"

namespace bough::step {

using motion::Vec6;

namespace {

constexpr double largest_turn =
    2.8;  ///< rotation of a node in one step [rad]: below pi, where the logarithm is no longer unique

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
    for (std::size_t n = 0; n < state.nodes.size(); ++n) {
      elements::NodeMotion& node = state.nodes[n];
      const Vec6<double>&v = start.nodes[n].v, &a = start.nodes[n].a, &algorithmic = start.algorithmic[n];
      const Vec6<double> next = (1.0 / (c.beta * h * h)) * (node.dq - h * v) - ((0.5 - c.beta) / c.beta) * algorithmic;
      node.v = v + h * ((1.0 - c.gamma) * algorithmic + c.gamma * next);
      node.a = (1.0 / (1.0 - c.alpha_f)) * ((1.0 - c.alpha_m) * next + c.alpha_m * algorithmic - c.alpha_f * a);
      state.algorithmic[n] = next;
      const motion::Vec3<double> turn = lanes::angular_part(node.dq);
      if (lanes::dot(turn, turn) > largest_turn * largest_turn)
        return Trouble{"'" + system.plan().nodes[n].name + "' turns by nearly half a turn in one step"};
    }
    return std::nullopt;
  }

  /// Predictor: dv/dt stays, a_{n+1} follows from it. Writes all of `state` in one pass over the start.
  void predict(State& state) const {
    state.step_size = start.step_size;
    state.multipliers = start.multipliers;
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
        const Vec6<double> next = (1.0 / (1.0 - c.alpha_m)) * (from.a - c.alpha_m * algorithmic);
        eta[i] = h * from.v + (h * h) * ((0.5 - c.beta) * algorithmic + c.beta * next);
        state.nodes[n + i] = from;
        state.nodes[n + i].dq = eta[i];
        state.rotation[n + i] = start.rotation[n + i];
      }
      move_nodes(state, n, some, eta, false);
    }
  }
};

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
