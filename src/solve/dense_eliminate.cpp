#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "dense.hpp"
#include "dense_panel.hpp"
#include "dense_tiles.hpp"

namespace bough::solve {

namespace {

void swap_rows(const FrontParts& v, FrontMatrix& f, int i, int k) {
  if (i == k) return;
  for (int j = 0; j < f.size; ++j) std::swap(v.top(j)[i], v.top(j)[k]);
  std::swap(f.rows[i], f.rows[k]);
  std::swap(f.row_from[i], f.row_from[k]);
}

void swap_columns(const FrontParts& v, FrontMatrix& f, int i, int k) {
  if (i == k) return;
  std::swap_ranges(v.top(i), v.top(i) + f.size, v.top(k));
  std::swap(f.columns[i], f.columns[k]);
}

int find_row_of_largest(const double* column, int begin, int end) {
  int row = begin;
  for (int i = begin + 1; i < end; ++i)
    if (std::abs(column[i]) > std::abs(column[row])) row = i;
  return row;
}

/// Divides the column below the pivot and updates columns (k, end).
void eliminate_one(const FrontParts& v, int k, int end) {
  double* l = v.top(k);
  const double inverse = 1.0 / l[k];
  for (int i = k + 1; i < v.size; ++i) l[i] *= inverse;
  for (int j = k + 1; j < end; ++j) {
    double* c = v.top(j);
    const double u = c[k];
    if (u != 0.0) tiles::take_column(v.size - k - 1, l + k + 1, u, c + k + 1);
  }
}

/// U = L^-1 B in place, L unit lower (depth x depth), B: n columns; packed as well, in groups filled up with zeros.
void solve_and_pack(int depth, const double* l, std::ptrdiff_t ldl, int n, double* b, std::ptrdiff_t ldb,
                    double* packed) {
  using namespace tiles;
  constexpr int high = 8;
  for (int j0 = 0; j0 < n; j0 += width) {
    double* group = group_of(packed, depth, j0 / width);
    const int wide = std::min(width, n - j0);
    double* first = b + j0 * ldb;
    for (int i0 = 0; i0 < depth; i0 += high) {
      const int rows = std::min(high, depth - i0);
      alignas(64) double square[high * width] = {};
      for (int j = 0; j < wide; ++j)
        for (int r = 0; r < rows; ++r) square[r * width + j] = first[j * ldb + i0 + r];
      Lanes t[high];
#pragma GCC unroll 8
      for (int r = 0; r < high; ++r) t[r] = load(square + r * width);
      if (rows == high) {
        for (int p = 0; p < i0; ++p) {
          const Lanes y = load(group + p * width);
          const double* lp = l + p * ldl + i0;
#pragma GCC unroll 8
          for (int r = 0; r < high; ++r) t[r] = take_product(y, all(lp[r]), t[r]);
        }
      } else {
        for (int p = 0; p < i0; ++p)
          for (int r = 0; r < rows; ++r) t[r] = take_product(load(group + p * width), all(l[p * ldl + i0 + r]), t[r]);
      }
      for (int p = 0; p < rows; ++p)
        for (int r = p + 1; r < rows; ++r) t[r] = take_product(t[p], all(l[(i0 + p) * ldl + i0 + r]), t[r]);
      for (int r = 0; r < rows; ++r) {
        store(group + (i0 + r) * width, t[r]);
        store(square + r * width, t[r]);
      }
      for (int j = 0; j < wide; ++j)
        for (int r = 0; r < rows; ++r) first[j * ldb + i0 + r] = square[r * width + j];
    }
  }
}

/// Subtracts from rows [row, end) of columns [first, last), all on one side of `full`, the product of the pivots
/// [from, to) with these columns' packed rows.
void subtract_rows(const FrontParts& v, int from, int to, int first, int last, int row, int end, const double* packed) {
  const int n = last - first, depth = to - from, top_end = first < v.full ? end : std::min(end, v.full);
  const double* l = v.a + from * v.lda;
  if (row < top_end)
    tiles::subtract_packed(top_end - row, n, depth, l + row, v.lda, packed, v.top(first) + row,
                           first < v.full ? v.lda : v.ldu);
  row = std::max(row, top_end);
  if (row < end)
    tiles::subtract_packed(end - row, n, depth, l + row, v.lda, packed, v.bottom(first) + (row - v.full), v.lds);
}

/// U in rows [begin, k) of columns [first, last), at most a chunk and all on one side of `full`, and the update of rows
/// [k, end) by it.
void catch_up(const FrontParts& v, int begin, int k, int first, int last, int end) {
  using namespace tiles;
  alignas(64) double packed[deepest * chunk];
  const std::ptrdiff_t ld = first < v.full ? v.lda : v.ldu;
  for (int from = begin; from < k; from += deepest) {
    const int to = std::min(k, from + deepest);
    solve_and_pack(to - from, v.a + from * v.lda + from, v.lda, last - first, v.top(first) + from, ld, packed);
    subtract_rows(v, from, to, first, last, to, end, packed);
  }
}

/// The diagonal is preferred as a pivot; else it is the largest entry of its column among the fully summed rows.
struct General {
  const FrontParts& parts;
  FrontMatrix& front;
  static constexpr double flops = 2.0;

