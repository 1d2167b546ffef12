/// Signs of pivots: the number of negative eigenvalues by Sylvester's law of inertia.
#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "bough/blocks/at.hpp"
#include "decompositions.hpp"
#include "hierarchical_state.hpp"

namespace bough::solve {

namespace {

/// Counts of the pivots so far.
struct PivotSigns {
  int negative = 0;
  bool moved_together = true;  ///< no row was exchanged without its column

  void add(double pivot) { negative += pivot < 0.0 ? 1 : 0; }
  /// [d0 d1; d1 d2]
  void add_pair(double d0, double d1, double d2) {
    const double determinant = (d0 / d1) * (d2 / d1) - 1.0;
    negative += determinant < 0.0 ? 1 : d0 < 0.0 ? 2 : 0;
  }
  void add_symmetric(const double* d, int pivots) {
    for (int k = 0; k < pivots; ++k) {
      if (d[2 * k + 1] == 0.0) {
        add(d[2 * k]);
      } else {
        add_pair(d[2 * k], d[2 * k + 1], d[2 * k + 2]);
        ++k;
      }
    }
  }
};

/// 1 or -1. `image` is undefined afterwards.
int sign_of_permutation(std::vector<int>& image) {
  int sign = 1;
  for (std::size_t i = 0; i < image.size(); ++i)
    while (image[i] != static_cast<int>(i)) {
      std::swap(image[i], image[at(image[i])]);
      sign = -sign;
    }
  return sign;
}

}  // namespace

void Hierarchical::State::keep_root(const FrontData& root) {
  const std::size_t n = at(root.full);
  root_copy.size = root.full;
  root_copy.negative = -1;
  root_copy.is_square = std::equal(root.rows, root.rows + root.full, root.columns);
  root_copy.entries.resize(n * n);
  for (std::size_t j = 0; j < n; ++j)
    std::copy_n(root.a + j * at(root.lda), n, root_copy.entries.begin() + static_cast<std::ptrdiff_t>(j * n));
}

/// The root was eliminated with pivots of any size, some off the diagonal; here it is eliminated again, symmetrically.
/// If no pivot is large enough, the eigenvalues of the remaining block are computed; the smallest, as many as there are
/// dependent rows, are zero.
int Hierarchical::State::count_negative_in_root() {
  RootCopy& r = root_copy;
  if (r.negative >= 0) return r.negative;  // the copy has been overwritten
  const int n = r.size;
  const std::size_t size = at(n);
  const bool has_both = !is_symmetric();
  for (std::size_t j = 0; has_both && j < size; ++j)
    for (std::size_t i = j + 1; i < size; ++i)
      r.entries[j * size + i] = 0.5 * (r.entries[j * size + i] + r.entries[i * size + j]);
  r.d.resize(2 * size);
  r.indices.resize(3 * size);
  FrontMatrix front = make_square(r.entries.data(), n, n);
  front.d = r.d.data();
  front.rows = r.indices.data();
  front.columns = front.rows + n;
  front.row_from = front.columns + n;
  const int pivots = eliminate_symmetric(front, {std::max(options.pivot_threshold, 0.1), suspect_pivot});
  PivotSigns signs;
  signs.add_symmetric(r.d.data(), pivots);
  if (pivots == n) return r.negative = signs.negative;
  const int left = n - pivots;
  const Eigen::Map<const Eigen::MatrixXd, 0, Eigen::OuterStride<>> block(r.entries.data() + at(pivots) * (size + 1),
                                                                         left, left, Eigen::OuterStride<>(n));
  const Eigen::VectorXd values = symmetric_eigenvalues(block);
  std::vector<double> by_size(values.data(), values.data() + left);
  std::sort(by_size.begin(), by_size.end(), [](double a, double b) { return std::abs(a) > std::abs(b); });
  for (int k = 0; k < left - fronts.back().num_delayed() - fronts.back().dependent; ++k) signs.add(by_size[at(k)]);
  return r.negative = signs.negative;
}

Inertia Hierarchical::inertia() {
  State& s = *state_;
  PivotSigns signs, of_root;
  std::vector<int>& rows = s.row_of_column;
  rows.clear();
  for (std::size_t i = 0; i < s.lanes.fronts.size(); ++i) {
    const LaneFront& f = s.lanes.fronts[i];
    const double* factor = s.factor_of(f);
    for (int l = 0; l < lanes_wide; ++l) {
      if (f.front[at(l)] == tree::none || (s.scalar_lanes[i] >> l & 1) != 0) continue;
      for (int k = 0; k < f.eliminated; ++k) signs.add(factor[k * (f.size() + 1) * lanes_wide + l]);
    }
  }
  for (tree::FrontId id = 0; id < s.tree.num_fronts(); ++id) {
    if (!s.is_scalar(id)) continue;
    const FrontData& d = s.data(id);
    PivotSigns& own = id + 1 == s.tree.num_fronts() ? of_root : signs;
    if (d.is_symmetric()) {
      own.add_symmetric(d.d, d.pivots);
      continue;
    }
    const int* dependent = d.columns + d.full - d.dependent;
    for (int k = d.full - d.dependent; k < d.full; ++k)
      own.moved_together &= std::find(dependent, dependent + d.dependent, d.rows[k]) != dependent + d.dependent;
    for (int k = 0; k < d.pivots; ++k) {
      own.add(d.a[k * (static_cast<std::ptrdiff_t>(d.lda) + 1)]);
      if (d.rows[k] == d.columns[k]) continue;
      own.moved_together = false;
      if (rows.empty())
        for (std::int64_t u = 0; u < s.tree.num_unknowns(); ++u) rows.push_back(static_cast<int>(u));
      rows[at(d.columns[k])] = d.rows[k];
    }
  }
  Inertia inertia;
  if (s.status.deficiency == 0) {
    inertia.determinant = (signs.negative + of_root.negative) % 2 == 0 ? 1 : -1;
    if (!rows.empty()) inertia.determinant *= sign_of_permutation(rows);
  }
  if (signs.moved_together && s.root_copy.is_square) inertia.negative = signs.negative + s.count_negative_in_root();
  return inertia;
}

}  // namespace bough::solve
