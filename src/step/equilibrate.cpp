#include <algorithm>
#include <cmath>
#include <utility>

#include "newton.hpp"
#include "settle.hpp"

namespace bough::step {

namespace {

constexpr double taken_whole = 1e-2;  ///< smaller corrections need no line search
/// The second-order effect of smaller corrections is below the rounding of strains. Each node then takes its own
/// increment, which avoids the rounding errors of the motion tree.
constexpr double taken_by_node = 1e-8;
constexpr double loose = 0.8;  ///< accepted part of the initial power; the line search only prevents overshooting
constexpr int max_trials = 6;
constexpr double divergence = 1e3;  ///< a larger change of relative motions means divergence

/// Applies the correction in work().x, shortened by a factor s if the whole correction overshoots: line search on the
/// power g(s) = residual(q(s)) . dq/ds of the unbalanced forces (Matthies, Strang 1979). A factor is accepted unless
/// g(s) has changed its sign and exceeds `loose` times g(0); the next one follows from regula falsi between 0 and s.
void apply_damped(System& system, State& state, double size) {
  const std::vector<double>& x = system.work().x;
  if (size <= taken_by_node) {
    system.corrections().apply(state, x.data());
    return;
  }
  if (size <= taken_whole) return system.corrections().apply_along_tree(state, x.data(), 1.0);
  State& before = system.work().before;
  before = state;
  double start = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) start += system.right_hand_side()[i] * x[i];
  double s = 1.0;
  for (int k = 1;; ++k) {
    system.corrections().apply_along_tree(state, x.data(), s);
    const bool finite = !system.evaluate(state, {}, false);
    const double g = finite ? system.corrections().power_along_tree(system.right_hand_side().data(), x.data()) : 0.0;
    if (finite && (g * start >= 0.0 || std::abs(g) <= loose * std::abs(start))) return;
    if (k == max_trials) return;
    s *= finite ? std::clamp(start / (start - g), 0.1, 0.9) : 0.5;
    state = before;
  }
}

StepReport try_load(System& system, State& state, const StepOptions& options, double load_factor) {
  StepReport report;
  const auto fail = [&report](const std::string& cause) {
    report.converged = false;
    report.cause = cause;
    return report;
  };
  if (const auto t = system.set_time(load_factor, laws::Side::left)) return fail(t->text);
  state.time = load_factor;
  state.unsettled.clear();
  set_at_rest(state);
  system.signals().follow_motion(state);
  std::vector<double>&rhs = system.work().rhs, &x = system.work().x;
  double previous = 0.0;
  for (int k = 0;; ++k) {
    if (const auto t = system.evaluate(state, {}, true)) return fail(t->text);
    report.residual = residual_of(system);
    if (k > 0) {
      const bool still = report.change < options.tolerance;
      report.converged = still && (is_small(system, report.residual, options.tolerance) || options.single_solution);
      if (still && !report.converged && may_be_round_off(k, report.change, previous, options.tolerance))
        report.converged = report.at_floor = is_at_floor(system, report.residual, options.tolerance);
      if (report.converged) break;
      if (k >= options.max_iterations)
        return fail("no convergence in " + std::to_string(k) +
                    " iterations: " + describe(system, report.residual, options.tolerance));
    }
    if (const auto t = system.linear().factor(k == 0, {}))
      return fail(k == 0 ? t->text : "iteration " + std::to_string(k) + " came to a shape at which " + t->text);
    rhs = system.right_hand_side();
    if (const auto t = system.linear().solve(rhs.data(), x.data())) return fail(t->text);
    previous = report.change;
    report.change = system.corrections().relative_size(state, x.data());
    if (report.iterations < StepReport::remembered_changes)
      report.change_list[static_cast<std::size_t>(report.iterations)] = report.change;
    ++report.iterations;
    if (!std::isfinite(report.change)) return fail("the iteration left finite numbers");
    if (report.change > divergence)
      return fail("the iteration diverges: " + describe(system, report.residual, options.tolerance));
    apply_damped(system, state, report.change);
    system.make_least(state);
  }
  if (const auto t = check_shape(system, state)) return fail(t->text);
  if (const auto t = check_closed(system, state)) return fail(t->text);
  settle(system, state);
  system.signals().observe(state, 0.0);
  return report;
}

}  // namespace

StepReport equilibrate(System& system, State& state, const StepOptions& options, double load_factor) {
  State& start = system.work().start;
  start = state;
  StepReport report = try_load(system, state, options, load_factor);
  if (!report.converged && system.linear().takes_symmetric_parts()) {  // may be the cause
    system.linear().drop_symmetry();
    state = start;
    report = try_load(system, state, options, load_factor);
  }
  if (!report.converged) std::swap(state, start);
  return report;
}

}  // namespace bough::step
