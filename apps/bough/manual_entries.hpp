#pragma once
/// The manual as entries that can be looked up: its sections by their headings, the rows of its tables by their first
/// cells.
#include <string>
#include <string_view>
#include <vector>

namespace bough::app {

struct ManualEntry {
  std::string page;                ///< "data/manual/guides/trust.md"
  std::string title;               ///< of the section, or of that in which the row stands
  std::vector<std::string> words;  ///< in small letters: the title, or the words of the first cell
  std::string text;                ///< what is printed, without marks of Markdown for links
  bool is_row = false;
};

/// All entries: messages and words first, then guides, tutorials, theory and what is for builders.
std::vector<ManualEntry> manual_entries();

std::string in_small_letters(std::string_view text);

/// The title of a section holds this word.
bool title_holds(const ManualEntry& entry, const std::string& word);

}  // namespace bough::app
