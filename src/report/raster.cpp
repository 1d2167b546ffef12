#include "bough/report/raster.hpp"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "between_frames.hpp"
#include "bough/io/number_text.hpp"
#include "bough/motion/so3.hpp"
#include "bough/scene/outlines.hpp"
#include "packed.hpp"
#include "pixel_text.hpp"

namespace bough::report {
namespace {

using Vec3 = motion::Vec3<double>;
using Mat3 = motion::Mat3<double>;
using Color = std::array<double, 3>;  ///< 0 to 1

constexpr double in_front = 1e300;  ///< depth of what covers everything else
constexpr int samples = 2;          ///< per pixel and direction: edges are smoothed by averaging

Vec3 vec(const double* x) {
  Vec3 v;
  std::copy_n(x, 3, v.v);
  return v;
}
Mat3 mat(const double* axes) {
  Mat3 R;
  std::copy_n(axes, 9, R.m);
  return R;
}

/// Pixels with the depth of the nearest object so far.
class Canvas {
 public:
  Canvas(int width, int height)
      : width_(samples * width),
        height_(samples * height),
        colors_(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_), paper),
        depths_(colors_.size(), -HUGE_VAL) {}

  struct Corner {
    double x, y, depth;  ///< [samples]; larger depths are nearer
  };

  void triangle(const Corner& a, const Corner& b, const Corner& c, const Color& color) {
    const double twice = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
    if (!(std::abs(twice) > 1e-12)) return;
    const auto span = [](double low, double high, int size) {
      return std::pair{static_cast<int>(std::clamp(std::floor(low), 0.0, static_cast<double>(size))),
                       static_cast<int>(std::clamp(std::ceil(high) + 1.0, 0.0, static_cast<double>(size)))};
    };
    const auto [x0, x1] = span(std::min({a.x, b.x, c.x}), std::max({a.x, b.x, c.x}), width_);
    const auto [y0, y1] = span(std::min({a.y, b.y, c.y}), std::max({a.y, b.y, c.y}), height_);
    for (int y = y0; y < y1; ++y)
      for (int x = x0; x < x1; ++x) {
        const double px = x + 0.5, py = y + 0.5;
        const double u = ((b.x - px) * (c.y - py) - (b.y - py) * (c.x - px)) / twice;
        const double v = ((c.x - px) * (a.y - py) - (c.y - py) * (a.x - px)) / twice;
        const double w = 1.0 - u - v;
        if (u < 0.0 || v < 0.0 || w < 0.0) continue;
        put(x, y, u * a.depth + v * b.depth + w * c.depth, color);
      }
  }

  /// A line with a width in samples, drawn slightly nearer to the viewer than the surface on which it lies.
  void line(const Corner& a, const Corner& b, double width, const Color& color, double nearer) {
    const double length = std::hypot(b.x - a.x, b.y - a.y);
    if (!std::isfinite(length)) return;
    const int steps = static_cast<int>(std::min(length * 2.0, 20000.0)) + 1;
    const int r = static_cast<int>(std::ceil(0.5 * width));
    for (int k = 0; k <= steps; ++k) {
      const double s = static_cast<double>(k) / steps, x = a.x + s * (b.x - a.x), y = a.y + s * (b.y - a.y);
      if (!(x > -r && x < width_ + r && y > -r && y < height_ + r)) continue;
      const int cx = static_cast<int>(std::floor(x)), cy = static_cast<int>(std::floor(y));
      for (int dy = -r; dy <= r; ++dy)
        for (int dx = -r; dx <= r; ++dx) {
          if (std::hypot(cx + dx + 0.5 - x, cy + dy + 0.5 - y) > 0.5 * width) continue;
          if (cx + dx < 0 || cx + dx >= width_ || cy + dy < 0 || cy + dy >= height_) continue;
          put(cx + dx, cy + dy, a.depth + s * (b.depth - a.depth) + nearer, color);
        }
    }
  }

  /// A rectangle over everything else [px].
  void cover(double x, double y, double width, double height, const Color& color) {
    const auto pixel = [](double v) { return static_cast<int>(std::lround(samples * v)); };
    for (int j = std::max(0, pixel(y)); j < std::min(height_, pixel(y + height)); ++j)
      for (int i = std::max(0, pixel(x)); i < std::min(width_, pixel(x + width)); ++i) put(i, j, in_front, color);
  }
  void label(double x, double y, std::string_view text, const Color& color) {
    for (const auto& [i, j] : dots_of(text)) cover(x + 2.0 * i, y + 2.0 * j, 2.0, 2.0, color);
  }

