#pragma once
/// Small vectors and matrices of fixed size over any kernel scalar. They are plain row-major aggregates with value
/// semantics and without allocation. Over packs and derivative types they compile to code close to hand-written loops,
/// which general libraries do not reach. Sums of products are chains of lanes::multiply_add.
#include "bough/lanes/scalar.hpp"

namespace bough::lanes {

template <class S, int N>
struct Vec {
  S v[N];
  static constexpr int size() { return N; }
  S& operator[](int i) { return v[i]; }
  const S& operator[](int i) const { return v[i]; }

  static Vec zero() {
    Vec r;
    for (int i = 0; i < N; ++i) r.v[i] = S(0.0);
    return r;
  }
  static Vec unit(int k) {
    Vec r = zero();
    r.v[k] = S(1.0);
    return r;
  }
  Vec& operator+=(const Vec& b) {
    for (int i = 0; i < N; ++i) v[i] = v[i] + b.v[i];
    return *this;
  }
  Vec& operator-=(const Vec& b) {
    for (int i = 0; i < N; ++i) v[i] = v[i] - b.v[i];
    return *this;
  }
};

template <class S, int R, int C>
struct Mat {
  S m[R * C];
  static constexpr int rows() { return R; }
  static constexpr int cols() { return C; }
  S& operator()(int i, int j) { return m[i * C + j]; }
  const S& operator()(int i, int j) const { return m[i * C + j]; }

