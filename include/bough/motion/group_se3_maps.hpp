#pragma once
/// Maps of motions on SE(3) in compact form; see group_se3.hpp for the meaning of the names.
#include "bough/motion/group_se3_algebra.hpp"

namespace bough::motion {

struct Se3Maps : Se3Algebra {
  using Se3Algebra::scaled;
  using Se3Algebra::times;
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
    motion::add_outer(m, y, x);
    add_diagonal(m, -dot(x, y));
  }
  /// m += a <x, .> - ad(x) ad(y)
  template <class S>
  static BOUGH_INLINE void add_second(DualMat<S>& m, const DualVec<S>& a, const DualVec<S>& x, const DualVec<S>& y) {
    motion::add_outer(m, a - y, x);
    add_diagonal(m, dot(x, y));
  }
  /// m += a <x, .>
  template <class S>
  static BOUGH_INLINE void add_polar(DualMat<S>& m, const DualVec<S>& a, const DualVec<S>& x) {
    motion::add_outer(m, a, x);
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
  static BOUGH_INLINE void subtract_product(DualMat<S>& m, const DualMat<S>& x, const DualMat<S>& y) {
    motion::add_product(m, negated(x), y);
  }
  /// m -= x ad(v)
  template <class S>
  static BOUGH_INLINE void subtract_times_ad(DualMat<S>& m, const DualMat<S>& x, const DualVec<S>& v) {
    m = m - skew_product(x, v);
  }
  /// A map to brackets as one to motions.
  template <class S>
  static BOUGH_INLINE const DualMat<S>& as_map(const DualMat<S>& m) {
    return m;
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
    motion::add_outer(m, a - n, x);
    add_diagonal(m, dot(x, n));
  }
  /// m += a <x, .> and its transpose
  template <class S>
  static BOUGH_INLINE void add_symmetric_polar(DualMat<S>& m, const DualVec<S>& a, const DualVec<S>& x) {
    motion::add_outer(m, a, x);
    motion::add_outer(m, x, a);
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
};

}  // namespace bough::motion
