#include "lane_kernels.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>

#include "bough/lanes/pack.hpp"
#include "lane_plan.hpp"

namespace bough::solve {

namespace {

constexpr int wide = lanes_wide;
constexpr int width =
    std::min(lanes::register_doubles, wide);  ///< lanes in a register; a pack is swept register by register

#if defined(__SSE2__)
typedef double Real __attribute__((vector_size(width * sizeof(double))));
typedef long long Flag __attribute__((vector_size(width * sizeof(double))));
#else
#error "bough needs the vector extensions of GCC or Clang on a machine with SSE2"
#endif

inline Real load(const double* p) {
  Real v;
  std::memcpy(&v, p, sizeof v);
  return v;
}
inline void store(double* p, const Real& v) { std::memcpy(p, &v, sizeof v); }

/// c - a b, rounded once: the same bits on every instruction set.
inline Real minus_product(const Real& c, const Real& a, const Real& b) {
#if defined(__AVX512F__)
  return Real(_mm512_fnmadd_pd(__m512d(a), __m512d(b), __m512d(c)));
#elif defined(__FMA__) && defined(__AVX__)
  return Real(_mm256_fnmadd_pd(__m256d(a), __m256d(b), __m256d(c)));
#else
  Real r;
  for (int l = 0; l < width; ++l) r[l] = std::fma(-a[l], b[l], c[l]);
  return r;
#endif
}
inline Real plus_product(const Real& c, const Real& a, const Real& b) {
#if defined(__AVX512F__)
  return Real(_mm512_fmadd_pd(__m512d(a), __m512d(b), __m512d(c)));
#elif defined(__FMA__) && defined(__AVX__)
  return Real(_mm256_fmadd_pd(__m256d(a), __m256d(b), __m256d(c)));
#else
  Real r;
  for (int l = 0; l < width; ++l) r[l] = std::fma(a[l], b[l], c[l]);
  return r;
#endif
}

constexpr long long infinite_bits = 0x7ff0000000000000LL;
inline Flag bits_of(const Real& x) {
  Flag bits;
  std::memcpy(&bits, &x, sizeof bits);
  return bits;
}
inline Real magnitude(const Real& x) {
  Flag bits;
  std::memcpy(&bits, &x, sizeof bits);
  bits &= Flag{} + 0x7fffffffffffffffLL;
  Real r;
  std::memcpy(&r, &bits, sizeof r);
  return r;
}
/// Greater magnitude, compared as bits: infinity and NaN come out on top.
inline Real greater_of(const Real& a, const Real& b) {
  Flag x, y;
  std::memcpy(&x, &a, sizeof x);
  std::memcpy(&y, &b, sizeof y);
  const Flag f = x > y ? x : y;
  Real r;
  std::memcpy(&r, &f, sizeof r);
  return r;
}

/// c(R x C) -= a(R x k) b(k x C)
template <int R, int C>
inline void subtract_tile(int k, const double* a, std::ptrdiff_t la, const double* b, std::ptrdiff_t lb, double* c,
                          std::ptrdiff_t lc) {
  Real sum[C][R];
  for (int j = 0; j < C; ++j)
    for (int i = 0; i < R; ++i) sum[j][i] = load(c + j * lc + i * wide);
  for (int p = 0; p < k; ++p) {
    Real l[R];
    for (int i = 0; i < R; ++i) l[i] = load(a + p * la + i * wide);
    for (int j = 0; j < C; ++j) {
      const Real u = load(b + p * wide + j * lb);
      for (int i = 0; i < R; ++i) sum[j][i] = minus_product(sum[j][i], l[i], u);
    }
  }
  for (int j = 0; j < C; ++j)
    for (int i = 0; i < R; ++i) store(c + j * lc + i * wide, sum[j][i]);
}

template <int C>
inline void subtract_columns(int m, int k, const double* a, std::ptrdiff_t la, const double* b, std::ptrdiff_t lb,
                             double* c, std::ptrdiff_t lc) {
  constexpr int rows = 6;
  int i = 0;
  for (; i + rows <= m; i += rows) subtract_tile<rows, C>(k, a + i * wide, la, b, lb, c + i * wide, lc);
  for (; i + 3 <= m; i += 3) subtract_tile<3, C>(k, a + i * wide, la, b, lb, c + i * wide, lc);
  for (; i < m; ++i) subtract_tile<1, C>(k, a + i * wide, la, b, lb, c + i * wide, lc);
}

/// U12 of C columns by pivots [k0, k1), then their rows below.
template <int C>
inline void update_columns(double* a, int n, int k0, int k1, double* columns) {
  const std::ptrdiff_t ld = static_cast<std::ptrdiff_t>(n) * wide;
  for (int p = k0; p + 1 < k1; ++p) {
    Real u[C];
    for (int j = 0; j < C; ++j) u[j] = load(columns + j * ld + p * wide);
    for (int i = p + 1; i < k1; ++i) {
      const Real l = load(a + p * ld + i * wide);
      for (int j = 0; j < C; ++j) {
        double* c = columns + j * ld + i * wide;
        store(c, minus_product(load(c), l, u[j]));
      }
    }
  }
  subtract_columns<C>(n - k1, k1 - k0, a + k0 * ld + k1 * wide, ld, columns + k0 * wide, ld, columns + k1 * wide, ld);
}

/// One register of lanes.
unsigned eliminate_register(double* a, int n, int e, const double* row_scale, const double* inverse_column_scale,
                            const LanePivotRule& rule) {
  const std::ptrdiff_t ld = static_cast<std::ptrdiff_t>(n) * wide;
  constexpr int panel = 12;
  unsigned failed = 0;
  for (int k0 = 0; k0 < e; k0 += panel) {
    const int k1 = std::min(e, k0 + panel);
    for (int k = k0; k < k1; ++k) {
      double* column = a + k * ld;
      Real largest = {};
      for (int i = k + 1; i < n; ++i)
        largest = greater_of(largest, magnitude(load(column + i * wide) * load(row_scale + i * wide)));
      Real pivot = load(column + k * wide);
      const Real size = magnitude(pivot * load(row_scale + k * wide));
      // Compared as bits: a NaN or infinity on either side refuses, and traps nothing.
      unsigned refused = 0;
      const Real least = greater_of(rule.threshold * largest, rule.least * load(inverse_column_scale + k * wide));
      const Flag bad = ~((bits_of(size) >= bits_of(least)) & (bits_of(size) < Flag{} + infinite_bits));
      for (int l = 0; l < width; ++l) refused |= bad[l] != 0 ? 1u << l : 0u;
      if (refused != 0) {
        failed |= refused;
        for (int j = 0; j < n; ++j)
          for (int i = 0; i < n; ++i)
            for (int l = 0; l < width; ++l)
              if ((refused >> l & 1u) != 0) a[j * ld + i * wide + l] = i == j && i < e ? 1.0 : 0.0;
        pivot = load(column + k * wide);
      }
      const Real inverse = 1.0 / pivot;
      store(column + k * wide, inverse);
      for (int i = k + 1; i < n; ++i) store(column + i * wide, load(column + i * wide) * inverse);
      for (int j = k + 1; j < k1; ++j) {
        double* c = a + j * ld;
        const Real u = load(c + k * wide);
        for (int i = k + 1; i < n; ++i)
          store(c + i * wide, minus_product(load(c + i * wide), load(column + i * wide), u));
      }
    }
    int j = k1;
    for (; j + 4 <= n; j += 4) update_columns<4>(a, n, k0, k1, a + j * ld);
    for (; j + 2 <= n; j += 2) update_columns<2>(a, n, k0, k1, a + j * ld);
    for (; j < n; ++j) update_columns<1>(a, n, k0, k1, a + j * ld);
  }
  return failed;
}

}  // namespace

LaneSet eliminate_lanes(double* a, int n, int e, const double* row_scale, const double* inverse_column_scale,
                        const LanePivotRule& rule) {
  unsigned failed = 0;
  for (int l = 0; l < wide; l += width)
    failed |= eliminate_register(a + l, n, e, row_scale + l, inverse_column_scale + l, rule) << l;
  return static_cast<LaneSet>(failed);
}

void neutralise_lanes(double* a, int n, int e, LaneSet lanes) {
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i)
      for (int l = 0; l < wide; ++l)
        if ((lanes >> l & 1) != 0) a[(static_cast<std::ptrdiff_t>(j) * n + i) * wide + l] = i == j && i < e ? 1.0 : 0.0;
}

