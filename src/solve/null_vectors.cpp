#include "null_vectors.hpp"

#include <algorithm>
#include <cmath>

#include "bough/blocks/at.hpp"

namespace bough::solve {

namespace {

/// A = L L^T in place, lower triangle of n x n by rows. Returns the smallest ratio of a pivot to `whole`, the diagonal
/// entry before all elimination.
double factor_block(double* a, int n, const double* whole) {
  double least = 1.0;
  for (int j = 0; j < n; ++j) {
    double pivot = a[j * n + j];
    for (int k = 0; k < j; ++k) pivot -= a[j * n + k] * a[j * n + k];
    if (!(pivot > 0.0)) return 0.0;
    least = std::min(least, pivot / whole[j]);
    a[j * n + j] = std::sqrt(pivot);
    for (int i = j + 1; i < n; ++i) {
      double sum = a[i * n + j];
      for (int k = 0; k < j; ++k) sum -= a[i * n + k] * a[j * n + k];
      a[i * n + j] = sum / a[j * n + j];
    }
  }
  return least;
}

/// B <- B L^-T, m x n by rows.
void divide_by_block(const double* l, int n, double* b, int m) {
  for (int i = 0; i < m; ++i)
    for (int j = 0; j < n; ++j) {
      double sum = b[i * n + j];
      for (int k = 0; k < j; ++k) sum -= b[i * n + k] * l[j * n + k];
      b[i * n + j] = sum / l[j * n + j];
    }
}

}  // namespace

void NullVectors::clear() {
  groups_.clear();
  unknowns_.clear();
  values_.clear();
  blocks_.clear();
  gram_.clear();
  num_vectors_ = 0;
  num_sweeps_ = 1;
}

void NullVectors::add(tree::FrontId front, int count, SparseRows& rows, const double* weight,
                      std::span<const int> earlier) {
  const int own = static_cast<int>(groups_.size());
  Group g{.front = front, .count = count, .first_vector = num_vectors_};
  g.begin = static_cast<std::int64_t>(unknowns_.size());
  g.values = static_cast<std::int64_t>(values_.size());
  const std::span<const double> z = rows.values();
  for (std::size_t k = 0; k < rows.unknowns().size(); ++k) {
    unknowns_.push_back(rows.unknowns()[k]);
    for (int v = 0; v < count; ++v) values_.push_back(z[k * most + at(v)]);
  }
  g.end = static_cast<std::int64_t>(unknowns_.size());
  num_vectors_ += count;
  groups_.push_back(g);
  const auto add_block = [&](int other) {
    const Group& e = groups_[at(other)];
    const auto begin = static_cast<std::int64_t>(gram_.size());
    blocks_.push_back({own, other, begin});
    gram_.resize(gram_.size() + at(count) * at(e.count), 0.0);
    double* m = gram_.data() + begin;
    const double* z_e = values_.data() + e.values;
    for (std::int64_t k = e.begin; k < e.end; ++k, z_e += e.count) {
      const int u = unknowns_[at(k)];
      const double* z_g = rows.find(u);
      if (z_g == nullptr) continue;
      const double w = weight == nullptr ? 1.0 : weight[u] * weight[u];
      for (int i = 0; i < count; ++i)
        for (int j = 0; j < e.count; ++j) m[i * e.count + j] += z_g[i] * w * z_e[j];
    }
  };
  for (const int e : earlier) add_block(e);
  add_block(own);
}

/// The columns of the factor: block (h, g) is filled if Z_h and Z_g overlap, or if both overlap with the same earlier
/// group. As in any sparse Cholesky factor, column g then has the rows of the columns whose first row is g.
void NullVectors::lay_out() {
  const auto n = static_cast<int>(groups_.size());
  own_begin_.assign(at(n) + 1, 0);
  for (const Block& b : blocks_)
    if (b.later != b.earlier) ++own_begin_[at(b.earlier) + 1];
  for (std::size_t g = 0; g < at(n); ++g) own_begin_[g + 1] += own_begin_[g];
  own_.resize(at(own_begin_.back()));
  mark_.assign(at(n), 0);
  for (const Block& b : blocks_)
    if (b.later != b.earlier) own_[at(own_begin_[at(b.earlier)] + mark_[at(b.earlier)]++)] = b.later;
  mark_.assign(at(n), -1);
  parent_.assign(at(n), -1);
  first_child_.assign(at(n), -1);
  next_child_.assign(at(n), -1);
  column_.clear();
  column_begin_.assign(1, 0);
  column_values_.clear();
  std::int64_t size = 0;
  for (int g = 0; g < n; ++g) {
    mark_[at(g)] = g;
    const auto take = [&](int h) {
      if (mark_[at(h)] == g) return;
      mark_[at(h)] = g;
      column_.push_back(h);
    };
    for (auto k = own_begin_[at(g)]; k < own_begin_[at(g) + 1]; ++k) take(own_[at(k)]);
    for (int c = first_child_[at(g)]; c >= 0; c = next_child_[at(c)])
      for (auto k = column_begin_[at(c)]; k < column_begin_[at(c) + 1]; ++k) take(column_[at(k)]);
    const auto begin = column_.begin() + column_begin_.back();
    std::sort(begin, column_.end());
    column_values_.push_back(size);
    size += static_cast<std::int64_t>(groups_[at(g)].count) * groups_[at(g)].count;
    for (auto h = begin; h != column_.end(); ++h)
      size += static_cast<std::int64_t>(groups_[at(*h)].count) * groups_[at(g)].count;
    if (begin != column_.end()) {
      parent_[at(g)] = *begin;
      next_child_[at(g)] = first_child_[at(*begin)];
      first_child_[at(*begin)] = g;
    }
    column_begin_.push_back(static_cast<std::int64_t>(column_.size()));
  }
  factor_.assign(at(size), 0.0);
}

/// A block of the factor that is known to be filled.
double* NullVectors::block_of(int later, int earlier) {
  const Group& g = groups_[at(earlier)];
  double* block = factor_.data() + column_values_[at(earlier)];
  if (later == earlier) return block;
  block += g.count * g.count;
  for (auto k = column_begin_[at(earlier)]; column_[at(k)] != later; ++k)
    block += groups_[at(column_[at(k)])].count * g.count;
  return block;
}

bool NullVectors::factor() {
  lay_out();
  for (const Block& b : blocks_)
    std::copy_n(gram_.data() + b.begin, groups_[at(b.later)].count * groups_[at(b.earlier)].count,
                block_of(b.later, b.earlier));
  coefficients_.resize(at(num_vectors_));
  for (int g = 0; g < static_cast<int>(groups_.size()); ++g)
    for (int v = 0; v < groups_[at(g)].count; ++v)
      coefficients_[at(groups_[at(g)].first_vector + v)] = block_of(g, g)[v * (groups_[at(g)].count + 1)];
  double least = 1.0;
  for (int g = 0; g < static_cast<int>(groups_.size()); ++g) {
    const int n = groups_[at(g)].count;
    double* const diagonal = block_of(g, g);
    least = std::min(least, factor_block(diagonal, n, coefficients_.data() + groups_[at(g)].first_vector));
    double* below = diagonal + n * n;
    for (auto k = column_begin_[at(g)]; k < column_begin_[at(g) + 1]; ++k) {
      const int h = column_[at(k)], m = groups_[at(h)].count;
      divide_by_block(diagonal, n, below, m);
      const double* other = diagonal + n * n;
      for (auto q = column_begin_[at(g)]; q <= k; ++q) {
        const int p = groups_[at(column_[at(q)])].count;
        double* target = block_of(h, column_[at(q)]);
        for (int i = 0; i < m; ++i)
          for (int j = 0; j < p; ++j)
            for (int t = 0; t < n; ++t) target[i * p + j] -= below[i * n + t] * other[j * n + t];
        other += p * n;
      }
      below += m * n;
    }
  }
  constexpr double well = 1e-4, badly = 1e-9, not_at_all = 1e-13;
  num_sweeps_ = least > well ? 1 : least > badly ? 2 : 3;
  return least > not_at_all;
}

void NullVectors::solve() {
  const auto num_groups = static_cast<int>(groups_.size());
  for (int g = 0; g < num_groups; ++g) {
    const int n = groups_[at(g)].count;
    double* c = coefficients_.data() + groups_[at(g)].first_vector;
    const double* l = factor_.data() + column_values_[at(g)];
    for (int i = 0; i < n; ++i) {
      for (int k = 0; k < i; ++k) c[i] -= l[i * n + k] * c[k];
      c[i] /= l[i * n + i];
    }
    const double* below = l + n * n;
    for (auto k = column_begin_[at(g)]; k < column_begin_[at(g) + 1]; ++k) {
      const Group& h = groups_[at(column_[at(k)])];
      double* to = coefficients_.data() + h.first_vector;
      for (int i = 0; i < h.count; ++i)
        for (int j = 0; j < n; ++j) to[i] -= below[i * n + j] * c[j];
      below += h.count * n;
    }
  }
  for (int g = num_groups; g-- > 0;) {
    const int n = groups_[at(g)].count;
    double* c = coefficients_.data() + groups_[at(g)].first_vector;
    const double* l = factor_.data() + column_values_[at(g)];
    const double* below = l + n * n;
    for (auto k = column_begin_[at(g)]; k < column_begin_[at(g) + 1]; ++k) {
      const Group& h = groups_[at(column_[at(k)])];
      const double* from = coefficients_.data() + h.first_vector;
      for (int i = 0; i < h.count; ++i)
        for (int j = 0; j < n; ++j) c[j] -= below[i * n + j] * from[i];
      below += h.count * n;
    }
    for (int i = n; i-- > 0;) {
      for (int k = i + 1; k < n; ++k) c[i] -= l[k * n + i] * c[k];
      c[i] /= l[i * n + i];
    }
  }
}

std::int64_t NullVectors::memory_bytes() const {
  const std::size_t doubles = values_.capacity() + coefficients_.capacity() + gram_.capacity() + factor_.capacity() +
                              column_begin_.capacity() + column_values_.capacity() + own_begin_.capacity();
  const std::size_t ints = unknowns_.capacity() + column_.capacity() + own_.capacity() + 4 * mark_.capacity();
  return static_cast<std::int64_t>(doubles * sizeof(double) + ints * sizeof(int) + groups_.capacity() * sizeof(Group) +
                                   blocks_.capacity() * sizeof(Block));
}

}  // namespace bough::solve
