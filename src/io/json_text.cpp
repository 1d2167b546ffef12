#include "bough/io/json_text.hpp"

#include <cmath>

#include "bough/io/json_value.hpp"
#include "bough/io/number_text.hpp"
#include "bough/io/printable_text.hpp"

namespace bough::io {

namespace {

bool is_json(std::string_view text) {
  std::vector<JsonFault> faults;
  return parse_json(text, source_file, faults).has_value() && faults.empty();
}

}  // namespace

std::string json_string(std::string_view text) {
  constexpr const char* digits = "0123456789abcdef";
  std::string quoted = "\"";
  while (!text.empty()) {
    const std::size_t length = utf8_length(text);
    const char c = text.front();
    if (length == 0) {
      quoted += "\xEF\xBF\xBD";  // U+FFFD
    } else if (c == '"' || c == '\\') {
      quoted += '\\';
      quoted += c;
    } else if (c == '\n') {
      quoted += "\\n";
    } else if (static_cast<unsigned char>(c) < 0x20u) {
      quoted += "\\u00";
      quoted += digits[static_cast<unsigned char>(c) >> 4u];
      quoted += digits[static_cast<unsigned char>(c) & 15u];
    } else {
      quoted += text.substr(0, length);
    }
    text.remove_prefix(length == 0 ? 1 : length);
  }
  return quoted + '"';
}

void JsonText::separate() {
  if (after_key_) {
    after_key_ = false;
    return;
  }
  if (has_items_.empty()) return;
  if (has_items_.back()) text_ += ',';
  has_items_.back() = true;
  text_ += '\n';
  text_.append(2 * has_items_.size(), ' ');
}

void JsonText::open(char bracket) {
  separate();
  text_ += bracket;
  has_items_.push_back(false);
}

void JsonText::close(char bracket) {
  const bool had_items = has_items_.back();
  has_items_.pop_back();
  if (had_items) {
    text_ += '\n';
    text_.append(2 * has_items_.size(), ' ');
  }
  text_ += bracket;
}

void JsonText::key(std::string_view name) {
  separate();
  text_ += json_string(name);
  text_ += ": ";
  after_key_ = true;
}

void JsonText::value(double number) {
  separate();
  const bool finite = std::isfinite(number);
  if (!finite) text_ += '"';
  append_number(text_, number);
  if (!finite) text_ += '"';
}

void JsonText::value(long long number) {
  separate();
  append_number(text_, number);
}

void JsonText::value(bool flag) {
  separate();
  text_ += flag ? "true" : "false";
}

void JsonText::value(std::string_view text) {
  separate();
  text_ += json_string(text);
}

void JsonText::raw(std::string_view json) {
  if (!is_json(json)) return value(json);
  separate();
  text_ += json;
}

}  // namespace bough::io
