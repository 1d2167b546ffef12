#include "adjacency.hpp"

namespace bough::tree {

Adjacency::Adjacency(const blocks::BlockGraph& g) : graph(&g), begin(static_cast<std::size_t>(g.num_blocks()) + 1, 0) {
  for (int b : g.element_blocks) ++begin[static_cast<std::size_t>(b) + 1];
  for (std::size_t b = 1; b < begin.size(); ++b) begin[b] += begin[b - 1];
  elements.resize(g.element_blocks.size());
  std::vector<std::int64_t> next(begin.begin(), begin.end() - 1);
  for (int e = 0; e < g.num_elements(); ++e)
    for (int b : blocks_of(e)) elements[static_cast<std::size_t>(next[static_cast<std::size_t>(b)]++)] = e;
}

int Adjacency::unknowns_of(int element) const {
  int n = 0;
  for (int b : blocks_of(element)) n += size_of(b);
  return n;
}

}  // namespace bough::tree
