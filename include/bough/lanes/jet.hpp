#pragma once
/// Forward differentiation: a jet is a value with its derivatives along N directions, which a kernel carries along in
/// one pass. The exact tangent is computed by the source of the residual, so the two cannot contradict each other.
#include "bough/lanes/scalar.hpp"

namespace bough::lanes {

template <class S, int N>
struct Jet {
  S a;     ///< value
  S d[N];  ///< derivatives
  Jet() = default;
  Jet(double x) : a(x) {  // NOLINT(google-explicit-constructor): numbers must mix with jets in kernels
    for (int i = 0; i < N; ++i) d[i] = S(0.0);
  }
  template <class T>
  requires(std::same_as<T, S> && !std::same_as<T, double>) explicit Jet(const T& x) : a(x) {
    for (int i = 0; i < N; ++i) d[i] = S(0.0);
  }
  static Jet variable(const S& value, int direction) {
    Jet r(0.0);
    r.a = value;
    r.d[direction] = S(1.0);
    return r;
  }
};

/// f(x) with f'(x) = slope, by the chain rule.
template <class S, int N>
Jet<S, N> chain(const Jet<S, N>& x, const S& value, const S& slope) {
  Jet<S, N> r;
  r.a = value;
  for (int i = 0; i < N; ++i) r.d[i] = slope * x.d[i];
  return r;
}

template <class S, int N>
Jet<S, N> operator+(const Jet<S, N>& x, const Jet<S, N>& y) {
  Jet<S, N> r;
  r.a = x.a + y.a;
  for (int i = 0; i < N; ++i) r.d[i] = x.d[i] + y.d[i];
  return r;
}
template <class S, int N>
Jet<S, N> operator-(const Jet<S, N>& x, const Jet<S, N>& y) {
  Jet<S, N> r;
  r.a = x.a - y.a;
  for (int i = 0; i < N; ++i) r.d[i] = x.d[i] - y.d[i];
  return r;
}
template <class S, int N>
Jet<S, N> operator-(const Jet<S, N>& x) {
  Jet<S, N> r;
  r.a = -x.a;
  for (int i = 0; i < N; ++i) r.d[i] = -x.d[i];
  return r;
}
template <class S, int N>
Jet<S, N> operator*(const Jet<S, N>& x, const Jet<S, N>& y) {
  Jet<S, N> r;
  r.a = x.a * y.a;
  for (int i = 0; i < N; ++i) r.d[i] = x.d[i] * y.a + x.a * y.d[i];
  return r;
}
template <class S, int N>
Jet<S, N> operator/(const Jet<S, N>& x, const Jet<S, N>& y) {
  Jet<S, N> r;
  const S inv = S(1.0) / y.a;
  r.a = x.a / y.a;  // the value is rounded as a quotient of doubles is
  for (int i = 0; i < N; ++i) r.d[i] = (x.d[i] - r.a * y.d[i]) * inv;
  return r;
}
template <class S, int N>
Jet<S, N> operator*(double k, const Jet<S, N>& x) {
  Jet<S, N> r;
  r.a = k * x.a;
  for (int i = 0; i < N; ++i) r.d[i] = k * x.d[i];
  return r;
}
template <class S, int N>
Jet<S, N> operator*(const Jet<S, N>& x, double k) {
  return k * x;
}
template <class S, int N>
Jet<S, N> operator+(const Jet<S, N>& x, double k) {
  Jet<S, N> r = x;
  r.a = r.a + k;
  return r;
}
template <class S, int N>
Jet<S, N> operator+(double k, const Jet<S, N>& x) {
  return x + k;
}
template <class S, int N>
Jet<S, N> operator-(const Jet<S, N>& x, double k) {
  return x + (-k);
}
template <class S, int N>
Jet<S, N> operator-(double k, const Jet<S, N>& x) {
  return (-x) + k;
}
template <class S, int N>
Jet<S, N> operator/(const Jet<S, N>& x, double k) {
  Jet<S, N> r = (1.0 / k) * x;
  r.a = x.a / k;
  return r;
}
template <class S, int N>
Jet<S, N> operator/(double k, const Jet<S, N>& x) {
  const S value = S(k) / x.a;
  return chain(x, value, S(-value / x.a));
}
/// Mixed arithmetic with a plain scalar S that is not a double: a constant of the kernel, without derivatives.
template <class S, int N>
requires(!std::same_as<S, double>) Jet<S, N>
operator*(const S& k, const Jet<S, N>& x) {
  Jet<S, N> r;
  r.a = k * x.a;
  for (int i = 0; i < N; ++i) r.d[i] = k * x.d[i];
  return r;
}
template <class S, int N>
requires(!std::same_as<S, double>) Jet<S, N>
operator*(const Jet<S, N>& x, const S& k) { return k * x; }
template <class S, int N>
requires(!std::same_as<S, double>) Jet<S, N>
operator+(const Jet<S, N>& x, const S& k) {
  Jet<S, N> r = x;
  r.a = r.a + k;
  return r;
}
template <class S, int N>
requires(!std::same_as<S, double>) Jet<S, N>
operator-(const Jet<S, N>& x, const S& k) {
  Jet<S, N> r = x;
  r.a = r.a - k;
  return r;
}
template <class S, int N>
Jet<S, N> sqrt(const Jet<S, N>& x) {
  using std::sqrt;
  const S value = sqrt(x.a);
  return chain(x, value, S(S(0.5) / value));
}
template <class S, int N>
Jet<S, N> sin(const Jet<S, N>& x) {
  using std::cos;
  using std::sin;
  return chain(x, S(sin(x.a)), S(cos(x.a)));
}
template <class S, int N>
Jet<S, N> cos(const Jet<S, N>& x) {
  using std::cos;
  using std::sin;
  return chain(x, S(cos(x.a)), S(-sin(x.a)));
}
template <class S, int N>
Jet<S, N> atan2(const Jet<S, N>& y, const Jet<S, N>& x) {
  using std::atan2;
  const S inv = S(1.0) / (x.a * x.a + y.a * y.a);
  Jet<S, N> r;
  r.a = atan2(y.a, x.a);
  for (int i = 0; i < N; ++i) r.d[i] = (x.a * y.d[i] - y.a * x.d[i]) * inv;
  return r;
}
template <class S, int N>
auto decide(const Jet<S, N>& x) {
  return decide(x.a);
}
template <class S, int N>
auto less(const Jet<S, N>& x, const Jet<S, N>& y) {
  return less(x.a, y.a);
}

}  // namespace bough::lanes
