#include "bough/io/printable_text.hpp"

namespace bough::io {
namespace {

unsigned byte_at(std::string_view text, std::size_t k) {
  return k < text.size() ? static_cast<unsigned char>(text[k]) : 0u;
}

/// C0 and DEL; C1 (U+0080 to U+009F); marks of direction and breaks of lines that no line feed is (U+200E, U+200F,
/// U+2028 to U+202E, U+2066 to U+2069).
bool is_control(std::string_view text, std::size_t length) {
  const unsigned first = byte_at(text, 0), second = byte_at(text, 1), third = byte_at(text, 2);
  if (length == 1) return (first < 0x20u && first != '\n' && first != '\t') || first == 0x7Fu;
  if (length == 2) return first == 0xC2u && second < 0xA0u;
  if (length != 3 || first != 0xE2u) return false;
  if (second == 0x80u) return third == 0x8Eu || third == 0x8Fu || (third >= 0xA8u && third <= 0xAEu);
  return second == 0x81u && third >= 0xA6u && third <= 0xA9u;
}

}  // namespace

std::size_t utf8_length(std::string_view text) {
  const auto tail = [&](std::size_t k) { return (byte_at(text, k) & 0xC0u) == 0x80u; };
  const unsigned first = byte_at(text, 0), second = byte_at(text, 1);
  if (text.empty()) return 0;
  if (first < 0x80u) return 1;
  if (first >= 0xC2u && first <= 0xDFu) return tail(1) ? 2 : 0;
  if (first >= 0xE0u && first <= 0xEFu) {
    const bool good = tail(1) && tail(2) && !(first == 0xE0u && second < 0xA0u) && !(first == 0xEDu && second > 0x9Fu);
    return good ? 3 : 0;
  }
  if (first >= 0xF0u && first <= 0xF4u) {
    const bool good =
        tail(1) && tail(2) && tail(3) && !(first == 0xF0u && second < 0x90u) && !(first == 0xF4u && second > 0x8Fu);
    return good ? 4 : 0;
  }
  return 0;
}

void append_printable(std::string& to, std::string_view text, std::size_t length) {
  constexpr const char* digits = "0123456789abcdef";
  if (length > 0 && !is_control(text, length)) {
    to.append(text.substr(0, length));
    return;
  }
  for (std::size_t k = 0; k < (length == 0 ? 1 : length); ++k) {
    to += "\\x";
    to += digits[byte_at(text, k) >> 4u];
    to += digits[byte_at(text, k) & 15u];
  }
}

std::string printable(std::string_view text) {
  std::string result;
  while (!text.empty()) {
    const std::size_t length = utf8_length(text);
    append_printable(result, text, length);
    text.remove_prefix(length == 0 ? 1 : length);
  }
  return result;
}

}  // namespace bough::io
