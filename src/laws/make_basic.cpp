// Constant, ramps and tables: laws made of polynomial pieces.

#include <cmath>
#include <cstddef>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "bough/laws/make_law.hpp"
#include "polynomial_pieces.hpp"

namespace bough::laws {

namespace {

using Knot = PolynomialPieces::Knot;
using Piece = PolynomialPieces::Piece;

Law make_pieces(std::vector<Knot> knots, std::vector<Piece> pieces) {
  return Law{std::make_shared<PolynomialPieces>(std::move(knots), std::move(pieces))};
}

void check_ramp(double t0, double t1, double v0, double v1) {
  for (double x : {t0, t1}) require_finite(x, "the time of a ramp");
  for (double x : {v0, v1}) require_finite(x, "the value of a ramp");
  if (!(t0 < t1)) throw LawError({}, 0, "a ramp must end after it begins");
}

/// Moments M_i = f''(times[i]) of the cubic spline with not-a-knot ends (f''' is continuous at the second and the last
/// but one knot). Each inner row has three terms:
///   h_{i-1} M_{i-1} + 2 (h_{i-1} + h_i) M_i + h_i M_{i+1} = 6 (d_i - d_{i-1}),   d_i the slope of chord i,
/// with M_0 = (1 + q) M_1 - q M_2, q = h_0 / h_1, inserted in the first row and its mirror image in the last. The
/// matrix is diagonally dominant, so pivoting is not needed.
std::vector<double> eval_spline_moments(const std::vector<double>& h, const std::vector<double>& d) {
  const std::size_t last = h.size();  // index of the last knot
  std::vector<double> moments(last + 1, 0.0);
  if (last < 2) return moments;
  if (last == 2) return std::vector<double>(3, 2.0 * (d[1] - d[0]) / (h[0] + h[1]));

  std::vector<double> lower(last, 0.0);
  std::vector<double> diagonal(last, 0.0);
  std::vector<double> upper(last, 0.0);
  for (std::size_t i = 1; i < last; ++i) {
    lower[i] = h[i - 1];
    diagonal[i] = 2.0 * (h[i - 1] + h[i]);
    upper[i] = h[i];
    moments[i] = 6.0 * (d[i] - d[i - 1]);
  }
  const double q = h[0] / h[1];
  diagonal[1] += h[0] * (1.0 + q);
  upper[1] -= h[0] * q;
  const double r = h[last - 1] / h[last - 2];
  diagonal[last - 1] += h[last - 1] * (1.0 + r);
  lower[last - 1] -= h[last - 1] * r;

  for (std::size_t i = 2; i < last; ++i) {
    const double factor = lower[i] / diagonal[i - 1];
    diagonal[i] -= factor * upper[i - 1];
    moments[i] -= factor * moments[i - 1];
  }
  moments[last - 1] /= diagonal[last - 1];
  for (std::size_t i = last - 1; i-- > 1;) moments[i] = (moments[i] - upper[i] * moments[i + 1]) / diagonal[i];
  moments[0] = (1.0 + q) * moments[1] - q * moments[2];
  moments[last] = (1.0 + r) * moments[last - 1] - r * moments[last - 2];
  return moments;
}

/// Slopes at the knots for cubics that are monotone where the data are (Fritsch, Carlson 1980): from the secants, 0
/// where two of them differ in sign or one is 0, and reduced where (m_i, m_{i+1}) / d_i leaves the circle of radius 3.
/// Inner slopes start from the mean of the secants, those at the ends from the secants.
std::vector<double> eval_monotone_slopes(const std::vector<double>& secants) {
  const std::size_t last = secants.size();
  std::vector<double> m(last + 1);
  m[0] = secants[0];
  m[last] = secants[last - 1];
  for (std::size_t i = 1; i < last; ++i)
    m[i] = secants[i - 1] * secants[i] > 0.0 ? 0.5 * (secants[i - 1] + secants[i]) : 0.0;
  for (std::size_t i = 0; i < last; ++i) {
    const double d = secants[i];
    if (d == 0.0) {
      m[i] = m[i + 1] = 0.0;
      continue;
    }
    const double a = m[i] / d, b = m[i + 1] / d, radius = std::hypot(a, b);
    if (radius <= 3.0) continue;
    m[i] = 3.0 / radius * a * d;
    m[i + 1] = 3.0 / radius * b * d;
  }
  return m;
}

void check_table(const std::vector<double>& times, const std::vector<double>& values) {
  if (times.empty()) throw LawError({}, 0, "a table needs at least one point");
  if (times.size() != values.size()) {
    throw LawError({}, 0,
                   "a table needs as many values as times: " + std::to_string(times.size()) + " times, " +
                       std::to_string(values.size()) + " values");
  }
  for (double x : times) require_finite(x, "the time of a table");
  for (double x : values) require_finite(x, "the value of a table");
  for (std::size_t i = 1; i < times.size(); ++i) {
    if (!(times[i - 1] < times[i])) {
      throw LawError({}, 0, "the times of a table must increase: entry " + std::to_string(i) + " does not");
    }
  }
}

}  // namespace

Law make_constant(double c) {
  require_finite(c, "a constant");
  return make_pieces({}, {{0.0, 1.0, {c}}});
}

Law make_ramp(double t0, double t1, double v0, double v1) {
  check_ramp(t0, t1, v0, v1);
  if (v0 == v1) return make_constant(v0);
  return make_pieces({{t0, 1}, {t1, 1}}, {{t0, 1.0, {v0}}, {t0, t1 - t0, {v0, v1 - v0}}, {t1, 1.0, {v1}}});
}

Law make_smooth_ramp(double t0, double t1, double v0, double v1) {
  check_ramp(t0, t1, v0, v1);
  if (v0 == v1) return make_constant(v0);
  const double dv = v1 - v0;
  return make_pieces(
      {{t0, 3}, {t1, 3}},
      {{t0, 1.0, {v0}}, {t0, t1 - t0, {v0, 0.0, 0.0, 10.0 * dv, -15.0 * dv, 6.0 * dv}}, {t1, 1.0, {v1}}});
}

Law make_table(const std::vector<double>& times, const std::vector<double>& values, Interpolation interpolation) {
  check_table(times, values);
  const std::size_t last = times.size() - 1;
  if (last == 0) return make_constant(values[0]);

  std::vector<double> h(last);  // widths
  std::vector<double> d(last);  // slopes of the chords
  for (std::size_t i = 0; i < last; ++i) {
    h[i] = times[i + 1] - times[i];
    d[i] = (values[i + 1] - values[i]) / h[i];
  }
  const bool is_cubic = interpolation == Interpolation::cubic;
  const bool is_monotone = interpolation == Interpolation::monotone;
  const std::vector<double> m = is_cubic      ? eval_spline_moments(h, d)
                                : is_monotone ? eval_monotone_slopes(d)
                                              : std::vector<double>(last + 1, 0.0);

  std::vector<Knot> knots;
  std::vector<Piece> pieces{{times[0], 1.0, {values[0]}}};
  for (std::size_t i = 0; i <= last; ++i) {
    const bool is_inner = i > 0 && i < last;
    knots.push_back({times[i], !is_inner ? 1 : is_cubic ? 3 : is_monotone ? 2 : 1});
    if (i == last) break;
    const double h2 = h[i] * h[i];
    std::vector<double> c{values[i], values[i + 1] - values[i]};
    if (is_cubic) {
      c[1] -= h2 * (2.0 * m[i] + m[i + 1]) / 6.0;
      c.push_back(h2 * m[i] / 2.0);
      c.push_back(h2 * (m[i + 1] - m[i]) / 6.0);
    }
    if (is_monotone) {  // the cubic of Hermite
      const double rise = c[1], from = h[i] * m[i], to = h[i] * m[i + 1];
      c = {values[i], from, 3.0 * rise - 2.0 * from - to, from + to - 2.0 * rise};
    }
    pieces.push_back({times[i], h[i], std::move(c)});
  }
  pieces.push_back({times[last], 1.0, {values[last]}});
  return make_pieces(std::move(knots), std::move(pieces));
}

}  // namespace bough::laws
