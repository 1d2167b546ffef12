#pragma once
/// Blocks and elements of a sparse matrix, found from its pattern.
#include <cstdint>
#include <vector>

#include "bough/blocks/block_graph.hpp"
#include "bough/solve/sparse_columns.hpp"

namespace bough::solve {

struct MatrixBlocks {
  blocks::BlockGraph graph;
  std::vector<int> unknown_begin;    ///< by block
  std::vector<int> place;            ///< where the graph has an unknown of the matrix
  std::vector<int> element;          ///< by entry of the matrix: its element
  std::vector<std::int64_t> offset;  ///< by entry: its place in the element matrix, row by row
};

/// The graph and the elements of a sparse matrix A, in the order of its unknowns; a pattern that is not symmetric is
/// completed with zeros.
///   - Blocks: unknowns whose rows and columns have entries in the same places. Unknowns with a zero on the diagonal
///     are multipliers, the others motions.
///   - Elements: a multiplier with all unknowns of its row and column; it joins the element of another one that has
///     them all. The remaining entries are covered by cliques, each grown from an entry that is not covered yet by the
///     block that covers most others, as long as it covers at least half of its entries with the clique. Finite
///     elements are found again in this way, up to a few.
/// Every entry is in one element.
MatrixBlocks find_blocks(const SparseColumns& a);

}  // namespace bough::solve
