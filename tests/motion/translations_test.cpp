/// Translations alone, R^3 and R^1, against SE(3) on poses without rotation: every operation of these groups that
/// elements and integrators use.
#include <gtest/gtest.h>

#include "bough/motion/vectors_on.hpp"
#include "samples.hpp"

namespace bough::motion {
namespace {

template <int N>
using Group = Translations<N>;
template <int N>
using Vector = lanes::Vec<double, N>;
template <int N>
using Matrix = lanes::Mat<double, N, N>;

template <int N>
Vec6<double> in_space(const Vector<N>& v) {
  Vec6<double> r = Vec6<double>::zero();
  for (int i = 0; i < N; ++i) r[i] = v[i];
  return r;
}
template <int N>
Frame<double> in_space(const Place<double, N>& H) {
  return {Mat3<double>::identity(), lanes::linear_part(in_space<N>(H.x))};
}
/// The components of a vector in space along the axes of the group; all others must vanish.
template <int N>
Vector<N> along(const Vec6<double>& v) {
  Vector<N> r;
  for (int i = 0; i < 6; ++i) {
    if (i < N)
      r[i] = v[i];
    else
      EXPECT_EQ(v[i], 0.0);
  }
  return r;
}
/// The same of a wrench, whose moment takes no part where nothing turns.
template <int N>
Vector<N> forces_along(const Vec6<double>& v) {
  Vector<N> r;
  for (int i = 0; i < N; ++i) r[i] = v[i];
  return r;
}
template <int N>
void expect_same(const Vector<N>& a, const Vector<N>& b) {
  for (int i = 0; i < N; ++i) EXPECT_NEAR(a[i], b[i], 4 * test::epsilon);
}
/// A block of space whose rows and columns of rotations are zero, from one of the group.
template <int N>
Mat6<double> in_space(const Matrix<N>& m) {
  Mat6<double> r = Mat6<double>::zero();
  for (int i = 0; i < N; ++i)
    for (int j = 0; j < N; ++j) r(i, j) = m(i, j);
  return r;
}
template <int N>
void expect_same_block(const Matrix<N>& a, const Mat6<double>& b) {
  for (int i = 0; i < N; ++i)
    for (int j = 0; j < N; ++j) EXPECT_NEAR(a(i, j), b(i, j), 16 * test::epsilon) << i << ", " << j;
}

template <int N>
struct Samples {
  Vector<N> a, b, c;
  Matrix<N> m;
  Place<double, N> H, K;
  explicit Samples(test::Random& random)
      : a(random.vector<N>()),
        b(random.vector<N>()),
        c(random.vector<N>()),
        H{{}, random.vector<N>()},
        K{{}, random.vector<N>()} {
    for (double& x : m.m) x = random.number();
  }
};

template <int N>
void compare_poses() {
  using G = Group<N>;
  test::Random random(40 + N);
  for (int k = 0; k < 100; ++k) {
    const Samples<N> s(random);
    const Frame<double> H = in_space<N>(s.H), K = in_space<N>(s.K);
    expect_same<N>(G::compose(s.H, s.K).x, forces_along<N>(lanes::join(Se3::compose(H, K).x, Vec3<double>::zero())));
    expect_same<N>(G::relative(s.H, s.K).x, forces_along<N>(lanes::join(Se3::relative(H, K).x, Vec3<double>::zero())));
    expect_same<N>(G::exp(s.a).x, forces_along<N>(lanes::join(exp_se3(in_space<N>(s.a)).x, Vec3<double>::zero())));
    expect_same<N>(G::log(s.H), along<N>(log_se3(H)));
    expect_same<N>(G::log(G::exp(s.a)), s.a);
    expect_same<N>(G::inverse_adjoint_times(s.H, s.a), along<N>(inverse_adjoint_times(H, in_space<N>(s.a))));
    expect_same<N>(G::inverse_adjoint_transpose_times(s.H, s.a),
                   forces_along<N>(inverse_adjoint_transpose_times(H, in_space<N>(s.a))));
    expect_same<N>(
        G::times(G::inverse_adjoint_map(s.H), s.a),
        along<N>(Se3::vector_of_motion(Se3::times(Se3::inverse_adjoint_map(H), Se3::motion(in_space<N>(s.a))))));
    expect_same<N>(G::turned(s.H, s.a), s.a);
    expect_same<N>(G::turned_back(s.H, s.a), s.a);
    expect_same<N>(G::wrench_turned_back(s.H, s.a),
                   along<N>(Se3::vector_of_wrench(Se3::wrench_turned_back(H, in_space<N>(s.a)))));
    const typename G::template Direction<double> d{s.b};
    EXPECT_NEAR(G::component(s.H, d), lanes::dot(s.b, s.H.x), 4 * test::epsilon);
    expect_same<N>(G::seen(s.H, d), s.b);
  }
}

TEST(Translations, of_poses_are_those_of_frames_without_rotation) {
  compare_poses<3>();
  compare_poses<1>();
}

/// Operators that are functions of ad(d), and brackets, by the plain vectors of integrators.
template <int N>
void compare_vectors() {
  using G = VectorsOn<Group<N>>;
  using Space = VectorsOn<Se3>;
  test::Random random(50 + N);
  for (int k = 0; k < 100; ++k) {
    const Samples<N> s(random);
    const Vec6<double> a = in_space<N>(s.a), b = in_space<N>(s.b);
    expect_same<N>(G::bracket(s.a, s.b), along<N>(Space::bracket(a, b)));
    expect_same<N>(G::dual_bracket(s.a, s.b), forces_along<N>(Space::dual_bracket(a, b)));
    expect_same<N>(G::tangent_times(s.a, s.b), along<N>(Space::tangent_times(a, b)));
    expect_same<N>(G::inverse_tangent_times(s.a, s.b), along<N>(Space::inverse_tangent_times(a, b)));
    expect_same<N>(G::tangent_transpose_times(s.a, s.b), forces_along<N>(Space::tangent_transpose_times(a, b)));
    expect_same<N>(G::inverse_tangent_transpose_times(s.a, s.b),
                   forces_along<N>(Space::inverse_tangent_transpose_times(a, b)));
    expect_same<N>(G::adjoint_transpose_times(s.H, s.b),
                   forces_along<N>(Space::adjoint_transpose_times(in_space<N>(s.H), b)));
    EXPECT_EQ(G::angular_square(s.a), Space::angular_square(a));
  }
}

TEST(Translations, have_the_operators_of_space_at_vectors_without_rotation) {
  compare_vectors<3>();
  compare_vectors<1>();
}

/// Blocks of tangents. The derivatives of space by rotations take no part.
template <int N>
void compare_blocks() {
  using G = Group<N>;
  test::Random random(60 + N);
  for (int k = 0; k < 100; ++k) {
    const Samples<N> s(random);
    const Frame<double> H = in_space<N>(s.H), K = in_space<N>(s.K);
    const Mat6<double> m = in_space<N>(s.m);
    const double factor = random.number();
    const Multiple<double> map = G::scaled(factor, Multiple<double>::identity());
    const DualMat<double> space = Se3::scaled(factor, DualMat<double>::identity());
    expect_same_block<N>(G::block_product(s.m, map), Se3::block_product(m, space));
    expect_same_block<N>(G::transposed_product(map, s.m), Se3::transposed_product(space, m));
    Matrix<N> own = s.m;
    Mat6<double> other = m;
    G::add_block_product(own, s.m, map), Se3::add_block_product(other, m, space);
    G::add_outer(own, s.a, s.b), Se3::add_outer(other, Se3::wrench(in_space<N>(s.a)), Se3::wrench(in_space<N>(s.b)));
    const Vec3<double> force = lanes::linear_part(in_space<N>(s.c));
    G::add_force_outer(own, s.c, s.a), Se3::add_force_outer(other, force, Se3::wrench(in_space<N>(s.a)));
    G::add_rotation(own, factor, s.H, s.K), Se3::add_rotation(other, factor, H, K);
    G::add_turning(own, s.a), Se3::add_turning(other, Se3::wrench(in_space<N>(s.a)));
    G::add_wrench_map(own, G::hat(s.b)), Se3::add_wrench_map(other, Se3::hat(Se3::wrench(in_space<N>(s.b))));
    G::add_block_product(own, s.m, G::ad(s.c)),
        Se3::add_block_product(other, m, Se3::ad(Se3::motion(in_space<N>(s.c))));
    const auto T = eval_tangent_operator<G, double>(s.a);
    const auto space_T = eval_tangent_operator<Se3, double>(Se3::motion(in_space<N>(s.a)));
    G::add_block_product(own, s.m, jacobian(T, s.b));
    Se3::add_block_product(other, m, jacobian(space_T, Se3::motion(in_space<N>(s.b))));
    expect_same_block<N>(own, other);
    const auto rows = Se3::linear_rows(space);
    const Matrix<N> own_rows = G::linear_rows(map);
    for (int i = 0; i < N; ++i)
      for (int j = 0; j < N; ++j) EXPECT_EQ(own_rows(i, j), rows(i, j));
    expect_same<N>(G::matrix_times(s.m, s.a),
                   forces_along<N>(Se3::vector_of_wrench(Se3::matrix_times(m, Se3::motion(in_space<N>(s.a))))));
    expect_same_block<N>(G::gyroscopic(s.m, s.a), Se3::gyroscopic(m, Se3::motion(in_space<N>(s.a))));
  }
}

TEST(Translations, have_the_blocks_of_space_by_displacements) {
  compare_blocks<3>();
  compare_blocks<1>();
}

}  // namespace
}  // namespace bough::motion
