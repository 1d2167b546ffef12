#include "lane_kernels.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <type_traits>

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

/// U of C columns for pivots [k0, k1): rows [k0, k1) of `head`, whose columns are `step` doubles apart.
template <int C>
inline void update_head(const double* l, std::ptrdiff_t ld, int k0, int k1, double* head, std::ptrdiff_t step) {
  for (int p = k0; p + 1 < k1; ++p) {
    Real u[C];
    for (int j = 0; j < C; ++j) u[j] = load(head + j * step + p * wide);
    for (int i = p + 1; i < k1; ++i) {
      const Real factor = load(l + p * ld + i * wide);
      for (int j = 0; j < C; ++j) {
        double* c = head + j * step + i * wide;
        store(c, minus_product(load(c), factor, u[j]));
      }
    }
  }
}

/// Where one register of lanes of a front lies.
struct Front {
  double *left, *upper, *schur;  ///< n x e; e x b; b x b
  int n, e;
  std::ptrdiff_t ld() const { return static_cast<std::ptrdiff_t>(n) * wide; }
};

template <int C>
inline void update_left(const Front& f, int k0, int k1, int column) {
  const std::ptrdiff_t ld = f.ld();
  double* head = f.left + column * ld;
  update_head<C>(f.left, ld, k0, k1, head, ld);
  subtract_columns<C>(f.n - k1, k1 - k0, f.left + k0 * ld + k1 * wide, ld, head + k0 * wide, ld, head + k1 * wide, ld);
}

template <int C>
inline void update_right(const Front& f, int k0, int k1, int column) {
  const int b = f.n - f.e;
  const std::ptrdiff_t ld = f.ld(), step = static_cast<std::ptrdiff_t>(f.e) * wide;
  double* head = f.upper + column * step;
  update_head<C>(f.left, ld, k0, k1, head, step);
  subtract_columns<C>(f.e - k1, k1 - k0, f.left + k0 * ld + k1 * wide, ld, head + k0 * wide, step, head + k1 * wide,
                      step);
  const std::ptrdiff_t tail = static_cast<std::ptrdiff_t>(b) * wide;
  subtract_columns<C>(b, k1 - k0, f.left + k0 * ld + f.e * wide, ld, head + k0 * wide, step, f.schur + column * tail,
                      tail);
}

template <class Update>
inline void for_columns(int begin, int end, const Update& update) {
  int j = begin;
  for (; j + 4 <= end; j += 4) update(j, std::integral_constant<int, 4>{});
  for (; j + 2 <= end; j += 2) update(j, std::integral_constant<int, 2>{});
  for (; j < end; ++j) update(j, std::integral_constant<int, 1>{});
}

void neutralise(const Front& f, unsigned lanes) {
  const int b = f.n - f.e;
  for (int l = 0; l < width; ++l) {
    if ((lanes >> l & 1u) == 0) continue;
    for (int i = 0; i < f.n * f.e; ++i) f.left[i * wide + l] = i / f.n == i % f.n ? 1.0 : 0.0;
    for (int i = 0; i < f.e * b; ++i) f.upper[i * wide + l] = 0.0;
    for (int i = 0; i < b * b; ++i) f.schur[i * wide + l] = 0.0;
  }
}

/// LU of the K x K block at (k0, k0), in place; the inverse pivots on the diagonal. `refused`: lanes whose pivot is tiny, not finite, or small
/// against the block's part of its column.
template <int K>
inline unsigned eliminate_block(const Front& f, int k0, const double* row_scale, const double* inverse_column_scale,
                                const LanePivotRule& rule) {
  const std::ptrdiff_t ld = f.ld();
  double* block = f.left + k0 * ld + k0 * wide;
  Flag good = ~Flag{};
  Real a[K][K];
  for (int j = 0; j < K; ++j)
    for (int i = 0; i < K; ++i) a[j][i] = load(block + j * ld + i * wide);
  for (int k = 0; k < K; ++k) {
    Real largest = {};
    for (int i = k + 1; i < K; ++i)
      largest = greater_of(largest, magnitude(a[k][i] * load(row_scale + (k0 + i) * wide)));
    const Real size = magnitude(a[k][k] * load(row_scale + (k0 + k) * wide));
    // Compared as bits: a NaN or infinity on either side refuses, and traps nothing.
    const Real least = greater_of(rule.threshold * largest, rule.least * load(inverse_column_scale + (k0 + k) * wide));
    const Flag taken = (bits_of(size) >= bits_of(least)) & (bits_of(size) < Flag{} + infinite_bits);
    good &= taken;
    const Real inverse = 1.0 / (taken ? a[k][k] : Real{} + 1.0);
    for (int i = k + 1; i < K; ++i) a[k][i] *= inverse;
    for (int j = k + 1; j < K; ++j)
      for (int i = k + 1; i < K; ++i) a[j][i] = minus_product(a[j][i], a[k][i], a[j][k]);
    a[k][k] = inverse;
  }
  for (int j = 0; j < K; ++j)
    for (int i = 0; i < K; ++i) store(block + j * ld + i * wide, a[j][i]);
  unsigned refused = 0;
  for (int l = 0; l < width; ++l) refused |= good[l] == 0 ? 1u << l : 0u;
  return refused;
}

