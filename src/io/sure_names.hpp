#pragma once
/// What a misspelt word can only have been meant to be. `scene::nearest_name` suggests; these decide whether a program
/// may change a file without asking, so they would rather find nothing.
#include <span>
#include <string>
#include <string_view>

namespace bough::io {

/// Of the words of a closed vocabulary (keys, kinds) the only one that is near: at most one letter of four is wrong, the
/// digits are the same, and every other word is two letters farther away. Empty where there is none, or below four
/// letters.
std::string only_word(std::string_view word, std::span<const std::string> words);

/// A text that reads as a number of JSON and nothing else, as of a number in quotes.
bool is_number_text(const std::string& text);

/// Of the names of a file the only one of which a word is a slip: letters in another case, another of `_`, `-` and
/// space, two neighbours exchanged, or one letter missing or doubled within. No digit, and neither the first nor the last
/// letter, is added or left out: these tell names of things apart, and the thing that is named may be missing.
/// Empty where there is none, or several.
std::string only_name(std::string_view word, std::span<const std::string> names);

}  // namespace bough::io
