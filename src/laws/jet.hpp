#pragma once

#include <cmath>

#include "interval.hpp"

namespace bough::laws {

/// Value, rate and acceleration of a quantity in time: Taylor arithmetic of second order on the scalar S (double, or
/// Interval for the ranges of all three over a span of time).
template <class S>
struct Jet {
  S value;
  S rate;
  S acceleration;
};

/// (f(x))' = f' x',  (f(x))'' = f'' x'^2 + f' x''.
template <class S>
Jet<S> chain(const Jet<S>& x, const S& f, const S& df, const S& d2f) {
  return {f, df * x.rate, d2f * (x.rate * x.rate) + df * x.acceleration};
}

template <class S>
Jet<S> operator-(const Jet<S>& a) {
  return {-a.value, -a.rate, -a.acceleration};
}

template <class S>
Jet<S> operator+(const Jet<S>& a, const Jet<S>& b) {
  return {a.value + b.value, a.rate + b.rate, a.acceleration + b.acceleration};
}

template <class S>
Jet<S> operator-(const Jet<S>& a, const Jet<S>& b) {
  return {a.value - b.value, a.rate - b.rate, a.acceleration - b.acceleration};
}

template <class S>
Jet<S> operator*(const Jet<S>& a, const Jet<S>& b) {
  return {a.value * b.value, a.rate * b.value + a.value * b.rate,
          a.acceleration * b.value + S(2.0) * (a.rate * b.rate) + a.value * b.acceleration};
}

/// q = a / b from  a = q b:  q' = (a' - q b') / b,  q'' = (a'' - 2 q' b' - q b'') / b.
template <class S>
Jet<S> operator/(const Jet<S>& a, const Jet<S>& b) {
  const S q = a.value / b.value;
  const S dq = (a.rate - q * b.rate) / b.value;
  return {q, dq, (a.acceleration - S(2.0) * (dq * b.rate) - q * b.acceleration) / b.value};
}

/// x^p for a number p. The derivatives of x^0, x^1 and x^2 that vanish do so at x = 0 too.
template <class S>
Jet<S> pow_number(const Jet<S>& x, double p) {
  using std::pow;
  const S df = p == 0.0 ? S(0.0) : S(p) * pow(x.value, p - 1.0);
  const S d2f = p == 0.0 || p == 1.0 ? S(0.0) : S(p * (p - 1.0)) * pow(x.value, p - 2.0);
  return chain(x, S(pow(x.value, p)), df, d2f);
}

inline double pow_value(double x, double y) { return std::pow(x, y); }
inline Interval pow_value(const Interval& x, const Interval& y) { return exp(y * log(x)); }

/// x^y = exp(L),  L = y log x; x > 0.
template <class S>
Jet<S> pow_general(const Jet<S>& x, const Jet<S>& y) {
  using std::log;
  const S inverse = S(1.0) / x.value;
  const Jet<S> exponent = y * chain(x, S(log(x.value)), inverse, -(inverse * inverse));
  const S f = pow_value(x.value, y.value);
  return chain(exponent, f, f, f);
}

}  // namespace bough::laws
