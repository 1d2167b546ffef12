#include "bough/step/advance.hpp"

#include <cmath>

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
  std::vector<Vec6<double>>&v, &a, &algorithmic;  ///< at the start of the step

  Integrator(const State& state, const StepOptions& options, double step, Workspace& work)
      : c(make_alpha_coefficients(options.spectral_radius)),
        h(step),
        v(work.v),
        a(work.a),
        algorithmic(work.algorithmic) {
    for (std::size_t n = 0; n < v.size(); ++n) {
      v[n] = state.nodes[n].v;
      a[n] = state.nodes[n].a;
      algorithmic[n] = state.algorithmic[n];
    }
  }

  ///   a_{n+1} = (dq - h v_n) / (beta h^2) - (1/2 - beta)/beta a_n,  v_{n+1} = v_n + h ((1 - gamma) a_n + gamma a_{n+1}),
  ///   dv/dt_{n+1} = ((1 - alpha_m) a_{n+1} + alpha_m a_n - alpha_f dv/dt_n) / (1 - alpha_f)
  std::optional<Trouble> follow(const System& system, State& state) const {
    for (std::size_t n = 0; n < v.size(); ++n) {
      elements::NodeMotion& node = state.nodes[n];
      const Vec6<double> next =
          (1.0 / (c.beta * h * h)) * (node.dq - h * v[n]) - ((0.5 - c.beta) / c.beta) * algorithmic[n];
      node.v = v[n] + h * ((1.0 - c.gamma) * algorithmic[n] + c.gamma * next);
      node.a = (1.0 / (1.0 - c.alpha_f)) * ((1.0 - c.alpha_m) * next + c.alpha_m * algorithmic[n] - c.alpha_f * a[n]);
      state.algorithmic[n] = next;
      const motion::Vec3<double> turn = lanes::angular_part(node.dq);
      if (lanes::dot(turn, turn) > largest_turn * largest_turn)
        return Trouble{"'" + system.plan().nodes[n].name + "' turns by nearly half a turn in one step"};
    }
    return std::nullopt;
  }
};

}  // namespace

StepReport advance(System& system, State& state, const StepOptions& options, double end_time) {
  const double h = state.step_size;
  const Integrator rule(state, options, h, system.work());
  const AlphaCoefficients& c = rule.c;
  StepReport report;
  if (const auto t = system.set_time(end_time, laws::Side::left)) {
    report.cause = t->text;
    return report;
  }
  // Predictor: dv/dt stays, a_{n+1} follows from it.
  for (std::size_t n = 0; n < state.nodes.size(); ++n) {
    const Vec6<double> next = (1.0 / (1.0 - c.alpha_m)) * (rule.a[n] - c.alpha_m * rule.algorithmic[n]);
    const Vec6<double> dq = h * rule.v[n] + (h * h) * ((0.5 - c.beta) * rule.algorithmic[n] + c.beta * next);
    state.nodes[n].dq = Vec6<double>::zero();
    move_node(state, n, dq);
    state.nodes[n].dq = dq;
  }
  if (const auto t = rule.follow(system, state)) {
    report.cause = t->text;
    return report;
  }
  state.time = end_time;
  const elements::Slopes slopes{c.gamma / (c.beta * h), (1.0 - c.alpha_m) / ((1.0 - c.alpha_f) * c.beta * h * h),
                                false};
  report = iterate(system, state, options, slopes, [&](State& s) { return rule.follow(system, s); });
  if (!report.converged) return report;
  if (const auto t = check_shape(system, state)) {
    report.converged = false;
    report.cause = t->text;
  }
  return report;
}

}  // namespace bough::step
