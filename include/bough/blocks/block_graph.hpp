#pragma once
/// Unknowns in blocks and the elements that couple them: all that the algebra tower knows of a model. Plain data.
#include <cstdint>
#include <vector>

namespace bough::blocks {

enum class BlockKind : std::uint8_t {
  motion,      ///< increments of a node: may be eliminated at once
  multiplier,  ///< multipliers of a constraint: zero on the diagonal, to be eliminated after an unknown it constrains
};

struct BlockGraph {
  std::vector<int> block_size;        ///< unknowns of each block, >= 1
  std::vector<BlockKind> block_kind;  ///< same length
  std::vector<std::int64_t> element_begin{
      0};  ///< element e couples element_blocks[element_begin[e] .. element_begin[e+1])
  std::vector<int>
      element_blocks;  ///< block ids, in the order of the element's own unknowns, no repeats in one element

  int num_blocks() const { return static_cast<int>(block_size.size()); }
  int num_elements() const { return static_cast<int>(element_begin.size()) - 1; }
};

}  // namespace bough::blocks
