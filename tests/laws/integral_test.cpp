#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <thread>
#include <vector>

#include "bough/laws/bounds.hpp"
#include "bough/laws/make_law.hpp"
#include "check_law.hpp"

namespace bough::laws {
namespace {

struct Sample {
  std::string name;
  Law law;
};

std::vector<Sample> make_samples() {
  const Law ramp = make_ramp(0.3, 1.1, -1.0, 2.0);
  const Law wave = make_harmonic(2.0, 3.0, 0.4, 0.7);
  return {{"constant", make_constant(2.5)},
          {"ramp", ramp},
          {"smooth ramp", make_smooth_ramp(0.2, 1.4, 3.0, -1.0)},
          {"cycloidal", make_cycloidal(0.2, 1.4, 3.0, -1.0)},
          {"harmonic", wave},
          {"linear table", make_table({0.0, 0.4, 1.0}, {1.0, -2.0, 3.0}, Interpolation::linear)},
          {"cubic table", make_table({0.0, 0.4, 1.0, 1.3, 2.0}, {1.0, -2.0, 3.0, 1.0, 0.0}, Interpolation::cubic)},
          {"piecewise", make_piecewise({{0.0, wave}, {0.5, make_constant(1.0)}, {1.2, ramp}})},
          {"sum", make_sum({ramp, make_scaled(-2.0, wave)})},
          {"product", make_product(ramp, wave)},
          {"expression", make_expression("exp(-t)*cos(5*t) + abs(t - 0.6)")},
          {"integral of a product", make_product(ramp, wave).integral(0.1)}};
}

TEST(Integral, derivative_of_the_integral_is_the_law) {
  for (const Sample& sample : make_samples()) {
    SCOPED_TRACE(sample.name);
    const Law integral = sample.law.integral(0.15);
    EXPECT_NEAR(integral.at(0.15).value, 0.0, 0.0);
    for (double t = -0.97; t < 2.5; t += 0.101) {
      expect_derivatives_match(integral, t, 1e-4, 100.0);
      for (Side side : {Side::left, Side::right}) {
        // Same polynomial or wave in another order of operations: round-off only.
        EXPECT_NEAR(integral.at(t, side).rate, sample.law.at(t, side).value, 1e-13);
        EXPECT_NEAR(integral.at(t, side).acceleration, sample.law.at(t, side).rate, 1e-12);
      }
    }
  }
}

TEST(Bounds, no_second_derivative_within_is_larger_and_short_intervals_leave_little_room) {
  std::vector<Sample> samples = make_samples();
  samples.push_back({"narrow pulse", make_expression("1e5*exp(-((t-0.5005)/5e-5)^2)")});
  for (const Sample& sample : samples) {
    SCOPED_TRACE(sample.name);
    for (const double width : {2.0, 0.3, 1e-3})
      for (double begin = -0.5; begin < 1.5; begin += 0.1737) {
        const double bound = largest_acceleration(sample.law, begin, begin + width);
        double most = 0.0;
        for (int k = 0; k <= 100; ++k)
          for (const Side side : {Side::left, Side::right})
            if ((k > 0 || side == Side::right) && (k < 100 || side == Side::left))
              most = std::max(most, std::abs(sample.law.at(begin + 0.01 * k * width, side).acceleration));
        EXPECT_GE(bound, most * (1.0 - 1e-12));
        if (width < 0.01 && std::isfinite(most))
          EXPECT_LE(bound, 1.2 * most + 120.0);  // a wave, times 3 in the product, may be anywhere in it
      }
  }
  EXPECT_GT(largest_acceleration(samples.back().law, 0.0, 1.0), 1e13) << "the pulse is within";
  EXPECT_LT(largest_acceleration(samples.back().law, 0.0, 0.49), 1e-3);
}

TEST(Integral, is_additive_over_the_time_it_starts_from) {
  // int_a^t + int_b^a = int_b^t; values up to 10, some sums in between.
  for (const Sample& sample : make_samples()) {
    SCOPED_TRACE(sample.name);
    const Law from_a = sample.law.integral(0.9);
    const Law from_b = sample.law.integral(-1.2);
    for (double t : {-3.0, -0.4, 0.7, 2.2, 5.0}) {
      EXPECT_NEAR(from_a.at(t).value + from_b.at(0.9).value, from_b.at(t).value, 1e-13);
    }
  }
}

TEST(Integral, closed_forms_and_quadrature_agree) {
  // A product with a formula that is 1 everywhere, but not known to be, takes the way of quadrature.
  const Law one = make_expression("cos(0*t)");
  ASSERT_FALSE(one.is_constant());
  for (const Sample& sample : make_samples()) {
    SCOPED_TRACE(sample.name);
    const Law closed = sample.law.integral(0.25);
    const Law numeric = make_product(sample.law, one).integral(0.25);
    for (double t : {-2.0, 0.1, 0.25, 0.8, 1.25, 3.7}) {
      EXPECT_NEAR(closed.at(t).value, numeric.at(t).value, 1e-13);
    }
  }
}

TEST(Integral, second_integral_of_slow_and_fast_waves_is_exact) {
  for (double omega : {1e-6, 1e-3, 0.02, 1.0, 40.0}) {
    const Law twice = make_harmonic(1.0, omega).integral(0.0).integral(0.0);
    for (double t : {0.5, 2.0, 10.0}) {
      // F = t / omega - sin(omega t) / omega^2, as a series where that cancels.
      const double x = omega * t;
      double expected = t / omega - std::sin(x) / (omega * omega);
      if (x < 0.5) {
        expected = t * t * (x / 6.0) * (1.0 - x * x / 20.0 * (1.0 - x * x / 42.0 * (1.0 - x * x / 72.0)));
      }
      // The closed form starts at omega = 0.01, where it loses eps / omega^2 of absolute accuracy.
      EXPECT_NEAR(twice.at(t).value, expected, 1e-13 * std::abs(expected) + 4e-16 / std::max(1e-4, omega * omega));
    }
  }
}

TEST(Integral, integral_removes_one_order_of_break) {
  const Law ramp = make_ramp(1.0, 2.0, 0.0, 1.0);
  EXPECT_EQ(ramp.integral(0.0).breakpoints(0.0, 3.0).size(), 2U);                // jumps of the acceleration
  EXPECT_EQ(ramp.integral(0.0).integral(0.0).breakpoints(0.0, 3.0).size(), 0U);  // of the third derivative
  const Law jump = make_expression("step(t - 1)");
  EXPECT_EQ(jump.integral(0.0).integral(0.0).breakpoints(0.0, 3.0), std::vector<double>{1.0});
  EXPECT_TRUE(jump.integral(0.0).integral(0.0).integral(0.0).breakpoints(0.0, 3.0).empty());
}

TEST(Integral, jump_inside_a_formula_is_integrated_to_round_off) {
  const Law law = make_expression("step(t - 1/3)*exp(t)").integral(0.0);
  const double t = 2.0;
  EXPECT_NEAR(law.at(t).value, std::exp(2.0) - std::exp(1.0 / 3.0), 1e-14 * 8.0);
}

TEST(Integral, root_at_the_start_and_long_spans_keep_their_digits) {
  // t^1.5 has an infinite second derivative at 0, so the first panel needs halving; e^(-t/100) runs over 10^4 panels.
  EXPECT_NEAR(make_expression("(t*t)^0.75 + 0*t").integral(0.0).at(2.0).value, 0.4 * std::pow(2.0, 2.5), 1e-14);
  EXPECT_NEAR(make_expression("exp(-t/100)").integral(0.0).at(500.0).value, -100.0 * std::expm1(-5.0), 1e-12);
  EXPECT_NEAR(make_expression("exp(t/100)").integral(0.0).at(-500.0).value, 100.0 * std::expm1(-5.0), 1e-12);
}

TEST(Integral, value_depends_neither_on_the_order_of_calls_nor_on_threads) {
  const auto make = [] { return make_expression("sin(t*t) + abs(cos(3*t))").integral(0.2); };
  std::vector<double> times;
  for (int i = 0; i < 60; ++i) times.push_back(-2.0 + 0.137 * i);
  std::vector<double> upwards;
  const Law first = make();
  for (double t : times) upwards.push_back(first.at(t).value);

  const Law second = make();
  for (std::size_t i = times.size(); i-- > 0;) EXPECT_EQ(second.at(times[i]).value, upwards[i]);

  const Law shared = make();
  std::vector<double> found(times.size());
  std::vector<std::thread> threads;
  for (std::size_t k = 0; k < 4; ++k) {
    threads.emplace_back([&, k] {
      for (std::size_t i = k; i < times.size(); i += 4) found[i] = shared.at(times[i]).value;
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(found, upwards);
}

}  // namespace
}  // namespace bough::laws
