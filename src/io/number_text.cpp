#include "bough/io/number_text.hpp"

#include <charconv>
#include <cmath>

namespace bough::io {

void append_number(std::string& text, double value) {
  if (std::isnan(value)) {  // to_chars would write the sign of a NaN
    text += "nan";
    return;
  }
  char buffer[40];
  const auto end = std::to_chars(buffer, buffer + sizeof buffer, value);
  text.append(buffer, end.ptr);
}

void append_number(std::string& text, long long value) {
  char buffer[24];
  const auto end = std::to_chars(buffer, buffer + sizeof buffer, value);
  text.append(buffer, end.ptr);
}

void append_rounded(std::string& text, double value, int digits) {
  if (!std::isfinite(value)) return append_number(text, value);
  char buffer[40];
  const auto end =
      std::to_chars(buffer, buffer + sizeof buffer, value == 0.0 ? 0.0 : value, std::chars_format::general, digits);
  text.append(buffer, end.ptr);
}

std::string rounded_text(double value, int digits) {
  std::string text;
  append_rounded(text, value, digits);
  return text;
}

bool read_number(std::string_view text, double& value) {
  if (!text.empty() && text.front() == '+') return false;
  const char* last = text.data() + text.size();
  const auto end = std::from_chars(text.data(), last, value);
  return end.ec == std::errc{} && end.ptr == last && !text.empty();
}

}  // namespace bough::io
