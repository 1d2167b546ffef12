#include "element_store.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

namespace bough::solve {

namespace {
std::size_t at(std::int64_t i) { return static_cast<std::size_t>(i); }
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
  chunk_.assign(at(4 * (graph_.num_blocks() / chunk_blocks + 1)), 0.0);
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
    double* most = chunk_.data() + 4 * (begin / chunk_blocks);  // |r|, |A| |x| per row norm, |x| and |b|, componentwise
    double* worst = most + 3;
    for (std::int64_t blk = begin; blk < end; ++blk) {
      for (int i = 0; i < graph_.block_size[at(blk)]; ++i) {
        const std::int64_t row = tree_.unknown_begin[at(blk)] + i;
        double sum = b[row], magnitude = std::abs(b[row]), norm = 0.0;
        for (std::int64_t t = touch_begin_[at(blk)]; t < touch_begin_[at(blk) + 1]; ++t) {
          const int e = touches_[at(t)].element;
          const auto a = view(e).from(static_cast<std::int64_t>(touches_[at(t)].offset + i) * size_of(e));
          std::int64_t c = 0;
          for (int k = 0; k < num_blocks_of(e); ++k) {
            const int other = blocks_of(e)[k];
            const std::int64_t first = tree_.unknown_begin[at(other)];
            for (int j = 0; j < graph_.block_size[at(other)]; ++j) {
              const double entry = a[c++];
              const double product = entry * x[first + j];
              sum -= product;
              magnitude += std::abs(product);
              norm += std::abs(entry) * scales.column[at(first + j)];
            }
          }
        }
        r[row] = sum;
        const double scale = scales.row[at(row)];
        const double residual = std::abs(sum);
        most[0] = larger(most[0], residual * scale);
        most[1] = larger(most[1], norm * scale);
        most[2] = larger(most[2], std::abs(b[row]) * scale);
        if (magnitude > 0.0) *worst = std::max(*worst, residual / magnitude);
      }
    }
  };
  walker.for_each_chunk(graph_.num_blocks(), chunk_blocks, tree::make_chunk(body));
  double residual = 0.0, norm = 0.0, rhs = 0.0, size = 0.0;
  Errors errors;
  for (std::size_t c = 0; c + 3 < chunk_.size(); c += 4) {
    residual = larger(residual, chunk_[c]);
    norm = larger(norm, chunk_[c + 1]);
    rhs = larger(rhs, chunk_[c + 2]);
    errors.componentwise = std::max(errors.componentwise, chunk_[c + 3]);
  }
  for (std::size_t i = 0; i < scales.column.size(); ++i) size = larger(size, std::abs(x[i]) / scales.column[i]);
  errors.finite = std::isfinite(residual) && std::isfinite(size);
  errors.size = norm * size + rhs;
  errors.normwise = errors.size > 0.0 ? residual / errors.size : residual;
  return errors;
}

