// Closed-form derivatives against the complex step, and derivative types through phi = 0.
#include <gtest/gtest.h>

#include "bough/lanes/jet.hpp"
#include "bough/lanes/taylor.hpp"
#include "bough/motion/group.hpp"
#include "samples.hpp"

namespace bough::motion {
namespace {

using Complex = std::complex<double>;

/// Checks the 6x6 matrix `closed(d, a)` against the derivative of `function(d, a)` by d, at all angles. Near 2 pi the
/// inverse has a pole, so the bound grows with the matrix.
template <class Closed, class Function>
void expect_derivative(const Closed& closed, const Function& function, unsigned seed) {
  test::Random random(seed);
  for (const double phi : test::angles_beyond_pi()) {
    const Vec6<double> d = random.motion(phi), a = random.vector<6>();
    const Mat6<double> matrix = closed(d, a);
    const Mat6<double> checked =
        test::complex_step<6>([&](const Vec6<Complex>& z) { return function(z, lanes::cast<Complex>(a)); }, d);
    EXPECT_LT(test::largest(matrix - checked), 32 * test::epsilon * (1.0 + test::largest(matrix))) << "phi = " << phi;
  }
}

TEST(Derivatives, of_the_tangent_times_a_motion_match_the_complex_step) {
  expect_derivative([](const auto& d, const auto& a) { return tangent_derivative(d, a); },
                    [](const auto& d, const auto& a) { return tangent_times(d, a); }, 11);
}
TEST(Derivatives, of_the_inverse_tangent_times_a_motion_match_the_complex_step) {
  expect_derivative([](const auto& d, const auto& a) { return inverse_tangent_derivative(d, a); },
                    [](const auto& d, const auto& a) { return inverse_tangent_times(d, a); }, 12);
}
TEST(Derivatives, of_the_tangent_transpose_times_a_wrench_match_the_complex_step) {
  expect_derivative([](const auto& d, const auto& n) { return tangent_transpose_derivative(d, n); },
                    [](const auto& d, const auto& n) { return tangent_transpose_times(d, n); }, 13);
}
TEST(Derivatives, of_the_inverse_tangent_transpose_times_a_wrench_match_the_complex_step) {
  expect_derivative([](const auto& d, const auto& n) { return inverse_tangent_transpose_derivative(d, n); },
                    [](const auto& d, const auto& n) { return inverse_tangent_transpose_times(d, n); }, 14);
}

/// [A, B; 0, A] and [0, A; A, B] of A + e B.
Mat6<double> on_motions(const DualMat<double>& m) { return detail::upper(m.a, m.b); }
Mat6<double> on_wrenches(const DualMat<double>& m) { return detail::lower_right(m.a, m.b); }

TEST(Derivatives, products_of_dual_matrices_are_those_of_operators_on_motions) {
  test::Random random(22);
  const auto any_dual = [&] { return DualVec<double>{random.vector<3>(), random.vector<3>()}; };
  DualMat<double> a = skew(any_dual()), b = skew(any_dual());
  add_outer(a, any_dual(), any_dual());
  add_outer(b, any_dual(), any_dual());
  const DualVec<double> y = any_dual();
  const double bound = 16 * test::epsilon;
  EXPECT_LT(test::largest(on_motions(product(a, b)) - on_motions(a) * on_motions(b)), bound);
  DualMat<double> sum = a;
  add_product(sum, a, b);
  EXPECT_LT(test::largest(on_motions(sum) - (on_motions(a) + on_motions(a) * on_motions(b))), bound);
  EXPECT_LT(test::largest(on_motions(skew(y)) - cross6(motion_vector(y))), bound);
  EXPECT_LT(test::largest(on_motions(skew_product(a, y)) - on_motions(a) * cross6(motion_vector(y))), bound);
  EXPECT_LT(test::largest(on_wrenches(skew(y)) - hat6(wrench_vector(y))), bound);
}

// Both take x from the same b and c: the same bits. R differs by a = sin(phi)/phi, which exp has and T's coefficients
// give as 1 - x c. Below phi = 4 exp computes it so itself: the same bits. Beyond, c = (1 - a)/x: six roundings of
// values up to
// |1 - a| <= 1.22 (difference, 1/x, its product, x c) and |a| <= 0.22 (1 - x c), which is 1.22 * 2 + 0.11 = 2.6
// epsilon; an entry of a ~psi then differs by phi times that, and two sums round it by epsilon more.
TEST(Derivatives, exp_from_the_tangents_coefficients_is_exp) {
  test::Random random(22);
  for (const double phi : test::angles_beyond_pi())
    for (int repeat = 0; repeat < 30; ++repeat) {
      const Vec6<double> d = random.motion(phi);
      const Frame<double> a = exp_se3(d), b = exp_se3(tangent_operator(d));
      const bool below = dot(angular_part(d), angular_part(d)) < detail::switch_x;
      EXPECT_LE(test::largest(a.R - b.R), below ? 0.0 : (1.0 + 2.6 * phi) * test::epsilon) << "phi = " << phi;
      EXPECT_EQ(test::largest(a.x - b.x), 0.0) << "phi = " << phi;
    }
}

TEST(Derivatives, of_the_exponential_are_the_tangent_operator) {
  test::Random random(15);
  for (const double phi : test::angles_beyond_pi()) {
    const Vec6<double> d = random.motion(phi);
    const Frame<Complex> base = cast<Complex>(exp_se3(d));
    const Mat6<double> derivative =
        test::complex_step<6>([&](const Vec6<Complex>& z) { return log_se3(relative(base, exp_se3(z))); }, d);
    EXPECT_LT(test::largest(derivative - tangent(d)), 32 * test::epsilon) << "phi = " << phi;
  }
}

// log(H exp(eta)) by eta is T(log H)^-1: through every branch of the logarithm, up to 1e-12 from pi.
TEST(Derivatives, of_the_logarithm_are_the_inverse_tangent_operator) {
  test::Random random(16);
  for (const double phi : test::angles_up_to_pi()) {
    const Vec6<double> d = random.motion(phi);
    const Frame<Complex> H = cast<Complex>(exp_se3(d));
    const Mat6<double> derivative = test::complex_step<6>(
        [&](const Vec6<Complex>& eta) { return log_se3(compose(H, exp_se3(eta))); }, Vec6<double>::zero());
    EXPECT_LT(test::largest(derivative - inverse_tangent(d)), 64 * test::epsilon) << "phi = " << phi;
  }
}

TEST(Derivatives, by_jets_equal_the_closed_forms_at_all_angles) {
  using Jet = lanes::Jet<double, 6>;
  test::Random random(17);
  for (const double phi : test::angles_beyond_pi()) {
    const Vec6<double> d = random.motion(phi), n = random.vector<6>();
    Vec6<Jet> z;
    for (int i = 0; i < 6; ++i) z[i] = Jet::variable(d[i], i);
    const Vec6<Jet> f = inverse_tangent_transpose_times(z, lanes::cast<Jet>(n));
    const Mat6<double> closed = inverse_tangent_transpose_derivative(d, n);
    for (int i = 0; i < 6; ++i)
      for (int j = 0; j < 6; ++j)
        EXPECT_NEAR(f[i].d[j], closed(i, j), 32 * test::epsilon * (1.0 + test::largest(closed))) << "phi = " << phi;
  }
}

TEST(Derivatives, by_jets_of_log_exp_are_the_identity_at_exactly_zero) {
  using Jet = lanes::Jet<double, 6>;
  Vec6<Jet> z;
  for (int i = 0; i < 6; ++i) z[i] = Jet::variable(0.0, i);
  const Vec6<Jet> back = log_se3(exp_se3(z));
  for (int i = 0; i < 6; ++i) {
    EXPECT_EQ(back[i].a, 0.0);
    for (int j = 0; j < 6; ++j) EXPECT_NEAR(back[i].d[j], i == j ? 1.0 : 0.0, test::epsilon);
  }
}

// log(exp(d0 + t v)) = d0 + t v as a series in time, and log(exp(t v)) = t v from the identity.
TEST(Derivatives, in_time_of_log_exp_are_those_of_the_path) {
  using Series = lanes::Taylor<double, 4>;
  test::Random random(18);
  for (const double phi : {0.0, 1e-16, 1e-6, 0.1, 0.39, 0.41, 1.0, 2.0, 3.0}) {
    const Vec6<double> d = random.motion(phi), v = random.vector<6>();
    Vec6<Series> path;
    for (int i = 0; i < 6; ++i) {
      path[i] = Series(d[i]);
      path[i].c[1] = v[i];
    }
    const Vec6<Series> back = log_se3(exp_se3(path));
    for (int i = 0; i < 6; ++i) {
      EXPECT_NEAR(back[i].c[0], d[i], 16 * test::epsilon) << "phi = " << phi;
      EXPECT_NEAR(back[i].c[1], v[i], 64 * test::epsilon) << "phi = " << phi;
      // Each order passes through all lower ones: some tens of roundings.
      for (int k = 2; k <= 4; ++k)
        EXPECT_NEAR(back[i].c[k], 0.0, 128 * test::epsilon) << "phi = " << phi << ", order " << k;
    }
  }
}

// T(psi) = I - ~psi/2 + ~psi ~psi/6 - ...: mixed second derivatives at 0 are those of ~psi ~psi/6.
TEST(Derivatives, nested_jets_pass_through_zero) {
  using Inner = lanes::Jet<double, 3>;
  using Outer = lanes::Jet<Inner, 3>;
  Vec3<Outer> psi;
  for (int i = 0; i < 3; ++i) psi[i] = Outer::variable(Inner::variable(0.0, i), i);
  const Mat3<Outer> T = tangent_so3(psi);
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      const Mat3<double> a = skew(Vec3<double>::unit(i)), b = skew(Vec3<double>::unit(j));
      const Mat3<double> exact = (1.0 / 6.0) * (a * b + b * a);
      for (int r = 0; r < 3; ++r)
        for (int c = 0; c < 3; ++c) EXPECT_NEAR(T(r, c).d[i].d[j], exact(r, c), test::epsilon);
    }
}

}  // namespace
}  // namespace bough::motion
