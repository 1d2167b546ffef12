#pragma once

#include <gtest/gtest.h>

#include <cmath>

#include "bough/laws/law.hpp"

namespace bough::laws {

/// Checks rate and acceleration at t against central differences of value and rate (fourth order, step h).
/// scale: size of the derivatives of f in the neighbourhood. Error: truncation h^4 f'''''/30 plus round-off eps f / h;
/// with h near 1e-3 of the time scale both are below 1e-9 of scale.
inline void expect_derivatives_match(const Law& law, double t, double h, double scale) {
  const auto difference = [&](auto member) {
    const auto f = [&](double s) { return law.at(s).*member; };
    return (8.0 * (f(t + h) - f(t - h)) - (f(t + 2.0 * h) - f(t - 2.0 * h))) / (12.0 * h);
  };
  const LawValue x = law.at(t);
  EXPECT_NEAR(x.rate, difference(&LawValue::value), 1e-8 * scale) << "t = " << t;
  EXPECT_NEAR(x.acceleration, difference(&LawValue::rate), 1e-8 * scale) << "t = " << t;
}

inline void expect_equal(const LawValue& a, const LawValue& b, double tolerance) {
  EXPECT_NEAR(a.value, b.value, tolerance);
  EXPECT_NEAR(a.rate, b.rate, tolerance);
  EXPECT_NEAR(a.acceleration, b.acceleration, tolerance);
}

}  // namespace bough::laws
