#include "bough/report/chart.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "bough/report/plot.hpp"
#include "curve.hpp"
#include "label_place.hpp"
#include "svg_text.hpp"

namespace bough::report {
namespace {

constexpr double left_margin = 66.0, right_margin = 16.0, head = 34.0, below_axis = 40.0;  // [px]
constexpr double lane_height = 22.0;  // for failures, above the plot [px]
constexpr double legend_row = 19.0;   // [px]
constexpr double character = 6.6;     // mean width of a character in 12 px [px]
constexpr double swatch = 26.0;       // of a legend's entry [px]
constexpr int num_colors = 6, num_marks = 5, num_dashes = 3;
constexpr std::size_t thinned_above = 400;  // number of points above which a line without marks is thinned

double on_axis(double value, Scale scale) {
  if (scale == Scale::linear || !std::isfinite(value)) return value;
  return value > 0.0 ? std::log10(value) : -std::numeric_limits<double>::infinity();
}

struct Range {
  double low = HUGE_VAL, high = -HUGE_VAL;
  void include(double value) {
    if (!std::isfinite(value)) return;
    low = std::min(low, value);
    high = std::max(high, value);
  }
};

/// Adds some room around the points; rounds to whole decades if the range has only a few, so that there are labels.
Range padded(Range range, Scale scale) {
  if (range.low > range.high) return scale == Scale::log ? Range{-1.0, 1.0} : Range{0.0, 1.0};
  const double extent = range.high - range.low;
  if (scale == Scale::log) {
    const double pad = std::max(0.06 * extent, 0.08);
    Range r{range.low - pad, range.high + pad};
    if (std::floor(r.high) - std::ceil(r.low) < 1.0) r = {std::floor(r.low + 0.02), std::ceil(r.high - 0.02)};
    if (r.high - r.low < 1.0) r.high = r.low + 1.0;
    return r;
  }
  const double magnitude = std::max(std::abs(range.low), std::abs(range.high));
  if (extent <= 1e-12 * magnitude || extent == 0.0) {
    const double half = magnitude > 0.0 ? 0.5 * magnitude : 1.0;
    return {range.low - half, range.high + half};
  }
  return {range.low - 0.05 * extent, range.high + 0.05 * extent};
}

bool has_failures(const Chart& chart) {
  return std::any_of(chart.series.begin(), chart.series.end(),
                     [](const ChartSeries& s) { return !s.failures.empty(); });
}

/// "10⁻⁴".
std::string power_text(int exponent) {
  static constexpr std::array<const char*, 10> digits{"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  if (exponent == 0) return "1";
  if (exponent == 1) return "10";
  std::string text = exponent < 0 ? "10⁻" : "10";
  for (const char c : std::to_string(std::abs(exponent))) text += digits[static_cast<std::size_t>(c - '0')];
  return text;
}

struct Tick {
  double at;  ///< position on the axis: log10 of the value on a logarithmic one
  std::string label;
  bool is_major = true;
};

std::vector<Tick> ticks_of(double low, double high, Scale scale, int wanted) {
  std::vector<Tick> ticks;
  if (scale == Scale::linear) {
    const std::vector<double> places = round_ticks(low, high, wanted);
    const std::vector<std::string> labels = tick_labels(places);
    for (std::size_t k = 0; k < places.size(); ++k) ticks.push_back({places[k], labels[k]});
    return ticks;
  }
  const int first = static_cast<int>(std::floor(low)), last = static_cast<int>(std::ceil(high));
  const int stride = std::max(1, (last - first + wanted) / (wanted + 1));
  for (int decade = first; decade <= last; ++decade) {
    if (decade >= low && decade <= high) {
      const bool labelled = decade % stride == 0;
      ticks.push_back({static_cast<double>(decade), labelled ? power_text(decade) : "", labelled});
    }
    if (last - first > 4) continue;
    for (const int factor : {2, 5})
      if (const double at = decade + std::log10(factor); at >= low && at <= high) ticks.push_back({at, "", false});
  }
  return ticks;
}

std::string axes(const Chart& chart, const ChartFrame& f) {
  std::string text;
  for (const Tick& tick : ticks_of(f.y_low, f.y_high, chart.y.scale, 6)) {
    const double y = f.to_y(tick.at);
    text +=
        tick.is_major ? line_element("grid", f.left, y, f.right, y) : line_element("axis", f.left, y, f.left + 4.0, y);
    if (!tick.label.empty()) text += text_element("tiny soft", f.left - 6.0, y + 4.0, "end", tick.label);
  }
  for (const Tick& tick : ticks_of(f.x_low, f.x_high, chart.x.scale, 7)) {
    const double x = f.to_x(tick.at);
    if (tick.is_major) text += line_element("grid", x, f.top, x, f.bottom);
    text += line_element("axis", x, f.bottom, x, f.bottom + (tick.is_major ? 5.0 : 3.0));
    if (!tick.label.empty()) text += text_element("tiny soft", x, f.bottom + 18.0, "middle", tick.label);
  }
  return text + line_element("axis", f.left, f.bottom, f.right, f.bottom) +
         line_element("axis", f.left, f.top, f.left, f.bottom) +
         text_element("tiny soft", 0.5 * (f.left + f.right), f.bottom + 34.0, "middle", chart.x.label);
}

std::string move_to(double x, double y, char verb = 'M') {
  std::string data(1, verb);
  append_pixel(data, x);
  data += ' ';
  append_pixel(data, y);
  return data;
}

/// Disc, square, triangle, diamond, inverted triangle: they can be distinguished without colour.
std::string mark_path(int shape, double x, double y) {
  constexpr double r = 3.6;
  switch (shape % num_marks) {
    case 0: {
      const std::string radius = pixel(r);
      return move_to(x - r, y) + "a" + radius + " " + radius + " 0 1 0 " + pixel(2.0 * r) + " 0a" + radius + " " +
             radius + " 0 1 0 " + pixel(-2.0 * r) + " 0z";
    }
    case 1:
      return move_to(x - r, y - r) + "h" + pixel(2.0 * r) + "v" + pixel(2.0 * r) + "h" + pixel(-2.0 * r) + "z";
    case 2:
      return move_to(x, y - 1.2 * r) + move_to(x + 1.15 * r, y + 0.9 * r, 'L') +
             move_to(x - 1.15 * r, y + 0.9 * r, 'L') + "z";
    case 3:
      return move_to(x, y - 1.3 * r) + move_to(x + 1.3 * r, y, 'L') + move_to(x, y + 1.3 * r, 'L') +
             move_to(x - 1.3 * r, y, 'L') + "z";
    default:
      return move_to(x, y + 1.2 * r) + move_to(x + 1.15 * r, y - 0.9 * r, 'L') +
             move_to(x - 1.15 * r, y - 0.9 * r, 'L') + "z";
  }
}

std::string color_class(int style) { return "s" + std::to_string(style % num_colors); }
std::string dash_class(int style) {
  const int dash = style / num_colors % num_dashes;
  return dash == 0 ? "" : " d" + std::to_string(dash);
}

std::string titled_path(const std::string& classes, const std::string& data, const ChartPoint& point, bool with_value) {
  std::string text = "<path class=\"" + classes + "\" d=\"" + data + "\"";
  if (with_value) {
    text += " data-y=\"";
    io::append_number(text, point.y);
    text += '"';
  }
  if (!point.source.empty()) text += " data-source=\"" + escaped(point.source) + "\"";
  return text + (point.note.empty() ? "/>\n" : "><title>" + escaped(point.note) + "</title></path>\n");
}

struct Placed {
  double x, y;   ///< [px]; y NaN: not drawn
  bool on_edge;  ///< below the range of the axis
};

Placed place(const Chart& chart, const ChartFrame& f, const ChartPoint& point) {
  const double x = on_axis(point.x, chart.x.scale), y = on_axis(point.y, chart.y.scale);
  const double nothing = std::numeric_limits<double>::quiet_NaN();
  if (!std::isfinite(x) || !std::isfinite(point.y)) return {nothing, nothing, false};
  if (!std::isfinite(y)) return {f.to_x(x), f.bottom, true};
  return {f.to_x(x), f.to_y(y), false};
}

std::string series_text(const Chart& chart, const ChartFrame& f, const ChartSeries& series, int style) {
  std::vector<Placed> places;
  for (const ChartPoint& point : series.points) places.push_back(place(chart, f, point));
  std::string text;
  if (series.has_line) {
    std::string data;
    if (!series.has_marks && places.size() > thinned_above) {
      data = curve_path(
          places.size(), [&](std::size_t k) { return places[k].x; }, [&](std::size_t k) { return places[k].y; },
          [](double y) { return y; });
    } else {
      bool pen_down = false;
      for (const Placed& p : places) {
        if (std::isfinite(p.y)) data += move_to(p.x, p.y, pen_down ? 'L' : 'M');
        pen_down = std::isfinite(p.y);
      }
    }
    text += path_element("curve " + color_class(style) + dash_class(style), data);
  }
  for (std::size_t k = 0; series.has_marks && k < places.size(); ++k)
    if (std::isfinite(places[k].y))
      text += titled_path("point " + color_class(style) + (places[k].on_edge ? " hollow" : " solid"),
                          mark_path(style, places[k].x, places[k].y), series.points[k], true);
  return text;
}

/// Crosses in the lane above the plot, side by side where several have the same x.
std::string failures_text(const Chart& chart, const ChartFrame& f) {
  if (!has_failures(chart)) return {};
  const double y = f.top - 0.5 * lane_height;
  std::string text = text_element("tiny soft", f.left - 6.0, y + 4.0, "end", "failed");
  std::vector<double> taken;
  for (const ChartSeries& series : chart.series)
    for (const ChartPoint& point : series.failures) {
      double x = on_axis(point.x, chart.x.scale);
      x = std::isfinite(x) ? f.to_x(x) : f.right;
      while (std::any_of(taken.begin(), taken.end(), [&](double other) { return std::abs(other - x) < 9.0; })) x += 9.0;
      taken.push_back(x);
      constexpr double r = 3.6;
      text += titled_path(
          "fail",
          move_to(x - r, y - r) + move_to(x + r, y + r, 'L') + move_to(x - r, y + r) + move_to(x + r, y - r, 'L'),
          {point.x, 0.0, series.name + ": " + point.note, point.source}, false);
    }
  return text;
}

/// The part of the line inside the plot area, clipped at its four edges, beginning at the end where its label is
/// placed; none if the line is outside.
std::optional<Segment> guide_of(const Chart& chart, const ChartFrame& f, const SlopeLine& line) {
  const double x0 = on_axis(line.x0, chart.x.scale), y0 = on_axis(line.y0, chart.y.scale);
  if (!std::isfinite(x0) || !std::isfinite(y0) || !std::isfinite(line.slope)) return std::nullopt;
  double a = f.x_low, b = f.x_high;
  if (line.slope != 0.0) {
    const double at_low = x0 + (f.y_low - y0) / line.slope, at_high = x0 + (f.y_high - y0) / line.slope;
    a = std::max(a, std::min(at_low, at_high));
    b = std::min(b, std::max(at_low, at_high));
  } else if (y0 < f.y_low || y0 > f.y_high) {
    return std::nullopt;
  }
  if (!(a < b)) return std::nullopt;
  if ((line.slope >= 0.0) != line.is_below) std::swap(a, b);
  const auto height = [&](double x) { return f.to_y(y0 + line.slope * (x - x0)); };
  return Segment{f.to_x(a), height(a), f.to_x(b), height(b)};
}

/// Lines and marks of the series, which labels must not cover.
std::vector<Segment> drawn_segments(const Chart& chart, const ChartFrame& f) {
  constexpr double r = 6.0;  // around a mark
  std::vector<Segment> drawn;
  for (const ChartSeries& series : chart.series) {
    const Placed* before = nullptr;
    std::vector<Placed> places;
    for (const ChartPoint& point : series.points) places.push_back(place(chart, f, point));
    for (const Placed& p : places) {
      const bool is_there = std::isfinite(p.y);
      if (is_there && series.has_line && before != nullptr) drawn.push_back({before->x, before->y, p.x, p.y});
      if (is_there && series.has_marks) {
        drawn.push_back({p.x - r, p.y - r, p.x + r, p.y + r});
        drawn.push_back({p.x - r, p.y + r, p.x + r, p.y - r});
      }
      before = is_there ? &p : nullptr;
    }
  }
  return drawn;
}

std::string slopes_text(const Chart& chart, const ChartFrame& f) {
  if (chart.slopes.empty()) return {};
  std::string text;
  std::vector<std::optional<Segment>> guides;
  std::vector<Segment> drawn = drawn_segments(chart, f);
  for (const SlopeLine& line : chart.slopes) {
    guides.push_back(guide_of(chart, f, line));
    if (!guides.back()) continue;
    const Segment& g = *guides.back();
    drawn.push_back(g);
    const bool starts_left = g.x0 <= g.x1;
    text += path_element("guide", move_to(starts_left ? g.x0 : g.x1, starts_left ? g.y0 : g.y1) +
                                      move_to(starts_left ? g.x1 : g.x0, starts_left ? g.y1 : g.y0, 'L'));
  }
  for (std::size_t k = 0; k < guides.size(); ++k) {
    const std::string& label = chart.slopes[k].label;
    if (!guides[k] || label.empty()) continue;
    const double width = character * static_cast<double>(label.size());
    const LabelPlace at = place_label(*guides[k], width, drawn, {f.left + 3.0, f.top, f.right, f.bottom - 1.0});
    const Rectangle box = rectangle_of(at, width);
    drawn.push_back({box.left, box.top, box.right, box.bottom});
    drawn.push_back({box.left, box.bottom, box.right, box.top});
    text += text_element("tiny soft", at.x, at.y, at.is_end ? "end" : "start", label);
  }
  return text;
}

/// Rows of entries that fit beside each other.
std::vector<std::vector<std::size_t>> legend_rows(const Chart& chart) {
  std::vector<std::vector<std::size_t>> rows;
  if (chart.series.size() == 1 && chart.series.front().name.empty()) return rows;
  double used = 0.0;
  for (std::size_t k = 0; k < chart.series.size(); ++k) {
    const double width = swatch + character * static_cast<double>(chart.series[k].name.size()) + 14.0;
    if (rows.empty() || used + width > chart.width - 20.0) {
      rows.emplace_back();
      used = 0.0;
    }
    rows.back().push_back(k);
    used += width;
  }
  return rows;
}

int style_of(const Chart& chart, std::size_t k) {
  return chart.series[k].style >= 0 ? chart.series[k].style : static_cast<int>(k);
}

std::string legend(const Chart& chart, double top) {
  std::string text;
  double y = top + 12.0;
  for (const std::vector<std::size_t>& row : legend_rows(chart)) {
    double x = 12.0;
    for (const std::size_t k : row) {
      const ChartSeries& series = chart.series[k];
      const int style = style_of(chart, k);
      if (series.has_line)
        text += path_element("curve " + color_class(style) + dash_class(style), level_stroke(x, y - 4.0, 20.0));
      if (series.has_marks)
        text += path_element("point solid " + color_class(style), mark_path(style, x + 10.0, y - 4.0));
      text += text_element("tiny soft", x + swatch, y, "start", series.name);
      x += swatch + character * static_cast<double>(series.name.size()) + 14.0;
    }
    y += legend_row;
  }
  return text;
}

}  // namespace

ChartFrame chart_frame(const Chart& chart) {
  Range x, y;
  for (const ChartSeries& series : chart.series) {
    for (const ChartPoint& point : series.points) {
      if (!std::isfinite(on_axis(point.x, chart.x.scale)) || !std::isfinite(point.y)) continue;
      x.include(on_axis(point.x, chart.x.scale));
      y.include(on_axis(point.y, chart.y.scale));
    }
    for (const ChartPoint& point : series.failures) x.include(on_axis(point.x, chart.x.scale));
  }
  x = padded(x, chart.x.scale);
  y = padded(y, chart.y.scale);
  const double top = head + (has_failures(chart) ? lane_height : 0.0);
  return {left_margin, chart.width - right_margin, top, top + chart.plot_height, x.low, x.high, y.low, y.high};
}

std::string chart_svg(const Chart& chart) {
  const ChartFrame f = chart_frame(chart);
  const double height = f.bottom + below_axis + 6.0 + legend_row * static_cast<double>(legend_rows(chart).size());
  std::string text = "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 " + pixel(chart.width) + " " +
                     pixel(height) + "\" role=\"img\" aria-label=\"" + escaped(chart.title) +
                     "\">\n<rect class=\"paper\" width=\"100%\" height=\"100%\"/>\n" +
                     text_element("head ink", 12.0, 21.0, "start", chart.title) +
                     text_element("tiny soft", chart.width - right_margin, 21.0, "end", chart.y.label) + axes(chart, f);
  text += slopes_text(chart, f);
  for (std::size_t k = 0; k < chart.series.size(); ++k)
    text += series_text(chart, f, chart.series[k], style_of(chart, k));
  return text + failures_text(chart, f) + legend(chart, f.bottom + below_axis) + "</svg>\n";
}

}  // namespace bough::report
