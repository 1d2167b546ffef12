#include <algorithm>
#include <stdexcept>
#include <utility>

#include "adjacency.hpp"
#include "bough/blocks/at.hpp"
#include "bough/tree/tree.hpp"
#include "dissect.hpp"
#include "quotient.hpp"

namespace bough::tree {

namespace {

void require(bool condition, const char* rule) {
  if (!condition) throw std::invalid_argument(std::string("make_tree: ") + rule);
}

void require_consistent(const blocks::BlockGraph& graph) {
  require(graph.block_kind.size() == graph.block_size.size(), "every block has a size and a kind");
  require(!graph.element_begin.empty() && graph.element_begin.front() == 0 &&
              graph.element_begin.back() == static_cast<std::int64_t>(graph.element_blocks.size()),
          "element_begin starts at 0 and ends at the number of element_blocks");
  for (int n : graph.block_size) require(n >= 1, "every block has at least one unknown");
  std::vector<int> last(graph.block_size.size(), -1);
  for (int e = 0; e < graph.num_elements(); ++e) {
    require(graph.element_begin[at(e)] <= graph.element_begin[at(e) + 1], "element_begin does not descend");
    for (auto k = graph.element_begin[at(e)]; k < graph.element_begin[at(e) + 1]; ++k) {
      const int b = graph.element_blocks[at(k)];
      require(b >= 0 && b < graph.num_blocks(), "element blocks exist");
      require(last[at(b)] != e, "no block twice in one element");
      last[at(b)] = e;
    }
  }
}

/// Makes the tree from the dissection: eliminates part by part, then numbers the fronts and lays them out.
class Builder {
 public:
  Builder(const blocks::BlockGraph& graph, const TreeOptions& options)
      : graph_(graph),
        in_lockstep_(options.in_lockstep),
        adjacency_(graph),
        dissection_(dissect(adjacency_, options)),
        quotient_(adjacency_) {}

  Tree run() {
    place_blocks();
    choose_sweeps();
    eliminate_all();
    number_fronts();
    sort_boundaries();
    lay_out();
    sum_flops();
    tree_.method = dissection_.method;
    return std::move(tree_);
  }

 private:
  /// The part of a block is the lowest one that holds all its elements.
  void place_blocks() {
    const auto& parts = dissection_.parts;
    std::vector<int> part_of_element(at(graph_.num_elements()), -1);
    for (std::size_t p = 0; p < parts.size(); ++p)
      for (int e : parts[p].elements) part_of_element[at(e)] = static_cast<int>(p);
    motion_of_part_.resize(parts.size());
    for (int b = 0; b < graph_.num_blocks(); ++b) {
      if (!adjacency_.is_motion(b)) continue;
      int p = -1;
      for (int e : adjacency_.elements_of(b)) {
        int q = part_of_element[at(e)];
        if (p < 0) p = q;
        while (p != q) (p < q ? p : q) = parts[at(std::min(p, q))].parent;  // postorder: the parent is the larger
      }
      motion_of_part_[at(p < 0 ? static_cast<int>(parts.size()) - 1 : p)].push_back(b);
    }
  }

  /// A leaf whose interior blocks are a path, in the order of a sweep along the chain it belongs to.
  struct Path {
    bool exists = false, first_is_held = false, last_is_held = false;  ///< held: by a block outside
    std::vector<int> blocks;
  };

