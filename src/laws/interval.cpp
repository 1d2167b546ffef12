#include "interval.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace bough::laws {

namespace {

constexpr double eps = std::numeric_limits<double>::epsilon();
constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double pi = std::numbers::pi;

/// Outwards by the error of one operation of the library (a few units in the last place).
Interval widen(double lo, double hi) {
  if (std::isnan(lo) || std::isnan(hi)) return everything();
  return {lo - 4.0 * eps * std::abs(lo), hi + 4.0 * eps * std::abs(hi)};
}

/// 0 times infinity is 0 here: the infinite end is a bound, not a number that is taken.
double times(double a, double b) { return a == 0.0 || b == 0.0 ? 0.0 : a * b; }

/// True where some  first + k period  lies in [lo, hi], within the error of the arguments.
bool holds_phase(const Interval& a, double first, double period) {
  const double slack = 4.0 * eps * (1.0 + std::max(std::abs(a.lo), std::abs(a.hi)));
  const double k = std::ceil((a.lo - slack - first) / period);
  return first + k * period <= a.hi + slack;
}

}  // namespace

Interval everything() { return {-infinity, infinity}; }

Interval hull(const Interval& a, const Interval& b) { return {std::min(a.lo, b.lo), std::max(a.hi, b.hi)}; }

Interval operator-(const Interval& a) { return {-a.hi, -a.lo}; }

Interval operator+(const Interval& a, const Interval& b) { return widen(a.lo + b.lo, a.hi + b.hi); }

Interval operator-(const Interval& a, const Interval& b) { return widen(a.lo - b.hi, a.hi - b.lo); }

Interval operator*(const Interval& a, const Interval& b) {
  const double p = times(a.lo, b.lo);
  const double q = times(a.lo, b.hi);
  const double r = times(a.hi, b.lo);
  const double s = times(a.hi, b.hi);
  return widen(std::min(std::min(p, q), std::min(r, s)), std::max(std::max(p, q), std::max(r, s)));
}

Interval operator/(const Interval& a, const Interval& b) {
  if (b.holds_zero()) return everything();
  return a * widen(1.0 / b.hi, 1.0 / b.lo);
}

Interval sin(const Interval& a) {
  if (!(a.hi - a.lo < 2.0 * pi) || !(std::abs(a.lo) < 1e15)) return {-1.0, 1.0};
  const double from = std::sin(a.lo);
  const double to = std::sin(a.hi);
  const Interval ends = widen(std::min(from, to), std::max(from, to));
  return {holds_phase(a, -0.5 * pi, 2.0 * pi) ? -1.0 : ends.lo, holds_phase(a, 0.5 * pi, 2.0 * pi) ? 1.0 : ends.hi};
}

Interval cos(const Interval& a) {
  if (!(a.hi - a.lo < 2.0 * pi) || !(std::abs(a.lo) < 1e15)) return {-1.0, 1.0};
  const double from = std::cos(a.lo);
  const double to = std::cos(a.hi);
  const Interval ends = widen(std::min(from, to), std::max(from, to));
  return {holds_phase(a, pi, 2.0 * pi) ? -1.0 : ends.lo, holds_phase(a, 0.0, 2.0 * pi) ? 1.0 : ends.hi};
}

Interval tan(const Interval& a) {
  if (!(a.hi - a.lo < pi) || !(std::abs(a.lo) < 1e15) || holds_phase(a, 0.5 * pi, pi)) return everything();
  return widen(std::tan(a.lo), std::tan(a.hi));
}

Interval asin(const Interval& a) {
  if (!(a.lo >= -1.0 && a.hi <= 1.0)) return everything();
  return widen(std::asin(a.lo), std::asin(a.hi));
}

Interval acos(const Interval& a) {
  if (!(a.lo >= -1.0 && a.hi <= 1.0)) return everything();
  return widen(std::acos(a.hi), std::acos(a.lo));
}

Interval atan(const Interval& a) { return widen(std::atan(a.lo), std::atan(a.hi)); }

Interval sinh(const Interval& a) { return widen(std::sinh(a.lo), std::sinh(a.hi)); }

Interval cosh(const Interval& a) {
  const double from = std::cosh(a.lo);
  const double to = std::cosh(a.hi);
  return widen(a.holds_zero() ? 1.0 : std::min(from, to), std::max(from, to));
}

Interval tanh(const Interval& a) { return widen(std::tanh(a.lo), std::tanh(a.hi)); }

Interval exp(const Interval& a) { return widen(std::exp(a.lo), std::exp(a.hi)); }

Interval log(const Interval& a) {
  if (!(a.lo > 0.0)) return everything();
  return widen(std::log(a.lo), std::log(a.hi));
}

Interval sqrt(const Interval& a) {
  if (!(a.lo >= 0.0)) return everything();
  return widen(std::sqrt(a.lo), std::sqrt(a.hi));
}

Interval pow(const Interval& a, double exponent) {
  const bool is_whole = exponent == std::trunc(exponent);
  if (exponent == 0.0) return {1.0, 1.0};
  if (!is_whole && !(a.lo >= 0.0)) return everything();
  if (exponent < 0.0 && a.holds_zero()) return everything();
  const double from = std::pow(a.lo, exponent);
  const double to = std::pow(a.hi, exponent);
  const bool has_bottom = a.lo < 0.0 && a.hi > 0.0 && std::fmod(exponent, 2.0) == 0.0;
  return widen(has_bottom ? 0.0 : std::min(from, to), std::max(from, to));
}

}  // namespace bough::laws
