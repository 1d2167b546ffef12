#include "bough/solve/matrix_blocks.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include "bough/blocks/at.hpp"

namespace bough::solve {

namespace {

using Lists = std::vector<std::vector<int>>;

/// Neighbours of every unknown in the pattern of A + A^T, ascending, without itself.
Lists find_neighbours(const SparseColumns& a) {
  Lists near(at(a.n));
  for (int j = 0; j < a.n; ++j)
    for (int k = a.column_begin[at(j)]; k < a.column_begin[at(j) + 1]; ++k) {
      const int i = a.row[at(k)];
      if (i == j) continue;
      near[at(j)].push_back(i);
      near[at(i)].push_back(j);
    }
  for (std::vector<int>& list : near) {
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
  }
  return near;
}

std::vector<char> find_diagonal(const SparseColumns& a) {
  std::vector<char> has(at(a.n), 0);
  for (int j = 0; j < a.n; ++j)
    for (int k = a.column_begin[at(j)]; k < a.column_begin[at(j) + 1]; ++k)
      if (a.row[at(k)] == j) has[at(j)] = 1;
  return has;
}

/// Blocks by their first unknown. Motions are alike if their neighbours and they themselves are the same set (they
/// are then neighbours of each other), multipliers if their neighbours are the same.
Lists find_blocks(const Lists& near, const std::vector<char>& has_diagonal) {
  std::map<std::pair<char, std::vector<int>>, std::size_t> block_of_set;
  Lists blocks;
  for (std::size_t i = 0; i < near.size(); ++i) {
    std::pair<char, std::vector<int>> key{has_diagonal[i], near[i]};
    const int self = static_cast<int>(i);
    if (has_diagonal[i] != 0) key.second.insert(std::lower_bound(key.second.begin(), key.second.end(), self), self);
    const auto [found, is_new] = block_of_set.emplace(std::move(key), blocks.size());
    if (is_new) blocks.emplace_back();
    blocks[found->second].push_back(self);
  }
  return blocks;
}

/// The cliques that become elements, over the graph of blocks.
class Cover {
 public:
  Cover(Lists near, const std::vector<blocks::BlockKind>& kind)
      : near_(std::move(near)), kind_(kind), element_of_pair_(near_.size()), elements_of_(near_.size()) {
    for (std::size_t b = 0; b < near_.size(); ++b) element_of_pair_[b].assign(near_[b].size(), -1);
    cover_multipliers();
    for (int b = 0; b < num_blocks(); ++b)
      for (std::size_t k = 0; k < near_[at(b)].size(); ++k)
        if (element_of_pair_[at(b)][k] < 0) add(grow(b, near_[at(b)][k]));
    for (int b = 0; b < num_blocks(); ++b)
      if (elements_of_[at(b)].empty()) add({b});
  }

  const Lists& elements() const { return elements_; }
  /// The element that has the entries of two blocks, which may be the same one.
  int element_of(int a, int b) const {
    return a == b ? elements_of_[at(a)].front() : element_of_pair_[at(a)][slot(a, b)];
  }

 private:
  int num_blocks() const { return static_cast<int>(near_.size()); }
  std::size_t slot(int a, int b) const {
    const std::vector<int>& list = near_[at(a)];
    return at(std::lower_bound(list.begin(), list.end(), b) - list.begin());
  }
  bool are_neighbours(int a, int b) const {
    const std::size_t k = slot(a, b);
    return k < near_[at(a)].size() && near_[at(a)][k] == b;
  }
  bool is_covered(int a, int b) const { return element_of_pair_[at(a)][slot(a, b)] >= 0; }

  void take_pairs(int element, int b) {
    for (int c : elements_[at(element)])
      if (c != b && are_neighbours(b, c) && !is_covered(b, c))
        element_of_pair_[at(b)][slot(b, c)] = element_of_pair_[at(c)][slot(c, b)] = element;
  }
  void add(std::vector<int> blocks) {
    const int id = static_cast<int>(elements_.size());
    elements_.push_back(std::move(blocks));
    for (int b : elements_.back()) elements_of_[at(b)].push_back(id);
    for (int b : elements_.back()) take_pairs(id, b);
  }

  /// Every multiplier with its neighbours, motions first. Those with most neighbours come first, so that others find
  /// an element that has all of theirs.
  void cover_multipliers() {
    std::vector<int> order;
    for (int b = 0; b < num_blocks(); ++b)
      if (kind_[at(b)] == blocks::BlockKind::multiplier && !near_[at(b)].empty()) order.push_back(b);
    std::stable_sort(order.begin(), order.end(),
                     [&](int a, int b) { return near_[at(a)].size() > near_[at(b)].size(); });
    for (int b : order) {
      const std::vector<int>& around = near_[at(b)];
      int host = -1;
      for (int e : elements_of_[at(around.front())])
        if (host < 0 && std::all_of(around.begin(), around.end(), [&](int c) { return contains(elements_[at(e)], c); }))
          host = e;
      if (host < 0) {
        std::vector<int> blocks = around;
        std::stable_partition(blocks.begin(), blocks.end(),
                              [&](int c) { return kind_[at(c)] == blocks::BlockKind::motion; });
        blocks.push_back(b);
        add(std::move(blocks));
      } else if (!contains(elements_[at(host)], b)) {
        elements_[at(host)].push_back(b);
        elements_of_[at(b)].push_back(host);
        take_pairs(host, b);
      }
    }
  }
  static bool contains(const std::vector<int>& list, int b) {
    return std::find(list.begin(), list.end(), b) != list.end();
  }

