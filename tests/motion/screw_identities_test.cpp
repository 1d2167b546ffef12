// Identities of the screw of a motion and of the motion tensor, 1000 random motions and more each, over all angles:
// results against 50 digits. Bounds are multiples of round-off times the scale of the case: |u| for displacements,
// |u|/(2 sin (phi/2)) for the axis, |d| + phi |w| where (d, phi, w, n) is given. Numbers in brackets: equations,
// data/manual/theory/motions.md.
#include "bough/motion/composition.hpp"
#include "bough/motion/half_angle.hpp"
#include "bough/motion/plucker.hpp"
#include "exact.hpp"

namespace bough::motion {
namespace {

using exact::Case;
using exact::error;
using exact::for_motions;
using exact::Real;
using test::epsilon;
using test::largest;

TEST(ScrewIdentities, half_rotation_squares_to_the_rotation_and_gives_it_less_the_identity) {
  for_motions(101, [](const Case& c, test::Random& random) {
    if (c.phi > exact::pi()) return;
    const Mat3<double> G = half_rotation(c.H.R);
    // Near pi the two half rotations are G and its turn by pi.
    const bool other = c.phi > Real(3.14) && error(G, c.G) > 1.0;
    const Mat3<Real> turned = c.G * exact::rotation(c.n, exact::pi());
    EXPECT_LE(error(G, other ? turned : c.G), 4 * epsilon);
    EXPECT_LE(error(G * G, c.R), 8 * epsilon);
    const Vec3<double> s = random.vector<3>();
    const Vec3<Real> change = c.R * lanes::cast<Real>(s) - lanes::cast<Real>(s);
    const Real sine = sin(c.phi / 2);
    EXPECT_LE(exact::norm(change - Real(2 * sine) * (c.G * cross(c.n, lanes::cast<Real>(s)))), 1e-45);  // the oracle
    const Quaternion<double> q = normalise(quaternion_of(c.H.R));
    EXPECT_LE(error(rotation_change(q, s), change), 8 * epsilon * static_cast<double>(2 * sine)) << "relative to phi";
  });
}

TEST(ScrewIdentities, every_form_of_the_displacement_field_is_the_same_field) {  // [1.2, 1.6, 1.7, 1.11]
  for_motions(102, [](const Case& c, test::Random& random) {
    const Vec3<double> s = std::pow(10.0, 3.0 * random.number()) * random.vector<3>();
    const Vec3<Real> r = lanes::cast<Real>(s), exact = c.u + c.R * r - r;
    const double reach = static_cast<double>(exact::norm(r));
    EXPECT_LE(error(point_displacement(c.H, s), exact), 8 * epsilon * (c.size + reach));                  // [1.2]
    EXPECT_LE(error(displacement_at(c.m, s), exact), 8 * epsilon * (c.screw_size + reach));               // [1.11]
    EXPECT_LE(error(displacement_at(intrinsic_motion(c.H), s), exact), 16 * epsilon * (c.size + reach));  // [1.11]
    const Vec3<double> q = nearest_axis_point(c.m), about = s - q;
    const Vec3<double> by_axis = c.m.d * c.m.n + rotation_change(normalise(quaternion_of(c.H.R)), about);  // [1.6]
    EXPECT_LE(error(by_axis, exact), 8 * epsilon * (c.screw_size + reach + largest(q)));
    EXPECT_LE(error(dot(c.m.n, displacement_at(c.m, s)), c.d), 8 * epsilon * (c.screw_size + reach));  // [1.7]
  });
}

TEST(ScrewIdentities, the_intrinsic_motion_is_the_exact_one) {  // [1.5, 1.7, 1.9, 1.10, 1.47]
  for_motions(103, [](const Case& c, test::Random&) {
    const IntrinsicMotion m = intrinsic_motion(c.H);
    ASSERT_EQ(m.kind, c.m.kind);
    // Beyond pi the rotation is the shorter one about -n, with the same axis line reversed.
    const bool beyond = c.phi > exact::pi();
    const Real phi = beyond ? Real(2 * exact::pi() - c.phi) : c.phi;
    const double near_pi = static_cast<double>(abs(exact::pi() - c.phi));
    const double turn = near_pi < 1e-10 && dot(m.n, c.m.n) * (beyond ? -1.0 : 1.0) < 0.0 ? -1.0 : 1.0;
    const Real sign = Real(turn * (beyond ? -1.0 : 1.0));
    EXPECT_LE(error(m.phi, turn < 0 ? Real(2 * exact::pi() - phi) : phi), 4 * epsilon * std::fmax(m.phi, 1e-300));
    EXPECT_LE(error(m.n, Vec3<Real>(sign * c.n)), 3 * epsilon);
    EXPECT_LE(error(m.d, Real(sign * c.d)), 3 * epsilon * c.size);
    EXPECT_LE(error(m.w, Vec3<Real>(sign * c.w)), 10 * epsilon * c.axis_size);
    EXPECT_LE(std::abs(dot(m.n, m.w)), 3 * epsilon * c.axis_size);
    EXPECT_NEAR(dot(m.n, m.n), 1.0, 4 * epsilon);
    EXPECT_LE(error(nearest_axis_point(m), cross(c.n, c.w)), 12 * epsilon * c.axis_size);  // [1.5]
    if (c.m.kind != MotionKind::screw) return;
    const Real half = 1 / (2 * sin(c.phi / 2));
    const Vec3<Real> Gu = transpose_times(c.G, c.u);
    const Vec3<Real> moment = -(half * cross(c.n, cross(c.n, Gu)));  // [1.9]
    EXPECT_LE(error(mozzi_chasles_axis(m), Vec6<Real>(sign * join(moment, c.n))), 12 * epsilon * (1.0 + c.axis_size));
    EXPECT_LE(error(pitch(m), Real(2 * exact::pi() * sign * c.d / m.phi)),
              6 * epsilon * c.size * 6.3 / m.phi);  // [1.8]
  });
}

TEST(ScrewIdentities, the_motion_of_a_screw_is_the_exact_one_up_to_two_pi) {  // [1.46]
  for_motions(104, [](const Case& c, test::Random&) {
    const Frame<double> H = frame_of(c.m);
    EXPECT_LE(error(H.R, c.R), 2.5 * epsilon * (1.0 + c.m.phi));
    EXPECT_LE(error(H.x, c.u), 3 * epsilon * c.screw_size);
  });
}

TEST(ScrewIdentities, points_of_a_cylinder_about_the_axis_move_by_one_distance) {  // [Ex. 1.1]
  for_motions(105, [](const Case& c, test::Random& random) {
    const Vec3<Real> across = cross(c.n, lanes::cast<Real>(random.unit()));
    const double rho = std::pow(10.0, 2.0 * random.number());
    const Vec3<Real> r = cross(c.n, c.w) + Real(random.number()) * c.n + Real(rho / exact::norm(across)) * across;
    const Vec3<Real> moved = c.u + c.R * r - r;
    EXPECT_LE(error(displacement_on_cylinder(c.m, rho), exact::norm(moved)), 4 * epsilon * (std::abs(c.m.d) + 6 * rho));
  });
}

TEST(ScrewIdentities, the_motion_tensor_its_factors_columns_and_inverse_are_exact) {  // [1.14-1.20]
  for_motions(106, [](const Case& c, test::Random& random) {
    const Mat6<Real> C = exact::motion_tensor(c.R, c.u);
    const double bound = 2 * epsilon * (1.0 + c.size);
    EXPECT_LE(error(adjoint(c.H), C), bound);
    EXPECT_LE(error(translation_factor(c.H) * rotation_factor(c.H), C), bound);                   // [1.19]
    const Mat6<Real> inverse = exact::motion_tensor(transpose(c.R), -transpose_times(c.R, c.u));  // [1.20]
    EXPECT_LE(largest(exact::rounded(inverse * C - Mat6<Real>::identity())), 1e-40);
    EXPECT_LE(error(inverse_adjoint(c.H), inverse), bound);
    for (int k = 0; k < 6; ++k) {  // [1.16-1.18]
      const Vec6<double> axis = moved_axis(c.H, k);
      for (int i = 0; i < 6; ++i) EXPECT_LE(error(axis[i], C(i, k)), bound);
    }
    const Vec3<double> point = random.vector<3>(), direction = random.unit();
    const Vec6<double> line = *line_along(point, direction), moved = moved_line(c.H, line);  // [1.15]
    const Vec3<Real> there = c.u + c.R * lanes::cast<Real>(point), l = c.R * lanes::cast<Real>(direction);
    EXPECT_LE(error(moved, join(cross(there, l), l)), 4 * bound);
    EXPECT_LE(*distance_from(moved, exact::rounded(there)), 4 * bound);
  });
}

TEST(ScrewIdentities, lines_keep_their_mutual_moment_and_lie_where_their_points_are) {
  for_motions(107, [](const Case& c, test::Random& random) {
    const Vec3<double> a = random.vector<3>(), b = a + random.unit();
    const Vec6<double> line = *line_through(a, b), other = *line_along(random.vector<3>(), random.unit());
    EXPECT_LE(*distance_from(line, a), 8 * epsilon);
    EXPECT_LE(*distance_from(line, b), 3 * epsilon);
    EXPECT_LE(std::abs(dot(linear_part(line), angular_part(line))), 2 * epsilon);
    const Vec3<double> nearest = *nearest_point(line);
    EXPECT_LE(*distance_from(line, nearest), 8 * epsilon);
    EXPECT_LE(std::abs(dot(nearest, angular_part(line))), 2 * epsilon);
    EXPECT_LE(largest(linear_part(line_about(line, nearest))), 8 * epsilon);
    EXPECT_NEAR(mutual_moment(moved_line(c.H, line), moved_line(c.H, other)), mutual_moment(line, other),
                6 * epsilon * (1.0 + c.size));
    EXPECT_LE(std::abs(mutual_moment(line, *line_along(a, random.unit()))), 8 * epsilon) << "lines that meet";
  });
  EXPECT_FALSE(line_along({{1.0, 2.0, 3.0}}, Vec3<double>::zero()).has_value());
  EXPECT_FALSE(line_through({{1.0, 2.0, 3.0}}, {{1.0, 2.0, 3.0}}).has_value());
  EXPECT_FALSE(nearest_point(Vec6<double>::unit(1)).has_value());
  EXPECT_FALSE(distance_from(Vec6<double>::unit(1), Vec3<double>::zero()).has_value());
}

TEST(ScrewIdentities, screw_vectors_are_eigenvectors_for_any_alpha) {  // [1.21-1.25]
  for_motions(108, [](const Case& c, test::Random& random) {
    const double alpha = random.number() < -0.5 ? 0.0 : 3.0 * random.number();
    const Vec6<double> N1 = first_eigenvector(c.m), N = screw_vector(c.m, alpha);
    const Mat6<Real> C = exact::motion_tensor(c.R, c.u);
    EXPECT_LE(error(N1, Vec6<Real>(C * lanes::cast<Real>(N1))), 2 * epsilon * (1.0 + c.size));
    const double scale = 1.0 + c.size + largest(N);
    EXPECT_LE(error(N, Vec6<Real>(C * lanes::cast<Real>(N))), 2 * epsilon * scale);
    EXPECT_LE(largest(screw_vector(c.m, 0.0) - mozzi_chasles_axis(c.m)), 0.0);  // [1.25]
    if (c.m.kind == MotionKind::translation) {
      EXPECT_EQ(screw_lambda(c.m, alpha).has_value(), alpha == 0.0);
      return;
    }
    const Real lambda = alpha * c.d / (2 * sin(c.phi / 2));
    const Vec6<Real> exact = join(Vec3<Real>(lambda * c.n + c.w), c.n);  // [1.22]
    const double far = 1.0 + (1.0 + std::abs(alpha)) * c.axis_size * 6.0;
    EXPECT_LE(error(N, exact), 2 * epsilon * far);
    EXPECT_LE(error(*screw_lambda(c.m, alpha), lambda), 2 * epsilon * far);  // [1.24]
    EXPECT_LE(error(dot(angular_part(N), linear_part(N)), lambda), 2 * epsilon * far);
    const Real half = 1 / (2 * sin(c.phi / 2));
    const Vec6<Real> N2 = join(Vec3<Real>(half * transpose_times(c.G, c.u)), c.n);  // [1.21]
    EXPECT_LE(error(screw_vector(c.m, 1.0), N2), 2 * epsilon * far);
  });
}

TEST(ScrewIdentities, E_and_J_take_displacements_to_moments_and_back) {  // [1.26-1.29]
  for_motions(109, [](const Case& c, test::Random& random) {
    const double alpha = (random.number() < 0.0 ? -1.0 : 1.0) * (0.1 + std::abs(random.number()));
    const auto E = moment_of_displacement(c.m.n, c.m.phi, alpha);
    const auto J = displacement_of_moment(c.m.n, c.m.phi, alpha);
    ASSERT_EQ(E.has_value(), c.phi != 0);
    ASSERT_TRUE(J.has_value());
    EXPECT_FALSE(displacement_of_moment(c.m.n, c.m.phi, 0.0).has_value());
    if (c.phi == 0) {
      EXPECT_EQ(largest(*J), 0.0);
      return;
    }
    const Real sine = sin(c.phi / 2), a = alpha / (2 * sine);
    const Mat3<Real> N = skew(c.n), I = Mat3<Real>::identity();
    const Mat3<Real> exact_E = a * I - Real(0.5) * N + Real(a - 1 / (2 * tan(c.phi / 2))) * (N * N);
    const Mat3<Real> exact_J = Real(1 / a) * I + Real(1 - cos(c.phi)) * N + Real(1 / a - sin(c.phi)) * (N * N);
    EXPECT_LE(largest(exact::rounded(exact_E * exact_J - I)), 1e-30);  // the oracle
    const double size_E = (1.0 + std::abs(alpha)) / static_cast<double>(abs(2 * sine));
    // The rounded angle: 2 pi - phi is known to epsilon phi only.
    const double room = std::fmax(1.0, static_cast<double>(c.phi) / static_cast<double>(abs(2 * sine)));
    EXPECT_LE(error(*E, exact_E), 4 * epsilon * size_E * room);
    const double small = std::fmin(1.0, static_cast<double>(c.phi));
    EXPECT_LE(error(*J, exact_J), 2 * epsilon * (2.0 + 2.0 / std::abs(alpha)) * small * room);
    const Vec3<Real> m = Real(a * c.d) * c.n + c.w;
    EXPECT_LE(largest(exact::rounded(exact_E * c.u - m)), 1e-30 * (1.0 + c.axis_size));  // [1.26]
    EXPECT_LE(error(*E * c.H.x, m), 8 * epsilon * size_E * room * c.size);
    EXPECT_LE(error(*J * exact::rounded(m), c.u),
              epsilon * (2.0 + 2.0 / std::abs(alpha)) * room * room * c.size * (1.0 + std::abs(alpha)));
  });
}

TEST(ScrewIdentities, the_intrinsic_tensor_and_its_inverse_are_the_motion_tensor_for_any_alpha) {  // [1.32-1.36]
  for_motions(110, [](const Case& c, test::Random& random) {
    const double alpha = 3.0 * random.number();
    const IntrinsicCoefficients k = intrinsic_coefficients(c.m.phi, alpha);
    EXPECT_LE(error(k.c1, Real(cos(c.phi) - alpha * cos(c.phi / 2))), 8 * epsilon * (1.0 + std::abs(alpha)));
    EXPECT_LE(error(k.c2, Real(sin(c.phi) - 2 * alpha * sin(c.phi / 2))), 8 * epsilon * (1.0 + std::abs(alpha)));
    const Mat6<Real> C = exact::motion_tensor(c.R, c.u);
    const Mat6<Real> inverse = exact::motion_tensor(transpose(c.R), -transpose_times(c.R, c.u));
    const double bound = 8 * epsilon * (1.0 + (1.0 + std::abs(alpha)) * c.screw_size);
    EXPECT_LE(error(motion_tensor(c.m, alpha), C), bound);
    EXPECT_LE(error(inverse_motion_tensor(c.m, alpha), inverse), bound);
    const Mat6<double> N = cross6(screw_vector(c.m, alpha)), Z = z_matrix(random.number(), random.number());
    EXPECT_LE(largest(Z * N - N * Z), 8 * epsilon * (1.0 + largest(N)));
  });
}

TEST(ScrewIdentities, relative_motion_in_the_inertial_and_in_the_moving_frame) {  // [1.42-1.49]
  for_motions(111, [](const Case& l, test::Random& random) {
    const Case k = exact::make_case(random, 3.0 * std::abs(random.number()));
    const Mat3<Real> R = l.R * transpose(k.R), moving = transpose_times(k.R, l.R);
    const Vec3<Real> u = l.u - k.u, u_O = u - (R * k.u - k.u);  // [1.44]
    const double scale = k.size + l.size;
    const Frame<double> carried = relative_in_inertial(k.H, l.H), seen = relative(k.H, l.H);
    EXPECT_LE(error(carried.R, R), 3 * epsilon);
    EXPECT_LE(error(carried.x, u_O), 12 * epsilon * scale);
    EXPECT_LE(error(seen.R, moving), 3 * epsilon);  // [1.49]
    EXPECT_LE(error(seen.x, Vec3<Real>(transpose_times(k.R, u))), 4 * epsilon * scale);
    const Mat6<double> C = adjoint(l.H) * inverse_adjoint(k.H), C_star = inverse_adjoint(k.H) * adjoint(l.H);
    EXPECT_LE(largest(C - adjoint(carried)), 12 * epsilon * (1.0 + scale));   // [1.42]
    EXPECT_LE(largest(C_star - adjoint(seen)), 6 * epsilon * (1.0 + scale));  // [1.48]
    // Intrinsic set and back [1.46-1.47].
    const IntrinsicMotion m = intrinsic_motion(carried);
    EXPECT_LE(largest(frame_of(m).x - carried.x), 16 * epsilon * (1.0 + largest(carried.x)));
    // What an element sees does not change when the whole moves rigidly; in the inertial frame it is carried along.
    const Case move = exact::make_case(random, 3.0 * std::abs(random.number()));
    const Frame<double> again = relative(compose(move.H, k.H), compose(move.H, l.H));
    EXPECT_LE(largest(again.R - seen.R), 6 * epsilon);
    EXPECT_LE(largest(again.x - seen.x), 8 * epsilon * (scale + move.size));
  });
}

// Two frames far from the origin that hardly move against each other.
TEST(ScrewIdentities, small_relative_motions_far_away_lose_no_digits_to_the_distance) {
  for_motions(112, [](const Case& c, test::Random& random) {
    if (c.phi > Real(1e-3)) return;
    const Vec3<double> far = 1e6 * random.unit();
    const Frame<double> k{Mat3<double>::identity(), far}, l{c.H.R, far + Vec3<double>(c.H.x)};
    const Vec3<Real> u = lanes::cast<Real>(l.x) - lanes::cast<Real>(k.x);
    const Vec3<Real> u_O = u - (c.R * lanes::cast<Real>(far) - lanes::cast<Real>(far));
    EXPECT_LE(error(relative_in_inertial(k, l).x, u_O),
              4 * epsilon * (static_cast<double>(exact::norm(u)) + static_cast<double>(c.phi) * 1e6));
  });
}

}  // namespace
}  // namespace bough::motion
