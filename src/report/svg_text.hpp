#pragma once
/// Pieces of SVG and HTML text.
#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>

#include "bough/io/number_text.hpp"

namespace bough::report {

inline std::string escaped(std::string_view text) {
  std::string result;
  for (const char c : text) {
    switch (c) {
      case '&':
        result += "&amp;";
        break;
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      case '"':
        result += "&quot;";
        break;
      default:
        result += c;
    }
  }
  return result;
}

/// JSON text that may stand inside a <script> element: no name of a case can end it.
inline std::string inside_script(std::string_view json) {
  std::string text;
  for (const char c : json) c == '<' ? text += "\\u003c" : text += c;
  return text;
}

/// A coordinate of a drawing, to a twentieth of a pixel. Values beyond any page, infinity and NaN are replaced by the
/// limit of what 32-bit readers of coordinates can represent.
inline void append_pixel(std::string& text, double value) {
  constexpr double far = 1e6;
  const double on_paper = value > -far ? std::min(value, far) : -far;  // the comparison is false for NaN
  io::append_rounded(text, std::round(on_paper * 20.0) / 20.0, 7);
}

inline std::string pixel(double value) {
  std::string text;
  append_pixel(text, value);
  return text;
}

/// Path data: a level stroke of `length` from (x, y); of no length it is a dot.
inline std::string level_stroke(double x, double y, double length) {
  std::string data(1, 'M');
  append_pixel(data, x);
  data += ' ';
  append_pixel(data, y);
  data += 'h';
  append_pixel(data, length);
  return data;
}

inline std::string line_element(std::string_view classes, double x1, double y1, double x2, double y2) {
  return "<line class=\"" + std::string(classes) + "\" x1=\"" + pixel(x1) + "\" y1=\"" + pixel(y1) + "\" x2=\"" +
         pixel(x2) + "\" y2=\"" + pixel(y2) + "\"/>\n";
}

/// anchor: "start", "middle", "end".
inline std::string text_element(std::string_view classes, double x, double y, std::string_view anchor,
                                std::string_view text) {
  return "<text class=\"" + std::string(classes) + "\" x=\"" + pixel(x) + "\" y=\"" + pixel(y) + "\" text-anchor=\"" +
         std::string(anchor) + "\">" + escaped(text) + "</text>\n";
}

inline std::string path_element(std::string_view classes, std::string_view data) {
  return data.empty() ? std::string()
                      : "<path class=\"" + std::string(classes) + "\" d=\"" + std::string(data) + "\"/>\n";
}

}  // namespace bough::report
