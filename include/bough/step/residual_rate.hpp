#pragma once
/// The time derivative of the residual along a motion.
#include <vector>

#include "bough/step/system.hpp"

namespace bough::step {

/// d(residual)/dt with accelerations, multipliers and rates of states held, by unknown; signals follow the motion.
/// step_size: the interval over which third
/// derivatives of prescribed motions are differenced; 0: these are left out. The laws of the state's time are set.
void evaluate_rate(System& system, const State& state, std::vector<double>& rate, double step_size = 0.0);

}  // namespace bough::step
