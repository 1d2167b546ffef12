#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "bough/laws/formula.hpp"
#include "bough/laws/law_error.hpp"
#include "bough/laws/make_law.hpp"
#include "bough/laws/surface.hpp"
#include "check_law.hpp"

namespace bough::laws {
namespace {

using Times = std::vector<double>;
using std::numbers::pi;

TEST(Monotone, values_at_knots_and_lines_and_constants_are_reproduced) {
  const std::vector<double> times{-1.0, 0.0, 0.3, 2.0, 2.5, 6.0};
  std::vector<double> line, other{3.0, -1.0, -1.0, 4.0, 4.5, 20.0};
  for (const double t : times) line.push_back(2.0 - 0.7 * t);
  const Law straight = make_table(times, line, Interpolation::monotone);
  for (double t = -0.99; t < 6.0; t += 0.173) expect_equal(straight.at(t), {2.0 - 0.7 * t, -0.7, 0.0}, 1e-13);
  const Law flat = make_table(times, std::vector<double>(6, 2.5), Interpolation::monotone);
  for (double t = -2.0; t < 7.0; t += 0.31) expect_equal(flat.at(t), {2.5, 0.0, 0.0}, 0.0);
  const Law law = make_table(times, other, Interpolation::monotone);
  for (std::size_t i = 0; i < times.size(); ++i) EXPECT_NEAR(law.at(times[i]).value, other[i], 1e-14);
  EXPECT_EQ(law.at(-5.0).value, 3.0);
  EXPECT_EQ(law.at(9.0).value, 20.0);
  expect_equal(make_table({0.0, 4.0}, {1.0, 3.0}, Interpolation::monotone).at(1.0), {1.5, 0.5, 0.0}, 1e-15);
}

// Random data with steep rises, plateaus and turns: between two knots the law does not leave their values, and its rate
// has one sign.
TEST(Monotone, no_interval_overshoots) {
  unsigned seed = 7;
  const auto number = [&seed] {
    seed = seed * 1664525u + 1013904223u;
    return static_cast<double>(seed >> 8) / 16777216.0;
  };
  for (int sample = 0; sample < 200; ++sample) {
    std::vector<double> times{0.0}, values{0.0};
    for (int i = 0; i < 8; ++i) {
      times.push_back(times.back() + std::pow(10.0, -2.0 + 2.0 * number()));
      const double rise = std::pow(10.0, -3.0 + 5.0 * number());
      values.push_back(values.back() + (number() < 0.2 ? 0.0 : number() < 0.3 ? -rise : rise));
    }
    const Law law = make_table(times, values, Interpolation::monotone);
    for (std::size_t i = 0; i + 1 < times.size(); ++i) {
      const double rise = values[i + 1] - values[i], width = times[i + 1] - times[i];
      for (int k = 0; k < 50; ++k) {
        const LawValue f = law.at(times[i] + width * k / 50.0);
        EXPECT_GE(f.rate * (rise > 0.0 ? 1.0 : -1.0), -1e-9 * std::abs(rise) / width) << "sample " << sample;
        if (rise == 0.0) {
          EXPECT_EQ(f.rate, 0.0);
        }
      }
    }
  }
}

TEST(Monotone, has_the_derivatives_of_its_value_and_jumps_in_the_second_alone) {
  const std::vector<double> times{0.0, 1.0, 1.5, 3.0}, values{0.0, 0.2, 2.0, 2.1};
  const Law law = make_table(times, values, Interpolation::monotone);
  for (const double t : {0.3, 0.8, 1.2, 1.44, 2.0, 2.9}) expect_derivatives_match(law, t, 1e-3, 10.0);
  for (const double t : {1.0, 1.5})
    EXPECT_NEAR(law.at(t, Side::left).rate, law.at(t, Side::right).rate, 1e-13) << "the rate is continuous";
  EXPECT_EQ(law.breakpoints(-1.0, 4.0), times);
  const Law sum = law.integral(0.0);
  expect_derivatives_match(sum, 1.7, 1e-3, 10.0);
  EXPECT_EQ(sum.at(2.0).rate, law.at(2.0).value);
}

TEST(Surface, reproduces_its_points_and_bilinear_functions) {
  const std::vector<double> xs{-1.0, 0.5, 4.0}, ys{0.0, 1.0, 1.5, 9.0};
  const auto f = [](double x, double y) { return 2.0 - 3.0 * x + 0.5 * y - 0.2 * x * y; };
  std::vector<double> values;
  for (const double x : xs)
    for (const double y : ys) values.push_back(f(x, y));
  const Surface surface(xs, ys, values);
  for (double x = -0.95; x < 4.0; x += 0.31)
    for (double y = 0.05; y < 9.0; y += 0.77) {
      double slopes[2];
      EXPECT_NEAR(surface(x, y, slopes), f(x, y), 1e-14 * 30.0);
      EXPECT_EQ(surface(x, y), surface(x, y, slopes));
      EXPECT_NEAR(slopes[0], -3.0 - 0.2 * y, 1e-12);
      EXPECT_NEAR(slopes[1], 0.5 - 0.2 * x, 1e-12);
    }
  for (std::size_t i = 0; i < xs.size(); ++i)
    for (std::size_t j = 0; j < ys.size(); ++j)
      EXPECT_NEAR(surface(xs[i], ys[j]), values[i * ys.size() + j], 1e-14 * 30.0);
}

TEST(Surface, outside_it_is_the_nearest_point_and_on_lines_the_side_of_growth_counts) {
  const Surface surface({0.0, 1.0, 3.0}, {0.0, 2.0}, {0.0, 4.0, 1.0, 7.0, 9.0, 9.0});
  double slopes[2];
  EXPECT_EQ(surface(-3.0, 1.0, slopes), 2.0);
  EXPECT_EQ(slopes[0], 0.0);
  EXPECT_EQ(slopes[1], 2.0);
  EXPECT_EQ(surface(7.0, 8.0, slopes), 9.0);
  EXPECT_EQ(slopes[0], 0.0);
  EXPECT_EQ(slopes[1], 0.0);
  EXPECT_EQ(surface(1.0, 0.0, slopes), 1.0);
  EXPECT_EQ(slopes[0], 4.0);
  EXPECT_EQ(Surface()(1.0, 2.0), 0.0);
  EXPECT_EQ(Surface({1.0}, {2.0}, {5.0})(0.0, 0.0), 5.0);
  EXPECT_THROW(Surface({1.0, 1.0}, {2.0}, {5.0, 5.0}), LawError);
  EXPECT_THROW(Surface({1.0, 2.0}, {2.0}, {5.0}), LawError);
}

/// The motion x(t) = 0.4 + 0.3 t + 0.6 t^2 and another one of y.
LawValue x_at(double t) { return {0.4 + t * (0.3 + 0.6 * t), 0.3 + 1.2 * t, 1.2}; }
LawValue y_at(double t) { return {1.2 - 0.5 * t + 0.25 * t * t, -0.5 + 0.5 * t, 0.5}; }

TEST(Motions, of_tables_and_formulas_have_the_derivatives_of_their_values) {
  const Surface surface({0.0, 0.3, 1.0}, {0.0, 1.0, 2.0}, {0.0, 4.0, 1.0, 7.0, 9.0, 3.0, 2.0, 5.0, 8.0});
  const std::vector<std::string> names{"x", "y"};
  const Formula formula("x^3*sin(y) - max(x, y)/(1 + x)", names);
  const double h = 1e-3;
  const auto check = [&](auto&& f) {
    const LawValue now = f(0.1);
    EXPECT_NEAR(now.rate, (f(0.1 + h).value - f(0.1 - h).value) / (2.0 * h), 2e-5);
    EXPECT_NEAR(now.acceleration, (f(0.1 + h).rate - f(0.1 - h).rate) / (2.0 * h), 2e-5);
  };
  check([&](double t) { return surface.along(x_at(t), y_at(t)); });
  check([&](double t) { return formula.along(std::vector<LawValue>{x_at(t), y_at(t)}); });
}

TEST(BasicLaws, default_law_is_zero_and_constant) {
  const Law law;
  EXPECT_TRUE(law.is_constant());
  expect_equal(law.at(3.0), {0.0, 0.0, 0.0}, 0.0);
  expect_equal(law.integral(1.0).at(3.0), {0.0, 0.0, 0.0}, 0.0);
  EXPECT_TRUE(law.breakpoints(-1.0, 1.0).empty());
}

TEST(BasicLaws, constant_has_no_rate) {
  const Law law = make_constant(2.5);
  EXPECT_TRUE(law.is_constant());
  expect_equal(law.at(-7.0), {2.5, 0.0, 0.0}, 0.0);
}

TEST(BasicLaws, ramp_takes_one_sided_rates_at_its_corners) {
  const Law law = make_ramp(1.0, 3.0, 5.0, 9.0);
  EXPECT_FALSE(law.is_constant());
  expect_equal(law.at(2.0), {7.0, 2.0, 0.0}, 0.0);
  expect_equal(law.at(1.0, Side::left), {5.0, 0.0, 0.0}, 0.0);
  expect_equal(law.at(1.0, Side::right), {5.0, 2.0, 0.0}, 0.0);
  expect_equal(law.at(3.0, Side::left), {9.0, 2.0, 0.0}, 0.0);
  expect_equal(law.at(3.0), {9.0, 0.0, 0.0}, 0.0);
}

TEST(BasicLaws, ramp_breaks_at_its_corners_including_the_ends_of_the_window) {
  const Law law = make_ramp(1.0, 3.0, 5.0, 9.0);
  EXPECT_EQ(law.breakpoints(0.0, 4.0), (Times{1.0, 3.0}));
  EXPECT_EQ(law.breakpoints(1.0, 3.0), (Times{1.0, 3.0}));
  EXPECT_EQ(law.breakpoints(1.5, 2.9), Times{});
}

TEST(BasicLaws, ramp_between_equal_values_is_constant) {
  EXPECT_TRUE(make_ramp(0.0, 1.0, 4.0, 4.0).is_constant());
  EXPECT_TRUE(make_smooth_ramp(0.0, 1.0, 4.0, 4.0).is_constant());
  EXPECT_TRUE(make_cycloidal(0.0, 1.0, 4.0, 4.0).is_constant());
}

struct Profile {
  const char* name;
  Law (*make)(double, double, double, double);
};
void PrintTo(const Profile& profile, std::ostream* out) { *out << profile.name; }

class SmoothRise : public ::testing::TestWithParam<Profile> {};

TEST_P(SmoothRise, has_no_jump_up_to_the_second_derivative) {
  // A rise of 4 within 2 s far from t = 0. Round-off: 4 * 60 / 2^2 units of the second derivative, a few eps of it.
  const Law law = GetParam().make(1000.0, 1002.0, -1.0, 3.0);
  for (double t : {1000.0, 1002.0}) expect_equal(law.at(t, Side::left), law.at(t, Side::right), 1e-13);
  EXPECT_TRUE(law.breakpoints(0.0, 2000.0).empty());
}

TEST_P(SmoothRise, is_monotone_point_symmetric_and_held_outside) {
  const Law law = GetParam().make(2.0, 4.0, -1.0, 3.0);
  EXPECT_EQ(law.at(1.9).value, -1.0);
  EXPECT_EQ(law.at(4.1).value, 3.0);
  EXPECT_NEAR(law.at(3.0).value, 1.0, 1e-15);
  for (double d = 0.05; d < 1.0; d += 0.1) {
    EXPECT_GT(law.at(3.0 + d).rate, 0.0);
    EXPECT_NEAR(law.at(3.0 + d).value - 1.0, 1.0 - law.at(3.0 - d).value, 1e-14);
    expect_derivatives_match(law, 3.0 + 0.9 * d, 1e-3, 20.0);
  }
}

INSTANTIATE_TEST_SUITE_P(AllProfiles, SmoothRise,
                         ::testing::Values(Profile{"smooth_ramp", &make_smooth_ramp},
                                           Profile{"cycloidal", &make_cycloidal}),
                         [](const auto& test) { return test.param.name; });

TEST(BasicLaws, cycloidal_rate_is_a_full_wave) {
  const Law law = make_cycloidal(1.0, 3.0, 0.0, 10.0);
  for (double t = 1.1; t < 3.0; t += 0.2) {
    EXPECT_NEAR(law.at(t).rate, 5.0 * (1.0 - std::cos(pi * (t - 1.0))), 1e-14 * 10.0);
  }
}

TEST(BasicLaws, harmonic_obeys_its_differential_equation) {
  const double omega = 3.0;
  const Law law = make_harmonic(2.0, omega, 0.4, 7.0);
  for (double t = -2.0; t < 2.0; t += 0.3) {
    const LawValue x = law.at(t);
    EXPECT_NEAR(x.acceleration, -omega * omega * (x.value - 7.0), 1e-13);
    expect_derivatives_match(law, t, 1e-3, 60.0);
  }
  EXPECT_DOUBLE_EQ(law.at(0.0).value, 7.0 + 2.0 * std::sin(0.4));
  EXPECT_TRUE(law.breakpoints(0.0, 100.0).empty());
  EXPECT_TRUE(make_harmonic(2.0, 0.0, 0.4).is_constant());
}

TEST(BasicLaws, linear_table_is_exact_on_lines_and_its_rate_jumps_at_knots) {
  const Law line = make_table({0.0, 0.5, 2.0}, {1.0, 2.0, 5.0}, Interpolation::linear);
  for (double t : {0.1, 0.5, 1.3, 1.9}) expect_equal(line.at(t), {1.0 + 2.0 * t, 2.0, 0.0}, 1e-14);
  const Law tent = make_table({0.0, 1.0, 2.0}, {0.0, 3.0, 0.0}, Interpolation::linear);
  EXPECT_EQ(tent.breakpoints(-5.0, 5.0), (Times{0.0, 1.0, 2.0}));
  EXPECT_EQ(tent.at(1.0, Side::left).rate, 3.0);
  EXPECT_EQ(tent.at(1.0, Side::right).rate, -3.0);
  expect_equal(tent.at(-1.0), {0.0, 0.0, 0.0}, 0.0);
}

TEST(BasicLaws, cubic_table_reproduces_polynomials_up_to_its_degree) {
  const auto cubic = [](double t) -> LawValue {
    return {1.0 - 2.0 * t + 0.5 * t * t + t * t * t, -2.0 + t + 3.0 * t * t, 1.0 + 6.0 * t};
  };
  for (std::size_t n : {4U, 5U, 9U}) {
    Times times;
    Times values;
    for (std::size_t i = 0; i < n; ++i) {
      const double x = static_cast<double>(i) / static_cast<double>(n - 1);
      times.push_back(-1.0 + 3.0 * x * (0.6 + 0.4 * x));  // uneven knots from -1 to 2
      values.push_back(cubic(times.back()).value);
    }
    const Law law = make_table(times, values, Interpolation::cubic);
    // Second derivatives are second differences: a few eps of the values over the smallest step squared.
    for (double t = -0.95; t < 2.0; t += 0.1) expect_equal(law.at(t), cubic(t), 2e-12);
    EXPECT_EQ(law.breakpoints(-9.0, 9.0), (Times{times.front(), times.back()}));
  }
  const Law parabola = make_table({0.0, 1.0, 3.0}, {0.0, 1.0, 9.0}, Interpolation::cubic);
  expect_equal(parabola.at(2.0), {4.0, 4.0, 2.0}, 1e-14);
  const Law line = make_table({0.0, 4.0}, {1.0, 3.0}, Interpolation::cubic);
  expect_equal(line.at(1.0), {1.5, 0.5, 0.0}, 1e-15);
}

TEST(BasicLaws, cubic_table_is_twice_continuous_inside_and_converges_with_fourth_order) {
  const auto error = [](int n) {
    Times times;
    Times values;
    for (int i = 0; i <= n; ++i) {
      times.push_back(3.0 * i / n);
      values.push_back(std::sin(times.back()));
    }
    const Law law = make_table(times, values, Interpolation::cubic);
    for (std::size_t i = 1; i + 1 < times.size(); ++i) {
      EXPECT_EQ(law.at(times[i]).value, values[i]);
      expect_equal(law.at(times[i], Side::left), law.at(times[i], Side::right), 1e-12);
    }
    double worst = 0.0;
    for (double t = 0.0; t < 3.0; t += 0.01) worst = std::max(worst, std::abs(law.at(t).value - std::sin(t)));
    return worst;
  };
  const double order = std::log2(error(20) / error(40));
  EXPECT_GT(order, 3.7);
  EXPECT_LT(order, 4.8);  // the ends, where not-a-knot is worst, may still gain more than the inside
}

TEST(BasicLaws, one_point_table_is_constant) {
  const Law law = make_table({1.0}, {4.0}, Interpolation::cubic);
  EXPECT_TRUE(law.is_constant());
  EXPECT_EQ(law.at(0.0).value, 4.0);
}

TEST(BasicLaws, bad_data_is_refused) {
  EXPECT_THROW(make_ramp(1.0, 1.0, 0.0, 1.0), LawError);
  EXPECT_THROW(make_smooth_ramp(2.0, 1.0, 0.0, 1.0), LawError);
  EXPECT_THROW(make_cycloidal(2.0, 1.0, 0.0, 1.0), LawError);
  EXPECT_THROW(make_table({}, {}, Interpolation::linear), LawError);
  EXPECT_THROW(make_table({0.0, 1.0}, {1.0}, Interpolation::linear), LawError);
  EXPECT_THROW(make_table({0.0, 0.0}, {1.0, 2.0}, Interpolation::cubic), LawError);
  EXPECT_THROW(make_constant(HUGE_VAL), LawError);
  EXPECT_THROW(make_harmonic(1.0, HUGE_VAL), LawError);
  EXPECT_THROW(make_piecewise({}), LawError);
  EXPECT_THROW(make_piecewise({{1.0, Law{}}, {1.0, Law{}}}), LawError);
}

}  // namespace
}  // namespace bough::laws
