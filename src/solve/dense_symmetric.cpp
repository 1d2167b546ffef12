#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include "dense.hpp"
#include "dense_panel.hpp"
#include "dense_tiles.hpp"

namespace bough::solve {

namespace {

/// Exchanges unknowns p < q; both columns and those between them are up to date.
void swap_unknowns(const FrontParts& v, FrontMatrix& f, int p, int q) {
  if (p == q) return;
  for (int c = 0; c < p; ++c) std::swap(v.top(c)[p], v.top(c)[q]);
  std::swap(v.top(p)[p], v.top(q)[q]);
  for (int t = p + 1; t < q; ++t) std::swap(v.top(p)[t], v.top(t)[q]);
  std::swap_ranges(v.top(p) + q + 1, v.top(p) + v.size, v.top(q) + q + 1);
  std::swap(f.rows[p], f.rows[q]);
  std::swap(f.columns[p], f.columns[q]);
  std::swap(f.row_from[p], f.row_from[q]);
}

/// A pivot of two rows: [d0 d1; d1 d2]. Entries are divided by d1, the largest, so that nothing overflows.
struct Pair {
  double ratio, other, scale;
  Pair(double d0, double d1, double d2) : ratio(d0 / d1), other(d2 / d1), scale(1.0 / (d1 * (ratio * other - 1.0))) {}
  double first(double x, double y) const { return (other * x - y) * scale; }  ///< of D^-1 (x, y)
  double second(double x, double y) const { return (ratio * y - x) * scale; }
};

/// Partner of unknown k in a pivot of two rows among [k + 1, open), or -1.
int find_partner(const FrontParts& v, const PivotRule& rule, int k, int open) {
  const double* column = v.top(k);
  int r = k + 1;
  for (int i = k + 2; i < open; ++i)
    if (std::abs(column[i]) > std::abs(column[r])) r = i;
  if (r >= open || !(std::abs(column[r]) > std::numeric_limits<double>::min())) return -1;
  const double d0 = std::abs(column[k]), d1 = std::abs(column[r]), d2 = std::abs(v.top(r)[r]);
  const double determinant = std::abs(column[k] * v.top(r)[r] - column[r] * column[r]);
  if (!(determinant >= rule.least * (d1 + std::max(d0, d2)))) return -1;
  const double of_k = std::max(find_largest(column, k + 1, r), find_largest(column, r + 1, v.size));
  double of_r = find_largest(v.top(r), r + 1, v.size);
  for (int t = k + 1; t < r; ++t) of_r = std::max(of_r, std::abs(v.top(t)[r]));
  const bool holds = rule.threshold * (d2 * of_k + d1 * of_r) <= determinant &&
                     rule.threshold * (d1 * of_k + d0 * of_r) <= determinant;
  return holds && std::isfinite(of_r) ? r : -1;
}

void eliminate_one(const FrontParts& v, double* d, int k, int end) {
  double* l = v.top(k);
  d[2 * k] = l[k];
  d[2 * k + 1] = 0.0;
  const double inverse = 1.0 / l[k];
  for (int i = k + 1; i < v.size; ++i) l[i] *= inverse;
  for (int j = k + 1; j < end; ++j) {
    const double u = d[2 * k] * l[j];
    if (u != 0.0) tiles::take_column(v.size - j, l + j, u, v.top(j) + j);
  }
}

void eliminate_two(const FrontParts& v, double* d, int k, int end) {
  double *l = v.top(k), *m = v.top(k + 1);
  const double d0 = l[k], d1 = l[k + 1], d2 = m[k + 1];
  d[2 * k] = d0;
  d[2 * k + 1] = d1;
  d[2 * k + 2] = d2;
  d[2 * k + 3] = 0.0;
  l[k + 1] = 0.0;  // L is the identity in the pivot's own rows
  const Pair pair(d0, d1, d2);
  for (int i = k + 2; i < v.size; ++i) {
    const double x = l[i], y = m[i];
    l[i] = pair.first(x, y);
    m[i] = pair.second(x, y);
  }
  for (int j = k + 2; j < end; ++j) {
    tiles::take_column(v.size - j, l + j, d0 * l[j] + d1 * m[j], v.top(j) + j);
    tiles::take_column(v.size - j, m + j, d1 * l[j] + d2 * m[j], v.top(j) + j);
  }
}

/// (L D)^T of rows [first, first + n), pivots [from, to), packed; groups filled up with zeros.
void pack_scaled(const FrontParts& v, const double* d, int from, int to, int first, int n, double* packed) {
  using namespace tiles;
  const int depth = to - from;
  for (int j0 = 0; j0 < n; j0 += width) {
    double* group = group_of(packed, depth, j0 / width);
    const int wide = std::min(width, n - j0);
    for (int p = from; p < to; ++p) {
      const double* l = v.top(p) + first + j0;
      double* w = group + (p - from) * width;
      if (d[2 * p + 1] == 0.0) {
        for (int j = 0; j < wide; ++j) w[j] = d[2 * p] * l[j];
      } else {
        const double* m = l + v.lda;
        for (int j = 0; j < wide; ++j) {
          w[j] = d[2 * p] * l[j] + d[2 * p + 1] * m[j];
          w[width + j] = d[2 * p + 1] * l[j] + d[2 * p + 2] * m[j];
        }
        for (int j = wide; j < width; ++j) w[j] = 0.0;
        ++p;
        w += width;
      }
      for (int j = wide; j < width; ++j) w[j] = 0.0;
    }
  }
}

}  // namespace

namespace {

/// Updates rows [row, end) of columns [first, last), at most a chunk and all on one side of `full`, by the pivots
/// [begin, k), whose D is d. Entries above the diagonal may be overwritten.
void catch_up(const FrontParts& v, const double* d, int begin, int k, int first, int last, int row, int end) {
  using namespace tiles;
  row = std::max(row, first);
  if (row >= end) return;
  alignas(64) double packed[deepest * chunk];
  const int n = last - first;
  for (int from = begin, to = begin; from < k; from = to) {
    to = std::min(k, from + deepest);
    if (to < k && d[2 * to - 1] != 0.0) --to;  // between two rows of a pivot
    pack_scaled(v, d, from, to, first, n, packed);
    double* c = first < v.full ? v.top(first) + row : v.bottom(first) + (row - v.full);
    subtract_packed(end - row, n, to - from, v.top(from) + row, v.lda, packed, c, first < v.full ? v.lda : v.lds,
                    row == first);
  }
}

/// The diagonal is preferred as a pivot; else it has two rows, of the candidate and of a partner.
struct Symmetric {
  const FrontParts& parts;
  FrontMatrix& front;
  const PivotRule& rule;
  static constexpr double flops = 1.0;

