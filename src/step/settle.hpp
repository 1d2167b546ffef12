#pragma once
/// Digits of forces in statics, beyond those of rounded positions. Internal to step.
#include "bough/step/system.hpp"

namespace bough::step {

/// Solves once more at an equilibrium, with the matrix that led to it. The position of a node is rounded, by u |x|, and
/// a stiff element responds with forces of EA u |x| / L that no load balances. With the solution eta, stored separately
/// in State::unsettled, forces f + K eta are in equilibrium to round-off of their own size. Multipliers take their
/// part. If the solution fails, there is no `unsettled`.
void settle(System& system, State& state);

}  // namespace bough::step
