#pragma once
/// The group SE(3) as elements see it: poses, plain vectors and matrices (dof = 6), and the algebra in its compact form. By
/// transference motions are dual vectors and operators on motions dual 3x3 matrices (dual.hpp), so what a formula says about
/// rotations holds for motions. The operations that elements are written in, with D = ad(d):
///
///   motion, wrench     vectors (linear; angular) and (force; moment) in compact form
///   bracket            ad(x) y                    dual_bracket       ad(x)^T n
///   pairing            <x, y>: the slope of X = <d, d> along e is 2 <d, e>, and D^3 = -X D
///   power              n . y, a number like X     covector           the wrench f <x, .>
///   number             a function of X            real               the value X itself
///   Map                motions to motions         BracketMap         motions to brackets, which may be a smaller space
///   WrenchMap          motions to wrenches, the derivative of a transposed operator; symmetric blocks are full matrices
///
/// The same names exist in every group, so an element is written once. All functions are pure and do not allocate.
#include "bough/motion/coefficients.hpp"
#include "bough/motion/dual.hpp"
#include "bough/motion/se3.hpp"

namespace bough::motion {

struct Se3 {
  static constexpr int dof = 6;
  static constexpr bool numbers_have_slopes = true;  ///< dual: f(X) carries f'(X)
  template <class S>
  using Pose = Frame<S>;
  template <class S>
  using Vector = Vec6<S>;
  template <class S>
  using Matrix = Mat6<S>;

  template <class S>
  static Pose<S> identity() {
    return Frame<S>::identity();
  }
  template <class S>
  static Pose<S> exp(const Vec6<S>& d) {
    return exp_se3(d);
  }
  template <class S>
  static Vec6<S> log(const Frame<S>& H) {
    return log_se3(H);
  }
  template <class S>
  static Pose<S> compose(const Frame<S>& a, const Frame<S>& b) {
    return motion::compose(a, b);
  }
  template <class S>
  static Pose<S> inverse(const Frame<S>& a) {
    return motion::inverse(a);
  }
  template <class S>
  static Pose<S> relative(const Frame<S>& a, const Frame<S>& b) {
    return motion::relative(a, b);
  }
  template <class S>
  static Mat6<S> adjoint(const Frame<S>& H) {
    return motion::adjoint(H);
  }
  template <class S>
  static Mat6<S> inverse_adjoint(const Frame<S>& H) {
    return motion::inverse_adjoint(H);
  }
  template <class S>
  static Vec6<S> adjoint_times(const Frame<S>& H, const Vec6<S>& v) {
    return motion::adjoint_times(H, v);
  }
  template <class S>
  static Vec6<S> inverse_adjoint_times(const Frame<S>& H, const Vec6<S>& v) {
    return motion::inverse_adjoint_times(H, v);
  }
  template <class S>
  static Vec6<S> adjoint_transpose_times(const Frame<S>& H, const Vec6<S>& f) {
    return motion::adjoint_transpose_times(H, f);
  }
  template <class S>
  static Vec6<S> inverse_adjoint_transpose_times(const Frame<S>& H, const Vec6<S>& f) {
    return motion::inverse_adjoint_transpose_times(H, f);
  }
  template <class S>
  static Mat6<S> cross(const Vec6<S>& v) {
    return cross6(v);
  }
  template <class S>
  static Vec6<S> cross_times(const Vec6<S>& v, const Vec6<S>& w) {
    return cross6_times(v, w);
  }
  template <class S>
  static Vec6<S> cross_transpose_times(const Vec6<S>& v, const Vec6<S>& f) {
    return cross6_transpose_times(v, f);
  }
  template <class S>
  static Mat6<S> hat(const Vec6<S>& P) {
    return hat6(P);
  }
  template <class S>
  static Mat6<S> tangent(const Vec6<S>& d) {
    return motion::tangent(d);
  }
  template <class S>
  static Mat6<S> inverse_tangent(const Vec6<S>& d) {
    return motion::inverse_tangent(d);
  }
  template <class S>
  static Vec6<S> tangent_times(const Vec6<S>& d, const Vec6<S>& a) {
    return motion::tangent_times(d, a);
  }
  template <class S>
  static Vec6<S> inverse_tangent_times(const Vec6<S>& d, const Vec6<S>& a) {
    return motion::inverse_tangent_times(d, a);
  }
  template <class S>
  static Vec6<S> tangent_transpose_times(const Vec6<S>& d, const Vec6<S>& n) {
    return motion::tangent_transpose_times(d, n);
  }
  template <class S>
  static Vec6<S> inverse_tangent_transpose_times(const Vec6<S>& d, const Vec6<S>& n) {
    return motion::inverse_tangent_transpose_times(d, n);
  }
  template <class S>
  static Mat6<S> tangent_derivative(const Vec6<S>& d, const Vec6<S>& a) {
    return motion::tangent_derivative(d, a);
  }
  template <class S>
  static Mat6<S> tangent_transpose_derivative(const Vec6<S>& d, const Vec6<S>& n) {
    return motion::tangent_transpose_derivative(d, n);
  }
  template <class S>
  static Mat6<S> inverse_tangent_transpose_derivative(const Vec6<S>& d, const Vec6<S>& n) {
    return motion::inverse_tangent_transpose_derivative(d, n);
  }

