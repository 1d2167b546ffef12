#pragma once
/// Short labels in pictures of pixels.
#include <array>
#include <string_view>
#include <vector>

namespace bough::report {

inline constexpr int letter_step = 6, letter_height = 7;  ///< of letters of 5 x 7 dots [dots]

/// Dots of a label, x to the right and y down from its upper left corner. It knows digits, the letters of units and of
/// "load factor", and . - + =; other characters are blanks.
std::vector<std::array<int, 2>> dots_of(std::string_view text);

}  // namespace bough::report
