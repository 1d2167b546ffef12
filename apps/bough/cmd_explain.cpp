/// bough explain WORD, bough help WORD: what the formats, the command line and the manual say of a word.
#include <algorithm>
#include <iostream>
#include <set>

#include "arguments.hpp"
#include "bough/io/fault_codes.hpp"
#include "bough/io/schema_words.hpp"
#include "bough/scene/nearest_name.hpp"
#include "manual_entries.hpp"

namespace bough::app {
namespace {

constexpr std::size_t most_entries = 16;  // of a kind: a word such as "name" stands in every object
constexpr std::size_t line_width = 100;   // of a line

/// A paragraph in lines of at most `line_width` characters, each after some spaces.
std::string wrapped(const std::string& text, std::size_t indent) {
  std::string result, line(indent, ' ');
  std::size_t at = 0;
  while (at < text.size()) {
    const std::size_t end = std::min(text.find(' ', at), text.size());
    const std::string word = text.substr(at, end - at);
    at = end + 1;
    if (line.size() > indent && line.size() + 1 + word.size() > line_width) {
      result += line + "\n";
      line.assign(indent, ' ');
    }
    line += (line.size() > indent ? " " : "") + word;
  }
  return line.size() > indent ? result + line + "\n" : result;
}

std::string more_text(std::size_t count) {
  return count > most_entries ? "  and " + std::to_string(count - most_entries) + " more\n" : "";
}

std::string schema_part(const std::string& word) {
  const std::vector<io::SchemaEntry> entries = io::schema_entries(word);
  std::string text;
  for (std::size_t i = 0; i < std::min(entries.size(), most_entries); ++i) {
    const io::SchemaEntry& e = entries[i];
    text += e.format + ": " + e.place + "\n" + wrapped(e.value, 4) + wrapped(e.about, 4);
  }
  return text + more_text(entries.size());
}

/// Rows of tables and sections with just this word, in the order of the entries, and then where it stands in headings.
std::string manual_part(const std::string& word, const std::vector<ManualEntry>& entries) {
  std::string told, others;
  std::size_t num_rows = 0;
  const ManualEntry* last_row = nullptr;
  for (const ManualEntry& e : entries) {
    const bool fits = std::find(e.words.begin(), e.words.end(), word) != e.words.end();
    const std::string where = e.page + ", \"" + e.title + "\"";
    if (fits && e.is_row) {
      if (++num_rows > most_entries) continue;
      if (last_row == nullptr || last_row->title != e.title || last_row->page != e.page) told += where + "\n";
      told += e.text;
      last_row = &e;
    } else if (fits && !e.text.empty()) {
      told += where + "\n" + e.text;
    } else if (title_holds(e, word)) {
      others += "  " + where + "\n";
    }
  }
  std::string text = told + more_text(num_rows);
  if (!others.empty()) text += "See also\n" + others;
  return text;
}

/// Sections in whose text a word stands that has no entry.
std::string mentions_of(const std::string& word, const std::vector<ManualEntry>& entries) {
  constexpr std::size_t least_letters = 4, most_mentions = 10;
  std::string text;
  std::size_t count = 0;
  for (const ManualEntry& e : entries) {
    if (word.size() < least_letters || e.is_row || in_small_letters(e.text).find(word) == std::string::npos) continue;
    if (++count <= most_mentions) text += "  " + e.page + ", \"" + e.title + "\"\n";
  }
  if (count > most_mentions) text += "  and " + std::to_string(count - most_mentions) + " more\n";
  return text.empty() ? text : "It has no entry of its own, and stands in\n" + text;
}

/// The nearest words, and those that hold the word.
std::vector<std::string> near_words(const std::string& word, const std::vector<std::string>& verbs,
                                    const std::vector<ManualEntry>& entries) {
  std::set<std::string> known(verbs.begin(), verbs.end());
  for (const std::string& key : io::schema_words()) known.insert(key);
  for (const io::FaultCode& code : io::fault_codes()) known.emplace(code.code);
  for (const ManualEntry& e : entries) known.insert(e.words.begin(), e.words.end());
  std::vector<std::pair<int, std::string>> near;
  for (const std::string& other : known) {
    const auto size = static_cast<int>(std::max(word.size(), other.size()));
    const int distance = scene::edit_distance(word, other);
    const bool is_within = word.size() >= 3 && other.find(word) != std::string::npos;
    if (distance <= 2 * std::max(1, size / 3) || is_within) near.emplace_back(distance, other);
  }
  std::sort(near.begin(), near.end());
  constexpr std::size_t most_near = 8;
  std::vector<std::string> words;
  for (std::size_t i = 0; i < std::min(near.size(), most_near); ++i) words.push_back(near[i].second);
  return words;
}

}  // namespace

int explain(const ExplainArguments& arguments) {
  constexpr std::size_t longest = 100;
  const std::string word = in_small_letters(arguments.word).substr(0, longest);
  const std::vector<ManualEntry> entries = manual_entries();
  std::string text;
  if (!word.empty())
    for (const std::string& part : {arguments.verb_help, schema_part(arguments.word), manual_part(word, entries)})
      if (!part.empty()) text += (text.empty() ? "" : "\n") + part;
  if (text.empty()) text = mentions_of(word, entries);
  if (!text.empty()) {
    std::cout << text << std::flush;
    return std::cout.good() ? exit_done : exit_failed;
  }
  std::cerr << "bough: there is no entry '" << word << "'";
  const std::vector<std::string> near = near_words(word, arguments.verbs, entries);
  for (std::size_t i = 0; i < near.size(); ++i) std::cerr << (i == 0 ? "; near are '" : ", '") << near[i] << "'";
  std::cerr << "\n";
  return exit_bad_input;
}

}  // namespace bough::app