  std::string png() const {
    const int w = width_ / samples, h = height_ / samples;
    std::string rows;
    rows.reserve(static_cast<std::size_t>(h) * static_cast<std::size_t>(3 * w + 1));
    for (int y = 0; y < h; ++y) {
      rows += '\0';  // no filter
      for (int x = 0; x < w; ++x)
        for (std::size_t c = 0; c < 3; ++c) {
          double sum = 0.0;
          for (int j = 0; j < samples; ++j)
            for (int i = 0; i < samples; ++i) sum += colors_[at(samples * x + i, samples * y + j)][c];
          rows += static_cast<char>(static_cast<unsigned char>(std::lround(255.0 * sum / (samples * samples))));
        }
    }
    std::string head;
    big_endian(head, static_cast<std::uint32_t>(w));
    big_endian(head, static_cast<std::uint32_t>(h));
    head += {'\x08', '\x02', '\0', '\0', '\0'};  // eight bits, red green blue
    return std::string("\x89PNG\r\n\x1a\n", 8) + chunk("IHDR", head) + chunk("IDAT", deflated(rows)) +
           chunk("IEND", "");
  }

 private:
  static constexpr Color paper = {0.988, 0.988, 0.984};

  static void big_endian(std::string& bytes, std::uint32_t v) {
    for (int b = 3; b >= 0; --b) bytes += static_cast<char>(v >> (8 * b) & 255u);
  }
  static std::string chunk(const std::string& kind, const std::string& data) {
    std::string bytes;
    big_endian(bytes, static_cast<std::uint32_t>(data.size()));
    const std::string body = kind + data;
    bytes += body;
    big_endian(bytes, static_cast<std::uint32_t>(
                          crc32(0, reinterpret_cast<const Bytef*>(body.data()), static_cast<uInt>(body.size()))));
    return bytes;
  }
  std::size_t at(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x);
  }
  void put(int x, int y, double depth, const Color& color) {
    const std::size_t k = at(x, y);
    if (!(depth > depths_[k])) return;
    depths_[k] = depth;
    colors_[k] = color;
  }

  int width_, height_;
  std::vector<Color> colors_;
  std::vector<double> depths_;
};

/// Maps positions in space to the canvas.
class Camera {
 public:
  /// Shows the whole motion, or only the instant if that would be too small to be visible.
  Camera(const RunFiles& run, const records::MotionFrame& instant, const RasterOptions& options) {
    projection_ = projection_of(resolve_view(options.view, box_of(run.motion)));
    for (int k = 0; k < 3; ++k) toward_[k] = cross_of(k);
    double low[2], high[2];
    const auto look_at = [&](const std::vector<records::MotionFrame>& frames) {
      std::fill_n(low, 2, HUGE_VAL);
      std::fill_n(high, 2, -HUGE_VAL);
      for_each_place(run, frames, [&](const double* x, double radius) {
        const Point2 p = projection_(x);
        if (!std::isfinite(p.u) || !std::isfinite(p.v)) return;
        low[0] = std::min(low[0], p.u - radius);
        high[0] = std::max(high[0], p.u + radius);
        low[1] = std::min(low[1], p.v - radius);
        high[1] = std::max(high[1], p.v + radius);
      });
      return std::max(high[0] - low[0], high[1] - low[1]);
    };
    constexpr double least_share = 0.02;
    const double of_instant = look_at({instant}), of_motion = look_at(run.motion);
    if (of_instant > 0.0 && of_instant < least_share * of_motion) look_at({instant});
    if (low[0] > high[0]) low[0] = high[0] = low[1] = high[1] = 0.0;
    const double width = samples * options.width, height = samples * options.height;
    extent_ = std::max({high[0] - low[0], high[1] - low[1], 1e-9 * (std::abs(high[0]) + std::abs(high[1])), 1e-12});
    scale_ = 0.86 * std::min(width / std::max(high[0] - low[0], 1e-3 * extent_),
                             height / std::max(high[1] - low[1], 1e-3 * extent_));
    x0_ = 0.5 * width - scale_ * 0.5 * (low[0] + high[0]);
    y0_ = 0.5 * height + scale_ * 0.5 * (low[1] + high[1]);
  }
  Canvas::Corner operator()(const Vec3& x) const {
    const Point2 p = projection_(x.v);
    return {x0_ + scale_ * p.u, y0_ - scale_ * p.v, dot(toward_, x)};
  }
  double extent() const { return extent_; }
  double pixels_per_length() const { return scale_ / samples; }  ///< [px/m]
  Point2 on_paper(const Vec3& direction) const { return projection_(direction.v); }
  /// Brightness of a surface with this normal, 0 to 1: a lamp beside the viewer, both sides of a surface alike.
  double light(const Vec3& n) const {
    const double size = std::sqrt(dot(n, n));
    if (!(size > 0.0)) return 1.0;
    const Vec3 lamp = toward_ + 0.35 * vec(projection_.up.data()) + (-0.25) * vec(projection_.right.data());
    return 0.45 + 0.55 * std::abs(dot(n, lamp)) / (size * std::sqrt(dot(lamp, lamp)));
  }

