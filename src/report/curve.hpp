#pragma once
/// A curve of many points as path data of few.
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "svg_text.hpp"

namespace bough::report {

/// Rows to draw: all where they are few; else, per pixel column, the rows of the smallest and largest value in their
/// order. to_x(k): of row k on paper, ascending [px]; value(k): of row k.
template <class ToX, class ValueOf>
std::vector<std::size_t> rows_to_draw(std::size_t num_rows, const ToX& to_x, const ValueOf& value) {
  std::vector<std::size_t> rows;
  for (std::size_t begin = 0; begin < num_rows;) {
    const double pixel_column = std::floor(to_x(begin));
    std::size_t low = begin, high = begin, end = begin;
    bool all_finite = true;
    for (; end < num_rows && std::floor(to_x(end)) == pixel_column; ++end) {
      if (!std::isfinite(value(end))) {
        all_finite = false;
        rows.push_back(end);
        continue;
      }
      if (!std::isfinite(value(low)) || value(end) < value(low)) low = end;
      if (!std::isfinite(value(high)) || value(end) > value(high)) high = end;
    }
    if (end == begin) break;  // a time that is not finite
    rows.push_back(begin);
    rows.push_back(end - 1);
    if (all_finite || std::isfinite(value(low))) rows.insert(rows.end(), {low, high});
    begin = end;
  }
  std::sort(rows.begin(), rows.end());
  rows.erase(std::unique(rows.begin(), rows.end()), rows.end());
  return rows;
}

/// Path data; a gap where a value is not finite. to_y: of a value on paper [px].
template <class ToX, class ValueOf, class ToY>
std::string curve_path(std::size_t num_rows, const ToX& to_x, const ValueOf& value, const ToY& to_y) {
  std::string path;
  bool pen_down = false;
  for (const std::size_t k : rows_to_draw(num_rows, to_x, value)) {
    if (!std::isfinite(value(k))) {
      pen_down = false;
      continue;
    }
    path += pen_down ? 'L' : 'M';
    append_pixel(path, to_x(k));
    path += ' ';
    append_pixel(path, to_y(value(k)));
    pen_down = true;
  }
  return path;
}

}  // namespace bough::report
