/// The upward walk of factor(): sizes fronts and eliminates.
#include <algorithm>

#include "bough/blocks/at.hpp"
#include "front_storage.hpp"
#include "hierarchical_state.hpp"

namespace bough::solve {

void Hierarchical::State::factor_subdomain(tree::SubdomainId s) {
  const tree::Subdomain& sub = tree.subdomains[at(s)];
  for (tree::FrontId f = sub.front_begin; f < sub.front_end; ++f) factor_front(f);
}

void Hierarchical::State::factor_front(tree::FrontId f) {
  size_front(f);
  assemble_front(f);
  mark(tree::Stage::assemble);
  eliminate_front(f);
  mark(tree::Stage::eliminate);
}

/// Makes room for the children's delayed unknowns, in separate memory if there are any.
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
  d.pivots = d.dependent = 0;
  const bool is_symmetric = this->is_symmetric();
  if (d.delayed_in == 0 && lanes.lane_front[at(f)] < 0) {
    d.vector = vector_pool.data() + vector_begin[at(f)];
    d.rows = index_pool.data() + index_begin[at(f)];
    d.set_parts(FrontShape(d.size, d.full, is_symmetric), factor_pool.data() + factor_begin[at(f)], schur_place(f));
  } else {
    Enlarged& own = enlarged[at(f)];
    const FrontShape parts(d.size, d.full, is_symmetric);
    const std::size_t doubles = at(parts.factor_size() + parts.s), n = at(vector_size(d.size));
    if (own.a.capacity() < doubles || own.vector.capacity() < n) {
      // with a reserve, since numbers of delayed pivots vary during a run
      const FrontShape room(d.size + 4, d.full + 4, false);
      own.a.reserve(std::max(doubles, at(room.factor_size() + room.s)));
      own.vector.reserve(at(vector_size(d.size + 4)));
      own.indices.reserve(3 * at(d.full + 4));
      d.allocated = true;
    }
    own.a.resize(doubles);
    own.vector.resize(n);
    own.indices.resize(3 * at(d.full));
    d.vector = own.vector.data();
    d.rows = own.indices.data();
    d.set_parts(parts, own.a.data(), own.a.data() + parts.factor_size());
  }
  d.columns = d.rows + d.full;
  d.row_from = d.columns + d.full;
}

/// Memory of its Schur complement until its parent has been eliminated.
double* Hierarchical::State::schur_place(tree::FrontId f) {
  const tree::FrontId host = schur_places.host[at(f)];
  return (host == tree::none ? schur_pool.data() : factor_pool.data() + factor_begin[at(host)]) +
         schur_places.begin[at(f)];
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

void Hierarchical::State::eliminate_front(tree::FrontId f) {
  FrontData& d = data(f);
  if (d.failed) {
    d.pivots = d.full;  // no unknown is delayed from here
    return;
  }
  FrontMatrix matrix = d.matrix();
  const bool is_root = f + 1 == tree.num_fronts();
  if (is_root && options.inertia) keep_root(d);
  // At the root, large pivots are eliminated first, then the others by complete pivoting down to those that
  // decide_rank() must examine.
  // Smaller pivots of multipliers may be the round-off of dependent rows behind long null vectors: the root takes
  // singular values, which tell.
  constexpr double least_of_multipliers = 1e-9;
  PivotRule rule{is_root ? std::max(options.pivot_threshold, 0.1) : options.pivot_threshold,
                 is_root ? 1e-2 : options.tiny_pivot};
  rule.marked = is_constraint.get();
  rule.least_of_marked = std::max(least_of_multipliers, uncertain_entry());
  if (d.is_symmetric()) {
    d.pivots = eliminate_symmetric(matrix, {rule.threshold, is_root ? suspect_pivot : rule.least}, &factor_walker);
    if (d.pivots >= 0 && d.pivots < d.full && is_root) {  // the rank is found by complete pivoting
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
    return;
  }
  decide_dependent(f);
  note_order(f);
}

/// Where pivots have exchanged nothing, vectors of fronts are gathered and handed to children by runs.
void Hierarchical::State::note_order(tree::FrontId f) {
  FrontData& d = data(f);
  d.rows_in_order = d.columns_in_order = true;
  for (int i = 0; i < d.full; ++i) d.rows_in_order = d.rows_in_order && d.row_from[i] == i;
  const int* own = row_unknowns.data() + row_begin[at(f)];
  for (int i = d.delayed_in; i < d.full; ++i)
    d.columns_in_order = d.columns_in_order && d.columns[i] == own[i - d.delayed_in];
}

}  // namespace bough::solve
