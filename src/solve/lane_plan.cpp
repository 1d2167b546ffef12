#include "lane_plan.hpp"

#include <algorithm>

namespace bough::solve {

namespace {

std::size_t at(std::int64_t i) { return static_cast<std::size_t>(i); }

/// Largest front that goes in lanes: eight of them must stay in the cache nearest to the core but one.
constexpr int largest_in_lanes = 64;
/// A single sub-domain goes through the kernel of eight only while its fronts are so small that their overhead counts most.
constexpr int largest_alone = 24;
/// Lanes go together while the fronts that fit all of them cost at most this much more than those of the larger one.
constexpr double most_padding = 1.35;
constexpr double most_inner_padding = 3.0;

double flops_of(int eliminated, int boundary) {
  const double e = eliminated, n = e + boundary;
  return e * n * n * 2.0 - e * e * n * 2.0 + e * e * e * (2.0 / 3.0) + n * n;
}

class Planner {
 public:
  Planner(const blocks::BlockGraph& graph, const tree::Tree& tree, bool use_lanes, Symmetry symmetry)
      : graph_(graph), tree_(tree), use_lanes_(use_lanes), is_symmetric_(symmetry == Symmetry::symmetric) {}

  LanePlan run() {
    plan_.lane_front.assign(at(tree_.num_fronts()), -1);
    plan_.lane.assign(at(tree_.num_fronts()), 0);
    plan_.group_of_subdomain.assign(at(tree_.num_subdomains()), -1);
    plan_.element_first.assign(at(graph_.num_elements()), 0);
    plan_.element_stride.assign(at(graph_.num_elements()), 1);
    measure_subdomains();
    const int root = form({tree_.root()}, false, 0);
    plan_.walk.subdomains[at(root)].parent = tree::none;
    set_levels();
    return std::move(plan_);
  }

 private:
  const tree::Front& front(tree::FrontId f) const { return tree_.fronts[at(f)]; }
  const tree::Subdomain& subdomain(tree::SubdomainId s) const { return tree_.subdomains[at(s)]; }
  int count_of(tree::SubdomainId s) const { return subdomain(s).front_end - subdomain(s).front_begin; }

  /// Largest front of every subtree, and whether a sub-domain's own fronts are a path.
  void measure_subdomains() {
    largest_.assign(at(tree_.num_subdomains()), 0);
    is_path_.assign(at(tree_.num_subdomains()), 0);
    for (tree::SubdomainId s = 0; s < tree_.num_subdomains(); ++s) {
      bool is_path = true;
      for (tree::FrontId f = subdomain(s).front_begin; f < subdomain(s).front_end; ++f) {
        largest_[at(s)] = std::max(largest_[at(s)], front(f).size());
        if (f + 1 < subdomain(s).front_end) is_path = is_path && front(f).parent == f + 1;
      }
      is_path_[at(s)] = is_path;
      for (tree::SubdomainId c : tree_.children(subdomain(s)))
        largest_[at(s)] = std::max(largest_[at(s)], largest_[at(c)]);
    }
  }

  /// Front of lane s that stands at position k of `count` common fronts, or none. Paths are aligned at their tops.
  tree::FrontId front_at(tree::SubdomainId s, int k, int count) const {
    const int i = k - (count - count_of(s));
    return i < 0 ? tree::none : subdomain(s).front_begin + i;
  }

  bool fits(tree::SubdomainId a, tree::SubdomainId b) const {
    if (tree_.children(subdomain(a)).size() != tree_.children(subdomain(b)).size()) return false;
    const int na = count_of(a), nb = count_of(b), count = std::max(na, nb);
    if (na != nb && !(is_path_[at(a)] && is_path_[at(b)] && subdomain(a).is_leaf())) return false;
    double common = 0.0, own_a = 0.0, own_b = 0.0;
    for (int k = 0; k < count; ++k) {
      const tree::FrontId fa = front_at(a, k, count), fb = front_at(b, k, count);
      int e = 0, bd = 0;
      if (fa != tree::none) {
        e = front(fa).num_eliminated;
        bd = front(fa).num_boundary;
        own_a += flops_of(e, bd);
      }
      if (fb != tree::none) {
        e = std::max(e, front(fb).num_eliminated);
        bd = std::max(bd, front(fb).num_boundary);
        own_b += flops_of(front(fb).num_eliminated, front(fb).num_boundary);
      }
      common += flops_of(e, bd);
      if (na == nb && k + 1 < count &&
          front(fa).parent - subdomain(a).front_begin != front(fb).parent - subdomain(b).front_begin)
        return false;
    }
    // Inner sub-domains are one front each: a poor fit there costs less than to part all that lies below.
    return common <= (subdomain(a).is_leaf() ? most_padding : most_inner_padding) * std::max(own_a, own_b);
  }

