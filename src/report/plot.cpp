#include "bough/report/plot.hpp"

#include <algorithm>
#include <cmath>

#include "bough/io/columns.hpp"
#include "bough/io/json_value.hpp"
#include "curve.hpp"
#include "round_off.hpp"
#include "svg_text.hpp"

namespace bough::report {
namespace {

constexpr double width = 468.0, height = 220.0, left = 66.0, right = width - 14.0, top = 40.0,
                 bottom = height - 40.0;  // [px]
constexpr std::size_t num_colors = 6;
constexpr double constant_below = 1e-12;  // range over magnitude; smaller ranges are round-off and drawn as a constant

struct Range {
  double low = HUGE_VAL, high = -HUGE_VAL;
  bool empty() const { return low > high; }
  void include(double value) {
    if (!std::isfinite(value)) return;
    low = std::min(low, value);
    high = std::max(high, value);
  }
};

Range padded(Range range) {
  if (range.empty()) return {-1.0, 1.0};
  const double magnitude = std::max(std::abs(range.low), std::abs(range.high)), extent = range.high - range.low;
  if (extent <= constant_below * magnitude || extent == 0.0) {
    const double half = magnitude > 0.0 ? 0.5 * magnitude : 1.0, middle = 0.5 * (range.low + range.high);
    return {middle - half, middle + half};
  }
  return {range.low - 0.05 * extent, range.high + 0.05 * extent};
}

struct Scale {
  Range x, y;
  double to_x(double t) const { return left + (right - left) * (t - x.low) / (x.high - x.low); }
  double to_y(double v) const { return bottom - (bottom - top) * (v - y.low) / (y.high - y.low); }
};

/// A curve and the constant that is subtracted from its values.
struct Line {
  std::size_t column = 0;
  double offset = 0.0;
};

/// shift: added to the values of all rows; empty: nothing.
std::string column_path(const io::History& history, const Line& line, const Scale& scale,
                        const std::vector<double>& shift = {}) {
  return curve_path(
      history.rows.size(), [&](std::size_t k) { return scale.to_x(history.rows[k].time); },
      [&](std::size_t k) {
        return history.rows[k].values[line.column] - line.offset + (shift.empty() ? 0.0 : shift[k]);
      },
      [&](double value) { return scale.to_y(value); });
}

/// The lines above and below a curve, each `half` away from it.
std::string band_lines(const io::History& history, const Line& line, const Scale& scale, std::vector<double> half,
                       const std::string& color) {
  std::string text;
  for (int side = 0; side < 2; ++side) {
    text += path_element("bound " + color, column_path(history, line, scale, half));
    for (double& h : half) h = -h;
  }
  return text;
}

/// If curves are so far apart that their variation would not be visible, each is drawn relative to its value at the
/// start.
std::vector<Line> lines_of(const io::History& history, const std::vector<std::size_t>& columns) {
  constexpr double far_apart = 20.0;  // times the largest range of one
  Range all;
  double largest = 0.0;
  for (const std::size_t c : columns) {
    Range own;
    for (const records::HistoryRow& row : history.rows) own.include(row.values[c]);
    if (own.empty()) continue;
    all.include(own.low);
    all.include(own.high);
    largest = std::max(largest, own.high - own.low);
  }
  const bool is_apart = columns.size() > 1 && !all.empty() && all.high - all.low > far_apart * largest &&
                        largest > constant_below * std::max(std::abs(all.low), std::abs(all.high));
  std::vector<Line> lines;
  for (const std::size_t c : columns) {
    const double start = is_apart ? history.rows.front().values[c] : 0.0;
    const bool is_visible = std::isfinite(start) && std::abs(start) > 1e-6 * largest;
    lines.push_back({c, is_visible ? start : 0.0});
  }
  return lines;
}

/// Name of the component, with the constant that was subtracted, and without what the title says already: "x" of
/// "razi_x" in the plot "split, razi".
std::string legend_text(const io::History& history, const Line& line, std::string_view title) {
  std::string component = io::split_column(history.header.columns[line.column]).component;
  const std::size_t mark = component.rfind('_');
  if (mark != std::string::npos && title.find(", " + component.substr(0, mark)) != std::string_view::npos)
    component.erase(0, mark + 1);
  if (line.offset == 0.0) return component;
  return component + (line.offset > 0.0 ? " - " : " + ") + io::rounded_text(std::abs(line.offset), 6);
}

std::string axes(const Scale& scale, std::string_view time_label, bool is_round_off) {
  std::string text;
  const std::vector<double> levels =
      is_round_off ? std::vector<double>{0.0} : round_ticks(scale.y.low, scale.y.high, 5);
  const std::vector<std::string> of_levels = tick_labels(levels);
  for (std::size_t k = 0; k < levels.size(); ++k) {
    const double y = scale.to_y(levels[k]);
    text += line_element("grid", left, y, right, y);
    text += text_element("tiny soft", left - 6.0, y + 4.0, "end", of_levels[k]);
  }
  const std::vector<double> times = round_ticks(scale.x.low, scale.x.high, 6);
  const std::vector<std::string> of_times = tick_labels(times);
  for (std::size_t k = 0; k < times.size(); ++k) {
    const double x = scale.to_x(times[k]);
    text += line_element("axis", x, bottom, x, bottom + 4.0);
    text += text_element("tiny soft", x, bottom + 17.0, "middle", of_times[k]);
  }
  return text + line_element("axis", left, bottom, right, bottom) +
         text_element("tiny soft", right, height - 6.0, "end", time_label);
}

}  // namespace

std::vector<double> round_ticks(double low, double high, int wanted) {
  const double rough = (high - low) / wanted, power = std::pow(10.0, std::floor(std::log10(rough)));
  double step = 10.0 * power;
  for (const double factor : {5.0, 2.0, 1.0})
    if (factor * power >= rough * (1.0 - 1e-12)) step = factor * power;
  std::vector<double> ticks;
  const double first = std::ceil(low / step - 1e-9), last = std::floor(high / step + 1e-9);
  for (double k = first; k <= last && ticks.size() < 20; k += 1.0) ticks.push_back(k * step);
  return ticks;
}

std::vector<std::string> tick_labels(const std::vector<double>& ticks) {
  std::vector<std::string> labels(ticks.size());
  std::transform(ticks.begin(), ticks.end(), labels.begin(), [](double t) { return io::rounded_text(t, 6); });
  if (std::adjacent_find(labels.begin(), labels.end()) == labels.end()) return labels;
  const double roundest = *std::min_element(ticks.begin(), ticks.end(), [](double a, double b) {
    return io::rounded_text(a, 12).size() < io::rounded_text(b, 12).size();
  });
  for (std::size_t k = 0; k < ticks.size(); ++k)
    if (ticks[k] != roundest) labels[k] = (ticks[k] > roundest ? "+" : "") + io::rounded_text(ticks[k] - roundest, 3);
  return labels;
}

Plot make_plot(const io::History& history, const std::string& title, const std::vector<std::size_t>& columns,
               std::string_view time_label, double round_off, const std::vector<std::vector<double>>& bands) {
  Range times, values;
  const std::vector<Line> lines = lines_of(history, columns);
  for (const records::HistoryRow& row : history.rows) {
    times.include(row.time);
    for (const Line& line : lines) values.include(row.values[line.column] - line.offset);
  }
  for (std::size_t r = 0; r < (bands.empty() ? 0 : history.rows.size()); ++r)
    for (const Line& line : lines)
      for (const double half : {-bands[line.column][r], bands[line.column][r]})
        values.include(history.rows[r].values[line.column] - line.offset + half);
  const double most = values.empty() ? 0.0 : std::max(std::abs(values.low), std::abs(values.high));
  const bool is_round_off = most > 0.0 && most <= round_off;
  // Curves of round-off lie on the line of zero.
  if (is_round_off) values = {-100.0 * round_off, 100.0 * round_off};
  if (times.empty()) times = {0.0, 1.0};
  if (times.low == times.high) times.high = times.low + 1.0;
  const Scale scale{times, padded(values)};
  Plot plot;
  plot.svg = "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 " + pixel(width) + " " + pixel(height) +
             "\" role=\"img\" aria-label=\"" + escaped(title) +
             " over time\">\n<rect class=\"paper\" width=\"100%\" height=\"100%\"/>\n" +
             text_element("head ink", 10.0, 20.0, "start", io::shown(title, 46)) +
             axes(scale, time_label, is_round_off);
  if (is_round_off) plot.svg += text_element("tiny soft", left + 8.0, top + 14.0, "start", round_off_words);
  // If title and legend do not fit side by side, the legend is placed below the title.
  constexpr double character = 9.0, title_character = 8.0;
  double legend_x = right,
         needed = 24.0 + title_character * static_cast<double>(std::min<std::size_t>(title.size(), 49));
  for (const Line& line : lines)
    needed += 32.0 + character * static_cast<double>(legend_text(history, line, title).size());
  const double legend_y = needed > right ? 35.0 : 20.0;
  for (std::size_t k = columns.size(); k-- > 0;) {
    const std::string color = "curve s" + std::to_string(k % num_colors);
    if (!bands.empty() && !is_round_off)
      plot.svg += band_lines(history, lines[k], scale, bands[lines[k].column], "s" + std::to_string(k % num_colors));
    plot.svg += path_element(color, column_path(history, lines[k], scale));
    const std::string component = legend_text(history, lines[k], title);
    if (columns.size() < 2 || component.empty()) continue;
    plot.svg += text_element("tiny soft", legend_x, legend_y, "end", component);
    legend_x -= character * static_cast<double>(component.size()) + 6.0;
    plot.svg += path_element(color, level_stroke(legend_x - 16.0, legend_y - 4.0, 14.0));
    legend_x -= 26.0;
  }
  plot.svg += "</svg>\n";
  return plot;
}

}  // namespace bough::report
