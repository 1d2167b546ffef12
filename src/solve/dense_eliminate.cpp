#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>

#include "dense.hpp"

namespace bough::solve {

namespace {

struct View {
  double* a;
  std::ptrdiff_t ld;
  double* column(int j) const { return a + j * ld; }
  double& operator()(int i, int j) const { return a[i + j * ld]; }
};

void swap_rows(const View& v, FrontMatrix& f, int i, int k) {
  if (i == k) return;
  for (int j = 0; j < f.size; ++j) std::swap(v(i, j), v(k, j));
  std::swap(f.rows[i], f.rows[k]);
  std::swap(f.row_from[i], f.row_from[k]);
}

void swap_columns(const View& v, FrontMatrix& f, int i, int k) {
  if (i == k) return;
  std::swap_ranges(v.column(i), v.column(i) + f.size, v.column(k));
  std::swap(f.columns[i], f.columns[k]);
}

/// Largest magnitude of rows [begin, end), compared as bits: infinity and NaN come out on top, above every finite number.
double find_largest(const double* column, int begin, int end) {
  constexpr std::uint64_t magnitude = ~std::uint64_t{0} >> 1;
  std::uint64_t largest = 0;
  for (int i = begin; i < end; ++i) largest = std::max(largest, std::bit_cast<std::uint64_t>(column[i]) & magnitude);
  return std::bit_cast<double>(largest);
}

int find_row_of_largest(const double* column, int begin, int end) {
  int row = begin;
  for (int i = begin + 1; i < end; ++i)
    if (std::abs(column[i]) > std::abs(column[row])) row = i;
  return row;
}

/// Divides the column below the pivot and updates columns (k, end).
void eliminate_one(const View& v, int k, int end, int size) {
  double* l = v.column(k);
  const double inverse = 1.0 / l[k];
  for (int i = k + 1; i < size; ++i) l[i] *= inverse;
  for (int j = k + 1; j < end; ++j) {
    double* c = v.column(j);
    const double u = c[k];
    if (u == 0.0) continue;
    for (int i = k + 1; i < size; ++i) c[i] -= l[i] * u;
  }
}

/// Pivots within columns [k, end), which alone are updated. Returns the new k; -1 when not finite.
int eliminate_panel(const View& v, FrontMatrix& f, const PivotRule& rule, int k, int end) {
  int open = end;  // columns [open, end) were refused in this round
  bool progress = false;
  for (;;) {
    if (k == open) {
      if (open == end || !progress) return k;
      open = end;  // the refused columns have changed: another round
      progress = false;
    }
    const double largest = find_largest(v.column(k), k, f.size);
    if (!std::isfinite(largest)) return -1;
    const double least = std::max({rule.threshold * largest, rule.least, std::numeric_limits<double>::min()});
    int row = k;
    if (std::abs(v(k, k)) < least) row = find_row_of_largest(v.column(k), k, f.full);
    if (std::abs(v(row, k)) >= least) {
      swap_rows(v, f, row, k);
      eliminate_one(v, k, end, f.size);
      ++k;
      progress = true;
    } else {
      --open;
      swap_columns(v, f, k, open);
      swap_rows(v, f, k, open);  // both, so that a diagonal stays one
    }
  }
}

/// Columns [end, size) catch up with pivots [begin, k).
void update_trailing(const View& v, int begin, int k, int end, int size) {
  const int width = k - begin;
  if (width == 0) return;
  for (int j = end; j < size; ++j) {
    double* c = v.column(j);
    for (int p = begin; p < k; ++p) {
      const double u = c[p];
      if (u == 0.0) continue;
      const double* l = v.column(p);
      for (int i = p + 1; i < k; ++i) c[i] -= l[i] * u;
    }
  }
  subtract_product(size - k, size - end, width, &v(k, begin), static_cast<int>(v.ld), &v(begin, end),
                   static_cast<int>(v.ld), &v(k, end), static_cast<int>(v.ld));
}

}  // namespace

int eliminate_with_threshold(FrontMatrix& f, const PivotRule& rule) {
  constexpr int panel = 32;
  const View v{f.a, f.size};
  int k = 0, tried = 0;  // columns [k, tried) were refused by earlier panels and go along with the next one
  while (tried < f.full) {
    const int left = f.full - tried;
    const int begin = k, end = tried + (left <= panel + panel / 2 ? left : panel);
    k = eliminate_panel(v, f, rule, k, end);
    if (k < 0) return -1;
    update_trailing(v, begin, k, end, f.size);
    tried = end;
  }
  return k;
}

int eliminate_completely(FrontMatrix& f, int k, int most, double least, double* row_weight, double* column_weight) {
  const View v{f.a, f.size};
  const int first = k;
  while (k < most) {
    double best = 0.0;
    int row = -1, column = -1;
    for (int j = k; j < f.full; ++j)
      for (int i = k; i < f.full; ++i) {
        double m = std::abs(v(i, j));
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
    eliminate_one(v, k, f.size, f.size);
    ++k;
  }
  return k;
}

void substitute_forward(const double* a, int size, int pivots, double* f) {
  const std::ptrdiff_t ld = size;
  for (int k = 0; k < pivots; ++k) {
    const double* l = a + k * ld;
    const double y = f[k];
    for (int i = k + 1; i < size; ++i) f[i] -= l[i] * y;
  }
}

void substitute_backward(const double* a, int size, int pivots, double* x) {
  const std::ptrdiff_t ld = size;
  for (int k = size - 1; k >= 0; --k) {
    const double* u = a + k * ld;
    if (k < pivots) x[k] /= u[k];
    const double value = x[k];
    const int above = std::min(k, pivots);
    for (int i = 0; i < above; ++i) x[i] -= u[i] * value;
  }
}

void substitute_backward_left(const double* a, int size, int pivots, double* z) {
  const std::ptrdiff_t ld = size;
  for (int k = pivots - 1; k >= 0; --k) {
    const double* l = a + k * ld;
    double sum = 0.0;
    for (int i = k + 1; i < size; ++i) sum += l[i] * z[i];
    z[k] = -sum;
  }
}

}  // namespace bough::solve
