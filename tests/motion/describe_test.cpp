// The report of a motion: its parts agree with each other by the laws that tie them, and every limit is decided.
#include "bough/motion/describe.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

#include "bough/motion/composition.hpp"
#include "bough/motion/parameterization.hpp"
#include "samples.hpp"

namespace bough::motion {
namespace {

using test::largest;
constexpr double round_off = 32 * test::epsilon;  // of displacements of order 1 and of rotations

void expect_finite(const MotionReport& r) {
  double sum = r.angle + r.rotation_defect + r.quaternion.w + r.intrinsic.d + r.intrinsic.phi + r.pitch.value_or(0.0);
  const auto add = [&sum](const auto& a) { sum += largest(a); };
  for (const auto& a : {r.rotation_vector, r.quaternion.v, r.intrinsic.w, r.intrinsic.n}) add(a);
  if (r.axis) add(*r.axis);
  if (r.axis_point) add(*r.axis_point);
  if (r.axis_line) add(*r.axis_line);
  for (const ParameterReport& p : r.parameters) {
    if (p.rotation) add(*p.rotation);
    if (p.motion) add(*p.motion);
  }
  add(r.half_angle);
  add(r.motion_tensor);
  add(r.inverse_motion_tensor);
  EXPECT_TRUE(std::isfinite(sum));
}

TEST(Describe, every_representation_gives_the_motion_back_at_all_angles) {
  test::Random random(61);
  for (const double phi : test::angles_beyond_pi())
    for (int repeat = 0; repeat < 20; ++repeat) {
      SCOPED_TRACE(phi);
      const Frame<double> H{exp_so3(phi * random.unit()), random.vector<3>()};
      const MotionReport r = describe_motion(H);
      expect_finite(r);
      const auto expect_same = [&H](const Frame<double>& G) {
        EXPECT_LT(largest(G.R - H.R), round_off);
        EXPECT_LT(largest(G.x - H.x), round_off);
      };
      expect_same(exp_se3(r.exponential_coordinates));
      expect_same(frame_of(r.intrinsic));
      expect_same(ExponentialMap::motion(*r.parameters[0].motion));
      expect_same(WienerMilenkovicMap::motion(*r.parameters[2].motion));
      EXPECT_LT(largest(exp_so3(r.rotation_vector) - H.R), round_off);
      EXPECT_LT(largest(rotation_of(r.quaternion) - H.R), round_off);
      EXPECT_LT(largest(r.half_angle * r.half_angle - H.R), round_off);
      EXPECT_LT(largest(r.motion_tensor * r.inverse_motion_tensor - Mat6<double>::identity()), round_off);
      for (const ParameterReport& p : r.parameters) {
        ASSERT_EQ(p.rotation.has_value(), p.motion.has_value()) << p.name;
        if (!p.motion) continue;  // Cayley's end at half a turn
        for (int i = 0; i < 3; ++i) EXPECT_EQ((*p.rotation)[i], (*p.motion)[i + 3]);
      }
      if (r.axis_line) {
        const double far = 1.0 + largest(*r.axis_line);
        EXPECT_LT(largest(r.motion_tensor * *r.axis_line - *r.axis_line), round_off * far);
        EXPECT_LT(largest(r.motion_tensor * *r.second_eigenvector - *r.second_eigenvector),
                  round_off * (1.0 + largest(*r.second_eigenvector)));
        EXPECT_LT(largest(point_displacement(H, *r.axis_point) - r.intrinsic.d * r.intrinsic.n), round_off * far);
      }
    }
}

TEST(Describe, cayley_parameters_end_at_pi_and_only_there) {
  test::Random random(62);
  for (const double phi : test::angles_up_to_pi()) {
    const Frame<double> H{exp_so3(phi * random.unit()), random.vector<3>()};
    const MotionReport r = describe_motion(H);
    ASSERT_TRUE(r.parameters[1].motion.has_value());
    const Frame<double> back = CayleyMap::motion(*r.parameters[1].motion);
    EXPECT_LT(largest(back.R - H.R), round_off) << phi;
    // u = T^-T x grows as p^2, and its product with T^T undoes it.
    EXPECT_LT(largest(back.x - H.x), round_off * (1.0 + largest(*r.parameters[1].rotation))) << phi;
  }
  Mat3<double> half_turn = -1.0 * Mat3<double>::identity();
  half_turn(1, 1) = 1.0;
  const MotionReport r = describe_motion({half_turn, {{1.0, 2.0, 3.0}}});
  expect_finite(r);
  EXPECT_FALSE(r.parameters[1].rotation.has_value());
  EXPECT_FALSE(r.parameters[1].motion.has_value());
  EXPECT_NEAR(r.angle, std::numbers::pi, 4 * test::epsilon);
  EXPECT_NEAR(r.intrinsic.d * r.intrinsic.n[1], 2.0, round_off);
}

TEST(Describe, a_translation_has_no_rotation_axis_no_pitch_and_no_axis_line) {
  const MotionReport r = describe_motion({Mat3<double>::identity(), {{0.0, 3.0, 4.0}}});
  expect_finite(r);
  EXPECT_EQ(r.intrinsic.kind, MotionKind::translation);
  EXPECT_EQ(r.intrinsic.d, 5.0);
  EXPECT_FALSE(r.axis || r.pitch || r.axis_point || r.axis_line || r.second_eigenvector);
  EXPECT_NEAR((*r.first_eigenvector)[2], 0.8, test::epsilon);
  for (const ParameterReport& p : r.parameters) EXPECT_EQ((*p.motion)[1], 3.0) << p.name;
}

TEST(Describe, no_motion_is_the_identity_of_everything) {
  const MotionReport r = describe_motion(Frame<double>::identity());
  expect_finite(r);
  EXPECT_EQ(r.intrinsic.kind, MotionKind::none);
  EXPECT_FALSE(r.axis || r.pitch || r.axis_line || r.first_eigenvector || r.second_eigenvector);
  EXPECT_EQ(r.angle, 0.0);
  EXPECT_EQ(largest(r.exponential_coordinates), 0.0);
}

TEST(Describe, relative_motions_do_what_they_say) {
  test::Random random(63);
  for (int i = 0; i < 200; ++i) {
    const Frame<double> k = random.frame(), l = random.frame();
    const Frame<double> carried = describe_relative_motion(k, l, SeenFrom::inertial).motion;
    const Frame<double> moving = describe_relative_motion(k, l, SeenFrom::first).motion;
    EXPECT_LT(largest(compose(carried, k).x - l.x), round_off);
    EXPECT_LT(largest(compose(carried, k).R - l.R), round_off);
    EXPECT_LT(largest(compose(k, moving).x - l.x), round_off);
    EXPECT_LT(largest(compose(k, moving).R - l.R), round_off);
  }
  // Two frames of the same attitude: the product of their rotations is the identity up to rounding.
  const Frame<double> k = random.frame();
  const Frame<double> l{k.R, k.x + Vec3<double>{{1.0, 0.0, 0.0}}};
  EXPECT_EQ(describe_relative_motion(k, l, SeenFrom::first).intrinsic.kind, MotionKind::translation);
  EXPECT_EQ(describe_relative_motion(k, l, SeenFrom::inertial).intrinsic.kind, MotionKind::translation);
}

TEST(Describe, what_is_not_a_motion_is_refused_with_its_reason) {
  Frame<double> H = Frame<double>::identity();
  H.R(0, 0) = -1.0;
  EXPECT_THROW(describe_motion(H), std::invalid_argument) << "a reflection";
  H.R(0, 0) = 1.1;
  EXPECT_THROW(describe_motion(H), std::invalid_argument) << "not orthonormal";
  H.R(0, 0) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(describe_motion(H), std::invalid_argument);
  H = Frame<double>::identity();
  H.x[1] = std::numeric_limits<double>::infinity();
  EXPECT_THROW(describe_motion(H), std::invalid_argument);
  EXPECT_THROW(describe_relative_motion(Frame<double>::identity(), H, SeenFrom::first), std::invalid_argument);
}

}  // namespace
}  // namespace bough::motion
