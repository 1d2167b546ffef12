#pragma once
/// What a run looks at in a state: sensors, the moving structure. Reads states, changes none.
#include <vector>

#include "bough/results/energies.hpp"
#include "bough/results/records.hpp"
#include "bough/step/system.hpp"

namespace bough::results {

/// Column names of a plan's sensors.
HistoryHeader make_header(const plan::Plan& plan);

/// Values of all sensors, in the order of the header. Laws of the system must stand at the state's time.
void eval_sensors(const step::System& system, const step::State& state, EnergyMeter& meter,
                  std::vector<double>& values);

/// The moving structure, with section resultants at the beams' nodes.
MotionFrame eval_motion(const step::System& system, const step::State& state);

}  // namespace bough::results
