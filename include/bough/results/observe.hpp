#pragma once
/// Results of a state: values of sensors, and the moving structure for pictures. States are read, never changed.
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "bough/records/run.hpp"
#include "bough/results/energies.hpp"
#include "bough/step/system.hpp"

namespace bough::results {

/// Values of all sensors, in the order of the header. The laws of the system have to be evaluated at the state's time.
void eval_sensors(const step::System& system, const step::State& state, EnergyMeter& meter,
                  std::vector<double>& values);

/// Values of the sensors with the given indices in Plan::sensors, in that order.
void eval_sensors(const step::System& system, const step::State& state, EnergyMeter& meter,
                  std::span<const int> sensors, std::vector<double>& values);

/// A message if a sensor names a sub-domain that the tree of the solver does not have.
std::optional<std::string> unknown_subdomain(const step::System& system);

/// Whether a sensor shows positions, rotations and velocities only. Such sensors can be interpolated between two steps
/// with step::eval_between. Forces, strains, energies and accelerations cannot: in a stiff part, they respond to the
/// smallest error of a position.
bool shows_motion(scene::SensorKind kind);
/// Appends the nodes from which a sensor of motion is evaluated.
void append_nodes_of(const plan::Plan& plan, const plan::SensorPlan& sensor, std::vector<int>& nodes);

/// The sensors that show motions, evaluated on the nodes that they read alone. Allocates when made and at the first
/// state, not afterwards.
class MotionSensors {
 public:
  explicit MotionSensors(const plan::Plan& plan);
  /// Takes time, signals and turns of a state, and the motions of these nodes in space.
  void see(const plan::Plan& plan, const step::State& state);
  /// Values for what is seen, at the indices of the sensors; 0 for all others.
  void eval(const step::System& system, std::vector<double>& values) const;
  /// Nodes that are read, ascending.
  std::span<const int> nodes() const { return nodes_; }
  /// Motion of one of these, which may be changed before values are asked for.
  elements::NodeMotion& motion(int node);
  void checkpoint(records::Archive& archive) { archive(seen_); }

 private:
  std::vector<int> nodes_;
  step::State seen_;  ///< in space, of which only what is seen is set
};

/// Sections, surfaces, kinds and sub-domains of the parts in eval_motion's frames, in the same order.
records::MotionParts make_parts(const scene::Scene& scene, const step::System& system);

/// The moving structure, with section resultants along the beams. An element is drawn with four intervals, since its
/// axis is curved; structures of more than a thousand elements with two, of more than four thousand with one.
records::MotionFrame eval_motion(const step::System& system, const step::State& state);

}  // namespace bough::results