  // ---- compact algebra

  template <class S>
  using Motion = DualVec<S>;
  template <class S>
  using Bracket = DualVec<S>;  ///< image of ad: all of the algebra
  template <class S>
  using Wrench = DualVec<S>;
  template <class S>
  using Number = Dual<S>;  ///< what commutes with every ad(d)
  template <class S>
  using Map = DualMat<S>;
  template <class S>
  using BracketMap = DualMat<S>;
  template <class S>
  using WrenchMap = DualMat<S>;
  template <class S>
  using Translation = Vec3<S>;

  template <class S>
  static BOUGH_INLINE DualVec<S> motion(const Vec6<S>& v) {
    return motion_dual(v);
  }
  template <class S>
  static BOUGH_INLINE DualVec<S> wrench(const Vec6<S>& f) {
    return wrench_dual(f);
  }
  template <class S>
  static BOUGH_INLINE Vec6<S> vector_of_motion(const DualVec<S>& v) {
    return motion_vector(v);
  }
  template <class S>
  static BOUGH_INLINE Vec6<S> vector_of_wrench(const DualVec<S>& f) {
    return wrench_vector(f);
  }
  /// The motion of a translation u without rotation.
  template <class S>
  static BOUGH_INLINE DualVec<S> translation(const Vec3<S>& u) {
    return {Vec3<S>::zero(), u};
  }
  /// Components in the frame H of a direction given in its parent.
  template <class S>
  static BOUGH_INLINE Vec3<S> turned_back(const Frame<S>& H, const Vec3<S>& u) {
    return lanes::transpose_times(H.R, u);
  }

  /// d and X of the logarithm of H, and the coefficient of D^2 in T(d)^-1 with its derivatives by X.
  template <class S>
  static BOUGH_INLINE InverseCoefficients<S> log(const Frame<S>& H, DualVec<S>& d, Dual<S>& x) {
    const Vec3<S> psi = log_so3(H.R);
    const S square = lanes::dot(psi, psi);
    const auto k = eval_inverse_coefficients(square);
    const Vec3<S> turned = k.k * lanes::cross(psi, H.x) - 0.5 * H.x;
    d = {psi, add_cross(H.x, psi, turned)};  // T(psi)^-T x
    const S half = lanes::dot(d.a, d.b);
    x = {square, half + half};
    return k;
  }
  template <class S>
  static BOUGH_INLINE Dual<S> square(const DualVec<S>& d) {
    const S half = lanes::dot(d.a, d.b);
    return {lanes::dot(d.a, d.a), half + half};
  }
  template <class S>
  static BOUGH_INLINE Dual<S> number(const Dual<S>& x, const S& f, const S& slope) {
    return {f, slope * x.b};
  }
  template <class S>
  static BOUGH_INLINE const S& real(const Dual<S>& x) {
    return x.a;
  }
  template <class S>
  static BOUGH_INLINE Dual<S> twice(const Dual<S>& x) {
    return x + x;
  }