  /// Makes the group of these sub-domains and, before it, the groups below. `in_lanes`: the parent's group is.
  int form(std::vector<tree::SubdomainId> subdomains, bool below_lanes, int level) {
    const tree::SubdomainId first = subdomains.front();
    const bool in_lanes = use_lanes_ && first != tree_.root() &&
                          (below_lanes || subdomains.size() > 1 || largest_[at(first)] <= largest_alone);
    std::vector<std::vector<tree::SubdomainId>> classes;
    const std::size_t num_children = tree_.children(subdomain(first)).size();
    for (std::size_t c = 0; c < num_children; ++c)
      for (tree::SubdomainId s : subdomains) place_child(tree_.children(subdomain(s))[c], classes);
    std::vector<int> children;
    for (const auto& members : classes)
      for (std::size_t i = 0; i < members.size(); i += lanes_wide) {
        const std::size_t end = std::min(members.size(), i + lanes_wide);
        children.push_back(
            form({members.begin() + static_cast<std::ptrdiff_t>(i), members.begin() + static_cast<std::ptrdiff_t>(end)},
                 in_lanes, level + 1));
      }
    return close(std::move(subdomains), in_lanes, children);
  }

  void place_child(tree::SubdomainId s, std::vector<std::vector<tree::SubdomainId>>& classes) const {
    if (use_lanes_ && largest_[at(s)] <= largest_in_lanes)
      for (auto& members : classes)
        if (largest_[at(members.front())] <= largest_in_lanes && fits(members.front(), s)) {
          members.push_back(s);
          return;
        }
    classes.push_back({s});
  }

  int close(std::vector<tree::SubdomainId> subdomains, bool in_lanes, const std::vector<int>& children) {
    const int id = static_cast<int>(plan_.groups.size());
    LaneGroup group;
    group.in_lanes = in_lanes;
    group.front_begin = static_cast<int>(plan_.fronts.size());
    group.element_begin = static_cast<int>(plan_.batches.size());
    group.scratch = plan_.scratch_size;
    for (tree::SubdomainId s : subdomains) plan_.group_of_subdomain[at(s)] = id;
    group.subdomains = std::move(subdomains);
    tree::Subdomain node;
    if (in_lanes) {
      add_fronts(group, node);
    } else {
      const tree::Subdomain& own = subdomain(group.subdomains.front());
      for (tree::FrontId f = own.front_begin; f < own.front_end; ++f)
        for (int e : tree_.elements(front(f))) {
          ElementBatch batch{.element = {}, .values = plan_.num_values, .stride = 1};
          batch.element.fill(-1);
          batch.element[0] = e;
          add_batch(batch, size_of(e));
        }
      node.flops = own.flops;
    }
    group.front_end = static_cast<int>(plan_.fronts.size());
    group.element_end = static_cast<int>(plan_.batches.size());
    node.subtree_flops = node.flops;
    node.subtree_begin = id;
    node.child_begin = static_cast<std::int32_t>(plan_.walk.subdomain_children.size());
    for (int c : children) {
      tree::Subdomain& child = plan_.walk.subdomains[at(c)];
      child.parent = id;
      node.subtree_flops += child.subtree_flops;
      node.subtree_begin = std::min(node.subtree_begin, child.subtree_begin);
      plan_.walk.subdomain_children.push_back(c);
    }
    node.child_end = static_cast<std::int32_t>(plan_.walk.subdomain_children.size());
    plan_.walk.subdomains.push_back(node);
    plan_.groups.push_back(std::move(group));
    return id;
  }

  int size_of(int element) const {
    int n = 0;
    for (auto k = graph_.element_begin[at(element)]; k < graph_.element_begin[at(element) + 1]; ++k)
      n += graph_.block_size[at(graph_.element_blocks[at(k)])];
    return n;
  }