  static Mat zero() {
    Mat r;
    for (int i = 0; i < R * C; ++i) r.m[i] = S(0.0);
    return r;
  }
  static Mat identity() {
    Mat r = zero();
    for (int i = 0; i < (R < C ? R : C); ++i) r(i, i) = S(1.0);
    return r;
  }
  Mat& operator+=(const Mat& b) {
    for (int i = 0; i < R * C; ++i) m[i] = m[i] + b.m[i];
    return *this;
  }
};

template <class S, int N>
BOUGH_INLINE Vec<S, N> operator+(const Vec<S, N>& a, const Vec<S, N>& b) {
  Vec<S, N> r;
  for (int i = 0; i < N; ++i) r.v[i] = a.v[i] + b.v[i];
  return r;
}
template <class S, int N>
BOUGH_INLINE Vec<S, N> operator-(const Vec<S, N>& a, const Vec<S, N>& b) {
  Vec<S, N> r;
  for (int i = 0; i < N; ++i) r.v[i] = a.v[i] - b.v[i];
  return r;
}
template <class S, int N>
BOUGH_INLINE Vec<S, N> operator-(const Vec<S, N>& a) {
  Vec<S, N> r;
  for (int i = 0; i < N; ++i) r.v[i] = -a.v[i];
  return r;
}
/// Scaling. The factor may be a plain double while S is a derivative type, which is cheaper than a product of two
/// derivative types.
template <class A, class S, int N>
BOUGH_INLINE Vec<S, N> operator*(const A& a, const Vec<S, N>& b) {
  Vec<S, N> r;
  for (int i = 0; i < N; ++i) r.v[i] = a * b.v[i];
  return r;
}
template <class S, int N>
BOUGH_INLINE S dot(const Vec<S, N>& a, const Vec<S, N>& b) {
  S r = a.v[0] * b.v[0];
  for (int i = 1; i < N; ++i) r = multiply_add(a.v[i], b.v[i], r);
  return r;
}
/// Of vectors whose squares neither overflow nor vanish; motion::norm takes any.
template <class S, int N>
BOUGH_INLINE S length_of(const Vec<S, N>& a) {
  using std::sqrt;
  return sqrt(dot(a, a));
}
template <class S>
BOUGH_INLINE Vec<S, 3> cross(const Vec<S, 3>& a, const Vec<S, 3>& b) {
  return {{negative_multiply_add(a[2], b[1], S(a[1] * b[2])), negative_multiply_add(a[0], b[2], S(a[2] * b[0])),
           negative_multiply_add(a[1], b[0], S(a[0] * b[1]))}};
}
template <class S>
BOUGH_INLINE Mat<S, 3, 3> skew(const Vec<S, 3>& a) {
  const S o(0.0);
  return {{o, -a[2], a[1], a[2], o, -a[0], -a[1], a[0], o}};
}
template <class S, int R, int C>
Mat<S, R, C> operator+(const Mat<S, R, C>& a, const Mat<S, R, C>& b) {
  Mat<S, R, C> r;
  for (int i = 0; i < R * C; ++i) r.m[i] = a.m[i] + b.m[i];
  return r;
}
template <class S, int R, int C>
Mat<S, R, C> operator-(const Mat<S, R, C>& a, const Mat<S, R, C>& b) {
  Mat<S, R, C> r;
  for (int i = 0; i < R * C; ++i) r.m[i] = a.m[i] - b.m[i];
  return r;
}
template <class A, class S, int R, int C>
Mat<S, R, C> operator*(const A& a, const Mat<S, R, C>& b) {
  Mat<S, R, C> r;
  for (int i = 0; i < R * C; ++i) r.m[i] = a * b.m[i];
  return r;
}
template <class S, int R, int K, int C>
Mat<S, R, C> operator*(const Mat<S, R, K>& a, const Mat<S, K, C>& b) {
  Mat<S, R, C> r;
  for (int i = 0; i < R; ++i)
    for (int j = 0; j < C; ++j) {
      S s = a(i, 0) * b(0, j);
      for (int k = 1; k < K; ++k) s = multiply_add(a(i, k), b(k, j), s);
      r(i, j) = s;
    }
  return r;
}
/// Matrix times vector. The matrix may hold plain doubles while the vector is of a derivative type.
template <class A, class S, int R, int C>
Vec<S, R> operator*(const Mat<A, R, C>& a, const Vec<S, C>& b) {
  Vec<S, R> r;
  for (int i = 0; i < R; ++i) {
    S s = a(i, 0) * b[0];
    for (int k = 1; k < C; ++k) s = multiply_add(a(i, k), b[k], s);
    r[i] = s;
  }
  return r;
}
/// a^T b without forming the transpose.
template <class A, class S, int R, int C>
Vec<S, C> transpose_times(const Mat<A, R, C>& a, const Vec<S, R>& b) {
  Vec<S, C> r;
  for (int j = 0; j < C; ++j) {
    S s = a(0, j) * b[0];
    for (int k = 1; k < R; ++k) s = multiply_add(a(k, j), b[k], s);
    r[j] = s;
  }
  return r;
}
/// a^T b for matrices.
template <class S, int K, int R, int C>
Mat<S, R, C> transpose_times(const Mat<S, K, R>& a, const Mat<S, K, C>& b) {
  Mat<S, R, C> r;
  for (int i = 0; i < R; ++i)
    for (int j = 0; j < C; ++j) {
      S s = a(0, i) * b(0, j);
      for (int k = 1; k < K; ++k) s = multiply_add(a(k, i), b(k, j), s);
      r(i, j) = s;
    }
  return r;
}
template <class S, int R, int C>
Mat<S, C, R> transpose(const Mat<S, R, C>& a) {
  Mat<S, C, R> r;
  for (int i = 0; i < R; ++i)
    for (int j = 0; j < C; ++j) r(j, i) = a(i, j);
  return r;
}
template <class S, int R, int C>
Mat<S, R, C> outer(const Vec<S, R>& a, const Vec<S, C>& b) {
  Mat<S, R, C> r;
  for (int i = 0; i < R; ++i)
    for (int j = 0; j < C; ++j) r(i, j) = a[i] * b[j];
  return r;
}
template <class S>
BOUGH_INLINE Vec<S, 6> join(const Vec<S, 3>& linear, const Vec<S, 3>& angular) {
  return {{linear[0], linear[1], linear[2], angular[0], angular[1], angular[2]}};
}
template <class S>
BOUGH_INLINE Vec<S, 3> linear_part(const Vec<S, 6>& a) {
  return {{a[0], a[1], a[2]}};
}
template <class S>
BOUGH_INLINE Vec<S, 3> angular_part(const Vec<S, 6>& a) {
  return {{a[3], a[4], a[5]}};
}
template <class S>
BOUGH_INLINE Vec<S, 3> column(const Mat<S, 3, 3>& a, int j) {
  return {{a(0, j), a(1, j), a(2, j)}};
}
/// Conversion of every entry to another scalar.
template <class T, class S, int N>
Vec<T, N> cast(const Vec<S, N>& a) {
  Vec<T, N> r;
  for (int i = 0; i < N; ++i) r[i] = T(a[i]);
  return r;
}
template <class T, class S, int R, int C>
Mat<T, R, C> cast(const Mat<S, R, C>& a) {
  Mat<T, R, C> r;
  for (int i = 0; i < R * C; ++i) r.m[i] = T(a.m[i]);
  return r;
}

}  // namespace bough::lanes
