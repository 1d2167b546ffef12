#pragma once
/// The profile of a tree for the terminal.
#include <string>

#include "bough/records/profile.hpp"

namespace bough::app {

/// How a terminal wants its text.
struct TextStyle {
  int width = 100;       ///< columns
  bool colors = false;   ///< ANSI escapes
  bool unicode = false;  ///< lines and bars drawn with more than ASCII
};

/// What standard output can show: its width, no colours where it is no terminal, NO_COLOR is set or TERM is dumb;
/// Unicode in a UTF-8 locale.
TextStyle style_of_terminal();

/// The hierarchy from the root down, the costliest branches opened up to `most_rows` rows, every row with unknowns,
/// interface, time and share; equal leaves go together. Then the sums: step, threads, memory, other trees.
std::string tree_text(const records::Profile& profile, const TextStyle& style, int most_rows = 40);

}  // namespace bough::app
