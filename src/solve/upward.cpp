/// The upward walk of factor(): size, assemble, eliminate.
#include <algorithm>
#include <cstring>

#include "front_storage.hpp"
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
  const bool is_symmetric = this->is_symmetric();
  if (d.delayed_in == 0 && lanes.lane_front[at(f)] < 0) {
    d.vector = vector_pool.data() + vector_begin[at(f)];
    d.rows = index_pool.data() + index_begin[at(f)];
    d.set_parts(FrontShape(d.size, d.full, is_symmetric), factor_pool.data() + factor_begin[at(f)],
                schur_pool.data() + schur_begin[at(f)]);
  } else {
    Enlarged& own = enlarged[at(f)];
    const FrontShape parts(d.size, d.full, is_symmetric);
    const std::size_t doubles = at(parts.factor_size() + parts.s), n = at(d.size);
    if (own.a.capacity() < doubles || own.vector.capacity() < 2 * n) {
      // some room to grow: deficiencies come and go during a run
      const FrontShape room(d.size + 4, d.full + 4, false);
      own.a.reserve(std::max(doubles, at(room.factor_size() + room.s)));
      own.vector.reserve(2 * (n + 4));
      own.indices.reserve(3 * at(d.full + 4));
      d.allocated = true;
    }
    own.a.resize(doubles);
    own.vector.resize(2 * n);
    own.indices.resize(3 * at(d.full));
    d.vector = own.vector.data();
    d.rows = own.indices.data();
    d.set_parts(parts, own.a.data(), own.a.data() + parts.factor_size());
  }
  d.columns = d.rows + d.full;
  d.row_from = d.columns + d.full;
}

void FrontData::set_parts(const FrontShape& shape, double* factor, double* schur) {
  lda = shape.lda;
  ldu = shape.ldu;
  lds = shape.lds;
  a = factor;
  d = shape.is_symmetric ? factor + shape.a : nullptr;
  u = factor + shape.a + shape.d;
  s = schur;
}

void Hierarchical::State::assemble_front(tree::FrontId f) {
  const tree::Front& shape = front(f);
  FrontData& d = data(f);
  if (d.failed) return;
  const auto clear = [](double* part, int ld, int columns) {
    if (columns > 0) std::memset(part, 0, sizeof(double) * at(ld) * at(columns));
  };
  clear(d.a, d.lda, d.full);
  if (!d.is_symmetric()) clear(d.u, d.ldu, d.size - d.full);
  clear(d.s, d.lds, d.size - d.full);
  const int* own = own_unknowns.data() + own_begin[at(f)];
  for (int i = 0; i < d.full; ++i) {
    d.row_from[i] = i;
    if (i >= d.delayed_in) d.rows[i] = d.columns[i] = own[i - d.delayed_in];
  }
  for (int p = shape.element_begin; p < shape.element_end; ++p) add_element(p, d);
  int delayed = 0;
  for (tree::FrontId c : tree.children(shape)) {
    if (is_scalar(c)) {
      add_child(c, d, delayed);
    } else {
      add_lane_child(c, d);
    }
  }
}

/// += D_r A_e D_c, the element's blocks at their rows of the front; symmetric: what is not above the diagonal.
void Hierarchical::State::add_element(int position, FrontData& d) {
  const int e = tree.element_order[at(position)];
  const int* rows = tree.scatter.data() + tree.scatter_begin[at(position)];
  const int* blocks = elements.blocks_of(e);
  const int count = elements.num_blocks_of(e), n = elements.size_of(e);
  const ConstElementView matrix = elements.view(e);
  const auto& block_size = elements.graph().block_size;
  const FrontParts parts(d.matrix());
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
          for (int i = 0; i < ni; ++i)
            to[i] += row_scale[i] * matrix[static_cast<std::int64_t>(i0 + i) * n + j0 + j] * column_scale[j];
        }
      i0 += ni;
    }
    j0 += nj;
  }
}