  template <class S>
  static BOUGH_INLINE DualVec<S> bracket(const DualVec<S>& x, const DualVec<S>& y) {
    return motion::cross(x, y);
  }
  template <class S>
  static BOUGH_INLINE DualVec<S> add_bracket(const DualVec<S>& r, const DualVec<S>& x, const DualVec<S>& y) {
    return add_cross(r, x, y);
  }
  template <class S>
  static BOUGH_INLINE DualVec<S> dual_bracket(const DualVec<S>& x, const DualVec<S>& n) {
    return motion::cross(n, x);
  }
  template <class S>
  static BOUGH_INLINE DualVec<S> add_dual_bracket(const DualVec<S>& r, const DualVec<S>& x, const DualVec<S>& n) {
    return add_cross(r, n, x);
  }
  template <class S>
  static BOUGH_INLINE DualVec<S> subtract_dual_bracket(const DualVec<S>& r, const DualVec<S>& x, const DualVec<S>& n) {
    return add_cross(r, x, n);
  }
  /// A bracket as a motion.
  template <class S>
  static BOUGH_INLINE const DualVec<S>& widened(const DualVec<S>& x) {
    return x;
  }
  template <class S>
  static BOUGH_INLINE Dual<S> pairing(const DualVec<S>& x, const DualVec<S>& y) {
    return dot(x, y);
  }
  template <class S>
  static BOUGH_INLINE Dual<S> power(const DualVec<S>& n, const DualVec<S>& y) {
    return dot(n, y);
  }
  template <class S>
  static BOUGH_INLINE S real_power(const DualVec<S>& n, const DualVec<S>& y) {
    return lanes::dot(n.a, y.b) + lanes::dot(n.b, y.a);
  }
  template <class S>
  static BOUGH_INLINE DualVec<S> add_covector(const DualVec<S>& r, const Dual<S>& f, const DualVec<S>& x) {
    return motion::add_scaled(r, f, x);
  }
  /// f x of a number or a plain factor.
  template <class S>
  static BOUGH_INLINE DualVec<S> times(const Dual<S>& f, const DualVec<S>& x) {
    return f * x;
  }
  template <class A, class S>
  static BOUGH_INLINE DualVec<S> scaled(const A& f, const DualVec<S>& x) {
    return motion::scaled(f, x);
  }
  /// r + f x
  template <class F, class S>
  static BOUGH_INLINE DualVec<S> add(const DualVec<S>& r, const F& f, const DualVec<S>& x) {
    return motion::add_scaled(r, f, x);
  }
  /// M x, a wrench, of the matrix of a section or a body.
  template <class C, class S>
  static BOUGH_INLINE DualVec<S> matrix_times(const Mat6<C>& m, const DualVec<S>& x) {
    return wrench_dual(Vec6<S>(m * motion_vector(x)));
  }

  // ---- maps

  template <class S>
  static BOUGH_INLINE DualMat<S> ad(const DualVec<S>& x) {
    return skew(x);
  }
  /// m + f
  template <class S>
  static BOUGH_INLINE DualMat<S> with_diagonal(DualMat<S> m, double f) {
    for (int i = 0; i < 3; ++i) m.a(i, i) = m.a(i, i) + f;
    return m;
  }
  /// m += ad(x) ad(y)
  template <class S>
  static BOUGH_INLINE void add_pair(DualMat<S>& m, const DualVec<S>& x, const DualVec<S>& y) {
    add_outer(m, y, x);
    add_diagonal(m, -dot(x, y));
  }
  /// m += a <x, .> - ad(x) ad(y)
  template <class S>
  static BOUGH_INLINE void add_second(DualMat<S>& m, const DualVec<S>& a, const DualVec<S>& x, const DualVec<S>& y) {
    add_outer(m, a - y, x);
    add_diagonal(m, dot(x, y));
  }
  /// m += a <x, .>
  template <class S>
  static BOUGH_INLINE void add_polar(DualMat<S>& m, const DualVec<S>& a, const DualVec<S>& x) {
    add_outer(m, a, x);
  }
  template <class S>
  static BOUGH_INLINE DualMat<S> plus(const DualMat<S>& x, const DualMat<S>& y) {
    return x + y;
  }
  template <class S>
  static BOUGH_INLINE DualMat<S> minus(const DualMat<S>& x, const DualMat<S>& y) {
    return x - y;
  }
  template <class S>
  static BOUGH_INLINE DualMat<S> negated(const DualMat<S>& x) {
    return {-1.0 * x.a, -1.0 * x.b};
  }
  template <class A, class S>
  static BOUGH_INLINE DualMat<S> scaled(const A& f, const DualMat<S>& x) {
    return motion::scaled(f, x);
  }
  /// m += f x
  template <class A, class S>
  static BOUGH_INLINE void add_to(DualMat<S>& m, const A& f, const DualMat<S>& x) {
    add_scaled_to(m, f, x);
  }
  template <class S>
  static BOUGH_INLINE DualMat<S> product(const DualMat<S>& x, const DualMat<S>& y) {
    return motion::product(x, y);
  }
  /// m += x y
  template <class S>
  static BOUGH_INLINE void add_product(DualMat<S>& m, const DualMat<S>& x, const DualMat<S>& y) {
    motion::add_product(m, x, y);
  }
  template <class S>
  static BOUGH_INLINE DualVec<S> times(const DualMat<S>& m, const DualVec<S>& x) {
    return motion::times(m, x);
  }
  template <class S>
  static BOUGH_INLINE DualVec<S> transpose_times(const DualMat<S>& m, const DualVec<S>& n) {
    return motion::transpose_times(m, n);
  }
  /// Ad(H)^-1 = [R^T, R^T ~x^T; 0, R^T].
  template <class S>
  static BOUGH_INLINE DualMat<S> inverse_adjoint_map(const Frame<S>& H) {
    DualMat<S> q{lanes::transpose(H.R), {}};
    for (int i = 0; i < 3; ++i) {
      const Vec3<S> row = lanes::cross(H.x, lanes::column(H.R, i));  // row i of R^T ~x^T = (~x R)^T
      for (int j = 0; j < 3; ++j) q.b(i, j) = row[j];
    }
    return q;
  }