 private:
  /// Visits all drawn points, each with a radius around it.
  template <class Visit>
  static void for_each_place(const RunFiles& run, const std::vector<records::MotionFrame>& frames, const Visit& visit) {
    std::vector<double> of_outline, of_mesh;
    for (const scene::Outline& o : run.parts.outlines) {
      double r = 0.0;
      for (const auto& loop : o.loops)
        for (const auto& p : loop) r = std::max(r, std::hypot(p[0], p[1]));
      of_outline.push_back(r);
    }
    for (const scene::Mesh& m : run.parts.meshes) {
      double r = 0.0;
      for (const auto& p : m.points) r = std::max(r, std::hypot(p[0], p[1], p[2]));
      of_mesh.push_back(r);
    }
    const auto radius = [](const std::vector<double>& list, int k) {
      return k < 0 ? 0.0 : list[static_cast<std::size_t>(k)];
    };
    for (const records::MotionFrame& f : frames) {
      for (std::size_t c = 0; c < f.curves.size(); ++c)
        for (const records::CurvePoint& p : f.curves[c].points)
          visit(p.position, radius(of_outline, c < run.parts.curves.size() ? run.parts.curves[c].outline : -1));
      for (std::size_t k = 0; k < f.bodies.size(); ++k) {
        visit(f.bodies[k].center, radius(of_mesh, k < run.parts.bodies.size() ? run.parts.bodies[k] : -1));
        for (const auto& a : f.bodies[k].attachments) visit(a.data(), 0.0);
      }
      for (const records::Link& l : f.links) {
        visit(l.first, 0.0);
        visit(l.second, 0.0);
      }
    }
  }
  double cross_of(int k) const {
    const auto &r = projection_.right, &u = projection_.up;
    const auto a = static_cast<std::size_t>((k + 1) % 3), b = static_cast<std::size_t>((k + 2) % 3);
    return r[a] * u[b] - r[b] * u[a];
  }

  Projection projection_;
  Vec3 toward_ = Vec3::zero();  ///< direction towards the viewer
  double extent_ = 1.0, scale_ = 1.0, x0_ = 0.0, y0_ = 0.0;
};

constexpr Color beam_color = {0.165, 0.471, 0.839}, body_color = {0.45, 0.55, 0.66}, joint_color = {0.3, 0.3, 0.28},
                spring_color = {0.1, 0.55, 0.38}, load_color = {0.8, 0.18, 0.18};

Color shaded(const Color& color, double light) { return {color[0] * light, color[1] * light, color[2] * light}; }

class Painter {
 public:
  Painter(const RunFiles& run, const records::MotionFrame& instant, const RasterOptions& options)
      : run_(run), options_(options), camera_(run, instant, options), canvas_(options.width, options.height) {}

  std::string paint(const records::MotionFrame& f) {
    for (std::size_t k = 0; k < f.curves.size(); ++k) beam(f.curves[k], k);
    for (std::size_t k = 0; k < f.bodies.size(); ++k) body(f.bodies[k], k);
    for (std::size_t k = 0; k < f.links.size(); ++k) link(f.links[k], k);
    arrows(f);
    if (options_.width >= 400 && options_.height >= 250) caption(f.time);
    return canvas_.png();
  }

 private:
  void face(const Vec3& a, const Vec3& b, const Vec3& c, const Color& color) {
    const Vec3 n = lanes::cross(b - a, c - a);
    canvas_.triangle(camera_(a), camera_(b), camera_(c), shaded(color, camera_.light(n)));
  }
  void stroke(const Vec3& a, const Vec3& b, double pixels, const Color& color) {
    canvas_.line(camera_(a), camera_(b), pixels * samples, color, 2e-3 * camera_.extent());
  }

