#include "branch_check.hpp"

#include <algorithm>
#include <cmath>

namespace bough::run {

namespace {

constexpr int halvings = 7;       ///< the last step is less than a hundredth of the load step
constexpr double stays = 0.75;    ///< part of a motion in one half of a step, every time: it does not shrink
constexpr double apart = 1e-3;    ///< of the motion of the step: farther apart, two equilibria are two
constexpr double foretold = 1.0;  ///< motion after the first correction, over that of the first

/// Largest change of a place, over the size of the structure, or of an entry of a rotation matrix.
double distance(const plan::Plan& plan, const step::State& a, const step::State& b) {
  const std::vector<elements::NodeMotion>&p = nodes_in_space(plan, a), &q = nodes_in_space(plan, b);
  double most = 0.0;
  for (std::size_t n = 0; n < p.size(); ++n) {
    for (int i = 0; i < 3; ++i) most = std::max(most, std::abs(p[n].x.hi[i] - q[n].x.hi[i]) / plan.length_scale);
    for (int i = 0; i < 9; ++i) most = std::max(most, std::abs(p[n].R.m[i] - q[n].R.m[i]));
  }
  return most;
}

}  // namespace

bool may_have_jumped(const step::StepReport& report) {
  const auto changes = report.changes();
  double later = 0.0;
  for (std::size_t k = 1; k < changes.size(); ++k) later += changes[k];
  return changes.size() > 2 && later > foretold * changes[0];
}

bool has_jumped(step::System& system, const step::StepOptions& options, const step::State& from, const step::State& to,
                long& iterations) {
  const plan::Plan& plan = system.plan();
  step::State low = from, high = to;
  const auto go = [&](step::State& state, double load_factor) {
    const step::StepReport report = step::equilibrate(system, state, options, load_factor);
    iterations += report.iterations;
    if (report.converged && !plan.joints.empty()) step::accept_turns(system, state);
    return report.converged;
  };
  const double whole = distance(plan, from, to);
  bool jumps = true;
  for (int k = 0; k < halvings && jumps; ++k) {
    step::State middle = low;
    if (!go(middle, 0.5 * (low.time + high.time))) break;
    step::State end = middle;
    if (!go(end, high.time) || distance(plan, end, high) > apart * whole) break;
    const double before = distance(plan, low, middle), after = distance(plan, middle, high);
    jumps = std::max(before, after) > stays * distance(plan, low, high);
    (before > after ? high : low) = middle;
  }
  step::State again = to;
  if (!system.set_time(to.time) && !system.evaluate(again, {}, true))
    static_cast<void>(system.linear().factor(true, {}));
  return jumps;
}

}  // namespace bough::run
