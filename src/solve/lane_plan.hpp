#pragma once
/// The sub-domains that are factored in lockstep, one per SIMD lane, and their common fronts. Symbolic, made once.
/// Internal to solve.
#include <array>
#include <cstdint>
#include <vector>

#include "bough/blocks/block_graph.hpp"
#include "bough/solve/element_view.hpp"
#include "bough/solve/options.hpp"
#include "bough/tree/tree.hpp"
#include "moves.hpp"

namespace bough::solve {

/// Up to eight equal elements of eight equal fronts: one pack per entry.
struct LaneElement {
  std::array<int, lanes_wide> element;      ///< ids; -1 for an unused lane
  int size = 0;                             ///< unknowns
  std::int64_t run_begin = 0, run_end = 0;  ///< LanePlan::runs, one for each of its blocks
  std::int64_t values = 0;                  ///< first entry of the first lane, in doubles, in the element store
};

/// A child of a front in lockstep: lane l of the parent takes lane from[l] of the child front, or none (-1).
struct LaneChild {
  int front;  ///< index in LanePlan::fronts
  bool is_identity;
  std::array<std::int8_t, lanes_wide> from;
  std::int64_t run_begin = 0, run_end = 0;  ///< LanePlan::runs
};

/// Up to eight fronts of the tree in lockstep. A lane with fewer unknowns is filled up with rows of the identity.
struct LaneFront {
  std::array<tree::FrontId, lanes_wide> front;  ///< tree::none for an empty lane
  int eliminated = 0, boundary = 0;             ///< numbers of unknowns, the largest of all lanes
  bool has_padding = false;                     ///< some lane has fewer unknowns to eliminate
  int element_begin = 0, element_end = 0;       ///< LanePlan::elements
  int child_begin = 0, child_end = 0;           ///< LanePlan::children
  Assembly assembly;                            ///< of LanePlan::lists
  /// First pack of the Schur complement, then of the vector: in the group's scratch; for a top in permanent memory.
  std::int64_t schur = 0;
  std::int64_t factor = 0;    ///< first pack of the factor: e columns of all n rows, then the b columns of U12
  std::int64_t unknown = 0;   ///< first of 8 x eliminated unknowns (-1: padding), lanes innermost
  bool is_symmetric = false;  ///< no U12; blocks above the diagonal are not stored
  int group = 0;              ///< LanePlan::groups
  bool is_top = false;        ///< its Schur complement is kept until the parent group is visited
  int size() const { return eliminated + boundary; }
  std::int64_t schur_size() const { return static_cast<std::int64_t>(boundary) * boundary; }
  std::int64_t factor_size() const {
    return static_cast<std::int64_t>(eliminated) * (size() + (is_symmetric ? 0 : boundary));
  }
};

/// Sub-domains visited together: several in lockstep, or a single one, in lanes or on the scalar path.
struct LaneGroup {
  std::vector<tree::SubdomainId> subdomains;
  bool in_lanes = false;
  int front_begin = 0, front_end = 0;      ///< LanePlan::fronts, children first; in lanes only
  int element_begin = 0, element_end = 0;  ///< positions in LanePlan::batches
  std::int64_t scratch = 0;  ///< packs of Schur complements and vectors that are needed only during the visit
};

struct LanePlan {
  std::vector<LaneGroup> groups;  ///< children before parents
  std::vector<LaneFront> fronts;
  std::vector<LaneElement> elements;
  std::vector<LaneChild> children;
  std::vector<Run> runs;
  MoveLists lists;
  std::vector<int> unknowns;
  std::vector<ElementBatch> batches;  ///< every element once, by group
  std::vector<int> lane_front;        ///< by front of the tree: index in fronts, -1 elsewhere
  std::vector<std::int8_t> lane;      ///< by front of the tree
  std::vector<int> group_of_subdomain;
  tree::Tree walk;                             ///< the groups as sub-domains, for walkers
  std::int64_t top_size = 0, factor_size = 0;  ///< packs
  std::int64_t num_values = 0;                 ///< doubles of the element store
  std::vector<std::int64_t> element_first;     ///< by element
  std::vector<int> element_stride;             ///< by element
  /// Of a LaneElement or LaneChild.
  template <class Contributor>
  std::span<const Run> runs_of(const Contributor& c) const {
    return std::span(runs).subspan(static_cast<std::size_t>(c.run_begin),
                                   static_cast<std::size_t>(c.run_end - c.run_begin));
  }
};

/// Groups the sub-domains of a tree. The result depends only on graph and tree; batches and positions in the element
/// store do not depend on the symmetry. `use_lanes` false: every sub-domain is a group on the scalar path.
LanePlan make_lane_plan(const blocks::BlockGraph& graph, const tree::Tree& tree, bool use_lanes,
                        Symmetry symmetry = Symmetry::general);

}  // namespace bough::solve
