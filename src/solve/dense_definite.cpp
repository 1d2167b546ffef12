#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "dense.hpp"
#include "dense_panel.hpp"
#include "dense_tiles.hpp"

namespace bough::solve {

namespace {

using namespace tiles;

/// The square of a panel: its unit L by rows, in groups of `width` rows, one column after the other, in the layout of
/// packed products.
struct Square {
  alignas(64) double l[deepest * deepest];
  double inverse[deepest];  ///< of D
  int depth;
  double* group(int g) { return group_of(l, depth, g); }
  const double* group(int g) const { return l + static_cast<std::ptrdiff_t>(g) * depth * width; }
};

/// The first m of `registers` x width rows of a column, m > (registers - 1) width, zeros after them; and back.
template <int registers>
inline void load_rows(int m, const double* column, Lanes* rows) {
#pragma GCC unroll 3
  for (int r = 0; r + 1 < registers; ++r) rows[r] = load(column + r * width);
  constexpr int whole = (registers - 1) * width;
  rows[registers - 1] = m == registers * width ? load(column + whole) : load_some(m - whole, column + whole);
}
template <int registers>
inline void store_rows(int m, const Lanes* rows, double* column) {
#pragma GCC unroll 3
  for (int r = 0; r + 1 < registers; ++r) store(column + r * width, rows[r]);
  constexpr int whole = (registers - 1) * width;
  if (m == registers * width) {
    store(column + whole, rows[registers - 1]);
  } else {
    store_some(m - whole, column + whole, rows[registers - 1]);
  }
}

/// t = rows of `width` columns minus their part in the pivots [0, depth): x is L D of the rows, b a group of L.
template <int registers>
inline void reduce_tile(int depth, const double* x, const double* b, Lanes (&t)[width][registers]) {
  for (int p = 0; p < depth; ++p) {
    Lanes left[registers];
#pragma GCC unroll 3
    for (int r = 0; r < registers; ++r) left[r] = load(x + (p * registers + r) * width);
#pragma GCC unroll 8
    for (int j = 0; j < width; ++j) {
      const Lanes right = all(b[p * width + j]);
#pragma GCC unroll 3
      for (int r = 0; r < registers; ++r) t[j][r] = take_product(left[r], right, t[j][r]);
    }
  }
}

/// L of m rows, at most registers x width, in the columns [0, columns) of a panel, in place; x: memory for their L D,
/// packed. reduction: the amount that these pivots subtract from each row's diagonal.
template <int registers>
inline void solve_rows(int m, int columns, const Square& square, double* a, std::ptrdiff_t lda, double* x,
                       double* reduction) {
  Lanes lost[registers] = {};
  for (int k0 = 0; k0 < columns; k0 += width) {
    const double* b = square.group(k0 / width);
    const int wide = std::min(width, columns - k0);
    Lanes t[width][registers];
#pragma GCC unroll 8
    for (int j = 0; j < width; ++j) load_rows<registers>(m, a + (k0 + std::min(j, wide - 1)) * lda, t[j]);
    reduce_tile<registers>(k0, x, b, t);
#pragma GCC unroll 8
    for (int k = 0; k < width; ++k) {
      if (k >= wide) break;
#pragma GCC unroll 8
      for (int j = k + 1; j < width; ++j) {
        const Lanes right = all(b[(k0 + k) * width + j]);
#pragma GCC unroll 3
        for (int r = 0; r < registers; ++r) t[j][r] = take_product(t[k][r], right, t[j][r]);
      }
      const Lanes inverse = all(square.inverse[k0 + k]);
      Lanes l[registers];
#pragma GCC unroll 3
      for (int r = 0; r < registers; ++r) {
        store(x + ((k0 + k) * registers + r) * width, t[k][r]);
        l[r] = t[k][r] * inverse;
        lost[r] = add_product(t[k][r], l[r], lost[r]);
      }
      store_rows<registers>(m, l, a + (k0 + k) * lda);
    }
  }
  for (int r = 0; r < registers; ++r) store(reduction + r * width, lost[r]);
}

/// Whether a pivot is finite and not below a positive limit. Compared as bits, so that NaN causes no trap.
bool holds(double pivot, double least) {
  const auto bits = std::bit_cast<std::int64_t>(pivot);
  return bits >= std::bit_cast<std::int64_t>(least) &&
         bits < std::bit_cast<std::int64_t>(std::numeric_limits<double>::infinity());
}

/// L D L^T of a square in place, `width` rows after the other. least: lower limit of each pivot. Returns the number of
/// accepted pivots.
int eliminate_square(double* a, std::ptrdiff_t lda, const double* least, double* d, Square& square) {
  alignas(64) double x[width * deepest], reduction[width];
  for (int k0 = 0; k0 < square.depth; k0 += width) {
    const int m = std::min(width, square.depth - k0);
    double *rows = a + k0, *b = square.group(k0 / width);
    solve_rows<1>(m, k0, square, rows, lda, x, reduction);
    for (int p = 0; p < k0; ++p) store(b + p * width, load(x + p * width) * all(square.inverse[p]));
    Lanes t[width][1];
    for (int j = 0; j < width; ++j) load_rows<1>(m, rows + (k0 + std::min(j, m - 1)) * lda, t[j]);
    reduce_tile<1>(k0, x, b, t);
    for (int k = 0; k < m; ++k) {
      alignas(64) double column[width];
      const double pivot = t[k][0][k];
      if (!holds(pivot, least[k0 + k])) return k0 + k;
      d[2 * (k0 + k)] = pivot;
      d[2 * (k0 + k) + 1] = 0.0;
      square.inverse[k0 + k] = 1.0 / pivot;
      const Lanes l = t[k][0] * all(square.inverse[k0 + k]);
      store(column, l);
      for (int i = 0; i < width; ++i) b[(k0 + k) * width + i] = i > k && i < m ? column[i] : 0.0;
      for (int j = k + 1; j < m; ++j) t[j][0] = take_product(t[k][0], all(column[j]), t[j][0]);
      std::memcpy(rows + (k0 + k) * lda + k + 1, column + k + 1, sizeof(double) * static_cast<std::size_t>(m - k - 1));
    }
  }
  return square.depth;
}

}  // namespace

int eliminate_definite(FrontMatrix& f, const PivotRule& rule, const tree::Walker* walker) {
  const FrontParts v(f);
  Square square;
  for (int k = 0; k < f.full;) {
    const int end = end_of_panel(k, f.full, outer_panel);
    // Relative to one, about which scaled diagonals were when the scales were computed, and to the pivot's value before
    // its front was eliminated.
    double least[deepest];
    if (k == 0)
      for (int i = 0; i < f.full; ++i) f.d[2 * i] = v.top(i)[i];
    for (int i = k; i < end; ++i) least[i - k] = rule.least * (holds(f.d[2 * i], 1.0) ? f.d[2 * i] : 1.0);
    square.depth = end - k;
    const int held = eliminate_square(v.top(k) + k, v.lda, least, f.d + 2 * k, square);
    if (k + held < end) return k + held;
    alignas(64) double x[tile_rows * deepest], reduction[tile_rows];
    for (int i = end; i < f.size; i += tile_rows) {
      const int m = std::min(tile_rows, f.size - i);
      double* rows = v.top(k) + i;
      if (m > 2 * width) {
        solve_rows<3>(m, square.depth, square, rows, v.lda, x, reduction);
      } else if (m > width) {
        solve_rows<2>(m, square.depth, square, rows, v.lda, x, reduction);
      } else {
        solve_rows<1>(m, square.depth, square, rows, v.lda, x, reduction);
      }
      for (int r = 0; r < m; ++r)
        if (!holds(1.0 / rule.threshold, reduction[r])) return k;
    }
    const auto update = [&](int first, int last) { catch_up_symmetric(v, f.d, k, end, first, last); };
    for_chunks_of_columns(end, f.full, f.size, 1.0 * (end - k) * (f.size - end), walker, update);
    k = end;
  }
  return f.full;
}

}  // namespace bough::solve