/// L of R rows below the block, and the largest of each column, rows scaled.
template <int K, int R>
inline void eliminate_rows(const double* block, double* rows, std::ptrdiff_t ld, const double* row_scale,
                           Real* largest) {
  Real l[K][R];
  for (int k = 0; k < K; ++k)
    for (int i = 0; i < R; ++i) l[k][i] = load(rows + k * ld + i * wide);
  for (int k = 0; k < K; ++k) {
    for (int p = 0; p < k; ++p) {
      const Real u = load(block + k * ld + p * wide);
      for (int i = 0; i < R; ++i) l[k][i] = minus_product(l[k][i], l[p][i], u);
    }
    const Real inverse = load(block + k * ld + k * wide);
    for (int i = 0; i < R; ++i) {
      l[k][i] *= inverse;
      store(rows + k * ld + i * wide, l[k][i]);
      largest[k] = greater_of(largest[k], magnitude(l[k][i] * load(row_scale + i * wide)));
    }
  }
}

template <int K>
inline unsigned eliminate_panel(const Front& f, int k0, const double* row_scale, const double* inverse_column_scale,
                                const LanePivotRule& rule) {
  const std::ptrdiff_t ld = f.ld();
  unsigned refused = eliminate_block<K>(f, k0, row_scale, inverse_column_scale, rule);
  if (refused != 0) neutralise(f, refused);
  const double* block = f.left + k0 * ld + k0 * wide;
  Real largest[K];
  for (int k = 0; k < K; ++k) largest[k] = Real{};
  int i = k0 + K;
  double* left = f.left + k0 * ld;
  for (; i + 4 <= f.n; i += 4) eliminate_rows<K, 4>(block, left + i * wide, ld, row_scale + i * wide, largest);
  for (; i + 2 <= f.n; i += 2) eliminate_rows<K, 2>(block, left + i * wide, ld, row_scale + i * wide, largest);
  for (; i < f.n; ++i) eliminate_rows<K, 1>(block, left + i * wide, ld, row_scale + i * wide, largest);
  // A pivot is small against its column where an entry of L, rows scaled, is above 1 / threshold.
  Flag good = ~Flag{};
  for (int k = 0; k < K; ++k)
    good &= bits_of(rule.threshold * largest[k]) <= bits_of(load(row_scale + (k0 + k) * wide));
  unsigned grown = 0;
  for (int l = 0; l < width; ++l) grown |= good[l] == 0 ? 1u << l : 0u;
  if (grown != 0) neutralise(f, grown);
  return refused | grown;
}

/// One register of lanes.
unsigned eliminate_register(const Front& f, const double* row_scale, const double* inverse_column_scale,
                            const LanePivotRule& rule) {
  unsigned failed = 0;
  for (int k0 = 0; k0 < f.e;) {
    const int k = std::min(6, f.e - k0);
    switch (k) {
      case 6:
        failed |= eliminate_panel<6>(f, k0, row_scale, inverse_column_scale, rule);
        break;
      case 5:
        failed |= eliminate_panel<5>(f, k0, row_scale, inverse_column_scale, rule);
        break;
      case 4:
        failed |= eliminate_panel<4>(f, k0, row_scale, inverse_column_scale, rule);
        break;
      case 3:
        failed |= eliminate_panel<3>(f, k0, row_scale, inverse_column_scale, rule);
        break;
      case 2:
        failed |= eliminate_panel<2>(f, k0, row_scale, inverse_column_scale, rule);
        break;
      default:
        failed |= eliminate_panel<1>(f, k0, row_scale, inverse_column_scale, rule);
    }
    for_columns(k0 + k, f.e, [&](int j, auto c) { update_left<decltype(c)::value>(f, k0, k0 + k, j); });
    for_columns(0, f.n - f.e, [&](int j, auto c) { update_right<decltype(c)::value>(f, k0, k0 + k, j); });
    k0 += k;
  }
  return failed;
}

