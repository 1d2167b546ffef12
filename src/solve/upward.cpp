/// The upward walk of factor(): size, assemble, eliminate.
#include <algorithm>
#include <cstring>

#include "hierarchical_state.hpp"

namespace bough::solve {

namespace {
std::size_t at(std::int64_t i) { return static_cast<std::size_t>(i); }
}  // namespace

void Hierarchical::State::factor_subdomain(tree::SubdomainId s) {
  const tree::Subdomain& sub = tree.subdomains[at(s)];
  for (tree::FrontId f = sub.front_begin; f < sub.front_end; ++f) {
    size_front(f);
    assemble_front(f);
    mark(tree::Stage::assemble);
    eliminate_front(f);
    mark(tree::Stage::eliminate);
  }
  if (options.elimination == Elimination::plain && s != tree.root()) condense_through_flexibility(s);
}

/// Room for the children's delayed unknowns; own memory only if there are any.
void Hierarchical::State::size_front(tree::FrontId f) {
  const tree::Front& shape = front(f);
  FrontData& d = data(f);
  d.delayed_in = 0;
  d.failed = d.allocated = false;
  for (tree::FrontId c : tree.children(shape)) {
    if (!is_scalar(c)) continue;
    d.delayed_in += data(c).num_delayed();
    d.failed = d.failed || data(c).failed;
  }
  if (d.failed) d.delayed_in = 0;
  d.full = d.delayed_in + shape.num_eliminated;
  d.size = d.delayed_in + shape.size();
  d.pivots = 0;
  if (d.delayed_in == 0 && lanes.lane_front[at(f)] < 0) {
    d.a = matrix_pool.data() + matrix_begin[at(f)];
    d.vector = vector_pool.data() + vector_begin[at(f)];
    d.rows = index_pool.data() + index_begin[at(f)];
  } else {
    Enlarged& own = enlarged[at(f)];
    const std::size_t n = at(d.size);
    if (own.a.capacity() < n * n) {  // some room to grow: deficiencies come and go during a run
      own.a.reserve((n + 4) * (n + 4));
      own.vector.reserve(2 * (n + 4));
      own.indices.reserve(3 * at(d.full + 4));
      d.allocated = true;
    }
    own.a.resize(n * n);
    own.vector.resize(2 * n);
    own.indices.resize(3 * at(d.full));
    d.a = own.a.data();
    d.vector = own.vector.data();
    d.rows = own.indices.data();
  }
  d.columns = d.rows + d.full;
  d.row_from = d.columns + d.full;
}

void Hierarchical::State::assemble_front(tree::FrontId f) {
  const tree::Front& shape = front(f);
  FrontData& d = data(f);
  if (d.failed) return;
  if (d.size > 0) std::memset(d.a, 0, sizeof(double) * at(d.size) * at(d.size));
  const int* own = own_unknowns.data() + own_begin[at(f)];
  for (int i = 0; i < d.full; ++i) {
    d.row_from[i] = i;
    if (i >= d.delayed_in) d.rows[i] = d.columns[i] = own[i - d.delayed_in];
  }
  for (int p = shape.element_begin; p < shape.element_end; ++p) add_element(shape, p, d.a, d.size, d.delayed_in);
  int delayed = 0;
  for (tree::FrontId c : tree.children(shape)) {
    if (is_scalar(c)) {
      add_child(c, d, delayed);
    } else {
      add_lane_child(c, d);
    }
  }
}

/// a += D_r A_e D_c, the element's blocks at their rows of the front.
void Hierarchical::State::add_element(const tree::Front&, int position, double* a, int ld, int shift) {
  const int e = tree.element_order[at(position)];
  const int* rows = tree.scatter.data() + tree.scatter_begin[at(position)];
  const int* blocks = elements.blocks_of(e);
  const int count = elements.num_blocks_of(e), n = elements.size_of(e);
  const ConstElementView matrix = elements.view(e);
  const auto& block_size = elements.graph().block_size;
  for (int p = 0, i0 = 0; p < count; ++p) {
    const int bi = blocks[p], ni = block_size[at(bi)];
    const double* row_scale = scales.row.data() + tree.unknown_begin[at(bi)];
    for (int q = 0, j0 = 0; q < count; ++q) {
      const int bj = blocks[q], nj = block_size[at(bj)];
      const double* column_scale = scales.column.data() + tree.unknown_begin[at(bj)];
      double* target = a + (rows[p] + shift) + static_cast<std::int64_t>(rows[q] + shift) * ld;
      for (int j = 0; j < nj; ++j)
        for (int i = 0; i < ni; ++i)
          target[i + static_cast<std::int64_t>(j) * ld] +=
              row_scale[i] * matrix[(i0 + i) * n + j0 + j] * column_scale[j];
      j0 += nj;
    }
    i0 += ni;
  }
}

/// Adds a child's Schur complement: its delayed unknowns to the next free ones of the parent's first rows, its boundary by runs.
void Hierarchical::State::add_child(tree::FrontId child, FrontData& parent, int& delayed) {
  const FrontData& c = data(child);
  const int waiting = c.num_delayed();
  const Run* runs_begin = runs.data() + run_begin[at(child)];
  const Run* runs_end = runs.data() + run_begin[at(child) + 1];
  const auto add_column = [&](const double* from, double* to) {  // both at the top of the full front's column
    for (int i = 0; i < waiting; ++i) to[delayed + i] += from[c.pivots + i];
    for (const Run* r = runs_begin; r != runs_end; ++r) {
      double* t = to + parent.delayed_in + r->to;
      const double* s = from + c.full + r->from;
      for (int i = 0; i < r->length; ++i) t[i] += s[i];
    }
  };
  for (int j = 0; j < waiting; ++j) {
    parent.rows[delayed + j] = c.rows[c.pivots + j];
    parent.columns[delayed + j] = c.columns[c.pivots + j];
    add_column(c.a + static_cast<std::int64_t>(c.pivots + j) * c.size,
               parent.a + static_cast<std::int64_t>(delayed + j) * parent.size);
  }
  for (const Run* r = runs_begin; r != runs_end; ++r)
    for (int j = 0; j < r->length; ++j)
      add_column(c.a + static_cast<std::int64_t>(c.full + r->from + j) * c.size,
                 parent.a + static_cast<std::int64_t>(parent.delayed_in + r->to + j) * parent.size);
  delayed += waiting;
}

void Hierarchical::State::eliminate_front(tree::FrontId f) {
  FrontData& d = data(f);
  if (d.failed) {
    d.pivots = d.full;  // nothing moves up from here
    return;
  }
  FrontMatrix matrix{d.a, d.size, d.full, d.rows, d.columns, d.row_from};
  const bool is_root = f + 1 == tree.num_fronts();
  // At the root the easy pivots go first, then the others by complete pivoting down to what decide_rank() must look at.
  const PivotRule rule{is_root ? std::max(options.pivot_threshold, 0.1) : options.pivot_threshold,
                       is_root ? 1e-2 : options.tiny_pivot};
  d.pivots = eliminate_with_threshold(matrix, rule);
  if (d.pivots >= 0 && is_root) d.pivots = eliminate_completely(matrix, d.pivots, d.full, suspect_pivot);
  if (d.pivots < 0) {
    d.failed = true;
    d.pivots = d.full;
  }
}

}  // namespace bough::solve
