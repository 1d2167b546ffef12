#pragma once
/// Samples shared by the tests of motions: angles by decades up to pi and beyond, and random axes with fixed seeds.
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

#include "bough/motion/se3.hpp"

namespace bough::motion::test {

inline constexpr double epsilon = std::numeric_limits<double>::epsilon();

/// 0, 1e-16 .. 0.1 by decades, 0.2 .. 3, pi - 1e-2 .. pi - 1e-12 by decades.
inline std::vector<double> angles_up_to_pi() {
  std::vector<double> a{0.0};
  for (int k = -16; k <= -1; ++k) a.push_back(std::pow(10.0, k));
  // Both sides of the ends of short series: 1/2, and the angles whose tangent or that of whose half is 1/4.
  for (const double end : {0.5, std::atan(0.25), 2.0 * std::atan(0.25)})
    for (const double phi : {0.9 * end, std::nextafter(end, 0.0), end, std::nextafter(end, 1.0), 1.1 * end})
      a.push_back(phi);
  for (const double phi : {0.2, 0.3, 0.39, 0.4, 0.41, 0.7, 1.0, 1.5, 2.0, 2.5, 3.0}) a.push_back(phi);
  for (int k = -2; k >= -12; --k) a.push_back(std::numbers::pi - std::pow(10.0, k));
  return a;
}
/// Those, pi and beyond: both sides of the switch of the coefficients at phi = 4.
inline std::vector<double> angles_beyond_pi() {
  std::vector<double> a = angles_up_to_pi();
  for (const double phi : {std::numbers::pi, 3.5, 3.999999, 4.0, 4.000001, 4.5, 5.0, 5.5, 6.0}) a.push_back(phi);
  return a;
}

class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  double number() { return std::uniform_real_distribution<double>(-1.0, 1.0)(engine_); }
  template <int N>
  lanes::Vec<double, N> vector() {
    lanes::Vec<double, N> v;
    for (int i = 0; i < N; ++i) v[i] = number();
    return v;
  }
  Vec3<double> unit() {
    for (;;) {
      const Vec3<double> v = vector<3>();
      const double norm = std::sqrt(dot(v, v));
      if (norm > 0.1 && norm < 1.0) return (1.0 / norm) * v;
    }
  }
  /// A motion vector of rotation angle phi and displacements of order 1 m.
  Vec6<double> motion(double phi) {
    const Vec3<double> u = vector<3>();  // first, so that samples do not depend on the compiler's order of arguments
    return lanes::join(u, phi * unit());
  }
  Frame<double> frame(double length = 1.0) {
    const double angle = 3.0 * number();
    const Mat3<double> R = exp_so3(angle * unit());
    return {R, length * vector<3>()};
  }

 private:
  std::mt19937 engine_;
};

/// Largest magnitude; NaN when there is one, so that no comparison with a bound passes.
template <class A>
double largest(const A& a) {
  double r = 0.0;
  for (const double x : a) {
    if (std::isnan(x)) return x;
    r = std::fmax(r, std::abs(x));
  }
  return r;
}
template <int N>
double largest(const lanes::Vec<double, N>& a) {
  return largest(a.v);
}
template <int R, int C>
double largest(const lanes::Mat<double, R, C>& a) {
  return largest(a.m);
}

/// d f(x) / dx by the complex step: exact to round-off, no differencing. f maps Vec<complex, N> to Vec<complex, M>.
template <int M, int N, class F>
lanes::Mat<double, M, N> complex_step(const F& f, const lanes::Vec<double, N>& x) {
  using C = std::complex<double>;
  const double h = 1e-60;
  lanes::Mat<double, M, N> r;
  for (int j = 0; j < N; ++j) {
    auto z = lanes::cast<C>(x);
    z[j] += C(0.0, h);
    const lanes::Vec<C, M> y = f(z);
    for (int i = 0; i < M; ++i) r(i, j) = y[i].imag() / h;
  }
  return r;
}

}  // namespace bough::motion::test
