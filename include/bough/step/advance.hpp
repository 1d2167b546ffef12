#pragma once
/// Verbs that take a state to the next: consistent start, one step in time, one step of load.
#include <array>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "bough/step/options.hpp"
#include "bough/step/system.hpp"

namespace bough::step {

/// Outcome of one attempt.
struct StepReport {
  static constexpr int remembered_changes = 32;
  bool converged = false;
  bool at_floor = false;  ///< accepted at the round-off floor of the residual, above the tolerance
  int iterations = 0;     ///< linear solutions
  double change = 0.0;    ///< last change of relative motions
  ResidualSize residual;  ///< at the end
  std::string cause;      ///< why not, when not converged
  std::array<double, remembered_changes> change_list{};
  /// Changes of the first iterations (statics: shows the quadratic convergence).
  std::span<const double> changes() const {
    return {change_list.data(),
            static_cast<std::size_t>(iterations < remembered_changes ? iterations : remembered_changes)};
  }
};

/// Outcome of a consistent start.
struct StartReport {
  bool ok = false;
  std::string cause;
  double position_correction = 0.0;  ///< largest change of relative motions that closed the constraints
  int open_joint = -1;               ///< that was open the widest before, relative to the parts that meet in it
  double gap = 0.0;                  ///< by so much of their length, or rad
  double velocity_impulse =
      0.0;  ///< largest multiplier of the velocity projection: an impulse where a driven rate meets rest [N s, N m s]
  double velocity_change = 0.0;  ///< largest change of a velocity, relative to the largest speed before or after [-]
};

/// Makes a state consistent at its time (a start, or the far side of a jump in a load or motion):
///   positions   [M G^T; G 0] (eta, mu) = (0, -Phi)      repeated
///   velocities  [M G^T; G 0] (dv, mu)  = (0, -Phi')
///   accelerations and multipliers  [M G^T; G 0] (a, lambda) = (-(forces), -Phi''|_{a = 0})
/// M may be singular where constraints hold. Fails where constraints contradict each other: a gap above 1e-9 of the
/// size of the parts that meet in a joint (or rad) is left, or a rate above 1e-8 of the largest speed and above what
/// opens 1e-12 in one step of `step_size` [s].
StartReport make_consistent(System& system, State& state, bool fix_positions, double step_size);

/// make_consistent, with laws that jump at the state's time at their values on `side` of it.
StartReport make_consistent_on(System& system, State& state, bool fix_positions, double step_size, laws::Side side);

/// Prepares generalized-alpha for step size h from a consistent state: a_n = dv/dt + shift h (d2v/dt2), and
/// velocities moved along the constraints' normals by the steady error of the index-3 scheme, so that positions,
/// velocities and multipliers are of second order from the first step on (Arnold, Bruls, Cardona 2015, sect. 5).
StartReport start_alpha(System& system, State& state, const StepOptions& options, double step_size);

/// The same when only the step size changes: dv/dt and multipliers stay, d2v/dt2 is solved for anew. (a_n - dv/dt
/// holds it, too, but with the slowly fading oscillations of earlier changes, which a few changes in a row would
/// amplify.)
StartReport change_step_size(System& system, State& state, const StepOptions& options, double step_size);

/// Takes `state` to where Newton starts for a step to `end_time`: dv/dt stays, all else follows. `slopes`: those of
/// the iteration.
[[nodiscard]] std::optional<Trouble> predict(System& system, State& state, const StepOptions& options, double end_time,
                                             elements::Slopes& slopes);

/// One step of Lie-group generalized-alpha, index 3 (Bruls, Cardona, Arnold 2012), from `state` over h to `state`.
/// Not converged: `state` is as it was. Where laws jump at the end, they have their values on `side` of it.
StepReport advance(System& system, State& state, const StepOptions& options, double end_time,
                   laws::Side side = laws::Side::left);

/// Equilibrium at a load factor, by Newton from the present shape. Not converged: `state` is as it was.
StepReport equilibrate(System& system, State& state, const StepOptions& options, double load_factor);

/// Whether joints stayed on their branch (no flipped poses) and relative rotations below pi; else says what happened.
/// Sets State::shape_margin.
std::optional<Trouble> check_shape(const System& system, State& state);

/// New counts of turns after an accepted step, for Plan::turning_joints.
void accept_turns(const System& system, State& state);

}  // namespace bough::step
