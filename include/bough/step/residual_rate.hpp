#pragma once
/// The time derivative of the residual along a motion.
#include <vector>

#include "bough/step/system.hpp"

namespace bough::step {

/// d(residual)/dt with multipliers and rates of states held, by unknown; signals follow the motion. step_size: the
/// interval over which third derivatives of prescribed motions are differenced; 0: these are left out. jerk: d2v/dt2 of
/// all nodes as a vector of unknowns; null: dv/dt is held. The laws of the state's time are set.
void evaluate_rate(System& system, const State& state, std::vector<double>& rate, double step_size = 0.0,
                   const std::vector<double>* jerk = nullptr);

}  // namespace bough::step
