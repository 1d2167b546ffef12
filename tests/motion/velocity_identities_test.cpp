// Velocities, differential motions, screws and the generalized vector product: 1000 random motions and more each, over
// all angles. The oracle differentiates rotation and motion tensors at 50 digits; it knows no formula of velocities.
#include "bough/motion/screw.hpp"
#include "bough/motion/so3_derivatives.hpp"
#include "bough/motion/velocity.hpp"
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

/// A motion that depends on time t and on a parameter e: vectors of R and u as polynomials with random coefficients.
struct Path {
  Vec3<Real> psi[4], u[4];  ///< coefficients of 1, t, e, t e
  double speed = 0.0;       ///< bound of all velocities and variations, with their products

  Path(const Case& c, test::Random& random) {
    for (int k = 0; k < 4; ++k) {
      psi[k] = k == 0 ? c.psi : cast<Real>(random.vector<3>());
      u[k] = k == 0 ? c.u : Real(c.size) * cast<Real>(random.vector<3>());
    }
    speed = 2.0 * (1.0 + c.size);
  }
  static Vec3<Real> at(const Vec3<Real>* a, const Real& t, const Real& e) {
    return a[0] + t * a[1] + e * a[2] + Real(t * e) * a[3];
  }
  Frame<Real> pose(const Real& t, const Real& e) const { return {exact::rotation(at(psi, t, e)), at(u, t, e)}; }
  Mat6<Real> tensor(const Real& t, const Real& e) const {
    const Frame<Real> H = pose(t, e);
    return exact::motion_tensor(H.R, H.x);
  }
  /// (linear; angular) of Adot A^-1 or A^-1 Adot with A = C, by t or by e: read off the 6x6 matrix [1.56, 1.59].
  Vec6<Real> inertial(const Real& t, const Real& e, bool by_time, const Real& h) const {
    const Mat6<Real> C = tensor(t, e), slope = difference(t, e, by_time, h);
    return vector_of(slope * invert(C));
  }
  Vec6<Real> body(const Real& t, const Real& e, bool by_time, const Real& h) const {
    const Mat6<Real> C = tensor(t, e), slope = difference(t, e, by_time, h);
    return vector_of(invert(C) * slope);
  }
  Mat6<Real> difference(const Real& t, const Real& e, bool by_time, const Real& h) const {
    const Real dt = by_time ? h : Real(0), de = by_time ? Real(0) : h;
    return Real(1 / (2 * h)) * (tensor(t + dt, e + de) - tensor(t - dt, e - de));
  }
  /// [R, X; 0, R]^-1 = [R^T, -R^T X R^T; 0, R^T].
  static Mat6<Real> invert(const Mat6<Real>& C) {
    Mat3<Real> R, X;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        R(i, j) = C(i, j);
        X(i, j) = C(i, j + 3);
      }
    const Mat3<Real> Rt = transpose(R);
    return detail::upper(Rt, Mat3<Real>(Real(-1) * (Rt * X * Rt)));
  }
  static Vec6<Real> vector_of(const Mat6<Real>& A) { return {{A(2, 4), A(0, 5), A(1, 3), A(2, 1), A(0, 2), A(1, 0)}}; }
};
const Real tiny("1e-16"), small("1e-12");  // steps of first and of mixed differences: errors of 1e-32 and 1e-24

TEST(VelocityIdentities, velocity_is_the_rate_of_the_motion_tensor) {  // [1.56-1.62]
  for_motions(121, [](const Case& c, test::Random& random) {
    const Path path(c, random);
    const Vec6<Real> V = path.inertial(0, 0, true, tiny), Vb = path.body(0, 0, true, tiny);
    const Mat6<Real> C = path.tensor(0, 0), C_rate = path.difference(0, 0, true, tiny);
    const Vec3<Real> omega = angular_part(V), u_rate = path.u[1];
    const Vec6<double> v = inertial_velocity(c.H, exact::rounded(u_rate), exact::rounded(omega));
    EXPECT_LE(error(v, V), 2 * epsilon * path.speed);  // [1.57]
    EXPECT_LE(error(body_velocity(c.H, exact::rounded(u_rate), exact::rounded(omega)), Vb), 2 * epsilon * path.speed);
    EXPECT_LE(error(inverse_adjoint_times(c.H, v), Vb), 4 * epsilon * path.speed);                  // [1.60]
    EXPECT_LE(error(motion_tensor_rate(c.H, v), C_rate), 4 * epsilon * path.speed);                 // [1.56]
    EXPECT_LE(error(velocity_of_basis(c.H, exact::rounded(C_rate)), V), 4 * epsilon * path.speed);  // [1.67]
    const Mat6<Real> inverse_rate = Real(-1) * (Path::invert(C) * C_rate * Path::invert(C));
    EXPECT_LE(error(inverse_motion_tensor_rate(c.H, v), inverse_rate), 4 * epsilon * path.speed);  // [1.61]
    const Mat6<double> conjugated = inverse_adjoint(c.H) * cross6(v) * adjoint(c.H);               // [1.62]
    EXPECT_LE(error(conjugated, Mat6<Real>(Path::invert(C) * C_rate)), 8 * epsilon * path.speed * (1.0 + c.size));
    // Each moved Plücker vector changes by ~V times itself [1.67].
    for (int k = 0; k < 6; ++k) {
      const Vec6<double> rate = cross6_times(v, adjoint_times(c.H, Vec6<double>::unit(k)));
      for (int i = 0; i < 6; ++i) EXPECT_LE(error(rate[i], C_rate(i, k)), 4 * epsilon * path.speed);
    }
  });
}

