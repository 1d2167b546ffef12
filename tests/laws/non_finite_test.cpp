#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "bough/laws/make_law.hpp"

namespace bough::laws {
namespace {

TEST(NonFinite, finite_values_are_not_reported) { EXPECT_FALSE(non_finite({1.0, -2.0, 1e308}).has_value()); }

TEST(NonFinite, report_names_each_member_and_its_kind) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(non_finite({nan, 0.0, 0.0}), "value is not a number");
  EXPECT_EQ(non_finite({0.0, HUGE_VAL, 0.0}), "rate is infinite");
  EXPECT_EQ(non_finite({0.0, -HUGE_VAL, nan}), "rate is infinite, acceleration is not a number");
}

TEST(NonFinite, poles_and_roots_outside_their_domain_are_returned_as_they_are) {
  EXPECT_TRUE(non_finite(make_expression("1/t").at(0.0)));
  EXPECT_TRUE(non_finite(make_expression("sqrt(t)").at(-1.0)));
  EXPECT_TRUE(non_finite(make_expression("log(t)").at(0.0)));
  EXPECT_TRUE(non_finite(make_expression("abs(sqrt(t))").at(-1.0)));
  EXPECT_TRUE(non_finite(make_expression("step(sqrt(t))").at(-1.0)));
  EXPECT_TRUE(non_finite(make_expression("max(0, log(t))").at(-1.0)));
  EXPECT_TRUE(non_finite(make_expression("exp(t)").at(1000.0)));
  EXPECT_TRUE(non_finite(make_expression("1/0").at(0.0)));
  EXPECT_EQ(non_finite(make_expression("sqrt(t)").at(0.0)).value().substr(0, 4), "rate");
}

TEST(NonFinite, time_that_is_no_number_gives_no_number) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(non_finite(make_harmonic(1.0, 1.0).at(nan)));
  EXPECT_TRUE(non_finite(make_expression("t + step(t)").at(nan, Side::left)));
  EXPECT_TRUE(non_finite(make_expression("t*t").integral(0.0).at(nan)));
}

TEST(NonFinite, integral_over_a_pole_is_no_number) {
  for (const char* text : {"1/t", "1/t^2", "1/(t - 0.1)"}) {
    const Law integral = make_expression(text).integral(-1.0);
    EXPECT_FALSE(non_finite(integral.at(-0.5))) << text;
    EXPECT_TRUE(non_finite(integral.at(1.0))) << text;
  }
}

TEST(NonFinite, change_of_branch_at_a_pole_is_found) {
  EXPECT_EQ(make_expression("step(1/t)").breakpoints(-1.0, 1.0), std::vector<double>{0.0});
}

/// Each panel of the way has more corners than quadrature is given; the first tells for all.
TEST(NonFinite, the_integral_of_a_law_that_moves_too_fast_is_given_up) {
  EXPECT_TRUE(std::isnan(make_expression("abs(sin(1e7*t))").integral(0.0).at(1000.0).value));
  EXPECT_TRUE(std::isnan(make_expression("sin(1e9*t*t)").integral(0.0).at(1e6).value));
  EXPECT_NEAR(make_expression("abs(sin(1e3*t))").integral(0.0).at(1.0).value, 2.0 / 3.14159265358979, 1e-3);
}

}  // namespace
}  // namespace bough::laws
