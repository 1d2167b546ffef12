#pragma once
/// Dual numbers a + e b (e^2 = 0), 3-vectors and 3x3 matrices of them. By the principle of transference they represent
/// SE(3): a motion vector (u; psi) is the dual vector psi + e u, an operator [A, B; 0, A] on motions is the dual matrix
/// A + e B, and every formula on SO(3) holds unchanged. A wrench (n; m) is n + e m: transposes of operators act on it
/// as transposed dual matrices. A product of two operators is 81 multiplications instead of 216.
#include "bough/motion/types.hpp"

namespace bough::motion {

template <class S>
struct Dual {
  S a, b;
};
template <class S>
struct DualVec {
  Vec3<S> a, b;
  static DualVec zero() { return {Vec3<S>::zero(), Vec3<S>::zero()}; }
};
template <class S>
struct DualMat {
  Mat3<S> a, b;
  static DualMat zero() { return {Mat3<S>::zero(), Mat3<S>::zero()}; }
  static DualMat identity() { return {Mat3<S>::identity(), Mat3<S>::zero()}; }
};

/// Motion vectors (linear; angular), wrenches (force; moment), and back.
template <class S>
BOUGH_INLINE DualVec<S> motion_dual(const Vec6<S>& v) {
  return {angular_part(v), linear_part(v)};
}
template <class S>
BOUGH_INLINE DualVec<S> wrench_dual(const Vec6<S>& f) {
  return {linear_part(f), angular_part(f)};
}
template <class S>
BOUGH_INLINE Vec6<S> motion_vector(const DualVec<S>& v) {
  return join(v.b, v.a);
}
template <class S>
BOUGH_INLINE Vec6<S> wrench_vector(const DualVec<S>& f) {
  return join(f.a, f.b);
}

template <class S>
BOUGH_INLINE Dual<S> operator+(const Dual<S>& x, const Dual<S>& y) {
  return {x.a + y.a, x.b + y.b};
}
template <class S>
BOUGH_INLINE Dual<S> operator-(const Dual<S>& x, const Dual<S>& y) {
  return {x.a - y.a, x.b - y.b};
}
template <class S>
BOUGH_INLINE Dual<S> operator-(const Dual<S>& x) {
  return {-x.a, -x.b};
}
template <class S>
BOUGH_INLINE Dual<S> operator*(const Dual<S>& x, const Dual<S>& y) {
  return {x.a * y.a, multiply_add(x.a, y.b, S(x.b * y.a))};
}
template <class S>
BOUGH_INLINE Dual<S> twice(const Dual<S>& x) {
  return x + x;
}

template <class S>
BOUGH_INLINE DualVec<S> operator+(const DualVec<S>& x, const DualVec<S>& y) {
  return {x.a + y.a, x.b + y.b};
}
template <class S>
BOUGH_INLINE DualVec<S> operator-(const DualVec<S>& x, const DualVec<S>& y) {
  return {x.a - y.a, x.b - y.b};
}
template <class S>
BOUGH_INLINE DualVec<S> operator-(const DualVec<S>& x) {
  return {-x.a, -x.b};
}
template <class S>
BOUGH_INLINE DualVec<S> twice(const DualVec<S>& x) {
  return x + x;
}
/// Scaling by a plain number.
template <class A, class S>
BOUGH_INLINE DualVec<S> scaled(const A& f, const DualVec<S>& x) {
  return {f * x.a, f * x.b};
}
/// r + f x.
template <class A, class S>
BOUGH_INLINE DualVec<S> add_scaled(const DualVec<S>& r, const A& f, const DualVec<S>& x) {
  DualVec<S> s;
  for (int i = 0; i < 3; ++i) {
    s.a[i] = multiply_add(f, x.a[i], r.a[i]);
    s.b[i] = multiply_add(f, x.b[i], r.b[i]);
  }
  return s;
}
template <class S>
BOUGH_INLINE DualVec<S> add_scaled(const DualVec<S>& r, const Dual<S>& f, const DualVec<S>& x) {
  DualVec<S> s;
  for (int i = 0; i < 3; ++i) {
    s.a[i] = multiply_add(f.a, x.a[i], r.a[i]);
    s.b[i] = multiply_add(f.a, x.b[i], multiply_add(f.b, x.a[i], r.b[i]));
  }
  return s;
}
template <class S>
BOUGH_INLINE DualVec<S> operator*(const Dual<S>& f, const DualVec<S>& x) {
  DualVec<S> s;
  for (int i = 0; i < 3; ++i) {
    s.a[i] = f.a * x.a[i];
    s.b[i] = multiply_add(f.a, x.b[i], S(f.b * x.a[i]));
  }
  return s;
}
template <class S>
BOUGH_INLINE Dual<S> dot(const DualVec<S>& x, const DualVec<S>& y) {
  S b = x.b[0] * y.a[0];
  for (int i = 1; i < 3; ++i) b = multiply_add(x.b[i], y.a[i], b);
  for (int i = 0; i < 3; ++i) b = multiply_add(x.a[i], y.b[i], b);
  return {dot(x.a, y.a), b};
}
/// r + x cross y.
template <class S>
BOUGH_INLINE Vec3<S> add_cross(const Vec3<S>& r, const Vec3<S>& x, const Vec3<S>& y) {
  return {{multiply_add(x[1], y[2], negative_multiply_add(x[2], y[1], r[0])),
           multiply_add(x[2], y[0], negative_multiply_add(x[0], y[2], r[1])),
           multiply_add(x[0], y[1], negative_multiply_add(x[1], y[0], r[2]))}};
}
template <class S>
BOUGH_INLINE DualVec<S> cross(const DualVec<S>& x, const DualVec<S>& y) {
  return {cross(x.a, y.a), add_cross(cross(x.a, y.b), x.b, y.a)};
}
template <class S>
BOUGH_INLINE DualVec<S> add_cross(const DualVec<S>& r, const DualVec<S>& x, const DualVec<S>& y) {
  return {add_cross(r.a, x.a, y.a), add_cross(add_cross(r.b, x.a, y.b), x.b, y.a)};
}

template <class S>
DualMat<S> operator+(const DualMat<S>& x, const DualMat<S>& y) {
  return {x.a + y.a, x.b + y.b};
}
template <class S>
DualMat<S> operator-(const DualMat<S>& x, const DualMat<S>& y) {
  return {x.a - y.a, x.b - y.b};
}
template <class A, class S>
DualMat<S> scaled(const A& f, const DualMat<S>& x) {
  return {f * x.a, f * x.b};
}
/// m += f x.
template <class A, class S>
void add_scaled_to(DualMat<S>& m, const A& f, const DualMat<S>& x) {
  for (int i = 0; i < 9; ++i) {
    m.a.m[i] = multiply_add(f, x.a.m[i], m.a.m[i]);
    m.b.m[i] = multiply_add(f, x.b.m[i], m.b.m[i]);
  }
}
template <class S>
BOUGH_INLINE DualMat<S> skew(const DualVec<S>& x) {
  return {skew(x.a), skew(x.b)};
}
template <class S>
BOUGH_INLINE void add_diagonal(DualMat<S>& m, const Dual<S>& x) {
  for (int i = 0; i < 3; ++i) {
    m.a(i, i) = m.a(i, i) + x.a;
    m.b(i, i) = m.b(i, i) + x.b;
  }
}
/// m += x y^T.
template <class S>
BOUGH_INLINE void add_outer(DualMat<S>& m, const DualVec<S>& x, const DualVec<S>& y) {
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      m.a(i, j) = multiply_add(x.a[i], y.a[j], m.a(i, j));
      m.b(i, j) = multiply_add(x.a[i], y.b[j], multiply_add(x.b[i], y.a[j], m.b(i, j)));
    }
}
/// x y and m += x y, computed row by row so that y stays in registers.
template <class S>
DualMat<S> product(const DualMat<S>& x, const DualMat<S>& y) {
  const Mat3<S> ya = y.a, yb = y.b;
  DualMat<S> r;
  for (int i = 0; i < 3; ++i) {
    const S a0 = x.a(i, 0), a1 = x.a(i, 1), a2 = x.a(i, 2), b0 = x.b(i, 0), b1 = x.b(i, 1), b2 = x.b(i, 2);
    for (int j = 0; j < 3; ++j) {
      r.a(i, j) = multiply_add(a2, ya(2, j), multiply_add(a1, ya(1, j), S(a0 * ya(0, j))));
      const S b = multiply_add(a2, yb(2, j), multiply_add(a1, yb(1, j), S(a0 * yb(0, j))));
      r.b(i, j) = multiply_add(b2, ya(2, j), multiply_add(b1, ya(1, j), multiply_add(b0, ya(0, j), b)));
    }
  }
  return r;
}
template <class S>
void add_product(DualMat<S>& m, const DualMat<S>& x, const DualMat<S>& y) {
  const Mat3<S> ya = y.a, yb = y.b;
  for (int i = 0; i < 3; ++i) {
    const S a0 = x.a(i, 0), a1 = x.a(i, 1), a2 = x.a(i, 2), b0 = x.b(i, 0), b1 = x.b(i, 1), b2 = x.b(i, 2);
    S ra[3], rb[3];
    for (int j = 0; j < 3; ++j) {
      ra[j] = multiply_add(a2, ya(2, j), multiply_add(a1, ya(1, j), multiply_add(a0, ya(0, j), m.a(i, j))));
      const S b = multiply_add(a2, yb(2, j), multiply_add(a1, yb(1, j), multiply_add(a0, yb(0, j), m.b(i, j))));
      rb[j] = multiply_add(b2, ya(2, j), multiply_add(b1, ya(1, j), multiply_add(b0, ya(0, j), b)));
    }
    for (int j = 0; j < 3; ++j) {
      m.a(i, j) = ra[j];
      m.b(i, j) = rb[j];
    }
  }
}
/// x ~y, the product with a skew matrix.
template <class S>
DualMat<S> skew_product(const DualMat<S>& x, const DualVec<S>& y) {
  DualMat<S> r;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      const int n = (j + 1) % 3, l = (j + 2) % 3;  // column j of ~y: y_l in row n, -y_n in row l
      r.a(i, j) = negative_multiply_add(x.a(i, l), y.a[n], S(x.a(i, n) * y.a[l]));
      r.b(i, j) = multiply_add(
          x.a(i, n), y.b[l],
          negative_multiply_add(x.a(i, l), y.b[n], multiply_add(x.b(i, n), y.a[l], S(-(x.b(i, l) * y.a[n])))));
    }
  return r;
}
template <class S>
BOUGH_INLINE DualVec<S> times(const DualMat<S>& m, const DualVec<S>& x) {
  DualVec<S> r{m.a * x.a, m.a * x.b};
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 3; ++k) r.b[i] = multiply_add(m.b(i, k), x.a[k], r.b[i]);
  return r;
}
template <class S>
BOUGH_INLINE DualVec<S> transpose_times(const DualMat<S>& m, const DualVec<S>& x) {
  DualVec<S> r{transpose_times(m.a, x.a), transpose_times(m.a, x.b)};
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 3; ++k) r.b[i] = multiply_add(m.b(k, i), x.a[k], r.b[i]);
  return r;
}

}  // namespace bough::motion
