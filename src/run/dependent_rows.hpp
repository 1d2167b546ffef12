#pragma once
#include <span>
#include <string>

#include "bough/step/system.hpp"

namespace bough::run {

/// Names the joints whose reactions are not unique according to a factorization, which gives `blocks` (of the solver's
/// blocks_not_unique()), grouped by connecting nodes: "joints 'a', 'b', 'c' and 7 others connected to them; joint 'd'".
std::string dependent_groups_text(const step::System& system, std::span<const int> blocks);

}  // namespace bough::run
