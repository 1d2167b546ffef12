#pragma once

namespace bough::laws {

/// All numbers from lo to hi. Results of operations hold the true range, widened by a few units in the last place;
/// an end that is exactly 0 stays 0. Outside the domain of a function (log of 0, division by an interval around 0):
/// everything.
struct Interval {
  double lo = 0.0;
  double hi = 0.0;

  Interval() = default;
  Interval(double x) : lo(x), hi(x) {}  // NOLINT: a number is an interval
  Interval(double low, double high) : lo(low), hi(high) {}

  bool holds_zero() const { return lo <= 0.0 && hi >= 0.0; }
};

Interval everything();
Interval hull(const Interval& a, const Interval& b);

Interval operator-(const Interval& a);
Interval operator+(const Interval& a, const Interval& b);
Interval operator-(const Interval& a, const Interval& b);
Interval operator*(const Interval& a, const Interval& b);
Interval operator/(const Interval& a, const Interval& b);

Interval sin(const Interval& a);
Interval cos(const Interval& a);
Interval tan(const Interval& a);
Interval asin(const Interval& a);
Interval acos(const Interval& a);
Interval atan(const Interval& a);
Interval sinh(const Interval& a);
Interval cosh(const Interval& a);
Interval tanh(const Interval& a);
Interval exp(const Interval& a);
Interval log(const Interval& a);
Interval sqrt(const Interval& a);
Interval pow(const Interval& a, double exponent);

}  // namespace bough::laws
