/// Operators of a group (operators.hpp) against the 6x6 forms of se3.hpp, in space and for motions within a plane,
/// and their second derivatives against the complex step of the first.
#include <gtest/gtest.h>

#include <complex>

#include "bough/motion/operators.hpp"
#include "samples.hpp"

namespace bough::motion {
namespace {

using Complex = std::complex<double>;

/// Where the components of a group's vectors stand among those of space.
template <class G>
constexpr int place(int i) {
  return G::dof == 6 ? i : i == 2 ? 5 : i;
}
template <class G>
Vec6<double> in_space(const typename G::template Vector<double>& v) {
  Vec6<double> r = Vec6<double>::zero();
  for (int i = 0; i < G::dof; ++i) r[place<G>(i)] = v[i];
  return r;
}
/// The largest difference of a vector or matrix of the group from what the group sees of one in space.
template <class G>
double difference(const typename G::template Vector<double>& v, const Vec6<double>& expected) {
  double most = 0.0;
  for (int i = 0; i < G::dof; ++i) most = std::max(most, std::abs(v[i] - expected[place<G>(i)]));
  return most;
}
template <class G>
double difference(const typename G::template Matrix<double>& m, const Mat6<double>& expected) {
  double most = 0.0;
  for (int i = 0; i < G::dof; ++i)
    for (int j = 0; j < G::dof; ++j) most = std::max(most, std::abs(m(i, j) - expected(place<G>(i), place<G>(j))));
  return most;
}
template <class G, class M>
typename G::template Matrix<double> on_motions(const M& m) {
  return G::block_product(G::template Matrix<double>::identity(), m);
}
template <class G>
typename G::template Matrix<double> on_wrenches(const typename G::template WrenchMap<double>& w) {
  auto m = G::template Matrix<double>::zero();
  G::add_wrench_map(m, w);
  return m;
}

template <class G>
struct Vectors {
  typename G::template Vector<double> d, x, y, n;
  Vectors(double phi, test::Random& random) {
    d = x = y = n = G::template Vector<double>::zero();
    const Vec6<double> motion = random.motion(phi);
    for (int i = 0; i < G::dof; ++i) {
      d[i] = motion[place<G>(i)];
      x[i] = random.number();
      y[i] = random.number();
      n[i] = random.number();
    }
    if (G::dof == 3) d[2] = random.number() < 0.0 ? -phi : phi;
  }
};

/// `operator_at`: the 6x6 form; `growth`: of what is compared near a pole.
template <class G, class F, class Operator>
void expect_like_six_by_six(const F& f, const Vectors<G>& v, const Operator& operator_at, double bound, bool has_pole) {
  const Vec6<double> d = in_space<G>(v.d), x = in_space<G>(v.x), y = in_space<G>(v.y), n = in_space<G>(v.n);
  const auto op = operator_at(d);
  const auto mx = G::motion(v.x), my = G::motion(v.y), wn = G::wrench(v.n);
  EXPECT_LT(difference<G>(G::vector_of_motion(times(f, my)), op.times(y)), bound);
  EXPECT_LT(difference<G>(G::vector_of_wrench(transpose_times(f, wn)), op.transpose_times(n)), bound);
  EXPECT_LT(difference<G>(on_motions<G>(matrix(f)), op.matrix()), bound);
  EXPECT_LT(difference<G>(G::vector_of_motion(G::times(matrix(f), my)), op.times(y)), bound);
  EXPECT_LT(difference<G>(G::vector_of_wrench(G::transpose_times(matrix(f), wn)), op.transpose_times(n)), bound);
  EXPECT_LT(difference<G>(on_motions<G>(jacobian(f, my)), op.derivative(y)), bound);
  EXPECT_LT(difference<G>(on_wrenches<G>(transpose_jacobian(f, wn)), op.transpose_derivative(n)), bound);
  EXPECT_LT(difference<G>(G::vector_of_motion(G::widened(slope_times(f, mx, my))), op.slope_times(x, y)), bound);
  EXPECT_LT(difference<G>(G::vector_of_motion(G::widened(G::times(slope_matrix(f, mx), my))), op.slope_times(x, y)),
            bound);
  const Mat6<double> second = test::complex_step<6>(
      [&](const Vec6<Complex>& z) {
        return operator_at(z).slope_times(lanes::cast<Complex>(x), lanes::cast<Complex>(y));
      },
      d);
  EXPECT_LT(difference<G>(on_motions<G>(second_jacobian(f, mx, my)), second),
            bound * (has_pole ? 1.0 + test::largest(second) : 1.0));
}

template <class G>
void expect_operators(unsigned seed) {
  test::Random random(seed);
  for (const double phi : test::angles_beyond_pi()) {
    SCOPED_TRACE(phi);
    const Vectors<G> v(phi, random);
    const auto at = G::motion(v.d);
    const auto T = eval_tangent_operator<G, double>(at);
    const double bound = 64 * test::epsilon;
    expect_like_six_by_six<G>(
        T, v, [](const auto& z) { return tangent_operator(z); }, bound, false);
    const auto gradient = [&](const Vec6<Complex>& z) {
      return lanes::transpose_times(tangent_operator(z).derivative(lanes::cast<Complex>(in_space<G>(v.y))),
                                    lanes::cast<Complex>(in_space<G>(v.n)));
    };
    EXPECT_LT(difference<G>(on_wrenches<G>(hessian(T, G::wrench(v.n), G::motion(v.y))),
                            test::complex_step<6>(gradient, in_space<G>(v.d))),
              bound);
    // near 2 pi the inverse has a pole: entries grow with k and its first derivative, which lose digits to the
    // distance from it
    const auto k = eval_inverse_coefficients(phi * phi);
    const double size = (1.0 + std::abs(k.k) + std::abs(k.dk)) / (1.0 - phi / (2.0 * std::numbers::pi));
    expect_like_six_by_six<G>(
        eval_inverse_tangent_operator<G, double>(at), v, [](const auto& z) { return inverse_tangent_operator(z); },
        bound * size, true);
  }
}

TEST(GroupOperators, in_space_are_those_of_six_by_six_matrices) { expect_operators<Se3>(31); }
TEST(GroupOperators, in_a_plane_are_those_of_six_by_six_matrices) { expect_operators<Se2>(32); }

/// Poses of the group, as poses in space.
Frame<double> in_space(const Frame<double>& H) { return H; }
Frame<double> in_space(const PlanePose<double>& H) {
  return {{{H.R[0], -H.R[1], 0, H.R[1], H.R[0], 0, 0, 0, 1}}, {{H.x[0], H.x[1], 0}}};
}

template <class G>
void expect_poses(unsigned seed) {
  test::Random random(seed);
  for (const double phi : test::angles_up_to_pi()) {
    SCOPED_TRACE(phi);
    const Vectors<G> v(phi, random), w(1.0, random);
    const auto H = G::template exp<double>(v.d), K = G::template exp<double>(w.d);
    const auto log = eval_log<G, double>(H);
    EXPECT_LT(difference<G>(G::vector_of_motion(log.d), in_space<G>(v.d)), 32 * test::epsilon);
    EXPECT_LT(difference<G>(G::vector_of_motion(times(log, G::motion(v.y))),
                            inverse_tangent_times(in_space<G>(v.d), in_space<G>(v.y))),
              64 * test::epsilon);
    const Frame<double> relative = motion::relative(in_space(H), in_space(K)), r = in_space(G::relative(H, K));
    EXPECT_LT(test::largest(r.R - relative.R) + test::largest(r.x - relative.x), 16 * test::epsilon);
    EXPECT_LT(difference<G>(on_motions<G>(G::inverse_adjoint_map(H)), inverse_adjoint(in_space(H))),
              16 * test::epsilon);
    EXPECT_LT(difference<G>(G::inverse_adjoint_times(H, v.y), inverse_adjoint_times(in_space(H), in_space<G>(v.y))),
              16 * test::epsilon);
    EXPECT_LT(difference<G>(G::inverse_adjoint_transpose_times(H, v.n),
                            inverse_adjoint_transpose_times(in_space(H), in_space<G>(v.n))),
              16 * test::epsilon);
  }
}

TEST(GroupOperators, of_poses_in_space_are_those_of_frames) { expect_poses<Se3>(33); }
TEST(GroupOperators, of_poses_in_a_plane_are_those_of_frames) { expect_poses<Se2>(34); }

}  // namespace
}  // namespace bough::motion