  /// The path that interior blocks form, or none. Chains run towards larger ids of the blocks where they are cut.
  Path find_path(const std::vector<int>& interior) const {
    std::vector<std::vector<int>> next(interior.size());
    std::vector<int> outside(interior.size(), -1);
    for (std::size_t i = 0; i < interior.size(); ++i)
      for (int e : adjacency_.elements_of(interior[i]))
        for (int b : adjacency_.blocks_of(e)) {
          if (!adjacency_.is_motion(b) || b == interior[i]) continue;
          const auto it = std::lower_bound(interior.begin(), interior.end(), b);
          if (it == interior.end() || *it != b) {
            if (outside[i] >= 0 && outside[i] != b) return {};
            outside[i] = b;
          } else if (std::find(next[i].begin(), next[i].end(), it - interior.begin()) == next[i].end()) {
            next[i].push_back(static_cast<int>(it - interior.begin()));
          }
        }
    std::vector<int> ends;
    for (std::size_t i = 0; i < interior.size(); ++i) {
      if (next[i].size() > 2 || next[i].empty() || (next[i].size() == 2 && outside[i] >= 0)) return {};
      if (next[i].size() == 1) ends.push_back(static_cast<int>(i));
    }
    if (ends.size() != 2) return {};
    const auto low = [&](int end) { return outside[at(end)] >= 0 ? outside[at(end)] : interior[at(end)]; };
    if (low(ends[0]) > low(ends[1])) std::swap(ends[0], ends[1]);
    Path path{.exists = true,
              .first_is_held = outside[at(ends[0])] >= 0,
              .last_is_held = outside[at(ends[1])] >= 0,
              .blocks = {}};
    for (int i = ends[0], before = -1; i >= 0;) {
      path.blocks.push_back(interior[at(i)]);
      int following = -1;
      for (int k : next[at(i)])
        if (k != before) following = k;
      before = i;
      i = following;
    }
    path.exists = path.blocks.size() == interior.size();
    return path;
  }

  /// Leaves of a chain are swept from their first block to their last, those at the two ends of the chain in the same
  /// way as the inner ones. All leaves are then alike and can be factored in lockstep, where the few additional
  /// operations in two of them cost nothing. For that purpose the free end of the chain is eliminated with the
  /// separator above. If most leaves are held at one end only (arms of a star), minimum degree sweeps them without
  /// fill.
  void choose_sweeps() {
    constexpr std::size_t shortest = 3;
    constexpr int least_leaves = 6;
    const auto& parts = dissection_.parts;
    is_swept_.assign(parts.size(), 0);
    std::vector<Path> paths(parts.size());
    int between = 0, ends = 0;
    for (std::size_t p = 0; p < parts.size(); ++p) {
      if (!parts[p].is_subdomain || !parts[p].is_terminal() || motion_of_part_[p].size() < shortest) continue;
      std::sort(motion_of_part_[p].begin(), motion_of_part_[p].end());
      paths[p] = find_path(motion_of_part_[p]);
      if (!paths[p].exists) continue;
      between += paths[p].first_is_held && paths[p].last_is_held ? 1 : 0;
      ends += paths[p].first_is_held != paths[p].last_is_held ? 1 : 0;
    }
    if (between < least_leaves || between < 3 * ends) return;
    for (std::size_t p = 0; p < parts.size(); ++p) {
      if (!paths[p].exists) continue;
      is_swept_[p] = 1;
      motion_of_part_[p] = std::move(paths[p].blocks);
      if (!paths[p].first_is_held || paths[p].last_is_held || parts[p].parent < 0) continue;
      motion_of_part_[at(parts[p].parent)].push_back(motion_of_part_[p].back());
      motion_of_part_[p].pop_back();
    }
  }

  void eliminate_all() {
    const auto& parts = dissection_.parts;
    for (std::size_t p = 0; p < parts.size(); ++p) {
      const Part& part = parts[p];
      const auto& motion = motion_of_part_[p];
      if (part.is_subdomain && !part.is_terminal() && parts[at(part.children[0])].is_subdomain) {
        close_inner(static_cast<int>(p));
        continue;
      }
      if (is_swept_[p] != 0) {
        for (int b : motion) quotient_.eliminate({b});
      } else if (part.is_terminal()) {
        quotient_.eliminate_by_minimum_degree(motion);
      } else if (!motion.empty()) {
        quotient_.eliminate(motion);
      }
      if (part.is_subdomain) close_leaf(static_cast<int>(p));
    }
    eliminate_leftovers();
  }

  void elements_below(int part, std::vector<int>& elements) const {
    const Part& p = dissection_.parts[at(part)];
    elements.insert(elements.end(), p.elements.begin(), p.elements.end());
    for (int c : p.children) elements_below(c, elements);
  }

