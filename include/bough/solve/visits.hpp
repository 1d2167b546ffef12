#pragma once
/// Planned visits of the hierarchical solver's walks: sizes and costs, without the numbers of a matrix.
#include <cstdint>
#include <vector>

#include "bough/blocks/block_graph.hpp"
#include "bough/solve/options.hpp"
#include "bough/tree/tree.hpp"

namespace bough::solve {

/// One visit: several sub-domains in lockstep, or a single one. Costs are those of one lane; in lockstep all lanes
/// together take the time of one.
struct VisitShape {
  std::vector<tree::SubdomainId> subdomains;
  bool in_lanes = false;
  int num_fronts = 0;
  double flops = 0.0;  ///< of the elimination [flop].
  double condense_flops =
      0.0;  ///< of these, updates of the boundary's own block: 2 e b^2 for e eliminated, b boundary unknowns [flop].
  std::int64_t factor_bytes = 0;   ///< factor of all its lanes.
  std::int64_t element_bytes = 0;  ///< element matrices of all its lanes.
  int batch_begin = 0;             ///< positions in Hierarchical::batches().
  int batch_end = 0;
};

struct VisitShapes {
  std::vector<VisitShape> visits;  ///< by the ids that walkers pass to visits.
  tree::Tree walk;                 ///< the tree that walkers see: its sub-domains are the visits.
};

/// The visits of Hierarchical made from the same arguments. Precondition: as there. Allocates.
VisitShapes make_visit_shapes(const blocks::BlockGraph& graph, const tree::Tree& tree,
                              const SolveOptions& options = {});

}  // namespace bough::solve