void store_factor(const double* a, int n, int e, double* factor) {
  const std::size_t whole = static_cast<std::size_t>(n) * wide, part = static_cast<std::size_t>(e) * wide;
  std::memcpy(factor, a, sizeof(double) * whole * static_cast<std::size_t>(e));
  factor += whole * static_cast<std::size_t>(e);
  for (int j = e; j < n; ++j, factor += part)
    std::memcpy(factor, a + static_cast<std::size_t>(j) * whole, sizeof(double) * part);
}

void forward_lanes(const double* factor, int n, int e, double* v) {
  const std::ptrdiff_t ld = static_cast<std::ptrdiff_t>(n) * wide;
  for (int l = 0; l < wide; l += width)
    for (int k = 0; k < e; ++k) {
      const Real y = load(v + k * wide + l);
      const double* column = factor + k * ld + l;
      for (int i = k + 1; i < n; ++i)
        store(v + i * wide + l, minus_product(load(v + i * wide + l), load(column + i * wide), y));
    }
}

void backward_lanes(const double* factor, int n, int e, double* v) {
  const std::ptrdiff_t ld = static_cast<std::ptrdiff_t>(n) * wide;
  for (int l = 0; l < wide; l += width) {
    const double* u = factor + e * ld + l;
    for (int j = e; j < n; ++j) {
      const Real x = load(v + j * wide + l);
      for (int i = 0; i < e; ++i, u += wide) store(v + i * wide + l, minus_product(load(v + i * wide + l), load(u), x));
    }
    for (int k = e - 1; k >= 0; --k) {
      const double* column = factor + k * ld + l;
      const Real x = load(v + k * wide + l) * load(column + k * wide);
      store(v + k * wide + l, x);
      for (int i = 0; i < k; ++i)
        store(v + i * wide + l, minus_product(load(v + i * wide + l), load(column + i * wide), x));
    }
  }
}