  int take_pivot(int k, int open, int end, double least) const {
    if (std::abs(parts.top(k)[k]) >= least) {
      eliminate_one(parts, front.d, k, end);
      return 1;
    }
    const int partner = find_partner(parts, rule, k, open);
    if (partner < 0) return 0;
    swap_unknowns(parts, front, k + 1, partner);
    eliminate_two(parts, front.d, k, end);
    return 2;
  }
  void exchange(int k, int open) const { swap_unknowns(parts, front, k, open); }
  void catch_up(int begin, int k, int first, int last) const {
    solve::catch_up(parts, front.d, begin, k, first, last, first, parts.size);
  }
  void prepare(int, int, int, int) const {}
  void update(int begin, int k, int first, int last, int row, int end) const {
    solve::catch_up(parts, front.d, begin, k, first, last, row, end);
  }
};

}  // namespace

int eliminate_symmetric(FrontMatrix& f, const PivotRule& rule, const tree::Walker* walker) {
  const FrontParts parts(f);
  return eliminate_in_panels(f, Symmetric{parts, f, rule}, rule, walker);
}

int move_negligible_last_symmetric(FrontMatrix& f, int pivots, const Negligible& negligible, const bool* is_candidate) {
  const FrontParts v(f);
  int to = f.full;
  for (int k = f.full; k-- > pivots;) {
    if (!is_candidate[f.rows[k]]) continue;
    double remaining = 0.0, boundary = 0.0;
    for (int j = pivots; j < k; ++j) remaining += v.top(j)[k] * v.top(j)[k];
    for (int i = k; i < f.full; ++i) remaining += v.top(k)[i] * v.top(k)[i];
    for (int i = f.full; i < f.size; ++i) boundary += v.top(k)[i] * v.top(k)[i];
    if (std::sqrt(remaining) <= negligible.remaining && std::sqrt(boundary) <= negligible.boundary)
      swap_unknowns(v, f, k, --to);
  }
  return f.full - to;
}

}  // namespace bough::solve