  int take_pivot(int k, int /*open*/, int end, double least) const {
    const double* column = parts.top(k);
    const int row = std::abs(column[k]) < least ? find_row_of_largest(column, k, front.full) : k;
    if (!(std::abs(column[row]) >= least)) return 0;
    swap_rows(parts, front, row, k);
    eliminate_one(parts, k, end);
    return 1;
  }
  void exchange(int k, int open) const {
    swap_columns(parts, front, k, open);
    swap_rows(parts, front, k, open);  // both, so that a diagonal stays one
  }
  void catch_up(int begin, int k, int first, int last) const {
    solve::catch_up(parts, begin, k, first, last, parts.size);
  }
  void prepare(int begin, int k, int first, int last) const { solve::catch_up(parts, begin, k, first, last, k); }
  void update(int begin, int k, int first, int last, int row, int end) const {
    alignas(64) double packed[tiles::deepest * tiles::chunk];
    for (int from = begin; from < k; from += tiles::deepest) {
      const int to = std::min(k, from + tiles::deepest);
      tiles::pack_columns(to - from, last - first, parts.top(first) + from, first < parts.full ? parts.lda : parts.ldu,
                          packed);
      subtract_rows(parts, from, to, first, last, row, end, packed);
    }
  }
};

}  // namespace

int eliminate_with_threshold(FrontMatrix& f, const PivotRule& rule, const tree::Walker* walker) {
  const FrontParts parts(f);
  return eliminate_in_panels(f, General{parts, f}, rule, walker);
}

int eliminate_completely(FrontMatrix& f, int k, int most, double least, double* row_weight, double* column_weight) {
  const FrontParts v(f);
  const int first = k;
  while (k < most) {
    double best = 0.0;
    int row = -1, column = -1;
    for (int j = k; j < f.full; ++j)
      for (int i = k; i < f.full; ++i) {
        double m = std::abs(v.top(j)[i]);
        if (row_weight != nullptr) m *= row_weight[i - first] * column_weight[j - first];
        if (m <= best || m < least) continue;
        best = m;
        row = i;
        column = j;
      }
    if (row < 0) break;
    swap_columns(v, f, k, column);
    swap_rows(v, f, row, k);
    if (row_weight != nullptr) {
      std::swap(row_weight[k - first], row_weight[row - first]);
      std::swap(column_weight[k - first], column_weight[column - first]);
    }
    eliminate_one(v, k, f.size);
    ++k;
  }
  return k;
}

int move_negligible_last(FrontMatrix& f, int pivots, const Negligible& negligible, const bool* is_candidate) {
  if (f.d != nullptr) return move_negligible_last_symmetric(f, pivots, negligible, is_candidate);
  const FrontParts v(f);
  const auto is_small = [&](auto&& entry) {
    double remaining = 0.0, boundary = 0.0;
    for (int i = pivots; i < f.full; ++i) remaining += entry(i) * entry(i);
    for (int i = f.full; i < f.size; ++i) boundary += entry(i) * entry(i);
    return std::sqrt(remaining) <= negligible.remaining && std::sqrt(boundary) <= negligible.boundary;
  };
  const auto is_small_column = [&](int j) {
    return is_candidate[f.columns[j]] &&
           is_small([&](int i) { return i < f.full ? v.top(j)[i] : v.bottom(j)[i - f.full]; });
  };
  const auto is_small_row = [&](int i) {
    return is_candidate[f.rows[i]] && is_small([&](int j) { return v.top(j)[i]; });
  };
  int rows = 0, columns = 0;
  for (int k = pivots; k < f.full; ++k) {
    columns += is_small_column(k) ? 1 : 0;
    rows += is_small_row(k) ? 1 : 0;
  }
  const int first = f.full - std::min(rows, columns);
  for (int k = f.full, to = f.full; to > first;)
    if (is_small_column(--k)) swap_columns(v, f, k, --to);
  for (int k = f.full, to = f.full; to > first;)
    if (is_small_row(--k)) swap_rows(v, f, k, --to);
  return f.full - first;
}

}  // namespace bough::solve