  /// A leaf has to end in one top group. If there are several, a group without eliminated blocks joins them.
  void close_leaf(int part) {
    std::vector<int> elements, open;
    elements_below(part, elements);
    const int first = group_end_.empty() ? 0 : group_end_.back();
    for (int e : elements)
      if (quotient_.is_live(e)) open.push_back(e);
    const bool loose = !open.empty();
    for (int g = first; g < static_cast<int>(quotient_.groups.size()); ++g)
      if (quotient_.is_live(quotient_.clique_of_group(g))) open.push_back(quotient_.clique_of_group(g));
    if (open.size() != 1 || loose) {
      std::sort(open.begin(), open.end());
      quotient_.eliminate({}, open);
    }
    // Sub-domains of chains and trees are usually alike, and eight fronts in lockstep share the cost of a visit.
    constexpr double visit_alone = 12e3, visit_in_lockstep = 1200.0;  // [flop]
    // The leaf at the end of a swept chain is merged as if it were held at both ends, so that it remains like the
    // others.
    const std::vector<int>& boundary = quotient_.groups.back().boundary;
    const int missing = is_swept_[at(part)] != 0 && boundary.size() == 1 ? adjacency_.size_of(boundary[0]) : 0;
    const bool in_lockstep = in_lockstep_ && dissection_.parts[at(part)].is_forest;
    amalgamate(quotient_.groups, first, adjacency_, in_lockstep ? visit_in_lockstep : visit_alone, missing);
    close(part, {}, first);
  }

  void close_inner(int part) {
    const int first = group_end_.back();
    std::vector<int> tops, children;
    for (int c : dissection_.parts[at(part)].children) {
      children.push_back(subdomain_of_part_[at(c)]);
      tops.push_back(quotient_.clique_of_group(group_end_[at(subdomain_of_part_[at(c)])] - 1));
    }
    quotient_.eliminate(motion_of_part_[at(part)], tops);
    close(part, children, first);
  }

  void close(int part, const std::vector<int>& children, int first) {
    const int id = static_cast<int>(tree_.subdomains.size());
    Subdomain s;
    s.level = dissection_.parts[at(part)].level;
    s.child_begin = static_cast<std::int32_t>(tree_.subdomain_children.size());
    s.subtree_begin = id;
    for (int c : children) {
      tree_.subdomains[at(c)].parent = id;
      tree_.subdomain_children.push_back(c);
      s.subtree_begin = std::min(s.subtree_begin, tree_.subdomains[at(c)].subtree_begin);
    }
    s.child_end = static_cast<std::int32_t>(tree_.subdomain_children.size());
    tree_.subdomains.push_back(s);
    group_begin_.push_back(first);
    group_end_.push_back(static_cast<int>(quotient_.groups.size()));
    subdomain_of_part_.resize(dissection_.parts.size(), -1);
    subdomain_of_part_[at(part)] = id;
  }

  /// Blocks that no element touches, and multipliers that constrain no motion, end in the root's top.
  void eliminate_leftovers() {
    std::vector<int> rest;
    for (int b = 0; b < graph_.num_blocks(); ++b)
      if (!quotient_.is_eliminated(b)) rest.push_back(b);
    if (rest.empty()) return;
    Group& top = quotient_.groups.back();
    top.eliminated.insert(top.eliminated.end(), rest.begin(), rest.end());
    std::erase_if(top.boundary, [&](int b) { return std::binary_search(rest.begin(), rest.end(), b); });
  }

