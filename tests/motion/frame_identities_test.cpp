// Every identity of nested frames over 1000 random chains of 2 to 6 frames, against rotations and positions that are
// differentiated in 113-bit arithmetic. Tolerances: epsilon times the sum of the magnitudes of the terms.
#include <gtest/gtest.h>

#include <boost/multiprecision/cpp_bin_float.hpp>

#include "bough/motion/spinning_disc.hpp"
#include "frame_oracle.hpp"

namespace bough::motion {
namespace {

namespace mp = boost::multiprecision;
using Real = mp::number<mp::cpp_bin_float<113, mp::digit_base_2>, mp::et_off>;
using Chains = test::Oracle<Real>;
using Vec = Chains::Vec;
using test::epsilon;
using test::length_of;
using test::rounded;
using test::scale_of;
using test::time_derivative;

constexpr int num_cases = 1000;
/// Each term is a product of up to six rotations, each with a few roundings, and of rounded data; 4 would not do.
constexpr double allowed = 8.0 * epsilon;

/// Runs `check(chain, a, b, g, scale)` on every case, with any three frames of the chain.
template <class Check>
void for_each_chain(unsigned seed, const Check& check) {
  test::Random random(seed);
  for (int k = 0; k < num_cases; ++k) {
    const Chains c(random, 2 + k % 5);
    const int size = c.chain.last() + 1;
    const auto pick = [&] { return static_cast<int>(0.5 * (random.number() + 1.0) * size) % size; };
    const int a = pick(), b = pick(), g = pick();
    SCOPED_TRACE("case " + std::to_string(k) + ": frames " + std::to_string(a) + ", " + std::to_string(b) + ", " +
                 std::to_string(g) + " of " + std::to_string(size - 1));
    check(c, a, b, g, scale_of(c.chain, c.point));
    if (testing::Test::HasFailure()) return;
  }
}
void expect_equal(const Resolved& x, int axes, const Vec& exact, double bound) {
  EXPECT_LE(length_of(x.components(In(axes)) - rounded(exact)), bound);
}

// (2.2), (2.16)
TEST(FrameIdentities, euler_transformation) {
  for_each_chain(70, [](const Chains& c, int a, int b, int k, const test::Scale& s) {
    const int n = c.chain.last();
    const Vec x = c.R(k, n) * c.r;  // resolved in any frame k
    const Resolved x_k(rounded(x), In(k));
    const Rate from_b(Resolved(rounded(c.derivative(b, k, x)), In(b)), From(b));
    const Rate from_a = derivative(c.chain, x_k, from_b, From(a));
    EXPECT_EQ(from_a.observer().frame, a);
    expect_equal(from_a.value(From(a)), k, c.R(k, a) * c.derivative(a, k, x),
                 allowed * (s.W * length_of(c.point.position) + length_of(c.point.velocity)));
  });
}

// (2.22)
TEST(FrameIdentities, mixed_transformation) {
  for_each_chain(71, [](const Chains& c, int a, int b, int k, const test::Scale& s) {
    const int n = c.chain.last();
    const Vec x = c.R(k, n) * c.r;
    const Resolved x_k(rounded(x), In(k));
    const Rate from_b(Resolved(rounded(c.derivative(b, k, x)), In(b)), From(b));
    const Rate from_a = mixed_derivative(c.chain, x_k, from_b, Of(n), From(a));
    expect_equal(from_a.value(From(a)), k, c.R(k, a) * c.derivative(a, k, x),
                 2 * allowed * (s.W * length_of(c.point.position) + length_of(c.point.velocity)));
  });
}

// (2.23), (2.24); the oracle differentiates R_ab and adds no angular velocities.
TEST(FrameIdentities, angular_velocities_add) {
  for_each_chain(72, [](const Chains& c, int a, int b, int k, const test::Scale& s) {
    expect_equal(angular_velocity(c.chain, Of(b), RelativeTo(a), In(k)), k, c.R(k, a) * c.W(a, b), allowed * s.W);
  });
}

// (2.29), any observer g
TEST(FrameIdentities, derivative_of_the_sum_of_angular_velocities_from_any_frame) {
  for_each_chain(73, [](const Chains& c, int a, int b, int g, const test::Scale& s) {
    const AngularAcceleration alpha = angular_acceleration(c.chain, Of(b), RelativeTo(a), From(g), In(g));
    expect_equal(alpha.total(), g, c.derivative(g, a, c.W(a, b)), allowed * s.alpha);
    expect_equal(alpha.local, g, c.R(g, b) * c.sum_of_local(a, b), allowed * s.alpha);
  });
}

// (2.31): a_1 + a_2 + a_3 + W_2 x w_2 + W_3 x w_3, the terms by themselves.
TEST(FrameIdentities, three_angular_velocities_from_the_inertial_frame) {
  test::Random random(74);
  for (int k = 0; k < num_cases; ++k) {
    const Chains c(random, 3);
    const auto w = [&](int i) { return resolve(c.chain, {rounded(c.w(i)), In(i)}, In(0)); };
    const auto a = [&](int i) { return resolve(c.chain, {rounded(c.a(i)), In(i)}, In(0)); };
    const auto W = [&](int i) { return angular_velocity(c.chain, Of(i), RelativeTo(0), In(0)); };
    const Resolved by_terms = a(1) + a(2) + a(3) + cross(W(2), w(2)) + cross(W(3), w(3));
    const double bound = allowed * scale_of(c.chain, c.point).alpha;
    expect_equal(by_terms, 0, time_derivative(c.W(0, 3)), bound);
    EXPECT_LE(norm(by_terms - angular_acceleration(c.chain, Of(3), RelativeTo(0), From(0), In(0)).total()), bound);
  }
}

// (2.35): the terms from angular velocities of differentiated rotations, their sum from the derivatives themselves.
TEST(FrameIdentities, mixed_acceleration) {
  for_each_chain(75, [](const Chains& c, int a, int b, int k, const test::Scale& s) {
    const int n = c.chain.last();
    const MixedAcceleration m = mixed_acceleration(c.chain, c.point, From(a), From(b), In(k));
    const Vec W_ac = c.R(n, a) * c.W(a, n), W_bc = c.R(n, b) * c.W(b, n), rate = time_derivative(c.r);
    const double bound = allowed * (length_of(c.point.acceleration) + 2 * s.W * length_of(c.point.velocity) +
                                    (s.alpha + 2 * s.W * s.W) * length_of(c.point.position));
    const auto in_k = [&](const Vec& x) -> Vec { return c.R(k, n) * x; };
    expect_equal(m.local, k, in_k(time_derivative(rate)), bound);
    expect_equal(m.coriolis, k, in_k(cross(W_bc + W_ac, rate)), bound);
    expect_equal(m.tangential, k, in_k(cross(time_derivative(W_ac), c.r)), bound);
    expect_equal(m.razi, k, in_k(cross(cross(W_bc, W_ac), c.r)), bound);
    expect_equal(m.centripetal, k, in_k(cross(W_ac, cross(W_bc, c.r))), bound);
    expect_equal(m.total(), k, c.R(k, b) * c.derivative(b, a, c.derivative(a, n, c.r)), bound);
  });
}

// (2.44), (2.45), from any frame: each part, and the sum with the part of the origin.
TEST(FrameIdentities, acceleration_of_a_point_of_n_frames) {
  for_each_chain(76, [](const Chains& c, int g, int, int k, const test::Scale& s) {
    const int n = c.chain.last();
    const AccelerationParts p = acceleration_split(c.chain, c.point, From(g), In(k));
    const Vec W = c.R(n, g) * c.W(g, n), rate = time_derivative(c.r), a = c.sum_of_local(g, n);
    const Vec alpha = c.R(n, g) * c.derivative(g, g, c.W(g, n));
    const auto in_k = [&](const Vec& x) -> Vec { return c.R(k, n) * x; };
    const double bound = allowed * s.acc;
    expect_equal(p.local, k, in_k(time_derivative(rate)), bound);
    expect_equal(p.tangential, k, in_k(cross(a, c.r)), bound);
    expect_equal(p.coriolis, k, in_k(2.0 * cross(W, rate)), bound);
    expect_equal(p.centripetal, k, in_k(cross(W, cross(W, c.r))), bound);
    expect_equal(p.razi, k, in_k(cross(alpha - a, c.r)), bound);
    const auto second = [&](const Vec& x) { return time_derivative(time_derivative(x)); };
    expect_equal(p.origin, k, c.R(k, g) * second(c.position(g, n, Vec::zero())), bound);
    expect_equal(p.total(), k, c.R(k, g) * second(c.position(g, n, c.r)), bound);
  });
}

// The same seen from beyond the point: frame n sees a point of frame b, the sums run backwards.
TEST(FrameIdentities, acceleration_of_a_point_seen_from_a_frame_beyond_it) {
  for_each_chain(77, [](const Chains& c, int b, int, int k, const test::Scale& s) {
    const int n = c.chain.last();
    PointMotion p = c.point;
    p.frame = b;
    const auto second = [&](const Vec& x) { return time_derivative(time_derivative(x)); };
    const AccelerationParts parts = acceleration_split(c.chain, p, From(n), In(k));
    expect_equal(parts.total(), k, c.R(k, n) * second(c.position(n, b, c.r)), allowed * s.acc);
    expect_equal(velocity_split(c.chain, p, From(n), In(k)).total(), k,
                 c.R(k, n) * time_derivative(c.position(n, b, c.r)), allowed * s.v);
  });
}

// (2.18): one moving frame has the four classical terms; (2.42): two have (w_1 x w_2) x r beside them.
TEST(FrameIdentities, two_and_three_frames) {
  test::Random random(78);
  for (int k = 0; k < num_cases; ++k) {
    const Chains two(random, 1), three(random, 2);
    EXPECT_EQ(norm(acceleration_split(two.chain, two.point, From(0), In(0)).razi), 0.0);
    const AccelerationParts classical = acceleration_split(two.chain, two.point, From(0), In(1));
    const Vec w = two.w(1);
    const double bound = allowed * scale_of(two.chain, two.point).acc;
    expect_equal(classical.tangential, 1, cross(two.a(1), two.r), bound);
    expect_equal(classical.centripetal, 1, cross(w, cross(w, two.r)), bound);
    const Vec razi = cross(cross(Vec(three.R(2, 1) * three.w(1)), three.w(2)), three.r);
    expect_equal(acceleration_split(three.chain, three.point, From(0), In(2)).razi, 2, razi,
                 allowed * scale_of(three.chain, three.point).acc);
  }
}

// (2.46) to (2.48): Newton's law for an observer who moves.
TEST(FrameIdentities, inertial_forces_close_the_balance_of_an_observer_who_moves) {
  for_each_chain(79, [](const Chains& c, int, int, int k, const test::Scale& s) {
    const int n = c.chain.last();
    const double mass = 2.5;
    const InertialForces f = inertial_forces(mass, acceleration_split(c.chain, c.point, From(0), In(k)));
    const double bound = 2 * allowed * mass * s.acc;
    expect_equal(f.applied, k, c.R(k, 0) * (mass * time_derivative(time_derivative(c.position(0, n, c.r)))), bound);
    expect_equal(f.applied + f.sum(), k, c.R(k, n) * (mass * time_derivative(time_derivative(c.r))), bound);
  });
}

// (2.49) to (2.51)
TEST(FrameIdentities, razi_acceleration_of_a_disc) {
  test::Random random(80);
  for (int k = 0; k < num_cases; ++k) {
    const SpinningDisc disc{5 * random.number(), 5 * random.number(), 3 * random.number(), 1.5 + random.number()};
    const FrameChain chain = chain_of(disc, 6 * random.number(), 6 * random.number());
    const PointMotion p = point_of(disc);
    const Resolved spin = angular_velocity(chain, Of(2), RelativeTo(1), In(1));
    const Resolved precession = angular_velocity(chain, Of(1), RelativeTo(0), In(1));
    const Resolved r = resolve(chain, {p.position, In(2)}, In(1));
    const Resolved razi = acceleration_split(chain, p, From(0), In(1)).razi;
    EXPECT_LE(norm(razi - razi_acceleration(precession, spin, r)), allowed * 25 * disc.radius);
    SpinningDisc upright = disc;
    upright.tilt = 0.0;
    EXPECT_EQ(norm(acceleration_split(chain_of(upright, 1.0), p, From(0), In(1)).razi), 0.0);
    SpinningDisc fixed = disc;
    fixed.precession = 0.0;
    EXPECT_EQ(norm(acceleration_split(chain_of(fixed, 1.0), p, From(0), In(1)).razi), 0.0);
  }
}

// (2.52) to (2.60)
TEST(FrameIdentities, angular_velocity_and_acceleration_from_the_derivatives_of_a_rotation) {
  for_each_chain(81, [](const Chains& c, int a, int b, int, const test::Scale& s) {
    const auto R = c.R(a, b);
    Mat3<double> derivatives[3];
    for (int k = 0; k < 9; ++k) {
      derivatives[0].m[k] = static_cast<double>(R.m[k].c[0]);
      derivatives[1].m[k] = static_cast<double>(R.m[k].c[1]);
      derivatives[2].m[k] = static_cast<double>(Real(2) * R.m[k].c[2]);
    }
    EXPECT_LE(length_of(angular_velocity_of(derivatives[0], derivatives[1]) - rounded(c.W(a, b))), allowed * s.W);
    EXPECT_LE(length_of(angular_acceleration_of(derivatives[0], derivatives[1], derivatives[2]) -
                        rounded(time_derivative(c.W(a, b)))),
              allowed * s.alpha);
  });
}

}  // namespace
}  // namespace bough::motion
