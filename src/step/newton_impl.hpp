#pragma once
#include <algorithm>
#include <cmath>
#include <utility>

namespace bough::step {

template <class Follow>
StepReport iterate(System& system, State& state, const StepOptions& options, const IterationGoal& goal,
                   const elements::Slopes& slopes, Follow&& follow) {
  StepReport report;
  std::vector<double>&rhs = system.work().rhs, &x = system.work().x;
  const auto fail = [&report](const Trouble& t) {
    report.cause = t.text;
    return report;
  };
  const bool may_reuse = !options.single_solution && options.reuse_factors;
  const double tolerance = options.tolerance;
  // Increments are rounded less than places: tolerances far below the usual one ask for their digits.
  const double least = goal.round_off > 0.0 ? std::min(goal.round_off, least_change) : least_change;
  const double negligible = std::max(left_open * tolerance, least);
  bool fresh = !may_reuse || !system.linear().has_factor(slopes) ||
               system.linear().is_factor_worn();  // the next solution gets a new one
  bool is_own = false;                            // whether the factor was made in this step
  int served = 0;                                 // solutions in this step with the present factor
  double previous = 0.0, size = 0.0;              // the change before the last; the residual's largest share
  double expected = 0.0;                          // what the last solution was to leave of that
  // By how much changes and residuals shrink. A factor that served before contracts as it did; of a new one nothing
  // is known at first.
  double rate = fresh ? 1.0 : system.linear().last_contraction(), shrunk = 0.0;
  double contraction = rate;  // the last that round-off did not make
  const auto converge = [&]() {
    report.converged = true;
    if (report.iterations > 1) system.linear().set_last_contraction(contraction);
    system.linear().note_service(served);
    system.met_round_off().count_iteration();
    return report;
  };
  for (int k = 0;; ++k) {
    if (const auto t = system.evaluate(state, slopes, fresh && k == 0)) return fail(*t);
    report.residual = system.residual_size();
    const double before = std::exchange(size, largest_share(system, report.residual));
    if (k > 0) {
      if (options.single_solution) {
        report.converged = true;
        return report;
      }
      shrunk = size < before ? size / before : 1.0;
      const double error = (k > 1 && rate <= shrinks ? unseen_growth * rate : 1.0) * report.change;
      const bool still = error <= negligible;
      if (still && is_settled(system, report.residual, tolerance, goal, error)) return converge();
      const bool lies_still = shrunk > shrinks && report.change <= least_change;
      if (k > 1 && report.change < tolerance &&
          is_noise(system, report.residual, tolerance, size, lies_still ? 0.0 : expected)) {
        system.met_round_off().note(report.residual);
        if (still && is_settled(system, report.residual, tolerance, goal, error)) return converge();
      }
      const bool stalled = k > 1 && rate > shrinks && is_own;  // with an old factor: it contracts badly here
      if (report.change < tolerance && stalled && size <= tolerance) return converge();
      // Is what is left only round-off? Nothing that a new factor could change where nodes no longer move.
      if (report.change < tolerance && (stalled || report.change == 0.0 || (k > 1 && lies_still))) {
        if (is_at_floor(system, report.residual, tolerance)) {
          report.at_floor = true;
          return converge();
        }
      }
      if (k >= options.max_iterations) {
        report.cause =
            "no convergence in " + std::to_string(k) + " iterations: " + describe(system, report.residual, tolerance);
        return report;
      }
      if (k >= 4 && report.change > 1e3 * std::max(previous, 1.0)) {
        report.cause = "the iteration diverges: " + describe(system, report.residual, tolerance);
        return report;
      }
      // A new factor costs some renewal_cost solutions, and serves for one at least: it pays where as many with this
      // one would not do.
      const double solutions = system.linear().renewal_cost() + 1.0;
      const double left = std::pow(std::min(rate, 1.0), solutions) * report.change;
      const bool is_slow =
          k > 1 && ((rate > shrinks && shrunk > shrinks) || left > negligible ||
                    !is_settled(system, report.residual, tolerance, goal, left, std::pow(shrunk, solutions)));
      if (k > 1 && is_own && rate > slowest_contraction && system.linear().takes_symmetric_parts())
        system.linear().drop_symmetry();  // not the factor's age
      fresh = !may_reuse || is_slow || !system.linear().has_factor(slopes);
      if (fresh)
        if (const auto t = system.evaluate(state, slopes, true)) return fail(*t);
    }
    is_own |= fresh;
    served = fresh ? 1 : served + 1;
    if (fresh)
      if (const auto t = system.linear().factor(k == 0 && !may_reuse, slopes))
        return fail(k == 0 ? *t : Trouble{"iteration " + std::to_string(k) + " came to a shape at which " + t->text});
    for (std::size_t i = 0; i < rhs.size(); ++i) rhs[i] = -system.residual()[i];
    if (const auto t = system.linear().solve(rhs.data(), x.data(), false)) return fail(*t);
    previous = report.change;
    report.change = system.apply(state, x.data());
    if (report.iterations < StepReport::remembered_changes)
      report.change_list[static_cast<std::size_t>(report.iterations)] = report.change;
    ++report.iterations;
    if (!std::isfinite(report.change)) return fail({"the iteration left finite numbers"});
    if (const auto t = follow(state)) return fail(*t);
    if (options.single_solution || k == 0) continue;  // nothing follows from the first: predictions err in other ways
    rate = previous > 0.0 ? report.change / previous : 0.0;
    if (k == 1 || report.change > least_change) contraction = rate;
    // What the solution leaves need not be looked at where changes and residuals shrink on as they did. Gaps have to
    // be seen closed: rows that contradict each other stay open while changes vanish.
    const double share = unseen_growth * std::max({rate, shrunk, is_own ? 0.0 : system.linear().last_contraction()});
    expected = share * size;
    const double error = share * report.change;
    if (rate <= shrinks && error <= negligible && is_closed(system, report.residual, tolerance) &&
        is_settled(system, report.residual, tolerance, goal, error, share))
      return converge();
  }
}

}  // namespace bough::step
