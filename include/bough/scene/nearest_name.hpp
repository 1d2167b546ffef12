#pragma once
/// The known name a misspelt one was probably meant to be.
#include <span>
#include <string>
#include <string_view>

namespace bough::scene {

/// Edit distance with insertions, deletions, substitutions and swaps of neighbours (optimal string alignment),
/// letters compared without case at half cost. In half steps: 2 per edit, 1 per difference of case.
int edit_distance(std::string_view a, std::string_view b);

/// Searches for the known names that misspelt ones were meant to be. Each compares a word with all names, so that those
/// of thousands of misspelt names would take time in proportion to the square of their number: together they compare
/// some 1e7 letters (some tenths of a second), and find nothing after that.
class NameSearch {
 public:
  /// The nearest of `known`, the first of equals; empty where none is near (more than a third of the letters, at least
  /// one edit).
  std::string nearest(std::string_view word, std::span<const std::string> known);
  bool is_spent() const;

 private:
  double letters_ = 0.0;  ///< compared so far
};

/// The same for a single word.
std::string nearest_name(std::string_view word, std::span<const std::string> known);

}  // namespace bough::scene