  void beam(const records::Curve& curve, std::size_t index) {
    for (std::size_t k = 0; k + 1 < curve.points.size(); ++k)
      canvas_.line(camera_(vec(curve.points[k].position)), camera_(vec(curve.points[k + 1].position)), 1.6 * samples,
                   beam_color, 0.0);
    const int outline = index < run_.parts.curves.size() ? run_.parts.curves[index].outline : -1;
    if (outline < 0 || curve.points.size() < 2) return;
    const scene::Outline& section = run_.parts.outlines[static_cast<std::size_t>(outline)];
    const auto placed = [&](const records::CurvePoint& p, const std::array<double, 2>& corner) {
      Vec3 x = vec(p.position);
      for (int r = 0; r < 3; ++r) x[r] += p.axes[3 * r + 1] * corner[0] + p.axes[3 * r + 2] * corner[1];
      return x;
    };
    for (std::size_t k = 0; k + 1 < curve.points.size(); ++k)
      for (const auto& loop : section.loops)
        for (std::size_t i = 0; i < loop.size(); ++i) {
          const auto &p = loop[i], &q = loop[(i + 1) % loop.size()];
          const Vec3 a = placed(curve.points[k], p), b = placed(curve.points[k], q), c = placed(curve.points[k + 1], q),
                     d = placed(curve.points[k + 1], p);
          face(a, b, c, beam_color);
          face(a, c, d, beam_color);
        }
    const scene::Triangulation cap = scene::triangles_of(section);
    for (const records::CurvePoint* end : {&curve.points.front(), &curve.points.back()})
      for (const auto& t : cap.triangles)
        face(placed(*end, cap.points[static_cast<std::size_t>(t[0])]),
             placed(*end, cap.points[static_cast<std::size_t>(t[1])]),
             placed(*end, cap.points[static_cast<std::size_t>(t[2])]), beam_color);
  }

  void body(const records::BodyPose& b, std::size_t index) {
    const Vec3 center = vec(b.center);
    const int index_of_mesh = index < run_.parts.bodies.size() ? run_.parts.bodies[index] : -1;
    for (const auto& a : b.attachments) stroke(center, vec(a.data()), 2.0, body_color);
    if (index_of_mesh < 0) return square(center, 0.012, body_color);
    const scene::Mesh& mesh = run_.parts.meshes[static_cast<std::size_t>(index_of_mesh)];
    const Mat3 R = mat(b.axes);
    std::vector<Vec3> x;
    for (const auto& p : mesh.points) x.push_back(center + R * vec(p.data()));
    for (const auto& t : mesh.triangles)
      face(x[static_cast<std::size_t>(t[0])], x[static_cast<std::size_t>(t[1])], x[static_cast<std::size_t>(t[2])],
           body_color);
  }

  void square(const Vec3& x, double size, const Color& color) {
    const Canvas::Corner c = camera_(x);
    canvas_.line(c, c, std::max(3.0, size * 500.0) * samples, color, 2e-2 * camera_.extent());
  }

  void link(const records::Link& l, std::size_t index) {
    const std::string kind = index < run_.parts.links.size() ? run_.parts.links[index].kind : std::string();
    const Vec3 a = vec(l.first), b = vec(l.second);
    if (!kind.starts_with("spring") && kind != "damper") {
      square(a, 0.01, joint_color);
      return stroke(a, b, 1.0, joint_color);
    }
    // A coil of eight turns between two straight ends.
    const Vec3 along = b - a;
    const double length = std::sqrt(dot(along, along));
    Vec3 other = Vec3::zero();
    other[std::abs(along[2]) < 0.9 * length ? 2 : 0] = 1.0;
    Vec3 side = lanes::cross(other, along);
    const double size = std::sqrt(dot(side, side));
    if (!(size > 0.0)) return;
    side = (std::min(0.012 * camera_.extent(), 0.2 * length) / size) * side;
    const Vec3 third = (1.0 / length) * lanes::cross(side, along);
    if (kind != "spring") dashpot(a, along, kind == "damper" ? 1.0 : 0.5, side, third);
    if (kind == "damper") return;
    constexpr int parts = 128;
    Vec3 before = a;
    for (int k = 1; k <= parts; ++k) {
      const double s = static_cast<double>(k) / parts, angle = 16.0 * 3.14159265358979 * s;
      Vec3 x = a + s * along;
      if (s > 0.1 && s < 0.9) x = x + std::cos(angle) * side + std::sin(angle) * third;
      stroke(before, x, 1.2, spring_color);
      before = x;
    }
  }

