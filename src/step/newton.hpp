#pragma once
/// Bounds and questions that the iterations in time (newton_iteration.hpp) and in statics (equilibrate.cpp) share.
#include "bough/step/advance.hpp"

namespace bough::step {

/// Changes that an own factor contracts less than this do not come from a whole tangent of a smooth system.
constexpr double slowest_contraction = 0.03;

/// Residual and change that an iteration may leave, measured or to be expected from its contraction, relative to the
/// tolerance: an old factor must come as near as a new one, since errors of steps add up.
constexpr double left_open = 1e-3;

/// Changes of relative motions that are round-off at any tolerance.
constexpr double least_change = 4e-15;

/// Changes whose ratio is above this no longer shrink: what is left may be round-off.
constexpr double shrinks = 0.3;

/// What was not measured is taken to be this much larger than the last ratio of changes or residuals lets expect.
constexpr double unseen_growth = 1.2;

/// What the local error of the last step asks of an iteration beside the tolerance; as made: nothing.
struct IterationGoal {
  double residual = 1.0;   ///< that may be left, relative to what makes it [-]
  double round_off = 0.0;  ///< changes of relative motions that rounding of a step's increments makes [-]
};

/// Iterations may leave 3e-5 of the local error, as a residual relative to what makes it, down to 1e-13. Nothing is
/// asked where the error is round-off itself, as where drives prescribe all motion, nor after a start.
IterationGoal make_goal(const State& start);

/// The largest of forces, moments, lengths and angles of a residual, each relative to what makes it.
double largest_share(const System& system, const ResidualSize& r);

/// Whether that is within the tolerance.
bool is_small(const System& system, const ResidualSize& r, double tolerance);

/// Whether `share` of a residual may be left where the motion still lacks `error`, relative: within left_open of the
/// tolerance, or, below the tolerance, within the round-off that iterations met. Where the goal asks for less, it is
/// met, or what is left is round-off of poses, or of reactions alone, which move nothing any more and do not add up
/// over steps.
bool is_settled(const System& system, const ResidualSize& r, double tolerance, const IterationGoal& goal, double error,
                double share = 1.0);

/// Whether a residual, `size` of what makes it, is much larger than `expected` of it and yet, below the tolerance, as
/// small as round-off can make it.
bool is_noise(const System& system, const ResidualSize& r, double tolerance, double size, double expected);

/// Whether the gaps of joints are within the tolerance.
bool is_closed(const System& system, const ResidualSize& r, double tolerance);

/// Whether iteration k of statics leaves a residual above the tolerance that may be what rounded places leave:
/// changes, the last one and that before, no longer shrink, or shrink so fast that the next would be negligible.
inline bool may_be_round_off(int k, double change, double previous, double tolerance) {
  if (change == 0.0) return true;
  return k > 1 && (change > shrinks * previous || change * change <= left_open * tolerance * previous);
}

/// Whether what is left of a residual above the tolerance may be round-off.
bool is_at_floor(const System& system, const ResidualSize& r, double tolerance);

/// Names the part of the residual that is worst, for a message.
std::string describe(System& system, ResidualSize r, double tolerance);

}  // namespace bough::step
