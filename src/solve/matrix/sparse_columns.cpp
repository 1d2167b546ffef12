#include "bough/solve/sparse_columns.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "bough/blocks/at.hpp"
#ifdef BOUGH_HAS_KLU  // BTF comes with it
#include <btf.h>
#endif

namespace bough::solve {

double pattern_symmetry(const SparseColumns& a) {
  const auto has = [&](int row, int column) {
    return std::binary_search(a.row.begin() + a.column_begin[at(column)],
                              a.row.begin() + a.column_begin[at(column) + 1], row);
  };
  int beside = 0, mirrored = 0;
  for (int j = 0; j < a.n; ++j)
    for (int k = a.column_begin[at(j)]; k < a.column_begin[at(j) + 1]; ++k) {
      if (a.row[at(k)] == j) continue;
      ++beside;
      mirrored += has(j, a.row[at(k)]) ? 1 : 0;
    }
  return beside == 0 ? 1.0 : static_cast<double>(mirrored) / beside;
}

#ifdef BOUGH_HAS_KLU

std::vector<int> rows_of_full_diagonal(const SparseColumns& a) {
  std::vector<int> column_of_row(at(a.n)), work(5 * at(a.n));
  constexpr double unlimited = -1.0;
  double done = 0.0;
  SparseColumns copy = a;  // BTF takes pointers to non-const
  if (btf_maxtrans(a.n, a.n, copy.column_begin.data(), copy.row.data(), unlimited, &done, column_of_row.data(),
                   work.data()) < a.n)
    return {};
  return column_of_row;
}

#else

std::vector<int> rows_of_full_diagonal(const SparseColumns&) { return {}; }

#endif

double backward_error(const SparseColumns& a, const double* x, const double* b, std::vector<double>& residual) {
  const std::size_t n = at(a.n);
  residual.assign(2 * n, 0.0);  // and the sums of the rows
  std::copy(b, b + n, residual.begin());
  double* const row_sum = residual.data() + n;
  double x_norm = 0.0, b_norm = 0.0, a_norm = 0.0, r_norm = 0.0;
  bool is_finite = true;
  for (std::size_t j = 0; j < n; ++j) {
    is_finite = is_finite && std::isfinite(x[j]);
    x_norm = std::max(x_norm, std::abs(x[j]));
    for (int k = a.column_begin[j]; k < a.column_begin[j + 1]; ++k) {
      residual[at(a.row[at(k)])] -= a.value[at(k)] * x[j];
      row_sum[at(a.row[at(k)])] += std::abs(a.value[at(k)]);
    }
  }
  for (std::size_t i = 0; i < n; ++i) {
    b_norm = std::max(b_norm, std::abs(b[i]));
    a_norm = std::max(a_norm, row_sum[i]);
    r_norm = std::max(r_norm, std::abs(residual[i]));
  }
  if (!is_finite) return std::numeric_limits<double>::quiet_NaN();
  const double whole = a_norm * x_norm + b_norm;
  return whole > 0.0 ? r_norm / whole : 0.0;
}

}  // namespace bough::solve