  /// The piston with its rod, and the open cylinder about it.
  void dashpot(const Vec3& a, const Vec3& along, double size, const Vec3& side, const Vec3& third) {
    const auto place = [&](double s, double u, double v) {
      return a + s * along + (size * u) * side + (size * v) * third;
    };
    stroke(place(0.0, 0.0, 0.0), place(0.5, 0.0, 0.0), 1.2, spring_color);
    stroke(place(0.66, 0.0, 0.0), place(1.0, 0.0, 0.0), 1.2, spring_color);
    for (const auto& [u, v] : {std::pair{1.0, 0.0}, std::pair{0.0, 1.0}}) {
      stroke(place(0.5, -0.7 * u, -0.7 * v), place(0.5, 0.7 * u, 0.7 * v), 1.2, spring_color);
      stroke(place(0.66, -u, -v), place(0.66, u, v), 1.2, spring_color);
      for (const double sign : {-1.0, 1.0})
        stroke(place(0.38, sign * u, sign * v), place(0.66, sign * u, sign * v), 1.2, spring_color);
    }
  }

  /// Arrows whose length is proportional to the force, relative to the largest point load or line load.
  void arrows(const records::MotionFrame& f) {
    double most[2] = {0.0, 0.0};
    for (const records::MotionFrame& g : run_.motion)
      for (const records::Arrow& a : g.arrows)
        most[a.is_per_length] = std::max(most[a.is_per_length], std::sqrt(dot(vec(a.force), vec(a.force))));
    for (const records::Arrow& a : f.arrows) {
      if (!(most[a.is_per_length] > 0.0)) continue;
      const double longest = (a.is_per_length ? 0.08 : 0.16) * camera_.extent();
      const Vec3 v = (longest / most[a.is_per_length]) * vec(a.force), tip = vec(a.position);
      stroke(tip - v, tip, 2.0, load_color);
      Vec3 other = Vec3::zero();
      other[std::abs(v[2]) < 0.9 * std::sqrt(dot(v, v)) ? 2 : 0] = 1.0;
      Vec3 side = lanes::cross(other, v);
      const double size = std::sqrt(dot(side, side));
      if (!(size > 0.0)) continue;
      side = (0.08 * std::sqrt(dot(v, v)) / size) * side;
      stroke(tip, tip - 0.22 * v + side, 2.0, load_color);
      stroke(tip, tip - 0.22 * v - side, 2.0, load_color);
    }
  }

  /// Axes, a scale and the time, in the margin below the structure.
  void caption(double time) {
    constexpr Color ink = {0.27, 0.27, 0.26}, axis_colors[3] = {{0.8, 0.2, 0.2}, {0.1, 0.5, 0.2}, {0.2, 0.36, 0.85}};
    const double base = options_.height - 20.0;
    const Vec3 directions[3] = {{{1, 0, 0}}, {{0, 1, 0}}, {{0, 0, 1}}};
    for (std::size_t k = 0; k < 3; ++k) {
      const Point2 p = camera_.on_paper(directions[k]);
      if (std::hypot(p.u, p.v) < 0.15) continue;
      const auto end = [&](double length) {
        return Canvas::Corner{26.0 + length * p.u, base - 4.0 - length * p.v, in_front};
      };
      const Canvas::Corner from = end(0.0), to = end(16.0), name = end(26.0);
      canvas_.line({samples * from.x, samples * from.y, in_front}, {samples * to.x, samples * to.y, in_front},
                   1.6 * samples, axis_colors[k], 0.0);
      canvas_.label(name.x - 5.0, name.y - 7.0, std::string_view("xyz").substr(k, 1), ink);
    }
    const double most = 120.0 / camera_.pixels_per_length(), power = std::pow(10.0, std::floor(std::log10(most)));
    const double length = power * (5.0 * power <= most ? 5.0 : 2.0 * power <= most ? 2.0 : 1.0);
    const double pixels = length * camera_.pixels_per_length(), left = 70.0;
    canvas_.cover(left, base + 5.0, pixels, 2.0, ink);
    canvas_.cover(left, base - 1.0, 2.0, 8.0, ink);
    canvas_.cover(left + pixels - 2.0, base - 1.0, 2.0, 8.0, ink);
    const std::string words = io::rounded_text(length, 3) + " m";
    canvas_.label(left + pixels + 10.0, base - 6.0, words, ink);
    const std::string when = is_of_modes(run_) ? "mode " + std::to_string(1 + static_cast<int>(time))
                             : is_static(run_) ? "load factor " + io::rounded_text(time, 3)
                                               : "t = " + io::rounded_text(time, 4) + " s";
    canvas_.label(options_.width - 20.0 - 2.0 * letter_step * static_cast<double>(when.size()), base - 6.0, when, ink);
  }

  const RunFiles& run_;
  RasterOptions options_;
  Camera camera_;
  Canvas canvas_;
};

}  // namespace

std::string picture_png(const RunFiles& run, double time, const RasterOptions& options) {
  const records::MotionFrame instant = frame_at(run.motion, time, has_velocities(run));
  return Painter(run, instant, options).paint(instant);
}

}  // namespace bough::report