  std::vector<int> grow(int a, int b) const {
    std::vector<int> clique{a, b}, candidates;
    std::set_intersection(near_[at(a)].begin(), near_[at(a)].end(), near_[at(b)].begin(), near_[at(b)].end(),
                          std::back_inserter(candidates));
    std::vector<int> fresh(candidates.size(), 0);  // entries with the clique that are not covered
    const auto count = [&](int member) {
      for (std::size_t k = 0; k < candidates.size(); ++k) fresh[k] += is_covered(candidates[k], member) ? 0 : 1;
    };
    count(a);
    count(b);
    while (!candidates.empty()) {
      const auto best = std::max_element(fresh.begin(), fresh.end());
      if (2 * at(*best) < clique.size()) break;
      const int taken = candidates[at(best - fresh.begin())];
      clique.push_back(taken);
      std::size_t kept = 0;
      for (std::size_t k = 0; k < candidates.size(); ++k) {
        if (candidates[k] == taken || !are_neighbours(candidates[k], taken)) continue;
        candidates[kept] = candidates[k];
        fresh[kept++] = fresh[k];
      }
      candidates.resize(kept);
      fresh.resize(kept);
      count(taken);
    }
    std::sort(clique.begin(), clique.end());
    return clique;
  }

  Lists near_;
  const std::vector<blocks::BlockKind>& kind_;
  Lists element_of_pair_;  ///< parallel to near_; -1: not covered
  Lists elements_of_;      ///< by block
  Lists elements_;
};

Lists find_block_neighbours(const Lists& near, const Lists& blocks, const std::vector<int>& block_of) {
  Lists out(blocks.size());
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    for (int i : near[at(blocks[b].front())])  // the others have the same
      if (block_of[at(i)] != static_cast<int>(b)) out[b].push_back(block_of[at(i)]);
    std::sort(out[b].begin(), out[b].end());
    out[b].erase(std::unique(out[b].begin(), out[b].end()), out[b].end());
  }
  return out;
}

}  // namespace

MatrixBlocks find_blocks(const SparseColumns& a) {
  MatrixBlocks out;
  const Lists near = find_neighbours(a);
  const std::vector<char> has_diagonal = find_diagonal(a);
  const Lists blocks = find_blocks(near, has_diagonal);
  std::vector<int> block_of(at(a.n));
  out.unknown_begin.assign(1, 0);
  out.place.assign(at(a.n), 0);
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    for (std::size_t k = 0; k < blocks[b].size(); ++k) {
      block_of[at(blocks[b][k])] = static_cast<int>(b);
      out.place[at(blocks[b][k])] = out.unknown_begin.back() + static_cast<int>(k);
    }
    out.graph.block_size.push_back(static_cast<int>(blocks[b].size()));
    out.graph.block_kind.push_back(has_diagonal[at(blocks[b].front())] != 0 ? blocks::BlockKind::motion
                                                                            : blocks::BlockKind::multiplier);
    out.unknown_begin.push_back(out.unknown_begin.back() + out.graph.block_size.back());
  }
  const Cover cover(find_block_neighbours(near, blocks, block_of), out.graph.block_kind);

  std::vector<std::map<int, int>> row_of_block;  // by element: first row of its blocks
  std::vector<std::int64_t> size;
  for (const std::vector<int>& element : cover.elements()) {
    int rows = 0;
    row_of_block.emplace_back();
    for (int b : element) {
      row_of_block.back()[b] = rows;
      rows += out.graph.block_size[at(b)];
      out.graph.element_blocks.push_back(b);
    }
    out.graph.element_begin.push_back(static_cast<std::int64_t>(out.graph.element_blocks.size()));
    size.push_back(rows);
  }
  for (int j = 0; j < a.n; ++j)
    for (int k = a.column_begin[at(j)]; k < a.column_begin[at(j) + 1]; ++k) {
      const int i = a.row[at(k)], bi = block_of[at(i)], bj = block_of[at(j)];
      const int e = cover.element_of(bi, bj);
      const int row = row_of_block[at(e)].at(bi) + out.place[at(i)] - out.unknown_begin[at(bi)];
      const int column = row_of_block[at(e)].at(bj) + out.place[at(j)] - out.unknown_begin[at(bj)];
      out.element.push_back(e);
      out.offset.push_back(row * size[at(e)] + column);
    }
  return out;
}

}  // namespace bough::solve
