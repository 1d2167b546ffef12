#pragma once
/// Sub-domain tree and elimination fronts of a block graph: all symbolic work of the solver, done once. Immutable
/// after make_tree.
///
/// The elements are cut into non-overlapping sub-domains, recursively (sub-domain tree, binary, one root). Each
/// sub-domain owns a run of fronts: a leaf the fronts that eliminate its interior, an inner sub-domain the one front
/// of its separator. The last front of a sub-domain is its top: the boundary blocks of that front are the interface
/// of the sub-domain. Sub-domains and fronts are numbered in postorder, so every subtree is a contiguous range that
/// ends at its top.
#include <algorithm>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "bough/blocks/block_graph.hpp"

namespace bough::tree {

using FrontId = std::int32_t;
using SubdomainId = std::int32_t;
constexpr std::int32_t none = -1;

/// Options for the division of the elements into sub-domains.
struct TreeOptions {
  int leaf_size = 0;  ///< largest number of elements of a leaf sub-domain, >= 1; 0: from a cost estimate (see
                      ///< target_leaf_flops).
  int depth = -1;     ///< levels of sub-domains below the root, >= 0 (0: one sub-domain); -1: determined by leaf_size.
  double target_leaf_flops =
      1e5;  ///< flops of a leaf when leaf_size is 0: some tens of microseconds, well above the cost of a task. Graphs
            ///< with many loops take several times as many.
  bool in_lockstep =
      true;  ///< whether equal leaves are visited eight at a time; leaf sizes that are not given are then chosen to
             ///< allow it.
  bool loops_in_one = false;  ///< whether elements that close many loops are one sub-domain, if neither leaf_size nor
                              ///< depth is given.
  unsigned seed = 1;  ///< seed of the general partitioner; the tree is a function of the graph and these options alone.
};

/// Describes what is wrong with the options; empty if nothing is.
std::vector<std::string> problems_in(const TreeOptions& options);

/// One dense elimination step: elements and children are assembled, the first blocks are eliminated, and the rest is
/// passed to the parent.
struct Front {
  FrontId parent = none;
  SubdomainId subdomain = none;
  int num_eliminated = 0;  ///< unknowns eliminated here (before any delayed pivots).
  int num_boundary = 0;    ///< unknowns of the boundary blocks.
  int num_eliminated_blocks = 0;
  std::int64_t block_begin = 0;  ///< blocks: eliminated ones first, then the boundary; range in Tree::front_blocks.
  std::int64_t block_end = 0;
  std::int64_t child_begin = 0;  ///< range in Tree::front_children; the order of addition is fixed.
  std::int64_t child_end = 0;
  int element_begin = 0;  ///< elements assembled here: range of positions in Tree::element_order.
  int element_end = 0;
  double flops = 0.0;          ///< estimate of the elimination [flop].
  double subtree_flops = 0.0;  ///< including all descendants [flop].
  int size() const { return num_eliminated + num_boundary; }
};

/// One sub-domain: a set of elements, and the blocks that are eliminated once all of these elements are assembled.
struct Subdomain {
  SubdomainId parent = none;
  int level = 0;            ///< 0 at the root.
  FrontId front_begin = 0;  ///< own fronts [front_begin, front_end); the last one is the top.
  FrontId front_end = 0;
  FrontId subtree_front_begin = 0;  ///< fronts of the sub-domain and its descendants: [subtree_front_begin, front_end).
  SubdomainId subtree_begin = 0;    ///< sub-domains of the subtree: [subtree_begin, own id].
  std::int32_t child_begin = 0;     ///< range in Tree::subdomain_children.
  std::int32_t child_end = 0;
  int element_begin = 0;  ///< elements of the subtree: range of positions in Tree::element_order.
  int element_end = 0;
  double flops = 0.0;          ///< own fronts [flop].
  double subtree_flops = 0.0;  ///< including descendants [flop].
  FrontId top() const { return front_end - 1; }
  bool is_leaf() const { return child_begin == child_end; }
};

/// The tree. Plain data, const after make_tree.
struct Tree {
  std::vector<Front> fronts;          ///< postorder.
  std::vector<Subdomain> subdomains;  ///< postorder; the root is the last.
  std::vector<int> front_blocks;      ///< block ids, see Front.
  std::vector<FrontId> front_children;
  std::vector<SubdomainId> subdomain_children;
  std::vector<int>
      element_order;  ///< element ids by the leaf and front that assembles them: a leaf is a contiguous range.
  std::vector<SubdomainId> leaf_of_element;  ///< by element id.
  std::vector<FrontId> front_of_block;       ///< front in which a block is eliminated, by block id.
  std::vector<std::int64_t>
      unknown_begin;  ///< first unknown of each block (prefix sums of block_size), size num_blocks + 1.
  std::vector<std::int64_t>
      scatter_begin;         ///< by position in element_order: range in scatter, one entry per block of the element.
  std::vector<int> scatter;  ///< first row of the element's block in its front.
  std::vector<int>
      parent_row;  ///< parallel to front_blocks: first row of a boundary block in the parent front (-1 for eliminated).
  std::string method;  ///< how the elements were cut, in words, for reports.

  int num_fronts() const { return static_cast<int>(fronts.size()); }
  int num_subdomains() const { return static_cast<int>(subdomains.size()); }
  SubdomainId root() const { return num_subdomains() - 1; }
  std::int64_t num_unknowns() const { return unknown_begin.back(); }
  int block_of_unknown(std::int64_t unknown) const {
    return static_cast<int>(std::upper_bound(unknown_begin.begin(), unknown_begin.end(), unknown) -
                            unknown_begin.begin()) -
           1;
  }
  std::span<const int> blocks(const Front& f) const;  ///< eliminated, then boundary.
  std::span<const int> boundary_blocks(const Front& f) const;
  std::span<const FrontId> children(const Front& f) const;
  std::span<const SubdomainId> children(const Subdomain& s) const;
  std::span<const int> elements(const Front& f) const;      ///< element ids assembled in this front.
  std::span<const int> elements(const Subdomain& s) const;  ///< element ids of the whole sub-domain.
};

/// Divides the elements into sub-domains and lays out all fronts. Chains and trees of bodies are cut at one block each;
/// other graphs by METIS if it was built in, otherwise along breadth-first levels. Unconnected parts and loops are
/// allowed. A motion block is eliminated in the lowest front that contains all its elements. A multiplier block is
/// eliminated where a motion block that it constrains is eliminated in the same front or below; otherwise it moves up.
/// Elements without blocks are assembled with the first front. Preconditions: problems_in(options) is empty; the graph
/// is consistent (checked by require, O(size)). Deterministic. Allocates.
Tree make_tree(const blocks::BlockGraph& graph, const TreeOptions& options = {});

/// Flops of eliminating e of e + b unknowns in a dense front that is not symmetric.
double elimination_flops(int e, int b);

}  // namespace bough::tree
