// Exponential, logarithm and tangent operators against their defining matrix power series at 60 digits, angle by angle.
#include <gtest/gtest.h>

#include <boost/multiprecision/cpp_bin_float.hpp>

#include "bough/lanes/jet.hpp"
#include "bough/lanes/pack.hpp"
#include "bough/motion/group.hpp"
#include "samples.hpp"

namespace bough::motion {
namespace {

using Real = boost::multiprecision::number<boost::multiprecision::cpp_bin_float<60>, boost::multiprecision::et_off>;
template <int N>
using Matrix = lanes::Mat<Real, N, N>;

/// sum_k A^k (-1)^(k s) / (k + s)!: exp(A) for s = 0, the tangent operator of ad = A for s = 1.
template <int N>
Matrix<N> power_series(const Matrix<N>& A, int s) {
  Matrix<N> sum = Matrix<N>::identity(), term = sum;
  for (int k = 1; k < 90; ++k) {
    term = Real(Real(s ? -1 : 1) / (k + s)) * (term * A);
    sum += term;
  }
  return sum;
}
Matrix<4> generator(const Vec6<double>& d) {
  Matrix<4> A = Matrix<4>::zero();
  const Mat3<double> w = skew(angular_part(d));
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) A(i, j) = w(i, j);
    A(i, 3) = d[i];
  }
  return A;
}
template <int R, int C>
double error(const lanes::Mat<double, R, C>& a, const lanes::Mat<Real, R, C>& exact) {
  lanes::Mat<double, R, C> difference;
  for (int i = 0; i < R * C; ++i) difference.m[i] = static_cast<double>(a.m[i] - exact.m[i]);
  return test::largest(difference);
}

// Entries are at most 1 in R and 2 in x: 8 epsilon leaves 4 roundings each.
TEST(Maps, exponential_matches_the_matrix_series_at_all_angles) {
  test::Random random(1);
  for (const double phi : test::angles_beyond_pi()) {
    const Vec6<double> d = random.motion(phi);
    const Matrix<4> exact = power_series(generator(d), 0);
    const Frame<double> H = exp_se3(d);
    for (int i = 0; i < 3; ++i) {
      EXPECT_NEAR(H.x[i], static_cast<double>(exact(i, 3)), 8 * test::epsilon) << "phi = " << phi;
      for (int j = 0; j < 3; ++j)
        EXPECT_NEAR(H.R(i, j), static_cast<double>(exact(i, j)), 8 * test::epsilon) << "phi = " << phi;
    }
  }
}

// The exact motion is rounded to double before the logarithm sees it: that rounding alone moves psi by 1 epsilon.
// The linear part is T^-T x, whose norm grows to pi/2 |x| at phi = pi.
TEST(Maps, logarithm_returns_the_motion_vector_to_round_off_up_to_pi) {
  test::Random random(2);
  for (const double phi : test::angles_up_to_pi()) {
    for (int repeat = 0; repeat < 5; ++repeat) {
      const Vec6<double> d = random.motion(phi);
      const Matrix<4> exact = power_series(generator(d), 0);
      Frame<double> H;
      for (int i = 0; i < 3; ++i) {
        H.x[i] = static_cast<double>(exact(i, 3));
        for (int j = 0; j < 3; ++j) H.R(i, j) = static_cast<double>(exact(i, j));
      }
      EXPECT_LT(test::largest(log_se3(H) - d), 16 * test::epsilon) << "phi = " << phi;
    }
  }
}

// R of a small rotation holds psi to a relative epsilon, and so does the logarithm.
TEST(Maps, logarithm_keeps_relative_accuracy_of_small_rotations) {
  test::Random random(3);
  for (const double phi : test::angles_up_to_pi()) {
    if (phi > 0.5) break;
    const Vec3<double> psi = phi * random.unit();
    EXPECT_LE(test::largest(log_so3(exp_so3(psi)) - psi), 8 * test::epsilon * phi) << "phi = " << phi;
  }
}

TEST(Maps, logarithm_beyond_pi_returns_the_shorter_rotation) {
  test::Random random(4);
  for (const double phi : {3.2, 3.5, 4.0, 5.0, 6.0, 6.28}) {
    const Vec3<double> n = random.unit();
    const Vec3<double> shorter = (phi - 2.0 * std::numbers::pi) * n;
    EXPECT_LT(test::largest(log_so3(exp_so3(phi * n)) - shorter), 16 * test::epsilon) << "phi = " << phi;
  }
}

TEST(Maps, logarithm_at_exactly_pi_is_one_of_the_two_rotation_vectors) {
  for (int axis = 0; axis < 3; ++axis) {
    Mat3<double> R = -1.0 * Mat3<double>::identity();
    R(axis, axis) = 1.0;
    const Vec3<double> psi = log_so3(R);
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(std::abs(psi[i]), i == axis ? std::numbers::pi : 0.0, 2 * test::epsilon);
  }
}

