#pragma once
/// What closed-form tangents of elements are put together from.
#include "bough/elements/port.hpp"

namespace bough::elements {

/// How a port's motion follows its increment eta: H <- H exp(eta) if `moves`, dv = velocity eta, da = acceleration eta.
/// `moves` is the same for all ports of an element; the columns of ports on the ground are dropped afterwards.
struct PortSlopes {
  bool moves = true;
  Mat6<double> velocity, acceleration;
};

/// c += w a b, rows of c in registers.
inline void add_product(Mat6<double>& c, const Mat6<double>& a, const Mat6<double>& b, double w = 1.0) {
  for (int i = 0; i < 6; ++i) {
    double row[6] = {};
    for (int k = 0; k < 6; ++k) {
      const double f = a(i, k);
      for (int j = 0; j < 6; ++j) row[j] += f * b(k, j);
    }
    for (int j = 0; j < 6; ++j) c(i, j) += w * row[j];
  }
}
inline Mat6<double> product(const Mat6<double>& a, const Mat6<double>& b) {
  Mat6<double> c = Mat6<double>::zero();
  add_product(c, a, b);
  return c;
}
/// c += w a.
inline void add_scaled(Mat6<double>& c, double w, const Mat6<double>& a) {
  for (int i = 0; i < 36; ++i) c.m[i] += w * a.m[i];
}
/// Operators on motions have the shape [A, B; 0, A]; so have their products. The functions below take and give such
/// matrices and compute the upper half only.
inline void copy_lower_half(Mat6<double>& c) {
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) c(3 + i, 3 + j) = c(i, j);
}
/// c += w a b, all [A, B; 0, A].
inline void add_motion_product(Mat6<double>& c, const Mat6<double>& a, const Mat6<double>& b, double w = 1.0) {
  for (int i = 0; i < 3; ++i) {
    double row[6] = {};
    for (int k = 0; k < 6; ++k) {
      const double f = a(i, k);
      for (int j = 0; j < 6; ++j) row[j] += f * b(k, j);
    }
    for (int j = 0; j < 6; ++j) c(i, j) += w * row[j];
  }
  copy_lower_half(c);
}
inline Mat6<double> motion_product(const Mat6<double>& a, const Mat6<double>& b) {
  Mat6<double> c = Mat6<double>::zero();
  add_motion_product(c, a, b);
  return c;
}
/// ad(v) a, a = [A, B; 0, A].
inline Mat6<double> cross6_product(const Vec6<double>& v, const Mat6<double>& a) {
  Mat6<double> r = Mat6<double>::zero();
  for (int i = 0; i < 3; ++i) {
    const int next = (i + 1) % 3, last = (i + 2) % 3;
    for (int j = 0; j < 6; ++j)
      r(i, j) =
          v[3 + next] * a(last, j) - v[3 + last] * a(next, j) + v[next] * a(3 + last, j) - v[last] * a(3 + next, j);
  }
  copy_lower_half(r);
  return r;
}
/// c += w a^T b, a = [A, B; 0, A], b and c any.
inline void add_transposed_product(Mat6<double>& c, const Mat6<double>& a, const Mat6<double>& b, double w = 1.0) {
  for (int i = 0; i < 6; ++i) {
    double row[6] = {};
    for (int k = 0; k < (i < 3 ? 3 : 6); ++k) {
      const double f = a(k, i);
      for (int j = 0; j < 6; ++j) row[j] += f * b(k, j);
    }
    for (int j = 0; j < 6; ++j) c(i, j) += w * row[j];
  }
}
inline Mat6<double> transposed_product(const Mat6<double>& a, const Mat6<double>& b) {
  Mat6<double> c = Mat6<double>::zero();
  add_transposed_product(c, a, b);
  return c;
}

/// Writes a block into a row-major matrix of `size` columns.
inline void put_block(const Mat6<double>& a, int row, int column, int size, double* matrix) {
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j) matrix[(row + i) * size + column + j] = a(i, j);
}

}  // namespace bough::elements
