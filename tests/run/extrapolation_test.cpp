/// Richardson's extrapolation of families of runs, on series whose limit is known.
#include "extrapolation.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "growing_distance.hpp"
#include "member_series.hpp"

namespace bough::run {
namespace {

using records::ErrorState;

std::vector<double> times_to(double end, int count) {
  std::vector<double> times;
  for (int k = 0; k <= count; ++k) times.push_back(end * k / count);
  return times;
}

/// Differences of members with sizes h, 2 h, 4 h whose values are limit(t) + error(t, size).
MemberDifferences differences(const std::vector<double>& times, const std::function<double(double, double)>& error) {
  MemberDifferences d;
  for (const double t : times) {
    d.fine.push_back(error(t, 1.0) - error(t, 2.0));
    d.coarse.push_back(error(t, 2.0) - error(t, 4.0));
  }
  return d;
}

const ErrorTheory second_order{2.0, 1e-13, 1e-8};

TEST(Extrapolation, an_error_of_the_theoretical_order_is_found_exactly) {
  const std::vector<double> times = times_to(2.0, 50);
  for (const double order : {1.0, 2.0, 3.0, 4.0, 6.0}) {
    const auto error = [order](double t, double h) { return 1e-3 * std::sin(3.0 * t) * std::pow(h, order); };
    for (int run = 0; run < 3; ++run) {
      const Extrapolation e = extrapolate(differences(times, error), times, run, {order, 1e-13, 1e-8});
      ASSERT_EQ(e.part.state, ErrorState::resolved) << order;
      EXPECT_NEAR(e.part.order_of_largest, order, 1e-6);
      EXPECT_NEAR(e.part.order_of_root_mean_square, order, 1e-6);
      for (std::size_t k = 0; k < times.size(); ++k)
        EXPECT_NEAR(e.error[k], -error(times[k], std::exp2(run)), 1e-12) << order << " " << run;
    }
  }
}

TEST(Extrapolation, what_is_left_is_of_fourth_order_where_errors_have_even_powers) {
  const std::vector<double> times = times_to(1.0, 20);
  const auto left = [&](double size) {
    const auto error = [size](double t, double h) {
      return (1.0 + t) * std::pow(size * h, 2) + 3.0 * t * std::pow(size * h, 4);
    };
    const Extrapolation e = extrapolate(differences(times, error), times, 0, second_order);
    EXPECT_EQ(e.part.state, ErrorState::resolved);
    return std::abs(error(1.0, 1.0) + e.error.back());
  };
  EXPECT_NEAR(std::log2(left(0.02) / left(0.01)), 4.0, 0.01);
}

TEST(Extrapolation, an_error_of_lower_order_is_not_resolved) {
  const std::vector<double> times = times_to(1.0, 20);
  const auto error = [](double t, double h) { return 1e-3 * t * h; };
  const Extrapolation e = extrapolate(differences(times, error), times, 0, second_order);
  EXPECT_EQ(e.part.state, ErrorState::not_resolved);
  EXPECT_TRUE(e.error.empty());
  EXPECT_DOUBLE_EQ(e.part.largest, 1e-3) << "the difference between the run and its twin";
}

TEST(Extrapolation, what_differs_from_the_order_at_one_time_alone_is_not_resolved_and_told_from_when_on) {
  const std::vector<double> times = times_to(1.0, 20);
  MemberDifferences d = differences(times, [](double t, double h) { return 1e-3 * (1.0 + t) * h * h; });
  d.coarse[15] = 0.0;
  const Extrapolation e = extrapolate(d, times, 0, second_order);
  EXPECT_EQ(e.part.state, ErrorState::not_resolved);
  EXPECT_NE(e.part.cause.find("from 0.75 on"), std::string::npos) << e.part.cause;
}

TEST(Extrapolation, two_members_tell_an_error_whose_order_was_not_examined) {
  const std::vector<double> times = times_to(1.0, 4);
  MemberDifferences d = differences(times, [](double, double h) { return 1e-3 * h * h; });
  d.coarse.clear();
  const Extrapolation e = extrapolate(d, times, 0, second_order);
  EXPECT_EQ(e.part.state, ErrorState::unexamined);
  EXPECT_TRUE(std::isnan(e.part.order_of_largest));
  EXPECT_NEAR(e.part.largest, 1e-3, 1e-12);
}

TEST(Extrapolation, differences_below_round_off_or_the_tolerance_are_round_off) {
  const std::vector<double> times = times_to(1.0, 10);
  const auto noise = [](double size) { return [size](double t, double h) { return size * std::sin(1000.0 * t * h); }; };
  const Extrapolation round_off = extrapolate(differences(times, noise(1e-14)), times, 0, second_order);
  EXPECT_EQ(round_off.part.state, ErrorState::round_off);
  EXPECT_EQ(round_off.part.largest, second_order.round_off);
  const Extrapolation tolerance = extrapolate(differences(times, noise(1e-9)), times, 0, second_order);
  EXPECT_EQ(tolerance.part.state, ErrorState::round_off);
  EXPECT_EQ(tolerance.part.largest, second_order.floor);
  EXPECT_EQ(extrapolate(differences(times, noise(1e-6)), times, 0, second_order).part.state, ErrorState::not_resolved);
}

/// A rotation about a tilted axis whose angle has an error of second order, near and beyond half a turn.
TEST(Extrapolation, rotations_extrapolate_on_the_group) {
  const std::vector<double> times = times_to(1.0, 40);
  const double axis[3] = {2.0 / 7.0, 3.0 / 7.0, 6.0 / 7.0};
  const auto angle = [](double t, double h) { return 4.0 * t + 1e-3 * t * h * h; };
  for (const bool is_quaternion : {false, true}) {
    const ComparedColumns columns{
        is_quaternion ? ComparedColumns::Kind::quaternion : ComparedColumns::Kind::rotation_vector, 0,
        is_quaternion ? std::size_t{4} : std::size_t{3}};
    const auto value = [&](double phi) {
      phi = std::remainder(phi, 2.0 * std::numbers::pi);
      if (is_quaternion) {
        const double s = std::sin(0.5 * phi);
        return std::vector<double>{std::cos(0.5 * phi), s * axis[0], s * axis[1], s * axis[2]};
      }
      return std::vector<double>{phi * axis[0], phi * axis[1], phi * axis[2]};
    };
    MemberSeries members[3];
    for (int m = 0; m < 3; ++m)
      for (const double t : times) {
        members[m].times.push_back(t);
        members[m].values.push_back(value(angle(t, std::exp2(m))));
      }
    const Family family({&members[0], &members[1], &members[2]}, 0);
    const Extrapolation e = extrapolate(family.differences(columns), family.times(), 0, second_order);
    ASSERT_EQ(e.part.state, ErrorState::resolved);
    EXPECT_NEAR(e.part.largest, 1e-3, 1e-9) << "an angle";
    for (std::size_t k = 0; k < times.size(); ++k) {
      std::vector<double> limit = members[0].values[k];
      turn(columns, &e.error[3 * k], limit.data());
      std::vector<double> exact = value(angle(times[k], 0.0));
      const double sign = is_quaternion && exact[0] * limit[0] < 0.0 ? -1.0 : 1.0;
      for (std::size_t i = 0; i < columns.count; ++i) EXPECT_NEAR(limit[i], sign * exact[i], 1e-9) << times[k];
    }
  }
}

TEST(Extrapolation, errors_between_the_times_of_members_are_those_of_a_cubic) {
  const std::vector<double> times = times_to(2.0, 8);
  std::vector<double> error;
  const auto cubic = [](double t) { return 1.0 + t * (2.0 - t * (3.0 - 0.5 * t)); };
  for (const double t : times) error.push_back(cubic(t));
  for (double t = 0.0; t <= 2.0; t += 0.03) {
    double found = 0.0;
    interpolate(times, error, 1, t, &found);
    EXPECT_NEAR(found, cubic(t), 1e-12) << t;
  }
}

TEST(Extrapolation, members_are_compared_at_the_times_that_all_of_them_have) {
  MemberSeries fine{{0.0, 0.1, 0.2, 0.3, 0.4}, {{0}, {1}, {2}, {3}, {4}}};
  MemberSeries coarse{{0.0, 0.2, 0.4}, {{0}, {2.5}, {4.5}}};
  const Family family({&fine, &coarse}, 0);
  EXPECT_EQ(family.times(), (std::vector<double>{0.0, 0.2, 0.4}));
  EXPECT_EQ(family.differences({}).fine, (std::vector<double>{0.0, -0.5, -0.5}));
}

TEST(GrowingDistance, tells_exponential_growth_from_a_power_and_from_an_event) {
  const std::vector<double> times = times_to(10.0, 200);
  const auto look = [&](const std::function<double(double)>& distance) {
    MemberDifferences d;
    for (const double t : times) d.fine.push_back(distance(t));
    GrowingDistance growing;
    growing.add(d, 1.0);
    return growing.look(times);
  };
  const auto chaos = look([](double t) { return std::min(1.0, 1e-6 * std::exp(t / 0.6)); });
  ASSERT_TRUE(chaos);
  EXPECT_NEAR(chaos->grows_in, 0.6, 0.03);
  ASSERT_TRUE(chaos->lost_from);
  EXPECT_NEAR(*chaos->lost_from, 0.6 * std::log(1e5), 0.1) << "a tenth of the range";
  EXPECT_FALSE(look([](double t) { return 1e-6 * std::pow(t, 4); }));
  EXPECT_FALSE(look([](double t) { return t < 8.0 ? 1e-9 : 1e-3; }));
  EXPECT_FALSE(look([](double) { return 0.0; }));
}

}  // namespace
}  // namespace bough::run
