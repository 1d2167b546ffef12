#include "bough/scene/outlines.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "bough/scene/shapes.hpp"

namespace bough::scene {
namespace {

using Point = std::array<double, 2>;
using Loop = std::vector<Point>;
using Rings = std::vector<std::pair<double, Loop>>;

constexpr int num_sides = 24;
constexpr double pi = std::numbers::pi;

/// Points of an ellipse's polygon with the ellipse's own area: the polygon of n sides within an ellipse has the area
/// n/2 sin(2 pi/n) a b, so both half-axes are stretched by the root of pi over n/2 sin(2 pi/n).
Loop round_loop(double a, double b, int sides = num_sides) {
  const double turn = 2.0 * pi / sides, stretch = std::sqrt(turn / std::sin(turn));
  Loop loop;
  for (int k = 0; k < sides; ++k) loop.push_back({stretch * a * std::cos(k * turn), stretch * b * std::sin(k * turn)});
  return loop;
}

Loop reversed(Loop loop) {
  std::reverse(loop.begin(), loop.end());
  return loop;
}

Loop rectangle_loop(double width, double height) {
  const double a = 0.5 * width, b = 0.5 * height;
  return {{-a, -b}, {a, -b}, {a, b}, {-a, b}};
}

Outline outline(const Rectangle& s, int) { return {{rectangle_loop(s.width, s.height)}}; }
Outline outline(const Circle& s, int n) { return {{round_loop(s.radius, s.radius, n)}}; }
Outline outline(const Tube& s, int n) {
  return {{round_loop(s.outer_radius, s.outer_radius, n), reversed(round_loop(s.inner_radius, s.inner_radius, n))}};
}
Outline outline(const Ellipse& s, int n) { return {{round_loop(0.5 * s.width, 0.5 * s.height, n)}}; }
Outline outline(const HollowBox& s, int) {
  return {{rectangle_loop(s.width, s.height),
           reversed(rectangle_loop(s.width - 2.0 * s.thickness, s.height - 2.0 * s.thickness))}};
}
Outline outline(const IProfile& s, int) {
  const double a = 0.5 * s.width, b = 0.5 * s.height, w = 0.5 * s.web, f = b - s.flange;
  return {
      {{{-a, -b}, {a, -b}, {a, -f}, {w, -f}, {w, f}, {a, f}, {a, b}, {-a, b}, {-a, f}, {-w, f}, {-w, -f}, {-a, -f}}}};
}
Outline outline(const CProfile& s, int) {
  const double a = s.width, b = 0.5 * s.height, w = s.web, f = b - s.flange;
  return centered({{{{0, -b}, {a, -b}, {a, -f}, {w, -f}, {w, f}, {a, f}, {a, b}, {0, b}}}});
}
Outline outline(const LProfile& s, int) {
  const double a = s.width, b = s.height, t = s.thickness;
  return centered({{{{0, 0}, {a, 0}, {a, t}, {t, t}, {t, b}, {0, b}}}});
}
Outline outline(const Polygon& s, int) { return centered(s.outline); }

/// Puts (along, across, across) into the body's axes so that `along` is its axis `axis`; even permutations keep the
/// side from which triangles are seen.
std::array<double, 3> turned(int axis, double along, double second, double third) {
  std::array<double, 3> x{};
  const auto a = static_cast<std::size_t>(axis - 1);
  x[a] = along;
  x[(a + 1) % 3] = second;
  x[(a + 2) % 3] = third;
  return x;
}

/// Triangles between consecutive rings of equally many points, and from the last to the first if it is a torus.
Mesh lofted(int axis, const Rings& rings, bool is_torus = false) {
  Mesh mesh;
  const int n = static_cast<int>(rings.front().second.size()), m = static_cast<int>(rings.size());
  for (const auto& [along, loop] : rings)
    for (const Point& p : loop) mesh.points.push_back(turned(axis, along, p[0], p[1]));
  for (int r = 0; r + (is_torus ? 0 : 1) < m; ++r)
    for (int k = 0; k < n; ++k) {
      const int next = (k + 1) % n, low = r * n, high = (r + 1) % m * n;
      mesh.triangles.push_back({low + k, low + next, high + next});
      mesh.triangles.push_back({low + k, high + next, high + k});
    }
  return mesh;
}

/// As lofted(), closed by fans around the centres of the first and the last ring.
Mesh closed(int axis, const Rings& rings) {
  Mesh mesh = lofted(axis, rings);
  const int n = static_cast<int>(rings.front().second.size()), last = static_cast<int>(rings.size()) - 1;
  for (const int ring : {0, last}) {
    const int middle = static_cast<int>(mesh.points.size());
    mesh.points.push_back(turned(axis, rings[static_cast<std::size_t>(ring)].first, 0.0, 0.0));
    for (int k = 0; k < n; ++k) {
      const int a = ring * n + k, b = ring * n + (k + 1) % n;
      mesh.triangles.push_back(ring == 0 ? std::array<int, 3>{middle, b, a} : std::array<int, 3>{middle, a, b});
    }
  }
  return mesh;
}

Mesh prism(int axis, double length, const Loop& loop) {
  return closed(axis, {{-0.5 * length, loop}, {0.5 * length, loop}});
}

Mesh with_volume(Mesh mesh, double volume) {
  const double scale = std::cbrt(volume / volume_of(mesh));
  for (auto& x : mesh.points)
    for (double& c : x) c *= scale;
  return mesh;
}

/// Rings of a half circle around `middle`, from the angle `begin` to `end`, counted from the lower pole.
void add_round(Rings& rings, double middle, double radius, double begin, double end) {
  constexpr int num_rings = num_sides / 4;
  for (int k = 0; k <= num_rings; ++k) {
    const double angle = begin + (end - begin) * k / num_rings;
    const double r = std::max(radius * std::sin(angle), 1e-6 * radius);  // poles are small rings
    rings.emplace_back(middle - radius * std::cos(angle), round_loop(r, r));
  }
}

Mesh mesh(const Box& s) { return prism(1, s.size[0], rectangle_loop(s.size[1], s.size[2])); }
Mesh mesh(const Cylinder& s) { return prism(s.axis, s.length, round_loop(s.radius, s.radius)); }
Mesh mesh(const Sphere& s) {
  Rings rings;
  add_round(rings, 0.0, s.radius, 0.0, 0.5 * pi);
  rings.pop_back();  // the equator belongs to both halves
  add_round(rings, 0.0, s.radius, 0.5 * pi, pi);
  return with_volume(closed(1, rings), volume_of(BodyShape(s)));
}
Mesh mesh(const Rod& s) {
  constexpr double slenderness = 50.0;
  const double radius = 0.5 * s.length / slenderness;
  return prism(s.axis, s.length, round_loop(radius, radius));
}
Mesh mesh(const Capsule& s) {
  Rings rings;
  add_round(rings, -0.5 * s.length, s.radius, 0.0, 0.5 * pi);
  add_round(rings, 0.5 * s.length, s.radius, 0.5 * pi, pi);
  return with_volume(closed(s.axis, rings), volume_of(BodyShape(s)));
}
Mesh mesh(const Cone& s) {
  const double low = -center_height(s);
  const double tip = std::max(s.end_radius, 1e-6 * s.radius);
  return closed(s.axis, {{low, round_loop(s.radius, s.radius)}, {low + s.length, round_loop(tip, tip)}});
}
Mesh mesh(const Ring& s) {
  const Loop outer = round_loop(s.outer_radius, s.outer_radius), inner = round_loop(s.inner_radius, s.inner_radius);
  const double a = -0.5 * s.length, b = 0.5 * s.length;
  return lofted(s.axis, {{a, inner}, {a, outer}, {b, outer}, {b, inner}}, true);
}
Mesh mesh(const Extrusion& s) {
  const Outline outline = centered(s.outline);
  const Triangulation flat = triangles_of(outline);
  Mesh mesh;
  const int n = static_cast<int>(flat.points.size());
  for (const double along : {-0.5 * s.length, 0.5 * s.length})
    for (const Point& p : flat.points) mesh.points.push_back(turned(s.axis, along, p[0], p[1]));
  for (const auto& t : flat.triangles) {
    mesh.triangles.push_back({t[0], t[2], t[1]});
    mesh.triangles.push_back({t[0] + n, t[1] + n, t[2] + n});
  }
  int first = 0;
  for (const Loop& loop : outline.loops) {
    const int count = static_cast<int>(loop.size());
    for (int k = 0; k < count; ++k) {
      const int a = first + k, b = first + (k + 1) % count;
      mesh.triangles.push_back({a, b, b + n});
      mesh.triangles.push_back({a, b + n, a + n});
    }
    first += count;
  }
  return mesh;
}

}  // namespace

Outline outline_of(const SectionShape& shape, int sides) {
  return std::visit([sides](const auto& s) { return outline(s, sides); }, shape);
}

Rectangle equivalent_rectangle(const motion::Mat6<double>& K) {
  return {std::sqrt(12.0 * K(5, 5) / K(0, 0)), std::sqrt(12.0 * K(4, 4) / K(0, 0))};
}

Mesh mesh_of(const BodyShape& shape) {
  return std::visit([](const auto& s) { return mesh(s); }, shape);
}

double volume_of(const Mesh& mesh) {
  double six = 0.0;
  for (const auto& t : mesh.triangles) {
    const auto &a = mesh.points[static_cast<std::size_t>(t[0])], &b = mesh.points[static_cast<std::size_t>(t[1])],
               &c = mesh.points[static_cast<std::size_t>(t[2])];
    six += a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) + a[2] * (b[0] * c[1] - b[1] * c[0]);
  }
  return six / 6.0;
}

}  // namespace bough::scene
