/// Assembly of a front: extend-add of the children's Schur complements, column by column, then the front's own
/// elements and children in lanes.
#include <algorithm>
#include <cstring>

#include "bough/blocks/at.hpp"
#include "dense_panel.hpp"
#include "hierarchical_state.hpp"

namespace bough::solve {

namespace {

/// Number of columns that are cleared and filled together, so that they stay in the second cache.
constexpr int doubles_in_cache = 1 << 16;
/// Symmetric fronts from this size on are cleared only below the diagonal; for shorter columns this costs more than it
/// saves.
constexpr int cleared_by_columns = 160;
/// Time of reading, adding and writing an entry, in operations of an elimination.
constexpr double flops_of_an_entry = 8.0;

}  // namespace

void Hierarchical::State::assemble_front(tree::FrontId f) {
  const tree::Front& shape = front(f);
  FrontData& d = data(f);
  if (d.failed) return;
  const int* own = own_unknowns.data() + own_begin[at(f)];
  for (int i = 0; i < d.full; ++i) {
    d.row_from[i] = i;
    if (i >= d.delayed_in) d.rows[i] = d.columns[i] = own[i - d.delayed_in];
  }
  int delayed = 0;
  for (tree::FrontId c : tree.children(shape)) {
    if (!is_scalar(c)) continue;
    FrontData& child = data(c);
    child.delayed_to = delayed;
    for (int j = child.pivots; j < child.pivots + child.num_delayed(); ++j, ++delayed) {
      d.rows[delayed] = child.rows[j];
      d.columns[delayed] = child.columns[j];
    }
  }
  const auto fill = [&](int first, int last) { fill_columns(f, first, last); };
  for_chunks_of_columns(0, d.full, d.size, flops_of_an_entry * d.size, &factor_walker, fill);
  for (tree::FrontId c : tree.children(shape))
    if (is_scalar(c) && data(c).is_symmetric() && !d.is_symmetric()) add_child_both_ways(c, d);
  for (int p = shape.element_begin; p < shape.element_end; ++p) add_element(p, d);
  for (tree::FrontId c : tree.children(shape))
    if (!is_scalar(c)) add_lane_child(c, d);
}

/// Clears columns [first, last), all on one side of `full`, and adds the contributions of the children on the scalar
/// path, child by child.
void Hierarchical::State::fill_columns(tree::FrontId f, int first, int last) {
  const FrontData& d = data(f);
  const FrontParts parts(d.matrix());
  const int block = std::max(4, doubles_in_cache / std::max(d.size, 1));
  for (int begin = first; begin < last; begin += block) {
    const int end = std::min(last, begin + block);
    const auto clear = [&](double* part, std::ptrdiff_t ld) {
      if (ld > 0) std::memset(part, 0, sizeof(double) * at(ld * (end - begin)));
    };
    if (d.is_symmetric() && d.size >= cleared_by_columns) {  // nothing above the diagonal is read
      for (int j = begin; j < end; ++j) {
        const int row = (j < d.full ? j : j - d.full) & ~7;  // from the line of the diagonal on
        double* column = j < d.full ? parts.top(j) : parts.bottom(j);
        std::memset(column + row, 0, sizeof(double) * at((j < d.full ? d.size : d.size - d.full) - row));
      }
    } else if (begin < d.full) {
      clear(parts.top(begin), parts.lda);
    } else {
      if (!d.is_symmetric()) clear(parts.top(begin), parts.ldu);
      clear(parts.bottom(begin), parts.lds);
    }
    for (tree::FrontId c : tree.children(front(f)))
      if (is_scalar(c) && data(c).is_symmetric() == d.is_symmetric()) add_child(c, d, begin, end);
  }
}

/// Adds to columns [first, last) of the parent the delayed unknowns of the child and its Schur complement; symmetric:
/// only on and below the diagonal.
void Hierarchical::State::add_child(tree::FrontId child, const FrontData& parent, int first, int last) {
  const FrontData& c = data(child);
  const int waiting = c.num_delayed(), delayed = c.delayed_to;
  const Run* runs_end = runs.data() + run_begin[at(child) + 1];
  const Run* runs_begin = runs.data() + run_begin[at(child)];
  const FrontParts from(c.matrix()), to(parent.matrix());
  const bool is_lower = parent.is_symmetric();
  // Column j of the child to column k of the parent: delayed unknowns from row `first_waiting` on, the boundary from
  // row `skip` of `run` on.
  const auto add_column = [&](int j, int k, int first_waiting, const Run* run, int skip) {
    const double *top = from.top(j) + c.pivots, *bottom = from.bottom(j);
    double *to_top = to.top(k), *to_bottom = to.bottom(k) - parent.full;
    for (int i = first_waiting; i < waiting; ++i) to_top[delayed + i] += top[i];
    for (const Run* r = run; r != runs_end; ++r) {
      const int row = parent.delayed_in + r->to;
      double* t = (row < parent.full ? to_top : to_bottom) + row;
      tiles::add_to(r->length - skip, bottom + r->from + skip, t + skip);
      skip = 0;
    }
  };
  for (int j = std::max(0, first - delayed); j < std::min(waiting, last - delayed); ++j)
    add_column(c.pivots + j, delayed + j, is_lower ? j : 0, runs_begin, 0);
  const Run* r = std::partition_point(runs_begin, runs_end,
                                      [&](const Run& run) { return parent.delayed_in + run.to + run.length <= first; });
  for (; r != runs_end && parent.delayed_in + r->to < last; ++r) {
    const int column = parent.delayed_in + r->to;
    for (int j = std::max(0, first - column); j < std::min(r->length, last - column); ++j)
      add_column(c.full + r->from + j, column + j, is_lower ? waiting : 0, is_lower ? r : runs_begin, is_lower ? j : 0);
  }
}

/// A symmetric child of a front that is not: both triangles.
void Hierarchical::State::add_child_both_ways(tree::FrontId child, const FrontData& parent) {
  const FrontData& c = data(child);
  const Run* runs_begin = runs.data() + run_begin[at(child)];
  const Run* runs_end = runs.data() + run_begin[at(child) + 1];
  const FrontParts from(c.matrix()), to(parent.matrix());
  const auto add = [&](int i, int j, double value) {
    (i < parent.full ? to.top(j)[i] : to.bottom(j)[i - parent.full]) += value;
  };
  const auto for_rows = [&](auto&& body) {  // body(row of the child, row of the parent), in order
    for (int i = c.pivots; i < c.pivots + c.num_delayed(); ++i) body(i, c.delayed_to + i - c.pivots);
    for (const Run* r = runs_begin; r != runs_end; ++r)
      for (int i = 0; i < r->length; ++i) body(c.full + r->from + i, parent.delayed_in + r->to + i);
  };
  for_rows([&](int j, int to_j) {
    for_rows([&](int i, int to_i) {
      if (i < j) return;
      const double value = i < c.full ? from.top(j)[i] : from.bottom(j)[i - c.full];
      add(to_i, to_j, value);
      if (i != j) add(to_j, to_i, value);
    });
  });
}

/// += D_r A_e D_c, with the element's blocks at their rows of the front; symmetric: only on and below the diagonal.
void Hierarchical::State::add_element(int position, FrontData& d) {
  const int e = tree.element_order[at(position)];
  const int* rows = tree.scatter.data() + tree.scatter_begin[at(position)];
  const int* blocks = elements.blocks_of(e);
  const int count = elements.num_blocks_of(e), n = elements.size_of(e);
  const ConstElementView matrix = elements.view(e);
  const auto& block_size = elements.graph().block_size;
  const FrontParts parts(d.matrix());
  // If a matrix equals its mirror image, its contiguous rows are used as columns.
  const bool is_contiguous = d.is_symmetric() && matrix.stride == 1;
  for (int q = 0, j0 = 0; q < count; ++q) {
    const int bj = blocks[q], nj = block_size[at(bj)];
    const double* column_scale = scales.column.data() + tree.unknown_begin[at(bj)];
    for (int p = 0, i0 = 0; p < count; ++p) {
      const int bi = blocks[p], ni = block_size[at(bi)], row = d.delayed_in + rows[p];
      const double* row_scale = scales.row.data() + tree.unknown_begin[at(bi)];
      if (!d.is_symmetric() || rows[p] >= rows[q])
        for (int j = 0; j < nj; ++j) {
          const int column = d.delayed_in + rows[q] + j;
          double* to = row < d.full ? parts.top(column) + row : parts.bottom(column) + (row - d.full);
          if (is_contiguous) {
            tiles::add_scaled(ni, row_scale, matrix.first + static_cast<std::int64_t>(j0 + j) * n + i0, column_scale[j],
                              to);
          } else {
            for (int i = 0; i < ni; ++i)
              to[i] += row_scale[i] * matrix[static_cast<std::int64_t>(i0 + i) * n + j0 + j] * column_scale[j];
          }
        }
      i0 += ni;
    }
    j0 += nj;
  }
}

}  // namespace bough::solve
