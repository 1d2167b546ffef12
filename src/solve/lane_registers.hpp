#pragma once
/// The product of packs, and parts of eliminations, used by the kernels of eight fronts. Internal to solve.
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <type_traits>

#include "lane_kernels.hpp"
#include "lane_plan.hpp"
#include "registers.hpp"
#include "transfers.hpp"

namespace bough::solve {

namespace packs {

using namespace registers;

constexpr int wide = lanes_wide;
static_assert(wide % width == 0, "a pack is processed register by register");

/// c(R x C) -= a(R x k) b(k x C)
template <int R, int C>
[[gnu::always_inline]] inline void subtract_tile(int k, const double* a, std::ptrdiff_t la, const double* b,
                                                 std::ptrdiff_t lb, double* c, std::ptrdiff_t lc) {
  Lanes sum[C][R];
  for (int j = 0; j < C; ++j)
    for (int i = 0; i < R; ++i) sum[j][i] = load(c + j * lc + i * wide);
  for (int p = 0; p < k; ++p) {
    Lanes l[R];
    for (int i = 0; i < R; ++i) l[i] = load(a + p * la + i * wide);
    for (int j = 0; j < C; ++j) {
      const Lanes u = load(b + p * wide + j * lb);
      for (int i = 0; i < R; ++i) sum[j][i] = take_product(l[i], u, sum[j][i]);
    }
  }
  for (int j = 0; j < C; ++j)
    for (int i = 0; i < R; ++i) store(c + j * lc + i * wide, sum[j][i]);
}

template <int C>
inline void subtract_columns(int m, int k, const double* a, std::ptrdiff_t la, const double* b, std::ptrdiff_t lb,
                             double* c, std::ptrdiff_t lc) {
  int i = 0;
  for (; i + 6 <= m; i += 6) subtract_tile<6, C>(k, a + i * wide, la, b, lb, c + i * wide, lc);
  for (; i + 4 <= m; i += 4) subtract_tile<4, C>(k, a + i * wide, la, b, lb, c + i * wide, lc);
  for (; i + 2 <= m; i += 2) subtract_tile<2, C>(k, a + i * wide, la, b, lb, c + i * wide, lc);
  for (; i < m; ++i) subtract_tile<1, C>(k, a + i * wide, la, b, lb, c + i * wide, lc);
}

/// The memory of one register of lanes of a front.
struct Front {
  double *left, *upper, *schur;  ///< n x e; e x b, symmetric: null; b x b
  int n, e;
  std::ptrdiff_t ld() const { return static_cast<std::ptrdiff_t>(n) * wide; }
};

template <class Update>
inline void for_columns(int begin, int end, const Update& update) {
  int j = begin;
  for (; j + 4 <= end; j += 4) update(j, std::integral_constant<int, 4>{});
  for (; j + 2 <= end; j += 2) update(j, std::integral_constant<int, 2>{});
  for (; j < end; ++j) update(j, std::integral_constant<int, 1>{});
}

inline void neutralise(const Front& f, unsigned lanes) {
  const int b = f.n - f.e;
  for (int l = 0; l < width; ++l) {
    if ((lanes >> l & 1u) == 0) continue;
    for (int i = 0; i < f.n * f.e; ++i) f.left[i * wide + l] = i / f.n == i % f.n ? 1.0 : 0.0;
    for (int i = 0; f.upper != nullptr && i < f.e * b; ++i) f.upper[i * wide + l] = 0.0;
    for (int i = 0; i < b * b; ++i) f.schur[i * wide + l] = 0.0;
  }
}

inline Front register_of(double* factor, double* schur, int n, int e, int lane, Symmetry symmetry) {
  double* upper = symmetry == Symmetry::general ? factor + static_cast<std::ptrdiff_t>(n) * e * wide + lane : nullptr;
  return {factor + lane, upper, n > e ? schur + lane : schur, n, e};
}

/// sum_i (+)= a_ij x_j for R rows i, steps in doubles.
template <int R, bool add>
inline void accumulate(const double* a, std::ptrdiff_t row_step, std::ptrdiff_t column_step, int columns,
                       const double* x, double* y) {
  Lanes sum[R];
  for (int i = 0; i < R; ++i) sum[i] = load(y + i * wide);
  for (int j = 0; j < columns; ++j) {
    const Lanes xj = load(x + j * wide);
    for (int i = 0; i < R; ++i) {
      const Lanes entry = load(a + i * row_step + j * column_step);
      sum[i] = add ? add_product(entry, xj, sum[i]) : take_product(entry, xj, sum[i]);
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

constexpr int panel_width = 6;  ///< pivots of one update

/// LU of the K x K block at (k0, k0), in place; the inverse pivots on the diagonal. `refused`: lanes whose pivot is
/// tiny, not finite, or small relative to the block's part of its column. Symmetric: entries above the diagonal are not
/// read.
template <int K, Symmetry symmetry>
inline unsigned eliminate_block(const Front& f, int k0, const double* row_scale, const double* inverse_column_scale,
                                const PivotRule& rule) {
  const std::ptrdiff_t ld = f.ld();
  double* block = f.left + k0 * ld + k0 * wide;
  Flag good = ~Flag{};
  Lanes a[K][K];
#pragma GCC unroll 8
  for (int j = 0; j < K; ++j)
#pragma GCC unroll 8
    for (int i = 0; i < K; ++i)
      a[j][i] =
          symmetry != Symmetry::general && i < j ? load(block + i * ld + j * wide) : load(block + j * ld + i * wide);
#pragma GCC unroll 8
  for (int k = 0; k < K; ++k) {
    // Compared as bits: a NaN or infinity on either side rejects without a trap. The pivot is compared with its column
    // in parallel with the division, which would otherwise wait for the result.
    const Lanes size = magnitude(a[k][k] * load(row_scale + (k0 + k) * wide));
    const Lanes least = rule.least * load(inverse_column_scale + (k0 + k) * wide);
    const Flag divides = (bits_of(size) >= bits_of(least)) & (bits_of(size) < Flag{} + infinite_bits);
    good &= divides;
    const Lanes inverse = 1.0 / (divides ? a[k][k] : Lanes{} + 1.0);
    Lanes largest = {};
#pragma GCC unroll 8
    for (int i = k + 1; i < K; ++i)
      largest = greater_of(largest, magnitude(a[k][i] * load(row_scale + (k0 + i) * wide)));
    good &= bits_of(size) >= bits_of(rule.threshold * largest);
#pragma GCC unroll 8
    for (int i = k + 1; i < K; ++i) a[k][i] *= inverse;
#pragma GCC unroll 8
    for (int j = k + 1; j < K; ++j)
#pragma GCC unroll 8
      for (int i = k + 1; i < K; ++i) a[j][i] = take_product(a[k][i], a[j][k], a[j][i]);
    a[k][k] = inverse;
  }
#pragma GCC unroll 8
  for (int j = 0; j < K; ++j)
#pragma GCC unroll 8
    for (int i = 0; i < K; ++i) store(block + j * ld + i * wide, a[j][i]);
  unsigned refused = 0;
  for (int l = 0; l < width; ++l) refused |= good[l] == 0 ? 1u << l : 0u;
  return refused;
}

/// L of R rows below the block, and the largest entry of each column, rows scaled. Symmetric: L D is written to
/// `products`, row by row, six packs per row.
template <int K, Symmetry symmetry, int R>
inline void eliminate_rows(const double* block, double* rows, std::ptrdiff_t ld, const double* row_scale,
                           Lanes* largest, [[maybe_unused]] double* products) {
  Lanes l[K][R];
#pragma GCC unroll 8
  for (int k = 0; k < K; ++k)
#pragma GCC unroll 8
    for (int i = 0; i < R; ++i) l[k][i] = load(rows + k * ld + i * wide);
#pragma GCC unroll 8
  for (int k = 0; k < K; ++k) {
#pragma GCC unroll 8
    for (int p = 0; p < k; ++p) {
      const Lanes u = load(block + k * ld + p * wide);
#pragma GCC unroll 8
      for (int i = 0; i < R; ++i) l[k][i] = take_product(l[p][i], u, l[k][i]);
    }
    const Lanes inverse = load(block + k * ld + k * wide);
#pragma GCC unroll 8
    for (int i = 0; i < R; ++i) {
      if constexpr (symmetry != Symmetry::general) store(products + (i * panel_width + k) * wide, l[k][i]);
      l[k][i] *= inverse;
      store(rows + k * ld + i * wide, l[k][i]);
      largest[k] = greater_of(largest[k], magnitude(l[k][i] * load(row_scale + i * wide)));
    }
  }
}

/// The columns of a panel: their block, and L below. Rejected lanes are replaced by an identity and returned. beside:
/// one step for every four rows or fewer.
template <int K, Symmetry symmetry>
inline unsigned eliminate_panel(const Front& f, int k0, const double* row_scale, const double* inverse_column_scale,
                                const PivotRule& rule, double* products, Transfers& beside) {
  const std::ptrdiff_t ld = f.ld();
  unsigned refused = eliminate_block<K, symmetry>(f, k0, row_scale, inverse_column_scale, rule);
  if (refused != 0) neutralise(f, refused);
  const double* block = f.left + k0 * ld + k0 * wide;
  Lanes largest[K];
  for (int k = 0; k < K; ++k) largest[k] = Lanes{};
  int i = k0 + K;
  double* left = f.left + k0 * ld;
  const auto rows = [&](int first, auto count) {
    double* of_rows = symmetry != Symmetry::general ? products + (first - k0 - K) * panel_width * wide : nullptr;
    beside.step();
    eliminate_rows<K, symmetry, decltype(count)::value>(block, left + first * wide, ld, row_scale + first * wide,
                                                        largest, of_rows);
  };
  for (; i + 4 <= f.n; i += 4) rows(i, std::integral_constant<int, 4>{});
  for (; i + 2 <= f.n; i += 2) rows(i, std::integral_constant<int, 2>{});
  for (; i < f.n; ++i) rows(i, std::integral_constant<int, 1>{});
  // A pivot is small relative to its column if an entry of L, rows scaled, is above 1 / threshold.
  Flag good = ~Flag{};
  for (int k = 0; k < K; ++k)
    good &= bits_of(rule.threshold * largest[k]) <= bits_of(load(row_scale + (k0 + k) * wide));
  unsigned grown = 0;
  for (int l = 0; l < width; ++l) grown |= good[l] == 0 ? 1u << l : 0u;
  if (grown != 0) neutralise(f, grown);
  for (int l = 0; symmetry != Symmetry::general && l < width;
       ++l)  // otherwise updates would reintroduce numbers that are not finite
    for (int r = 0; (grown >> l & 1u) != 0 && r < (f.n - k0 - K) * panel_width; ++r) products[r * wide + l] = 0.0;
  return refused | grown;
}

}  // namespace packs

}  // namespace bough::solve
