#pragma once
#include <string>

#include "bough/step/linearisation.hpp"

namespace bough::run {

/// From where the linearised equations of a state that moves are the same at all times.
struct Steadiness {
  bool from_ground = true;  ///< from axes that stand still, as of symmetric parts that turn in bearings; else from the
                            ///< nodes' own, as of a structure that turns as one
  std::string doubt;        ///< why from neither, in words
};

/// Compares K, C and M of a state with those of the state in which every node has gone on along its own screw for a
/// while, by their products with a vector. linear: those of the state, as they were taken.
Steadiness look_at_steadiness(step::System& system, const step::Linearisation& linear, const step::State& state);

}  // namespace bough::run
