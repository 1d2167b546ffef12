#pragma once
/// The known name a misspelt one was probably meant to be.
#include <span>
#include <string>
#include <string_view>

namespace bough::scene {

/// Edit distance with insertions, deletions, substitutions and swaps of neighbours (optimal string alignment),
/// letters compared without case at half cost. In half steps: 2 per edit, 1 per difference of case.
int edit_distance(std::string_view a, std::string_view b);

/// The nearest of `known`, the first of equals; empty where none is near (more than a third of the letters, at least
/// one edit).
std::string nearest_name(std::string_view word, std::span<const std::string> known);

}  // namespace bough::scene
