#include "quotient.hpp"

#include <algorithm>
#include <set>
#include <utility>

#include "bough/blocks/at.hpp"
#include "bough/tree/tree.hpp"

namespace bough::tree {

Quotient::Quotient(const Adjacency& adjacency)
    : adjacency_(adjacency),
      num_elements_(adjacency.graph->num_elements()),
      live_(at(num_elements_), 1),
      eliminated_(at(adjacency.graph->num_blocks()), 0),
      capacity_(adjacency.graph->block_size),
      cliques_(at(adjacency.graph->num_blocks())),
      block_stamp_(at(adjacency.graph->num_blocks()), 0),
      clique_stamp_(at(num_elements_), 0) {
  for (int b = 0; b < adjacency.graph->num_blocks(); ++b) {
    const auto list = adjacency.elements_of(b);
    cliques_[at(b)].assign(list.begin(), list.end());
  }
}

std::span<const int> Quotient::blocks_of_clique(int clique) const {
  if (clique < num_elements_) return adjacency_.blocks_of(clique);
  return groups[at(clique - num_elements_)].boundary;
}

const std::vector<int>& Quotient::live_cliques(int block) {
  auto& list = cliques_[at(block)];
  std::erase_if(list, [&](int c) { return !live_[at(c)]; });
  return list;
}

int Quotient::degree(int block) {
  ++stamp_;
  int sum = 0;
  for (int c : live_cliques(block))
    for (int b : blocks_of_clique(c)) {
      if (eliminated_[at(b)] || block_stamp_[at(b)] == stamp_) continue;
      block_stamp_[at(b)] = stamp_;
      sum += adjacency_.size_of(b);
    }
  return sum - adjacency_.size_of(block);
}

void Quotient::collect(const std::vector<int>& motion_blocks, const std::vector<int>& forced) {
  ++stamp_;
  absorbed_.clear();
  united_.clear();
  const auto absorb = [&](int c) {
    if (clique_stamp_[at(c)] == stamp_) return;
    clique_stamp_[at(c)] = stamp_;
    absorbed_.push_back(c);
    for (int b : blocks_of_clique(c)) {
      if (block_stamp_[at(b)] == stamp_) continue;
      block_stamp_[at(b)] = stamp_;
      united_.push_back(b);
    }
  };
  for (int b : motion_blocks)
    for (int c : live_cliques(b)) absorb(c);
  for (int c : forced)
    if (live_[at(c)]) absorb(c);
}

bool Quotient::all_constrained_gone(int multiplier) const {
  for (int e : adjacency_.elements_of(multiplier))
    for (int b : adjacency_.blocks_of(e))
      if (adjacency_.is_motion(b) && !eliminated_[at(b)]) return false;
  return true;
}

void Quotient::take_multipliers(const std::vector<int>& motion_blocks, std::vector<int>& taken) {
  for (int v : motion_blocks) eliminated_[at(v)] = 1;
  const auto take = [&](int m) {
    eliminated_[at(m)] = 1;
    taken.push_back(m);
  };
  for (int v : motion_blocks)
    for (int e : adjacency_.elements_of(v))
      for (int m : adjacency_.blocks_of(e)) {
        if (adjacency_.is_motion(m) || eliminated_[at(m)] || adjacency_.size_of(m) > capacity_[at(v)]) continue;
        capacity_[at(v)] -= adjacency_.size_of(m);
        take(m);
      }
  for (int v : motion_blocks)
    for (int e : adjacency_.elements_of(v))
      for (int m : adjacency_.blocks_of(e))
        if (!adjacency_.is_motion(m) && !eliminated_[at(m)] && all_constrained_gone(m)) take(m);
}

int Quotient::finish(std::vector<int> eliminated) {
  Group group;
  const int id = static_cast<int>(groups.size());
  const int clique = clique_of_group(id);
  group.eliminated = std::move(eliminated);
  for (int b : group.eliminated) eliminated_[at(b)] = 1;
  for (int b : united_)
    if (!eliminated_[at(b)]) group.boundary.push_back(b);
  std::sort(absorbed_.begin(), absorbed_.end());
  for (int c : absorbed_) {
    live_[at(c)] = 0;
    if (c < num_elements_) {
      group.elements.push_back(c);
    } else {
      group.children.push_back(c - num_elements_);
    }
  }
  for (int b : group.boundary) cliques_[at(b)].push_back(clique);
  groups.push_back(std::move(group));
  live_.push_back(1);
  clique_stamp_.push_back(0);
  return id;
}

int Quotient::eliminate(const std::vector<int>& motion_blocks, const std::vector<int>& forced) {
  collect(motion_blocks, forced);
  std::vector<int> eliminated = motion_blocks;
  take_multipliers(motion_blocks, eliminated);
  return finish(std::move(eliminated));
}

int Quotient::eliminate_rest(const std::vector<int>& rest, const std::vector<int>& forced) {
  collect({}, forced);
  return finish(rest);
}

void Quotient::eliminate_by_minimum_degree(const std::vector<int>& motion_blocks) {
  std::set<std::pair<int, int>> queue;  // (degree, block)
  std::vector<int> key(motion_blocks.size());
  std::vector<int> sorted = motion_blocks;
  std::sort(sorted.begin(), sorted.end());
  const auto index_of = [&](int b) {
    const auto it = std::lower_bound(sorted.begin(), sorted.end(), b);
    return it != sorted.end() && *it == b ? static_cast<int>(it - sorted.begin()) : -1;
  };
  for (std::size_t i = 0; i < sorted.size(); ++i) {
    key[i] = degree(sorted[i]);
    queue.insert({key[i], sorted[i]});
  }
  std::vector<int> one(1);
  while (!queue.empty()) {
    one[0] = queue.begin()->second;
    queue.erase(queue.begin());
    const int g = eliminate(one);
    for (int b : groups[at(g)].boundary) {
      const int i = index_of(b);
      if (i < 0) continue;
      const int d = degree(b);
      if (d == key[at(i)]) continue;
      queue.erase({key[at(i)], b});
      key[at(i)] = d;
      queue.insert({d, b});
    }
  }
}

double elimination_flops(int e, int b) {
  // sum over pivots of m + 2 m^2, m = rows left below the pivot
  const auto sums = [](double n) { return n * (n + 1.0) / 2.0 + n * (n + 1.0) * (2.0 * n + 1.0) / 3.0; };
  return sums(e + b - 1.0) - (b > 0 ? sums(b - 1.0) : 0.0);
}

void amalgamate(std::vector<Group>& groups, int first, const Adjacency& adjacency, double visit_flops, int missing) {
  const auto unknowns = [&](const std::vector<int>& list) {
    int n = 0;
    for (int b : list) n += adjacency.size_of(b);
    return n;
  };
  for (int p = first; p < static_cast<int>(groups.size()); ++p) {
    Group& parent = groups[at(p)];
    if (parent.eliminated.empty()) continue;
    const int boundary = unknowns(parent.boundary) + missing;
    int own = unknowns(parent.eliminated);
    const std::vector<int> children = parent.children;
    for (int c : children) {
      if (c < first) continue;
      Group& child = groups[at(c)];
      const int gone = unknowns(child.eliminated);
      if (gone == 0) continue;
      const double apart =
          elimination_flops(gone, unknowns(child.boundary) + missing) + elimination_flops(own, boundary);
      if (elimination_flops(gone + own, boundary) > apart + visit_flops) continue;
      parent.eliminated.insert(parent.eliminated.begin(), child.eliminated.begin(), child.eliminated.end());
      parent.elements.insert(parent.elements.begin(), child.elements.begin(), child.elements.end());
      std::erase(parent.children, c);
      parent.children.insert(parent.children.begin(), child.children.begin(), child.children.end());
      child = Group{};
      child.alive = false;
      own += gone;
    }
  }
}

}  // namespace bough::tree
