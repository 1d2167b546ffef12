/// Common fronts of the sub-domains of a group: unknowns, elements, children, and the memory of Schur complements.
#include <algorithm>

#include "lane_planner.hpp"

namespace bough::solve {

int LanePlanner::size_of(int element) const {
  int n = 0;
  for (auto k = graph_.element_begin[at(element)]; k < graph_.element_begin[at(element) + 1]; ++k)
    n += graph_.block_size[at(graph_.element_blocks[at(k)])];
  return n;
}

void LanePlanner::add_batch(const ElementBatch& batch, int size) {
  for (int l = 0; l < lanes_wide; ++l) {
    const int e = batch.element[at(l)];
    if (e < 0) continue;
    plan_.element_first[at(e)] = batch.values + (batch.stride == 1 ? 0 : l);
    plan_.element_stride[at(e)] = batch.stride;
  }
  const std::int64_t doubles = static_cast<std::int64_t>(size) * size * batch.stride;
  plan_.num_values = batch.values + (doubles + lanes_wide - 1) / lanes_wide * lanes_wide;  // packs stay aligned
  plan_.batches.push_back(batch);
}

void LanePlanner::add_fronts(LaneGroup& group, tree::Subdomain& node) {
  int count = 0;
  for (tree::SubdomainId s : group.subdomains) count = std::max(count, count_of(s));
  for (int k = 0; k < count; ++k) {
    LaneFront f;
    f.is_symmetric = is_symmetric_;
    f.group = static_cast<int>(plan_.groups.size());
    f.front.fill(tree::none);
    for (std::size_t l = 0; l < group.subdomains.size(); ++l) {
      const tree::FrontId id = front_at(group.subdomains[l], k, count);
      f.front[l] = id;
      if (id == tree::none) continue;
      f.eliminated = std::max(f.eliminated, front(id).num_eliminated);
      f.boundary = std::max(f.boundary, front(id).num_boundary);
      plan_.lane_front[at(id)] = static_cast<int>(plan_.fronts.size());
      plan_.lane[at(id)] = static_cast<std::int8_t>(l);
    }
    add_unknowns(f);
    add_elements(f);
    add_children(f);
    f.is_top = k + 1 == count;
    add_moves(f);
    f.factor = plan_.factor_size;
    plan_.factor_size += f.factor_size();
    node.flops += lanes_wide * cost_of(f.eliminated, f.boundary);
    plan_.fronts.push_back(f);
  }
  place_work(group);
}

void LanePlanner::add_unknowns(LaneFront& f) {
  f.unknown = static_cast<std::int64_t>(plan_.unknowns.size());
  plan_.unknowns.resize(plan_.unknowns.size() + at(lanes_wide * f.eliminated), -1);
  for (int l = 0; l < lanes_wide; ++l) {
    if (f.front[at(l)] == tree::none) {
      f.has_padding = true;
      continue;
    }
    const tree::Front& own = front(f.front[at(l)]);
    f.has_padding = f.has_padding || own.num_eliminated < f.eliminated;
    int row = 0;
    for (int k = 0; k < own.num_eliminated_blocks; ++k) {
      const int b = tree_.front_blocks[at(own.block_begin + k)];
      for (int i = 0; i < graph_.block_size[at(b)]; ++i, ++row)
        plan_.unknowns[at(f.unknown + row * lanes_wide + l)] = static_cast<int>(tree_.unknown_begin[at(b)]) + i;
    }
  }
}

int LanePlanner::common_row(const LaneFront& f, int lane, int row) const {
  const tree::Front& own = front(f.front[at(lane)]);
  return row < own.num_eliminated ? row : f.eliminated + row - own.num_eliminated;
}

void LanePlanner::add_elements(LaneFront& f) {
  f.element_begin = static_cast<int>(plan_.elements.size());
  std::vector<Run> blocks;
  for (int l = 0; l < lanes_wide; ++l) {
    if (f.front[at(l)] == tree::none) continue;
    const tree::Front& own = front(f.front[at(l)]);
    for (int p = own.element_begin; p < own.element_end; ++p) {
      const int e = tree_.element_order[at(p)];
      blocks.clear();
      int from = 0;
      const auto begin = graph_.element_begin[at(e)];
      for (auto k = begin; k < graph_.element_begin[at(e) + 1]; ++k) {
        const int length = graph_.block_size[at(graph_.element_blocks[at(k)])];
        blocks.push_back({from, common_row(f, l, tree_.scatter[at(tree_.scatter_begin[at(p)] + k - begin)]), length});
        from += length;
      }
      find_slot(f, l, blocks).element[at(l)] = e;
    }
  }
  f.element_end = static_cast<int>(plan_.elements.size());
  for (int i = f.element_begin; i < f.element_end; ++i) {
    LaneElement& slot = plan_.elements[at(i)];
    slot.values = plan_.num_values;
    add_batch({.element = slot.element, .values = slot.values, .stride = lanes_wide}, slot.size);
  }
}

LaneElement& LanePlanner::find_slot(const LaneFront& f, int lane, const std::vector<Run>& blocks) {
  for (std::size_t i = at(f.element_begin); i < plan_.elements.size(); ++i) {
    LaneElement& slot = plan_.elements[i];
    if (slot.element[at(lane)] < 0 && std::equal(plan_.runs.begin() + slot.run_begin, plan_.runs.begin() + slot.run_end,
                                                 blocks.begin(), blocks.end()))
      return slot;
  }
  LaneElement slot;
  slot.element.fill(-1);
  slot.run_begin = static_cast<std::int64_t>(plan_.runs.size());
  plan_.runs.insert(plan_.runs.end(), blocks.begin(), blocks.end());
  slot.run_end = static_cast<std::int64_t>(plan_.runs.size());
  for (const Run& block : blocks) slot.size += block.length;
  plan_.elements.push_back(slot);
  return plan_.elements.back();
}

void LanePlanner::add_children(LaneFront& f) {
  struct Draft {
    LaneChild child;
    std::vector<int> to;  ///< row of the parent for every boundary row of the child, -1 where no lane has one
  };
  std::vector<Draft> drafts;
  for (int l = 0; l < lanes_wide; ++l) {
    if (f.front[at(l)] == tree::none) continue;
    for (tree::FrontId c : tree_.children(front(f.front[at(l)]))) {
      const int child = plan_.lane_front[at(c)];
      std::vector<int> to(at(plan_.fronts[at(child)].boundary), -1);
      const tree::Front& own = front(c);
      std::size_t row = 0;
      for (auto k = own.block_begin + own.num_eliminated_blocks; k < own.block_end; ++k)
        for (int i = 0; i < graph_.block_size[at(tree_.front_blocks[at(k)])]; ++i)
          to[row++] = common_row(f, l, tree_.parent_row[at(k)] + i);
      const auto agrees = [&](const Draft& d) {
        if (d.child.front != child || d.child.from[at(l)] >= 0) return false;
        for (std::size_t i = 0; i < to.size(); ++i)
          if (to[i] >= 0 && d.to[i] >= 0 && to[i] != d.to[i]) return false;
        return true;
      };
      auto it = std::find_if(drafts.begin(), drafts.end(), agrees);
      if (it == drafts.end()) {
        Draft draft{.child = {.front = child, .is_identity = false, .from = {}}, .to = to};
        draft.child.from.fill(-1);
        drafts.push_back(std::move(draft));
        it = drafts.end() - 1;
      }
      it->child.from[at(l)] = plan_.lane[at(c)];
      for (std::size_t i = 0; i < to.size(); ++i)
        if (to[i] >= 0) it->to[i] = to[i];
    }
  }
  f.child_begin = static_cast<int>(plan_.children.size());
  for (Draft& d : drafts) {
    d.child.is_identity = true;
    for (int l = 0; l < lanes_wide; ++l)
      d.child.is_identity =
          d.child.is_identity &&
          (d.child.from[at(l)] == l || (d.child.from[at(l)] < 0 && is_empty_lane(plan_.fronts[at(d.child.front)], l)));
    d.child.run_begin = static_cast<std::int64_t>(plan_.runs.size());
    for (std::size_t i = 0; i < d.to.size(); ++i) {
      if (d.to[i] < 0) continue;
      const int from = static_cast<int>(i);
      if (static_cast<std::int64_t>(plan_.runs.size()) > d.child.run_begin && d.to[i] != f.eliminated) {
        Run& last = plan_.runs.back();  // runs end where the boundary begins
        if (last.from + last.length == from && last.to + last.length == d.to[i]) {
          ++last.length;
          continue;
        }
      }
      plan_.runs.push_back({from, d.to[i], 1});
    }
    d.child.run_end = static_cast<std::int64_t>(plan_.runs.size());
    plan_.children.push_back(d.child);
  }
  f.child_end = static_cast<int>(plan_.children.size());
}

void LanePlanner::add_moves(LaneFront& f) {
  moves_.begin(f.size(), f.eliminated);
  for (int c = f.child_begin; c < f.child_end; ++c) moves_.add(c - f.child_begin, plan_.runs_of(plan_.children[at(c)]));
  for (int i = f.element_begin; i < f.element_end; ++i)
    moves_.add(~(i - f.element_begin), plan_.runs_of(plan_.elements[at(i)]));
  f.assembly = moves_.finish();
}

void LanePlanner::place_work(LaneGroup& group) {
  struct Live {
    std::int64_t begin, end;
    int last;  ///< front that reads it
  };
  const int begin = group.front_begin, end = static_cast<int>(plan_.fronts.size());
  std::vector<int> reader(at(end - begin), end);
  for (int i = begin; i < end; ++i)
    for (int c = plan_.fronts[at(i)].child_begin; c < plan_.fronts[at(i)].child_end; ++c)
      if (plan_.children[at(c)].front >= begin) reader[at(plan_.children[at(c)].front - begin)] = i;
  std::vector<Live> live;  // by begin
  std::int64_t most = 0;
  for (int i = begin; i < end; ++i) {
    LaneFront& f = plan_.fronts[at(i)];
    const std::int64_t size = f.schur_size() + f.size();
    if (f.is_top) {
      f.schur = plan_.top_size;
      plan_.top_size += size;
      continue;
    }
    std::erase_if(live, [&](const Live& x) { return x.last < i; });
    std::int64_t place = 0;
    auto it = live.begin();
    for (; it != live.end() && it->begin < place + size; ++it) place = it->end;
    live.insert(it, {place, place + size, reader[at(i - begin)]});
    most = std::max(most, place + size);
    f.schur = place;
  }
  group.scratch = most;
}

}  // namespace bough::solve
