/// Assembly of fronts on the scalar path: children, then elements, scaled where their values are not.
#include <algorithm>
#include <cstring>

#include "bough/blocks/at.hpp"
#include "dense_panel.hpp"
#include "hierarchical_state.hpp"

namespace bough::solve {

namespace {

/// Number of columns that are filled together, so that they stay in the second cache.
constexpr int doubles_in_cache = 1 << 16;
/// Symmetric fronts from this size on are cleared only below the diagonal; for shorter columns this costs more than it
/// saves.
constexpr int cleared_by_columns = 160;
/// Time of reading, adding and writing an entry, in operations of an elimination.
constexpr double flops_of_an_entry = 8.0;

/// A block whose columns are contiguous.
void add_columns(const Source& source, const Move& move, const Target& target) {
  for (int j = 0; j < move.columns; ++j) {
    const int above = move.is_triangle ? j : 0;
    tiles::add_to(move.rows - above, source.first + j * source.column_step + above,
                  target.first + j * target.step + above);
  }
}

/// D_r times a block times D_c. unknown: of the rows of the front.
void add_scaled(const Source& source, const Move& move, const Scales& scales, const int* unknown,
                const Target& target) {
  constexpr int strip = tiles::width;
  double row_scale[strip], column_scale[strip];
  for (int j0 = 0; j0 < move.columns; j0 += strip) {
    const int columns = std::min(strip, move.columns - j0);
    for (int j = 0; j < columns; ++j) column_scale[j] = scales.column[at(unknown[move.column + j0 + j])];
    for (int i0 = move.is_triangle ? j0 : 0; i0 < move.rows; i0 += strip) {
      const int rows = std::min(strip, move.rows - i0);
      for (int i = 0; i < rows; ++i) row_scale[i] = scales.row[at(unknown[move.row + i0 + i])];
      const double* from = source.first + i0 * source.row_step + j0 * source.column_step;
      double* to = target.first + j0 * target.step + i0;
      if (source.column_step == 1 && !move.is_triangle) {
        tiles::add_transposed(rows, columns, row_scale, from, source.row_step, column_scale, to, target.step);
        continue;
      }
      for (int j = 0; j < columns; ++j) {
        const int above = move.is_triangle ? std::max(0, j0 + j - i0) : 0;
        if (above < rows)
          tiles::add_scaled(rows - above, row_scale + above, from + above * source.row_step + j * source.column_step,
                            source.row_step, column_scale[j], to + j * target.step + above);
      }
    }
  }
}

}  // namespace

/// Lists of the contributors of a front: children, then elements.
template <class Visit>
void Hierarchical::State::for_contributors(tree::FrontId f, Visit&& visit) const {
  const tree::Front& shape = front(f);
  int child = 0;
  for (tree::FrontId c : tree.children(shape))
    visit(child++, std::span(runs).subspan(at(run_begin[at(c)]), at(run_begin[at(c) + 1] - run_begin[at(c)])));
  for (int p = shape.element_begin; p < shape.element_end; ++p)
    visit(~(p - shape.element_begin),
          std::span(element_runs)
              .subspan(at(tree.scatter_begin[at(p)]), at(elements.num_blocks_of(tree.element_order[at(p)]))));
}

void Hierarchical::State::assemble_front(tree::FrontId f) {
  const tree::Front& shape = front(f);
  FrontData& d = data(f);
  if (d.failed) return;
  const int* own = row_unknowns.data() + row_begin[at(f)];
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
  const auto fill = [&](int first, int last) {
    const int block = std::max(4, doubles_in_cache / std::max(d.size, 1));
    for (int begin = first; begin < last; begin += block) fill_columns(f, begin, std::min(last, begin + block));
  };
  for_chunks_of_columns(0, d.full, d.size, flops_of_an_entry * d.size, &factor_walker, fill);
  if (d.is_symmetric() || !is_symmetric()) return;
  for (int j = 0; j < d.size; ++j)  // the root, whose rank is determined with exchanges of rows
    for (int i = j + 1; i < d.size; ++i)
      d.a[static_cast<std::ptrdiff_t>(i) * d.lda + j] = d.a[static_cast<std::ptrdiff_t>(j) * d.lda + i];
}

/// Clears columns [first, last), all on one side of `full`, and adds what there is in them.
void Hierarchical::State::fill_columns(tree::FrontId f, int first, int last) {
  const FrontData& d = data(f);
  const FrontParts parts(d.matrix());
  const auto clear = [&](double* part, std::ptrdiff_t ld) {
    if (ld > 0) std::memset(part, 0, sizeof(double) * at(ld * (last - first)));
  };
  if (d.is_symmetric() && d.size >= cleared_by_columns) {  // nothing above the diagonal is read
    for (int j = first; j < last; ++j) {
      const int row = (j < d.full ? j : j - d.full) & ~7;  // from the line of the diagonal on
      double* column = j < d.full ? parts.top(j) : parts.bottom(j);
      std::memset(column + row, 0, sizeof(double) * at((j < d.full ? d.size : d.size - d.full) - row));
    }
  } else if (first < d.full) {
    clear(parts.top(first), parts.lda);
  } else {
    if (!d.is_symmetric()) clear(parts.top(first), parts.ldu);
    clear(parts.bottom(first), parts.lds);
  }
  const int shift = d.delayed_in;
  if (shift > 0) add_delayed(f, first, last);
  for_contributors(f, [&](int contributor, std::span<const Run> of_contributor) {
    for_blocks(contributor, of_contributor, is_symmetric(), first - shift, last - shift, [&](const Move& move) {
      add_block(f, move, target_of<1>(parts, move.row + shift, move.column + shift));
    });
  });
}

/// A block of a child or of an element. Those of children in lanes and of elements are not scaled yet.
void Hierarchical::State::add_block(tree::FrontId f, const Move& move, const Target& target) {
  Source source;
  const std::ptrdiff_t row = move.from_row, column = move.from_column;
  if (move.contributor < 0) {
    const int e = tree.element_order[at(front(f).element_begin + ~move.contributor)];
    const ConstElementView matrix = elements.view(e);
    const std::ptrdiff_t step = matrix.stride, row_step = elements.size_of(e) * step;
    source = is_symmetric() ? Source{matrix.first + column * row_step + row * step, step, row_step}  // its mirror image
                            : Source{matrix.first + row * row_step + column * step, row_step, step};
  } else {
    const tree::FrontId c = tree.children(front(f))[at(move.contributor)];
    if (is_scalar(c)) {
      const FrontData& child = data(c);
      source = {child.s + column * child.lds + row, 1, child.lds};
      return add_columns(source, move, target);
    }
    const LaneFront& child = lanes.fronts[at(lanes.lane_front[at(c)])];
    source = {schur_of(child) + (column * child.boundary + row) * lanes_wide + lanes.lane[at(c)], lanes_wide,
              static_cast<std::ptrdiff_t>(child.boundary) * lanes_wide};
  }
  add_scaled(source, move, scales, row_unknowns.data() + row_begin[at(f)], target);
}

/// Rows and columns of the children's delayed unknowns, which come first.
void Hierarchical::State::add_delayed(tree::FrontId f, int first, int last) {
  const FrontParts parts(data(f).matrix());
  const int shift = data(f).delayed_in;
  for (tree::FrontId c : tree.children(front(f))) {
    if (!is_scalar(c) || data(c).num_delayed() == 0) continue;
    const FrontData& child = data(c);
    const FrontParts from(child.matrix());
    const int delayed = child.num_delayed(), to = child.delayed_to, begin = child.pivots;
    const auto add = [&](const double* entry, std::ptrdiff_t step, const Move& whole) {
      in_columns(whole, first, last, [&](const Move& move) {
        add_columns({entry + move.from_column * step + move.from_row, 1, step}, move,
                    target_of<1>(parts, move.row, move.column));
      });
    };
    add(from.top(begin) + begin, from.lda, {c, 0, 0, to, to, delayed, delayed, is_symmetric()});
    for (std::int64_t k = run_begin[at(c)]; k < run_begin[at(c) + 1]; ++k) {
      const Run& run = runs[at(k)];
      add(from.bottom(begin) + run.from, from.lda, {c, 0, 0, shift + run.to, to, run.length, delayed});
      if (!is_symmetric())
        add(from.top(child.full + run.from) + begin, from.ldu, {c, 0, 0, to, shift + run.to, delayed, run.length});
    }
  }
}

}  // namespace bough::solve
