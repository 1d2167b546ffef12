#include "transversal.hpp"

#include <algorithm>
#include <tuple>
#include <utility>

#include "bough/blocks/at.hpp"
#ifdef BOUGH_HAS_KLU  // BTF comes with it
#include <btf.h>
#endif

namespace bough::bench {

double find_symmetry(const SparseMatrix& a) {
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

bool permute_rows(SparseMatrix& a) {
  std::vector<int> column_of_row(at(a.n)), work(5 * at(a.n));
  constexpr double unlimited = -1.0;
  double done = 0.0;
  if (btf_maxtrans(a.n, a.n, a.column_begin.data(), a.row.data(), unlimited, &done, column_of_row.data(), work.data()) <
      a.n)
    return false;
  std::vector<std::pair<int, double>> column;
  for (int j = 0; j < a.n; ++j) {
    const auto begin = at(a.column_begin[at(j)]), end = at(a.column_begin[at(j) + 1]);
    column.clear();
    for (std::size_t k = begin; k < end; ++k) column.emplace_back(column_of_row[at(a.row[k])], a.value[k]);
    std::sort(column.begin(), column.end());
    for (std::size_t k = begin; k < end; ++k) std::tie(a.row[k], a.value[k]) = column[k - begin];
  }
  return true;
}

#else

bool permute_rows(SparseMatrix&) { return false; }

#endif

}  // namespace bough::bench
