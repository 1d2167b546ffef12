#pragma once
/// Inputs and outputs of linearised equations (scene/linear_inputs.hpp).
#include <span>
#include <string>
#include <vector>

#include "about_state.hpp"
#include "bough/records/run.hpp"
#include "bough/results/energies.hpp"

namespace bough::run {

/// An input or a column of a sensor.
struct LinearPort {
  std::string name, unit;
  std::size_t place = 0;  ///< of an input its unknown, of an output its column in the header
};

/// The inputs that the analysis of a scene names. A right-hand side is a one at the unknown of the input.
std::vector<LinearPort> inputs_of(const scene::Scene& scene, const step::System& system);
/// The columns of the sensors that the analysis names, or of all.
std::vector<LinearPort> outputs_of(const scene::Scene& scene, const records::HistoryHeader& header);

/// Derivatives of sensors along motions about a state, by central differences of order six: their error is 1e-12 of
/// the derivative or less where nothing bends by much within a hundredth of the size of the structure.
class OutputSlopes {
 public:
  /// Keeps the references.
  OutputSlopes(step::System& system, const step::State& state, const AboutState& about);

  /// Derivatives of all columns along x with rates x' and x'', vectors by unknown: nodes in their own axes, multipliers
  /// and signals. frequency: at which these vibrate [rad/s], by which rates are measured; 0: they are not.
  const std::vector<double>& eval(std::span<const double> x, std::span<const double> rate,
                                  std::span<const double> second, double frequency = 0.0);
  /// Whether one of some outputs changes where a node moves in all of its directions.
  bool depend_on(std::size_t node, const std::vector<LinearPort>& outputs);

 private:
  double size_of_motion(std::span<const double> x) const;
  void displace(double by, std::span<const double> x, std::span<const double> rate, std::span<const double> second);

  step::System& system_;
  const step::State& state_;
  const AboutState& about_;
  results::EnergyMeter meter_;
  step::State displaced_;
  std::vector<double> values_, slopes_, at_rest_;  ///< of all columns
};

}  // namespace bough::run
