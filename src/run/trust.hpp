#pragma once
#include <string>
#include <vector>

#include "bough/records/run.hpp"

namespace bough::run {

/// Bounds above which a run is doubted. Each is well above the values of the gallery, and below what an engineer would
/// accept without being told.
struct TrustLimits {
  /// Change of a given initial velocity by the consistent start, relative to the largest speed. Numbers in a scene have
  /// at least six digits, so smaller changes may be due to their rounding; a note reports them.
  double velocity_changed = 1e-6;
  /// Energy added by the integrator by the end, relative to the largest energy. A stable scheme adds no more than its
  /// truncation error. A hundredth of the energy is half a hundredth of amplitudes, which is visible.
  double energy_gained = 1e-2;
  /// Energy taken by the integrator, relative to the largest energy. Unresolved vibrations are damped on purpose; a
  /// tenth of all energy changes amplitudes by a twentieth.
  double energy_taken = 0.1;
  /// Momentum that no impulse explains, over the largest momentum or impulse: a body whose path bends by a
  /// hundredth lands visibly elsewhere.
  double momentum_lost = 1e-2;
  /// Energy balance at any time, relative to the largest energy: what the integrator added or took on the way, or an
  /// energy that is not counted.
  double energy_balance = 0.1;
  /// Estimated error of a sensor by the end (ErrorWatch), relative to its range. The estimate is right within a factor
  /// of three. Runs with errors of 12 %, which are visible in a picture, are thus always doubted, and runs right to 1 %
  /// never. Scenes of the gallery stay below 3.3 %.
  double sensor_error = 0.04;
  /// Sum of local errors, relative to the size of the structure or 1 rad. Used if no sensor shows a motion.
  double local_error_sum = 0.04;
  /// LAPACK's test ratio for a linear solution: its residual over the norm, the number of unknowns and the unit
  /// round-off.
  double lapack_ratio = 30.0;
  /// Change of a displacement or a reaction by one more Newton correction, relative to the largest: fewer than three
  /// digits are certain above this.
  double lost = 1e-3;
  /// Violation of constraints, relative to the size of the parts that meet in a joint, or in rad.
  double violation = 1e-6;
  /// The same for the violation that rates of constraints cause in one step.
  double violation_step = 1e-3;
  /// Unbalanced force of steps in time accepted at the round-off floor, relative to the largest force. Reactions and
  /// section forces have this error. Reaching the floor alone is no reason for doubt, since the tolerance may just ask
  /// for more digits than there are. In statics no force stays unbalanced, see step/settle.hpp.
  double unbalanced = 1e-6;
  /// Rejected steps per accepted step: above this, the step size does not suit the problem.
  double rejected = 0.1;
};

/// What doubts of estimated errors are about in a run with twins.
inline constexpr const char* estimate_beside_twins = "estimated error";

/// What doubts take into account besides the summary.
struct TrustContext {
  /// Errors of reactions below `TrustLimits::unbalanced` times this do not count, where all reactions are zero but for
  /// round-off [N].
  double least_force = 0.0;
  /// Of sensitive motions: the time in which an error grows by e, at the end [s]; 0: it grows no faster than a power.
  double errors_grow_in = 0.0;
  /// What doubts of the estimated errors are about: where twins measure errors, these may take their place.
  const char* about_estimate = "error";
};

/// Describes the given initial velocities that the start has changed: the three largest changes, with given and actual
/// values, and the number of others.
std::string describe(const std::vector<records::ChangedVelocity>& changed);

/// Reasons in words why a run should not be trusted without a closer look. They concern the run itself (it broke off),
/// initial velocities, energy, errors, linear solutions, condition, constraints, stability, round-off and steps. Reads
/// the status, changed velocities, steps, checks, levels and solver figures of the summary.
std::vector<records::Doubt> doubts_of(const records::Summary& summary, bool is_dynamic, const TrustLimits& limits = {},
                                      const TrustContext& more = {});

}  // namespace bough::run
