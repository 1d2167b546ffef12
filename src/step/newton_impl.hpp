#pragma once
#include <algorithm>
#include <cmath>

namespace bough::step {

template <class Follow>
StepReport iterate(System& system, State& state, const StepOptions& options, const elements::Slopes& slopes,
                   Follow&& follow) {
  StepReport report;
  std::vector<double>&rhs = system.work().rhs, &x = system.work().x;
  const auto fail = [&report](const Trouble& t) {
    report.cause = t.text;
    return report;
  };
  const bool may_reuse = !options.single_solution && options.reuse_factors;
  double previous = 0.0, rate = system.last_contraction(), size = 0.0;
  bool is_own = false;                                    // whether the factor was made in this step
  bool fresh = !may_reuse || !system.has_factor(slopes);  // whether the next solution gets a new factor
  for (int k = 0;; ++k) {
    if (const auto t = system.evaluate(state, slopes, fresh && k == 0)) return fail(*t);
    report.residual = system.residual_size();
    size = largest_share(system, report.residual);
    if (k > 0) {
      if (options.single_solution) {
        report.converged = true;
        return report;
      }
      if (k > 1) rate = previous > 0.0 ? report.change / previous : 0.0;
      const bool still = report.change < options.tolerance;
      const bool stalled = k > 1 && rate > shrinks && is_own;  // with an old factor: it contracts badly here
      if (still && size <= (stalled ? 1.0 : left_open) * options.tolerance) {
        report.converged = true;
        if (k > 1) system.set_last_contraction(rate);
        return report;
      }
      if (still && (stalled || report.change == 0.0)) {  // is what is left only round-off?
        if (is_at_floor(system, state, report.residual, options.tolerance)) {
          report.converged = report.at_floor = true;
          return report;
        }
      }
      if (k >= options.max_iterations) {
        report.cause = "no convergence in " + std::to_string(k) +
                       " iterations: " + describe(system, report.residual, options.tolerance);
        return report;
      }
      if (k >= 4 && report.change > 1e3 * std::max(previous, 1.0)) {
        report.cause = "the iteration diverges: " + describe(system, report.residual, options.tolerance);
        return report;
      }
      const bool is_slow = k > 1 && rate > slowest_contraction;
      if (is_slow && is_own && system.takes_symmetric_parts()) system.drop_symmetry();  // not the factor's age
      fresh = !may_reuse || is_slow;
      if (fresh)
        if (const auto t = system.evaluate(state, slopes, true)) return fail(*t);
    }
    is_own |= fresh;
    if (fresh)
      if (const auto t = system.factor(k == 0, slopes))
        return fail(k == 0 ? *t : Trouble{"iteration " + std::to_string(k) + " came to a shape at which " + t->text});
    for (std::size_t i = 0; i < rhs.size(); ++i) rhs[i] = -system.residual()[i];
    if (const auto t = system.solve(rhs.data(), x.data(), false)) return fail(*t);
    previous = report.change;
    report.change = system.apply(state, x.data());
    if (report.iterations < StepReport::remembered_changes)
      report.change_list[static_cast<std::size_t>(report.iterations)] = report.change;
    ++report.iterations;
    if (!std::isfinite(report.change)) return fail({"the iteration left finite numbers"});
    if (const auto t = follow(state)) return fail(*t);
    if (k == 0 || options.single_solution || std::max(report.change, size) > options.tolerance) continue;
    // Where changes shrink on as they did, what this one leaves of a residual that was small already need not be looked at.
    rate = previous > 0.0 ? report.change / previous : 0.0;
    if (rate <= shrinks && rate * size <= left_open * options.tolerance) {
      report.converged = true;
      system.set_last_contraction(rate);
      return report;
    }
  }
}

}  // namespace bough::step
