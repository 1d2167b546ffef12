#include "bough/io/json_value.hpp"

#include <algorithm>

#include "bough/io/printable_text.hpp"

namespace bough::io {

const JsonValue* JsonValue::find(std::string_view key) const {
  for (std::size_t i = 0; i < keys.size(); ++i)
    if (keys[i] == key) return &items[i];
  return nullptr;
}

JsonValue* JsonValue::find(std::string_view key) {
  for (std::size_t i = 0; i < keys.size(); ++i)
    if (keys[i] == key) return &items[i];
  return nullptr;
}

std::string pointer_to(const std::string& parent, std::string_view token) {
  std::string r = parent + "/";
  for (const char c : token) {
    if (c == '~')
      r += "~0";
    else if (c == '/')
      r += "~1";
    else
      r += c;
  }
  return r;
}

std::optional<std::vector<std::string>> split_pointer(std::string_view pointer) {
  std::vector<std::string> tokens;
  if (pointer.empty()) return tokens;
  if (pointer.front() != '/') return std::nullopt;
  for (std::size_t i = 0; i < pointer.size(); ++i) {
    if (pointer[i] == '/') {
      tokens.emplace_back();
    } else if (pointer[i] == '~') {
      ++i;
      if (i == pointer.size() || (pointer[i] != '0' && pointer[i] != '1')) return std::nullopt;
      tokens.back() += pointer[i] == '0' ? '~' : '/';
    } else {
      tokens.back() += pointer[i];
    }
  }
  return tokens;
}

LineIndex::LineIndex(std::string_view text) : text_(text), starts_{0} {
  if (text_.substr(0, 3) == "\xEF\xBB\xBF") starts_[0] = 3;  // a byte order mark is no column
  for (std::size_t i = 0; i < text.size(); ++i)
    if (text[i] == '\n') starts_.push_back(i + 1);
}

LineColumn LineIndex::at(std::size_t offset) const {
  offset = std::clamp(offset, starts_.front(), std::max(starts_.front(), text_.size()));
  const auto next = std::upper_bound(starts_.begin(), starts_.end(), offset);
  const std::size_t start = *(next - 1);
  int column = 1;
  for (std::size_t i = start; i < offset; ++i)
    if ((static_cast<unsigned char>(text_[i]) & 0xC0u) != 0x80u) ++column;
  return {static_cast<int>(next - starts_.begin()), column};
}

std::string shown(std::string_view text, std::size_t limit) {
  std::string r;
  std::size_t count = 0;
  for (std::size_t i = 0; i < text.size(); ++count) {
    if (count == limit) return r + "...";
    const auto c = static_cast<unsigned char>(text[i]);
    const std::size_t n = utf8_length(text.substr(i));
    if (c == '\n' || c == '\t' || c == '\r') {
      if (r.empty() || r.back() != ' ') r += ' ';
      ++i;
    } else {
      append_printable(r, text.substr(i), n);
      i += n == 0 ? 1 : n;
    }
  }
  return r;
}

}  // namespace bough::io
