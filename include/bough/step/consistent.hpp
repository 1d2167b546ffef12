#pragma once
/// Consistent states on either side of a jump.
#include "bough/step/advance.hpp"

namespace bough::step {

/// make_consistent, with laws that jump at the state's time at their values on `side` of it.
StartReport make_consistent_on(System& system, State& state, bool fix_positions, double step_size, laws::Side side);

}  // namespace bough::step
