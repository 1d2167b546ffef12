#pragma once
#include <vector>

#include "bough/step/modes.hpp"
#include "recording.hpp"

namespace bough::run {

/// Pictures of one period of each mode about a state, mode k from time k - 1 to time k. What moves most moves by 6 % of
/// the size of the structure, or turns by 0.4 rad. There are 300 pictures at most.
void draw_modes(Recording& recording, const step::System& system, const step::State& about,
                const std::vector<step::Mode>& modes);

}  // namespace bough::run
