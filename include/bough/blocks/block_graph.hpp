#pragma once
/// The sparsity of a model for the linear solver: blocks of unknowns, and the elements that couple them. The tree of
/// sub-domains and the solver use no other data of a model. Plain data.
#include <cstdint>
#include <vector>

namespace bough::blocks {

enum class BlockKind : std::uint8_t {
  motion,      ///< increments of a node: their diagonal block may be eliminated at any time
  multiplier,  ///< multipliers of a constraint: their diagonal block is zero, so an unknown that they constrain is
               ///< eliminated first
};

struct BlockGraph {
  std::vector<int> block_size;        ///< number of unknowns of each block, >= 1
  std::vector<BlockKind> block_kind;  ///< kind of each block, as many as block_size
  std::vector<std::int64_t> element_begin{
      0};  ///< element e couples element_blocks[element_begin[e] .. element_begin[e+1])
  std::vector<int>
      element_blocks;  ///< block ids, in the order of the element's own unknowns; none twice in one element

  /// What each multiplier counts where dependent rows leave a choice, which is then of least norm of these times the
  /// multipliers; block after block. Empty: each is measured relative to its constraint row.
  std::vector<double> multiplier_measure;

  int num_blocks() const { return static_cast<int>(block_size.size()); }
  int num_elements() const { return static_cast<int>(element_begin.size()) - 1; }
};

}  // namespace bough::blocks
