// Jet and Taylor against the complex step, each other and the elementary identities.
#include <gtest/gtest.h>

#include <limits>

#include "bough/lanes/jet.hpp"
#include "bough/lanes/small.hpp"
#include "bough/lanes/taylor.hpp"

namespace bough::lanes {
namespace {

constexpr double epsilon = std::numeric_limits<double>::epsilon();

/// A formula that uses every operation of the scalar vocabulary.
template <class S>
S formula(const S& x, const S& y) {
  using std::atan2;
  using std::cos;
  using std::sin;
  using std::sqrt;
  const S r = sqrt(x * x + y * y + 1.0);
  return sin(x * y) / r + 2.0 * cos(x - y) * r - (3.0 - x) / (2.0 + y) + 1.0 / (x + 4.0) + (-x) * 0.5 +
         (1.0 + y) / 3.0 - (x - 2.0);
}

TEST(Jet, gradient_matches_the_complex_step) {
  using C = std::complex<double>;
  const double h = 1e-40;
  for (const double x : {-1.3, 0.0, 0.4, 2.0})
    for (const double y : {-0.9, 0.0, 0.7}) {
      const Jet<double, 2> f = formula(Jet<double, 2>::variable(x, 0), Jet<double, 2>::variable(y, 1));
      const double dx = formula(C(x, h), C(y)).imag() / h, dy = formula(C(x), C(y, h)).imag() / h;
      EXPECT_NEAR(f.a, formula(x, y), 16 * epsilon);
      EXPECT_NEAR(f.d[0], dx, 32 * epsilon);
      EXPECT_NEAR(f.d[1], dy, 32 * epsilon);
    }
}

TEST(Jet, angle_of_a_point_turns_with_the_perpendicular_direction) {
  for (const double phi : {-3.0, -1.0, 0.0, 0.5, 2.0, 3.1}) {
    const double r = 1.7;
    const Jet<double, 2> x = Jet<double, 2>::variable(r * std::cos(phi), 0);
    const Jet<double, 2> y = Jet<double, 2>::variable(r * std::sin(phi), 1);
    const Jet<double, 2> angle = atan2(y, x);
    EXPECT_NEAR(angle.a, phi, 4 * epsilon);
    EXPECT_NEAR(angle.d[0], -std::sin(phi) / r, 4 * epsilon);
    EXPECT_NEAR(angle.d[1], std::cos(phi) / r, 4 * epsilon);
  }
}

TEST(Jet, nested_jets_give_symmetric_second_derivatives) {
  using Inner = Jet<double, 2>;
  using Outer = Jet<Inner, 2>;
  const auto variable = [](double v, int k) { return Outer::variable(Inner::variable(v, k), k); };
  const Outer f = formula(variable(0.4, 0), variable(-0.8, 1));
  EXPECT_NEAR(f.d[0].d[1], f.d[1].d[0], 16 * epsilon);
  // d^2/dx^2 of x^2 y is 2 y: no formula of ours in the oracle.
  const Outer x = variable(3.0, 0), y = variable(5.0, 1), g = x * x * y;
  EXPECT_EQ(g.d[0].d[0], 10.0);
  EXPECT_EQ(g.d[0].d[1], 6.0);
  EXPECT_EQ(g.d[1].d[1], 0.0);
}

TEST(Jet, choices_follow_the_value_and_keep_its_derivative) {
  const Jet<double, 1> a = Jet<double, 1>::variable(1.0, 0), b = 2.0 * a;
  EXPECT_TRUE(less(a, b));
  EXPECT_EQ(select(less(a, b), a, b).d[0], 1.0);
  EXPECT_EQ(select(less(b, a), a, b).d[0], 2.0);
}

TEST(Taylor, coefficients_of_the_elementary_functions_are_the_known_series) {
  using T = Taylor<double, 6>;
  T t(0.0);
  t.c[1] = 1.0;
  const T s = sin(t), c = cos(t), root = sqrt(1.0 + t), geometric = 1.0 / (1.0 - t), angle = atan2(t, T(1.0));
  double factorial = 1.0, binomial = 1.0;
  for (int k = 0; k <= 6; ++k) {
    if (k > 0) factorial *= k;
    const double sign = k / 2 % 2 == 0 ? 1.0 : -1.0;
    EXPECT_NEAR(s.c[k], k % 2 ? sign / factorial : 0.0, epsilon);
    EXPECT_NEAR(c.c[k], k % 2 ? 0.0 : sign / factorial, epsilon);
    EXPECT_NEAR(geometric.c[k], 1.0, epsilon);
    EXPECT_NEAR(root.c[k], binomial, epsilon);
    EXPECT_NEAR(angle.c[k], k % 2 ? sign / k : 0.0, epsilon);
    binomial *= (0.5 - k) / (k + 1);
  }
}

TEST(Taylor, first_coefficient_is_the_jet_derivative_along_the_path) {
  using T = Taylor<double, 3>;
  T x(0.4), y(-0.8);
  x.c[1] = 1.5;
  y.c[1] = -0.3;
  const T f = formula(x, y);
  const Jet<double, 2> g = formula(Jet<double, 2>::variable(0.4, 0), Jet<double, 2>::variable(-0.8, 1));
  EXPECT_NEAR(f.c[0], g.a, 16 * epsilon);
  EXPECT_NEAR(f.c[1], 1.5 * g.d[0] - 0.3 * g.d[1], 16 * epsilon);
}

TEST(Taylor, a_jet_of_series_gives_the_derivative_of_each_coefficient) {
  using T = Taylor<double, 3>;
  using J = Jet<T, 1>;
  T a(2.0);
  a.c[1] = 1.0;  // a = 2 + t
  const J x = J::variable(a, 0);
  const J cube = x * x * x;  // derivative 3 a^2 = 12 + 12 t + 3 t^2
  EXPECT_EQ(cube.d[0].c[0], 12.0);
  EXPECT_EQ(cube.d[0].c[1], 12.0);
  EXPECT_EQ(cube.d[0].c[2], 3.0);
  EXPECT_EQ(cube.d[0].c[3], 0.0);
}

TEST(Small, products_with_the_transpose_equal_the_products_of_the_transpose) {
  const Mat<double, 2, 3> a{{1, 2, 3, 4, 5, 6}};
  const Mat<double, 2, 2> b{{7, 8, 9, 10}};
  const Vec<double, 2> v{{-1, 2}};
  const Mat<double, 3, 2> left = transpose_times(a, b), right = transpose(a) * b;
  for (int i = 0; i < 6; ++i) EXPECT_EQ(left.m[i], right.m[i]);
  const Vec<double, 3> p = transpose_times(a, v), q = transpose(a) * v;
  for (int i = 0; i < 3; ++i) EXPECT_EQ(p[i], q[i]);
}

TEST(Small, the_skew_matrix_times_a_vector_is_the_cross_product) {
  const Vec<double, 3> a{{1, -2, 3}}, b{{-4, 5, 6}};
  const Vec<double, 3> left = skew(a) * b, right = cross(a, b);
  for (int i = 0; i < 3; ++i) EXPECT_EQ(left[i], right[i]);
}

}  // namespace
}  // namespace bough::lanes
