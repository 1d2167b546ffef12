#pragma once
/// The compact algebra of SE(3): vectors, numbers and brackets; see group_se3.hpp for the meaning of the names.
#include "bough/motion/coefficients.hpp"
#include "bough/motion/dual.hpp"
#include "bough/motion/se3.hpp"

namespace bough::motion {

struct Se3Algebra {
  template <class S>
  using Pose = Frame<S>;
  template <class S>
  using Vector = Vec6<S>;
  template <class S>
  using Matrix = Mat6<S>;
  static constexpr int dof = 6;
  static constexpr bool numbers_have_slopes = true;  ///< numbers are dual: f(X) contains f'(X)

  template <class S>
  using Motion = DualVec<S>;
  template <class S>
  using Bracket = DualVec<S>;  ///< image of ad, the whole algebra
  template <class S>
  using Wrench = DualVec<S>;
  template <class S>
  using Number = Dual<S>;  ///< scalars that commute with every ad(d)
  template <class S>
  using Map = DualMat<S>;
  template <class S>
  using BracketMap = DualMat<S>;
  template <class S>
  using WrenchMap = DualMat<S>;
  static constexpr int translations = 3;
  static constexpr bool turns = true;  ///< whether frames rotate
  static constexpr bool has_moving_frames = true;
  template <class S>
  using Translation = Vec3<S>;
  template <class S>
  using Rotation = Mat3<S>;
  template <class C>
  struct Direction {
    static constexpr bool has_numbers = false;
    int i = 0, j = 0;  ///< axes of the first and the second frame
    static Direction axial() { return {2, 2}; }
  };

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
  /// v + a translation by u.
  template <class S>
  static BOUGH_INLINE DualVec<S> add_translation(const DualVec<S>& v, const Vec3<S>& u) {
    return {v.a, v.b + u};
  }
  /// Linear part of a vector; R u and R^T u for a direction u; w x u, with w the angular part of a twist.
  template <class S>
  static BOUGH_INLINE Vec3<S> linear(const Vec6<S>& v) {
    return linear_part(v);
  }
  template <class S>
  static BOUGH_INLINE Vec3<S> turned(const Frame<S>& H, const Vec3<S>& u) {
    return H.R * u;
  }
  template <class S>
  static BOUGH_INLINE Vec3<S> turned_back(const Frame<S>& H, const Vec3<S>& u) {
    return lanes::transpose_times(H.R, u);
  }
  template <class S>
  static BOUGH_INLINE Vec3<S> spin(const Vec6<S>& v, const Vec3<S>& u) {
    return lanes::cross(angular_part(v), u);
  }

  /// d = log(H) and X = <d, d>. Returns the coefficient of D^2 in T(d)^-1 with its derivatives by X.
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
  /// f x for a number or a plain factor f.
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
  /// The wrench M x, M the matrix of a section or a body.
  template <class C, class S>
  static BOUGH_INLINE DualVec<S> matrix_times(const Mat6<C>& m, const DualVec<S>& x) {
    return wrench_dual(Vec6<S>(m * motion_vector(x)));
  }

  /// f d - e0, a strain.
  template <class C, class S>
  static BOUGH_INLINE DualVec<S> strain(const C& f, const DualVec<S>& d, const Vec6<C>& e0) {
    DualVec<S> e;
    for (int i = 0; i < 3; ++i) {
      e.b[i] = f * d.b[i] - e0[i];
      e.a[i] = f * d.a[i] - e0[3 + i];
    }
    return e;
  }
  template <class S>
  static BOUGH_INLINE void put(const DualVec<S>& n, S* out) {
    for (int k = 0; k < 3; ++k) {
      out[k] = n.a[k];
      out[3 + k] = n.b[k];
    }
  }
  /// The wrench of a force f without a moment, written to `out` or returned.
  template <class S>
  static BOUGH_INLINE void put_force(const Vec3<S>& f, S* out) {
    for (int k = 0; k < 3; ++k) {
      out[k] = f[k];
      out[3 + k] = S(0.0);
    }
  }
  template <class S>
  static BOUGH_INLINE DualVec<S> force(const Vec3<S>& f) {
    return {f, Vec3<S>::zero()};
  }
  /// Components in the axes of H of a wrench given in inertial axes, about the same point.
  template <class S>
  static BOUGH_INLINE DualVec<S> wrench_turned_back(const Frame<S>& H, const Vec6<S>& n) {
    return {lanes::transpose_times(H.R, linear_part(n)), lanes::transpose_times(H.R, angular_part(n))};
  }
  /// Components in the axes of H exp(d) of a wrench given in inertial axes, about the same point.
  template <class S>
  static BOUGH_INLINE DualVec<S> turned_back(const Frame<S>& H, const DualVec<S>& d, const Vec6<S>& n) {
    const Mat3<S> R = H.R * exp_so3(d.a);
    return {lanes::transpose_times(R, linear_part(n)), lanes::transpose_times(R, angular_part(n))};
  }

  /// M (u; 0)
  template <class C, class S>
  static BOUGH_INLINE DualVec<S> matrix_times(const Mat6<C>& m, const Vec3<S>& u) {
    Vec6<S> n;
    for (int i = 0; i < 6; ++i) n[i] = multiply_add(m(i, 2), u[2], multiply_add(m(i, 1), u[1], S(m(i, 0) * u[0])));
    return wrench_dual(n);
  }
};

}  // namespace bough::motion
