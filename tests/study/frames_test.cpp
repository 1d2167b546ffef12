// Accelerations in nested frames over an angle and over time.
#include "bough/study/frames.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <stdexcept>

#include "bough/laws/make_law.hpp"
#include "support/untrapped.hpp"

namespace bough::study {
namespace {

using io::Part;

double largest_difference(const motion::Vec3<double>& a, const motion::Vec3<double>& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

TEST(SplitDisc, without_speeds_is_the_example_of_the_source) {
  const io::SplitTable t = split_disc({});
  ASSERT_EQ(t.series.size(), 6u);
  EXPECT_EQ(t.series[5].parameters[0].second, 5.0);
  EXPECT_EQ(t.series[5].parameters[1].second, 0.0);
  for (const io::SplitSeries& s : t.series) {
    ASSERT_EQ(s.rows.size(), 361u);
    EXPECT_EQ(s.rows.front().at, 0.0);
    EXPECT_EQ(s.rows[90].at, 90.0);
    EXPECT_EQ(s.rows.back().at, 360.0);
    // |(phi' x psi') x r| = phi' psi' sin(tilt) |cos psi| r, a fixed axis (5, 0) included.
    const double spin = s.parameters[0].second, precession = s.parameters[1].second;
    for (const io::SplitRow& row : s.rows)
      EXPECT_NEAR(row.magnitude(Part::razi),
                  spin * precession * std::sqrt(0.5) * std::abs(std::cos(row.at * std::numbers::pi / 180.0)), 1e-14);
  }
}

/// The disc as a chain of laws: at equal angles the same parts.
TEST(SplitFrames, the_disc_as_a_chain_of_laws_is_the_disc) {
  const double tilt_deg = 30.0, spin = 2.0, precession = 3.0;
  const io::SplitTable disc = split_disc({{{spin, precession}}, tilt_deg, 1.5, 13});
  scene::FrameStudy study;
  study.frames.resize(2);
  study.frames[0].name = "shaft";
  study.frames[0].turns = {{{{0.0, 0.0, 1.0}}, laws::make_constant(precession).integral(0.0)}};
  study.frames[1].rotation = motion::exp_so3(motion::Vec3<double>{{0.0, tilt_deg * std::numbers::pi / 180.0, 0.0}});
  study.frames[1].turns = {{{{0.0, 0.0, 1.0}}, laws::make_constant(spin).integral(0.0)}};
  study.point_frame = 2;
  study.point[0] = laws::make_constant(1.5);
  study.in = 1;
  study.end_time = 2.0 * std::numbers::pi / spin;
  study.num_points = 13;
  const io::SplitTable chain = split_frames(study);
  EXPECT_EQ(chain.axes, "shaft");
  for (std::size_t k = 0; k < 13; ++k)
    for (const Part part : {Part::centripetal, Part::razi, Part::coriolis, Part::tangential, Part::origin, Part::total})
      EXPECT_LT(largest_difference(disc.series[0].rows[k][part], chain.series[0].rows[k][part]), 1e-13) << k;
}

/// Differences of eighth order of the positions of the chain itself.
TEST(SplitFrames, the_total_is_the_second_derivative_of_the_position) {
  scene::FrameStudy study;
  study.frames.resize(3);
  study.frames[0].position[1] = laws::make_harmonic(0.7, 2.0, 0.3);
  study.frames[0].turns = {{{{0.0, 0.0, 1.0}}, laws::make_expression("t + 0.4*t^2")}};
  study.frames[1].position[0] = laws::make_expression("0.5 + 0.1*sin(3*t)");
  study.frames[1].turns = {{{{1.0, 0.0, 0.0}}, laws::make_harmonic(0.8, 2.5)},
                           {{{0.0, 0.6, 0.8}}, laws::make_expression("1.5*t")}};
  study.frames[2].turns = {{{{0.0, 1.0, 0.0}}, laws::make_harmonic(1.2, 3.0, 1.0)}};
  study.point_frame = 3;
  study.point[0] = laws::make_expression("0.3 + 0.1*t");
  study.point[2] = laws::make_harmonic(0.2, 2.0);
  study.num_points = 5;
  const auto position = [&](double t) {
    motion::Frame<double> H = motion::Frame<double>::identity();
    for (const scene::MovingFrame& f : study.frames) H = motion::compose(H, scene::motion_at(f, t).pose);
    motion::Vec3<double> r;
    for (int k = 0; k < 3; ++k) r[k] = study.point[k].at(t).value;
    return motion::transform(H, r);
  };
  const double h = 0.02, weights[5] = {-205.0 / 72, 8.0 / 5, -1.0 / 5, 8.0 / 315, -1.0 / 560};
  const io::SplitTable split = split_frames(study);
  for (const io::SplitRow& row : split.series[0].rows) {
    motion::Vec3<double> second = (weights[0] / (h * h)) * position(row.at);
    for (int k = 1; k <= 4; ++k)
      second += (weights[k] / (h * h)) * (position(row.at + k * h) + position(row.at - k * h));
    // Truncation about h^8 w^10 r / 3150 with w of 6 rad/s, rounding 1e-16 / h^2: both near 1e-10.
    EXPECT_LT(largest_difference(second, row[Part::total]), 1e-9 * row.magnitude(Part::total)) << row.at;
  }
}

TEST(SplitFrames, a_law_that_is_not_finite_is_named_with_its_time) {
  const bough::test::Untrapped untrapped;
  scene::FrameStudy study;
  study.frames.resize(1);
  study.frames[0].name = "slide";
  study.frames[0].position[2] = laws::make_expression("1/(t-0.5)");
  study.num_points = 3;
  try {
    (void)split_frames(study);
    ADD_FAILURE() << "no error";
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("position z of frame \"slide\""), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("t = 0.5 s"), std::string::npos) << error.what();
  }
}

TEST(SplitFrames, what_is_too_large_for_a_double_is_an_error) {
  const bough::test::Untrapped untrapped;
  EXPECT_THROW((void)split_disc({{{1e200, 1e200}}, 45.0, 1.0, 3}), std::runtime_error);
}

}  // namespace
}  // namespace bough::study
