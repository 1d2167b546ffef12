#pragma once
/// Scalar functions of the relative pose of two frames, and full blocks, on SE(3); group_se3.hpp explains the names.
#include "bough/motion/group_se3_maps.hpp"

namespace bough::motion {

namespace detail {
/// c = R_11 + R_22, s = R_21 - R_12 and their gradients by the rotation's right increment.
template <class S>
struct AxialTurn {
  S s, c, inverse;  ///< 1/(s^2 + c^2)
  Vec3<S> ds, dc;
  explicit AxialTurn(const Frame<S>& H)
      : s(H.R(1, 0) - H.R(0, 1)), c(H.R(0, 0) + H.R(1, 1)), inverse(S(1.0) / (s * s + c * c)) {
    const auto by = [&H](int i, int j) {
      return lanes::cross(Vec3<S>::unit(j), Vec3<S>{{H.R(i, 0), H.R(i, 1), H.R(i, 2)}});
    };
    ds = by(1, 0) - by(0, 1);
    dc = by(0, 0) + by(1, 1);
  }
};
}  // namespace detail

struct Se3Blocks : Se3Maps {
  // ---- functions of the relative pose H of a second frame in a first. s = R^T e_i is axis i of the first frame in the
  // axes of the second. Derivatives are by the rotation of the right increment of H.

  template <class S>
  using Seen = Vec3<S>;
  template <class S>
  using TurnSlope = Mat3<S>;  ///< derivative of a force or a moment by the rotation
  template <class S, class C>
  static BOUGH_INLINE Vec3<S> seen(const Frame<S>& H, const Direction<C>& d) {
    return {{H.R(d.i, 0), H.R(d.i, 1), H.R(d.i, 2)}};
  }
  /// e_i . x; its gradient is (s; 0), with s as the force.
  template <class S, class C>
  static BOUGH_INLINE const S& component(const Frame<S>& H, const Direction<C>& d) {
    return H.x[d.i];
  }
  /// e_i . R e_j, and e_j x s of its gradient (0; e_j x s).
  template <class S, class C>
  static BOUGH_INLINE S cosine(const Direction<C>& d, const Vec3<S>& s) {
    return s[d.j];
  }
  template <class S, class C>
  static BOUGH_INLINE Vec3<S> cosine_moment(const Direction<C>& d, const Vec3<S>& s) {
    return lanes::cross(Vec3<S>::unit(d.j), s);
  }
  /// d s = ~s theta and d(e_j x s) = ~e_j ~s theta.
  template <class S>
  static BOUGH_INLINE Mat3<S> seen_slope(const Vec3<S>& s) {
    return skew(s);
  }
  template <class S, class C>
  static BOUGH_INLINE Mat3<S> cosine_slope(const Direction<C>& d, const Vec3<S>& s) {
    Mat3<S> m = lanes::outer(s, Vec3<S>::unit(d.j));
    for (int k = 0; k < 3; ++k) m(k, k) = m(k, k) - s[d.j];
    return m;
  }
  /// Cosine and sine, times a positive factor, of the rotation theta about axis 3, which is the projection of R: theta
  /// = atan2(R_21 - R_12, R_11 + R_22).
  template <class S, class C>
  static BOUGH_INLINE lanes::Vec<S, 2> axial_turn(const Frame<S>& H, const Direction<C>&) {
    return {{H.R(0, 0) + H.R(1, 1), H.R(1, 0) - H.R(0, 1)}};
  }
  template <class S>
  static BOUGH_INLINE S angle_of_turn(const S& c, const S& s) {
    using lanes::atan2;  // for complex numbers, whose own namespace is std
    using std::atan2;
    return atan2(s, c);
  }
  /// Gradient of theta and its derivative: g = (c ds - s dc)/(s^2 + c^2) and
  /// dg = (c dds - s ddc + ds dc^T - dc ds^T - 2 g (s ds + c dc)^T)/(s^2 + c^2), of c = R_11 + R_22, s = R_21 - R_12.
  template <class S, class C>
  static BOUGH_INLINE Vec3<S> axial_moment(const Frame<S>& H, const Direction<C>&) {
    const detail::AxialTurn<S> t(H);
    return (t.c * t.inverse) * t.ds - (t.s * t.inverse) * t.dc;
  }
  template <class S, class C>
  static BOUGH_INLINE Mat3<S> axial_slope(const Frame<S>& H, const Direction<C>& d) {
    const detail::AxialTurn<S> t(H);
    const Vec3<S> g = axial_moment(H, d), half = t.s * t.ds + t.c * t.dc;
    const Direction<C> ab[4] = {{1, 0}, {0, 1}, {0, 0}, {1, 1}};
    const Mat3<S> dds = cosine_slope(ab[0], seen(H, ab[0])) - cosine_slope(ab[1], seen(H, ab[1]));
    const Mat3<S> ddc = cosine_slope(ab[2], seen(H, ab[2])) + cosine_slope(ab[3], seen(H, ab[3]));
    const Mat3<S> turned = t.c * dds - t.s * ddc + lanes::outer(t.ds, t.dc) - lanes::outer(t.dc, t.ds);
    return t.inverse * (turned - lanes::outer(Vec3<S>(2.0 * g), half));
  }
  /// The wrench of a force and a moment, and that of a moment alone.
  template <class S>
  static BOUGH_INLINE DualVec<S> force_moment(const Vec3<S>& f, const Vec3<S>& m) {
    return {f, m};
  }
  template <class S>
  static BOUGH_INLINE DualVec<S> moment(const Vec3<S>& m) {
    return {Vec3<S>::zero(), m};
  }
  /// r += f x in the columns of the rotation; x is the derivative of a force or of a moment by the rotation.
  template <class S>
  static BOUGH_INLINE void add_force_slope(Mat6<S>& r, const S& f, const Mat3<S>& x) {
    for (int i = 0; i < 3; ++i)
      for (int k = 0; k < 3; ++k) r(i, 3 + k) = multiply_add(f, x(i, k), r(i, 3 + k));
  }
  template <class S>
  static BOUGH_INLINE void add_moment_slope(Mat6<S>& r, const S& f, const Mat3<S>& x) {
    for (int i = 0; i < 3; ++i)
      for (int k = 0; k < 3; ++k) r(3 + i, 3 + k) = multiply_add(f, x(i, k), r(3 + i, 3 + k));
  }
  /// x^T applied to the displacement and to the rotation of a twist.
  template <class S>
  static BOUGH_INLINE Vec3<S> force_slope_transpose_times(const Mat3<S>& x, const DualVec<S>& v) {
    return lanes::transpose_times(x, v.b);
  }
  template <class S>
  static BOUGH_INLINE Vec3<S> moment_slope_transpose_times(const Mat3<S>& x, const DualVec<S>& v) {
    return lanes::transpose_times(x, v.a);
  }
  /// r += a b^T of two wrenches.
  template <class S>
  static BOUGH_INLINE void add_outer(Mat6<S>& r, const DualVec<S>& a, const DualVec<S>& b) {
    const Vec6<S> x = wrench_vector(a), y = wrench_vector(b);
    for (int i = 0; i < 6; ++i)
      for (int j = 0; j < 6; ++j) r(i, j) = multiply_add(x[i], y[j], r(i, j));
  }