TEST(VelocityIdentities, transitivity_of_velocities_and_differential_motions) {  // [1.63-1.66]
  for_motions(
      122,
      [](const Case& c, test::Random& random) {
        const Path path(c, random);
        const auto by = [&path](bool in_body, bool velocity, bool along_time) {
          const auto f = [&](const Real& x) {
            const Real t = along_time ? x : Real(0), e = along_time ? Real(0) : x;
            return in_body ? path.body(t, e, velocity, small) : path.inertial(t, e, velocity, small);
          };
          return Vec6<Real>(Real(1 / (2 * small)) * (f(small) - f(Real(-small))));
        };
        const Vec6<double> V = exact::rounded(path.inertial(0, 0, true, tiny)),
                           Vb = exact::rounded(path.body(0, 0, true, tiny));
        const Vec6<double> dU = exact::rounded(path.inertial(0, 0, false, tiny));
        const Vec6<double> dUb = exact::rounded(path.body(0, 0, false, tiny));
        EXPECT_LE(largest(adjoint_times(c.H, dUb) - dU), 4 * epsilon * path.speed * (1.0 + c.size));  // [1.65]
        const Vec6<Real> dV = by(false, true, false), dU_rate = by(false, false, true);
        const Vec6<Real> dVb = by(true, true, false), dUb_rate = by(true, false, true);
        const double scale = path.speed * path.speed;
        EXPECT_LE(error(velocity_variation(V, dU, exact::rounded(dU_rate)), dV), epsilon * scale);  // [1.66a]
        EXPECT_LE(error(adjoint_times(c.H, exact::rounded(dUb_rate)), dV), epsilon * scale);
        EXPECT_LE(error(body_velocity_variation(Vb, dUb, exact::rounded(dUb_rate)), dVb), epsilon * scale);  // [1.66b]
        EXPECT_LE(error(inverse_adjoint_times(c.H, exact::rounded(dU_rate)), dVb), epsilon * scale);
      },
      18);
}

TEST(VelocityIdentities, velocity_field_and_its_screw) {  // [1.50-1.54]
  for_motions(123, [](const Case& c, test::Random& random) {
    const Path path(c, random);
    const Vec6<Real> exact_V = path.inertial(0, 0, true, tiny);
    const Vec6<double> V = exact::rounded(exact_V);
    // The point now at s was at R^T (s - u) in the body.
    const Vec3<double> s = random.vector<3>();
    const Vec3<Real> in_body = transpose_times(c.R, Vec3<Real>(cast<Real>(s) - c.u));
    const auto position = [&](const Real& t) {
      const Frame<Real> H = path.pose(t, 0);
      return Vec3<Real>(H.x + H.R * in_body);
    };
    const Vec3<Real> rate = Real(1 / (2 * tiny)) * (position(tiny) - position(Real(-tiny)));
    EXPECT_LE(error(velocity_at(V, s), rate), 2 * epsilon * path.speed);  // [1.50]
    const VelocityScrew screw = velocity_screw(V);
    ASSERT_EQ(screw.kind, MotionKind::screw);
    const Vec3<Real> v = linear_part(exact_V), w = angular_part(exact_V);
    const Real ww = dot(w, w), speed = sqrt(ww);
    const double far = static_cast<double>(exact::norm(v) / speed);
    const Vec3<Real> point = Real(1 / ww) * cross(w, v);  // [1.52]
    EXPECT_LE(error(nearest_axis_point(screw), point), 8 * epsilon * far);
    EXPECT_LE(error(screw.axis, join(cross(point, Vec3<Real>(Real(1 / speed) * w)), Vec3<Real>(Real(1 / speed) * w))),
              8 * epsilon * (1.0 + far));  // [1.54]
    EXPECT_LE(error(screw.sliding_speed, dot(w, v) / speed), 4 * epsilon * far * screw.angular_speed);
    const Vec3<double> by_screw = screw.sliding_speed * angular_part(screw.axis) +
                                  cross(angular_part(V), s - nearest_axis_point(screw));  // [1.53]
    EXPECT_LE(error(by_screw, rate), 8 * epsilon * (path.speed + far * screw.angular_speed));
  });
}