/// Extend-add of a child's Schur complement and what waits in it; symmetric: what is not above the diagonal.
void Hierarchical::State::add_child(tree::FrontId child, FrontData& parent, int& delayed) {
  const FrontData& c = data(child);
  const int waiting = c.num_delayed();
  const Run* runs_begin = runs.data() + run_begin[at(child)];
  const Run* runs_end = runs.data() + run_begin[at(child) + 1];
  for (int j = 0; j < waiting; ++j) {
    parent.rows[delayed + j] = c.rows[c.pivots + j];
    parent.columns[delayed + j] = c.columns[c.pivots + j];
  }
  if (c.is_symmetric() && !parent.is_symmetric()) {
    add_child_both_ways(c, runs_begin, runs_end, parent, delayed);
    delayed += waiting;
    return;
  }
  const FrontParts from(c.matrix()), to(parent.matrix());
  const bool is_lower = parent.is_symmetric();
  // Column j of the child to column k of the parent: what waits from row `first_waiting` on, the boundary from row `skip` of `run` on.
  const auto add_column = [&](int j, int k, int first_waiting, const Run* run, int skip) {
    const double *top = from.top(j) + c.pivots, *bottom = from.bottom(j);
    double *to_top = to.top(k), *to_bottom = to.bottom(k) - parent.full;
    for (int i = first_waiting; i < waiting; ++i) to_top[delayed + i] += top[i];
    for (const Run* r = run; r != runs_end; ++r) {
      const int row = parent.delayed_in + r->to;
      double* t = (row < parent.full ? to_top : to_bottom) + row;
      const double* b = bottom + r->from;
      for (int i = skip; i < r->length; ++i) t[i] += b[i];
      skip = 0;
    }
  };
  for (int j = 0; j < waiting; ++j) add_column(c.pivots + j, delayed + j, is_lower ? j : 0, runs_begin, 0);
  for (const Run* r = runs_begin; r != runs_end; ++r)
    for (int j = 0; j < r->length; ++j)
      add_column(c.full + r->from + j, parent.delayed_in + r->to + j, is_lower ? waiting : 0, is_lower ? r : runs_begin,
                 is_lower ? j : 0);
  delayed += waiting;
}

/// A symmetric child of a front that is not: both triangles.
void Hierarchical::State::add_child_both_ways(const FrontData& c, const Run* runs_begin, const Run* runs_end,
                                              FrontData& parent, int delayed) {
  const FrontParts from(c.matrix()), to(parent.matrix());
  const auto add = [&](int i, int j, double value) {
    (i < parent.full ? to.top(j)[i] : to.bottom(j)[i - parent.full]) += value;
  };
  const auto for_rows = [&](auto&& body) {  // body(row of the child, row of the parent), in order
    for (int i = c.pivots; i < c.full; ++i) body(i, delayed + i - c.pivots);
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

void Hierarchical::State::eliminate_front(tree::FrontId f) {
  FrontData& d = data(f);
  if (d.failed) {
    d.pivots = d.full;  // nothing moves up from here
    return;
  }
  FrontMatrix matrix = d.matrix();
  const bool is_root = f + 1 == tree.num_fronts();
  // At the root the easy pivots go first, then the others by complete pivoting down to what decide_rank() must look at.
  const PivotRule rule{is_root ? std::max(options.pivot_threshold, 0.1) : options.pivot_threshold,
                       is_root ? 1e-2 : options.tiny_pivot};
  if (d.is_symmetric()) {
    d.pivots = eliminate_symmetric(matrix, {rule.threshold, is_root ? suspect_pivot : rule.least}, &factor_walker);
    if (d.pivots >= 0 && d.pivots < d.full && is_root) {  // the rank is decided on rows and columns apart
      d.d = nullptr;
      d.pivots = 0;
      assemble_front(f);
      matrix = d.matrix();
    }
  }
  if (!d.is_symmetric()) d.pivots = eliminate_with_threshold(matrix, rule, &factor_walker);
  if (d.pivots >= 0 && is_root && !d.is_symmetric())
    d.pivots = eliminate_completely(matrix, d.pivots, d.full, suspect_pivot);
  if (d.pivots < 0) {
    d.failed = true;
    d.pivots = d.full;
  }
}

}  // namespace bough::solve
