#include "manual_entries.hpp"

#include <algorithm>
#include <cctype>
#include <iterator>

#include "embedded_texts.hpp"

namespace bough::app {
namespace {

/// [text](target) reads "text", and marks of code and emphasis are left out where `plain` says so.
std::string without_links(std::string_view text, bool plain) {
  std::string result;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const std::size_t middle = text[i] == '[' ? text.find("](", i) : std::string_view::npos;
    const std::size_t end = middle == std::string_view::npos ? middle : text.find(')', middle);
    if (end != std::string_view::npos && text.substr(i, middle - i).find('\n') == std::string_view::npos) {
      if (!result.empty() && result.back() == '!') result.pop_back();  // a picture
      result += without_links(text.substr(i + 1, middle - i - 1), plain);
      i = end;
    } else if (!plain || (text[i] != '`' && text[i] != '*' && text[i] != '"')) {
      result += text[i];
    }
  }
  return result;
}

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && std::isspace(static_cast<unsigned char>(text.front())) != 0) text.remove_prefix(1);
  while (!text.empty() && std::isspace(static_cast<unsigned char>(text.back())) != 0) text.remove_suffix(1);
  return text;
}

/// The cells of a row of a table; a bar after a backslash is none.
std::vector<std::string> cells_of(std::string_view line) {
  std::vector<std::string> cells(1);
  line = trimmed(line);
  line.remove_prefix(1);
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (line[i] == '\\' && i + 1 < line.size() && line[i + 1] == '|')
      cells.back() += line[++i];
    else if (line[i] == '|')
      cells.emplace_back();
    else
      cells.back() += line[i];
  }
  if (cells.size() > 1 && trimmed(cells.back()).empty()) cells.pop_back();
  for (std::string& cell : cells) cell = std::string(trimmed(without_links(cell, false)));
  return cells;
}

/// "`nodes`, `bodies`" gives "nodes" and "bodies".
std::vector<std::string> words_of_cell(const std::string& cell) {
  std::vector<std::string> words;
  std::string rest = in_small_letters(without_links(cell, true)) + ",";
  for (std::size_t at = 0, end = rest.find(','); end != std::string::npos; at = end + 1, end = rest.find(',', at)) {
    const std::string word(trimmed(std::string_view(rest).substr(at, end - at)));
    if (!word.empty()) words.push_back(word);
  }
  return words;
}

/// Pages in the order in which a reader wants them.
std::size_t rank_of(std::string_view path) {
  constexpr std::string_view parts[] = {"guides/messages", "reference/words", "guides/",
                                        "reference/",      "tutorials/",      "theory/"};
  const auto* const at = std::find_if(std::begin(parts), std::end(parts),
                                      [&](std::string_view part) { return path.find(part) != std::string_view::npos; });
  return static_cast<std::size_t>(at - std::begin(parts));
}

/// Reads one page line by line.
class PageReader {
 public:
  PageReader(const EmbeddedText& page, std::vector<ManualEntry>& entries) : page_(page.path), entries_(entries) {}

  void line(std::string_view text) {
    if (text.starts_with("```")) {
      in_block_ = !in_block_;
      return add(std::string(text));
    }
    if (in_block_) return add(std::string(text));
    if (text.starts_with("<!--")) return;
    const std::size_t level = std::min(text.find_first_not_of('#'), text.size());
    if (level > 0 && level < text.size() && text[level] == ' ') return heading(text.substr(level + 1));
    if (text.starts_with("|")) return row(text);
    header_.clear();
    add(without_links(text, false));
  }

 private:
  void heading(std::string_view title) {
    header_.clear();
    title_ = std::string(title);
    section_ = entries_.size();
    const std::string word = in_small_letters(without_links(title, true));
    entries_.push_back({page_, without_links(title, true), {word}, "", false});
  }

  void row(std::string_view text) {
    add(without_links(text, false));
    if (text.starts_with("|--")) return;
    const std::vector<std::string> cells = cells_of(text);
    if (header_.empty()) {
      header_ = cells;
      return;
    }
    std::string told = cells.front() + "\n";
    for (std::size_t k = 1; k < cells.size(); ++k)
      if (!cells[k].empty())
        told += "  " + (k < header_.size() && !header_[k].empty() ? header_[k] + ": " : "") + cells[k] + "\n";
    entries_.push_back({page_, without_links(title_, true), words_of_cell(cells.front()), std::move(told), true});
  }

  void add(const std::string& text) {
    if (section_ < entries_.size()) entries_[section_].text += text + "\n";
  }

  std::string page_, title_;
  std::vector<ManualEntry>& entries_;
  std::size_t section_ = static_cast<std::size_t>(-1);  ///< index of the entry of the section
  std::vector<std::string> header_;                     ///< of the table
  bool in_block_ = false;
};

}  // namespace

std::string in_small_letters(std::string_view text) {
  std::string small(text);
  std::transform(small.begin(), small.end(), small.begin(),
                 [](char c) { return static_cast<char>(std::tolower(static_cast<unsigned char>(c))); });
  return small;
}

bool title_holds(const ManualEntry& entry, const std::string& word) {
  if (entry.is_row || entry.words.empty()) return false;
  const std::string& title = entry.words.front();
  const auto is_letter = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; };
  for (std::size_t at = title.find(word); at != std::string::npos; at = title.find(word, at + 1)) {
    const std::size_t end = at + word.size();
    const bool has_plural =
        end < title.size() && title[end] == 's' && (end + 1 == title.size() || !is_letter(title[end + 1]));
    if ((at == 0 || !is_letter(title[at - 1])) && (end == title.size() || !is_letter(title[end]) || has_plural))
      return true;
  }
  return false;
}

std::vector<ManualEntry> manual_entries() {
  std::vector<ManualEntry> entries;
  std::vector<EmbeddedText> pages = manual_pages();
  std::stable_sort(pages.begin(), pages.end(),
                   [](const EmbeddedText& a, const EmbeddedText& b) { return rank_of(a.path) < rank_of(b.path); });
  for (const EmbeddedText& page : pages) {
    if (!page.path.ends_with(".md")) continue;
    PageReader reader(page, entries);
    std::string_view rest = page.text;
    while (!rest.empty()) {
      const std::size_t end = std::min(rest.find('\n'), rest.size());
      reader.line(rest.substr(0, end));
      rest.remove_prefix(std::min(end + 1, rest.size()));
    }
  }
  return entries;
}

}  // namespace bough::app