  // ---- maps to wrenches

  /// e -> ad(e)^T n
  template <class S>
  static BOUGH_INLINE DualMat<S> hat(const DualVec<S>& n) {
    return skew(n);
  }
  /// m += a <x, .> + ad(x)^T hat(n)
  template <class S>
  static BOUGH_INLINE void add_dual_second(DualMat<S>& m, const DualVec<S>& a, const DualVec<S>& x,
                                           const DualVec<S>& n) {
    add_outer(m, a - n, x);
    add_diagonal(m, dot(x, n));
  }
  /// m += a <x, .> and its transpose
  template <class S>
  static BOUGH_INLINE void add_symmetric_polar(DualMat<S>& m, const DualVec<S>& a, const DualVec<S>& x) {
    add_outer(m, a, x);
    add_outer(m, x, a);
  }
  /// m -= ad(y)^T hat(n) and its transpose
  template <class S>
  static BOUGH_INLINE void subtract_symmetric_pair(DualMat<S>& m, const DualVec<S>& y, const DualVec<S>& n) {
    const Dual<S> half = dot(n, y);
    add_symmetric_polar(m, n, y);
    add_diagonal(m, -(half + half));
  }
  /// m += f <., .>
  template <class S>
  static BOUGH_INLINE void add_pairing(DualMat<S>& m, const Dual<S>& f) {
    add_diagonal(m, f);
  }
  template <class S>
  static BOUGH_INLINE DualMat<S> transposed(const DualMat<S>& m) {
    return {lanes::transpose(m.a), lanes::transpose(m.b)};
  }

  // ---- full blocks: the matrices of sections and bodies, and what they multiply

