/// Polygons: moments, what can be wrong with them, triangles that fill them.
#include <algorithm>
#include <cmath>

#include "bough/scene/outlines.hpp"

namespace bough::scene {
namespace {

using Point = std::array<double, 2>;
using Loop = std::vector<Point>;

double cross(const Point& a, const Point& b, const Point& c) {
  return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

double area_of(const Loop& loop) { return moments_of({{loop}}).area; }

/// Whether the open edges a-b and c-d have a point in common; it must not be called for edges that share a corner.
bool edges_meet(const Point& a, const Point& b, const Point& c, const Point& d) {
  const double s = cross(a, b, c), t = cross(a, b, d), u = cross(c, d, a), v = cross(c, d, b);
  const auto sign = [](double x) { return (x > 0.0) - (x < 0.0); };
  if (sign(s) * sign(t) < 0 && sign(u) * sign(v) < 0) return true;
  const auto within = [](const Point& p, const Point& q, const Point& x) {
    return std::min(p[0], q[0]) <= x[0] && x[0] <= std::max(p[0], q[0]) && std::min(p[1], q[1]) <= x[1] &&
           x[1] <= std::max(p[1], q[1]);
  };
  return (s == 0.0 && within(a, b, c)) || (t == 0.0 && within(a, b, d)) || (u == 0.0 && within(c, d, a)) ||
         (v == 0.0 && within(c, d, b));
}

bool has_crossing(const Outline& outline) {
  struct Edge {
    std::size_t loop, begin, end;
  };
  std::vector<Edge> edges;
  for (std::size_t l = 0; l < outline.loops.size(); ++l)
    for (std::size_t k = 0; k < outline.loops[l].size(); ++k)
      edges.push_back({l, k, (k + 1) % outline.loops[l].size()});
  for (std::size_t i = 0; i < edges.size(); ++i)
    for (std::size_t j = i + 1; j < edges.size(); ++j) {
      const Edge &e = edges[i], &f = edges[j];
      const bool share = e.loop == f.loop && (e.end == f.begin || f.end == e.begin || e.begin == f.begin);
      if (share) continue;
      const Loop &p = outline.loops[e.loop], &q = outline.loops[f.loop];
      if (edges_meet(p[e.begin], p[e.end], q[f.begin], q[f.end])) return true;
    }
  return false;
}

bool is_inside(const Point& x, const Point& a, const Point& b, const Point& c) {
  return cross(a, b, x) >= 0.0 && cross(b, c, x) >= 0.0 && cross(c, a, x) >= 0.0;
}

/// Joins all loops to one: each hole is connected by a bridge from its rightmost corner to a visible corner of the
/// loops joined so far.
std::vector<int> joined_loops(const Outline& outline, const std::vector<Point>& points) {
  std::vector<int> joined;
  int first = 0;
  for (std::size_t l = 0; l < outline.loops.size(); ++l) {
    const int n = static_cast<int>(outline.loops[l].size());
    std::vector<int> own;
    for (int k = 0; k < n; ++k) own.push_back(first + k);
    first += n;
    if (l == 0) {
      joined = own;
      continue;
    }
    const auto at = [&](int k) { return points[static_cast<std::size_t>(k)]; };
    std::rotate(own.begin(), std::max_element(own.begin(), own.end(), [&](int a, int b) { return at(a) < at(b); }),
                own.end());
    const Point from = at(own.front());
    std::size_t best = 0;
    double nearest = HUGE_VAL;
    for (std::size_t k = 0; k < joined.size(); ++k) {
      const Point to = at(joined[k]);
      const double distance = std::hypot(to[0] - from[0], to[1] - from[1]);
      if (distance >= nearest) continue;
      bool is_seen = true;
      for (std::size_t e = 0; e < joined.size() && is_seen; ++e) {
        const int a = joined[e], b = joined[(e + 1) % joined.size()];
        if (a == joined[k] || b == joined[k]) continue;
        is_seen = !edges_meet(from, to, at(a), at(b));
      }
      if (!is_seen) continue;
      best = k;
      nearest = distance;
    }
    std::vector<int> bridge = own;
    bridge.push_back(own.front());
    bridge.push_back(joined[best]);
    joined.insert(joined.begin() + static_cast<std::ptrdiff_t>(best) + 1, bridge.begin(), bridge.end());
  }
  return joined;
}

}  // namespace

PolygonMoments moments_of(const Outline& outline) {
  PolygonMoments m;
  for (const Loop& loop : outline.loops)
    for (std::size_t k = 0; k < loop.size(); ++k) {
      const Point &a = loop[k], &b = loop[(k + 1) % loop.size()];
      const double w = a[0] * b[1] - b[0] * a[1];
      m.area += w / 2.0;
      m.first_2 += (a[0] + b[0]) * w / 6.0;
      m.first_3 += (a[1] + b[1]) * w / 6.0;
      m.square_2 += (a[0] * a[0] + a[0] * b[0] + b[0] * b[0]) * w / 12.0;
      m.square_3 += (a[1] * a[1] + a[1] * b[1] + b[1] * b[1]) * w / 12.0;
      m.product += (a[0] * b[1] + 2.0 * a[0] * a[1] + 2.0 * b[0] * b[1] + b[0] * a[1]) * w / 24.0;
    }
  return m;
}

Outline centered(Outline outline) {
  for (int pass = 0; pass < 2; ++pass) {  // the second pass removes the round-off of an outline far from the origin
    const PolygonMoments m = moments_of(outline);
    for (Loop& loop : outline.loops)
      for (Point& p : loop) p = {p[0] - m.first_2 / m.area, p[1] - m.first_3 / m.area};
  }
  return outline;
}

std::string problem_in(const Outline& outline) {
  constexpr std::size_t most = 500;
  std::size_t corners = 0;
  for (std::size_t l = 0; l < outline.loops.size(); ++l) {
    const Loop& loop = outline.loops[l];
    corners += loop.size();
    if (loop.size() < 3) return "an outline has at least three corners";
    for (std::size_t k = 0; k < loop.size(); ++k) {
      if (!std::isfinite(loop[k][0]) || !std::isfinite(loop[k][1])) return "a corner is not finite";
      if (loop[k] == loop[(k + 1) % loop.size()])
        return "a corner is given twice (the last one is joined to the first by itself)";
    }
  }
  if (corners == 0) return "an outline has at least three corners";
  if (corners > most) return "an outline has at most " + std::to_string(most) + " corners";
  if (has_crossing(outline)) return "its edges cross or touch each other";
  for (std::size_t l = 0; l < outline.loops.size(); ++l) {
    const double area = area_of(outline.loops[l]);
    if (l == 0 && !(area > 0.0)) return "its corners go clockwise: list them counter-clockwise, from axis 2 to axis 3";
    if (l > 0 && !(area < 0.0)) return "the corners of a hole go counter-clockwise: list them clockwise";
  }
  if (!(moments_of(outline).area > 0.0)) return "its holes are larger than itself";
  return {};
}

Triangulation triangles_of(const Outline& outline) {
  Triangulation result;
  for (const Loop& loop : outline.loops) result.points.insert(result.points.end(), loop.begin(), loop.end());
  std::vector<int> left = joined_loops(outline, result.points);
  const auto at = [&](int k) -> const Point& { return result.points[static_cast<std::size_t>(k)]; };
  while (left.size() > 2) {
    const std::size_t n = left.size();
    bool has_cut = false;
    for (std::size_t k = 0; k < n && !has_cut; ++k) {
      const int a = left[(k + n - 1) % n], b = left[k], c = left[(k + 1) % n];
      if (!(cross(at(a), at(b), at(c)) > 0.0)) continue;
      const bool is_ear = std::none_of(left.begin(), left.end(), [&](int p) {
        return at(p) != at(a) && at(p) != at(b) && at(p) != at(c) && is_inside(at(p), at(a), at(b), at(c));
      });
      if (!is_ear) continue;
      result.triangles.push_back({a, b, c});
      left.erase(left.begin() + static_cast<std::ptrdiff_t>(k));
      has_cut = true;
    }
    if (has_cut) continue;
    // The remaining polygon has no area: corners on one line.
    const auto flat = std::find_if(left.begin(), left.end(), [&](const int& p) {
      const auto k = static_cast<std::size_t>(&p - left.data());
      return cross(at(left[(k + n - 1) % n]), at(p), at(left[(k + 1) % n])) == 0.0;
    });
    if (flat == left.end()) break;
    left.erase(flat);
  }
  return result;
}

}  // namespace bough::scene