TEST(VelocityIdentities, of_velocities_without_rotation_or_at_rest_are_decided) {
  const VelocityScrew sliding = velocity_screw({{0.0, 3.0, -4.0, 0.0, 0.0, 0.0}}),
                      rest = velocity_screw(Vec6<double>::zero());
  EXPECT_EQ(sliding.kind, MotionKind::translation);
  EXPECT_EQ(sliding.sliding_speed, 5.0);
  EXPECT_EQ(largest(nearest_axis_point(sliding)), 0.0);
  EXPECT_EQ(rest.kind, MotionKind::none);
  EXPECT_EQ(largest(nearest_axis_point(rest)), 0.0);
}

TEST(VelocityIdentities, quaternion_rate_is_that_of_the_rotation) {
  for_motions(124, [](const Case& c, test::Random& random) {
    const Path path(c, random);
    const auto quaternion = [&path](const Real& t) {
      const Vec3<Real> psi = Path::at(path.psi, t, 0);
      const Real phi = exact::norm(psi);
      const Real scale = phi == 0 ? Real(0.5) : Real(sin(phi / 2) / phi);
      return Quaternion<Real>{cos(phi / 2), scale * psi};
    };
    const Quaternion<Real> low = quaternion(Real(-tiny)), high = quaternion(tiny), now = quaternion(0);
    const Quaternion<double> q{static_cast<double>(now.w), exact::rounded(now.v)};
    const Vec3<Real> omega = angular_part(path.body(0, 0, true, tiny));
    const Quaternion<double> rate = quaternion_rate(q, exact::rounded(omega));
    EXPECT_LE(error(rate.w, (high.w - low.w) / (2 * tiny)), 2 * epsilon);
    EXPECT_LE(error(rate.v, Vec3<Real>(Real(1 / (2 * tiny)) * (high.v - low.v))), 2 * epsilon);
    EXPECT_LE(error(body_angular_velocity(q, rate), omega), 4 * epsilon);
    EXPECT_LE(std::abs(q.w * rate.w + dot(q.v, rate.v)), epsilon);
  });
}

TEST(VelocityIdentities, generalized_vector_products) {  // [1.37-1.41]
  for_motions(125, [](const Case& c, test::Random& random) {
    const Vec3<double> n = random.unit(), m = std::pow(10.0, 2.0 * random.number()) * random.vector<3>();
    const Vec6<double> N = join(m, n), V = random.vector<6>(), P = random.vector<6>();
    const Mat6<double> X = cross6(N);
    const double far = 1.0 + largest(m);
    // n is unit to epsilon only, and so is the identity.
    EXPECT_LE(largest(X * X * X + z_matrix(2.0 * dot(n, m), 1.0) * X), 16 * epsilon * far);  // [1.38]
    EXPECT_LE(largest(X * N), epsilon * far);
    EXPECT_LE(largest(cross6(V) * P + cross6(P) * V), 8 * epsilon);           // [1.39]
    EXPECT_LE(largest(transpose(cross6(V)) * P - hat6(P) * V), 8 * epsilon);  // [1.40-1.41]
    EXPECT_LE(largest(cross6_transpose_times(V, P) - hat6(P) * V), 3 * epsilon);
    // ~N3 = C^-1 ~N1 C is N3 = C^-1 N1 [1.37], here with C(N2) from the intrinsic form.
    const double alpha = 2.0 * random.number();
    const Mat6<double> C = motion_tensor(c.m, alpha), inverse = inverse_motion_tensor(c.m, alpha);
    const double scale = (1.0 + (1.0 + std::abs(alpha)) * c.screw_size);
    EXPECT_LE(largest(cross6(inverse * N) - inverse * X * C), 8 * epsilon * far * scale * scale);
    EXPECT_LE(largest(inverse * N - inverse_adjoint_times(c.H, N)), 8 * epsilon * far * scale);
  });
}