/// An unknown with little or nothing on the diagonal may still resist through a constraint to one that does (the turning of a massless bar
/// that carries a mass): a row g then lends it g_u^2 / sum_{v != u} g_v^2 / a_v. Taken where the own diagonal is weaker by `weak`;
/// scaled by noise instead, such an unknown would dwarf the others in its rows and make them look dependent.
/// strict: rows all of whose other unknowns have a diagonal; it is their own one that they lend, not what they have borrowed, else the rows of
/// many hinges on one body, which couple its unknowns in ever other ratios, raise these without end. bare: a node between joints, to which no such row leads, takes the sum over
/// what has one in the row's other blocks, and the most of its rows; what its own block could give way to is held by its other joints, or
/// by nothing at all. What was lent in a bare sweep stands negative until its end and does not lend on. Answers whether something was lent.
bool ElementStore::lend_diagonals(Lending lending, const std::vector<double>& given,
                                  std::vector<double>& diagonal) const {
  constexpr double weak = 1e-6;
  bool has_lent = false;
  for (std::int64_t b = 0; b < graph_.num_blocks(); ++b) {
    if (graph_.block_kind[at(b)] == blocks::BlockKind::motion) continue;
    for (std::int64_t t = touch_begin_[at(b)]; t < touch_begin_[at(b) + 1]; ++t) {
      const Touch touch = touches_[at(t)];
      const std::int64_t ne = size_of(touch.element);
      const auto for_motion = [&](auto&& visit) {
        std::int64_t j = 0;
        for (int p = 0; p < num_blocks_of(touch.element); ++p) {
          const int other = blocks_of(touch.element)[p];
          for (std::int64_t u = tree_.unknown_begin[at(other)]; u < tree_.unknown_begin[at(other) + 1]; ++u, ++j)
            if (graph_.block_kind[at(other)] == blocks::BlockKind::motion) visit(at(u), j, other);
        }
      };
      for (int i = 0; i < graph_.block_size[at(b)]; ++i) {
        const ConstElementView g = view(touch.element).from((touch.offset + i) * ne);
        double largest = 0.0;
        for_motion([&](std::size_t, std::int64_t j, int) { largest = std::max(largest, std::abs(g[j])); });
        // Entries that are round-off couple nothing: the mobility behind them would be lent a thousand times over.
        const auto couples = [&](std::int64_t j) { return std::abs(g[j]) > 1e-8 * largest; };
        for_motion([&](std::size_t u, std::int64_t j, int own) {
          if (!couples(j)) return;
          double others = 0.0;  // mobility of the row's other unknowns; one without any diagonal gives way freely
          bool held = true;
          for_motion([&](std::size_t v, std::int64_t k, int other) {
            if (v == u || !couples(k)) return;
            if (lending == Lending::bare && (other == own || !(diagonal[v] > 0.0))) return;
            const double own_one = lending == Lending::strict && given[v] > 0.0 ? given[v] : diagonal[v];
            held = held && own_one > 0.0;
            if (held) others += g[k] * g[k] / own_one;
          });
          if (!held || others == 0.0) return;
          const double lent = g[j] * g[j] / others;
          if (lending == Lending::strict) {
            if (!(diagonal[u] < weak * lent)) return;
            diagonal[u] = lent;
          } else {
            if (!(diagonal[u] <= 0.0 && lent > -diagonal[u])) return;
            diagonal[u] = -lent;
          }
          has_lent = true;
        });
      }
    }
  }
  if (lending == Lending::bare && has_lent)
    for (double& d : diagonal) d = std::abs(d);
  return has_lent;
}

/// Strictly once: rows that couple in other ratios would raise each other without end. Bare nodes borrow from nothing, so only once each;
/// what has borrowed lends on.
void ElementStore::lift_weak_diagonals(std::vector<double>& given, std::vector<double>& diagonal) const {
  given = diagonal;
  lend_diagonals(Lending::strict, given, diagonal);
  while (lend_diagonals(Lending::bare, given, diagonal)) {
  }
}