  // ---- full blocks: the matrices of sections and bodies, and their products

  /// m x and r += m x, computed row by row so that x stays in registers.
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
  /// x^T m, computed column by column so that x stays in registers.
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
  /// r += w and r += w x, where w = A + e B represents [0, A; A, B].
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
  /// r += d(R^T q)/deta of a wrench q constant in inertial axes, f = R^T q. x maps eta to the increment of the frame.
  template <class S>
  static BOUGH_INLINE void add_turning_product(Mat6<S>& r, const DualVec<S>& f, const DualMat<S>& x) {
    const Mat3<S> upper = skew(f.a) * x.a, lower = skew(f.b) * x.a;
    for (int i = 0; i < 3; ++i)
      for (int k = 0; k < 3; ++k) {
        r(i, 3 + k) = r(i, 3 + k) + upper(i, k);
        r(3 + i, 3 + k) = r(3 + i, 3 + k) + lower(i, k);
      }
  }
  template <class S>
  static BOUGH_INLINE void add_turning(Mat6<S>& r, const DualVec<S>& f) {
    const Mat3<S> upper = skew(f.a), lower = skew(f.b);
    for (int i = 0; i < 3; ++i)
      for (int k = 0; k < 3; ++k) {
        r(i, 3 + k) = r(i, 3 + k) + upper(i, k);
        r(3 + i, 3 + k) = r(3 + i, 3 + k) + lower(i, k);
      }
  }
  /// Rows of displacements of the map x; and rows += d(w x u)/deta for v = (u; w), dv = velocity eta.
  template <class S>
  static BOUGH_INLINE lanes::Mat<S, 3, 6> linear_rows(const DualMat<S>& x) {
    lanes::Mat<S, 3, 6> rows;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        rows(i, j) = x.a(i, j);
        rows(i, 3 + j) = x.b(i, j);
      }
    return rows;
  }
  template <class S>
  static BOUGH_INLINE void add_spin_rows(lanes::Mat<S, 3, 6>& rows, const Vec6<S>& v, const DualMat<S>& velocity) {
    const Mat3<S> w = skew(angular_part(v)), u = skew(linear_part(v));
    const Mat3<S> linear = w * velocity.a, angular = w * velocity.b - u * velocity.a;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        rows(i, j) = rows(i, j) + linear(i, j);
        rows(i, 3 + j) = rows(i, 3 + j) + angular(i, j);
      }
  }
  /// r += (f; 0) n^T; and r += a R_k^T R_q in the block of displacements.
  template <class S>
  static BOUGH_INLINE void add_force_outer(Mat6<S>& r, const Vec3<S>& f, const DualVec<S>& n) {
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        r(i, j) = multiply_add(f[i], n.a[j], r(i, j));
        r(i, 3 + j) = multiply_add(f[i], n.b[j], r(i, 3 + j));
      }
  }
  template <class S>
  static BOUGH_INLINE void add_rotation(Mat6<S>& r, const S& a, const Frame<S>& Hk, const Frame<S>& Hq) {
    const Mat3<S> turn = lanes::transpose_times(Hk.R, Hq.R);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) r(i, j) = multiply_add(a, turn(i, j), r(i, j));
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
  /// m -= the derivative of R^T u by the increment of the frame, as a motion. u is a direction constant in inertial
  /// axes, given by its components R^T u in the frame.
  template <class S>
  static BOUGH_INLINE void subtract_turned_back(DualMat<S>& m, const Vec3<S>& components) {
    m.b = m.b - skew(components);
  }
};

}  // namespace bough::motion
