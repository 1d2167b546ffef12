#pragma once
/// What closed-form tangents of elements are put together from: operators on motions as dual matrices, 6x6 blocks of forces.
#include "bough/elements/port.hpp"
#include "bough/motion/dual.hpp"

namespace bough::elements {

using motion::DualMat;
using motion::DualVec;

/// How a port's motion follows its increment eta: H <- H exp(eta) if `moves`, dv = velocity eta, da = acceleration eta.
/// `moves` is the same for all ports of an element; the columns of ports on the ground are dropped afterwards.
template <class S>
struct PortSlopes {
  bool moves = true;
  DualMat<S> velocity, acceleration;
};

/// x = m z and x += m z, z an operator on motions; row by row, z in registers.
template <class A, class S>
Mat6<S> motion_product(const Mat6<A>& m, const DualMat<S>& z) {
  using lanes::multiply_add;
  const Mat3<S> za = z.a, zb = z.b;
  Mat6<S> x;
  for (int i = 0; i < 6; ++i) {
    const A m0 = m(i, 0), m1 = m(i, 1), m2 = m(i, 2), m3 = m(i, 3), m4 = m(i, 4), m5 = m(i, 5);
    for (int j = 0; j < 3; ++j) {
      x(i, j) = multiply_add(m2, za(2, j), multiply_add(m1, za(1, j), S(m0 * za(0, j))));
      const S b = multiply_add(m2, zb(2, j), multiply_add(m1, zb(1, j), S(m0 * zb(0, j))));
      x(i, 3 + j) = multiply_add(m5, za(2, j), multiply_add(m4, za(1, j), multiply_add(m3, za(0, j), b)));
    }
  }
  return x;
}
template <class A, class S>
void add_motion_product(Mat6<S>& x, const Mat6<A>& m, const DualMat<S>& z) {
  using lanes::multiply_add;
  const Mat3<S> za = z.a, zb = z.b;
  for (int i = 0; i < 6; ++i) {
    const A m0 = m(i, 0), m1 = m(i, 1), m2 = m(i, 2), m3 = m(i, 3), m4 = m(i, 4), m5 = m(i, 5);
    S row[6];
    for (int j = 0; j < 3; ++j) {
      row[j] = multiply_add(m2, za(2, j), multiply_add(m1, za(1, j), multiply_add(m0, za(0, j), x(i, j))));
      const S b = multiply_add(m2, zb(2, j), multiply_add(m1, zb(1, j), multiply_add(m0, zb(0, j), x(i, 3 + j))));
      row[3 + j] = multiply_add(m5, za(2, j), multiply_add(m4, za(1, j), multiply_add(m3, za(0, j), b)));
    }
    for (int j = 0; j < 6; ++j) x(i, j) = row[j];
  }
}
/// z^T y, column by column, z in registers.
template <class S, class A>
Mat6<S> transposed_product(const DualMat<S>& z, const Mat6<A>& y) {
  using lanes::multiply_add;
  const Mat3<S> za = z.a, zb = z.b;
  Mat6<S> x;
  for (int j = 0; j < 6; ++j) {
    const A y0 = y(0, j), y1 = y(1, j), y2 = y(2, j), y3 = y(3, j), y4 = y(4, j), y5 = y(5, j);
    for (int i = 0; i < 3; ++i) {
      x(i, j) = multiply_add(za(2, i), y2, multiply_add(za(1, i), y1, S(za(0, i) * y0)));
      const S b = multiply_add(zb(2, i), y2, multiply_add(zb(1, i), y1, S(zb(0, i) * y0)));
      x(3 + i, j) = multiply_add(za(2, i), y5, multiply_add(za(1, i), y4, multiply_add(za(0, i), y3, b)));
    }
  }
  return x;
}
/// x += [0, A; A, B], the derivative of a wrench by a motion given as A + e B.
template <class S>
void add_wrench(Mat6<S>& x, const DualMat<S>& z) {
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      x(i, 3 + j) = x(i, 3 + j) + z.a(i, j);
      x(3 + i, j) = x(3 + i, j) + z.a(i, j);
      x(3 + i, 3 + j) = x(3 + i, 3 + j) + z.b(i, j);
    }
}
/// x += ad(d)^T y.
template <class S>
void add_cross_transposed(Mat6<S>& x, const DualVec<S>& d, const Mat6<S>& y) {
  using lanes::multiply_add;
  using lanes::negative_multiply_add;
  for (int i = 0; i < 3; ++i) {
    const int n = (i + 1) % 3, l = (i + 2) % 3;
    for (int j = 0; j < 6; ++j) {
      x(i, j) = multiply_add(y(n, j), d.a[l], negative_multiply_add(y(l, j), d.a[n], x(i, j)));
      const S b = multiply_add(y(n, j), d.b[l], negative_multiply_add(y(l, j), d.b[n], x(3 + i, j)));
      x(3 + i, j) = multiply_add(y(3 + n, j), d.a[l], negative_multiply_add(y(3 + l, j), d.a[n], b));
    }
  }
}
/// x += f y.
template <class A, class S>
void add_scaled_to(Mat6<S>& x, const A& f, const Mat6<S>& y) {
  using lanes::multiply_add;
  for (int i = 0; i < 36; ++i) x.m[i] = multiply_add(f, y.m[i], x.m[i]);
}
/// d(m a - ad(v)^T m v)/dv = -(ad(v)^T m + ^(m v)).
template <class A, class S>
Mat6<S> gyroscopic_matrix(const Mat6<A>& m, const DualVec<S>& v, const DualVec<S>& momentum) {
  Mat6<S> x = Mat6<S>::zero(), y = lanes::cast<S>(m);
  add_cross_transposed(x, DualVec<S>{-v.a, -v.b}, y);
  add_wrench(x, motion::skew(DualVec<S>{-momentum.a, -momentum.b}));
  return x;
}

/// Writes a block into a row-major matrix of `size` columns.
template <class S>
void put_block(const Mat6<S>& a, int row, int column, int size, S* matrix) {
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j) matrix[(row + i) * size + column + j] = a(i, j);
}

}  // namespace bough::elements