void ElementStore::eval_scales(Scales& s) const {
  const std::size_t n = at(tree_.num_unknowns());
  std::vector<double>& exact_row = s.row;
  std::vector<double>& exact_column = s.column;
  std::fill(exact_row.begin(), exact_row.end(), 0.0);
  std::fill(exact_column.begin(), exact_column.end(), 0.0);
  std::fill(s.weight.begin(), s.weight.end(), 0.0);
  const auto is_motion = [&](std::int64_t b) { return graph_.block_kind[at(b)] == blocks::BlockKind::motion; };
  // Motion: row gathers |diagonal|, column the largest entry of the row, weight that of the column.
  double probe = 0.0;  // NaN as soon as something is not finite
  for (std::int64_t b = 0; b < graph_.num_blocks(); ++b) {
    if (!is_motion(b)) continue;
    for (std::int64_t t = touch_begin_[at(b)]; t < touch_begin_[at(b) + 1]; ++t) {
      const Touch touch = touches_[at(t)];
      const std::int64_t ne = size_of(touch.element);
      const ConstElementView a = view(touch.element);
      for (int i = 0; i < graph_.block_size[at(b)]; ++i) {
        const std::size_t row = at(tree_.unknown_begin[at(b)] + i);
        const std::int64_t k = touch.offset + i;
        exact_row[row] += std::abs(a[k * ne + k]);
        for (std::int64_t j = 0; j < ne; ++j) {
          exact_column[row] = std::max(exact_column[row], std::abs(a[k * ne + j]));
          s.weight[row] = std::max(s.weight[row], std::abs(a[j * ne + k]));
        }
      }
    }
  }
  lift_weak_diagonals(s.given, exact_row);
  s.empty_unknown = -1;
  const auto empty = [&](std::size_t i) {
    if (s.empty_unknown < 0 || static_cast<std::int64_t>(i) < s.empty_unknown)
      s.empty_unknown = static_cast<std::int64_t>(i);
  };
  for (std::int64_t b = 0; b < graph_.num_blocks(); ++b) {
    if (!is_motion(b)) continue;
    for (std::size_t i = at(tree_.unknown_begin[at(b)]); i < at(tree_.unknown_begin[at(b) + 1]); ++i) {
      if (exact_column[i] == 0.0 || s.weight[i] == 0.0) empty(i);
      const double value = exact_row[i] > 0.0 ? exact_row[i] : std::max(exact_column[i], s.weight[i]);
      probe += value * 0.0;
      exact_row[i] = exact_column[i] = value > 0.0 ? 1.0 / std::sqrt(value) : 1.0;
      s.weight[i] = 1.0;
    }
  }
  for (std::int64_t b = 0; b < graph_.num_blocks(); ++b) {
    if (is_motion(b)) continue;
    for (int i = 0; i < graph_.block_size[at(b)]; ++i) {
      double row = 0.0, column = 0.0, diagonal = 0.0;
      for (std::int64_t t = touch_begin_[at(b)]; t < touch_begin_[at(b) + 1]; ++t) {
        const Touch touch = touches_[at(t)];
        const std::int64_t ne = size_of(touch.element), k = touch.offset + i;
        const ConstElementView a = view(touch.element);
        diagonal += std::abs(a[k * ne + k]);
        std::int64_t j = 0;
        for (int p = 0; p < num_blocks_of(touch.element); ++p) {
          const int other = blocks_of(touch.element)[p];
          for (std::int64_t u = tree_.unknown_begin[at(other)]; u < tree_.unknown_begin[at(other) + 1]; ++u, ++j) {
            if (!is_motion(other)) continue;
            row += std::pow(a[k * ne + j] * exact_column[at(u)], 2);
            column += std::pow(a[j * ne + k] * exact_row[at(u)], 2);
          }
        }
      }
      const std::size_t u = at(tree_.unknown_begin[at(b)] + i);
      probe += (row + column) * 0.0;
      if (row == 0.0) row = column > 0.0 ? column : diagonal;  // a row switched off by a diagonal, or an empty one
      if (column == 0.0) column = row;
      exact_row[u] = row > 0.0 ? 1.0 / std::sqrt(row) : 1.0;
      exact_column[u] = column > 0.0 ? 1.0 / std::sqrt(column) : 1.0;
    }
  }
  for (std::size_t i = 0; i < n; ++i) {
    const auto rounded = [](double x) { return std::exp2(std::round(std::log2(x))); };
    const double column = rounded(exact_column[i]);
    s.weight[i] = column / exact_column[i];
    s.row[i] = rounded(exact_row[i]);
    s.column[i] = column;
  }
  s.finite = probe == 0.0;
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

/// Bit by bit: what has been made symmetric is found so in a fraction of the time that differences take.
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
  std::uint64_t most = 0;  // as bits: infinity and NaN come out on top
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

double ElementStore::eval_norm(const Scales& scales) const {
  double norm = 0.0;
  for (std::int64_t b = 0; b < graph_.num_blocks(); ++b)
    for (int i = 0; i < graph_.block_size[at(b)]; ++i) {
      double sum = 0.0;
      for (std::int64_t t = touch_begin_[at(b)]; t < touch_begin_[at(b) + 1]; ++t) {
        const int e = touches_[at(t)].element;
        const ConstElementView a = view(e).from(static_cast<std::int64_t>(touches_[at(t)].offset + i) * size_of(e));
        std::int64_t c = 0;
        for (int k = 0; k < num_blocks_of(e); ++k) {
          const int other = blocks_of(e)[k];
          for (int j = 0; j < graph_.block_size[at(other)]; ++j)
            sum += std::abs(a[c++]) * scales.column[at(tree_.unknown_begin[at(other)] + j)];
        }
      }
      norm = std::max(norm, sum * scales.row[at(tree_.unknown_begin[at(b)] + i)]);
    }
  return norm;
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
