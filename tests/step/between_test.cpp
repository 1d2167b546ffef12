// Motion between two states: exact where it has to be, and its order against a motion in closed form.
#include "bough/step/between.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "bough/motion/group.hpp"

namespace bough::step {
namespace {

using elements::NodeMotion;
using motion::Frame;
using motion::Se3;
using motion::Vec6;

/// H = exp(a sin t) exp(b t^2), twist Ad(exp(b t^2))^-1 a cos t + 2 b t: about two axes that move in each other.
NodeMotion turning(double t) {
  const Vec6<double> a{0.3, -0.2, 0.5, 0.9, 0.4, -0.6}, b{-0.4, 0.1, 0.2, -0.3, 0.8, 0.5};
  const Frame<double> outer = Se3::exp(Vec6<double>(std::sin(t) * a)), inner = Se3::exp(Vec6<double>(t * t * b));
  const Frame<double> H = Se3::compose(outer, inner);
  NodeMotion n{};
  n.R = H.R;
  n.x = motion::Vec3Pair::from(H.x);
  n.v = Se3::inverse_adjoint_times(inner, Vec6<double>(std::cos(t) * a)) + (2.0 * t) * b;
  return n;
}

double largest(const Vec6<double>& v) {
  double most = 0.0;
  for (int i = 0; i < 6; ++i) most = std::max(most, std::abs(v[i]));
  return most;
}

/// Largest component of log(A^-1 B).
double distance(const NodeMotion& a, const NodeMotion& b) {
  return largest(Se3::log(Se3::relative(Frame<double>{a.R, a.x.hi}, Frame<double>{b.R, b.x.hi})));
}

struct Errors {
  double pose = 0.0, twist = 0.0;
};

/// Over steps of h from 0 to 1.
Errors errors_at(double h) {
  Errors most;
  for (int k = 0; k < static_cast<int>(std::lround(1.0 / h)); ++k)
    for (const double part : {0.1, 0.25, 0.5, 0.7, 0.9}) {
      NodeMotion found{};
      eval_between(turning(k * h), turning((k + 1) * h), h, part, found);
      const NodeMotion exact = turning((k + part) * h);
      most.pose = std::max(most.pose, distance(exact, found));
      most.twist = std::max(most.twist, largest(found.v - exact.v));
    }
  return most;
}

TEST(Between, poses_are_of_fourth_order_and_twists_of_third) {
  const Errors coarse = errors_at(0.05), fine = errors_at(0.025);
  const double pose = std::log2(coarse.pose / fine.pose), twist = std::log2(coarse.twist / fine.twist);
  std::printf("between steps of 0.05 and 0.025: poses %.1e, %.1e (order %.2f), twists %.1e, %.1e (order %.2f)\n",
              coarse.pose, fine.pose, pose, coarse.twist, fine.twist, twist);
  EXPECT_NEAR(pose, 4.0, 0.2);
  EXPECT_NEAR(twist, 3.0, 0.2);
}

TEST(Between, both_ends_are_met) {
  const NodeMotion first = turning(0.3), last = turning(0.9);
  NodeMotion found{};
  eval_between(first, last, 0.6, 0.0, found);
  EXPECT_LT(distance(first, found), 1e-15);
  EXPECT_LT(largest(found.v - first.v), 1e-14);
  eval_between(first, last, 0.6, 1.0, found);
  EXPECT_LT(distance(last, found), 1e-14);
  EXPECT_LT(largest(found.v - last.v), 1e-14);
}

TEST(Between, a_steady_twist_is_met_exactly_up_to_nearly_half_a_turn_a_step) {
  const Vec6<double> twist{1.0, -2.0, 0.5, 0.6, -1.1, 2.5};  // 2.8 rad/s
  NodeMotion first = turning(0.4), last{}, found{};
  first.v = last.v = twist;
  const auto moved = [&](double t) {
    const Frame<double> H = Se3::compose(Frame<double>{first.R, first.x.hi}, Se3::exp(Vec6<double>(t * twist)));
    NodeMotion n{};
    n.R = H.R;
    n.x = motion::Vec3Pair::from(H.x);
    return n;
  };
  last.R = moved(1.0).R;
  last.x = moved(1.0).x;
  for (const double part : {0.1, 0.5, 0.8}) {
    eval_between(first, last, 1.0, part, found);
    EXPECT_LT(distance(moved(part), found), 1e-14) << part;
    EXPECT_LT(largest(found.v - twist), 1e-13) << part;
  }
}

TEST(Between, nodes_that_move_as_one_body_stay_one) {
  const Frame<double> arm{motion::exp_so3(motion::Vec3<double>{0.3, -1.2, 0.4}), {100.0, -20.0, 3.0}};
  const auto carried = [&](const NodeMotion& n) {
    const Frame<double> H = Se3::compose(Frame<double>{n.R, n.x.hi}, arm);
    NodeMotion other{};
    other.R = H.R;
    other.x = motion::Vec3Pair::from(H.x);
    other.v = Se3::inverse_adjoint_times(arm, n.v);
    return other;
  };
  const NodeMotion first = turning(0.2), last = turning(0.8);
  NodeMotion one{}, other{};
  for (const double part : {0.2, 0.5, 0.9}) {
    eval_between(first, last, 0.6, part, one);
    eval_between(carried(first), carried(last), 0.6, part, other);
    EXPECT_LT(distance(carried(one), other), 1e-12) << part;  // 100 m of arm
  }
}

}  // namespace
}  // namespace bough::step
