#include <algorithm>

#include "dense.hpp"
#include "dense_tiles.hpp"

namespace bough::solve {

namespace tiles {

namespace {

/// m rows of a, k columns, one column after the other, filled up with zeros to full registers.
template <int registers>
void pack_rows(int m, int k, const double* a, std::ptrdiff_t lda, double* packed) {
  constexpr int high = registers * width;
  if (m == high) {
    for (int p = 0; p < k; ++p)
      for (int r = 0; r < registers; ++r) store(packed + p * high + r * width, load(a + p * lda + r * width));
    return;
  }
  const int whole = m - m % width;
  for (int p = 0; p < k; ++p) {
    double* to = packed + p * high;
    const double* from = a + p * lda;
    for (int i = 0; i < whole; i += width) store(to + i, load(from + i));
    for (int i = whole; i < high; ++i) to[i] = i < m ? from[i] : 0.0;
  }
}

/// m x n entries of c, at most registers x width by width; columns of a are `step` apart.
template <int registers, int step>
inline void run_tile(int m, int n, int k, const double* a, const double* b, double* c, std::ptrdiff_t ldc) {
  constexpr int high = registers * width;
  Lanes sum[width][registers] = {};
#pragma GCC unroll 8
  for (int j = 0; j < width; ++j)
    for (int r = 0; r < registers; ++r) __builtin_prefetch(c + std::min(j, n - 1) * ldc + r * width, 1);
  for (int p = 0; p < k; ++p) {
    Lanes left[registers];
#pragma GCC unroll 3
    for (int r = 0; r < registers; ++r) left[r] = load(a + p * step + r * width);
#pragma GCC unroll 8
    for (int j = 0; j < width; ++j) {
      const Lanes right = all(b[p * width + j]);
#pragma GCC unroll 3
      for (int r = 0; r < registers; ++r) sum[j][r] = add_product(left[r], right, sum[j][r]);
    }
  }
  if (m == high && n == width) {
#pragma GCC unroll 8
    for (int j = 0; j < width; ++j)
#pragma GCC unroll 3
      for (int r = 0; r < registers; ++r) {
        double* entry = c + j * ldc + r * width;
        store(entry, load(entry) - sum[j][r]);
      }
    return;
  }
  const int whole = m - m % width;
  double rest[width];
#pragma GCC unroll 8
  for (int j = 0; j < width; ++j) {
    if (j >= n) break;
    double* column = c + j * ldc;
#pragma GCC unroll 3
    for (int r = 0; r < registers; ++r) {
      if (r * width < whole) {
        store(column + r * width, load(column + r * width) - sum[j][r]);
      } else if (r * width < m) {
        store(rest, sum[j][r]);
        for (int i = whole; i < m; ++i) column[i] -= rest[i - whole];
      }
    }
  }
}

/// From column `diagonal` on, registers above the diagonal are omitted.
template <int registers>
void run_row_of_tiles(int m, int n, int k, const double* a, std::ptrdiff_t lda, const double* packed, double* c,
                      std::ptrdiff_t ldc, int diagonal) {
  constexpr int step = registers * width;
  alignas(64) double left[step * deepest];
  pack_rows<registers>(m, k, a, lda, left);
  for (int j = 0; j < n; j += width) {
    const int wide = std::min(width, n - j);
    const double* b = packed + static_cast<std::ptrdiff_t>(j) * k;
    double* columns = c + j * ldc;
    if (j < diagonal + width) {
      run_tile<registers, step>(m, wide, k, left, b, columns, ldc);
    } else if (registers > 2 && j < diagonal + 2 * width) {
      run_tile<std::max(1, registers - 1), step>(m - width, wide, k, left + width, b, columns + width, ldc);
    } else {
      constexpr int above = (registers - 1) * width;
      run_tile<1, step>(m - above, wide, k, left + above, b, columns + above, ldc);
    }
  }
}

}  // namespace

void pack_columns(int k, int n, const double* b, std::ptrdiff_t ldb, double* packed) {
  for (int j = 0; j < (n + width - 1) / width * width; ++j)
    for (int p = 0; p < k; ++p) group_of(packed, k, j / width)[p * width + j % width] = j < n ? b[p + j * ldb] : 0.0;
}

void subtract_packed(int m, int n, int k, const double* a, std::ptrdiff_t lda, const double* packed, double* c,
                     std::ptrdiff_t ldc, bool lower) {
  for (int i = 0; i < m; i += tile_rows) {
    const int high = std::min(tile_rows, m - i), wide = lower ? std::min(n, i + high) : n, diagonal = lower ? i : n;
    if (high > 2 * width) {
      run_row_of_tiles<3>(high, wide, k, a + i, lda, packed, c + i, ldc, diagonal);
    } else if (high > width) {
      run_row_of_tiles<2>(high, wide, k, a + i, lda, packed, c + i, ldc, diagonal);
    } else {
      run_row_of_tiles<1>(high, wide, k, a + i, lda, packed, c + i, ldc, diagonal);
    }
  }
}

}  // namespace tiles

void subtract_product(int m, int n, int k, const double* a, int lda, const double* b, int ldb, double* c, int ldc) {
  using namespace tiles;
  alignas(64) double packed[deepest * chunk];
  for (int p0 = 0; p0 < k; p0 += deepest) {
    const int depth = std::min(deepest, k - p0);
    for (int j0 = 0; j0 < n; j0 += chunk) {
      const int wide = std::min(chunk, n - j0);
      pack_columns(depth, wide, b + p0 + static_cast<std::ptrdiff_t>(j0) * ldb, ldb, packed);
      subtract_packed(m, wide, depth, a + static_cast<std::ptrdiff_t>(p0) * lda, lda, packed,
                      c + static_cast<std::ptrdiff_t>(j0) * ldc, ldc);
    }
  }
}

}  // namespace bough::solve
