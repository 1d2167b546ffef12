#include "excerpts.hpp"

#include <algorithm>

#include "bough/io/printable_text.hpp"

namespace bough::io {
namespace {

constexpr std::size_t most_before = 100, most_behind = 60;  // characters shown on both sides of a place

bool continues(char c) { return (static_cast<unsigned char>(c) & 0xC0u) == 0x80u; }

/// Appends the characters of a text; returns their number as shown.
std::size_t append_shown(std::string& to, std::string_view text) {
  std::size_t count = 0;
  while (!text.empty()) {
    const std::size_t length = utf8_length(text);
    const std::size_t before = to.size();
    if (text.front() == '\t')
      to += ' ';
    else if (text.front() != '\r')
      append_printable(to, text, length);
    count += static_cast<std::size_t>(std::count_if(to.begin() + static_cast<std::ptrdiff_t>(before), to.end(),
                                                    [](char c) { return !continues(c); }));
    text.remove_prefix(length == 0 ? 1 : length);
  }
  return count;
}

/// The end of a piece of a text that starts at an offset: the end of the line, or of so many characters.
std::size_t end_of_piece(std::string_view text, std::size_t from, std::size_t most) {
  std::size_t end = from;
  for (std::size_t count = 0; end < text.size() && text[end] != '\n'; ++end)
    if (!continues(text[end]) && ++count > most) break;
  return end;
}

}  // namespace

std::size_t token_length(std::string_view text, std::size_t offset) {
  if (offset >= text.size()) return 0;
  std::size_t end = offset + 1;
  if (text[offset] == '"') {
    while (end < text.size() && text[end] != '"' && text[end] != '\n') end += text[end] == '\\' ? 2 : 1;
    return std::min(end + 1, text.size()) - offset;
  }
  while (end < text.size() && std::string_view(" \t\r\n,:{}[]\"").find(text[end]) == std::string_view::npos) ++end;
  return end - offset;
}

Excerpt excerpt_of(std::string_view text, int line, std::size_t offset, std::size_t length) {
  Excerpt e;
  e.line = line;
  offset = std::min(offset, text.size());
  std::size_t begin = offset;
  for (std::size_t count = 0; begin > 0 && text[begin - 1] != '\n' && count < most_before; --begin)
    if (!continues(text[begin - 1])) ++count;
  if (begin > 0 && text[begin - 1] != '\n') {
    e.text = "...";
    e.before = e.text.size();
  } else if (text.substr(begin, 3) == "\xEF\xBB\xBF") {
    begin = std::min(begin + 3, offset);  // a byte order mark has no width
  }
  e.before += append_shown(e.text, text.substr(begin, offset - begin));
  const std::size_t end = end_of_piece(text, offset, most_behind);
  const std::size_t marked = std::min(std::max<std::size_t>(length, 1), end - offset);
  e.marked = append_shown(e.text, text.substr(offset, marked));
  append_shown(e.text, text.substr(offset + marked, end - offset - marked));
  if (end < text.size() && text[end] != '\n') e.text += "...";
  e.marked = std::max<std::size_t>(e.marked, 1);
  return e;
}

std::string marked_lines(const Excerpt& excerpt, char mark, const std::string& remark) {
  constexpr std::size_t width = 6;
  const std::string number = std::to_string(excerpt.line);
  const std::string margin(std::max(width, number.size() + 1), ' ');
  std::string text = margin.substr(number.size()) + number + " | " + excerpt.text + "\n";
  text += margin + " | " + std::string(excerpt.before, ' ') + std::string(excerpt.marked, mark);
  return text + (remark.empty() ? "" : " " + remark) + "\n";
}

DefinedNames::DefinedNames(const JsonValue* root) {
  for (std::size_t i = 0; root != nullptr && i < root->items.size(); ++i) {
    if (!root->items[i].is(JsonKind::array)) continue;
    for (const JsonValue& item : root->items[i].items) {
      const JsonValue* name = item.is(JsonKind::object) ? item.find("name") : nullptr;
      if (name == nullptr || !name->is(JsonKind::string)) continue;
      const auto [at, is_new] = first_.try_emplace(name->text.str());
      if (!is_new) continue;
      all_.push_back(at->first);
      at->second = {name, root->items.key(i)};
    }
  }
}

const DefinedNames::Place* DefinedNames::find(const std::string& name) const {
  const auto at = first_.find(name);
  return at == first_.end() || at->second.name->source != source_file ? nullptr : &at->second;
}

}  // namespace bough::io