Front register_of(double* factor, double* schur, int n, int e, int lane) {
  return {factor + lane, factor + static_cast<std::ptrdiff_t>(n) * e * wide + lane, n > e ? schur + lane : schur, n, e};
}

/// sum_i (+)= a_ij x_j for R rows i, steps in doubles.
template <int R, bool add>
inline void accumulate(const double* a, std::ptrdiff_t row_step, std::ptrdiff_t column_step, int columns,
                       const double* x, double* y) {
  Real sum[R];
  for (int i = 0; i < R; ++i) sum[i] = load(y + i * wide);
  for (int j = 0; j < columns; ++j) {
    const Real xj = load(x + j * wide);
    for (int i = 0; i < R; ++i) {
      const Real entry = load(a + i * row_step + j * column_step);
      sum[i] = add ? plus_product(sum[i], entry, xj) : minus_product(sum[i], entry, xj);
    }
  }
  for (int i = 0; i < R; ++i) store(y + i * wide, sum[i]);
}

template <bool add>
inline void accumulate_rows(int rows, const double* a, std::ptrdiff_t row_step, std::ptrdiff_t column_step, int columns,
                            const double* x, double* y) {
  int i = 0;
  for (; i + 6 <= rows; i += 6) accumulate<6, add>(a + i * row_step, row_step, column_step, columns, x, y + i * wide);
  for (; i + 2 <= rows; i += 2) accumulate<2, add>(a + i * row_step, row_step, column_step, columns, x, y + i * wide);
  for (; i < rows; ++i) accumulate<1, add>(a + i * row_step, row_step, column_step, columns, x, y + i * wide);
}

}  // namespace

LaneSet eliminate_lanes(double* factor, double* schur, int n, int e, const double* row_scale,
                        const double* inverse_column_scale, const LanePivotRule& rule) {
  unsigned failed = 0;
  for (int l = 0; l < wide; l += width)
    failed |= eliminate_register(register_of(factor, schur, n, e, l), row_scale + l, inverse_column_scale + l, rule)
              << l;
  return static_cast<LaneSet>(failed);
}

void neutralise_lanes(double* factor, double* schur, int n, int e, LaneSet lanes) {
  for (int l = 0; l < wide; l += width)
    neutralise(register_of(factor, schur, n, e, l), static_cast<unsigned>(lanes) >> l);
}

namespace {

/// y_k -= sum_{p<k} l_kp y_p for K rows.
template <int K>
inline void forward_triangle(const double* l, std::ptrdiff_t ld, double* v) {
  Real y[K];
  for (int k = 0; k < K; ++k) y[k] = load(v + k * wide);
  for (int k = 0; k < K; ++k)
    for (int i = k + 1; i < K; ++i) y[i] = minus_product(y[i], load(l + k * ld + i * wide), y[k]);
  for (int k = 1; k < K; ++k) store(v + k * wide, y[k]);
}

template <int K>
inline void backward_triangle(const double* u, std::ptrdiff_t ld, double* v) {
  Real x[K];
  for (int k = 0; k < K; ++k) x[k] = load(v + k * wide);
  for (int k = K - 1; k >= 0; --k) {
    x[k] *= load(u + k * ld + k * wide);
    for (int i = 0; i < k; ++i) x[i] = minus_product(x[i], load(u + k * ld + i * wide), x[k]);
  }
  for (int k = 0; k < K; ++k) store(v + k * wide, x[k]);
}

template <class Triangle>
inline void with_size(int k, const Triangle& triangle) {
  switch (k) {
    case 6:
      triangle(std::integral_constant<int, 6>{});
      break;
    case 5:
      triangle(std::integral_constant<int, 5>{});
      break;
    case 4:
      triangle(std::integral_constant<int, 4>{});
      break;
    case 3:
      triangle(std::integral_constant<int, 3>{});
      break;
    case 2:
      triangle(std::integral_constant<int, 2>{});
      break;
    default:
      triangle(std::integral_constant<int, 1>{});
  }
}

}  // namespace

