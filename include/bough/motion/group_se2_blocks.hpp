#pragma once
/// Scalar functions of the relative pose of two frames, and full blocks, on SE(2); group_se3.hpp explains the names.
#include "bough/motion/group_se2_maps.hpp"

namespace bough::motion {

struct Se2Blocks : Se2Maps {
  // ---- functions of the relative pose H of a second frame in a first. s = e^(-i theta) d is a direction d of the
  // first frame in the axes of the second. A cosine is d . (cos theta, sin theta), an angle is d_1 theta.

  template <class S>
  using Seen = Vec2<S>;
  template <class S>
  using TurnSlope = Vec2<S>;  ///< derivative by theta, of a moment in the first entry
  template <class S, class C>
  static BOUGH_INLINE Vec2<S> seen(const PlanePose<S>& H, const Direction<C>& direction) {
    return conjugate_times(H.R, Vec2<S>{{S(direction.d[0]), S(direction.d[1])}});
  }
  template <class S, class C>
  static BOUGH_INLINE S component(const PlanePose<S>& H, const Direction<C>& direction) {
    return multiply_add(direction.d[1], H.x[1], S(direction.d[0] * H.x[0]));
  }
  template <class S, class C>
  static BOUGH_INLINE S cosine(const Direction<C>&, const Vec2<S>& s) {
    return s[0];
  }
  template <class S, class C>
  static BOUGH_INLINE S cosine_moment(const Direction<C>&, const Vec2<S>& s) {
    return s[1];
  }
  template <class S>
  static BOUGH_INLINE Vec2<S> seen_slope(const Vec2<S>& s) {
    return {{s[1], -s[0]}};
  }
  template <class S, class C>
  static BOUGH_INLINE Vec2<S> cosine_slope(const Direction<C>&, const Vec2<S>& s) {
    return {{-s[0], S(0.0)}};
  }
  template <class S, class C>
  static BOUGH_INLINE Vec2<S> axial_turn(const PlanePose<S>& H, const Direction<C>& direction) {
    return {{H.R[0], direction.d[0] * H.R[1]}};
  }
  template <class S>
  static BOUGH_INLINE S angle_of_turn(const S& c, const S& s) {
    return angle_of(c, s);
  }
  template <class S, class C>
  static BOUGH_INLINE S axial_moment(const PlanePose<S>&, const Direction<C>& direction) {
    return S(direction.d[0]);
  }
  template <class S, class C>
  static BOUGH_INLINE Vec2<S> axial_slope(const PlanePose<S>&, const Direction<C>&) {
    return Vec2<S>::zero();
  }
  template <class S>
  static BOUGH_INLINE Vec3<S> force_moment(const Vec2<S>& f, const S& m) {
    return join(f, m);
  }
  template <class S>
  static BOUGH_INLINE Vec3<S> moment(const S& m) {
    return {{S(0.0), S(0.0), m}};
  }
  template <class S>
  static BOUGH_INLINE void add_force_slope(Mat3<S>& r, const S& f, const Vec2<S>& x) {
    r(0, 2) = multiply_add(f, x[0], r(0, 2));
    r(1, 2) = multiply_add(f, x[1], r(1, 2));
  }
  template <class S>
  static BOUGH_INLINE void add_moment_slope(Mat3<S>& r, const S& f, const Vec2<S>& x) {
    r(2, 2) = multiply_add(f, x[0], r(2, 2));
  }
  template <class S>
  static BOUGH_INLINE S force_slope_transpose_times(const Vec2<S>& x, const Vec3<S>& v) {
    return multiply_add(x[1], v[1], S(x[0] * v[0]));
  }
  template <class S>
  static BOUGH_INLINE S moment_slope_transpose_times(const Vec2<S>& x, const Vec3<S>& v) {
    return x[0] * v[2];
  }
  template <class S>
  static BOUGH_INLINE void add_outer(Mat3<S>& r, const Vec3<S>& a, const Vec3<S>& b) {
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) r(i, j) = multiply_add(a[i], b[j], r(i, j));
  }

  // ---- full blocks

