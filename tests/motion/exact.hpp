#pragma once
/// Motions at 50 digits for tests: textbook closed forms, which share nothing with the library, and cases over all
/// angles.
#include <gtest/gtest.h>

#include <boost/multiprecision/cpp_bin_float.hpp>

#include "bough/motion/motion_tensor.hpp"
#include "samples.hpp"

namespace bough::motion::exact {

using Real = boost::multiprecision::number<boost::multiprecision::cpp_bin_float<50>, boost::multiprecision::et_off>;

inline Real pi() { return boost::math::constants::pi<Real>(); }

template <class T, int N>
Real norm(const lanes::Vec<T, N>& a) {
  Real s(0);
  for (int i = 0; i < N; ++i) s += Real(a[i]) * Real(a[i]);
  return sqrt(s);
}
template <int N>
lanes::Vec<double, N> rounded(const lanes::Vec<Real, N>& a) {
  return lanes::cast<double>(a);
}
template <int R, int C>
lanes::Mat<double, R, C> rounded(const lanes::Mat<Real, R, C>& a) {
  return lanes::cast<double>(a);
}
inline Frame<double> rounded(const Frame<Real>& a) { return {rounded(a.R), rounded(a.x)}; }

/// Largest difference from the exact value; NaN when there is one.
inline double error(double a, const Real& exact) { return std::abs(static_cast<double>(Real(a) - exact)); }
template <int N>
double error(const lanes::Vec<double, N>& a, const lanes::Vec<Real, N>& exact) {
  return test::largest(rounded(lanes::cast<Real>(a) - exact));
}
template <int R, int C>
double error(const lanes::Mat<double, R, C>& a, const lanes::Mat<Real, R, C>& exact) {
  return test::largest(rounded(lanes::cast<Real>(a) - exact));
}

/// exp(phi ~n) by Rodrigues, 1 - cos phi = 2 sin^2(phi/2).
inline Mat3<Real> rotation(const Vec3<Real>& n, const Real& phi) {
  const Mat3<Real> N = skew(n);
  const Real half = sin(phi / 2);
  return Mat3<Real>::identity() + Real(sin(phi)) * N + Real(2 * half * half) * (N * N);
}
inline Mat3<Real> rotation(const Vec3<Real>& psi) {
  const Real phi = norm(psi);
  if (phi == 0) return Mat3<Real>::identity();
  return rotation(Vec3<Real>(Real(1 / phi) * psi), phi);
}

/// [R, ~u R; 0, R] written out.
inline Mat6<Real> motion_tensor(const Mat3<Real>& R, const Vec3<Real>& u) {
  Mat6<Real> C = Mat6<Real>::zero();
  const Mat3<Real> uR = skew(u) * R;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      C(i, j) = C(i + 3, j + 3) = R(i, j);
      C(i, j + 3) = uR(i, j);
    }
  return C;
}

/// c_n(x) = sum_k (-x)^k/(2k + n)!, the Stumpff functions, summed until nothing changes.
inline Real stumpff(int n, const Real& x) {
  Real term(1);
  for (int j = 2; j <= n; ++j) term /= j;
  Real sum = term;
  for (int k = 1; k < 80; ++k) {
    term *= -x / ((2 * k + n) * (2 * k + n - 1));
    if (sum + term == sum) break;
    sum += term;
  }
  return sum;
}
/// exp of a motion vector d = (u; psi): R and x = (I + c_2 ~psi + c_3 ~psi~psi) u.
inline Frame<Real> exponential(const Vec6<Real>& d) {
  const Vec3<Real> u = linear_part(d), psi = angular_part(d), w = cross(psi, u);
  const Real x = dot(psi, psi);
  return {rotation(psi), u + stumpff(2, x) * w + stumpff(3, x) * cross(psi, w)};
}
/// d f/dx along `direction` by central differences of step h: error h^2, and 1e-49/h of round-off.
template <class F, class V>
auto slope(const F& f, const V& x, const V& direction, const Real& h = Real("1e-16")) {
  const V step = h * direction;
  return Real(1 / (2 * h)) * (f(V(x + step)) - f(V(x - step)));
}

/// Angles by decades from 1e-16 over pi - 1e-12 and pi + 1e-12 to beyond, 0 first.
inline std::vector<double> angles() {
  std::vector<double> a = test::angles_beyond_pi();
  for (int k = -12; k <= -1; ++k) a.push_back(std::numbers::pi + std::pow(10.0, k));
  return a;
}

/// One random motion: exact screw and pose, and the pose as a double sees it.
struct Case {
  Real phi;           ///< angle given, up to 6
  Vec3<Real> n;       ///< unit
  Vec3<Real> psi, u;  ///< rotation vector and displacement of the reference point
  Mat3<Real> R, G;    ///< rotation, half rotation
  Real d;             ///< n.u
  Vec3<Real> w;       ///< moment of the axis; zero where phi = 0
  Frame<double> H;    ///< (R, u) rounded
  IntrinsicMotion m;  ///< (d, phi, w, n) rounded
  double size;        ///< |u|
  double axis_size;   ///< |u|/(2 sin(phi/2)): scale of errors of the axis
  double screw_size;  ///< |d| + phi |w|: of displacements from the rounded (d, phi, w, n)
};
inline Case make_case(test::Random& random, double angle) {
  Case c;
  const Vec3<double> unit = random.unit();
  c.psi = lanes::cast<Real>(Vec3<double>(angle * unit));
  c.phi = norm(c.psi);
  const Vec3<Real> axis = angle > 0.0 ? c.psi : lanes::cast<Real>(unit);
  c.n = Real(1 / norm(axis)) * axis;
  c.u = lanes::cast<Real>(Vec3<double>(std::pow(10.0, 3.0 * random.number()) * random.vector<3>()));
  c.R = rotation(c.n, c.phi);
  c.G = rotation(c.n, Real(c.phi / 2));
  c.H = rounded(Frame<Real>{c.R, c.u});
  c.size = static_cast<double>(norm(c.u));
  if (angle == 0.0) {  // the direction of a translation is that of u
    c.d = norm(c.u);
    c.n = Real(1 / c.d) * c.u;
    c.w = Vec3<Real>::zero();
    c.m = {MotionKind::translation, static_cast<double>(c.d), 0.0, Vec3<double>::zero(), rounded(c.n)};
    c.axis_size = c.screw_size = c.size;
    return c;
  }
  const Real sine = sin(c.phi / 2);
  c.d = dot(c.n, c.u);
  c.w = Real(1 / (2 * sine)) * transpose_times(c.G, Vec3<Real>(c.u - c.d * c.n));
  c.m = {MotionKind::screw, static_cast<double>(c.d), static_cast<double>(c.phi), rounded(c.w), rounded(c.n)};
  c.axis_size = c.size / std::abs(static_cast<double>(2 * sine));
  c.screw_size = std::abs(c.m.d) + angle * static_cast<double>(norm(c.w));
  return c;
}

/// Calls check(case, random) for `repeats` random motions at each angle: over 1000 in all.
template <class Check>
void for_motions(unsigned seed, const Check& check, int repeats = 18) {
  test::Random random(seed);
  int count = 0;
  for (const double phi : angles())
    for (int repeat = 0; repeat < repeats; ++repeat) {
      check(make_case(random, phi), random);
      ++count;
      if (::testing::Test::HasFailure()) {
        ADD_FAILURE() << "at phi = " << phi << ", repeat " << repeat;
        return;
      }
    }
  EXPECT_GE(count, 1000);
}

}  // namespace bough::motion::exact
