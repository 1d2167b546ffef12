#include <cmath>

#include "bough/step/advance.hpp"

namespace bough::step {

using lanes::Taylor;
using motion::Vec6;

namespace {

constexpr elements::Slopes mass_slopes{0.0, 0.0, true};

Vec6<double> node_part(const System& system, const std::vector<double>& x, std::size_t node) {
  Vec6<double> v;
  for (int i = 0; i < 6; ++i) v[i] = x[static_cast<std::size_t>(system.block_begin(static_cast<int>(node)) + i)];
  return v;
}

/// Spreads values by multiplier over the solver's unknowns:  to[block of joint] = factor * from.
template <class From>
void set_rows(const System& system, std::vector<double>& to, From&& from) {
  for (const plan::JointPlan& j : system.plan().joints) {
    if (j.block < 0) continue;
    const int size = system.plan().graph.block_size[static_cast<std::size_t>(j.block)];
    for (int i = 0; i < size; ++i)
      to[static_cast<std::size_t>(system.block_begin(j.block) + i)] =
          from(static_cast<std::size_t>(j.multiplier_begin + i));
  }
}

/// Matrix [M G^T; G 0] of the present positions, factored.
std::optional<Trouble> factor_mass(System& system, const State& state) {
  if (auto t = system.evaluate(state, mass_slopes, true)) return t;
  if (auto t = system.factor(true, mass_slopes))
    return Trouble{t->text + "; every part that can move needs inertia or has to be held by a joint"};
  return std::nullopt;
}

/// Joints whose constraints contradict each other, for a message.
std::string contradicting(const System& system, int worst, const std::vector<int>& blocks) {
  std::string text = system.plan().joints.empty()
                         ? ""
                         : system.plan().joints[static_cast<std::size_t>(worst)].what + " '" +
                               system.plan().joints[static_cast<std::size_t>(worst)].name + "'";
  std::string others;
  int named = 0;
  for (int b : blocks) {
    const int j = system.joint_of_block(b);
    if (j < 0 || j == worst) continue;
    others += (named++ == 0 ? "" : ", ") + ("'" + system.plan().joints[static_cast<std::size_t>(j)].name + "'");
    if (named == 8) break;
  }
  if (named > 0) text += " contradicts " + others + " (their constraints depend on each other)";
  return text;
}

/// Velocities that satisfy the constraints (plus `offset` by multiplier when given), nearest in the mass metric. Mass matrix factored.
std::optional<Trouble> project_velocities(System& system, State& state, const std::vector<double>* offset,
                                          double* impulse) {
  std::vector<double> rhs(system.num_unknowns(), 0.0), x(system.num_unknowns());
  std::vector<Taylor<double, 3>> series;
  system.constraint_series(state, nullptr, 0.0, series);
  set_rows(system, rhs, [&](std::size_t m) { return -series[m].c[1] + (offset != nullptr ? (*offset)[m] : 0.0); });
  if (auto t = system.solve(rhs.data(), x.data())) return t;
  for (std::size_t n = 0; n < state.nodes.size(); ++n) state.nodes[n].v += node_part(system, x, n);
  if (impulse != nullptr) {
    *impulse = 0.0;
    set_rows(system, rhs, [&](std::size_t) { return 0.0; });
    for (const plan::JointPlan& j : system.plan().joints) {
      const int size = j.block < 0 ? 0 : system.plan().graph.block_size[static_cast<std::size_t>(j.block)];
      for (int i = 0; i < size; ++i)
        *impulse = std::max(*impulse, std::abs(x[static_cast<std::size_t>(system.block_begin(j.block) + i)]));
    }
  }
  return std::nullopt;
}

/// Largest speed, to measure velocity constraints against: [m/s] and [rad/s] alike.
double speed_scale(const System& system, const State& state) {
  double most = 0.0;
  for (const elements::NodeMotion& n : state.nodes)
    for (int i = 0; i < 6; ++i) most = std::max(most, std::abs(n.v[i]) * (i < 3 ? 1.0 : system.plan().length_scale));
  return most;
}

/// Steady velocity error of the index-3 scheme in the constraints' normals, by multiplier:
///   G delta = -h^2 G ((beta + shift/2 - 1/6) jerk - ad(v) a / 12)
/// (local error of dq against the Magnus series of the motion). Element matrices hold G.
void steady_velocity_error(System& system, const State& state, const AlphaCoefficients& c, double h,
                           const std::vector<Vec6<double>>& jerk, std::vector<double>& offset) {
  std::vector<double> delta(system.num_unknowns(), 0.0), product(system.num_unknowns());
  for (std::size_t n = 0; n < state.nodes.size(); ++n) {
    const Vec6<double> d = (-h * h) * ((c.beta + 0.5 * c.shift() - 1.0 / 6.0) * jerk[n] -
                                       (1.0 / 12.0) * motion::cross6_times(state.nodes[n].v, state.nodes[n].a));
    for (int i = 0; i < 6; ++i) delta[static_cast<std::size_t>(system.block_begin(static_cast<int>(n)) + i)] = d[i];
  }
  system.solver().multiply(system.walker(), delta.data(), product.data());
  offset.assign(static_cast<std::size_t>(system.plan().num_multipliers), 0.0);
  for (const plan::JointPlan& j : system.plan().joints) {
    const int size = j.block < 0 ? 0 : system.plan().graph.block_size[static_cast<std::size_t>(j.block)];
    for (int i = 0; i < size; ++i)
      offset[static_cast<std::size_t>(j.multiplier_begin + i)] =
          product[static_cast<std::size_t>(system.block_begin(j.block) + i)];
  }
}

StartReport failed(const std::string& cause) {
  StartReport r;
  r.cause = cause;
  return r;
}

}  // namespace

StartReport make_consistent(System& system, State& state, bool fix_positions) {
  StartReport report;
  if (const auto t = system.set_time(state.time, laws::Side::right)) return failed(t->text);
  for (elements::NodeMotion& n : state.nodes) n.dq = n.a = Vec6<double>::zero();
  std::vector<double> rhs(system.num_unknowns(), 0.0), x(system.num_unknowns());
  const double length = system.plan().length_scale;
  int worst = 0;

  if (const auto t = factor_mass(system, state)) return failed(t->text);
  double gap = system.constraint_violation(state, 0, &worst);
  for (int k = 0; fix_positions && gap > 1e-13 * std::max(length, 1.0) && k < 30; ++k) {
    std::vector<Taylor<double, 3>> series;
    system.constraint_series(state, nullptr, 0.0, series);
    std::fill(rhs.begin(), rhs.end(), 0.0);
    set_rows(system, rhs, [&](std::size_t m) { return -series[m].c[0]; });
    if (const auto t = system.solve(rhs.data(), x.data())) return failed(t->text);
    set_rows(system, x, [](std::size_t) { return 0.0; });  // impulses of a projection are no reactions
    State trial = state;
    const double change = system.apply(trial, x.data());
    const double next = system.constraint_violation(trial, 0, &worst);
    if (!(next < gap)) break;  // as closed as round-off allows
    report.position_correction = std::max(report.position_correction, change);
    state = std::move(trial);
    gap = next;
    if (const auto t = factor_mass(system, state)) return failed(t->text);
  }
  if (gap > 1e-9 * std::max(length, 1.0)) {
    char text[80];
    std::snprintf(text, sizeof text, " cannot be closed at time %.6g: a gap of %.3g is left", state.time, gap);
    return failed(contradicting(system, worst, system.solver().blocks_not_unique()) + text);
  }
  for (elements::NodeMotion& n : state.nodes) n.dq = Vec6<double>::zero();

  if (const auto t = project_velocities(system, state, nullptr, &report.velocity_impulse)) return failed(t->text);
  const double rate = system.constraint_violation(state, 1, &worst);
  if (rate > 1e-8 * std::max(speed_scale(system, state), 1e-6)) {
    char text[80];
    std::snprintf(text, sizeof text, " cannot move as asked at time %.6g: a rate of %.3g is left", state.time, rate);
    return failed(contradicting(system, worst, system.solver().blocks_not_unique()) + text);
  }

  std::fill(state.multipliers.begin(), state.multipliers.end(), 0.0);
  if (const auto t = system.evaluate(state, mass_slopes, false)) return failed(t->text);
  std::vector<Taylor<double, 3>> series;
  system.constraint_series(state, nullptr, 0.0, series);
  for (std::size_t i = 0; i < rhs.size(); ++i) rhs[i] = -system.residual()[i];
  set_rows(system, rhs, [&](std::size_t m) { return -2.0 * series[m].c[2]; });
  if (const auto t = system.solve(rhs.data(), x.data())) return failed(t->text);
  for (std::size_t n = 0; n < state.nodes.size(); ++n) state.nodes[n].a = node_part(system, x, n);
  for (const plan::JointPlan& j : system.plan().joints) {
    const int size = j.block < 0 ? 0 : system.plan().graph.block_size[static_cast<std::size_t>(j.block)];
    for (int i = 0; i < size; ++i)
      state.multipliers[static_cast<std::size_t>(j.multiplier_begin + i)] =
          x[static_cast<std::size_t>(system.block_begin(j.block) + i)];
  }
  report.ok = true;
  return report;
}

StartReport start_alpha(System& system, State& state, const StepOptions& options, double h) {
  const AlphaCoefficients c = make_alpha_coefficients(options.spectral_radius);
  for (elements::NodeMotion& n : state.nodes) n.dq = Vec6<double>::zero();
  // (M + O(h^2) K) jerk + G^T lambda' = -(residual)',  G jerk = -Phi'''|_{jerk = 0}, with the step's own matrix: modes faster than the step
  // are filtered, smooth ones change by O(h) only.
  const double acceleration = (1.0 - c.alpha_m) / ((1.0 - c.alpha_f) * c.beta * h * h);
  const elements::Slopes slopes{c.gamma / (c.beta * h), acceleration, false};
  std::vector<double> rate, rhs(system.num_unknowns()), x(system.num_unknowns());
  std::vector<Taylor<double, 3>> series;
  system.evaluate_rate(state, rate);
  system.constraint_series(state, nullptr, h, series);
  if (const auto t = system.evaluate(state, slopes, true)) return failed(t->text);
  if (const auto t = system.factor(true, slopes)) return failed(t->text);
  for (std::size_t i = 0; i < rhs.size(); ++i) rhs[i] = -acceleration * rate[i];
  set_rows(system, rhs, [&](std::size_t m) { return -6.0 * series[m].c[3]; });
  if (const auto t = system.solve(rhs.data(), x.data())) return failed(t->text);
  std::vector<Vec6<double>> jerk(state.nodes.size());
  for (std::size_t n = 0; n < jerk.size(); ++n) {
    jerk[n] = node_part(system, x, n);
    state.algorithmic[n] = state.nodes[n].a + (c.shift() * h) * jerk[n];
  }
  state.step_size = h;
  StartReport report;
  report.ok = true;
  if (system.plan().num_multipliers == 0) return report;
  if (const auto t = factor_mass(system, state)) return failed(t->text);
  std::vector<double> offset;
  steady_velocity_error(system, state, c, h, jerk, offset);
  if (const auto t = project_velocities(system, state, &offset, nullptr)) return failed(t->text);
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
