#include "bough/laws/surface.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <utility>

#include "bough/laws/law_error.hpp"
#include "traps_masked.hpp"

namespace bough::laws {

struct Surface::Grid {
  std::vector<double> xs, ys, values;

  double at(std::size_t i, std::size_t j) const { return values[i * ys.size() + j]; }
};

namespace {

/// Where a number lies among the points of one direction.
struct Place {
  std::size_t low = 0, high = 0;  ///< points on both sides; equal outside of the grid
  double share = 0.0;             ///< s: 0 at the low, 1 at the high point
  double slope = 0.0;             ///< ds/dx; 0 outside
};

/// On a point, the side on which x grows.
Place place_in(const std::vector<double>& points, double x) {
  const auto above = std::upper_bound(points.begin(), points.end(), x);
  if (std::isnan(x)) return {0, points.size() - 1, x, x};
  if (above == points.begin()) return {};
  if (above == points.end()) return {points.size() - 1, points.size() - 1, 0.0, 0.0};
  const double from = above[-1], width = *above - from;
  const auto high = static_cast<std::size_t>(above - points.begin());
  return {high - 1, high, (x - from) / width, 1.0 / width};
}

void check_points(const std::vector<double>& points, const std::string& name) {
  if (points.empty()) throw LawError({}, 0, "a table needs at least one point in \"" + name + "\"");
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!std::isfinite(points[i])) throw LawError({}, 0, "the points of a table have to be finite");
    if (i > 0 && !(points[i - 1] < points[i]))
      throw LawError({}, 0, "the points in \"" + name + "\" must increase: entry " + std::to_string(i) + " does not");
  }
}

/// f = f_00 + a s + b r + c s r in a cell.
struct Cell {
  double corner, a, b, c;
  Place x, y;
  double value() const { return corner + a * x.share + b * y.share + c * x.share * y.share; }
  double by_x() const { return (a + c * y.share) * x.slope; }
  double by_y() const { return (b + c * x.share) * y.slope; }
};

template <class Grid>
Cell cell_of(const Grid& g, double x, double y) {
  const Place s = place_in(g.xs, x), r = place_in(g.ys, y);
  const double f00 = g.at(s.low, r.low), f10 = g.at(s.high, r.low), f01 = g.at(s.low, r.high),
               f11 = g.at(s.high, r.high);
  return {f00, f10 - f00, f01 - f00, f11 - f10 - (f01 - f00), s, r};
}

}  // namespace

Surface::Surface(std::vector<double> xs, std::vector<double> ys, std::vector<double> values) {
  check_points(xs, "x");
  check_points(ys, "y");
  if (values.size() != xs.size() * ys.size()) throw LawError({}, 0, "a table needs one value for every pair of points");
  for (double v : values)
    if (!std::isfinite(v)) throw LawError({}, 0, "the values of a table have to be finite");
  grid_ = std::make_shared<const Grid>(Grid{std::move(xs), std::move(ys), std::move(values)});
}

double Surface::operator()(double x, double y) const {
  const TrapsMasked masked;
  return grid_ ? cell_of(*grid_, x, y).value() : 0.0;
}

double Surface::operator()(double x, double y, std::span<double, 2> slopes) const {
  const TrapsMasked masked;
  slopes[0] = slopes[1] = 0.0;
  if (!grid_) return 0.0;
  const Cell c = cell_of(*grid_, x, y);
  slopes[0] = c.by_x();
  slopes[1] = c.by_y();
  return c.value();
}

LawValue Surface::along(const LawValue& x, const LawValue& y) const {
  const TrapsMasked masked;
  if (!grid_) return {};
  const Cell c = cell_of(*grid_, x.value, y.value);
  return {c.value(), c.by_x() * x.rate + c.by_y() * y.rate,
          c.by_x() * x.acceleration + c.by_y() * y.acceleration + 2.0 * c.c * c.x.slope * c.y.slope * x.rate * y.rate};
}

}  // namespace bough::laws
