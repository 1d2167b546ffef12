// Exponential, logarithm, tangent operators and their derivatives on SE(3), each over 1000 random motions and more at
// all angles: against closed forms at 50 digits and derivatives of those by differences.
#include "bough/motion/so3.hpp"
#include "exact.hpp"

namespace bough::motion {
namespace {

using exact::Case;
using exact::error;
using exact::for_motions;
using exact::Real;
using lanes::cast;
using test::epsilon;
using test::largest;

/// exp(d)^-1 D exp(d)[a] by central differences: T(d) a.
Vec6<Real> exact_tangent_times(const Vec6<Real>& d, const Vec6<Real>& a, const Real& h) {
  const Vec6<Real> step = h * a;
  const Frame<Real> H = exact::exponential(d), high = exact::exponential(d + step), low = exact::exponential(d - step);
  const Real scale = 1 / (2 * h);
  const Mat3<Real> turn = transpose_times(H.R, Mat3<Real>(scale * (high.R - low.R)));
  return join(transpose_times(H.R, Vec3<Real>(scale * (high.x - low.x))),
              Vec3<Real>{{turn(2, 1), turn(0, 2), turn(1, 0)}});
}
Vec6<double> motion_vector(const Case& c, test::Random& random) {
  const Vec3<double> u = random.vector<3>();
  return join(u, exact::rounded(c.psi));
}
/// Grows as the operator T^-1 towards its pole at 2 pi.
double pole(const Case& c) { return std::fmax(1.0, c.m.phi / (2.0 * std::numbers::pi - c.m.phi)); }

// The error is the rounding of phi^2, which turns R by epsilon phi, and that of the products: 2.5 (1 + phi) epsilon.
TEST(Operators, exponential_is_within_round_off_times_one_plus_phi) {
  for_motions(141, [](const Case& c, test::Random& random) {
    const Vec6<double> d = motion_vector(c, random);
    const Frame<Real> exact = exact::exponential(cast<Real>(d));
    const Frame<double> H = exp_se3(d), by_tangent = exp_se3(tangent_operator(d));
    const double bound = 2.5 * epsilon * (1.0 + c.m.phi);
    EXPECT_LE(error(H.R, exact.R), bound);
    EXPECT_LE(error(H.x, exact.x), bound);
    EXPECT_LE(error(by_tangent.R, exact.R), bound);
    EXPECT_LE(error(by_tangent.x, exact.x), bound);
    EXPECT_LE(error(exp_so3(angular_part(d)), exact.R), bound);
    const Quaternion<double> q = exp_quaternion(angular_part(d));
    EXPECT_LE(error(q.w, Real(cos(c.phi / 2))), bound);
    EXPECT_LE(error(rotation_of(q), exact.R), 2 * bound);
  });
}

TEST(Operators, logarithm_returns_the_motion_vector_of_the_shorter_rotation) {
  for_motions(142, [](const Case& c, test::Random& random) {
    const Vec6<double> d = motion_vector(c, random);
    const Frame<Real> H = exact::exponential(cast<Real>(d));
    const Vec6<double> back = log_se3(exact::rounded(H));
    const Vec3<Real> psi = cast<Real>(Vec3<double>(angular_part(back)));
    // Which of the two vectors near pi: that of the library, to its 2 pi.
    const bool shorter = dot(psi, c.psi) >= 0 && c.phi < Real(3.2);
    const Real phi = shorter ? c.phi : Real(c.phi - 2 * exact::pi());
    const double turn = std::fmin(1.0, c.m.phi);
    EXPECT_LE(error(angular_part(back), Vec3<Real>(phi * (c.phi == 0 ? Vec3<Real>::zero() : c.n))), 6 * epsilon * turn);
    // exp(log H) = H in 50 digits: the linear part. T^-1 at pi has norm pi/2.
    const Frame<Real> again = exact::exponential(cast<Real>(back));
    EXPECT_LE(exact::norm(again.x - H.x), 3 * epsilon);
    EXPECT_LE(test::largest(exact::rounded(again.R - H.R)), 6 * epsilon);
  });
}

TEST(Operators, tangent_its_inverse_and_transposes_are_those_of_the_exponential) {
  for_motions(143, [](const Case& c, test::Random& random) {
    const Vec6<double> d = motion_vector(c, random), a = random.vector<6>(), n = random.vector<6>();
    const Vec6<Real> exact = exact_tangent_times(cast<Real>(d), cast<Real>(a), Real("1e-16"));
    const double bound = 3 * epsilon * (1.0 + c.m.phi);
    EXPECT_LE(error(tangent_times(d, a), exact), bound);
    EXPECT_LE(error(tangent(d) * a, exact), bound);
    EXPECT_LE(error(tangent_so3_times(angular_part(d), angular_part(a)), Vec3<Real>(angular_part(exact))), bound);
    EXPECT_LE(error(dot(tangent_transpose_times(d, n), a), dot(cast<Real>(n), exact)), 4 * bound);
    const Vec6<double> Ta = exact::rounded(exact);
    const double room = pole(c) * pole(c);
    EXPECT_LE(largest(inverse_tangent_times(d, Ta) - a), 2 * bound * room);
    EXPECT_LE(largest(inverse_tangent(d) * Ta - a), 2 * bound * room);
    EXPECT_LE(std::abs(dot(inverse_tangent_transpose_times(d, n), Ta) - dot(n, a)), 3 * bound * room);
  });
}

TEST(Operators, derivatives_of_tangent_operators_are_those_of_the_exponential) {
  const Real h("1e-12");
  for_motions(144, [&h](const Case& c, test::Random& random) {
    const Vec6<double> d = motion_vector(c, random), a = random.vector<6>(), b = random.vector<6>(),
                       n = random.vector<6>();
    const Vec6<Real> exact = exact::slope([&](const Vec6<Real>& x) { return exact_tangent_times(x, cast<Real>(a), h); },
                                          cast<Real>(d), cast<Real>(b), h);
    const double bound = 3 * epsilon * (1.0 + c.m.phi);
    EXPECT_LE(error(tangent_derivative(d, a) * b, exact), bound);
    EXPECT_LE(error(tangent_operator(d).slope_times(b, a), exact), bound);
    EXPECT_LE(error(dot(tangent_transpose_derivative(d, n) * b, a), dot(cast<Real>(n), exact)), 4 * bound);
    // T^-1 (T a) = a along b, with T a held: D(T^-1)[b] T a = -T^-1 DT[b] a.
    const Vec6<double> Ta = tangent_times(d, a), slope = exact::rounded(exact);
    const double room = pole(c) * pole(c) * pole(c);
    const Vec6<double> balance = inverse_tangent_derivative(d, Ta) * b + inverse_tangent_times(d, slope);
    EXPECT_LE(largest(balance), 2 * bound * room);
    const double transposed =
        dot(inverse_tangent_transpose_derivative(d, n) * b, Ta) + dot(n, inverse_tangent_times(d, slope));
    EXPECT_LE(std::abs(transposed), 3 * bound * room);
  });
}

}  // namespace
}  // namespace bough::motion