TEST(VelocityIdentities, screws_keep_magnitude_and_pitch_under_a_change_of_frame) {  // [1.68-1.71]
  for_motions(126, [](const Case& c, test::Random& random) {
    const double size = std::pow(10.0, 3.0 * random.number());
    const Vec6<double> S = join(random.vector<3>(), Vec3<double>(size * random.unit()));
    const Screw s = screw_of(S), moved = moved_screw(c.H, s);
    const double far = 1.0 + 1.0 / size;
    EXPECT_LE(largest(vector_of(s) - S), 4 * epsilon * (1.0 + size));
    EXPECT_LE(std::abs(dot(s.point, s.n)), 2 * epsilon * far);
    const Vec6<Real> exact = exact::motion_tensor(c.R, c.u) * cast<Real>(S);
    EXPECT_LE(error(vector_of(moved), exact), 12 * epsilon * (1.0 + size) * (1.0 + c.size));
    const Screw again = screw_of(exact::rounded(exact));
    EXPECT_NEAR(again.magnitude, s.magnitude, 4 * epsilon * size);
    EXPECT_NEAR(again.h, s.h, 8 * epsilon * (far + c.size));
  });
  const Screw couple = screw_of({{0.0, 0.0, -2.0, 0.0, 0.0, 0.0}}), none = screw_of(Vec6<double>::zero());
  EXPECT_EQ(couple.kind, MotionKind::translation);
  EXPECT_EQ(couple.magnitude, 2.0);
  EXPECT_EQ(vector_of(couple)[2], -2.0);
  EXPECT_EQ(vector_of(moved_screw(Frame<double>{Mat3<double>::identity(), {{1.0, 2.0, 3.0}}}, couple))[2], -2.0);
  EXPECT_EQ(none.kind, MotionKind::none);
  EXPECT_EQ(largest(vector_of(none)), 0.0);
}

TEST(VelocityIdentities, derivatives_on_rotations_match_differences_at_50_digits) {
  for_motions(127, [](const Case& c, test::Random& random) {
    const Vec3<double> psi = exact::rounded(c.psi), a = random.vector<3>(), b = random.vector<3>();
    const Vec3<Real> ra = cast<Real>(a), rb = cast<Real>(b);
    const auto rotated = [&](const Vec3<Real>& x) { return Vec3<Real>(exact::rotation(x) * ra); };
    EXPECT_LE(error(rotation_derivative(psi, a) * b, exact::slope(rotated, c.psi, rb)), 16 * epsilon);
    const auto T = [&](const Vec3<Real>& x, bool transposed) {
      const Real xx = dot(x, x), p = transposed ? exact::stumpff(2, xx) : Real(-exact::stumpff(2, xx));
      return Vec3<Real>(ra + p * cross(x, ra) + exact::stumpff(3, xx) * cross(x, cross(x, ra)));
    };
    for (const bool transposed : {false, true}) {
      const auto f = [&](const Vec3<Real>& x) { return T(x, transposed); };
      const Mat3<double> slope = transposed ? tangent_so3_transpose_derivative(psi, a) : tangent_so3_derivative(psi, a);
      EXPECT_LE(error(slope * b, exact::slope(f, c.psi, rb)), 8 * epsilon);
    }
    // T^-1 a = a +- psi x a/2 + k psi x (psi x a), k = (1 - (phi/2) cot(phi/2))/phi^2 = (c_3 - 2 c_4)/(2 c_2).
    const auto inverse = [&](const Vec3<Real>& x, bool transposed) {
      const Real xx = dot(x, x), c2 = exact::stumpff(2, xx), c3 = exact::stumpff(3, xx), c4 = exact::stumpff(4, xx);
      const Real k = (c3 - 2 * c4) / (2 * c2), half(transposed ? -0.5 : 0.5);
      return Vec3<Real>(ra + half * cross(x, ra) + k * cross(x, cross(x, ra)));
    };
    const double room = 1.0 + 1.0 / std::pow(2.0 * std::numbers::pi - static_cast<double>(c.phi), 2);
    for (const bool transposed : {false, true}) {
      const auto f = [&](const Vec3<Real>& x) { return inverse(x, transposed); };
      const Mat3<double> slope =
          transposed ? inverse_tangent_so3_transpose_derivative(psi, a) : inverse_tangent_so3_derivative(psi, a);
      EXPECT_LE(error(slope * b, exact::slope(f, c.psi, rb)), 64 * epsilon * room);
    }
  });
}

}  // namespace
}  // namespace bough::motion
