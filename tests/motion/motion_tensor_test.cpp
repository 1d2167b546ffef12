// The Mozzi-Chasles screw of a motion: eq. numbers are those of data/manual/theory/motions.md.
#include "bough/motion/motion_tensor.hpp"

#include <gtest/gtest.h>

#include "samples.hpp"

namespace bough::motion {
namespace {

using test::largest;
constexpr double round_off = 64 * test::epsilon;

Frame<double> frame_with_angle(test::Random& random, double phi) {
  return {exp_so3(phi * random.unit()), random.vector<3>()};
}
// The axis of a small rotation is u/phi away; its moment is of that order and so are its errors.
std::vector<double> screw_angles() {
  std::vector<double> a = test::angles_up_to_pi();
  a.erase(a.begin());
  return a;
}

TEST(MotionTensor, intrinsic_motion_and_back_is_the_same_motion_at_all_angles) {
  test::Random random(41);
  for (const double phi : test::angles_up_to_pi()) {
    const Frame<double> H = frame_with_angle(random, phi);
    const IntrinsicMotion m = intrinsic_motion(H);
    const Frame<double> back = frame_of(m);
    EXPECT_LT(largest(back.R - H.R), round_off) << "phi = " << phi;
    EXPECT_LT(largest(back.x - H.x), round_off) << "phi = " << phi;
    EXPECT_NEAR(m.phi, phi, 16 * test::epsilon * (1.0 + phi));
    EXPECT_NEAR(dot(m.n, m.n), 1.0, 8 * test::epsilon);
    EXPECT_LE(std::abs(dot(m.n, m.w)), round_off * (1.0 + largest(m.w))) << "phi = " << phi;
  }
}

TEST(MotionTensor, every_point_of_the_axis_moves_along_it_by_the_intrinsic_displacement) {
  test::Random random(42);
  for (const double phi : screw_angles()) {
    const Frame<double> H = frame_with_angle(random, phi);
    const IntrinsicMotion m = intrinsic_motion(H);
    const Vec3<double> point = nearest_axis_point(m) + random.number() * m.n;
    // The point may be u/phi away: its displacement from the frame carries that magnitude times epsilon times phi.
    EXPECT_LT(largest(displacement_at(m, point) - m.d * m.n), round_off) << "phi = " << phi;
    EXPECT_NEAR(dot(nearest_axis_point(m), m.n), 0.0, round_off * (1.0 + largest(m.w)));
  }
}

TEST(MotionTensor, displacement_of_a_point_is_that_of_the_frame) {
  test::Random random(43);
  for (const double phi : test::angles_up_to_pi()) {
    const Frame<double> H = frame_with_angle(random, phi);
    const Vec3<double> r = random.vector<3>();
    EXPECT_LT(largest(displacement_at(intrinsic_motion(H), r) - (transform(H, r) - r)), round_off) << phi;
  }
}

// All points at distance rho of the axis move by sqrt(d^2 + (2 rho sin(phi/2))^2) [example 1.1].
TEST(MotionTensor, points_of_a_cylinder_about_the_axis_all_move_by_the_same_distance) {
  test::Random random(44);
  const Frame<double> H = frame_with_angle(random, 1.3);
  const IntrinsicMotion m = intrinsic_motion(H);
  const double rho = 2.5;
  for (int i = 0; i < 20; ++i) {
    const Vec3<double> across = cross(m.n, random.unit());
    const Vec3<double> r =
        nearest_axis_point(m) + random.number() * m.n + (rho / std::sqrt(dot(across, across))) * across;
    const Vec3<double> u = displacement_at(m, r);
    EXPECT_NEAR(std::sqrt(dot(u, u)), std::hypot(m.d, 2.0 * rho * std::sin(0.5 * m.phi)), round_off);
  }
}

TEST(MotionTensor, the_axis_is_the_same_line_seen_from_any_reference_point) {
  test::Random random(45);
  for (int i = 0; i < 20; ++i) {
    const Frame<double> H = frame_with_angle(random, 0.9);
    // Reference point moved to p: H seen in axes through p.
    const Frame<double> shift{Mat3<double>::identity(), random.vector<3>()};
    const Frame<double> seen = compose(compose(inverse(shift), H), shift);
    const IntrinsicMotion a = intrinsic_motion(H), b = intrinsic_motion(seen);
    EXPECT_NEAR(a.d, b.d, round_off);
    EXPECT_LT(largest(mozzi_chasles_axis(a) - adjoint_times(shift, mozzi_chasles_axis(b))), round_off);
  }
}

TEST(MotionTensor, screw_vectors_are_unit_eigenvectors_of_the_motion_tensor_for_any_alpha) {
  test::Random random(46);
  for (const double phi : {0.1, 1.0, 2.0, 3.0}) {
    const Frame<double> H = frame_with_angle(random, phi);
    const IntrinsicMotion m = intrinsic_motion(H);
    for (const double alpha : {0.0, 0.5, 1.0, -2.0}) {
      const Vec6<double> N = screw_vector(m, alpha);
      EXPECT_LT(largest(adjoint_times(H, N) - N), round_off * largest(N)) << "phi = " << phi;
      EXPECT_LT(largest(cross6(N) * N), round_off * largest(N) * largest(N));
    }
    EXPECT_LT(largest(screw_vector(m, 0.0) - mozzi_chasles_axis(m)), test::epsilon);
  }
}

TEST(MotionTensor, the_intrinsic_form_is_the_adjoint_for_any_alpha) {
  test::Random random(47);
  for (const double phi : {0.1, 1.0, 2.0, 3.0}) {
    const Frame<double> H = frame_with_angle(random, phi);
    const IntrinsicMotion m = intrinsic_motion(H);
    for (const double alpha : {0.0, 0.5, 1.0, -2.0})
      EXPECT_LT(largest(motion_tensor(m, alpha) - adjoint(H)), 16 * round_off * (1.0 + largest(screw_vector(m, alpha))))
          << "phi = " << phi << ", alpha = " << alpha;
  }
}

TEST(MotionTensor, a_translation_is_told_as_such_and_has_an_infinite_pitch) {
  const Frame<double> H{Mat3<double>::identity(), Vec3<double>{{3.0, 0.0, -4.0}}};
  const IntrinsicMotion m = intrinsic_motion(H);
  EXPECT_EQ(m.kind, MotionKind::translation);
  EXPECT_EQ(m.d, 5.0);
  EXPECT_EQ(m.phi, 0.0);
  EXPECT_NEAR(m.n[0], 0.6, test::epsilon);
  EXPECT_NEAR(m.n[2], -0.8, test::epsilon);
  EXPECT_EQ(largest(m.w), 0.0);
  EXPECT_TRUE(std::isinf(pitch(m)));
  EXPECT_LT(largest(frame_of(m).x - H.x), 4 * test::epsilon);
}

TEST(MotionTensor, no_motion_has_no_axis) {
  const IntrinsicMotion m = intrinsic_motion(Frame<double>::identity());
  EXPECT_EQ(m.kind, MotionKind::none);
  EXPECT_EQ(largest(mozzi_chasles_axis(m)), 0.0);
  EXPECT_EQ(pitch(m), 0.0);
  EXPECT_EQ(largest(frame_of(m).R - Mat3<double>::identity()), 0.0);
}

TEST(MotionTensor, rounding_of_a_rotation_counts_as_translation_when_the_caller_says_so) {
  Frame<double> H{exp_so3(Vec3<double>{{1e-15, 0.0, 0.0}}), Vec3<double>{{0.0, 1.0, 0.0}}};
  EXPECT_EQ(intrinsic_motion(H).kind, MotionKind::screw);
  EXPECT_EQ(intrinsic_motion(H, 1e-14).kind, MotionKind::translation);
}

TEST(MotionTensor, pitch_of_a_threaded_motion_is_its_advance_in_one_turn) {
  const double thread = 1.5e-3, turns = 0.4;
  const Vec3<double> n{{0.0, 0.6, 0.8}};
  const Frame<double> H{exp_so3(2.0 * std::numbers::pi * turns * n), thread * turns * n};
  EXPECT_NEAR(pitch(intrinsic_motion(H)), thread, round_off * thread);
}

// The screw of a velocity is the screw of the motion it makes in a short time, and its axis does not move.
TEST(MotionTensor, screw_axis_of_a_velocity_is_the_axis_of_its_exponential) {
  test::Random random(48);
  for (int i = 0; i < 20; ++i) {
    const Vec6<double> V = random.vector<6>();
    const VelocityScrew s = velocity_screw(V);
    const IntrinsicMotion m = intrinsic_motion(exp_se3(V));
    EXPECT_EQ(s.kind, MotionKind::screw);
    EXPECT_NEAR(s.angular_speed, m.phi, round_off);
    EXPECT_NEAR(s.sliding_speed, m.d, round_off * (1.0 + 1.0 / m.phi));
    EXPECT_LT(largest(s.axis - mozzi_chasles_axis(m)), round_off * (1.0 + 1.0 / (m.phi * m.phi)));
  }
}

TEST(MotionTensor, velocities_without_rotation_are_decided) {
  const VelocityScrew sliding = velocity_screw(Vec6<double>{{0.0, 2.0, 0.0, 0.0, 0.0, 0.0}});
  EXPECT_EQ(sliding.kind, MotionKind::translation);
  EXPECT_EQ(sliding.sliding_speed, 2.0);
  EXPECT_EQ(sliding.axis[4], 1.0);
  EXPECT_EQ(velocity_screw(Vec6<double>::zero()).kind, MotionKind::none);
}

}  // namespace
}  // namespace bough::motion