  void add_batch(const ElementBatch& batch, int size) {
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

  void add_fronts(LaneGroup& group, tree::Subdomain& node) {
    int count = 0;
    for (tree::SubdomainId s : group.subdomains) count = std::max(count, count_of(s));
    for (int k = 0; k < count; ++k) {
      LaneFront f;
      f.is_symmetric = is_symmetric_;
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
      f.vector = plan_.vector_size;
      plan_.factor_size += f.factor_size();
      plan_.vector_size += f.size();
      node.flops += flops_of(f.eliminated, f.boundary);
      plan_.fronts.push_back(f);
    }
    place_work(group);
  }

  void add_unknowns(LaneFront& f) {
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

  /// Row of the common front for a row of a lane's own.
  int common_row(const LaneFront& f, int lane, int row) const {
    const tree::Front& own = front(f.front[at(lane)]);
    return row < own.num_eliminated ? row : f.eliminated + row - own.num_eliminated;
  }

  void add_elements(LaneFront& f) {
    f.element_begin = static_cast<int>(plan_.elements.size());
    std::vector<Place> places;
    for (int l = 0; l < lanes_wide; ++l) {
      if (f.front[at(l)] == tree::none) continue;
      const tree::Front& own = front(f.front[at(l)]);
      for (int p = own.element_begin; p < own.element_end; ++p) {
        const int e = tree_.element_order[at(p)];
        places.clear();
        const auto begin = graph_.element_begin[at(e)];
        for (auto k = begin; k < graph_.element_begin[at(e) + 1]; ++k)
          places.push_back({common_row(f, l, tree_.scatter[at(tree_.scatter_begin[at(p)] + k - begin)]),
                            graph_.block_size[at(graph_.element_blocks[at(k)])]});
        find_slot(f, l, places).element[at(l)] = e;
      }
    }
    f.element_end = static_cast<int>(plan_.elements.size());
    for (int i = f.element_begin; i < f.element_end; ++i) {
      LaneElement& slot = plan_.elements[at(i)];
      slot.values = plan_.num_values;
      add_batch({.element = slot.element, .values = slot.values, .stride = lanes_wide}, slot.size);
    }
  }

  LaneElement& find_slot(const LaneFront& f, int lane, const std::vector<Place>& places) {
    for (std::size_t i = at(f.element_begin); i < plan_.elements.size(); ++i) {
      LaneElement& slot = plan_.elements[i];
      if (slot.element[at(lane)] >= 0 || slot.place_end - slot.place_begin != static_cast<std::int64_t>(places.size()))
        continue;
      bool same = true;
      for (std::size_t k = 0; k < places.size(); ++k) {
        const Place& p = plan_.places[at(slot.place_begin) + k];
        same = same && p.row == places[k].row && p.length == places[k].length;
      }
      if (same) return slot;
    }
    LaneElement slot;
    slot.element.fill(-1);
    slot.place_begin = static_cast<std::int64_t>(plan_.places.size());
    plan_.places.insert(plan_.places.end(), places.begin(), places.end());
    slot.place_end = static_cast<std::int64_t>(plan_.places.size());
    for (const Place& p : places) slot.size += p.length;
    plan_.elements.push_back(slot);
    return plan_.elements.back();
  }

  void add_children(LaneFront& f) {
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
            d.child.is_identity && (d.child.from[at(l)] == l ||
                                    (d.child.from[at(l)] < 0 && is_empty_lane(plan_.fronts[at(d.child.front)], l)));
      d.child.run_begin = static_cast<std::int64_t>(plan_.runs.size());
      const int first = plan_.fronts[at(d.child.front)].eliminated;
      for (std::size_t i = 0; i < d.to.size(); ++i) {
        if (d.to[i] < 0) continue;
        const int from = first + static_cast<int>(i);
        if (static_cast<std::int64_t>(plan_.runs.size()) > d.child.run_begin && d.to[i] != f.eliminated) {
          LaneRun& last = plan_.runs.back();  // runs end where the boundary begins
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

  static bool is_empty_lane(const LaneFront& f, int lane) { return f.front[at(lane)] == tree::none; }

  /// Every block of every contributor with its place, in fixed order: what comes first is written, what follows is added, what is left is
  /// a gap. So no front is cleared as a whole.
  void add_moves(LaneFront& f) {
    const int n = f.size(), e = f.eliminated, b = f.boundary;
    std::vector<char> reached(at(static_cast<std::int64_t>(n) * n), 0);
    f.move_begin = static_cast<int>(plan_.moves.size());
    f.gap_begin = static_cast<int>(plan_.gaps.size());
    const auto place = [&](LaneMove& move, int row, int column) {
      move.to_schur = row >= e && column >= e;
      if (column < e) {
        move.target = static_cast<std::int64_t>(column) * n + row;
        move.target_step = n;
      } else if (row < e) {
        move.target = static_cast<std::int64_t>(e) * n + static_cast<std::int64_t>(column - e) * e + row;
        move.target_step = e;
      } else {
        move.target = static_cast<std::int64_t>(column - e) * b + row - e;
        move.target_step = b;
      }
    };
    const auto has_place = [&](int i, int j) { return !is_symmetric_ || i >= j; };
    const auto fill_gaps = [&](int row, int column, int rows, int columns) {
      for (int j = column; j < column + columns; ++j)
        for (int i = row; i < row + rows;) {
          if (!has_place(i, j) || reached[at(static_cast<std::int64_t>(j) * n + i)] != 0) {
            ++i;
            continue;
          }
          LaneMove where;
          place(where, i, j);
          const bool above = i < e && j >= e;  // U12 and the Schur complement do not lie next to each other
          int count = 0;
          for (; i < row + rows && reached[at(static_cast<std::int64_t>(j) * n + i)] == 0 && !(above && i == e);
               ++i, ++count)
            reached[at(static_cast<std::int64_t>(j) * n + i)] = 1;
          plan_.gaps.push_back({where.target, count, where.to_schur});
        }
    };
    const auto add = [&](LaneMove move, int row, int column) {
      if (is_symmetric_ && row < column) return;  // blocks are the same or apart
      move.is_triangle = is_symmetric_ && row == column;
      place(move, row, column);
      int already = 0, places = 0;
      for (int j = column; j < column + move.columns; ++j)
        for (int i = row; i < row + move.rows; ++i)
          if (has_place(i, j)) {
            ++places;
            already += reached[at(static_cast<std::int64_t>(j) * n + i)];
          }
      move.is_first = already == 0;
      if (already > 0 && already < places) fill_gaps(row, column, move.rows, move.columns);
      for (int j = column; j < column + move.columns; ++j)
        for (int i = row; i < row + move.rows; ++i) reached[at(static_cast<std::int64_t>(j) * n + i)] = 1;
      plan_.moves.push_back(move);
    };
    for (int c = f.child_begin; c < f.child_end; ++c) {
      const LaneChild& child = plan_.children[at(c)];
      const LaneFront& from = plan_.fronts[at(child.front)];
      for (auto q = child.run_begin; q < child.run_end; ++q)
        for (auto p = child.run_begin; p < child.run_end; ++p) {
          const LaneRun &rows = plan_.runs[at(p)], &columns = plan_.runs[at(q)];
          add({.source = static_cast<std::int64_t>(columns.from - from.eliminated) * from.boundary + rows.from -
                         from.eliminated,
               .rows = rows.length,
               .columns = columns.length,
               .row_step = 1,
               .column_step = from.boundary,
               .child = c},
              rows.to, columns.to);
        }
    }
    for (int i = f.element_begin; i < f.element_end; ++i) {
      const LaneElement& element = plan_.elements[at(i)];
      int row = 0;
      for (auto p = element.place_begin; p < element.place_end; ++p) {
        int column = 0;
        for (auto q = element.place_begin; q < element.place_end; ++q) {
          add({.source = element.values / lanes_wide + static_cast<std::int64_t>(row) * element.size + column,
               .rows = plan_.places[at(p)].length,
               .columns = plan_.places[at(q)].length,
               .row_step = element.size,
               .column_step = 1},
              plan_.places[at(p)].row, plan_.places[at(q)].row);
          column += plan_.places[at(q)].length;
        }
        row += plan_.places[at(p)].length;
      }
    }
    fill_gaps(0, 0, n, n);
    f.move_end = static_cast<int>(plan_.moves.size());
    f.gap_end = static_cast<int>(plan_.gaps.size());
  }

  /// Schur complements live until their parent is assembled: first fit in the group's scratch. The top lasts.
  void place_work(LaneGroup& group) {
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
      const std::int64_t size = static_cast<std::int64_t>(f.boundary) * f.boundary;
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
      f.schur = group.scratch + place;
    }
    plan_.scratch_size += most;
  }

  void set_levels() {
    for (auto s = plan_.walk.subdomains.rbegin(); s != plan_.walk.subdomains.rend(); ++s)
      s->level = s->parent == tree::none ? 0 : plan_.walk.subdomains[at(s->parent)].level + 1;
  }

  const blocks::BlockGraph& graph_;
  const tree::Tree& tree_;
  bool use_lanes_, is_symmetric_;
  std::vector<int> largest_;
  std::vector<char> is_path_;
  LanePlan plan_;
};

}  // namespace

LanePlan make_lane_plan(const blocks::BlockGraph& graph, const tree::Tree& tree, bool use_lanes, Symmetry symmetry) {
  return Planner(graph, tree, use_lanes, symmetry).run();
}

}  // namespace bough::solve
