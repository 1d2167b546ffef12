#pragma once
/// Element matrices, products with them, and the scales computed from them. Internal to solve; shared by both solvers.
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "bough/blocks/block_graph.hpp"
#include "bough/solve/element_view.hpp"
#include "bough/tree/tree.hpp"
#include "bough/tree/walker.hpp"
#include "line_allocator.hpp"

namespace bough::solve {

/// Scales D_r, D_c: powers of two. Motion unknowns: both 2^round(-log2(a)/2), a = sum over the elements of |diagonal|
/// (row norm if that is 0). Multipliers: column and row by the inverse 2-norm of the constraint's column and row in
/// scaled motion unknowns. A tangent K + C/h + M/h^2 then has diagonal near 1 and constraint rows of norm near 1 for
/// every h.
struct Scales {
  std::vector<double> row, column;
  /// The norm of scaled multipliers, of which dependent rows leave a choice: that of BlockGraph::multiplier_measure, or
  /// column / exact column scale, in [2^-1/2, 2^1/2], which is without the rounding of scales.
  std::vector<double> weight;
  std::vector<double>
      diagonal;  ///< of motion unknowns, the sum over the elements of |diagonal| for which they were made
  std::int64_t empty_unknown = -1;  ///< first unknown whose row or column is zero, or -1
  bool finite = true;
};

/// An element whose matrix differs from its transpose, or is not finite; -1: none.
struct Asymmetry {
  int element = -1;
  double difference = 0.0;
  bool is_finite() const { return std::isfinite(difference); }
  static bool shows(double difference) { return !std::isfinite(difference) || difference > 1e-9; }
};

/// Larger of two magnitudes; NaN counts as the largest.
inline double larger(double a, double b) { return std::islessequal(b, a) || std::isnan(a) ? a : b; }

class ElementStore {
 public:
  /// Element matrices one after the other, by leaf.
  ElementStore(const blocks::BlockGraph& graph, const tree::Tree& tree);
  /// Element e at `first[e]`, entries `stride[e]` apart, in `count` doubles.
  ElementStore(const blocks::BlockGraph& graph, const tree::Tree& tree, std::vector<std::int64_t> first,
               std::vector<int> stride, std::int64_t count);

  ElementView view(int element) {
    return {values_.data() + begin_[static_cast<std::size_t>(element)], stride_[static_cast<std::size_t>(element)]};
  }
  ConstElementView view(int element) const {
    return {values_.data() + begin_[static_cast<std::size_t>(element)], stride_[static_cast<std::size_t>(element)]};
  }
  int size_of(int element) const { return size_[static_cast<std::size_t>(element)]; }
  const int* blocks_of(int element) const {
    return graph_.element_blocks.data() + graph_.element_begin[static_cast<std::size_t>(element)];
  }
  int num_blocks_of(int element) const {
    const auto e = static_cast<std::size_t>(element);
    return static_cast<int>(graph_.element_begin[e + 1] - graph_.element_begin[e]);
  }

  /// y = A x. Rows are computed independently; every row adds its elements in ascending order.
  void multiply(const tree::Walker& walker, const double* x, double* y) const;

  struct Errors {
    double normwise = 0.0;
    double size = 0.0;  ///< |A| |x| + |b|, the reference of the normwise error.
    bool finite = true;
    /// Sets the normwise error. Products below the range of normal numbers lose digits that no solution can have: a
    /// size at which that shows counts as the smallest one at which it does not.
    void set_normwise(double residual) {
      constexpr double least = std::numeric_limits<double>::min() / std::numeric_limits<double>::epsilon();
      normwise = residual / (size > least ? size : least);
    }
  };
  /// r = b - A x and the backward error of x in scaled variables.
  Errors eval_residual(const tree::Walker& walker, const Scales& scales, const double* x, const double* b, double* r);

  /// Serial, one pass over the element matrices. No allocation. scratch: num_unknowns numbers, overwritten. precision:
  /// SolveOptions::data_precision.
  void eval_scales(Scales& scales, std::vector<double>& scratch, double precision = 0.0) const;
  void measure_multipliers(Scales& scales) const;
  /// Largest entry of D (A - A^T) D of one element, D the scales of columns; infinity or NaN if A is not finite.
  double asymmetry_of(int element, const Scales& scales) const;
  /// Of the present matrices in given scales, which may be those of earlier matrices.
  struct Sizes {
    double norm = 0.0;  ///< largest row sum of magnitudes
    /// Largest scaled sum over the elements of |diagonal| of a motion unknown, or the inverse of one, if it was near 1
    /// when the scales were made: weak diagonals do not determine a scale.
    double drift = 0.0;
  };
  Sizes eval_sizes(const tree::Walker& walker, const Scales& scales);
  /// r = b - A x for the rows of some blocks; raises `most`, {|r|, |b|} scaled.
  void eval_rows(const Scales& scales, std::span<const int> blocks, const double* x, const double* b, double* r,
                 double* most) const;
  const double* values() const { return values_.data(); }
  /// Batches of one element each, by leaf.
  std::vector<ElementBatch> single_batches() const;

  std::int64_t memory_bytes() const;
  const blocks::BlockGraph& graph() const { return graph_; }
  const tree::Tree& tree() const { return tree_; }

 private:
  struct Touch {
    int element;
    int offset;  ///< first row of the block in the element
  };
  void prepare();
  enum class Lending { strict, bare };
  bool lend_diagonals(Lending lending, const std::vector<double>& given, std::vector<double>& diagonal) const;
  void drop_round_off(double precision, std::vector<double>& diagonal) const;
  void lift_weak_diagonals(std::vector<double>& given, std::vector<double>& diagonal) const;
  template <class Row>
  void for_rows(std::int64_t begin, std::int64_t end, Row&& row) const;

  const blocks::BlockGraph& graph_;
  const tree::Tree& tree_;
  std::vector<std::int64_t> begin_;  ///< by element, into values_
  std::vector<int> stride_;          ///< by element
  std::vector<int> size_;
  std::vector<double, LineAllocator<double>> values_;
  std::vector<std::int64_t> touch_begin_;  ///< by block
  std::vector<Touch> touches_;
  std::vector<double> chunk_;  ///< partial maxima, three per chunk
};

}  // namespace bough::solve
