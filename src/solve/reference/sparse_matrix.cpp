#include "sparse_matrix.hpp"

#include <algorithm>
#include <cmath>

#include "bough/blocks/at.hpp"

namespace bough::solve {

namespace {

/// Calls visit(row, column, entry of the element matrix) for all entries of all elements that are in the pattern, in the
/// order of SparseAssembly::slots_.
template <class Visit>
void for_entries(const ElementStore& elements, MultiplierEntries between, Visit&& visit) {
  const auto& first = elements.tree().unknown_begin;
  std::vector<int> place, sparse;  // unknowns; the block that they are in if it has its diagonal alone, or -1
  for (int e = 0; e < elements.graph().num_elements(); ++e) {
    place.clear();
    sparse.clear();
    for (int p = 0; p < elements.num_blocks_of(e); ++p) {
      const auto b = at(elements.blocks_of(e)[p]);
      for (std::int64_t u = first[b]; u < first[b + 1]; ++u) place.push_back(static_cast<int>(u));
      const bool is_sparse =
          between == MultiplierEntries::diagonal && elements.graph().block_kind[b] == blocks::BlockKind::multiplier;
      sparse.resize(place.size(), is_sparse ? static_cast<int>(b) : -1);
    }
    const ConstElementView a = elements.view(e);
    std::int64_t k = 0;
    for (std::size_t i = 0; i < place.size(); ++i)
      for (std::size_t j = 0; j < place.size(); ++j, ++k)
        if (i == j || sparse[i] < 0 || sparse[i] != sparse[j]) visit(place[i], place[j], a[k]);
  }
}
}  // namespace

SparseAssembly::SparseAssembly(const ElementStore& elements, MultiplierEntries between) : between_(between) {
  const auto& graph = elements.graph();
  const auto n = static_cast<int>(elements.tree().num_unknowns());
  std::vector<Eigen::Triplet<double, int>> entries;
  for (int i = 0; i < n; ++i) entries.emplace_back(i, i, 0.0);
  for_entries(elements, between_, [&](int i, int j, double) { entries.emplace_back(i, j, 0.0); });
  matrix_.resize(n, n);
  matrix_.setFromTriplets(entries.begin(), entries.end());
  matrix_.makeCompressed();
  const int* begin = matrix_.outerIndexPtr();
  const int* rows = matrix_.innerIndexPtr();
  const auto slot = [&](int i, int j) {
    return static_cast<int>(std::lower_bound(rows + begin[j], rows + begin[j + 1], i) - rows);
  };
  for_entries(elements, between_, [&](int i, int j, double) { slots_.push_back(slot(i, j)); });
  for (int i = 0; i < n; ++i) diagonal_.push_back(slot(i, i));
  is_multiplier_.assign(at(n), 0);
  for (int b = 0; b < graph.num_blocks(); ++b)
    if (graph.block_kind[at(b)] == blocks::BlockKind::multiplier)
      for (std::int64_t u = elements.tree().unknown_begin[at(b)]; u < elements.tree().unknown_begin[at(b) + 1]; ++u)
        is_multiplier_[at(u)] = 1;
}

void SparseAssembly::assemble(const ElementStore& elements, const Scales& scales, double lowered) {
  double* values = matrix_.valuePtr();
  std::fill(values, values + matrix_.nonZeros(), 0.0);
  auto slot = slots_.begin();
  for_entries(elements, between_,
              [&](int i, int j, double a) { values[*slot++] += scales.row[at(i)] * a * scales.column[at(j)]; });
  if (lowered == 0.0) return;
  for (std::size_t i = 0; i < diagonal_.size(); ++i)
    if (is_multiplier_[i] != 0) values[diagonal_[i]] -= lowered * scales.weight[i] * scales.weight[i];
}

double SparseAssembly::asymmetry() const {
  const SparseMatrix transposed = matrix_.transpose();  // the pattern is symmetric: entries are at the same positions
  double most = 0.0;
  for (Eigen::Index k = 0; k < matrix_.nonZeros(); ++k)
    most = std::max(most, std::abs(matrix_.valuePtr()[k] - transposed.valuePtr()[k]));
  return most;
}

}  // namespace bough::solve
