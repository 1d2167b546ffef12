#pragma once
/// Elements of every block: the transpose of the block graph's lists. Internal to tree.
#include <cstdint>
#include <span>
#include <vector>

#include "bough/blocks/block_graph.hpp"

namespace bough::tree {

struct Adjacency {
  const blocks::BlockGraph* graph = nullptr;
  std::vector<std::int64_t> begin;  ///< by block
  std::vector<int> elements;        ///< ascending element ids of each block

  explicit Adjacency(const blocks::BlockGraph& g);

  std::span<const int> elements_of(int block) const {
    const auto b = static_cast<std::size_t>(block);
    return {elements.data() + begin[b], static_cast<std::size_t>(begin[b + 1] - begin[b])};
  }
  std::span<const int> blocks_of(int element) const {
    const auto e = static_cast<std::size_t>(element);
    const auto& g = *graph;
    return {g.element_blocks.data() + g.element_begin[e],
            static_cast<std::size_t>(g.element_begin[e + 1] - g.element_begin[e])};
  }
  int size_of(int block) const { return graph->block_size[static_cast<std::size_t>(block)]; }
  bool is_motion(int block) const {
    return graph->block_kind[static_cast<std::size_t>(block)] == blocks::BlockKind::motion;
  }
  int degree(int block) const {
    return static_cast<int>(begin[static_cast<std::size_t>(block) + 1] - begin[static_cast<std::size_t>(block)]);
  }
  int unknowns_of(int element) const;
};

}  // namespace bough::tree
