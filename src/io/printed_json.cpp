#include "printed_json.hpp"

#include "bough/io/json_text.hpp"
#include "bough/io/number_text.hpp"

namespace bough::io {
namespace {

constexpr std::size_t longest_line = 120;

/// Appends the value to the present line; false if it does not fit, in which case part of it has been written.
bool append_line(std::string& out, const JsonValue& v, std::size_t line_begin) {
  switch (v.kind) {
    case JsonKind::null:
      out += "null";
      break;
    case JsonKind::boolean:
      out += v.truth ? "true" : "false";
      break;
    case JsonKind::number:
      append_number(out, v.number);
      break;
    case JsonKind::string:
      out += json_string(v.text.str());
      break;
    default: {
      const bool is_array = v.is(JsonKind::array);
      out += is_array ? '[' : '{';
      for (std::size_t i = 0; i < v.items.size(); ++i) {
        if (i > 0) out += ", ";
        if (!is_array) out += json_string(v.items.key(i)) + ": ";
        if (!append_line(out, v.items[i], line_begin)) return false;
      }
      out += is_array ? ']' : '}';
    }
  }
  return out.size() - line_begin <= longest_line;
}

/// Text before the value on its line: indent and key.
void append(std::string& out, const JsonValue& v, std::size_t depth, std::size_t line_begin) {
  const std::size_t before = out.size();
  const bool is_list = v.is(JsonKind::array) || v.is(JsonKind::object);
  if (append_line(out, v, line_begin) && depth > 0) return;
  if (!is_list || v.items.empty()) return;
  out.resize(before);
  const bool is_array = v.is(JsonKind::array);
  out += is_array ? "[" : "{";
  for (std::size_t i = 0; i < v.items.size(); ++i) {
    out += i > 0 ? ",\n" : "\n";
    const std::size_t begin = out.size();
    out.append(2 * (depth + 1), ' ');
    if (!is_array) out += json_string(v.items.key(i)) + ": ";
    append(out, v.items[i], depth + 1, begin);
  }
  out += '\n';
  out.append(2 * depth, ' ');
  out += is_array ? ']' : '}';
}

}  // namespace

std::string printed(const JsonValue& value) {
  std::string out;
  append(out, value, 0, 0);
  return out;
}

}  // namespace bough::io
