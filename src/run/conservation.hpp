#pragma once
/// Checks of energy, momentum and constraints during a run.
#include "bough/records/run.hpp"
#include "bough/results/balance.hpp"
#include "bough/scene/scene.hpp"
#include "bough/step/options.hpp"
#include "bough/step/system.hpp"
#include "error_watch.hpp"
#include "finite_gate.hpp"

namespace bough::run {

/// Compares the changes of energy and momentum with the work and the impulse of loads and drives, and keeps the largest
/// violations of constraints.
class Conservation {
 public:
  /// Keeps the references. has_balance: whether the work of every step is summed.
  Conservation(const step::System& system, bool has_balance);

  bool has_balance() const { return has_balance_; }
  results::EnergyMeter& energies() { return energy_meter_; }
  const results::Balance& balance() const { return balance_; }
  double mass() const { return work_meter_.mass(); }  ///< of the whole structure [kg]

  void checkpoint(records::Archive& archive) { archive(work_meter_, balance_, open_joint_, fast_joint_); }

  /// Starts the balances at the consistent initial state.
  void begin(const step::State& state);
  /// Continues the balances after a jump in a load or a motion. before: energies before the jump.
  void jump(const results::Energies& before, const step::State& state);
  /// Adds the work of an accepted step of this size.
  void add_step(const step::State& state, double step_size);
  /// Compares energy and momentum with the supplied work and impulse.
  void compare(const step::State& state) {
    balance_.compare(energy_meter_.eval(system_, state), work_meter_.supply(), work_meter_.mass(), plan_.length_scale);
  }

  /// Performs the checks of a row: violations of constraints and, where work is summed in dynamics, balances.
  /// error_watch may be null.
  void check(const step::State& state, double step_size, records::Checks& checks, FiniteGate& gate,
             ErrorWatch* error_watch);
  /// Writes the results of the whole run to the checks. In dynamics `duration` is the end time [s].
  void sum_up(records::Checks& checks, const step::StepOptions& options, double duration) const;

  /// What round-off and the tolerance explain of an energy balance [J].
  double energy_round_off(const step::StepOptions& options, double duration) const;

 private:
  const step::System& system_;
  const plan::Plan& plan_;
  bool has_balance_;
  results::WorkMeter work_meter_;
  results::EnergyMeter energy_meter_;
  results::Balance balance_;
  int open_joint_ = -1, fast_joint_ = -1;  ///< with the largest relative violations, in Plan::joints
};

}  // namespace bough::run
