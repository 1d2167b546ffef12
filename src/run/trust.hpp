#pragma once
#include <string>
#include <vector>

#include "bough/records/run.hpp"

namespace bough::run {

/// Where a run is doubted. Each bound lies well above what the gallery shows and below what an engineer would accept
/// unsaid.
struct TrustLimits {
  /// Of the largest speed: a given initial velocity that the start changes by more is not the one asked for. Numbers
  /// in a scene have six digits at
  /// least, so what is less may be their rounding; a note tells it.
  double velocity_changed = 1e-6;
  /// Of the largest energy: what the integrator may have added by the end. A scheme that is stable adds what its
  /// truncation error is; a hundredth is visible in amplitudes (their half).
  double energy_gained = 1e-2;
  /// Of the largest energy: the same for what it took. Damping of unresolved vibrations is meant, a tenth of
  /// all energy changes amplitudes by a twentieth.
  double energy_taken = 0.1;
  /// Of the range of a sensor: its estimated error by the end (ErrorWatch), which is right within a factor of three. So
  /// runs are doubted that are wrong by 12 %, which shows in a picture, and none that is right to 1 %. Scenes of the
  /// gallery stay below 3.3 %.
  double sensor_error = 0.04;
  /// The same of the size of the structure, or 1 rad, of the sum of local errors, where no sensor shows a motion.
  double local_error_sum = 0.04;
  /// LAPACK's bar for a solution: residual over norm, unknowns and unit round-off.
  double lapack_ratio = 30.0;
  /// What one more correction changes of a displacement or of a reaction, over the largest: fewer than three digits
  /// are sure.
  double lost = 1e-3;
  /// Of the size of the parts that meet in a joint, or rad: open by more than a millionth.
  double violation = 1e-6;
  /// The same for what the rates open in one step: a thousandth.
  double violation_step = 1e-3;
  /// Of the largest force: what steps in time accepted at the floor of round-off leave unbalanced. Reactions and
  /// section forces have that error; a tolerance that asks for more digits than there are is no reason for doubt. In
  /// statics nothing stays unbalanced, see step::System::settle.
  double unbalanced = 1e-6;
  /// Share of the steps that were rejected: the step size is not that of the problem.
  double rejected = 0.1;
};

/// Given initial velocities that the start has changed: the three changed most, asked and got, and how many others.
std::string describe(const std::vector<records::ChangedVelocity>& changed);

/// Why a run should not be trusted without a closer look, in words: about the run itself (it broke off), initial
/// velocities, energy, errors, linear solutions, condition, constraints, stability, round-off, steps. Reads the
/// summary's status, changed velocities, steps, checks, levels and solver figures.
std::vector<records::Doubt> doubts_of(const records::Summary& summary, bool is_dynamic, const TrustLimits& limits = {});

}  // namespace bough::run
