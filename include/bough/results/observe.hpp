#pragma once
/// What a run looks at in a state: sensors, the moving structure. Reads states, changes none.
#include <span>
#include <vector>

#include "bough/records/run.hpp"
#include "bough/results/energies.hpp"
#include "bough/step/system.hpp"

namespace bough::results {

/// Values of all sensors, in the order of the header. Laws of the system must stand at the state's time.
void eval_sensors(const step::System& system, const step::State& state, EnergyMeter& meter,
                  std::vector<double>& values);

/// The same of some sensors, by their places in Plan::sensors, one after the other.
void eval_sensors(const step::System& system, const step::State& state, EnergyMeter& meter,
                  std::span<const int> sensors, std::vector<double>& values);

/// Whether a sensor shows places, rotations and velocities alone: between two steps these follow from
/// step::eval_between. Forces, strains, energies and accelerations do not: a stiff part answers to the smallest error
/// of a place.
bool shows_motion(scene::SensorKind kind);
/// Adds the nodes that a sensor of motion looks at.
void append_nodes_of(const plan::Plan& plan, const plan::SensorPlan& sensor, std::vector<int>& nodes);

/// Values of the sensors that show motions, in their places; 0 for the others.
void eval_motion_sensors(const step::System& system, const step::State& state, std::vector<double>& values);

/// Sections, surfaces, kinds and sub-domains of what eval_motion shows, in the same order.
records::MotionParts make_parts(const scene::Scene& scene, const step::System& system);

/// The moving structure, with section resultants along the beams: four intervals an element, since the axis is curved
/// within it; of structures of more than a thousand elements two, of more than four thousand one.
records::MotionFrame eval_motion(const step::System& system, const step::State& state);

}  // namespace bough::results
