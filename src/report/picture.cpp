#include "bough/report/picture.hpp"

#include <algorithm>
#include <cmath>

#include "svg_text.hpp"

namespace bough::report {
namespace {

constexpr double page_width = 960.0, margin = 24.0, foot = 96.0;  // [px]
constexpr double tallest = 560.0, lowest = 150.0;                 // of the drawn area
constexpr double same_spot = 0.35;                                // points nearer than this are one [px]
constexpr int num_colors = 9;

/// Maps projected positions to pixels of the drawing: u to the right, v down.
struct Sheet {
  Projection projection;
  double scale = 1.0;            ///< [px/m]
  double left = 0.0, top = 0.0;  ///< of the drawn area
  double u_low = 0.0, v_high = 0.0;
  double height = 0.0;  ///< of the whole drawing
  double width() const { return page_width; }

  Point2 operator()(const double* x) const {
    const Point2 p = projection(x);
    return {left + scale * (p.u - u_low), top + scale * (v_high - p.v)};
  }
};

void include(double& low, double& high, double value) {
  low = std::min(low, value);
  high = std::max(high, value);
}

/// Fits the projection of all frames to the sheet, with equal scales of both axes.
Sheet make_sheet(const std::vector<records::MotionFrame>& frames, const Projection& projection) {
  double u_low = HUGE_VAL, u_high = -HUGE_VAL, v_low = HUGE_VAL, v_high = -HUGE_VAL;
  const auto take = [&](const double* x) {
    const Point2 p = projection(x);
    if (!std::isfinite(p.u) || !std::isfinite(p.v)) return;
    include(u_low, u_high, p.u);
    include(v_low, v_high, p.v);
  };
  for (const records::MotionFrame& frame : frames) {
    for (const records::Curve& curve : frame.curves)
      for (const records::CurvePoint& point : curve.points) take(point.position);
    for (const records::BodyPose& body : frame.bodies) {
      take(body.center);
      for (const auto& point : body.attachments) take(point.data());
    }
    for (const records::Link& link : frame.links) {
      take(link.first);
      take(link.second);
    }
  }
  if (u_low > u_high) u_low = u_high = v_low = v_high = 0.0;
  const double smallest =
      1e-12 * std::max({std::abs(u_low), std::abs(u_high), std::abs(v_low), std::abs(v_high)}) + 1e-300;
  double u_extent = u_high - u_low, v_extent = v_high - v_low;
  if (std::max(u_extent, v_extent) <= smallest) u_extent = 1.0;  // a single point at rest: one metre around it
  const double inner = page_width - 2.0 * margin;
  Sheet sheet;
  sheet.projection = projection;
  sheet.scale = std::min(inner / std::max(u_extent, smallest), tallest / std::max(v_extent, smallest));
  const double drawn_height = std::max(lowest, sheet.scale * v_extent);
  sheet.left = margin + 0.5 * (inner - sheet.scale * (u_high - u_low));
  sheet.top = margin + 0.5 * (drawn_height - sheet.scale * (v_high - v_low));
  sheet.u_low = u_low;
  sheet.v_high = v_high;
  sheet.height = drawn_height + 2.0 * margin + foot;
  return sheet;
}

/// Builds path data; points that coincide with the previous one are omitted.
class PathData {
 public:
  explicit PathData(const Sheet& sheet) : sheet_(sheet) {}

  void move(const double* x) {
    is_pending_ = false;
    if (place(x)) put('M');
  }
  void draw(const double* x) {
    if (!place(x)) return;
    is_pending_ = std::abs(here_.u - drawn_.u) + std::abs(here_.v - drawn_.v) < same_spot;
    if (!is_pending_) put('L');
  }
  /// Ends a curve at its last point, which is never omitted.
  void finish() {
    if (is_pending_) put('L');
    is_pending_ = false;
  }
  void dot(const double* x) {
    if (!place(x)) return;
    put('M');
    text_ += "h0";
  }
  std::string take() { return std::move(text_); }

 private:
  bool place(const double* x) {
    const Point2 p = sheet_(x);
    if (!std::isfinite(p.u) || !std::isfinite(p.v)) return false;
    here_ = p;
    return true;
  }
  void put(char command) {
    text_ += command;
    append_pixel(text_, here_.u);
    text_ += ' ';
    append_pixel(text_, here_.v);
    drawn_ = here_;
  }