void forward_lanes(const double* factor, int n, int e, double* v) {
  const std::ptrdiff_t ld = static_cast<std::ptrdiff_t>(n) * wide;
  for (int l = 0; l < wide; l += width)
    for (int k0 = 0; k0 < e;) {
      const int k = std::min(6, e - k0);
      const double* block = factor + k0 * ld + k0 * wide + l;
      with_size(k, [&](auto size) { forward_triangle<decltype(size)::value>(block, ld, v + k0 * wide + l); });
      k0 += k;
      accumulate_rows<false>(n - k0, block + k * wide, wide, ld, k, v + (k0 - k) * wide + l, v + k0 * wide + l);
    }
}

void backward_lanes(const double* factor, int n, int e, double* v) {
  const std::ptrdiff_t ld = static_cast<std::ptrdiff_t>(n) * wide;
  for (int l = 0; l < wide; l += width) {
    accumulate_rows<false>(e, factor + e * ld + l, wide, static_cast<std::ptrdiff_t>(e) * wide, n - e, v + e * wide + l,
                           v + l);
    for (int k0 = (e + 5) / 6 * 6 - 6, k = e - k0; k0 >= 0; k0 -= 6, k = 6) {
      with_size(k, [&](auto size) {
        backward_triangle<decltype(size)::value>(factor + k0 * ld + k0 * wide + l, ld, v + k0 * wide + l);
      });
      accumulate_rows<false>(k0, factor + k0 * ld + l, wide, ld, k, v + k0 * wide + l, v + l);
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

void move_block(const double* source, int row_step, int column_step, int rows, int columns, double* target,
                int target_step, bool is_first) {
  // The source is read in the order in which it lies; the target's few lines stay in the nearest cache.
  const bool by_row = column_step == 1;
  const int outer = by_row ? rows : columns, inner = by_row ? columns : rows;
  const std::ptrdiff_t from_step = static_cast<std::ptrdiff_t>(by_row ? row_step : column_step) * wide;
  const std::ptrdiff_t to_step = by_row ? wide : static_cast<std::ptrdiff_t>(target_step) * wide;
  const std::ptrdiff_t to_inner = by_row ? static_cast<std::ptrdiff_t>(target_step) * wide : wide;
  for (int j = 0; j < outer; ++j) {
    const double* from = source + j * from_step;
    double* to = target + j * to_step;
    if (is_first) {
      for (int i = 0; i < inner; ++i)
        for (int l = 0; l < wide; l += width) store(to + i * to_inner + l, load(from + i * wide + l));
    } else {
      for (int i = 0; i < inner; ++i)
        for (int l = 0; l < wide; l += width)
          store(to + i * to_inner + l, load(to + i * to_inner + l) + load(from + i * wide + l));
    }
  }
}

void multiply_block_lanes(const double* element, int stride, int p, int q, const double* x, double* y) {
  for (int l = 0; l < wide; l += width)
    accumulate_rows<true>(p, element + l, static_cast<std::ptrdiff_t>(stride) * wide, wide, q, x + l, y + l);
}

double largest_asymmetry_lanes(const double* element, int size, const Place* places, int count,
                               const double* row_scale) {
  double largest = 0.0;
  for (int l = 0; l < wide; l += width) {
    Real most = {};
    for (int p = 0, i = 0; p < count; ++p)
      for (int r = places[p].row; r < places[p].row + places[p].length; ++r, ++i) {
        const double* row = element + static_cast<std::ptrdiff_t>(i) * size * wide + l;
        const double* column = element + static_cast<std::ptrdiff_t>(i) * wide + l;
        const std::ptrdiff_t step = static_cast<std::ptrdiff_t>(size) * wide;
        Real of_row = {};
        for (int q = 0, j = 0; j < i; ++q)
          for (int c = places[q].row; c < places[q].row + places[q].length && j < i; ++c, ++j)
            of_row = greater_of(
                of_row, magnitude((load(row + j * wide) - load(column + j * step)) * load(row_scale + c * wide + l)));
        most = greater_of(most, of_row * load(row_scale + r * wide + l));
      }
    for (int k = 0; k < width; ++k) {
      if (!std::isfinite(most[k])) return most[k];
      largest = std::max(largest, most[k]);
    }
  }
  return largest;
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
