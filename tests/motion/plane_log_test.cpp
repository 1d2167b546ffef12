/// Logarithms of motions of a plane against tangent operators of their own and against jets.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "bough/lanes/jet.hpp"
#include "bough/motion/se2.hpp"
#include "samples.hpp"

namespace bough::motion {
namespace {

constexpr Vec2<double> shift{{0.8, -1.3}};
constexpr Vec3<double> z{{0.4, -0.9, 1.7}}, delta{{-1.1, 0.6, 0.8}};

/// The logarithm of exp(d), which is d.
template <class S>
PlaneLog<S> log_of_exp(const Vec3<S>& d) {
  using std::cos;
  using std::sin;
  const PlaneMotion<S> m(d);
  return PlaneLog<S>(Vec2<S>{{cos(d[2]), sin(d[2])}}, complex_times(m.series.f, plane_part(d)));
}

/// To both sides.
std::vector<double> angles() {
  std::vector<double> all = test::angles_up_to_pi();
  for (const double theta : test::angles_up_to_pi()) all.push_back(-theta);
  return all;
}

double largest(const Vec3<double>& a) { return std::max({std::abs(a[0]), std::abs(a[1]), std::abs(a[2])}); }

TEST(PlaneLog, angles_are_within_3_ulps_of_themselves) {
  for (const double theta : angles()) {
    const auto exact = static_cast<long double>(theta);
    const double angle = angle_of(static_cast<double>(std::cos(exact)), static_cast<double>(std::sin(exact)));
    EXPECT_LE(std::abs(angle - theta), 3 * test::epsilon * std::abs(theta)) << theta;
  }
}

TEST(PlaneLog, is_the_inverse_of_the_exponential_and_of_its_tangent) {
  for (const double theta : angles()) {
    const Vec3<double> d = join(shift, theta);
    const PlaneMotion<double> m(d);
    const PlaneLog<double> log = log_of_exp(d);
    EXPECT_LT(largest(log.d - d), 16 * test::epsilon) << theta;
    EXPECT_LT(largest(log.inverse_times(m.times(z)) - z), 16 * test::epsilon) << theta;
    EXPECT_LT(largest(m.transpose_times(log.inverse_transpose_times(z)) - z), 16 * test::epsilon) << theta;
  }
}

TEST(PlaneLog, slope_of_the_inverse_tangent_is_its_derivative) {
  using J = lanes::Jet<double, 1>;
  for (const double theta : angles()) {
    const Vec3<double> d = join(shift, theta);
    Vec3<J> moved, carried;
    for (int i = 0; i < 3; ++i) {
      moved[i] = J(d[i]);
      moved[i].d[0] = delta[i];
      carried[i] = J(z[i]);
    }
    const Vec3<J> along = log_of_exp(moved).inverse_times(carried);
    const Vec3<double> slope = log_of_exp(d).inverse_slope_times(delta, z);
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(slope[i], along[i].d[0], 32 * test::epsilon) << theta;
  }
}

}  // namespace
}  // namespace bough::motion
