#pragma once
#include <string>

#include "bough/step/system.hpp"

namespace bough::run {

/// Names the joints whose reactions are not unique according to the last factorization, grouped by connecting nodes:
/// "joints 'a', 'b', 'c' and 7 others connected to them; joint 'd'".
std::string dependent_groups_text(const step::System& system);

}  // namespace bough::run
