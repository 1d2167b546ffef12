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

/// (m0 m1 m2) . (b0 b1 b2) + c.
template <class A, class S>
S fma3(const A& m0, const A& m1, const A& m2, const S& b0, const S& b1, const S& b2, const S& c) {
  using lanes::fma;
  return fma(m2, b2, fma(m1, b1, fma(m0, b0, c)));
}

/// x = m z and x += m z, z an operator on motions.
template <class A, class S>
Mat6<S> motion_product(const Mat6<A>& m, const DualMat<S>& z) {
  using lanes::fma;
  Mat6<S> x;
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 3; ++j) {
      x(i, j) = fma(m(i, 2), z.a(2, j), fma(m(i, 1), z.a(1, j), S(m(i, 0) * z.a(0, j))));
      const S b = fma(m(i, 2), z.b(2, j), fma(m(i, 1), z.b(1, j), S(m(i, 0) * z.b(0, j))));
      x(i, 3 + j) = fma3(m(i, 3), m(i, 4), m(i, 5), z.a(0, j), z.a(1, j), z.a(2, j), b);
    }
  return x;
}
template <class A, class S>
void add_motion_product(Mat6<S>& x, const Mat6<A>& m, const DualMat<S>& z) {
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 3; ++j) {
      x(i, j) = fma3(m(i, 0), m(i, 1), m(i, 2), z.a(0, j), z.a(1, j), z.a(2, j), x(i, j));
      const S b = fma3(m(i, 0), m(i, 1), m(i, 2), z.b(0, j), z.b(1, j), z.b(2, j), x(i, 3 + j));
      x(i, 3 + j) = fma3(m(i, 3), m(i, 4), m(i, 5), z.a(0, j), z.a(1, j), z.a(2, j), b);
    }
}
/// z^T y and x += z^T y.
template <class S, class A>
Mat6<S> transposed_product(const DualMat<S>& z, const Mat6<A>& y) {
  using lanes::fma;
  Mat6<S> x;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 6; ++j) {
      x(i, j) = fma(z.a(2, i), y(2, j), fma(z.a(1, i), y(1, j), S(z.a(0, i) * y(0, j))));
      const S b = fma(z.b(2, i), y(2, j), fma(z.b(1, i), y(1, j), S(z.b(0, i) * y(0, j))));
      x(3 + i, j) = fma(z.a(2, i), y(5, j), fma(z.a(1, i), y(4, j), fma(z.a(0, i), y(3, j), b)));
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
  using lanes::fma;
  using lanes::fnma;
  for (int i = 0; i < 3; ++i) {
    const int n = (i + 1) % 3, l = (i + 2) % 3;
    for (int j = 0; j < 6; ++j) {
      x(i, j) = fma(y(n, j), d.a[l], fnma(y(l, j), d.a[n], x(i, j)));
      const S b = fma(y(n, j), d.b[l], fnma(y(l, j), d.b[n], x(3 + i, j)));
      x(3 + i, j) = fma(y(3 + n, j), d.a[l], fnma(y(3 + l, j), d.a[n], b));
    }
  }
}
/// x += f y.
template <class A, class S>
void add_scaled_to(Mat6<S>& x, const A& f, const Mat6<S>& y) {
  using lanes::fma;
  for (int i = 0; i < 36; ++i) x.m[i] = fma(f, y.m[i], x.m[i]);
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
