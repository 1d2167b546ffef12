#pragma once
/// Convergence criteria shared by Newton's iterations in time (newton_iteration.hpp) and in statics (equilibrate.cpp).
#include "bough/step/advance.hpp"

namespace bough::step {

/// With an up-to-date and complete Jacobian of a smooth system, Newton's corrections shrink faster than by this ratio.
/// A slower rate means that the Jacobian is incomplete: the antisymmetric part of the tangents was dropped.
constexpr double slowest_contraction = 0.03;

/// Residual and correction at which an iteration may stop, measured or predicted from its rate of contraction, relative
/// to the tolerance. The margin makes a stale Jacobian as accurate as a new one: errors of steps accumulate.
constexpr double left_open = 1e-3;

/// Changes of relative motions below this are round-off, whatever the tolerance.
constexpr double least_change = 4e-15;

/// If the ratio of two successive corrections is above this, they no longer shrink, and the remaining residual may be
/// round-off.
constexpr double shrinks = 0.3;

/// Safety factor on predicted corrections and residuals: the last evaluation of the residual is skipped only if this
/// multiple of its prediction is within the bounds.
constexpr double unseen_growth = 1.2;

/// What the local error of the last step requires of an iteration in addition to the tolerance. The default requires
/// nothing.
struct IterationGoal {
  bool is_set = false;
  double motion = 0.0;     ///< changes of relative motions that are negligible beside the local error of velocities [-]
  double round_off = 0.0;  ///< changes of relative motions due to the rounding of increments [-]
};

/// The motion that is left out may be 30 tolerances of the last local error of velocities, which the default tolerance
/// makes 3e-7. Nothing is required after a start, or where the local error itself is round-off, as where drives
/// prescribe all motion.
IterationGoal make_goal(const State& start, double tolerance);

/// The residual just evaluated. Rows that depend on each other within the precision of the scene are not enforced, and
/// are open by as much as that: violations up to it do not count, where the last factorization found such rows.
ResidualSize residual_of(const System& system);

/// Relative size of a residual: the largest of its forces, moments, lengths and angles, each relative to its own scale
/// (the sum of the magnitudes of the terms, the size of the structure, 1 rad).
double largest_share(const System& system, const ResidualSize& r);

/// Whether the relative size of a residual is within the tolerance.
bool is_small(const System& system, const ResidualSize& r, double tolerance);

/// Whether an iteration may stop with `share` times this residual, `error` being the relative change of the motion that
/// is still to be expected. Violations of constraints must be within left_open times the tolerance. Where no goal is
/// set, forces must be so as well, or within the tolerance and the round-off that earlier iterations met. Where a goal
/// is set and the change is negligible (IterationGoal::motion), forces must be within the tolerance. Otherwise, what
/// applies without a goal is required, and forces must be within 1e-13 of their terms. Exempt from the latter is a
/// residual that is round-off of poses, and one that belongs to reactions alone (`error` is round-off): reactions do
/// not accumulate over steps.
bool is_settled(const System& system, const ResidualSize& r, double tolerance, const IterationGoal& goal, double error,
                double share = 1.0);

/// Whether a residual is noise: its relative size `size` is below the tolerance but much larger than the prediction
/// `expected`, and its forces and moments are within the round-off floor.
bool is_noise(const System& system, const ResidualSize& r, double tolerance, double size, double expected);

/// Whether the violations of the constraints are within the tolerance, and those of the equations of signals within
/// left_open times the tolerance: the kinks of their formulas make predictions from rates of convergence unreliable.
bool is_closed(const System& system, const ResidualSize& r, double tolerance);

/// Whether a residual above the tolerance after iteration k of statics may come from rounded positions: the last two
/// corrections, `previous` and `change`, no longer shrink, or they shrink so fast (quadratically) that the next one
/// would be negligible.
inline bool may_be_round_off(int k, double change, double previous, double tolerance) {
  if (change == 0.0) return true;
  return k > 1 && (change > shrinks * previous || change * change <= left_open * tolerance * previous);
}

/// Whether a residual above the tolerance is within the round-off floor.
bool is_at_floor(const System& system, const ResidualSize& r, double tolerance);

/// Describes the largest part of the residual for a message.
std::string describe(System& system, ResidualSize r, double tolerance);

/// In statics, whether all joints are closed, also those without unknowns, whose rows no residual shows.
[[nodiscard]] std::optional<Trouble> check_closed(const System& system, const State& state);

}  // namespace bough::step
