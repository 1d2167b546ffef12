#include "sparse_matrix.hpp"

#include <algorithm>
#include <cmath>

#include "bough/blocks/at.hpp"

namespace bough::solve {

/// Calls visit(row, column, entry of the element matrix) for all entries of all elements, in the order of slots_.
template <class Visit>
void SparseAssembly::for_entries(const ElementStore& elements, Visit&& visit) const {
  const int* place = unknowns_.data();
  for (int e = 0; e < elements.graph().num_elements(); ++e) {
    const ConstElementView a = elements.view(e);
    const int n = elements.size_of(e);
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j) visit(place[i], place[j], a[i * n + j]);
    place += n;
  }
}

SparseAssembly::SparseAssembly(const ElementStore& elements) {
  const auto& graph = elements.graph();
  const auto& first = elements.tree().unknown_begin;
  const auto n = static_cast<int>(elements.tree().num_unknowns());
  multiplier_block_.assign(at(n), -1);
  for (int b = 0; b < graph.num_blocks(); ++b)
    if (graph.block_kind[at(b)] == blocks::BlockKind::multiplier)
      for (std::int64_t u = first[at(b)]; u < first[at(b) + 1]; ++u) multiplier_block_[at(u)] = b;
  for (int e = 0; e < graph.num_elements(); ++e)
    for (int p = 0; p < elements.num_blocks_of(e); ++p) {
      const auto b = at(elements.blocks_of(e)[p]);
      for (std::int64_t u = first[b]; u < first[b + 1]; ++u) unknowns_.push_back(static_cast<int>(u));
    }
  const auto is_left_out = [&](int i, int j) {
    return i != j && multiplier_block_[at(i)] >= 0 && multiplier_block_[at(i)] == multiplier_block_[at(j)];
  };
  std::vector<Eigen::Triplet<double, int>> entries;
  for (int i = 0; i < n; ++i) entries.emplace_back(i, i, 0.0);
  for_entries(elements, [&](int i, int j, double) {
    if (!is_left_out(i, j)) entries.emplace_back(i, j, 0.0);
  });
  matrix_.resize(n, n);
  matrix_.setFromTriplets(entries.begin(), entries.end());
  matrix_.makeCompressed();
  const int* begin = matrix_.outerIndexPtr();
  const int* rows = matrix_.innerIndexPtr();
  const auto slot = [&](int i, int j) {
    return static_cast<int>(std::lower_bound(rows + begin[j], rows + begin[j + 1], i) - rows);
  };
  for_entries(elements, [&](int i, int j, double) { slots_.push_back(is_left_out(i, j) ? -1 : slot(i, j)); });
  for (int i = 0; i < n; ++i) diagonal_.push_back(slot(i, i));
}

void SparseAssembly::assemble(const ElementStore& elements, const Scales& scales, double lowered) {
  double* values = matrix_.valuePtr();
  std::fill(values, values + matrix_.nonZeros(), 0.0);
  const int* slot = slots_.data();
  for_entries(elements, [&](int i, int j, double a) {
    const int to = *slot++;
    if (to >= 0) values[to] += scales.row[at(i)] * a * scales.column[at(j)];
  });
  if (lowered == 0.0) return;
  for (std::size_t i = 0; i < diagonal_.size(); ++i)
    if (multiplier_block_[i] >= 0) values[diagonal_[i]] -= lowered * scales.weight[i] * scales.weight[i];
}

double SparseAssembly::asymmetry() const {
  const SparseMatrix transposed = matrix_.transpose();  // the pattern is symmetric: entries are at the same positions
  double most = 0.0;
  for (Eigen::Index k = 0; k < matrix_.nonZeros(); ++k)
    most = std::max(most, std::abs(matrix_.valuePtr()[k] - transposed.valuePtr()[k]));
  return most;
}

}  // namespace bough::solve
