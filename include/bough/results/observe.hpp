#pragma once
/// What a run looks at in a state: sensors, balances, the moving structure. Reads states, changes none.
#include <vector>

#include "bough/results/records.hpp"
#include "bough/step/system.hpp"

namespace bough::results {

/// Column names of a plan's sensors.
HistoryHeader make_header(const plan::Plan& plan);

/// Values of all sensors, in the order of the header. Laws of the system must stand at the state's time.
void eval_sensors(const step::System& system, const step::State& state, std::vector<double>& values);

/// Sums of energies, powers and momentum over all elements, in a fixed order.
elements::Measures eval_measures(const step::System& system, const step::State& state);

/// The moving structure, with section resultants at the beams' nodes.
MotionFrame eval_motion(const step::System& system, const step::State& state);

/// Balances from step to step; work and impulse by the trapezoidal rule on the steps' own ends.
class Balance {
 public:
  void begin(const elements::Measures& start);
  /// After a jump (breakpoint): what is there now counts as start of the next interval, the energy of the jump is no error.
  void jump(const elements::Measures& after);
  void add(const elements::Measures& now, double step_size);
  double energy_error() const {
    return energy_error_;
  }  ///< largest |kinetic + strain + potential - work + dissipation - start| [J]
  double energy_scale() const { return energy_scale_; }     ///< largest sum of magnitudes [J]
  double last_energy_error() const { return last_error_; }  ///< signed, now: negative is energy taken by the integrator
  double momentum_error() const { return momentum_error_; }  ///< largest |linear momentum - impulse - start| [kg m/s]
  double momentum_scale() const { return momentum_scale_; }

 private:
  elements::Measures last_;
  double start_energy_ = 0.0, work_ = 0.0;
  double energy_error_ = 0.0, energy_scale_ = 0.0, last_error_ = 0.0, momentum_error_ = 0.0, momentum_scale_ = 0.0;
  motion::Vec6<double> expected_ = motion::Vec6<double>::zero();
};

}  // namespace bough::results
