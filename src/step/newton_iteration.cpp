#include "newton_iteration.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace bough::step {

NewtonIteration::NewtonIteration(System& system, const StepOptions& options, const IterationGoal& goal,
                                 const elements::Slopes& slopes)
    : system_(system),
      options_(options),
      goal_(goal),
      slopes_(slopes),
      may_reuse_(!options.single_solution && options.reuse_factors),
      fresh_(!may_reuse_ || !system.linear().has_factor(slopes) || system.linear().is_factor_worn()),
      rate_(fresh_ ? 1.0 : system.linear().last_contraction()),
      contraction_(rate_) {
  // An increment of a step is rounded less than a position. Tolerances far below the usual one require these digits.
  const double least = goal.round_off > 0.0 ? std::min(goal.round_off, least_change) : least_change;
  negligible_ = std::max(left_open * options.tolerance, least);
}

const StepReport& NewtonIteration::fail(const Trouble& trouble) {
  report_.cause = trouble.text;
  return report_;
}

const StepReport& NewtonIteration::converge() {
  report_.converged = true;
  if (options_.single_solution) return report_;
  if (count() > 1) system_.linear().set_last_contraction(contraction_);
  system_.linear().note_service(served_);
  system_.round_off().met().count_iteration();
  return report_;
}

bool NewtonIteration::is_settled_at(double error, double share) const {
  return is_settled(system_, report_.residual, options_.tolerance, goal_, error, share);
}

bool NewtonIteration::is_noise_at(double expected) const {
  return is_noise(system_, report_.residual, options_.tolerance, size_, expected);
}

std::optional<Trouble> NewtonIteration::evaluate(const State& state) {
  std::optional<Trouble> t, of_factor;
  if (count() == 0 && fresh_)
    t = system_.evaluate_and_factor(state, slopes_, !may_reuse_, of_factor);
  else if (count() == 0 || may_reuse_)
    t = system_.evaluate_and_condense(state, slopes_);
  else
    t = system_.evaluate(state, slopes_, false);  // the matrix will be factored anew
  if (t) return t;
  report_.residual = residual_of(system_);
  const double before = std::exchange(size_, largest_share(system_, report_.residual));
  if (count() > 0) shrunk_ = size_ < before ? size_ / before : 1.0;
  return of_factor;
}

bool NewtonIteration::is_converged() {
  if (count() == 0) return false;
  if (options_.single_solution) return true;
  const double tolerance = options_.tolerance, change = report_.change;
  const bool has_rate = count() > 1;
  const double error = (has_rate && rate_ <= shrinks ? unseen_growth * rate_ : 1.0) * change;
  const bool still = error <= negligible_;
  if (still && is_settled_at(error)) return true;
  const bool lies_still = shrunk_ > shrinks && change <= least_change;
  if (has_rate && change < tolerance && is_noise_at(lies_still ? 0.0 : expected_)) {
    system_.round_off().met().note(report_.residual);
    if (still && is_settled_at(error)) return true;
  }
  if (!(change < tolerance)) return false;
  const bool stalled = has_rate && rate_ > shrinks && is_own_;  // a stale Jacobian may merely contract slowly
  if (stalled && size_ <= tolerance) return true;
  // The remaining residual may be round-off. Where nodes no longer move, a new factorization could not reduce it.
  if (stalled || change == 0.0 || (has_rate && lies_still))
    report_.at_floor = is_at_floor(system_, report_.residual, tolerance);
  return report_.at_floor;
}

std::optional<Trouble> NewtonIteration::give_up() {
  if (count() >= options_.max_iterations)
    return Trouble{"no convergence in " + std::to_string(count()) +
                   " iterations: " + describe(system_, report_.residual, options_.tolerance)};
  if (count() >= 4 && report_.change > 1e3 * std::max(previous_, 1.0))
    return Trouble{"the iteration diverges: " + describe(system_, report_.residual, options_.tolerance)};
  return std::nullopt;
}

/// A new factorization costs as much as renewal_cost solutions and is followed by at least one solution. It pays if
/// renewal_cost + 1 further solutions with the present factorization would not reach convergence.
bool NewtonIteration::contracts_slowly() const {
  if (count() < 2) return false;
  const double solutions = system_.linear().renewal_cost() + 1.0;
  const double left = std::pow(std::min(rate_, 1.0), solutions) * report_.change;
  return (rate_ > shrinks && shrunk_ > shrinks) || left > negligible_ ||
         !is_settled_at(left, std::pow(shrunk_, solutions));
}

std::optional<Trouble> NewtonIteration::renew_factor(const State& state) {
  LinearSolution& linear = system_.linear();
  if (count() == 0) {
    is_own_ = fresh_;
    served_ = 1;
    return std::nullopt;
  }
  const bool is_slow = contracts_slowly();
  if (count() > 1 && is_own_ && rate_ > slowest_contraction && linear.takes_symmetric_parts())
    linear.drop_symmetry();  // the Jacobian is up to date, so the dropped antisymmetric part slows it down
  fresh_ = !may_reuse_ || is_slow || !linear.has_factor(slopes_);
  is_own_ |= fresh_;
  served_ = fresh_ ? 1 : served_ + 1;
  if (!fresh_) return std::nullopt;
  std::optional<Trouble> of_factor;
  if (auto t = system_.evaluate_and_factor(state, slopes_, false, of_factor)) return t;
  if (!of_factor) return std::nullopt;
  return Trouble{"iteration " + std::to_string(count()) + " came to a shape at which " + of_factor->text};
}

std::optional<Trouble> NewtonIteration::solve(solve::VisitWork correct) {
  if (auto t = system_.linear().substitute(system_.right_hand_side().data(), system_.work().x.data(), correct))
    return t;
  previous_ = report_.change;
  report_.change = system_.corrections().applied_size();
  if (count() < StepReport::remembered_changes) report_.change_list[static_cast<std::size_t>(count())] = report_.change;
  ++report_.iterations;
  if (!std::isfinite(report_.change)) return Trouble{"the iteration left finite numbers"};
  return std::nullopt;
}

/// The constraints must have been evaluated as satisfied, not only predicted so: rows that contradict each other stay
/// violated while corrections vanish. No prediction is made from the first correction, because the error of the
/// predictor differs in kind from that of later iterates.
bool NewtonIteration::will_be_converged() {
  if (options_.single_solution || count() == 1) return false;
  rate_ = previous_ > 0.0 ? report_.change / previous_ : 0.0;
  if (count() == 2 || report_.change > least_change) contraction_ = rate_;
  const double last = is_own_ ? 0.0 : system_.linear().last_contraction();
  const double share = unseen_growth * std::max({rate_, shrunk_, last});
  expected_ = share * size_;
  const double error = share * report_.change;
  return rate_ <= shrinks && error <= negligible_ && is_closed(system_, report_.residual, options_.tolerance) &&
         is_settled_at(error, share);
}

}  // namespace bough::step
