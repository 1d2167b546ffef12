// Constants of the local error against steps of the rule on polynomials, and the controller on its own.
#include "bough/step/step_control.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <utility>

namespace bough::step {
namespace {

/// One step of the rule in one coordinate whose acceleration is `rate`, from exact values of q and v = `speed` at t
/// and the algorithmic acceleration of a motion in which the rule has settled. Writes the errors of q and v over h^3.
template <class Speed, class Rate>
std::pair<double, double> errors_of_a_step(double radius, Speed speed, Rate rate, double place_change) {
  const AlphaCoefficients c = make_alpha_coefficients(radius);
  const double h = 1.0;
  double a = rate(-400.0);
  const auto next = [&](double t) {
    return ((1.0 - c.alpha_f) * rate(t + h) + c.alpha_f * rate(t) - c.alpha_m * a) / (1.0 - c.alpha_m);
  };
  for (int k = -400; k < 0; ++k) a = next(k * h);
  const double after = next(0.0);
  const double dq = h * speed(0.0) + h * h * ((0.5 - c.beta) * a + c.beta * after);
  const double dv = h * ((1.0 - c.gamma) * a + c.gamma * after);
  return {dq - place_change, dv - (speed(h) - speed(0.0))};
}

TEST(ErrorConstants, are_what_a_step_leaves_of_polynomials) {
  for (const double radius : {0.0, 0.3, 0.5, 0.8, 0.95}) {
    const AlphaCoefficients c = make_alpha_coefficients(radius);
    // q = t^3 / 6: v'' = 1.
    const auto cubic = errors_of_a_step(
        radius, [](double t) { return 0.5 * t * t; }, [](double t) { return t; }, 1.0 / 6.0);
    EXPECT_NEAR(cubic.first, c.error_of_increments(), 1e-12) << radius;
    EXPECT_NEAR(cubic.second, 0.0, 1e-12) << radius;
    // v = t^3 / 6: v''' = 1.
    const auto quartic = errors_of_a_step(
        radius, [](double t) { return t * t * t / 6.0; }, [](double t) { return 0.5 * t * t; }, 1.0 / 24.0);
    EXPECT_NEAR(quartic.second, c.error_of_velocities(), 1e-9) << radius;
    EXPECT_GT(c.error_of_increments(), 0.08) << "no radius leaves positions without an error to measure";
  }
}

TEST(StepController, keeps_a_size_within_the_dead_band) {
  StepController controller(1e-3);
  for (int k = 0; k < 20; ++k) EXPECT_EQ(controller.after_accepted(0.8, 0.1), 0.1);
  StepController easy(1e-3);
  for (int k = 0; k < 20; ++k) EXPECT_EQ(easy.after_accepted(0.4, 0.1), 0.1);
}

TEST(StepController, grows_after_four_steps_that_agree_and_at_once_far_below) {
  StepController controller(1e-3);
  for (int k = 0; k < 3; ++k) EXPECT_EQ(controller.after_accepted(0.1, 0.1), 0.1) << k;
  EXPECT_NEAR(controller.after_accepted(0.1, 0.1), 0.1 * std::pow(8.0, 0.2), 1e-12);
  StepController dips(1e-3);
  for (int k = 0; k < 12; ++k) EXPECT_EQ(dips.after_accepted(k % 3 == 0 ? 0.6 : 0.05, 0.1), 0.1) << k;
  StepController far(1e-3);
  EXPECT_GT(far.after_accepted(1e-6, 0.1), 0.2);
  EXPECT_LE(far.after_accepted(0.0, 0.1), 0.4 + 1e-15);
}

TEST(StepController, shrinks_before_a_rising_error_is_rejected_and_after_it_was) {
  StepController controller(1e-3);
  (void)controller.after_accepted(0.3, 0.1);
  EXPECT_LT(controller.after_accepted(0.9, 0.1), 0.09);
  EXPECT_NEAR(controller.after_rejected(6.4, 0.1), 0.05, 1e-12);
  EXPECT_NEAR(controller.after_rejected(1e9, 0.1), 0.02, 1e-12);
  EXPECT_EQ(controller.after_failure(0.1), 0.05);
  for (int k = 0; k < 7; ++k) EXPECT_EQ(controller.after_accepted(0.1, 0.05), 0.05) << "held after a failure, " << k;
  EXPECT_GT(controller.after_accepted(0.1, 0.05), 0.05);
}

TEST(StepController, settles_where_the_error_is_of_third_order) {
  // E = (h / h_wanted)^3 with h_wanted that falls by a factor of ten at step 60 and rises again at step 150.
  StepController controller(1e-3);
  double h = 1e-4;
  int changes = 0, rejections = 0;
  for (int k = 0; k < 260; ++k) {
    const double wanted = k < 60 || k >= 150 ? 1.0 : 0.1;
    double ratio = std::pow(h / wanted, 3);
    while (ratio > 1.0) {
      h = controller.after_rejected(ratio, h);
      ratio = std::pow(h / wanted, 3);
      ASSERT_LT(++rejections, 6);
    }
    const double next = controller.after_accepted(ratio, h);
    changes += next != h ? 1 : 0;
    h = next;
    if (k % 60 == 59 || k == 259) {
      EXPECT_GT(h, 0.6 * wanted) << k;
      EXPECT_LT(h, 1.0 * wanted) << k;
    }
  }
  EXPECT_LT(changes, 40);
}

}  // namespace
}  // namespace bough::step
