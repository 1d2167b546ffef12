/// Visits of groups: eight sub-domains in lockstep.
#include <algorithm>
#include <cmath>
#include <cstring>

#include "bough/blocks/at.hpp"
#include "hierarchical_state.hpp"

namespace bough::solve {

void Hierarchical::State::factor_group(int index, const VisitWork& before) {
  const LaneGroup& group = lanes.groups[at(index)];
  if (before) before(index);
  mark(tree::Stage::evaluate);
  asymmetries[at(index)] = {};
  if (group.in_lanes) return with_scratch(index, [&] { factor_lanes(index); });
  for (int b = group.element_begin; compares_triangles() && b < group.element_end; ++b)
    check_element_symmetric(index, lanes.batches[at(b)].element[0]);
  factor_subdomain(group.subdomains.front());
  if (visit_rhs == nullptr || group.subdomains.front() == tree.root()) return;
  forward_group(index, true);
  mark(tree::Stage::forward);
}

/// If factors do not fit into any cache, a front is eliminated in separate memory and then written past the caches
/// while the next one is eliminated. Eliminated in place, its memory would be read before it is written, which is half
/// of the traffic.
void Hierarchical::State::factor_lanes(int index) {
  const LaneGroup& group = lanes.groups[at(index)];
  constexpr std::int64_t room = 1 << 11;  // packs
  alignas(64) double aside[2][room * lanes_wide];
  Transfers transfers;
  for (int k = group.front_begin; k < group.front_end; ++k) {
    const LaneFront& f = lanes.fronts[at(k)];
    const bool is_aside = exceeds_caches && f.factor_size() <= room;
    double* factor = is_aside ? aside[k % 2] : factor_of(f);
    factor_lane_front(k, factor, transfers);
    transfers.finish();
    if (is_aside) transfers.write(factor, f.factor_size(), factor_of(f));
  }
  transfers.finish();
  if (exceeds_caches) Transfers::end_writes();
}

/// Prefetches the input of the next front of an upward walk: if a factorization does not fit into the caches, waiting
/// for memory would take half of its time.
void Hierarchical::State::fetch_front(int index, Transfers& transfers) {
  const LaneFront& f = lanes.fronts[at(index)];
  if (f.is_symmetric && trusts_symmetry) {  // one triangle
    for (const Move& move : lanes.lists.moves_of(f.assembly)) {
      if (move.contributor >= 0) continue;
      const Source source = source_of(f, move);
      for (int row = 0; row < move.rows; ++row)
        transfers.fetch(source.first + row * source.row_step * lanes_wide, move.is_triangle ? row + 1 : move.columns);
    }
  } else {
    for (int i = f.element_begin; i < f.element_end; ++i) {
      const LaneElement& element = lanes.elements[at(i)];
      transfers.fetch(elements.values() + element.values, static_cast<std::int64_t>(element.size) * element.size);
    }
  }
  transfers.fetch(lane_scales.row(index), f.size() + f.eliminated);
  if (visit_rhs == nullptr) return;
  transfers.fetch(lane_vectors.data() + f.unknown, f.eliminated);
  const int* unknown = lanes.unknowns.data() + f.unknown;
  transfers.fetch(reinterpret_cast<const double*>(unknown + f.eliminated * lanes_wide),
                  f.eliminated / 2 + 1);  // of the front after it
  for (int l = 0; l < lanes_wide; ++l)
    if (unknown[l] >= 0) __builtin_prefetch(visit_rhs + unknown[l]);
}

/// The same for the substitutions of a solution: the parts of a front's factor in the order in which they are read, its
/// vector, and the unknowns that it is gathered from or scattered to.
void Hierarchical::State::prefetch_factor(int index, bool downward) const {
  const LaneFront& f = lanes.fronts[at(index)];
  const double* factor = lane_factors.data() + f.factor * lanes_wide;
  const std::int64_t n = f.size(), e = f.eliminated;
  prefetch_packs(lane_vectors.data() + f.unknown, f.eliminated);
  const int* unknown = lanes.unknowns.data() + f.unknown;
  const double* whole = downward ? x : visit_rhs;
  for (int l = 0; l < lanes_wide; ++l)
    if (unknown[l] >= 0) __builtin_prefetch(whole + unknown[l]);
  if (f.is_symmetric || !downward) return prefetch_packs(factor, static_cast<int>(n * e));
  prefetch_packs(factor + n * e * lanes_wide, static_cast<int>(e * f.boundary));
  for (std::int64_t k = e; k-- > 0;) prefetch_packs(factor + k * n * lanes_wide, static_cast<int>(k + 1));
}

/// Checks the element matrices of a front just before they are assembled: values that are symmetric once need not
/// remain symmetric.
void Hierarchical::State::check_front_symmetric(int index) {
  const LaneFront& f = lanes.fronts[at(index)];
  for (int i = f.element_begin; i < f.element_end; ++i) {
    const LaneElement& element = lanes.elements[at(i)];
    const double most = largest_asymmetry_lanes(elements.values() + element.values, element.size,
                                                lanes.runs_of(element), lane_scales.row(index));
    if (!Asymmetry::shows(most)) continue;
    for (int e : element.element)
      if (e >= 0) check_element_symmetric(f.group, e);
  }
}

void Hierarchical::State::check_element_symmetric(int group, int element) {
  Asymmetry& found = asymmetries[at(group)];
  const double difference = elements.asymmetry_of(element, scales);
  if (found.element < 0 && Asymmetry::shows(difference)) found = {element, difference};
}

/// while_factoring: other visits may be factoring their fronts, so only fronts of this one are prefetched.
void Hierarchical::State::forward_group(int index, bool while_factoring) {
  const LaneGroup& group = lanes.groups[at(index)];
  if (group.in_lanes)
    return with_scratch(index, [&] {
      for (int f = group.front_begin; f < group.front_end; ++f) {
        if (reads_factors_ahead && f + 1 < static_cast<int>(lanes.fronts.size())) prefetch_factor(f + 1, false);
        forward_lane_front(f, factor_of(lanes.fronts[at(f)]));
      }
    });
  const tree::Subdomain& sub = tree.subdomains[at(group.subdomains.front())];
  const tree::FrontId last = while_factoring ? sub.front_end - 1 : tree.num_fronts() - 1;
  for (tree::FrontId f = sub.front_begin; f < sub.front_end; ++f) {
    if (fronts_are_far && f < last) prefetch_front(f + 1);
    forward_front(f);
  }
}

void Hierarchical::State::backward_group(int index) {
  const LaneGroup& group = lanes.groups[at(index)];
  if (group.in_lanes)
    return with_scratch(index, [&] {
      for (int f = group.front_end; f-- > group.front_begin;) backward_lane_front(f);
    });
  const tree::Subdomain& s = tree.subdomains[at(group.subdomains.front())];
  for (tree::FrontId f = s.front_end; f-- > s.front_begin;) {
    if (fronts_are_far && f > 0) prefetch_front(f - 1);
    backward_front(f);
    hand_down(f);
  }
}

/// Factors a front, and condenses the right-hand side of the walk if there is one. factor: memory of the factor.
/// transfers: done meanwhile, together with the prefetches for the next front.
void Hierarchical::State::factor_lane_front(int index, double* factor, Transfers& transfers) {
  const LaneFront& f = lanes.fronts[at(index)];
  const int n = f.size(), e = f.eliminated;
  double* schur = schur_of(f);
  if (exceeds_caches) {
    if (index + 1 < static_cast<int>(lanes.fronts.size())) fetch_front(index + 1, transfers);
    transfers.spread(f.assembly.move_end - f.assembly.move_begin + elimination_steps(n, e));
  }
  if (compares_triangles()) check_front_symmetric(index);
  LaneSet& leaving = leaving_lanes[at(index)];
  LaneSet alone = static_cast<LaneSet>(lanes_to_leave(f) | leaving);
  unsigned present = 0;
  for (int l = 0; l < lanes_wide; ++l) present |= f.front[at(l)] != tree::none ? 1u << l : 0u;
  if ((alone & present) == present) {
    factor_lanes_alone(index, factor, alone);
    return;
  }
  const FrontParts parts(factor, n * lanes_wide, factor + static_cast<std::ptrdiff_t>(n) * e * lanes_wide,
                         e * lanes_wide, schur, f.boundary * lanes_wide, n, e);
  for (const Gap& gap : lanes.lists.gaps_of(f.assembly)) {
    double* first = target_of<lanes_wide>(parts, gap.row, gap.column).first;
    std::memset(first, 0, sizeof(double) * lanes_wide * at(gap.rows));
  }
  for (const Move& move : lanes.lists.moves_of(f.assembly)) {
    transfers.step();
    move_block(source_of(f, move), move, target_of<lanes_wide>(parts, move.row, move.column));
  }
  if (f.has_padding)
    for (int k = 0; k < e * lanes_wide; ++k)
      if (lanes.unknowns[at(f.unknown + k)] < 0)
        factor[static_cast<std::int64_t>(k / lanes_wide) * (n + 1) * lanes_wide + k % lanes_wide] = 1.0;
  if (alone != 0) neutralise_lanes(factor, schur, n, e, alone, symmetry.used);
  mark(tree::Stage::assemble);
  const PivotRule rule{options.pivot_threshold, options.tiny_pivot};
  const auto eliminate = f.is_symmetric ? eliminate_lanes_symmetric : eliminate_lanes;
  const LaneSet refused =
      eliminate(factor, schur, n, e, lane_scales.row(index), lane_scales.inverse_column(f, index), rule, transfers);
  alone = static_cast<LaneSet>(alone | refused);
  scalar_lanes[at(index)] = alone;
  leave_lanes(index, factor, alone);
}

/// The block of a move in the matrices of an element or in the Schur complements of a child, in packs.
Source Hierarchical::State::source_of(const LaneFront& f, const Move& move) {
  if (move.contributor < 0) {
    const LaneElement& element = lanes.elements[at(f.element_begin + ~move.contributor)];
    return {elements.values() + element.values +
                (static_cast<std::ptrdiff_t>(move.from_row) * element.size + move.from_column) * lanes_wide,
            element.size, 1};
  }
  const LaneChild& child = lanes.children[at(f.child_begin + move.contributor)];
  const LaneFront& from = lanes.fronts[at(child.front)];
  return {schur_of(from) + (static_cast<std::ptrdiff_t>(move.from_column) * from.boundary + move.from_row) * lanes_wide,
          1, from.boundary, child.is_identity ? nullptr : child.from.data()};
}

/// All lanes leave: the front is an identity in each of them.
void Hierarchical::State::factor_lanes_alone(int index, double* factor, LaneSet alone) {
  const LaneFront& f = lanes.fronts[at(index)];
  std::memset(factor, 0, sizeof(double) * lanes_wide * at(f.factor_size()));
  std::memset(schur_of(f), 0, sizeof(double) * lanes_wide * at(f.schur_size()));
  for (int k = 0; k < f.eliminated; ++k)
    std::fill_n(factor + static_cast<std::int64_t>(k) * (f.size() + 1) * lanes_wide, lanes_wide, 1.0);
  scalar_lanes[at(index)] = alone;
  mark(tree::Stage::assemble);
  leave_lanes(index, factor, alone);
}

/// Factors lanes by themselves. One with dependent rows does not try to stay in the next factorization in these scales.
void Hierarchical::State::leave_lanes(int index, const double* factor, LaneSet alone) {
  LaneSet& leaving = leaving_lanes[at(index)];
  for (int l = 0; alone != 0 && l < lanes_wide; ++l) {
    if ((alone >> l & 1) == 0) continue;
    factor_lane_alone(index, l);
    const FrontData& d = data(lanes.fronts[at(index)].front[at(l)]);
    const auto lane = static_cast<LaneSet>(1u << l);
    leaving = static_cast<LaneSet>(d.dependent > 0 ? leaving | lane : leaving & ~lane);
  }
  mark(tree::Stage::eliminate);
  if (visit_rhs == nullptr) return;
  forward_lane_front(index, factor);
  mark(tree::Stage::forward);
}

/// Adds the results of an upward walk in the boundaries of the children.
void Hierarchical::State::add_children_vectors(const LaneFront& f, double* v) {
  for (int c = f.child_begin; c < f.child_end; ++c) {
    const LaneChild& child = lanes.children[at(c)];
    const LaneFront& from = lanes.fronts[at(child.front)];
    const double* g = vector_of(from) + from.eliminated * lanes_wide;
    for (const Run& rows : lanes.runs_of(child)) {
      if (child.is_identity) {
        add_packs(g + rows.from * lanes_wide, rows.length, v + rows.to * lanes_wide);
      } else {
        add_packs(g + rows.from * lanes_wide, rows.length, v + rows.to * lanes_wide, child.from.data());
      }
    }
  }
}

void Hierarchical::State::forward_lane_front(int index, const double* factor) {
  const LaneFront& f = lanes.fronts[at(index)];
  double* v = vector_of(f);
  const int* unknown = lanes.unknowns.data() + f.unknown;
  if (f.has_padding) {
    for (int k = 0; k < f.eliminated * lanes_wide; ++k) v[k] = unknown[k] < 0 ? 0.0 : visit_rhs[unknown[k]];
  } else {
    for (int k = 0; k < f.eliminated * lanes_wide; ++k) v[k] = visit_rhs[unknown[k]];
  }
  std::fill_n(v + f.eliminated * lanes_wide, f.boundary * lanes_wide, 0.0);
  add_children_vectors(f, v);
  forward_lanes(factor, f.size(), f.eliminated, v);
  std::copy_n(v, f.eliminated * lanes_wide, lane_vectors.data() + f.unknown);
  const LaneSet alone = scalar_lanes[at(index)];
  for (int l = 0; alone != 0 && l < lanes_wide; ++l) {
    if ((alone >> l & 1) == 0) continue;
    const tree::FrontId id = f.front[at(l)];
    forward_front(id);
    const FrontData& d = data(id);
    for_boundary(id, [&](int i, std::size_t u) {
      v[(f.eliminated + i) * lanes_wide + l] = d.vector[d.full + i] / scales.row[u];
    });
  }
}

void Hierarchical::State::backward_lane_front(int index) {
  const LaneFront& f = lanes.fronts[at(index)];
  double* v = vector_of(f);
  std::copy_n(lane_vectors.data() + f.unknown, f.eliminated * lanes_wide, v);
  if (reads_factors_ahead && index > 0) prefetch_factor(index - 1, true);
  (f.is_symmetric ? backward_lanes_symmetric : backward_lanes)(lane_factors.data() + f.factor * lanes_wide, f.size(),
                                                               f.eliminated, v);
  const int* unknown = lanes.unknowns.data() + f.unknown;
  const LaneSet alone = scalar_lanes[at(index)];
  if (alone == 0 && !f.has_padding) {
    for (int k = 0; k < f.eliminated * lanes_wide; ++k) x[at(unknown[k])] = v[k];
  } else {
    for (int k = 0; k < f.eliminated * lanes_wide; ++k)
      if (unknown[k] >= 0 && (alone >> (k % lanes_wide) & 1) == 0) x[at(unknown[k])] = v[k];
    for (int l = 0; l < lanes_wide; ++l)
      if ((alone >> l & 1) != 0) {
        backward_front(f.front[at(l)]);
        fill_lane_vector(f.front[at(l)], true);
      }
  }
  for (int c = f.child_begin; c < f.child_end; ++c) {
    const LaneChild& child = lanes.children[at(c)];
    const LaneFront& below = lanes.fronts[at(child.front)];
    double* to = vector_of(below) + below.eliminated * lanes_wide;
    for (const Run& rows : lanes.runs_of(child)) {
      if (child.is_identity) {
        std::memcpy(to + rows.from * lanes_wide, v + rows.to * lanes_wide,
                    sizeof(double) * lanes_wide * at(rows.length));
      } else {
        for (int i = 0; i < rows.length; ++i)
          for (int l = 0; l < lanes_wide; ++l)
            if (child.from[at(l)] >= 0)
              to[(rows.from + i) * lanes_wide + child.from[at(l)]] = v[(rows.to + i) * lanes_wide + l];
      }
    }
  }
}

/// Left vectors, for null spaces: gathers the boundary from `left`, unscaled, and writes its own part there.
void Hierarchical::State::backward_left_lane_front(int index, std::vector<double>& left) {
  const LaneFront& f = lanes.fronts[at(index)];
  alignas(64) double v[most_lane_rows * lanes_wide];
  std::memset(v, 0, sizeof(double) * lanes_wide * at(f.size()));
  for (int l = 0; l < lanes_wide; ++l)
    if (f.front[at(l)] != tree::none)
      for_boundary(f.front[at(l)], [&](int i, std::size_t u) { v[(f.eliminated + i) * lanes_wide + l] = left[u]; });
  backward_left_lanes(lane_factors.data() + f.factor * lanes_wide, f.size(), f.eliminated, v);
  for (int k = 0; k < f.eliminated * lanes_wide; ++k) {
    const int u = lanes.unknowns[at(f.unknown + k)];
    if (u >= 0 && (scalar_lanes[at(index)] >> (k % lanes_wide) & 1) == 0) left[at(u)] = v[k];
  }
}

}  // namespace bough::solve
