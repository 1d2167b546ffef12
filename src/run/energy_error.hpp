#pragma once
#include "bough/plan/plan.hpp"
#include "bough/results/energies.hpp"

namespace bough::run {

/// Local errors of energies for step control: of energies shown by sensors, and of kinetic and strain energy if sensors
/// show forces or accelerations, which respond to vibrations of all parts.
///
/// With the local errors e_q of places and e_v of velocities of a step,
///   e_E = E(q + e_q, v + e_v) - E(q, v)
/// for each kind of energy. To first order the kinetic part is the sum of p . e_v over all nodes, p their momenta: each
/// velocity counts by its effect on the energy. A vibration faster than the step has an e_v as large as its own
/// velocities, and counts with its share of the energy, where the largest of its velocities would ask for steps that
/// resolve it.
class EnergyError {
 public:
  /// Whether a sensor shows an energy, a force or an acceleration.
  static bool is_needed(const plan::Plan& plan);
  /// mass: of the structure [kg]. duration: of the run [s].
  EnergyError(const plan::Plan& plan, double duration, double mass);

  /// Largest error among the energies that count, relative to the largest sum so far of kinetic energy, strain energy
  /// and the change of the potential [-]. That sum is at least the kinetic energy of the whole mass at a speed of one
  /// size of the structure per duration of the run.
  double eval(const step::System& system, const step::State& after, const step::State& disturbed,
              results::EnergyMeter& meter);
  void checkpoint(records::Archive& archive) { archive(largest_, first_potential_, has_first_); }

 private:
  bool of_kinetic_ = false, of_strain_ = false, of_potential_ = false, of_total_ = false;
  double largest_;  ///< [J]
  double first_potential_ = 0.0;
  bool has_first_ = false;
};

}  // namespace bough::run
