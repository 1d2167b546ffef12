// Laws of the group, the motion tensor and the vector products of motions; quaternions; compensated positions.
#include "bough/motion/group.hpp"

#include <gtest/gtest.h>

#include "bough/motion/compensated.hpp"
#include "samples.hpp"

namespace bough::motion {
namespace {

using test::largest;
// Sums of at most six products of numbers of order 1 to 10, a few of them in a row.
constexpr double round_off = 64 * test::epsilon;

double distance(const Frame<double>& a, const Frame<double>& b) {
  return std::fmax(largest(a.R - b.R), largest(a.x - b.x));
}

TEST(Group, frames_satisfy_the_group_axioms) {
  test::Random random(21);
  for (int i = 0; i < 50; ++i) {
    const Frame<double> a = random.frame(), b = random.frame(), c = random.frame(), e = Frame<double>::identity();
    EXPECT_LT(distance(compose(compose(a, b), c), compose(a, compose(b, c))), round_off);
    EXPECT_EQ(distance(compose(a, e), a), 0.0);
    EXPECT_EQ(distance(compose(e, a), a), 0.0);
    EXPECT_LT(distance(compose(a, inverse(a)), e), round_off);
    EXPECT_LT(distance(compose(inverse(a), a), e), round_off);
    EXPECT_LT(distance(relative(a, b), compose(inverse(a), b)), round_off);
    const Vec3<double> p = random.vector<3>();
    EXPECT_LT(largest(transform(compose(a, b), p) - transform(a, transform(b, p))), round_off);
  }
}

TEST(Group, a_rigid_motion_of_both_frames_does_not_change_their_relative_pose) {
  test::Random random(22);
  for (int i = 0; i < 50; ++i) {
    const Frame<double> a = random.frame(), b = random.frame(), move = random.frame();
    EXPECT_LT(distance(relative(compose(move, a), compose(move, b)), relative(a, b)), round_off);
  }
}

TEST(Group, the_motion_tensor_is_a_homomorphism_with_the_stated_inverse) {
  test::Random random(23);
  for (int i = 0; i < 50; ++i) {
    const Frame<double> a = random.frame(), b = random.frame();
    EXPECT_LT(largest(adjoint(compose(a, b)) - adjoint(a) * adjoint(b)), round_off);
    EXPECT_LT(largest(adjoint(a) * inverse_adjoint(a) - Mat6<double>::identity()), round_off);
    EXPECT_LT(largest(inverse_adjoint(a) - adjoint(inverse(a))), round_off);
  }
}

TEST(Group, products_with_the_motion_tensor_equal_the_matrix_products) {
  test::Random random(24);
  for (int i = 0; i < 50; ++i) {
    const Frame<double> H = random.frame();
    const Vec6<double> v = random.vector<6>();
    const Mat6<double> C = adjoint(H), inv = inverse_adjoint(H);
    EXPECT_LT(largest(adjoint_times(H, v) - C * v), round_off);
    EXPECT_LT(largest(inverse_adjoint_times(H, v) - inv * v), round_off);
    EXPECT_LT(largest(adjoint_transpose_times(H, v) - transpose(C) * v), round_off);
    EXPECT_LT(largest(inverse_adjoint_transpose_times(H, v) - transpose(inv) * v), round_off);
  }
}

// ~V* = C^-1 ~V C [1.62], C exp(ad) relation: Ad(exp d) = exp(ad d) seen through H exp(eta) H^-1 = exp(Ad(H) eta).
TEST(Group, conjugation_of_an_exponential_is_the_exponential_of_the_adjoint) {
  test::Random random(25);
  for (int i = 0; i < 50; ++i) {
    const Frame<double> H = random.frame();
    const Vec6<double> eta = random.vector<6>();
    EXPECT_LT(distance(compose(compose(H, exp_se3(eta)), inverse(H)), exp_se3(adjoint_times(H, eta))), round_off);
    const Mat6<double> left = cross6(inverse_adjoint_times(H, eta));
    EXPECT_LT(largest(left - inverse_adjoint(H) * cross6(eta) * adjoint(H)), round_off);
  }
}

// ~V P = -~P V [1.39]; ~V^T P = ^P V [1.40]; Jacobi; ~N~N~N + Z(2 lambda, 1) ~N = 0 for a unit axis [1.38].
TEST(Group, generalized_vector_products_satisfy_their_identities) {
  test::Random random(26);
  for (int i = 0; i < 50; ++i) {
    const Vec6<double> v = random.vector<6>(), p = random.vector<6>(), w = random.vector<6>();
    EXPECT_LT(largest(cross6(v) * p + cross6(p) * v), round_off);
    EXPECT_LT(largest(cross6_times(v, p) - cross6(v) * p), round_off);
    EXPECT_LT(largest(cross6_transpose_times(v, p) - transpose(cross6(v)) * p), round_off);
    EXPECT_LT(largest(hat6(p) * v - transpose(cross6(v)) * p), round_off);
    const Vec6<double> jacobi =
        cross6_times(v, cross6_times(p, w)) + cross6_times(p, cross6_times(w, v)) + cross6_times(w, cross6_times(v, p));
    EXPECT_LT(largest(jacobi), round_off);
    const Vec3<double> n = random.unit(), m = random.vector<3>();
    const Mat6<double> N = cross6(lanes::join(m, n));
    Mat6<double> Z = Mat6<double>::identity();
    for (int k = 0; k < 3; ++k) Z(k, k + 3) = 2.0 * dot(n, m);
    EXPECT_LT(largest(N * N * N + Z * N), round_off);
  }
}

// T(d)^-T acts on wrenches as T(-d)^-T does after the transport: Ad(exp d) = T(-d) T(d)^-1.
TEST(Group, the_tangent_operators_of_both_ends_differ_by_the_motion_tensor) {
  test::Random random(27);
  for (const double phi : test::angles_up_to_pi()) {
    const Vec6<double> d = random.motion(phi);
    const Vec6<double> minus = -d;
    EXPECT_LT(largest(tangent(minus) - adjoint(exp_se3(d)) * tangent(d)), round_off) << "phi = " << phi;
  }
}

TEST(Quaternions, compose_as_rotations_do) {
  test::Random random(31);
  for (int i = 0; i < 50; ++i) {
    const Quaternion<double> p = exp_quaternion(random.vector<3>()), q = exp_quaternion(4.0 * random.vector<3>());
    EXPECT_LT(largest(rotation_of(multiply(p, q)) - rotation_of(p) * rotation_of(q)), round_off);
    EXPECT_LT(largest(rotation_of(multiply(p, conjugate(p))) - Mat3<double>::identity()), round_off);
    EXPECT_LT(largest(rotation_of(multiply(Quaternion<double>::identity(), q)) - rotation_of(q)), round_off);
  }
}

TEST(Quaternions, give_the_rotation_of_their_vector_and_return_from_it_at_all_angles) {
  test::Random random(32);
  for (const double phi : test::angles_beyond_pi()) {
    const Vec3<double> psi = phi * random.unit();
    const Quaternion<double> q = exp_quaternion(psi);
    EXPECT_LT(largest(rotation_of(q) - exp_so3(psi)), round_off) << "phi = " << phi;
    const Quaternion<double> back = quaternion_of(rotation_of(q));
    const double sign = q.w * back.w + dot(q.v, back.v) < 0.0 ? -1.0 : 1.0;  // at pi either sign is right
    EXPECT_GE(back.w, 0.0);
    EXPECT_NEAR(back.w, sign * q.w, round_off) << "phi = " << phi;
    EXPECT_LT(largest(back.v - sign * q.v), round_off) << "phi = " << phi;
  }
}

TEST(Quaternions, normalising_removes_a_drift_of_the_norm_and_keeps_the_rotation) {
  const Quaternion<double> q = exp_quaternion(Vec3<double>{{0.3, -1.0, 0.7}});
  const Quaternion<double> drifted{1.001 * q.w, 1.001 * q.v}, r = normalise(drifted);
  EXPECT_NEAR(r.w * r.w + dot(r.v, r.v), 1.0, 4 * test::epsilon);
  EXPECT_LT(largest(rotation_of(r) - rotation_of(q)), round_off);
}

// At 3e6 m a double resolves 5e-10 m: steps of 1e-12 m vanish in it, and all arrive in the pair.
TEST(Compensated, a_million_tiny_steps_far_from_the_origin_are_not_lost) {
  const Vec3<double> start{{1e6, -2e6, 3e6}}, step{{1e-12, 2e-12, -3e-12}};
  Vec3Pair p = Vec3Pair::from(start);
  const int steps = 1000000;
  for (int i = 0; i < steps; ++i) p.add(step);
  const Vec3<double> moved = difference(p, Vec3Pair::from(start));
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(moved[i], steps * step[i], 1e-12 * steps * std::abs(step[i]));
  EXPECT_EQ(largest(start + step - start), 0.0) << "the step is below the resolution of one double";
}

TEST(Compensated, relative_pose_does_not_depend_on_the_distance_to_the_origin) {
  test::Random random(33);
  for (int i = 0; i < 20; ++i) {
    const Vec6<double> eta_a = random.motion(0.3), eta_b = random.motion(0.2);
    const Mat3<double> R = random.frame().R;
    PreciseFrame<double> near = PreciseFrame<double>::from({R, Vec3<double>::zero()});
    PreciseFrame<double> far = PreciseFrame<double>::from({R, Vec3<double>{{2e5, -1e5, 3e5}}});
    const Frame<double> at_origin = relative(moved(near, eta_a), moved(near, eta_b));
    const Frame<double> far_away = relative(moved(far, eta_a), moved(far, eta_b));
    EXPECT_LT(distance(at_origin, far_away), 4 * test::epsilon);
    EXPECT_LT(distance(at_origin, relative(moved(near, eta_a).rounded(), moved(near, eta_b).rounded())), round_off);
  }
}

}  // namespace
}  // namespace bough::motion