  /// m x and r += m x, row by row, x in registers.
  template <class A, class S>
  static Mat6<S> block_product(const Mat6<A>& m, const DualMat<S>& x) {
    const Mat3<S> xa = x.a, xb = x.b;
    Mat6<S> r;
    for (int i = 0; i < 6; ++i) {
      const A m0 = m(i, 0), m1 = m(i, 1), m2 = m(i, 2), m3 = m(i, 3), m4 = m(i, 4), m5 = m(i, 5);
      for (int j = 0; j < 3; ++j) {
        r(i, j) = multiply_add(m2, xa(2, j), multiply_add(m1, xa(1, j), S(m0 * xa(0, j))));
        const S b = multiply_add(m2, xb(2, j), multiply_add(m1, xb(1, j), S(m0 * xb(0, j))));
        r(i, 3 + j) = multiply_add(m5, xa(2, j), multiply_add(m4, xa(1, j), multiply_add(m3, xa(0, j), b)));
      }
    }
    return r;
  }
  template <class A, class S>
  static void add_block_product(Mat6<S>& r, const Mat6<A>& m, const DualMat<S>& x) {
    const Mat3<S> xa = x.a, xb = x.b;
    for (int i = 0; i < 6; ++i) {
      const A m0 = m(i, 0), m1 = m(i, 1), m2 = m(i, 2), m3 = m(i, 3), m4 = m(i, 4), m5 = m(i, 5);
      S row[6];
      for (int j = 0; j < 3; ++j) {
        row[j] = multiply_add(m2, xa(2, j), multiply_add(m1, xa(1, j), multiply_add(m0, xa(0, j), r(i, j))));
        const S b = multiply_add(m2, xb(2, j), multiply_add(m1, xb(1, j), multiply_add(m0, xb(0, j), r(i, 3 + j))));
        row[3 + j] = multiply_add(m5, xa(2, j), multiply_add(m4, xa(1, j), multiply_add(m3, xa(0, j), b)));
      }
      for (int j = 0; j < 6; ++j) r(i, j) = row[j];
    }
  }
  /// x^T m, column by column, x in registers.
  template <class S, class A>
  static Mat6<S> transposed_product(const DualMat<S>& x, const Mat6<A>& m) {
    const Mat3<S> xa = x.a, xb = x.b;
    Mat6<S> r;
    for (int j = 0; j < 6; ++j) {
      const A m0 = m(0, j), m1 = m(1, j), m2 = m(2, j), m3 = m(3, j), m4 = m(4, j), m5 = m(5, j);
      for (int i = 0; i < 3; ++i) {
        r(i, j) = multiply_add(xa(2, i), m2, multiply_add(xa(1, i), m1, S(xa(0, i) * m0)));
        const S b = multiply_add(xb(2, i), m2, multiply_add(xb(1, i), m1, S(xb(0, i) * m0)));
        r(3 + i, j) = multiply_add(xa(2, i), m5, multiply_add(xa(1, i), m4, multiply_add(xa(0, i), m3, b)));
      }
    }
    return r;
  }
  /// r += ad(d)^T m
  template <class S>
  static void add_ad_transposed(Mat6<S>& r, const DualVec<S>& d, const Mat6<S>& m) {
    for (int i = 0; i < 3; ++i) {
      const int n = (i + 1) % 3, l = (i + 2) % 3;
      for (int j = 0; j < 6; ++j) {
        r(i, j) = multiply_add(m(n, j), d.a[l], negative_multiply_add(m(l, j), d.a[n], r(i, j)));
        const S b = multiply_add(m(n, j), d.b[l], negative_multiply_add(m(l, j), d.b[n], r(3 + i, j)));
        r(3 + i, j) = multiply_add(m(3 + n, j), d.a[l], negative_multiply_add(m(3 + l, j), d.a[n], b));
      }
    }
  }
  /// r += w and r += w x, w = A + e B standing for [0, A; A, B].
  template <class S>
  static BOUGH_INLINE void add_wrench_map(Mat6<S>& r, const DualMat<S>& w) {
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        r(i, 3 + j) = r(i, 3 + j) + w.a(i, j);
        r(3 + i, j) = r(3 + i, j) + w.a(i, j);
        r(3 + i, 3 + j) = r(3 + i, 3 + j) + w.b(i, j);
      }
  }
  template <class S>
  static BOUGH_INLINE void add_wrench_product(Mat6<S>& r, const DualMat<S>& w, const DualMat<S>& x) {
    add_wrench_map(r, motion::product(w, x));
  }
  /// d(m a - ad(v)^T m v)/dv = -(ad(v)^T m + hat(m v))
  template <class C, class S>
  static BOUGH_INLINE Mat6<S> gyroscopic(const Mat6<C>& m, const DualVec<S>& v) {
    Mat6<S> x = Mat6<S>::zero();
    add_ad_transposed(x, DualVec<S>{-v.a, -v.b}, lanes::cast<S>(m));
    const DualVec<S> momentum = matrix_times(m, v);
    add_wrench_map(x, skew(DualVec<S>{-momentum.a, -momentum.b}));
    return x;
  }
  /// How R^T u of a direction u = H.R at_rest, given by its components in the frame, follows the frame's increment: m -= that, as a motion.
  template <class S>
  static BOUGH_INLINE void subtract_turned_back(DualMat<S>& m, const Vec3<S>& components) {
    m.b = m.b - skew(components);
  }
};

}  // namespace bough::motion
