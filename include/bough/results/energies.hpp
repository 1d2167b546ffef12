#pragma once
/// Energies and momentum of the whole structure, elements of one kind eight at a time.
#include <memory>
#include <vector>

#include "bough/plan/stores.hpp"
#include "bough/step/system.hpp"

namespace bough::results {

/// Energies and momentum with respect to the inertial frame, in its axes.
struct Energies {
  double kinetic = 0.0;    ///< [J]
  double strain = 0.0;     ///< [J]
  double potential = 0.0;  ///< of gravity, about the inertial origin [J]
  /// (linear; angular about the inertial origin); the latter of scenes in a plane about its normal, and zero where
  /// nothing turns.
  motion::Vec6<double> momentum = motion::Vec6<double>::zero();
  double total() const { return kinetic + strain + potential; }
};

/// Evaluates the elements of a plan that store energy or carry momentum, on the group of the scene, sorted into lanes
/// once. Sums go over fixed chunks, so the bits do not depend on the number of threads. In scenes with moving frames,
/// and where a law changes their stiffness, elements are evaluated one by one.
class EnergyMeter {
 public:
  explicit EnergyMeter(const plan::Plan& plan);
  ~EnergyMeter();
  EnergyMeter(const EnergyMeter& other);
  EnergyMeter& operator=(const EnergyMeter& other);
  /// The laws of the system have to be evaluated at the state's time. No allocation after the first call.
  Energies eval(const step::System& system, const step::State& state);

 private:
  class Sorted;
  template <class G>
  class SortedOn;
  double stored(const step::System& system, const step::State& state) const;

  std::unique_ptr<Sorted> sorted_;
};

}  // namespace bough::results
