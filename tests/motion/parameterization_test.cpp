// Three parameterizations of rotations and motions behind one interface, each against 50 digits: the map by its angle
// law and Rodrigues' formula, motions by their screw p N [1.73], tangent operators by differentiating those. 1000
// random motions and more for each law, over all angles of its range.
#include "bough/motion/parameterization.hpp"

#include "bough/motion/screw.hpp"
#include "bough/motion/velocity.hpp"
#include "exact.hpp"

namespace bough::motion {
namespace {

using exact::Case;
using exact::error;
using exact::Real;
using lanes::cast;
using test::epsilon;
using test::largest;

/// p, p', p'' of the angle, and the angle of p, at 50 digits; largest angle of the sweep.
struct ExponentialOracle {
  using Map = ExponentialMap;
  static Real p(const Real& phi) { return phi; }
  static Real slope(const Real&) { return 1; }
  static Real second(const Real&) { return 0; }
  static Real angle(const Real& p) { return p; }
  static constexpr double largest_angle = 6.0;
};
struct CayleyOracle {
  using Map = CayleyMap;
  static Real p(const Real& phi) { return 2 * tan(phi / 2); }
  static Real slope(const Real& phi) { return 1 / (cos(phi / 2) * cos(phi / 2)); }
  static Real second(const Real& phi) { return tan(phi / 2) * slope(phi); }
  static Real angle(const Real& p) { return 2 * atan(p / 2); }
  static constexpr double largest_angle = std::numbers::pi - 1e-13;
};
struct WienerMilenkovicOracle {
  using Map = WienerMilenkovicMap;
  static Real p(const Real& phi) { return 4 * tan(phi / 4); }
  static Real slope(const Real& phi) { return 1 / (cos(phi / 4) * cos(phi / 4)); }
  static Real second(const Real& phi) { return tan(phi / 4) * slope(phi) / 2; }
  static Real angle(const Real& p) { return 4 * atan(p / 4); }
  static constexpr double largest_angle = 6.0;
};

template <class Oracle>
class Parameterizations : public ::testing::Test {
 protected:
  using Map = typename Oracle::Map;
  static Mat3<Real> rotation(const Vec3<Real>& p) {
    const Real size = exact::norm(p);
    if (size == 0) return Mat3<Real>::identity();
    return exact::rotation(Vec3<Real>(Real(1 / size) * p), Oracle::angle(size));
  }
  /// The motion of the screw P = (u; p) = (p w + p' d n; p n).
  static Frame<Real> motion(const Vec6<Real>& P) {
    const Vec3<Real> u = linear_part(P), p = angular_part(P);
    const Real size = exact::norm(p);
    if (size == 0) return {Mat3<Real>::identity(), u};
    const Vec3<Real> n = Real(1 / size) * p;
    const Real phi = Oracle::angle(size), along = dot(n, u), d = along / Oracle::slope(phi);
    const Vec3<Real> w = Real(1 / size) * (u - along * n);
    return {exact::rotation(n, phi), d * n + Real(2 * sin(phi / 2)) * (exact::rotation(n, Real(phi / 2)) * w)};
  }
  /// H^-1 D H[a] as a 6-vector, by differences of step h (1 + |p|).
  static Vec6<Real> tangent_times(const Vec6<Real>& P, const Vec6<Real>& a, const Real& step) {
    const Real h = step * (1 + exact::norm(angular_part(P)));
    const Vec6<Real> move = h * a;
    const Frame<Real> H = motion(P), high = motion(P + move), low = motion(P - move);
    const Real scale = 1 / (2 * h);
    const Mat3<Real> turn = transpose_times(H.R, Mat3<Real>(scale * (high.R - low.R)));
    return join(transpose_times(H.R, Vec3<Real>(scale * (high.x - low.x))),
                Vec3<Real>{{turn(2, 1), turn(0, 2), turn(1, 0)}});
  }
  /// Parameters of a motion for this law, exact, and their condition: change of p and of u per relative round-off.
  struct Sample {
    Vec6<Real> P;
    Vec6<double> rounded;
    double size_p, size_u, slope, second;
  };
  static Sample sample(const Case& c) {
    Sample s;
    const Real p = Oracle::p(c.phi), slope = Oracle::slope(c.phi);
    s.P = c.phi == 0 ? join(c.u, Vec3<Real>::zero())
                     : join(Vec3<Real>(p * c.w + Real(slope * c.d) * c.n), Vec3<Real>(p * c.n));
    s.rounded = exact::rounded(s.P);
    s.size_p = static_cast<double>(p);
    s.size_u = static_cast<double>(exact::norm(linear_part(s.P)));
    s.slope = static_cast<double>(slope);
    s.second = static_cast<double>(Oracle::second(c.phi));
    return s;
  }
  template <class Check>
  static void for_samples(unsigned seed, const Check& check) {
    const int repeats = 25;
    exact::for_motions(
        seed,
        [&](const Case& c, test::Random& random) {
          if (static_cast<double>(c.phi) <= Oracle::largest_angle) check(c, sample(c), random);
        },
        repeats);
  }
};
using Oracles = ::testing::Types<ExponentialOracle, CayleyOracle, WienerMilenkovicOracle>;
struct OracleNames {
  template <class Oracle>
  static std::string GetName(int) {
    return std::string(Oracle::Map::name);
  }
};
TYPED_TEST_SUITE(Parameterizations, Oracles, OracleNames);

TYPED_TEST(Parameterizations, give_the_exact_rotation_and_motion) {
  TestFixture::for_samples(131, [](const Case& c, const auto& s, test::Random&) {
    using Law = typename TestFixture::Map;
    // R has the rounding of p.p, which moves the angle by epsilon phi. It is the motion of the rounded parameters
    // that is asked for.
    const Vec6<Real> P = cast<Real>(s.rounded);
    const Frame<Real> exact = TestFixture::motion(P);
    const Frame<double> H = Law::motion(s.rounded);
    EXPECT_LE(error(Law::rotation(angular_part(s.rounded)), exact.R), 2.5 * epsilon * (1.0 + c.m.phi));
    EXPECT_LE(error(H.R, exact.R), 2.5 * epsilon * (1.0 + c.m.phi));
    // x = T^T u: T has norm 1 near phi = 0 and 2 sin(phi/2)/p across the axis far from it.
    const double norm_T = std::fmax(1.0 / s.slope, c.phi == 0 ? 1.0 : 2.0 * std::sin(0.5 * c.m.phi) / s.size_p);
    EXPECT_LE(error(H.x, exact.x), 16 * epsilon * std::fmax(norm_T * s.size_u, c.size));
  });
}

TYPED_TEST(Parameterizations, of_a_motion_are_its_screw_p_N) {  // [1.68-1.73]
  TestFixture::for_samples(132, [](const Case& c, const auto& s, test::Random&) {
    using Law = typename TestFixture::Map;
    if (c.m.phi > std::numbers::pi - 1e-14) return;
    const Vec6<double> P = Law::parameters(c.H);
    // The rounding of R moves the angle by epsilon min(1, phi), and p, p' by p', p'' times that.
    const double turn = std::fmin(1.0, c.m.phi);
    const double bound_p = 3 * epsilon * (s.size_p + s.slope * turn);
    const double bound_u = 6 * epsilon * (s.size_u + s.second * turn * c.size + s.slope * c.size);
    EXPECT_LE(error(Law::parameters(c.H.R), Vec3<Real>(angular_part(s.P))), bound_p);
    EXPECT_LE(error(angular_part(P), Vec3<Real>(angular_part(s.P))), bound_p);
    EXPECT_LE(error(linear_part(P), Vec3<Real>(linear_part(s.P))), bound_u);
    // alpha = 2 sin(phi/2) p'/p: the same 6-vector as a screw of the motion.
    const double alpha = c.m.kind == MotionKind::screw ? 2.0 * std::sin(0.5 * c.m.phi) * s.slope / s.size_p : 0.0;
    const Vec6<double> screw = motion_screw(c.m, s.size_p, alpha);
    EXPECT_LE(error(linear_part(screw), Vec3<Real>(linear_part(s.P))), bound_u);
  });
}

TYPED_TEST(Parameterizations, tangent_operators_are_the_derivatives_of_the_map) {
  TestFixture::for_samples(133, [](const Case&, const auto& s, test::Random& random) {
    using Law = typename TestFixture::Map;
    const Vec6<Real> P = cast<Real>(s.rounded);
    const Vec6<double> a = random.vector<6>(), b = random.vector<6>();
    const Mat6<double> T = Law::tangent(s.rounded), inverse = Law::inverse_tangent(s.rounded);
    const Vec6<Real> exact = TestFixture::tangent_times(P, cast<Real>(a), Real("1e-16"));
    const double size = std::fmax(largest(T), 1.0 / (1.0 + s.size_p * s.size_p));
    EXPECT_LE(error(T * a, exact), 12 * epsilon * size);
    EXPECT_LE(error(Law::tangent(angular_part(s.rounded)) * angular_part(a), Vec3<Real>(angular_part(exact))),
              8 * epsilon * largest(Law::tangent(angular_part(s.rounded))));
    // T^-1 by its action on exact values: T^-1 (T a) = a.
    EXPECT_LE(largest(inverse * exact::rounded(exact) - a), 3 * epsilon * (1.0 + largest(inverse) * size));
    const Mat3<double> both = Law::inverse_tangent(angular_part(s.rounded)) * Law::tangent(angular_part(s.rounded));
    EXPECT_LE(largest(both - Mat3<double>::identity()),
              6 * epsilon * (1.0 + largest(Law::inverse_tangent(angular_part(s.rounded)))));
    // Derivative of T a along b.
    const Mat6<double> slope = Law::tangent_derivative(s.rounded, a);
    const Real h = Real("1e-12") * (1 + exact::norm(angular_part(P)));
    const Vec6<Real> move = h * cast<Real>(b);
    const Vec6<Real> difference =
        Real(1 / (2 * h)) * (TestFixture::tangent_times(P + move, cast<Real>(a), Real("1e-12")) -
                             TestFixture::tangent_times(P - move, cast<Real>(a), Real("1e-12")));
    EXPECT_LE(error(slope * b, difference), 6 * epsilon * (size + largest(slope)));
    // d(T^-1 T a) = 0.
    const Vec6<double> Ta = T * a;
    const Mat6<double> balance = Law::inverse_tangent_derivative(s.rounded, Ta) + inverse * slope;
    EXPECT_LE(largest(balance),
              2 * epsilon * (1.0 + largest(inverse)) * (size + largest(slope)) * (1.0 + largest(inverse) * size));
  });
}

// With V* = H* dq/dt, H* = T(q), and V = H dq/dt, H = T(-q) = C T(q).
TYPED_TEST(Parameterizations, transitivity_of_their_velocity_operators) {  // [1.82-1.85]
  TestFixture::for_samples(134, [](const Case&, const auto& s, test::Random& random) {
    using Law = typename TestFixture::Map;
    const Vec6<double> q = s.rounded, minus = -q, rate = random.vector<6>(), b = random.vector<6>();
    const Frame<double> H = Law::motion(q);
    const Vec6<double> Vb = Law::tangent(q) * rate, V = Law::tangent(minus) * rate, Hb = Law::tangent(q) * b;
    // (d/dt operator) b = d(operator b)/dq dq/dt; derivatives of T(-q) change sign.
    const Vec6<double> body_rate = Law::tangent_derivative(q, b) * rate;
    const Vec6<double> body_slope = Law::tangent_derivative(q, rate) * b;
    const Vec6<double> inertial_rate = -(Law::tangent_derivative(minus, b) * rate);
    const Vec6<double> inertial_slope = -(Law::tangent_derivative(minus, rate) * b);
    const double size = largest(Law::tangent(q)),
                 derivative = largest(Law::tangent_derivative(q, b)) + largest(Law::tangent_derivative(q, rate));
    const double C = 1.0 + largest(H.x);
    const double bound = 6 * epsilon * C * (size + size * size + derivative) * C;
    EXPECT_LE(largest(V - adjoint_times(H, Vb)), 24 * epsilon * C * size);
    EXPECT_LE(largest(inertial_rate - inertial_slope - cross6_times(V, Vec6<double>(Law::tangent(minus) * b))), bound);
    EXPECT_LE(largest(body_rate - body_slope + cross6_times(Vb, Hb)), bound);         // [1.83]
    EXPECT_LE(largest(inverse_adjoint_times(H, inertial_rate) - body_slope), bound);  // [1.84]
    EXPECT_LE(largest(adjoint_times(H, body_rate) - inertial_slope), bound);          // [1.85]
  });
}

TEST(Rescaling, keeps_the_motion_and_brings_the_modulus_below_4) {
  exact::for_motions(135, [](const Case& c, test::Random&) {
    const Real p = 4 * tan(c.phi / 4), slope = 1 / (cos(c.phi / 4) * cos(c.phi / 4));
    const Vec6<double> P = exact::rounded(
        Vec6<Real>(c.phi == 0 ? join(c.u, Vec3<Real>::zero())
                              : join(Vec3<Real>(p * c.w + Real(slope * c.d) * c.n), Vec3<Real>(p * c.n))));
    const Vec6<double> Q = rescale_wiener_milenkovic(P);
    const Vec3<double> q = angular_part(Q);
    EXPECT_LE(std::sqrt(dot(q, q)), 4.0 + 4 * epsilon);
    EXPECT_EQ(largest(rescale_wiener_milenkovic(Vec3<double>(angular_part(P))) - q), 0.0);
    const Frame<double> H = WienerMilenkovicMap::motion(Q);
    EXPECT_LE(error(H.R, c.R), 8 * epsilon);
    // u has the size p'|u|; near 2 pi rescaling gives back what the first set of parameters lost in it.
    EXPECT_LE(error(H.x, c.u), 4 * epsilon * (c.size + largest(P) * c.screw_size / (1.0 + static_cast<double>(p))));
    EXPECT_TRUE(c.phi > Real(3.1) || largest(Q - P) == 0.0);
    const Mat6<double> inverse = WienerMilenkovicMap::inverse_tangent(Q);
    EXPECT_LE(largest(detail::upper(Mat3<double>(WienerMilenkovicMap::inverse_tangent(q)), Mat3<double>::zero())),
              2.0 + 8 * epsilon);
    EXPECT_TRUE(std::isfinite(largest(inverse)));
  });
}

// Cayley's modulus is infinite at pi by nature; a finite one stands for it and gives the rotation back.
TEST(Parameterization, of_a_half_turn_are_finite_and_return_for_every_law) {
  for (int axis = 0; axis < 3; ++axis) {
    Frame<double> H{-1.0 * Mat3<double>::identity(), {{1.0, -2.0, 3.0}}};
    H.R(axis, axis) = 1.0;
    const auto check = [&]<class Map>(const Map&) {
      const Vec3<double> p = Map::parameters(H.R);
      const Vec6<double> P = Map::parameters(H);
      EXPECT_TRUE(std::isfinite(largest(p)) && std::isfinite(largest(P))) << Map::name;
      EXPECT_LE(largest(Map::rotation(p) - H.R), 4 * epsilon) << Map::name;
      return largest(Map::motion(P).x - H.x);
    };
    EXPECT_LE(check(ExponentialMap{}), 16 * epsilon);
    EXPECT_LE(check(WienerMilenkovicMap{}), 16 * epsilon);
    EXPECT_TRUE(std::isfinite(check(CayleyMap{})));  // the part of u across the axis is below the digits of the other
  }
}

TEST(Parameterization, the_three_agree_to_first_order_at_the_identity) {
  test::Random random(136);
  for (int i = 0; i < 100; ++i) {
    const Vec6<double> P = 1e-9 * random.vector<6>();
    const Frame<double> H = ExponentialMap::motion(P);
    for (const Frame<double>& G : {CayleyMap::motion(P), WienerMilenkovicMap::motion(P)}) {
      EXPECT_LE(largest(G.R - H.R), 1e-26);
      EXPECT_LE(largest(G.x - H.x), 1e-26);
    }
  }
}

}  // namespace
}  // namespace bough::motion