  template <class A, class S>
  static BOUGH_INLINE Mat3<S> block_product(const Mat3<A>& m, const PlaneMap<S>& x) {
    Mat3<S> r;
    for (int i = 0; i < 3; ++i) {
      r(i, 0) = multiply_add(m(i, 1), x.c[1], S(m(i, 0) * x.c[0]));
      r(i, 1) = negative_multiply_add(m(i, 0), x.c[1], S(m(i, 1) * x.c[0]));
      r(i, 2) = multiply_add(m(i, 2), x.b, multiply_add(m(i, 1), x.t[1], S(m(i, 0) * x.t[0])));
    }
    return r;
  }
  template <class A, class S>
  static BOUGH_INLINE Mat3<S> block_product(const Mat3<A>& m, const PlaneBracketMap<S>& x) {
    Mat3<S> r;
    for (int i = 0; i < 3; ++i) {
      r(i, 0) = multiply_add(m(i, 1), x.c[1], S(m(i, 0) * x.c[0]));
      r(i, 1) = negative_multiply_add(m(i, 0), x.c[1], S(m(i, 1) * x.c[0]));
      r(i, 2) = multiply_add(m(i, 1), x.t[1], S(m(i, 0) * x.t[0]));
    }
    return r;
  }
  template <class A, class S>
  static BOUGH_INLINE void add_block_product(Mat3<S>& r, const Mat3<A>& m, const PlaneMap<S>& x) {
    for (int i = 0; i < 3; ++i) {
      r(i, 0) = multiply_add(m(i, 1), x.c[1], multiply_add(m(i, 0), x.c[0], r(i, 0)));
      r(i, 1) = negative_multiply_add(m(i, 0), x.c[1], multiply_add(m(i, 1), x.c[0], r(i, 1)));
      r(i, 2) = multiply_add(m(i, 2), x.b, multiply_add(m(i, 1), x.t[1], multiply_add(m(i, 0), x.t[0], r(i, 2))));
    }
  }
  template <class A, class S>
  static BOUGH_INLINE void add_block_product(Mat3<S>& r, const Mat3<A>& m, const PlaneBracketMap<S>& x) {
    for (int i = 0; i < 3; ++i) {
      r(i, 0) = multiply_add(m(i, 1), x.c[1], multiply_add(m(i, 0), x.c[0], r(i, 0)));
      r(i, 1) = negative_multiply_add(m(i, 0), x.c[1], multiply_add(m(i, 1), x.c[0], r(i, 1)));
      r(i, 2) = multiply_add(m(i, 1), x.t[1], multiply_add(m(i, 0), x.t[0], r(i, 2)));
    }
  }
  template <class S, class A>
  static BOUGH_INLINE Mat3<S> transposed_product(const PlaneMap<S>& x, const Mat3<A>& m) {
    Mat3<S> r;
    for (int j = 0; j < 3; ++j) {
      r(0, j) = multiply_add(x.c[1], m(1, j), S(x.c[0] * m(0, j)));
      r(1, j) = negative_multiply_add(x.c[1], m(0, j), S(x.c[0] * m(1, j)));
      r(2, j) = multiply_add(x.b, m(2, j), multiply_add(x.t[1], m(1, j), S(x.t[0] * m(0, j))));
    }
    return r;
  }
  template <class S, class A>
  static BOUGH_INLINE Mat3<S> transposed_product(const PlaneBracketMap<S>& x, const Mat3<A>& m) {
    Mat3<S> r;
    for (int j = 0; j < 3; ++j) {
      r(0, j) = multiply_add(x.c[1], m(1, j), S(x.c[0] * m(0, j)));
      r(1, j) = negative_multiply_add(x.c[1], m(0, j), S(x.c[0] * m(1, j)));
      r(2, j) = multiply_add(x.t[1], m(1, j), S(x.t[0] * m(0, j)));
    }
    return r;
  }
  template <class S>
  static BOUGH_INLINE void add_ad_transposed(Mat3<S>& r, const Vec3<S>& d, const Mat3<S>& m) {
    for (int j = 0; j < 3; ++j) {
      r(0, j) = multiply_add(d[2], m(1, j), r(0, j));
      r(1, j) = negative_multiply_add(d[2], m(0, j), r(1, j));
      r(2, j) = negative_multiply_add(d[0], m(1, j), multiply_add(d[1], m(0, j), r(2, j)));
    }
  }
  template <class S>
  static BOUGH_INLINE void add_wrench_map(Mat3<S>& r, const PlaneWrenchMap<S>& w) {
    r(0, 2) = r(0, 2) + w.column[0];
    r(1, 2) = r(1, 2) + w.column[1];
    r(2, 0) = r(2, 0) + w.row[0];
    r(2, 1) = r(2, 1) + w.row[1];
    r(2, 2) = r(2, 2) + w.corner;
  }
  template <class S>
  static BOUGH_INLINE void add_wrench_product(Mat3<S>& r, const PlaneWrenchMap<S>& w, const PlaneMap<S>& x) {
    r(0, 2) = multiply_add(w.column[0], x.b, r(0, 2));
    r(1, 2) = multiply_add(w.column[1], x.b, r(1, 2));
    r(2, 0) = multiply_add(w.row[1], x.c[1], multiply_add(w.row[0], x.c[0], r(2, 0)));
    r(2, 1) = negative_multiply_add(w.row[0], x.c[1], multiply_add(w.row[1], x.c[0], r(2, 1)));
    r(2, 2) = multiply_add(w.corner, x.b, multiply_add(w.row[1], x.t[1], multiply_add(w.row[0], x.t[0], r(2, 2))));
  }
  /// r += d(R^T q)/deta of a wrench q constant in inertial axes, f = R^T q. x maps eta to the increment of the frame.
  template <class S>
  static BOUGH_INLINE void add_turning_product(Mat3<S>& r, const Vec3<S>& f, const PlaneMap<S>& x) {
    r(0, 2) = multiply_add(f[1], x.b, r(0, 2));
    r(1, 2) = negative_multiply_add(f[0], x.b, r(1, 2));
  }
  template <class S>
  static BOUGH_INLINE void add_turning(Mat3<S>& r, const Vec3<S>& f) {
    r(0, 2) = r(0, 2) + f[1];
    r(1, 2) = r(1, 2) - f[0];
  }
  /// Rows of displacements of the map x; and rows += d(w x u)/deta for v = (u; w), dv = velocity eta.
  template <class S>
  static BOUGH_INLINE lanes::Mat<S, 2, 3> linear_rows(const PlaneMap<S>& x) {
    return {{x.c[0], -x.c[1], x.t[0], x.c[1], x.c[0], x.t[1]}};
  }
  template <class S>
  static BOUGH_INLINE void add_spin_rows(lanes::Mat<S, 2, 3>& rows, const Vec3<S>& v, const PlaneMap<S>& velocity) {
    const Vec2<S> c = v[2] * quarter_turn(velocity.c);
    const Vec2<S> t = v[2] * quarter_turn(velocity.t) + velocity.b * quarter_turn(plane_part(v));
    const lanes::Mat<S, 2, 3> more{{c[0], -c[1], t[0], c[1], c[0], t[1]}};
    rows += more;
  }
  /// r += (f; 0) n^T; and r += a R_k^T R_q in the block of displacements.
  template <class S>
  static BOUGH_INLINE void add_force_outer(Mat3<S>& r, const Vec2<S>& f, const Vec3<S>& n) {
    for (int i = 0; i < 2; ++i)
      for (int j = 0; j < 3; ++j) r(i, j) = multiply_add(f[i], n[j], r(i, j));
  }
  template <class S>
  static BOUGH_INLINE void add_rotation(Mat3<S>& r, const S& a, const PlanePose<S>& Hk, const PlanePose<S>& Hq) {
    const Vec2<S> turn = conjugate_times(Hk.R, Hq.R);
    r(0, 0) = multiply_add(a, turn[0], r(0, 0));
    r(0, 1) = negative_multiply_add(a, turn[1], r(0, 1));
    r(1, 0) = multiply_add(a, turn[1], r(1, 0));
    r(1, 1) = multiply_add(a, turn[0], r(1, 1));
  }
  template <class C, class S>
  static BOUGH_INLINE Mat3<S> gyroscopic(const Mat3<C>& m, const Vec3<S>& v) {
    const Vec3<S> momentum = m * v;
    Mat3<S> r;
    for (int j = 0; j < 3; ++j) {
      r(0, j) = -(v[2] * m(1, j));
      r(1, j) = v[2] * m(0, j);
      r(2, j) = negative_multiply_add(v[1], m(0, j), S(v[0] * m(1, j)));
    }
    r(0, 2) = r(0, 2) - momentum[1];
    r(1, 2) = r(1, 2) + momentum[0];
    r(2, 0) = r(2, 0) + momentum[1];
    r(2, 1) = r(2, 1) - momentum[0];
    return r;
  }
  template <class S>
  static BOUGH_INLINE void subtract_turned_back(PlaneMap<S>& m, const Vec2<S>& components) {
    m.t = m.t + quarter_turn(components);
  }
};

}  // namespace bough::motion
