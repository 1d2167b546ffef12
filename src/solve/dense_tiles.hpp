#pragma once
/// Operations on columns, and the product of packed panels, used by the dense kernels. All loops ascend. Internal to
/// solve.
#include <cstddef>
#include <cstring>

#include "bough/lanes/transpose.hpp"
#include "registers.hpp"

namespace bough::solve::tiles {

using namespace registers;

constexpr int tile_registers = 3;                  ///< height of a tile in registers
constexpr int tile_rows = tile_registers * width;  ///< by `width` columns
constexpr int deepest = 96;                        ///< pivots in one update
constexpr int chunk = 96;                          ///< columns of one update: a multiple of every width

/// c[0, n) -= l[0, n) u.
inline void take_column(int n, const double* l, double u, double* c) {
  int i = 0;
  const Lanes factor = all(u);
  for (; i + width <= n; i += width) store(c + i, take_product(load(l + i), factor, load(c + i)));
  for (; i < n; ++i) c[i] = take_product(l[i], u, c[i]);
}

/// The first n <= width entries, zeros after them; and back.
inline Lanes load_some(int n, const double* p) {
#if defined(__AVX512F__)
  return Lanes(_mm512_maskz_loadu_pd(static_cast<__mmask8>((1u << n) - 1u), p));
#else
  if (n == width) return load(p);
  Lanes v = {};
  std::memcpy(&v, p, sizeof(double) * static_cast<std::size_t>(n));
  return v;
#endif
}
inline void store_some(int n, double* p, const Lanes& v) {
#if defined(__AVX512F__)
  _mm512_mask_storeu_pd(p, static_cast<__mmask8>((1u << n) - 1u), __m512d(v));
#else
  std::memcpy(p, &v, sizeof(double) * static_cast<std::size_t>(n));
#endif
}

/// c[0, n) += a[0, n).
inline void add_to(int n, const double* a, double* c) {
  int i = 0;
  for (; i + width <= n; i += width) store(c + i, load(c + i) + load(a + i));
  if constexpr (width == 8) {
    if (i < n) store_some(n - i, c + i, load_some(n - i, c + i) + load_some(n - i, a + i));
  } else {
    for (; i < n; ++i) c[i] += a[i];
  }
}

/// c_i += scale_i a_i factor for i in [0, n), n <= width; entries of a are `step` apart.
inline void add_scaled(int n, const double* scale, const double* a, std::ptrdiff_t step, double factor, double* c) {
  if (step == 1 && (width == 8 || n == width))
    return store_some(n, c, load_some(n, c) + load_some(n, scale) * load_some(n, a) * factor);
  for (int i = 0; i < n; ++i) c[i] += scale[i] * a[i * step] * factor;
}

/// c_ij += row_scale_i a_ij column_scale_j for a block of at most `width` rows and columns; rows of a and columns of c
/// are contiguous.
inline void add_transposed(int rows, int columns, const double* row_scale, const double* a, std::ptrdiff_t lda,
                           const double* column_scale, double* c, std::ptrdiff_t ldc) {
  Lanes square[width];
#pragma GCC unroll 8
  for (int i = 0; i < width; ++i) square[i] = i < rows ? load_some(columns, a + i * lda) : Lanes{};
  lanes::detail::transpose_square(square);
  const Lanes scale = load_some(rows, row_scale);
#pragma GCC unroll 8
  for (int j = 0; j < width; ++j) {
    if (j == columns) return;
    store_some(rows, c + j * ldc, load_some(rows, c + j * ldc) + scale * square[j] * column_scale[j]);
  }
}

/// c + a b in the first n < width lanes of the products, c in the others: a and b at most n entries in memory.
inline Lanes add_some_products(int n, const double* a, const double* b, const Lanes& c) {
#if defined(__AVX512F__)
  const auto some = static_cast<__mmask8>((1u << n) - 1u);
  return Lanes(_mm512_mask3_fmadd_pd(_mm512_maskz_loadu_pd(some, a), _mm512_maskz_loadu_pd(some, b), __m512d(c), some));
#else
  double sum[width];
  store(sum, c);
  for (int i = 0; i < n; ++i) sum[i] = add_product(a[i], b[i], sum[i]);
  return load(sum);
#endif
}

/// ((p_0 + p_1) + (p_2 + p_3)) + ((p_4 + p_5) + (p_6 + p_7)) of eight numbers in registers.
inline double sum_of_eight(const Lanes* p) {
#if defined(__AVX512F__)
  const Lanes pairs = p[0] + __builtin_shufflevector(p[0], p[0], 1, 0, 3, 2, 5, 4, 7, 6),
              fours = pairs + __builtin_shufflevector(pairs, pairs, 2, 3, 0, 1, 6, 7, 4, 5);
  return fours[0] + fours[4];
#else
  double s[8];
  for (int r = 0; r < 8 / width; ++r) store(s + r * width, p[r]);
  return ((s[0] + s[1]) + (s[2] + s[3])) + ((s[4] + s[5]) + (s[6] + s[7]));
#endif
}

/// A panel of b, k rows of `width` entries, one for each group of columns: group g begins at g k width.
inline double* group_of(double* packed, int k, int group) {
  return packed + static_cast<std::ptrdiff_t>(group) * k * width;
}

/// Packs k rows of n columns of b, the groups filled up with zeros.
void pack_columns(int k, int n, const double* b, std::ptrdiff_t ldb, double* packed);

/// c -= a b with b packed (k rows; groups of `width` columns filled up with zeros). c: m x n, a: m x k.
/// `lower`: only entries (i, j) with i >= j are needed; others may be overwritten.
void subtract_packed(int m, int n, int k, const double* a, std::ptrdiff_t lda, const double* packed, double* c,
                     std::ptrdiff_t ldc, bool lower = false);

}  // namespace bough::solve::tiles
