#pragma once
/// Points and lines on linear or logarithmic axes, with fitted slopes and marked failures, as SVG.
#include <string>
#include <string_view>
#include <vector>

namespace bough::report {

enum class Scale { linear, log };

struct AxisOptions {
  std::string label;  ///< with the unit: "step size [s]"
  Scale scale = Scale::linear;
};

struct ChartPoint {
  double x = 0.0, y = 0.0;
  std::string note = {};    ///< shown where the pointer rests on the mark
  std::string source = {};  ///< JSON pointer to y in the file that goes with the page; see Cell
};

/// Points in the order in which they are joined.
struct ChartSeries {
  std::string name;
  std::vector<ChartPoint> points;
  std::vector<ChartPoint> failures =
      {};          ///< y is not used: marked in a lane above the plot at their x; note: the cause
  int style = -1;  ///< number of colour and mark, >= 0, equal in all charts of a page for equal things; -1: by position
  bool has_line = true;   ///< joins the points
  bool has_marks = true;  ///< shows each of them
};

/// A dashed line y = y0 (x / x0)^slope (log-log), or y = y0 + slope (x - x0), through the plot.
struct SlopeLine {
  double x0 = 0.0, y0 = 0.0, slope = 0.0;
  std::string label;
  bool is_below = false;  ///< the compared points are above the line: the label is placed from the line's lower end on
};

struct Chart {
  std::string title;
  AxisOptions x, y;
  std::vector<ChartSeries> series;
  std::vector<SlopeLine> slopes = {};
  double width = 468.0, plot_height = 250.0;  ///< of the drawing; of the plot area [px]
};

/// One <svg> element, styled by classes (style_text). A legend is below the plot. Points that are not finite are
/// omitted and interrupt the line. A y that is zero or negative on a logarithmic axis is drawn hollow on the lower
/// edge; such an x is omitted. Lines of more than a few hundred points without marks are thinned like histories.
std::string chart_svg(const Chart& chart);

/// Position and range of a chart's plot area, for tests and overlays.
struct ChartFrame {
  double left = 0.0, right = 0.0, top = 0.0, bottom = 0.0;      ///< [px]
  double x_low = 0.0, x_high = 1.0, y_low = 0.0, y_high = 1.0;  ///< on logarithmic axes: log10
  double to_x(double x) const { return left + (right - left) * (x - x_low) / (x_high - x_low); }
  double to_y(double y) const { return bottom - (bottom - top) * (y - y_low) / (y_high - y_low); }
};
ChartFrame chart_frame(const Chart& chart);

}  // namespace bough::report
