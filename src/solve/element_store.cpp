#include "element_store.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#include "bough/blocks/at.hpp"

namespace bough::solve {

namespace {
constexpr std::int64_t chunk_blocks = 128;
}  // namespace

namespace {

std::vector<std::int64_t> first_of_leaves(const blocks::BlockGraph& graph, const tree::Tree& tree,
                                          std::int64_t& total) {
  std::vector<std::int64_t> first(at(graph.num_elements()), 0);
  total = 0;
  for (int e : tree.element_order) {
    first[at(e)] = total;
    std::int64_t n = 0;
    for (auto k = graph.element_begin[at(e)]; k < graph.element_begin[at(e) + 1]; ++k)
      n += graph.block_size[at(graph.element_blocks[at(k)])];
    total += n * n;
  }
  return first;
}

}  // namespace

ElementStore::ElementStore(const blocks::BlockGraph& graph, const tree::Tree& tree) : graph_(graph), tree_(tree) {
  std::int64_t total = 0;
  begin_ = first_of_leaves(graph, tree, total);
  stride_.assign(at(graph.num_elements()), 1);
  values_.assign(at(total), 0.0);
  prepare();
}

ElementStore::ElementStore(const blocks::BlockGraph& graph, const tree::Tree& tree, std::vector<std::int64_t> first,
                           std::vector<int> stride, std::int64_t count)
    : graph_(graph), tree_(tree), begin_(std::move(first)), stride_(std::move(stride)), values_(at(count), 0.0) {
  prepare();
}

void ElementStore::prepare() {
  size_.assign(at(graph_.num_elements()), 0);
  for (int e = 0; e < graph_.num_elements(); ++e)
    for (int k = 0; k < num_blocks_of(e); ++k) size_[at(e)] += graph_.block_size[at(blocks_of(e)[k])];
  touch_begin_.assign(at(graph_.num_blocks()) + 1, 0);
  for (int b : graph_.element_blocks) ++touch_begin_[at(b) + 1];
  for (std::size_t b = 1; b < touch_begin_.size(); ++b) touch_begin_[b] += touch_begin_[b - 1];
  touches_.resize(graph_.element_blocks.size());
  std::vector<std::int64_t> next(touch_begin_.begin(), touch_begin_.end() - 1);
  for (int e = 0; e < graph_.num_elements(); ++e) {
    int offset = 0;
    for (int k = 0; k < num_blocks_of(e); ++k) {
      const int b = blocks_of(e)[k];
      touches_[at(next[at(b)]++)] = {e, offset};
      offset += graph_.block_size[at(b)];
    }
  }
  chunk_.assign(at(3 * (graph_.num_blocks() / chunk_blocks + 1)), 0.0);
}

/// Calls row(global row, element, row of the element matrix) for all rows of blocks [begin, end), elements ascending.
template <class Row>
void ElementStore::for_rows(std::int64_t begin, std::int64_t end, Row&& row) const {
  for (std::int64_t b = begin; b < end; ++b)
    for (std::int64_t t = touch_begin_[at(b)]; t < touch_begin_[at(b) + 1]; ++t) {
      const Touch touch = touches_[at(t)];
      const std::int64_t n = size_of(touch.element);
      const ConstElementView a = view(touch.element);
      for (int i = 0; i < graph_.block_size[at(b)]; ++i)
        row(tree_.unknown_begin[at(b)] + i, touch.element, a.from((touch.offset + i) * n));
    }
}

void ElementStore::multiply(const tree::Walker& walker, const double* x, double* y) const {
  auto body = [&](std::int64_t begin, std::int64_t end) {
    std::fill(y + tree_.unknown_begin[at(begin)], y + tree_.unknown_begin[at(end)], 0.0);
    for_rows(begin, end, [&](std::int64_t i, int e, const ConstElementView& a) {
      double sum = 0.0;
      std::int64_t c = 0;
      for (int k = 0; k < num_blocks_of(e); ++k) {
        const int b = blocks_of(e)[k];
        const double* xb = x + tree_.unknown_begin[at(b)];
        for (int j = 0; j < graph_.block_size[at(b)]; ++j) sum += a[c++] * xb[j];
      }
      y[i] += sum;
    });
  };
  walker.for_each_chunk(graph_.num_blocks(), chunk_blocks, tree::make_chunk(body));
}

ElementStore::Errors ElementStore::eval_residual(const tree::Walker& walker, const Scales& scales, const double* x,
                                                 const double* b, double* r) {
  std::fill(chunk_.begin(), chunk_.end(), 0.0);
  auto body = [&](std::int64_t begin, std::int64_t end) {
    double* most = chunk_.data() + 3 * (begin / chunk_blocks);  // |r|, row sum of |A|, |b|, scaled
    for (std::int64_t blk = begin; blk < end; ++blk) {
      for (int i = 0; i < graph_.block_size[at(blk)]; ++i) {
        const std::int64_t row = tree_.unknown_begin[at(blk)] + i;
        double sum = b[row], norm = 0.0;
        for (std::int64_t t = touch_begin_[at(blk)]; t < touch_begin_[at(blk) + 1]; ++t) {
          const int e = touches_[at(t)].element;
          const auto a = view(e).from(static_cast<std::int64_t>(touches_[at(t)].offset + i) * size_of(e));
          std::int64_t c = 0;
          for (int k = 0; k < num_blocks_of(e); ++k) {
            const int other = blocks_of(e)[k];
            const std::int64_t first = tree_.unknown_begin[at(other)];
            for (int j = 0; j < graph_.block_size[at(other)]; ++j) {
              const double entry = a[c++];
              sum -= entry * x[first + j];
              norm += std::abs(entry) * scales.column[at(first + j)];
            }
          }
        }
        r[row] = sum;
        const double scale = scales.row[at(row)];
        most[0] = larger(most[0], std::abs(sum) * scale);
        most[1] = larger(most[1], norm * scale);
        most[2] = larger(most[2], std::abs(b[row]) * scale);
      }
    }
  };
  walker.for_each_chunk(graph_.num_blocks(), chunk_blocks, tree::make_chunk(body));
  double residual = 0.0, norm = 0.0, rhs = 0.0, size = 0.0;
  Errors errors;
  for (std::size_t c = 0; c + 2 < chunk_.size(); c += 3) {
    residual = larger(residual, chunk_[c]);
    norm = larger(norm, chunk_[c + 1]);
    rhs = larger(rhs, chunk_[c + 2]);
  }
  for (std::size_t i = 0; i < scales.column.size(); ++i) size = larger(size, std::abs(x[i]) / scales.column[i]);
  errors.finite = std::isfinite(residual) && std::isfinite(size);
  errors.size = norm * size + rhs;
  errors.set_normwise(residual);
  return errors;
}

std::vector<ElementBatch> ElementStore::single_batches() const {
  std::vector<ElementBatch> batches;
  for (int e : tree_.element_order) {
    ElementBatch batch;
    batch.element.fill(-1);
    batch.element[0] = e;
    batch.values = view(e).first - values_.data();
    batches.push_back(batch);
  }
  return batches;
}

namespace {

/// Compares bits: matrices that were made symmetric are recognised in a fraction of the time that differences take.
bool is_mirrored(const ConstElementView& a, int n) {
  std::uint64_t differ = 0;
  for (std::int64_t i = 1; i < n; ++i)
    for (std::int64_t j = 0; j < i; ++j)
      differ |= std::bit_cast<std::uint64_t>(a[i * n + j]) ^ std::bit_cast<std::uint64_t>(a[j * n + i]);
  return differ == 0;
}

}  // namespace

double ElementStore::asymmetry_of(int e, const Scales& scales) const {
  const ConstElementView a = view(e);
  if (is_mirrored(a, size_of(e))) return 0.0;
  const std::int64_t step = a.stride, n = size_of(e) * step;
  const int* blocks = blocks_of(e);
  const int count = num_blocks_of(e);
  std::uint64_t most = 0;  // as bits, in which infinity and NaN are the largest
  for (int p = 0, i0 = 0; p < count; ++p) {
    const int rows = graph_.block_size[at(blocks[p])];
    const double* row_scale = scales.column.data() + tree_.unknown_begin[at(blocks[p])];
    for (int q = 0, j0 = 0; q <= p; ++q) {
      const int columns = graph_.block_size[at(blocks[q])];
      const double* column_scale = scales.column.data() + tree_.unknown_begin[at(blocks[q])];
      for (int i = 0; i < rows; ++i) {
        const double *lower = a.first + (i0 + i) * n + j0 * step, *upper = a.first + j0 * n + (i0 + i) * step;
        for (int j = 0; j < columns; ++j, lower += step, upper += n) {
          if (*lower == *upper) continue;
          const double difference = std::abs(*upper - *lower) * row_scale[i] * column_scale[j];
          most = std::max(most, std::bit_cast<std::uint64_t>(difference));
        }
      }
      j0 += columns;
    }
    i0 += rows;
  }
  return std::bit_cast<double>(most);
}

ElementStore::Sizes ElementStore::eval_sizes(const tree::Walker& walker, const Scales& scales) {
  constexpr double least_of_own = 0.25;  // rounded to powers of two, a scaled diagonal is between 1/2 and 2
  std::fill(chunk_.begin(), chunk_.end(), 0.0);
  auto body = [&](std::int64_t begin, std::int64_t end) {
    double* most = chunk_.data() + 3 * (begin / chunk_blocks);  // row sum; scaled diagonal, and its inverse
    for (std::int64_t b = begin; b < end; ++b)
      for (int i = 0; i < graph_.block_size[at(b)]; ++i) {
        const std::int64_t row = tree_.unknown_begin[at(b)] + i;
        double sum = 0.0, diagonal = 0.0;
        for (std::int64_t t = touch_begin_[at(b)]; t < touch_begin_[at(b) + 1]; ++t) {
          const int e = touches_[at(t)].element, own = touches_[at(t)].offset + i;
          const ConstElementView a = view(e).from(static_cast<std::int64_t>(own) * size_of(e));
          diagonal += std::abs(a[own]);
          std::int64_t c = 0;
          for (int k = 0; k < num_blocks_of(e); ++k) {
            const int other = blocks_of(e)[k];
            for (int j = 0; j < graph_.block_size[at(other)]; ++j)
              sum += std::abs(a[c++]) * scales.column[at(tree_.unknown_begin[at(other)] + j)];
          }
        }
        most[0] = larger(most[0], sum * scales.row[at(row)]);
        if (graph_.block_kind[at(b)] == blocks::BlockKind::multiplier || diagonal == 0.0) continue;
        const double square = scales.row[at(row)] * scales.column[at(row)];
        most[1] = larger(most[1], diagonal * square);
        if (scales.diagonal[at(row)] * square > least_of_own) most[2] = larger(most[2], 1.0 / (diagonal * square));
      }
  };
  walker.for_each_chunk(graph_.num_blocks(), chunk_blocks, tree::make_chunk(body));
  Sizes sizes;
  for (std::size_t c = 0; c + 2 < chunk_.size(); c += 3) {
    sizes.norm = larger(sizes.norm, chunk_[c]);
    sizes.drift = larger(sizes.drift, larger(chunk_[c + 1], chunk_[c + 2]));
  }
  return sizes;
}

void ElementStore::eval_rows(const Scales& scales, std::span<const int> blocks, const double* x, const double* b,
                             double* r, double* most) const {
  for (int block : blocks) {
    const std::int64_t first = tree_.unknown_begin[at(block)], end = tree_.unknown_begin[at(block) + 1];
    for (std::int64_t u = first; u < end; ++u) r[u] = b[u];
    for_rows(block, block + 1, [&](std::int64_t row, int e, const ConstElementView& a) {
      std::int64_t c = 0;
      double sum = 0.0;
      for (int k = 0; k < num_blocks_of(e); ++k) {
        const int other = blocks_of(e)[k];
        const double* xb = x + tree_.unknown_begin[at(other)];
        for (int j = 0; j < graph_.block_size[at(other)]; ++j) sum += a[c++] * xb[j];
      }
      r[row] -= sum;
    });
    for (std::int64_t u = first; u < end; ++u) {
      const double size = std::abs(r[u]) * scales.row[at(u)];
      most[0] = larger(most[0], size);
      most[1] = larger(most[1], std::abs(b[u]) * scales.row[at(u)]);
    }
  }
}

std::int64_t ElementStore::memory_bytes() const {
  return static_cast<std::int64_t>(values_.size() * sizeof(double) + touches_.size() * sizeof(Touch));
}

}  // namespace bough::solve
