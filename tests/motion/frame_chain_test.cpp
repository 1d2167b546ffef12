// Nested frames: what a chain promises beside its formulas, and the sum of the parts against differentiated positions.
#include "bough/motion/frame_chain.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

#include "bough/motion/spinning_disc.hpp"
#include "frame_oracle.hpp"

namespace bough::motion {
namespace {

using test::length_of;
using Chains = test::Oracle<long double>;

TEST(FrameChain, the_parts_of_velocity_and_acceleration_add_up_to_the_derivatives_of_the_position) {
  test::Random random(60);
  for (int k = 0; k < 1000; ++k) {
    const Chains c(random, 2 + k % 5);
    const int n = c.chain.last();
    const auto x = c.position(0, n, c.r);
    const AccelerationParts parts = acceleration_split(c.chain, c.point, From(0), In(0));
    double largest = 0.0;
    for (const Resolved& part :
         {parts.local, parts.tangential, parts.coriolis, parts.centripetal, parts.razi, parts.origin})
      largest = std::max(largest, norm(part));
    const Vec3<double> exact = test::rounded(test::time_derivative(test::time_derivative(x)));
    EXPECT_LT(length_of(parts.total().components(In(0)) - exact), 1e-10 * largest) << n << " frames";
    const VelocityParts v = velocity_split(c.chain, c.point, From(0), In(0));
    EXPECT_LT(length_of(v.total().components(In(0)) - test::rounded(test::time_derivative(x))),
              1e-10 * (norm(v.local) + norm(v.tangential) + norm(v.origin)));
  }
}

TEST(FrameChain, an_observer_and_back_gives_the_same_motion_of_the_point) {
  test::Random random(61);
  for (int k = 0; k < 1000; ++k) {
    const Chains c(random, 2 + k % 5);
    const int n = c.chain.last(), g = k % n;
    const PointMotion back = observe(c.chain, observe(c.chain, c.point, From(g)), From(n));
    const test::Scale scale = test::scale_of(c.chain, c.point);
    EXPECT_EQ(back.frame, n);
    EXPECT_LT(length_of(back.velocity - c.point.velocity), 64 * test::epsilon * scale.v);
    EXPECT_LT(length_of(back.acceleration - c.point.acceleration), 64 * test::epsilon * scale.acc);
  }
}

TEST(FrameChain, the_chain_as_one_link_moves_as_the_chain) {
  test::Random random(62);
  for (int k = 0; k < 1000; ++k) {
    const Chains c(random, 2 + k % 5);
    const int n = c.chain.last();
    PointMotion p = c.point;
    p.frame = 1;
    const FrameChain one({relative_motion(c.chain, Of(n), RelativeTo(0))});
    const AccelerationParts a = acceleration_split(c.chain, c.point, From(0), In(0));
    const AccelerationParts b = acceleration_split(one, p, From(0), In(0));
    const double bound = 64 * test::epsilon * test::scale_of(c.chain, c.point).acc;
    EXPECT_LT(norm(a.total() - b.total()), bound);
    EXPECT_LT(norm(a.centripetal - b.centripetal), bound);
    // One link knows no Razi acceleration: its tangential part holds it.
    EXPECT_EQ(norm(b.razi), 0.0);
    EXPECT_LT(norm(a.tangential + a.razi - b.tangential), bound);
  }
}

TEST(FrameChain, the_axes_of_the_result_change_components_and_no_magnitude) {
  test::Random random(63);
  const Chains c(random, 4);
  const AccelerationParts a = acceleration_split(c.chain, c.point, From(1), In(0));
  for (int k = 0; k <= 4; ++k) {
    const AccelerationParts b = acceleration_split(c.chain, c.point, From(1), In(k));
    EXPECT_EQ(b.razi.axes().frame, k);
    EXPECT_NEAR(norm(b.razi), norm(a.razi), 16 * test::epsilon * norm(a.razi));
    EXPECT_LT(norm(resolve(c.chain, b.total(), In(0)) - a.total()), 64 * test::epsilon * norm(a.total()));
  }
}

TEST(FrameChain, the_origins_can_be_split_in_turn) {
  test::Random random(64);
  const Chains c(random, 5);
  Resolved sum = Resolved::zero(In(0));
  for (int i = 1; i <= 5; ++i) {
    const AccelerationParts a = acceleration_split(c.chain, origin_of(c.chain, i), From(0), In(0));
    sum += a.local + a.tangential + a.coriolis + a.centripetal + a.razi;
  }
  const AccelerationParts a = acceleration_split(c.chain, c.point, From(0), In(0));
  EXPECT_LT(norm(sum - a.origin), 64 * test::epsilon * test::scale_of(c.chain, c.point).acc);
}

TEST(FrameChain, a_twist_and_its_rate_give_the_motion_of_the_frame) {
  test::Random random(65);
  for (int k = 0; k < 100; ++k) {
    const Chains c(random, 1);
    const FrameMotion& m = c.chain.link(1);
    // V = (R^T dx/dt; R^T w) as functions of time, differentiated.
    const auto R = c.R(0, 1);
    const auto x = c.position(0, 1, Vec3<Chains::T>::zero());
    const auto v = transpose_times(R, test::time_derivative(x)), omega = c.w(1);
    const FrameMotion same =
        motion_from_twist(m.pose, join(test::rounded(v), test::rounded(omega)),
                          join(test::rounded(test::time_derivative(v)), test::rounded(test::time_derivative(omega))));
    const double scale = length_of(m.acceleration) + length_of(m.angular_velocity) * length_of(m.velocity);
    EXPECT_LT(length_of(same.acceleration - m.acceleration), 16 * test::epsilon * scale);
    EXPECT_LT(length_of(same.velocity - m.velocity), 16 * test::epsilon * length_of(m.velocity));
    EXPECT_LT(length_of(same.angular_velocity - m.angular_velocity),
              16 * test::epsilon * length_of(m.angular_velocity));
    EXPECT_LT(length_of(same.angular_acceleration - m.angular_acceleration),
              16 * test::epsilon * length_of(m.angular_acceleration));
  }
}

TEST(FrameChain, frames_with_one_fixed_axis_have_no_razi_acceleration) {
  for (const double angle : {0.0, 0.4, 2.0}) {
    FrameMotion m;
    m.pose.R = exp_so3(angle * Vec3<double>::unit(2));
    m.angular_velocity = Vec3<double>{{0.0, 0.0, 3.0}};
    m.angular_acceleration = Vec3<double>{{0.0, 0.0, -2.0}};
    const PointMotion p{.frame = 3, .position = {{1.0, 2.0, 3.0}}, .velocity = {{4.0, 5.0, 6.0}}};
    const AccelerationParts a = acceleration_split(FrameChain({m, m, m}), p, From(0), In(3));
    EXPECT_EQ(norm(a.razi), 0.0);
    EXPECT_NEAR(norm(a.centripetal), 81.0 * std::sqrt(5.0), 1e-12);
    EXPECT_NEAR(norm(a.tangential), 6.0 * std::sqrt(5.0), 1e-13);
    EXPECT_NEAR(norm(a.coriolis), 18.0 * std::sqrt(41.0), 1e-12);
  }
}

TEST(FrameChain, a_chain_without_moving_frames_sees_the_point_as_it_is) {
  const FrameChain none({});
  const PointMotion p{.frame = 0, .position = {{1.0, 0.0, 0.0}}, .acceleration = {{0.0, 7.0, 0.0}}};
  const AccelerationParts a = acceleration_split(none, p, From(0), In(0));
  EXPECT_EQ(a.total().components(In(0))[1], 7.0);
  EXPECT_EQ(norm(a.origin), 0.0);
}

TEST(FrameChain, frames_outside_the_chain_are_refused) {
  FrameChain chain({FrameMotion{}, FrameMotion{}});
  EXPECT_THROW((void)chain.link(0), std::invalid_argument);
  EXPECT_THROW((void)chain.link(3), std::invalid_argument);
  EXPECT_THROW(chain.set_link(3, {}), std::invalid_argument);
  EXPECT_THROW((void)angular_velocity(chain, Of(3), RelativeTo(0), In(0)), std::invalid_argument);
  EXPECT_THROW((void)angular_velocity(chain, Of(1), RelativeTo(-1), In(0)), std::invalid_argument);
  EXPECT_THROW((void)acceleration_split(chain, {.frame = 2}, From(0), In(9)), std::invalid_argument);
  EXPECT_THROW((void)acceleration_split(chain, {.frame = 4}, From(0), In(0)), std::invalid_argument);
}

TEST(Resolved, vectors_of_different_axes_do_not_mix) {
  const Resolved a({{1.0, 2.0, 3.0}}, In(1)), b({{1.0, 0.0, 0.0}}, In(2));
  EXPECT_THROW((void)(a + b), std::invalid_argument);
  EXPECT_THROW((void)(a - b), std::invalid_argument);
  EXPECT_THROW((void)cross(a, b), std::invalid_argument);
  EXPECT_THROW((void)dot(a, b), std::invalid_argument);
  EXPECT_THROW((void)a.components(In(2)), std::invalid_argument);
  EXPECT_EQ(a.components(In(1))[2], 3.0);
  try {
    (void)(a + b);
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("resolved in frame 1, the other in frame 2"), std::string::npos);
  }
}

TEST(Resolved, derivatives_of_different_observers_do_not_mix) {
  const Rate rate(Resolved({{1.0, 2.0, 3.0}}, In(1)), From(2));
  EXPECT_THROW((void)rate.value(From(1)), std::invalid_argument);
  EXPECT_EQ(rate.value(From(2)).axes().frame, 1);
}

}  // namespace
}  // namespace bough::motion