  const Sheet& sheet_;
  Point2 here_, drawn_;
  bool is_pending_ = false;
  std::string text_;
};

bool has_length(const records::Link& link) {
  return std::hypot(link.second[0] - link.first[0], link.second[1] - link.first[1], link.second[2] - link.first[2]) >
         0.0;
}

Picture::Paths paths_of(const records::MotionFrame& frame, const Sheet& sheet) {
  Picture::Paths paths;
  paths.time = frame.time;
  PathData beams(sheet), bodies(sheet), springs(sheet), joints(sheet);
  for (const records::Curve& curve : frame.curves) {
    if (curve.points.empty()) continue;
    beams.move(curve.points.front().position);
    for (std::size_t k = 1; k < curve.points.size(); ++k) beams.draw(curve.points[k].position);
    beams.finish();
  }
  for (const records::BodyPose& body : frame.bodies) {
    for (const auto& point : body.attachments) {
      bodies.move(body.center);
      bodies.draw(point.data());
      bodies.finish();
    }
    joints.dot(body.center);
  }
  for (const records::Link& link : frame.links) {
    joints.dot(link.first);
    joints.dot(link.second);
    if (!has_length(link)) continue;
    springs.move(link.first);
    springs.draw(link.second);
    springs.finish();
  }
  paths.beams = beams.take();
  paths.bodies = bodies.take();
  paths.springs = springs.take();
  paths.joints = joints.take();
  return paths;
}

/// The largest of 1, 2, 5 times a power of ten up to `limit`.
double round_below(double limit) {
  const double power = std::pow(10.0, std::floor(std::log10(limit)));
  for (const double factor : {5.0, 2.0})
    if (factor * power <= limit) return factor * power;
  return power;
}

std::string length_text(double metres) {
  if (metres >= 1000.0 && metres < 1e7) return io::rounded_text(metres / 1000.0, 3) + " km";
  if (metres < 1e-3 && metres >= 1e-7) return io::rounded_text(metres * 1e6, 3) + " µm";
  if (metres < 1.0 && metres >= 1e-3) return io::rounded_text(metres * 1e3, 3) + " mm";
  return io::rounded_text(metres, 3) + " m";
}

std::string scale_bar(const Sheet& sheet) {
  const double length = round_below(160.0 / sheet.scale), end = margin + length * sheet.scale;
  const double y = sheet.height - 30.0;
  return line_element("mark", margin, y, end, y) + line_element("mark", margin, y - 4.0, margin, y + 4.0) +
         line_element("mark", end, y - 4.0, end, y + 4.0) +
         text_element("tiny soft", margin, y + 18.0, "start", length_text(length));
}

std::string axis_triad(const Sheet& sheet) {
  constexpr double length = 24.0;
  const double x0 = 260.0, y0 = sheet.height - 26.0;
  std::string text;
  for (std::size_t k = 0; k < 3; ++k) {
    const double u = sheet.projection.right[k], v = sheet.projection.up[k], size = std::hypot(u, v);
    if (size < 0.1) continue;
    text += line_element("mark", x0, y0, x0 + length * u, y0 - length * v);
    text += text_element("tiny soft", x0 + (length + 9.0) * u / size, y0 - (length * size + 9.0) * v / size + 4.0,
                         "middle", std::string_view("xyz").substr(k, 1));
  }
  return text;
}

std::string color_ramp(const Sheet& sheet, const std::vector<double>& times, const std::vector<int>& colors,
                       const PictureOptions& options) {
  const double step =
      std::max(26.0, 170.0 / static_cast<double>(times.size()));  // the first and the last time have to fit side by
                                                                  // side
  const double right = page_width - margin, left = right - step * static_cast<double>(times.size()),
               y = sheet.height - 36.0;
  std::string text;
  for (std::size_t k = 0; k < times.size(); ++k) {
    const double x = left + step * static_cast<double>(k);
    text += path_element("beams t" + std::to_string(colors[k]), level_stroke(x + 3.0, y, step - 6.0));
  }
  text += text_element("tiny soft", left - 8.0, y + 4.0, "end",
                       options.is_by_step  ? "position at step"
                       : options.is_static ? "position at load"
                                           : "position at");
  const char* unit = options.is_static || options.is_by_step ? "" : " s";
  const bool several = times.size() > 1;
  text += text_element("tiny soft", several ? left : right, y + 22.0, several ? "start" : "end",
                       io::rounded_text(times.front(), 4) + unit);
  if (several) text += text_element("tiny soft", right, y + 22.0, "end", io::rounded_text(times.back(), 4) + unit);
  return text;
}

std::string legend(const Sheet& sheet, const std::vector<records::MotionFrame>& frames) {
  const records::MotionFrame& frame = frames.front();
  const double y = sheet.height - 84.0;  // on a line of its own, above scale, axes and times
  double x = margin;
  std::string text;
  const auto entry = [&](const char* classes, const std::string& data, const char* name, double advance) {
    text += path_element(classes, data) + text_element("tiny soft", x + 34.0, y + 4.0, "start", name);
    x += advance;
  };
  const bool has_spokes =
      std::any_of(frame.bodies.begin(), frame.bodies.end(), [](const auto& body) { return !body.attachments.empty(); });
  // The two points of a joint differ by round-off only, those of a spring by much: links of some pixels are drawn as
  // lines.
  const auto is_long = [&](const records::Link& link) {
    const Point2 a = sheet(link.first), b = sheet(link.second);
    return std::hypot(b.u - a.u, b.v - a.v) > 1.0;
  };
  const bool has_springs = std::any_of(frames.begin(), frames.end(), [&](const records::MotionFrame& f) {
    return std::any_of(f.links.begin(), f.links.end(), is_long);
  });
  const char* joint_words = frame.bodies.empty() ? "joint" : frame.links.empty() ? "centre" : "centre, joint";
  if (!frame.curves.empty()) entry("beams t5", level_stroke(x, y, 26.0), "beam", 80.0);
  if (has_spokes) entry("bodies t5", level_stroke(x, y, 26.0), "body", 80.0);
  if (has_springs) entry("springs t5", level_stroke(x, y, 26.0), "link", 80.0);
  if (!frame.bodies.empty() || !frame.links.empty())
    entry("joints t5", level_stroke(x + 20.0, y, 0.0), joint_words, 110.0);
  return text;
}

}  // namespace

Picture make_picture(const std::vector<records::MotionFrame>& frames, const PictureOptions& options) {
  Picture picture;
  picture.view = resolve_view(options.view, box_of(frames));
  const Sheet sheet = make_sheet(frames, projection_of(picture.view));

  const std::size_t wanted = static_cast<std::size_t>(std::clamp(options.num_positions, 1, num_colors));
  const std::size_t num_shown = std::min(wanted, frames.size());
  std::vector<double> times;
  std::vector<int> colors;
  std::string positions;
  for (std::size_t k = 0; k < num_shown; ++k) {
    const std::size_t f = num_shown == 1 ? frames.size() - 1 : k * (frames.size() - 1) / (num_shown - 1);
    const int color = num_shown == 1 ? num_colors - 1 : static_cast<int>(k * (num_colors - 1) / (num_shown - 1));
    const std::string shade = " t" + std::to_string(color);
    picture.positions.push_back(paths_of(frames[f], sheet));
    const Picture::Paths& paths = picture.positions.back();
    positions += path_element("bodies" + shade, paths.bodies) + path_element("springs" + shade, paths.springs) +
                 path_element("beams" + shade, paths.beams) + path_element("joints" + shade, paths.joints);
    times.push_back(paths.time);
    colors.push_back(color);
  }
  picture.svg = "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 " + pixel(page_width) + " " +
                pixel(sheet.height) + "\" role=\"img\" aria-label=\"Positions of the structure over time, view " +
                std::string(name_of(picture.view)) + "\">\n" +
                "<rect class=\"paper\" width=\"100%\" height=\"100%\"/>\n<g id=\"positions\">\n" + positions +
                "</g>\n" + scale_bar(sheet) + axis_triad(sheet) + legend(sheet, frames) +
                color_ramp(sheet, times, colors, options) + "</svg>\n";
  return picture;
}

std::string standalone_svg(const Picture& picture, std::string_view title) {
  const std::size_t after_tag = picture.svg.find('\n') + 1;
  return picture.svg.substr(0, after_tag) + "<title>" + escaped(title) + "</title>\n<style>" +
         std::string(style_text()) + "</style>\n" + picture.svg.substr(after_tag);
}

}  // namespace bough::report