  /// Depth first inside each sub-domain: fronts in postorder, elements in the order of their fronts.
  void number_fronts() {
    tree_.front_of_block.assign(at(graph_.num_blocks()), none);
    tree_.leaf_of_element.assign(at(graph_.num_elements()), none);
    std::vector<FrontId> front_of_group(quotient_.groups.size(), none);
    for (std::size_t s = 0; s < tree_.subdomains.size(); ++s) {
      Subdomain& sub = tree_.subdomains[s];
      sub.front_begin = tree_.num_fronts();
      sub.element_begin = static_cast<int>(tree_.element_order.size());
      sub.subtree_front_begin = sub.front_begin;
      for (SubdomainId c : tree_.children(sub)) {
        sub.element_begin = std::min(sub.element_begin, tree_.subdomains[at(c)].element_begin);
        sub.subtree_front_begin = std::min(sub.subtree_front_begin, tree_.subdomains[at(c)].subtree_front_begin);
      }
      std::vector<std::pair<int, std::size_t>> stack{{group_end_[s] - 1, 0}};
      while (!stack.empty()) {
        const int g = stack.back().first;
        const auto& children = quotient_.groups[at(g)].children;
        if (stack.back().second < children.size()) {
          const int c = children[stack.back().second++];
          if (c >= group_begin_[s]) stack.push_back({c, 0});
          continue;
        }
        front_of_group[at(g)] = append_front(quotient_.groups[at(g)], static_cast<SubdomainId>(s), front_of_group);
        stack.pop_back();
      }
      sub.front_end = tree_.num_fronts();
      sub.element_end = static_cast<int>(tree_.element_order.size());
    }
  }

  FrontId append_front(const Group& group, SubdomainId s, const std::vector<FrontId>& front_of_group) {
    Front f;
    const FrontId id = tree_.num_fronts();
    f.subdomain = s;
    f.element_begin = static_cast<int>(tree_.element_order.size());
    std::vector<int> elements = group.elements;
    for (int e = 0; id == 0 && e < graph_.num_elements(); ++e)
      if (adjacency_.blocks_of(e).empty()) elements.push_back(e);  // these add nothing to a front
    for (int e : elements) {
      tree_.element_order.push_back(e);
      tree_.leaf_of_element[at(e)] = s;
    }
    f.element_end = static_cast<int>(tree_.element_order.size());
    f.block_begin = static_cast<std::int64_t>(tree_.front_blocks.size());
    f.num_eliminated_blocks = static_cast<int>(group.eliminated.size());
    for (int b : group.eliminated) {
      tree_.front_blocks.push_back(b);
      tree_.front_of_block[at(b)] = id;
      f.num_eliminated += adjacency_.size_of(b);
    }
    for (int b : group.boundary) {
      tree_.front_blocks.push_back(b);
      f.num_boundary += adjacency_.size_of(b);
    }
    f.block_end = static_cast<std::int64_t>(tree_.front_blocks.size());
    f.child_begin = static_cast<std::int64_t>(tree_.front_children.size());
    for (int c : group.children) tree_.front_children.push_back(front_of_group[at(c)]);
    std::sort(tree_.front_children.begin() + f.child_begin, tree_.front_children.end());
    f.child_end = static_cast<std::int64_t>(tree_.front_children.size());
    for (auto k = f.child_begin; k < f.child_end; ++k) tree_.fronts[at(tree_.front_children[at(k)])].parent = id;
    tree_.fronts.push_back(f);
    return id;
  }

  /// Boundaries are sorted by the order of elimination, so that rows of children keep their order in the parent.
  void sort_boundaries() {
    std::vector<std::int64_t> rank(at(graph_.num_blocks()), 0);
    for (const Front& f : tree_.fronts)
      for (auto k = f.block_begin; k < f.block_begin + f.num_eliminated_blocks; ++k)
        rank[at(tree_.front_blocks[at(k)])] = k;
    for (const Front& f : tree_.fronts)
      std::sort(tree_.front_blocks.begin() + f.block_begin + f.num_eliminated_blocks,
                tree_.front_blocks.begin() + f.block_end, [&](int a, int b) { return rank[at(a)] < rank[at(b)]; });
  }

