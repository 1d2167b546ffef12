#include "bough/scene/moving_frame.hpp"

#include <gtest/gtest.h>

#include "bough/lanes/taylor.hpp"
#include "bough/laws/make_law.hpp"
#include "support/untrapped.hpp"

namespace bough::scene {
namespace {

using Series = lanes::Taylor<long double, 2>;
using Vec = motion::Vec3<Series>;
using Mat = motion::Mat3<Series>;

/// The law around t as a series, to second order.
Series series_of(const laws::Law& law, double t) {
  const laws::LawValue v = law.at(t);
  Series s;
  s.c[0] = v.value;
  s.c[1] = v.rate;
  s.c[2] = 0.5L * v.acceleration;
  return s;
}

/// Rotation about a unit axis (Rodrigues).
Mat turned(const motion::Vec3<double>& n, const Series& angle) {
  Series s, c;
  sin_cos(angle, s, c);
  const Vec axis = lanes::cast<Series>(n);
  const Mat nn = lanes::outer(axis, axis), I = Mat::identity();
  return c * I + s * lanes::skew(axis) + (1.0 - c) * nn;
}

MovingFrame tumbling() {
  MovingFrame f;
  f.name = "tumbling";
  f.position[0] = laws::make_harmonic(2.0, 3.0, 0.4);
  f.position[1] = laws::make_expression("t^3 - t");
  f.rotation = motion::exp_so3(motion::Vec3<double>{{0.3, -0.2, 0.9}});
  f.turns = {{{{0.6, 0.0, 0.8}}, laws::make_expression("2*t + t^2")},
             {{{0.0, 1.0, 0.0}}, laws::make_harmonic(1.5, 4.0)},
             {{{0.0, -0.6, 0.8}}, laws::make_constant(3.0).integral(0.0)}};
  return f;
}

TEST(MovingFrame, moves_as_the_derivatives_of_its_pose_say) {
  const MovingFrame f = tumbling();
  for (const double t : {0.0, 0.3, 1.7}) {
    Mat R = lanes::cast<Series>(f.rotation);
    for (const Turn& turn : f.turns) R = R * turned(turn.axis, series_of(turn.angle, t));
    motion::Mat3<double> value, rate, second;
    for (int k = 0; k < 9; ++k) {
      value.m[k] = static_cast<double>(R.m[k].c[0]);
      rate.m[k] = static_cast<double>(R.m[k].c[1]);
      second.m[k] = static_cast<double>(2.0L * R.m[k].c[2]);
    }
    const motion::FrameMotion m = motion_at(f, t);
    const motion::Vec3<double> w = motion::angular_velocity_of(value, rate),
                               alpha = motion::angular_acceleration_of(value, rate, second);
    for (int k = 0; k < 9; ++k) EXPECT_NEAR(m.pose.R.m[k], value.m[k], 4e-15);
    for (int k = 0; k < 3; ++k) {
      const laws::LawValue x = f.position[k].at(t);
      EXPECT_EQ(m.pose.x[k], x.value);
      EXPECT_EQ(m.velocity[k], x.rate);
      EXPECT_EQ(m.acceleration[k], x.acceleration);
      // Speeds up to 15 rad/s: terms of the acceleration up to 15^2.
      EXPECT_NEAR(m.angular_velocity[k], w[k], 1e-14);
      EXPECT_NEAR(m.angular_acceleration[k], alpha[k], 2e-13);
    }
  }
}

TEST(MovingFrame, takes_the_side_of_a_jump_that_is_asked_for) {
  MovingFrame f;
  f.turns = {{motion::Vec3<double>::unit(2), laws::make_ramp(0.0, 1.0, 0.0, 5.0)}};
  EXPECT_EQ(motion_at(f, 1.0, laws::Side::left).angular_velocity[2], 5.0);
  EXPECT_EQ(motion_at(f, 1.0, laws::Side::right).angular_velocity[2], 0.0);
}

TEST(MovingFrame, names_the_law_that_is_not_finite) {
  const test::Untrapped untrapped;
  MovingFrame f = tumbling();
  EXPECT_FALSE(non_finite_law(f, 0.0));
  f.turns[1].angle = laws::make_expression("sqrt(t)");
  EXPECT_FALSE(non_finite_law(f, 1.0));
  const auto fault = non_finite_law(f, 0.0);
  ASSERT_TRUE(fault);
  EXPECT_EQ(fault->find("turn 2 of frame \"tumbling\": rate is infinite"), 0u) << *fault;
}

TEST(FrameStudy, ends_at_its_ends) {
  FrameStudy s;
  s.start_time = 0.1;
  s.end_time = 0.7;
  s.num_points = 8;
  EXPECT_EQ(time_of(s, 0), 0.1);
  EXPECT_EQ(time_of(s, 7), 0.7);
}

}  // namespace
}  // namespace bough::scene