void backward_left_lanes(const double* factor, int n, int e, double* v) {
  const std::ptrdiff_t ld = static_cast<std::ptrdiff_t>(n) * wide;
  for (int l = 0; l < wide; l += width)
    for (int k = e - 1; k >= 0; --k) {
      Real sum = {};
      for (int i = k + 1; i < n; ++i)
        sum = minus_product(sum, load(factor + k * ld + i * wide + l), load(v + i * wide + l));
      store(v + k * wide + l, sum);
    }
}

void add_block_lanes(const double* element, int stride, int p, int q, double* a, int n) {
  for (int j = 0; j < q; ++j)
    for (int i = 0; i < p; ++i) {
      const double* from = element + (static_cast<std::ptrdiff_t>(i) * stride + j) * wide;
      double* to = a + (static_cast<std::ptrdiff_t>(j) * n + i) * wide;
      for (int l = 0; l < wide; l += width) store(to + l, load(to + l) + load(from + l));
    }
}

void multiply_block_lanes(const double* element, int stride, int p, int q, const double* x, double* y) {
  for (int l = 0; l < wide; l += width)
    for (int i = 0; i < p; ++i) {
      const double* from = element + static_cast<std::ptrdiff_t>(i) * stride * wide + l;
      Real sum = load(y + i * wide + l);
      for (int j = 0; j < q; ++j) sum = plus_product(sum, load(from + j * wide), load(x + j * wide + l));
      store(y + i * wide + l, sum);
    }
}

double largest_scaled(const double* v, const double* scale, int count) {
  Real most = {};
  for (int i = 0; i < count * wide; i += width) most = greater_of(most, magnitude(load(v + i) * load(scale + i)));
  double largest = 0.0;
  for (int l = 0; l < width; ++l) largest = most[l] <= largest ? largest : most[l];
  return largest;
}

void add_packs(const double* from, int count, double* to) {
  for (int i = 0; i < count * wide; i += width) store(to + i, load(to + i) + load(from + i));
}

void add_packs(const double* from, int count, double* to, const std::int8_t* from_lane) {
#if defined(__AVX512F__)
  long long index[wide];
  __mmask8 mask = 0;
  for (int l = 0; l < wide; ++l) {
    index[l] = from_lane[l] < 0 ? 0 : from_lane[l];
    if (from_lane[l] >= 0) mask = static_cast<__mmask8>(mask | 1u << l);
  }
  const __m512i order = _mm512_loadu_si512(index);
  for (int i = 0; i < count; ++i) {
    const __m512d moved = _mm512_maskz_permutexvar_pd(mask, order, _mm512_loadu_pd(from + i * wide));
    _mm512_storeu_pd(to + i * wide, _mm512_add_pd(_mm512_loadu_pd(to + i * wide), moved));
  }
#else
  for (int i = 0; i < count; ++i)
    for (int l = 0; l < wide; ++l)
      if (from_lane[l] >= 0) to[i * wide + l] += from[i * wide + from_lane[l]];
#endif
}

}  // namespace bough::solve