  void lay_out() {
    tree_.unknown_begin.assign(1, 0);
    for (int n : graph_.block_size) tree_.unknown_begin.push_back(tree_.unknown_begin.back() + n);
    std::vector<int> row(at(graph_.num_blocks()), -1);
    tree_.parent_row.assign(tree_.front_blocks.size(), -1);
    tree_.scatter_begin.assign(1, 0);
    for (const Front& f : tree_.fronts) {
      int next = 0;
      for (int b : tree_.blocks(f)) {
        row[at(b)] = next;
        next += adjacency_.size_of(b);
      }
      for (int e : tree_.elements(f)) {
        for (int b : adjacency_.blocks_of(e)) tree_.scatter.push_back(row[at(b)]);
        tree_.scatter_begin.push_back(static_cast<std::int64_t>(tree_.scatter.size()));
      }
      for (FrontId c : tree_.children(f)) {
        const Front& child = tree_.fronts[at(c)];
        for (auto k = child.block_begin + child.num_eliminated_blocks; k < child.block_end; ++k)
          tree_.parent_row[at(k)] = row[at(tree_.front_blocks[at(k)])];
      }
    }
  }

  void sum_flops() {
    for (Front& f : tree_.fronts) {
      f.flops = elimination_flops(f.num_eliminated, f.num_boundary) + 2.0 * f.size() * f.size();
      f.subtree_flops = f.flops;
      for (FrontId c : tree_.children(f)) f.subtree_flops += tree_.fronts[at(c)].subtree_flops;
    }
    for (Subdomain& s : tree_.subdomains) {
      for (FrontId f = s.front_begin; f < s.front_end; ++f) s.flops += tree_.fronts[at(f)].flops;
      s.subtree_flops = s.flops;
      for (SubdomainId c : tree_.children(s)) s.subtree_flops += tree_.subdomains[at(c)].subtree_flops;
    }
    // levels count sub-domains, not parts
    for (auto s = tree_.subdomains.rbegin(); s != tree_.subdomains.rend(); ++s)
      s->level = s->parent == none ? 0 : tree_.subdomains[at(s->parent)].level + 1;
  }

  const blocks::BlockGraph& graph_;
  const bool in_lockstep_;
  Adjacency adjacency_;
  Dissection dissection_;
  Quotient quotient_;
  std::vector<std::vector<int>> motion_of_part_;
  std::vector<char> is_swept_;                ///< by part: a leaf eliminated from its first block to its last
  std::vector<int> group_begin_, group_end_;  ///< by sub-domain
  std::vector<int> subdomain_of_part_;
  Tree tree_;
};

}  // namespace

std::span<const int> Tree::blocks(const Front& f) const {
  return {front_blocks.data() + f.block_begin, static_cast<std::size_t>(f.block_end - f.block_begin)};
}
std::span<const int> Tree::boundary_blocks(const Front& f) const {
  return blocks(f).subspan(at(f.num_eliminated_blocks));
}
std::span<const FrontId> Tree::children(const Front& f) const {
  return {front_children.data() + f.child_begin, static_cast<std::size_t>(f.child_end - f.child_begin)};
}
std::span<const SubdomainId> Tree::children(const Subdomain& s) const {
  return {subdomain_children.data() + s.child_begin, static_cast<std::size_t>(s.child_end - s.child_begin)};
}
std::span<const int> Tree::elements(const Front& f) const {
  return {element_order.data() + f.element_begin, static_cast<std::size_t>(f.element_end - f.element_begin)};
}
std::span<const int> Tree::elements(const Subdomain& s) const {
  return {element_order.data() + s.element_begin, static_cast<std::size_t>(s.element_end - s.element_begin)};
}

std::vector<std::string> problems_in(const TreeOptions& options) {
  std::vector<std::string> problems;
  if (options.leaf_size < 0) problems.push_back("leaf_size: must be >= 0");
  if (options.depth < -1) problems.push_back("depth: must be >= -1");
  if (!(options.target_leaf_flops > 0.0)) problems.push_back("target_leaf_flops: must be > 0");
  return problems;
}

Tree make_tree(const blocks::BlockGraph& graph, const TreeOptions& options) {
  require(problems_in(options).empty(), "options are valid");
  require_consistent(graph);
  return Builder(graph, options).run();
}

}  // namespace bough::tree
