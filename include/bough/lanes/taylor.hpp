#pragma once
/// Truncated Taylor series in time, x(t) = c[0] + c[1] t + ... + c[K] t^K. A kernel evaluated on them yields exact time
/// derivatives along a motion (rates of constraints, jerk) without difference quotients.
#include "bough/lanes/scalar.hpp"

namespace bough::lanes {

template <class S, int K>
struct Taylor {
  S c[K + 1];  ///< c[k] = (d^k x / dt^k) / k!
  Taylor() = default;
  Taylor(double x) {  // NOLINT(google-explicit-constructor): numbers must mix with series in kernels
    c[0] = S(x);
    for (int k = 1; k <= K; ++k) c[k] = S(0.0);
  }
};

template <class S, int K>
Taylor<S, K> operator+(const Taylor<S, K>& x, const Taylor<S, K>& y) {
  Taylor<S, K> r;
  for (int k = 0; k <= K; ++k) r.c[k] = x.c[k] + y.c[k];
  return r;
}
template <class S, int K>
Taylor<S, K> operator-(const Taylor<S, K>& x, const Taylor<S, K>& y) {
  Taylor<S, K> r;
  for (int k = 0; k <= K; ++k) r.c[k] = x.c[k] - y.c[k];
  return r;
}
template <class S, int K>
Taylor<S, K> operator-(const Taylor<S, K>& x) {
  Taylor<S, K> r;
  for (int k = 0; k <= K; ++k) r.c[k] = -x.c[k];
  return r;
}
template <class S, int K>
Taylor<S, K> operator*(const Taylor<S, K>& x, const Taylor<S, K>& y) {
  Taylor<S, K> r;
  for (int k = 0; k <= K; ++k) {
    S s = x.c[0] * y.c[k];
    for (int j = 1; j <= k; ++j) s = s + x.c[j] * y.c[k - j];
    r.c[k] = s;
  }
  return r;
}
template <class S, int K>
Taylor<S, K> operator/(const Taylor<S, K>& x, const Taylor<S, K>& y) {
  Taylor<S, K> r;
  for (int k = 0; k <= K; ++k) {
    S s = x.c[k];
    for (int j = 0; j < k; ++j) s = s - r.c[j] * y.c[k - j];
    r.c[k] = s / y.c[0];
  }
  return r;
}
template <class S, int K>
Taylor<S, K> operator*(double a, const Taylor<S, K>& x) {
  Taylor<S, K> r;
  for (int k = 0; k <= K; ++k) r.c[k] = a * x.c[k];
  return r;
}
template <class S, int K>
Taylor<S, K> operator*(const Taylor<S, K>& x, double a) {
  return a * x;
}
template <class S, int K>
Taylor<S, K> operator+(const Taylor<S, K>& x, double a) {
  Taylor<S, K> r = x;
  r.c[0] = r.c[0] + a;
  return r;
}
template <class S, int K>
Taylor<S, K> operator+(double a, const Taylor<S, K>& x) {
  return x + a;
}
template <class S, int K>
Taylor<S, K> operator-(const Taylor<S, K>& x, double a) {
  return x + (-a);
}
template <class S, int K>
Taylor<S, K> operator-(double a, const Taylor<S, K>& x) {
  return (-x) + a;
}
template <class S, int K>
Taylor<S, K> operator/(const Taylor<S, K>& x, double a) {
  return (1.0 / a) * x;
}
template <class S, int K>
Taylor<S, K> operator/(double a, const Taylor<S, K>& x) {
  return Taylor<S, K>(a) / x;
}
template <class S, int K>
Taylor<S, K> sqrt(const Taylor<S, K>& x) {
  using std::sqrt;
  Taylor<S, K> r;
  r.c[0] = sqrt(x.c[0]);
  for (int k = 1; k <= K; ++k) {
    S s = x.c[k];
    for (int j = 1; j < k; ++j) s = s - r.c[j] * r.c[k - j];
    r.c[k] = s / (2.0 * r.c[0]);
  }
  return r;
}
/// sin and cos together: k s_k = sum j x_j c_{k-j}, k c_k = -sum j x_j s_{k-j}.
template <class S, int K>
void sin_cos(const Taylor<S, K>& x, Taylor<S, K>& s, Taylor<S, K>& c) {
  using std::cos;
  using std::sin;
  s.c[0] = sin(x.c[0]);
  c.c[0] = cos(x.c[0]);
  for (int k = 1; k <= K; ++k) {
    S p(0.0), q(0.0);
    for (int j = 1; j <= k; ++j) {
      p = p + double(j) * x.c[j] * c.c[k - j];
      q = q - double(j) * x.c[j] * s.c[k - j];
    }
    s.c[k] = p / double(k);
    c.c[k] = q / double(k);
  }
}
template <class S, int K>
Taylor<S, K> sin(const Taylor<S, K>& x) {
  Taylor<S, K> s, c;
  sin_cos(x, s, c);
  return s;
}
template <class S, int K>
Taylor<S, K> cos(const Taylor<S, K>& x) {
  Taylor<S, K> s, c;
  sin_cos(x, s, c);
  return c;
}
/// atan2 from its rate: theta' = (x y' - y x') / (x^2 + y^2).
template <class S, int K>
Taylor<S, K> atan2(const Taylor<S, K>& y, const Taylor<S, K>& x) {
  using std::atan2;
  Taylor<S, K> dy(0.0), dx(0.0), r;
  for (int k = 0; k < K; ++k) {
    dy.c[k] = double(k + 1) * y.c[k + 1];
    dx.c[k] = double(k + 1) * x.c[k + 1];
  }
  const Taylor<S, K> rate = (x * dy - y * dx) / (x * x + y * y);
  r.c[0] = atan2(y.c[0], x.c[0]);
  for (int k = 1; k <= K; ++k) r.c[k] = rate.c[k - 1] / double(k);
  return r;
}
template <class S, int K>
auto decide(const Taylor<S, K>& x) {
  return decide(x.c[0]);
}
template <class S, int K>
auto less(const Taylor<S, K>& x, const Taylor<S, K>& y) {
  return less(x.c[0], y.c[0]);
}

}  // namespace bough::lanes
