#pragma once
/// Null vectors with few entries, of dependent rows that were decided below the root. Internal to solve.
#include <cstdint>
#include <span>
#include <vector>

#include "bough/tree/tree.hpp"

namespace bough::solve {

/// Rows of a fixed number of values at few of many unknowns. Rows are added and found in constant time; clearing takes
/// time proportional to their number.
class SparseRows {
 public:
  explicit SparseRows(int width) : width_(width) {}
  void resize(std::int64_t num_unknowns) { place_.resize(static_cast<std::size_t>(num_unknowns), -1); }
  /// The row of an unknown, or null.
  const double* find(int unknown) const {
    const int p = place_[static_cast<std::size_t>(unknown)];
    return p < 0 ? nullptr : values_.data() + static_cast<std::size_t>(p) * static_cast<std::size_t>(width_);
  }
  /// The same, added with zeros if it is missing. Pointers to rows become invalid.
  double* at(int unknown) {
    int& p = place_[static_cast<std::size_t>(unknown)];
    if (p < 0) {
      p = static_cast<int>(unknowns_.size());
      unknowns_.push_back(unknown);
      values_.resize(values_.size() + static_cast<std::size_t>(width_), 0.0);
    }
    return values_.data() + static_cast<std::size_t>(p) * static_cast<std::size_t>(width_);
  }
  std::span<const int> unknowns() const { return unknowns_; }
  std::span<double> values() { return values_; }
  void clear() {
    for (const int u : unknowns_) place_[static_cast<std::size_t>(u)] = -1;
    unknowns_.clear();
    values_.clear();
  }

 private:
  int width_;
  std::vector<int> place_;  ///< by unknown; -1: no row
  std::vector<int> unknowns_;
  std::vector<double> values_;
};

/// Vectors Z in groups of at most eight, each group with entries in the subtree of one front, and the projection
///   x <- x - Z (Z^T W^2 Z)^-1 Z^T W^2 x                                                                   (6)
/// Groups are added in the order of the fronts. Groups of unrelated subtrees have no common entries, so the Cholesky
/// factor of the Gram matrix, in this order, has entries only between a group and others above it on the way to the
/// root. All memory is kept for the next time.
class NullVectors {
 public:
  static constexpr int most = 8;  ///< vectors of a group

  struct Group {
    tree::FrontId front = tree::none;
    int count = 0;
    int first_vector = 0;
    std::int64_t begin = 0, end = 0;  ///< of its unknowns
    std::int64_t values = 0;          ///< end - begin rows of `count` values
  };

  void clear();
  /// rows: of width `most`, the values of `count` vectors; weight: W by unknown, null for ones. earlier: groups whose
  /// entries may overlap, ascending.
  void add(tree::FrontId front, int count, SparseRows& rows, const double* weight, std::span<const int> earlier);
  /// Factors the Gram matrix. False if it is not positive definite, to working precision.
  bool factor();

  int num_vectors() const { return num_vectors_; }
  std::span<const Group> groups() const { return groups_; }
  std::span<const int> unknowns(const Group& g) const {
    return {unknowns_.data() + g.begin, static_cast<std::size_t>(g.end - g.begin)};
  }
  /// Values of the k-th of its unknowns, `count` of them.
  const double* values(const Group& g, std::int64_t k) const { return values_.data() + g.values + k * g.count; }

  /// Subtracts from x its part (6) in the span of the vectors. read(u): W^2 x at unknown u; take(u, v): x -= v there.
  template <class Read, class Take>
  void project(Read&& read, Take&& take) {
    for (int sweep = 0; sweep < num_sweeps_; ++sweep) {
      for (const Group& g : groups_) {
        double* c = coefficients_.data() + g.first_vector;
        for (int v = 0; v < g.count; ++v) c[v] = 0.0;
        const double* z = values_.data() + g.values;
        for (std::int64_t k = g.begin; k < g.end; ++k, z += g.count) {
          const double x = read(unknowns_[static_cast<std::size_t>(k)]);
          for (int v = 0; v < g.count; ++v) c[v] += z[v] * x;
        }
      }
      solve();
      for (const Group& g : groups_) {
        const double* c = coefficients_.data() + g.first_vector;
        const double* z = values_.data() + g.values;
        for (std::int64_t k = g.begin; k < g.end; ++k, z += g.count) {
          double sum = 0.0;
          for (int v = 0; v < g.count; ++v) sum += z[v] * c[v];
          take(unknowns_[static_cast<std::size_t>(k)], sum);
        }
      }
    }
  }

  std::int64_t memory_bytes() const;

 private:
  /// Gram block of two groups, later x earlier.
  struct Block {
    int later, earlier;
    std::int64_t begin;
  };
  void lay_out();
  double* block_of(int later, int earlier);
  void solve();  ///< coefficients <- (Z^T W^2 Z)^-1 coefficients

  std::vector<Group> groups_;
  int num_vectors_ = 0;
  int num_sweeps_ = 1;  ///< a sweep leaves an error of round-off times the condition of the Gram matrix
  std::vector<int> unknowns_;
  std::vector<double> values_, coefficients_;
  std::vector<Block> blocks_;  ///< by later group, then earlier, the diagonal last
  std::vector<double> gram_, factor_;
  // Columns of the factor: the groups below the diagonal, ascending, and the blocks, the diagonal first.
  std::vector<std::int64_t> column_begin_, column_values_, own_begin_;
  std::vector<int> column_, own_, parent_, first_child_, next_child_, mark_;
};

}  // namespace bough::solve
