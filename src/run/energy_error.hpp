#pragma once
#include "bough/plan/plan.hpp"
#include "bough/results/energies.hpp"

namespace bough::run {

/// Local errors of energies, for step control: of those that sensors show, and of kinetic and strain energy where they
/// show forces or accelerations, which answer to vibrations of all parts.
///
/// With the local errors e_q of places and e_v of velocities of a step,
///   e_E = E(q + e_q, v + e_v) - E(q, v)
/// for each kind of energy. To first order the kinetic part is the sum of p . e_v over all nodes, p their
/// momenta: each velocity counts by what it does to the energy. A vibration faster than the step has an e_v as large as
/// its own velocities, and counts with its share of the energy, where the largest of its velocities would ask for steps
/// that resolve it.
class EnergyError {
 public:
  /// Whether a sensor shows an energy, a force or an acceleration.
  static bool is_needed(const plan::Plan& plan);
  /// mass: of the structure [kg]. duration: of the run [s].
  EnergyError(const plan::Plan& plan, double duration, double mass);

  /// Largest error of an energy that counts, over the largest sum of kinetic and strain energy and of the change of the
  /// potential so far; that of all mass at the size of the structure in the time of the run at the least [-].
  double eval(const step::System& system, const step::State& after, const step::State& disturbed,
              results::EnergyMeter& meter);

 private:
  bool of_kinetic_ = false, of_strain_ = false, of_potential_ = false, of_total_ = false;
  double largest_;  ///< [J]
  double first_potential_ = 0.0;
  bool has_first_ = false;
};

}  // namespace bough::run
