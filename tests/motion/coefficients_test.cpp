// Each coefficient and its derivatives by x = phi^2 against the textbook closed form at 250 digits, where cancellation
// and the differencing of the derivatives do no harm: an oracle that shares nothing with the implementation.
#include "bough/motion/coefficients.hpp"

#include <gtest/gtest.h>

#include <boost/multiprecision/cpp_bin_float.hpp>

#include "samples.hpp"

namespace bough::motion {
namespace {

using Real = boost::multiprecision::number<boost::multiprecision::cpp_bin_float<250>, boost::multiprecision::et_off>;

struct Values {
  Real f, df, ddf;
};
// Value and central differences with a step of 1e-50: errors of 1e-100, and 250 digits less the 3 * 32 that cancel.
template <class F>
Values differences(const F& f, double at) {
  const Real x(at), h("1e-50");
  const Real low = f(x - h), mid = f(x), high = f(x + h);
  return {mid, (high - low) / (2 * h), (high - 2 * mid + low) / (h * h)};
}
Real closed_a(const Real& x) { return sin(sqrt(x)) / sqrt(x); }
Real closed_b(const Real& x) { return (1 - cos(sqrt(x))) / x; }
Real closed_c(const Real& x) { return (sqrt(x) - sin(sqrt(x))) / (x * sqrt(x)); }
Real closed_k(const Real& x) { return (1 - sqrt(x) / 2 / tan(sqrt(x) / 2)) / x; }

double ulps(double value, const Real& exact, double scale) {
  return static_cast<double>(abs(Real(value) - exact)) / (test::epsilon * std::abs(scale));
}

// Angles without 0, where the closed forms have no value; 0 has its own test.
std::vector<double> angles() {
  std::vector<double> a = test::angles_beyond_pi();
  a.erase(a.begin());
  for (const double phi : {1.1, 2.2, 3.3, 3.7, 3.9, 4.2}) a.push_back(phi);
  return a;
}

// Errors in units of epsilon times the largest value of that coefficient, which is the value at phi = 0.
TEST(Coefficients, values_are_within_4_ulps_of_their_maximum_at_all_angles) {
  for (const double phi : angles()) {
    const double x = phi * phi;
    const AngleCoefficients<double> r = eval_angle_coefficients(x);
    EXPECT_LT(ulps(r.a, differences(closed_a, x).f, 1.0), 4.0) << "a at phi = " << phi;
    EXPECT_LT(ulps(r.b, differences(closed_b, x).f, 1.0 / 2.0), 4.0) << "b at phi = " << phi;
    EXPECT_LT(ulps(r.c, differences(closed_c, x).f, 1.0 / 6.0), 4.0) << "c at phi = " << phi;
  }
}

TEST(Coefficients, first_derivatives_are_within_4_ulps_of_their_maximum_at_all_angles) {
  for (const double phi : angles()) {
    const double x = phi * phi;
    const AngleCoefficients<double> r = eval_angle_coefficients(x);
    EXPECT_LT(ulps(r.da, differences(closed_a, x).df, 1.0 / 6.0), 4.0) << "a' at phi = " << phi;
    EXPECT_LT(ulps(r.db, differences(closed_b, x).df, 1.0 / 24.0), 4.0) << "b' at phi = " << phi;
    EXPECT_LT(ulps(r.dc, differences(closed_c, x).df, 1.0 / 120.0), 4.0) << "c' at phi = " << phi;
  }
}

TEST(Coefficients, second_derivatives_are_within_8_ulps_of_their_maximum_at_all_angles) {
  for (const double phi : angles()) {
    const double x = phi * phi;
    const AngleCoefficients<double> r = eval_angle_coefficients(x);
    EXPECT_LT(ulps(r.dda, differences(closed_a, x).ddf, 1.0 / 60.0), 8.0) << "a'' at phi = " << phi;
    EXPECT_LT(ulps(r.ddb, differences(closed_b, x).ddf, 1.0 / 360.0), 8.0) << "b'' at phi = " << phi;
    EXPECT_LT(ulps(r.ddc, differences(closed_c, x).ddf, 1.0 / 2520.0), 8.0) << "c'' at phi = " << phi;
  }
}

// Relative errors. Up to phi = 4 nothing cancels; beyond, the distance to the pole at 2 pi divides the rounding of the
// angle: 4 ulps / (1 - phi/(2 pi)) and as much again for each derivative.
TEST(Coefficients, the_inverse_coefficient_is_within_4_ulps_up_to_4_rad_and_follows_its_pole_beyond) {
  for (const double phi : angles()) {
    const double x = phi * phi, room = phi < 4.0 ? 1.0 : 4.0 / (1.0 - phi / (2.0 * std::numbers::pi));
    const InverseCoefficients<double> r = eval_inverse_coefficients(x);
    const Values exact = differences(closed_k, x);
    EXPECT_LT(ulps(r.k, exact.f, r.k), 4.0 * room) << "k at phi = " << phi;
    EXPECT_LT(ulps(r.dk, exact.df, r.dk), 4.0 * room) << "k' at phi = " << phi;
    EXPECT_LT(ulps(r.ddk, exact.ddf, r.ddk), 4.0 * room) << "k'' at phi = " << phi;
  }
}

TEST(Coefficients, the_limits_at_zero_are_exact_to_one_rounding) {
  const AngleCoefficients<double> r = eval_angle_coefficients(0.0);
  const InverseCoefficients<double> s = eval_inverse_coefficients(0.0);
  const double values[] = {r.a, r.b, r.c, r.da, r.db, r.dc, r.dda, r.ddb, r.ddc, s.k, s.dk, s.ddk};
  const double limits[] = {1.0,        1.0 / 2.0,   1.0 / 6.0,    -1.0 / 6.0, -1.0 / 24.0, -1.0 / 120.0,
                           1.0 / 60.0, 1.0 / 360.0, 1.0 / 2520.0, 1.0 / 12.0, 1.0 / 720.0, 1.0 / 15120.0};
  for (int i = 0; i < 12; ++i) EXPECT_NEAR(values[i], limits[i], 4.0 * test::epsilon * std::abs(limits[i])) << i;
}

// c_0 .. c_7 against their defining series, at 250 digits: no cancellation is left at any angle. c_0 ends the
// recurrence 1 - x c_2 and takes up its rounding, twice that of the others.
TEST(Coefficients, stumpff_functions_match_their_series_within_4_ulps_of_their_maximum) {
  for (const double phi : angles()) {
    const double x = phi * phi;
    const lanes::Vec<double, 8> c = eval_stumpff(x);
    Real factorial(1);
    for (int n = 0; n < 8; ++n) {
      if (n > 1) factorial *= n;
      Real term = 1 / factorial, sum = term;
      for (int k = 1; k < 60; ++k) sum += term *= -Real(x) / ((2 * k + n) * (2 * k + n - 1));
      EXPECT_LT(ulps(c[n], sum, static_cast<double>(1 / factorial)), n == 0 ? 8.0 : 4.0)
          << "c_" << n << " at phi = " << phi;
    }
  }
}

// The tables hold long double digits: the check of the table against a mistyped digit that double would hide.
TEST(Coefficients, long_double_values_keep_long_double_digits) {
  for (const double phi : {1e-3, 0.3, 0.499, 0.5, 1.0, 2.0, 3.0, 3.9}) {
    const long double x = static_cast<long double>(phi) * phi;
    const InverseCoefficients<long double> s = eval_inverse_coefficients(x);
    const AngleCoefficients<long double> r = eval_angle_coefficients(x);
    const long double bound = 8.0L * std::numeric_limits<long double>::epsilon();
    EXPECT_LT(abs(Real(s.k) - closed_k(Real(x))), bound * s.k) << phi;
    EXPECT_LT(abs(Real(r.a) - closed_a(Real(x))), bound) << phi;
    EXPECT_LT(abs(Real(r.c) - closed_c(Real(x))), bound / 6) << phi;
  }
}

}  // namespace
}  // namespace bough::motion
