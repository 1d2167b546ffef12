#pragma once
#include <string>

#include "bough/step/system.hpp"

namespace bough::run {

/// The joints whose reactions are not unique by the last factorization, in groups that nodes connect:
/// "joints 'a', 'b', 'c' and 7 others connected to them; joint 'd'".
std::string dependent_groups_text(const step::System& system);

}  // namespace bough::run
