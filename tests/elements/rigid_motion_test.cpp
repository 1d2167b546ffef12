/// Turning and moving everything, also far from the origin, and the precision of strains.
#include <gtest/gtest.h>

#include "elements/check_element.hpp"

namespace bough::elements::check {
namespace {

/// Everything turned by Q and moved: nodes, ground and what has a direction in space.
template <class E>
Sample<E> carried(const Sample<E>& s, const Mat3<double>& Q, const Vec3<double>& shift) {
  Sample<E> r = s;
  for (NodeMotion& n : r.nodes) {
    const Vec3<double> turned = Q * n.x.hi;
    n.R = Q * n.R;
    n.x = motion::Vec3Pair::from(shift);
    n.x.add(turned);
  }
  for (Port& port : r.element.ports)
    if (port.node == ground) port.offset = {Q * port.offset.R, shift + Q * port.offset.x};
  if constexpr (requires { r.element.follows; })
    if (!r.element.follows)
      r.element.wrench =
          lanes::join<double>(Q * lanes::linear_part(s.element.wrench), Q * lanes::angular_part(s.element.wrench));
  return r;
}

template <class E>
void expect_frame_invariance(const Sample<E>& s, const Mat3<double>& Q, const Vec3<double>& shift) {
  SCOPED_TRACE(s.name);
  const Sample<E> moved = carried(s, Q, shift);
  bool grounded = false;
  for (const Port& port : s.element.ports) grounded = grounded || port.node == ground;
  // Sizes near one, nodes as pairs: round-off of the turned frames only (some 1e-16 each), wherever they are. What is
  // fixed to the ground has plain doubles: 200 m away an ulp is 3e-14 m.
  const double far = std::abs(shift[0]) > 10.0 && grounded ? 5e-13 : 2e-14;
  for (const bool has_inertia : {false, true}) {
    Field here = s.field(has_inertia, Slopes{3.1, 7.3, false}), there = moved.field(has_inertia, here.slopes);
    there.around.gravity = Q * here.around.gravity;
    const Evaluation a = evaluation_of(s, here), b = evaluation_of(moved, there);
    EXPECT_LE(relative_error(a.residual, b.residual, 1.0), far);
    EXPECT_LE(relative_error(a.tangent, b.tangent, 1.0), far);
  }
}

TEST(RigidMotion, turns_and_moves_all_elements_without_a_change_of_forces_and_tangents) {
  Numbers numbers(7);
  const Mat3<double> Q = motion::exp_so3(numbers.vec3(2.0));
  for_all_elements([&](const auto& s) { expect_frame_invariance(s, Q, Vec3<double>{{0.3, -0.7, 0.4}}); });
}

TEST(RigidMotion, by_two_hundred_metres_costs_no_digit) {
  Numbers numbers(8);
  const Mat3<double> Q = motion::exp_so3(numbers.vec3(2.0));
  for_all_elements([&](const auto& s) { expect_frame_invariance(s, Q, Vec3<double>{{200.1, -134.7, 87.3}}); });
}

TEST(RigidMotion, is_free_of_strain) {
  Numbers numbers(9);
  const auto check = [&](auto s) {
    s.element.has_mass = false;
    std::vector<Frame<double>> poses;
    for (const NodeMotion& n : s.nodes) poses.push_back({n.R, n.x.hi});
    set_reference(s.element, still(poses).data());
    for (int turn = 0; turn < 5; ++turn) {
      const auto moved = carried(s, motion::exp_so3(numbers.vec3(3.0)), numbers.vec3(300.0));
      EXPECT_LE(largest(residual_of(moved, moved.field(false))), 3e-14);
    }
  };
  check(beam_sample<2>(Ends::plain));
  check(beam_sample<3>(Ends::plain));
  check(beam_sample<4>(Ends::plain));
}

/// Strain in double against the same kernel in long double, of the same (rounded) node poses.
template <int N>
double strain_error(const std::vector<Frame<double>>& poses, double length) {
  std::vector<PortMotion<long double>> precise;
  for (const Frame<double>& H : poses)
    precise.push_back({motion::cast<long double>(H), Vec6<long double>::zero(), Vec6<long double>::zero()});
  const BeamShape<double, N> b = eval_shape<double, N>(still(poses).data());
  const BeamShape<long double, N> exact = eval_shape<long double, N>(precise.data());
  double worst = 0.0;
  for (int g = 0; g < N - 1; ++g) {
    const Vec6<double> e = eval_strain<double, N>(b, length, g);
    const Vec6<long double> e_exact = eval_strain<long double, N>(exact, length, g);
    long double size = 0.0L, difference = 0.0L;
    for (int i = 0; i < 6; ++i) {
      size = std::max(size, std::abs(e_exact[i]));
      difference = std::max(difference, std::abs(e[i] - e_exact[i]));
    }
    worst = std::max(worst, static_cast<double>(difference / size));
  }
  return worst;
}

/// Helix whose end is turned by `angle` against the start.
template <int N>
double strain_error_at(double angle, Numbers& numbers) {
  Vec6<double> e = lanes::join(Vec3<double>{{1.0, 0.1, -0.05}}, numbers.vec3());
  const double size = std::sqrt(lanes::dot(lanes::angular_part(e), lanes::angular_part(e)));
  for (int i = 3; i < 6; ++i) e[i] *= angle / size;
  return strain_error<N>(helix(N, 1.0, e, 0.0, numbers), 1.0);
}

TEST(StrainPrecision, holds_from_no_rotation_to_nearly_half_a_turn) {
  Numbers numbers(10);
  double worst[3] = {0.0, 0.0, 0.0};
  for (const double angle : {0.0, 1e-15, 1e-12, 1e-8, 1e-5, 1e-3, 0.1, 1.0, 2.0, 2.5, 3.0})
    for (int sample = 0; sample < 20; ++sample) {
      worst[0] = std::max(worst[0], strain_error_at<2>(angle, numbers));
      worst[1] = std::max(worst[1], strain_error_at<3>(angle, numbers));
      worst[2] = std::max(worst[2], strain_error_at<4>(angle, numbers));
    }
  // Some ten roundings, of strains up to 3; slopes of more nodes amplify by the sum of |N_i'| (4 and 8).
  EXPECT_LE(worst[0], 2e-15);
  EXPECT_LE(worst[1], 4e-15);
  EXPECT_LE(worst[2], 8e-15);
  RecordProperty("worst_of_two_nodes", std::to_string(worst[0]));
}

TEST(StrainPrecision, small_curvatures_keep_their_own_relative_digits) {
  // The rotation part of a two-node element is the logarithm of R alone: relative to itself, not to the axial 1.
  for (const double angle : {1e-15, 1e-12, 1e-8, 1e-4}) {
    const Vec6<double> d{{1.0, 0.0, 0.0, angle, -2.0 * angle, 0.5 * angle}};
    const auto poses = std::vector<Frame<double>>{Frame<double>::identity(), motion::exp_se3(d)};
    const Vec6<double> e = eval_strain<double, 2>(eval_shape<double, 2>(still(poses).data()), 1.0, 0);
    for (int i = 3; i < 6; ++i) EXPECT_NEAR(e[i], d[i], 1e-15 * angle * 4);
  }
}

}  // namespace
}  // namespace bough::elements::check
