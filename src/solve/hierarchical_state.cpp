#include "hierarchical_state.hpp"

#include <algorithm>

#include "bough/blocks/at.hpp"
#include "front_storage.hpp"
#include "last_cache.hpp"

namespace bough::solve {

Hierarchical::State::State(const blocks::BlockGraph& graph, const tree::Tree& t, const SolveOptions& o)
    : tree(t),
      options(o),
      lanes(make_lane_plan(graph, t, o.lanes, o.symmetry)),
      elements(graph, t, lanes.element_first, lanes.element_stride, lanes.num_values),
      lane_scales(lanes) {
  const std::size_t n = at(tree.num_unknowns()), num_fronts = at(tree.num_fronts());
  scales.row.assign(n, 1.0);
  scales.diagonal.assign(n, 0.0);
  scales.column.assign(n, 1.0);
  inverse_column.assign(n, 1.0);
  scales.weight.assign(n, 1.0);
  is_constraint = std::make_unique<bool[]>(n);
  for (int b = 0; b < graph.num_blocks(); ++b)
    for (std::int64_t u = tree.unknown_begin[at(b)]; u < tree.unknown_begin[at(b) + 1]; ++u)
      is_constraint[at(u)] = graph.block_kind[at(b)] == blocks::BlockKind::multiplier;
  fronts.resize(num_fronts);
  enlarged.resize(num_fronts);
  symmetry.declared = symmetry.used = options.symmetry;
  vector_begin.assign(1, 0);
  index_begin.assign(1, 0);
  row_begin.assign(1, 0);
  run_begin.assign(1, 0);
  for (tree::FrontId id = 0; id < tree.num_fronts(); ++id) {
    const tree::Front& f = front(id);
    const bool in_lanes = lanes.lane_front[at(id)] >= 0;
    const std::int64_t size = in_lanes ? 0 : f.size();
    vector_begin.push_back(vector_begin.back() + vector_size(size));
    index_begin.push_back(index_begin.back() + (in_lanes ? 0 : 3 * f.num_eliminated));
    row_begin.push_back(row_begin.back() + f.size());
    if (!in_lanes) scalar_fronts.push_back(id);
    add_runs(graph, f);
    run_begin.push_back(static_cast<std::int64_t>(runs.size()));
  }
  for (int e : tree.element_order)
    for (int k = 0, from = 0; k < elements.num_blocks_of(e); ++k) {
      const int length = graph.block_size[at(elements.blocks_of(e)[k])];
      element_runs.push_back({from, tree.scatter[element_runs.size()], length});
      from += length;
    }
  size_factors();
  schur_places = plan_schur(tree, lanes.lane_front, is_symmetric());
  schur_pool.resize(at(schur_places.pool));
  vector_pool.resize(at(vector_begin.back()));
  index_pool.resize(at(index_begin.back()));
  lane_vectors.assign(lanes.unknowns.size(), 0.0);
  lane_tops.assign(at(std::max<std::int64_t>(lanes.top_size, 1) * lanes_wide),
                   0.0);  // tops without unknowns also point into it
  scalar_lanes.assign(lanes.fronts.size(), 0);
  leaving_lanes.assign(lanes.fronts.size(), 0);
  leaves_to_root.assign(num_fronts, 0);
  sizes.resize(lanes.groups.size());
  asymmetries.resize(lanes.groups.size());
  if (options.inertia && num_fronts > 0) {
    const std::size_t full = at(front(tree.num_fronts() - 1).num_eliminated);
    root_copy.entries.reserve(full * full);
    root_copy.d.reserve(2 * full);
    root_copy.indices.reserve(3 * full);
  }
  residual.assign(n, 0.0);
  if (options.check != SolveCheck::none && options.refinement_steps > 0) correction.assign(n, 0.0);
}

void Hierarchical::State::size_factors() {
  factor_begin.assign(1, 0);
  counters.factor_flops = counters.flops_in_lanes = counters.flops_of_packs = 0.0;
  counters.columns_alone = counters.panels_alone = 0.0;
  counters.packs_of_fronts = 0;
  for (tree::FrontId id = 0; id < tree.num_fronts(); ++id) {
    const tree::Front& f = front(id);
    const bool in_lanes = lanes.lane_front[at(id)] >= 0;
    const FrontShape shape(f.size(), f.num_eliminated, is_symmetric());
    factor_begin.push_back(factor_begin.back() + (in_lanes ? 0 : shape.factor_size()));
    const double flops = is_symmetric() ? 0.5 * f.flops : f.flops;
    counters.factor_flops += flops;
    if (in_lanes) {
      counters.flops_in_lanes += flops;
      continue;
    }
    counters.columns_alone += f.num_eliminated;
    counters.panels_alone += static_cast<double>(f.num_eliminated) * f.size();
  }
  for (const LaneFront& f : lanes.fronts) {
    ++counters.packs_of_fronts;
    counters.flops_of_packs += (f.is_symmetric ? 0.5 : 1.0) * tree::elimination_flops(f.eliminated, f.boundary);
  }
  counters.factor_bytes =
      (factor_begin.back() + lanes.factor_size * lanes_wide) * static_cast<std::int64_t>(sizeof(double));
  factor_pool.resize(at(factor_begin.back()));
  // One pack more than there are, since fronts that eliminate nothing have an address as well.
  lane_factors.assign(at((lanes.factor_size + 1) * lanes_wide), 0.0);
  std::int64_t scratch = 0;
  for (const LaneGroup& group : lanes.groups)
    if (group.scratch * lanes_wide > room_of_scratch) scratch += group.scratch * lanes_wide;
  lane_scratch.assign(at(scratch), 0.0);
  group_scratch.assign(lanes.groups.size(), nullptr);
  for (std::size_t g = 0; g < lanes.groups.size(); ++g)
    if (lanes.groups[g].scratch * lanes_wide > room_of_scratch)
      group_scratch[g] = lane_scratch.data() + (scratch -= lanes.groups[g].scratch * lanes_wide);
  constexpr std::size_t second_cache = std::size_t{2} << 20;
  reads_factors_ahead = sizeof(double) * lane_factors.size() > second_cache;
  fronts_are_far = sizeof(double) * factor_pool.size() > second_cache;
  const std::size_t bytes = sizeof(double) * (lane_factors.size() + at(lanes.num_values));
  exceeds_caches = options.near_bytes > 0 ? bytes > at(options.near_bytes) : exceeds_share_of_caches(bytes);
}

/// Unknowns of the rows of a front, and its boundary by runs of adjacent rows of the parent.
void Hierarchical::State::add_runs(const blocks::BlockGraph& graph, const tree::Front& f) {
  int from = 0;
  const std::size_t first = runs.size();
  for (std::int64_t k = f.block_begin; k < f.block_end; ++k) {
    const int b = tree.front_blocks[at(k)], length = graph.block_size[at(b)];
    for (int i = 0; i < length; ++i) row_unknowns.push_back(static_cast<int>(tree.unknown_begin[at(b)]) + i);
    if (k < f.block_begin + f.num_eliminated_blocks) continue;
    const int to = tree.parent_row[at(k)];
    const bool is_split = to == front(f.parent).num_eliminated;  // the parent's boundary is stored in another part
    if (runs.size() > first && runs.back().to + runs.back().length == to && !is_split) {
      runs.back().length += length;
    } else {
      runs.push_back({from, to, length});
    }
    from += length;
  }
}

}  // namespace bough::solve