// Entries of T grow with |u| phi: 16 epsilon.
TEST(Maps, tangent_operator_matches_its_series_at_all_angles) {
  test::Random random(5);
  for (const double phi : test::angles_beyond_pi()) {
    const Vec6<double> d = random.motion(phi);
    const Matrix<6> exact = power_series(lanes::cast<Real>(cross6(d)), 1);
    EXPECT_LT(error(tangent(d), exact), 16 * test::epsilon) << "phi = " << phi;
    Matrix<3> exact3;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) exact3(i, j) = exact(i, j);
    EXPECT_LT(error(tangent_so3(angular_part(d)), exact3), 16 * test::epsilon) << "phi = " << phi;
  }
}

// T^-1 has a pole at 2 pi: its entries scale the error.
TEST(Maps, inverse_tangent_times_the_tangent_series_is_the_identity) {
  test::Random random(6);
  for (const double phi : test::angles_beyond_pi()) {
    const Vec6<double> d = random.motion(phi);
    const Matrix<6> exact = power_series(lanes::cast<Real>(cross6(d)), 1);
    const Mat6<double> inverse = inverse_tangent(d);
    const Matrix<6> product = lanes::cast<Real>(inverse) * exact;
    const double room = 1.0 + test::largest(inverse);
    EXPECT_LT(error(Mat6<double>::identity(), product), 16 * test::epsilon * room) << "phi = " << phi;
    const Mat3<double> product3 = inverse_tangent_so3(angular_part(d)) * tangent_so3(angular_part(d));
    EXPECT_LT(test::largest(product3 - Mat3<double>::identity()), 16 * test::epsilon * room) << "phi = " << phi;
  }
}

TEST(Maps, products_without_matrices_equal_the_matrix_products) {
  test::Random random(7);
  for (const double phi : test::angles_beyond_pi()) {
    const Vec6<double> d = random.motion(phi), a = random.vector<6>();
    const Mat6<double> T = tangent(d), inv = inverse_tangent(d);
    const double bound = 32 * test::epsilon * (1.0 + test::largest(inv));
    EXPECT_LT(test::largest(tangent_times(d, a) - T * a), bound);
    EXPECT_LT(test::largest(tangent_transpose_times(d, a) - transpose(T) * a), bound);
    EXPECT_LT(test::largest(inverse_tangent_times(d, a) - inv * a), bound);
    EXPECT_LT(test::largest(inverse_tangent_transpose_times(d, a) - transpose(inv) * a), bound);
    const Vec3<double> psi = angular_part(d), v = linear_part(a);
    EXPECT_LT(test::largest(tangent_so3_times(psi, v) - tangent_so3(psi) * v), bound);
    EXPECT_LT(test::largest(tangent_so3_transpose_times(psi, v) - transpose(tangent_so3(psi)) * v), bound);
    EXPECT_LT(test::largest(inverse_tangent_so3_times(psi, v) - inverse_tangent_so3(psi) * v), bound);
    EXPECT_LT(test::largest(inverse_tangent_so3_transpose_times(psi, v) - transpose(inverse_tangent_so3(psi)) * v),
              bound);
  }
}

// Bits, not tolerances: a lane computes what a double computes, also where its neighbours take the other branch.
TEST(Maps, every_lane_of_a_pack_gives_the_bits_of_the_double) {
  using P = lanes::Pack<8>;
  const double angles[8] = {0.0, 1e-16, 1e-5, 0.3, 1.0, 3.1, 4.5, 6.0};
  test::Random random(8);
  Vec6<double> d[8], n[8];
  Vec6<P> dp, np;
  for (int lane = 0; lane < 8; ++lane) {
    d[lane] = random.motion(angles[lane]);
    n[lane] = random.vector<6>();
    set_lane(dp, lane, d[lane]);
    set_lane(np, lane, n[lane]);
  }
  const Frame<P> H = exp_se3(dp);
  const Vec6<P> back = log_se3(H), force = inverse_tangent_transpose_times(dp, np);
  const Mat6<P> G = inverse_tangent_transpose_derivative(dp, np), T = tangent(dp);
  for (int lane = 0; lane < 8; ++lane) {
    const Frame<double> h = exp_se3(d[lane]);
    EXPECT_EQ(test::largest(get_lane(H.R, lane) - h.R), 0.0) << lane;
    EXPECT_EQ(test::largest(get_lane(H.x, lane) - h.x), 0.0) << lane;
    EXPECT_EQ(test::largest(get_lane(back, lane) - log_se3(h)), 0.0) << lane;
    EXPECT_EQ(test::largest(get_lane(force, lane) - inverse_tangent_transpose_times(d[lane], n[lane])), 0.0) << lane;
    EXPECT_EQ(test::largest(get_lane(G, lane) - inverse_tangent_transpose_derivative(d[lane], n[lane])), 0.0) << lane;
    EXPECT_EQ(test::largest(get_lane(T, lane) - tangent(d[lane])), 0.0) << lane;
  }
}

TEST(Maps, a_frame_in_long_double_returns_through_log_to_long_double_round_off) {
  const Vec6<long double> d = lanes::cast<long double>(test::Random(9).motion(2.0));
  const Vec6<long double> e = log_se3(exp_se3(d)) - d;
  for (int i = 0; i < 6; ++i) EXPECT_LT(std::abs(e[i]), 32 * std::numeric_limits<long double>::epsilon());
}

}  // namespace
}  // namespace bough::motion
