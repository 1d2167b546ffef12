#pragma once
#include <algorithm>
#include <cmath>

namespace bough::step {

template <class Follow>
StepReport iterate(System& system, State& state, const StepOptions& options, const elements::Slopes& slopes, bool rescale,
                   Follow&& follow) {
  StepReport report;
  std::vector<double> rhs(system.num_unknowns()), x(system.num_unknowns());
  const auto fail = [&report](const Trouble& t) {
    report.cause = t.text;
    return report;
  };
  const double length = system.plan().length_scale;
  double previous = 0.0;
  for (int k = 0;; ++k) {
    const bool first = k == 0;
    if (const auto t = system.evaluate(state, slopes, first)) return fail(*t);
    report.residual = system.residual_size();
    if (!first) {
      if (options.single_solution) {
        report.converged = true;
        return report;
      }
      const bool still = report.change < options.tolerance;
      if (still && is_small(report.residual, options.tolerance, length)) {
        report.converged = true;
        return report;
      }
      if (still && k >= 3) {  // changes have stopped: is what is left only round-off?
        const ResidualSize floor = system.round_off_floor(state);
        const ResidualSize& r = report.residual;
        const bool at_floor = r.force <= std::max(16.0 * floor.force, options.tolerance * r.force_scale) &&
                              r.moment <= std::max(16.0 * floor.moment, options.tolerance * r.moment_scale) &&
                              r.length <= std::max(floor.length, options.tolerance * length) &&
                              r.angle <= std::max(floor.angle, options.tolerance);
        if (at_floor) {
          report.converged = report.at_floor = true;
          return report;
        }
      }
      if (k >= options.max_iterations) {
        report.cause = "no convergence in " + std::to_string(k) + " iterations: " + describe(system, report.residual, options.tolerance);
        return report;
      }
      if (k >= 4 && report.change > 1e3 * std::max(previous, 1.0)) {
        report.cause = "the iteration diverges: " + describe(system, report.residual, options.tolerance);
        return report;
      }
      if (const auto t = system.evaluate(state, slopes, true)) return fail(*t);
    }
    if (const auto t = system.factor(first && rescale)) return fail(*t);
    for (std::size_t i = 0; i < rhs.size(); ++i) rhs[i] = -system.residual()[i];
    if (const auto t = system.solve(rhs.data(), x.data())) return fail(*t);
    previous = report.change;
    report.change = system.apply(state, x.data());
    report.changes.push_back(report.change);
    ++report.iterations;
    if (!std::isfinite(report.change)) return fail({"the iteration left finite numbers"});
    if (const auto t = follow(state)) return fail(*t);
  }
}

}  // namespace bough::step
