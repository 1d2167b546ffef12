#include "bough/report/split_plot.hpp"

#include <algorithm>
#include <cmath>

#include "bough/report/picture.hpp"
#include "bough/report/plot.hpp"
#include "curve.hpp"

namespace bough::report {
namespace {

constexpr double drawing_width = 990.0, head = 66.0, left = 46.0, right = 24.0, top = 30.0, bottom = 40.0;  // [px]
constexpr double only_height = 400.0, panel_height = 232.0;  // of one panel alone, of each of several [px]
constexpr double zero_below = 1e-12;                         // relative to the largest part: smaller ones are round-off
constexpr std::size_t max_columns = 3;

/// Curve classes of style_text, the same for a part in every drawing; the sum is drawn in ink.
std::string_view class_of(io::Part part) {
  switch (part) {
    case io::Part::centripetal:
      return "curve s0";
    case io::Part::razi:
      return "curve s1";
    case io::Part::coriolis:
      return "curve s2";
    case io::Part::tangential:
      return "curve s3";
    case io::Part::local:
      return "curve s4";
    case io::Part::origin:
      return "curve s5";
    case io::Part::total:
      break;
  }
  return "mark";
}

std::string_view name_of(io::Part part) { return io::part_names[static_cast<std::size_t>(part)]; }

double largest_of(const io::SplitTable& table, io::Part part) {
  double r = 0.0;
  for (const io::SplitSeries& series : table.series)
    for (const io::SplitRow& row : series.rows) r = std::max(r, row.magnitude(part));
  return r;
}

struct Scale {
  double x_low, x_high, y_high;
  double width, height;  ///< of a panel [px]
  double to_x(double x) const { return left + (width - left - right) * (x - x_low) / (x_high - x_low); }
  double to_y(double y) const { return height - bottom - (height - bottom - top) * y / y_high; }
};

std::string label_of(const std::string& abscissa) {
  return abscissa == "psi_deg" ? "spin angle psi [degrees]" : abscissa == "time" ? "t [s]" : abscissa;
}

std::vector<double> x_ticks(const io::SplitTable& table, const Scale& scale) {
  if (table.abscissa == "psi_deg") return {0.0, 90.0, 180.0, 270.0, 360.0};
  return round_ticks(scale.x_low, scale.x_high, 6);
}

std::string title_of(const io::SplitSeries& series) {
  std::string text;
  for (const auto& [name, value] : series.parameters)
    if (name == "spin" || name == "precession")
      text += (text.empty() ? "" : ", ") + name + " " + io::rounded_text(value, 6);
  return text.empty() ? text : text + " rad/s";
}

/// A panel with its own coordinate system.
std::string panel(const io::SplitTable& table, const io::SplitSeries& series, const std::vector<io::Part>& parts,
                  const Scale& scale) {
  std::string text = text_element("head ink", left, 18.0, "start", title_of(series));
  const double x_end = scale.width - right, y_end = scale.height - bottom;
  for (const double y : round_ticks(0.0, scale.y_high, 5)) {
    text += line_element("grid", left, scale.to_y(y), x_end, scale.to_y(y));
    text += text_element("tiny soft", left - 6.0, scale.to_y(y) + 4.0, "end", io::rounded_text(y, 6));
  }
  const std::vector<double> places = x_ticks(table, scale);
  const std::vector<std::string> labels = tick_labels(places);
  for (std::size_t k = 0; k < places.size(); ++k) {
    const double x = scale.to_x(places[k]);
    text += line_element("axis", x, y_end, x, y_end + 4.0);
    text += text_element("tiny soft", x, y_end + 17.0, "middle", labels[k]);
  }
  text += line_element("axis", left, y_end, x_end, y_end);
  text += text_element("tiny soft", x_end, scale.height - 6.0, "end", label_of(table.abscissa));
  for (const io::Part part : parts)
    text += path_element(
        class_of(part),
        curve_path(
            series.rows.size(), [&](std::size_t k) { return scale.to_x(series.rows[k].at); },
            [&](std::size_t k) { return series.rows[k].magnitude(part); }, [&](double y) { return scale.to_y(y); }));
  return text;
}

std::string legend(const std::vector<io::Part>& parts, double x, double y) {
  std::string text;
  for (const io::Part part : parts) {
    text += path_element(class_of(part), level_stroke(x, y - 4.0, 18.0));
    text += text_element("tiny soft", x + 24.0, y, "start", name_of(part));
    x += 24.0 + 7.0 * static_cast<double>(name_of(part).size()) + 16.0;
  }
  return text;
}

}  // namespace

std::string split_svg(const io::SplitTable& table) {
  double largest = 0.0;
  for (const io::Part part : table.columns) largest = std::max(largest, largest_of(table, part));
  std::vector<io::Part> parts;
  for (const io::Part part : table.columns)
    if (largest_of(table, part) > zero_below * largest) parts.push_back(part);

  const auto& rows = table.series.front().rows;
  const std::size_t columns = std::min(max_columns, table.series.size());
  const std::size_t lines = (table.series.size() + columns - 1) / columns;
  const double panel_width = drawing_width / static_cast<double>(columns);
  const Scale scale{rows.front().at, rows.back().at, largest > 0.0 ? 1.05 * largest : 1.0, panel_width,
                    table.series.size() > 1 ? panel_height : only_height};
  const double height = head + scale.height * static_cast<double>(lines);
  std::string text =
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 " + pixel(drawing_width) + " " + pixel(height) +
      "\" role=\"img\">\n<title>" + escaped(table.title) + "</title>\n<style>" + std::string(style_text()) +
      "</style>\n<rect class=\"paper\" width=\"100%\" height=\"100%\"/>\n" +
      text_element("head ink", 10.0, 24.0, "start", table.title + ": magnitudes [m/s^2] seen from " + table.seen_from) +
      legend(parts, 10.0, 48.0);
  for (std::size_t k = 0; k < table.series.size(); ++k)
    text += "<g transform=\"translate(" + pixel(panel_width * static_cast<double>(k % columns)) + " " +
            pixel(head + scale.height * static_cast<double>(k / columns)) + ")\">\n" +
            panel(table, table.series[k], parts, scale) + "</g>\n";
  return text + "</svg>\n";
}

}  // namespace bough::report
