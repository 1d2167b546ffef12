/// Angles of complex numbers.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "bough/motion/se2.hpp"
#include "samples.hpp"

namespace bough::motion {
namespace {

/// To both sides.
std::vector<double> angles() {
  std::vector<double> all = test::angles_up_to_pi();
  for (const double theta : test::angles_up_to_pi()) all.push_back(-theta);
  return all;
}

TEST(PlaneAngle, angles_are_within_3_ulps_of_themselves) {
  for (const double theta : angles()) {
    const auto exact = static_cast<long double>(theta);
    const double angle = angle_of(static_cast<double>(std::cos(exact)), static_cast<double>(std::sin(exact)));
    EXPECT_LE(std::abs(angle - theta), 3 * test::epsilon * std::abs(theta)) << theta;
  }
}

}  // namespace
}  // namespace bough::motion
