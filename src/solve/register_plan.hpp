#pragma once
/// Assembly lists of the small fronts of a leaf without equals, which are eliminated row by row in registers. Symbolic,
/// made once. Internal to solve.
#include <cstdint>
#include <vector>

#include "bough/blocks/block_graph.hpp"
#include "bough/tree/tree.hpp"
#include "lane_plan.hpp"

namespace bough::solve {

constexpr int row_register = 8;  ///< entries of a row in one register, for any width of the machine's registers
/// Largest number of unknowns of such a front: with the right-hand side a row has three times eight entries.
constexpr int largest_in_registers = tree::largest_swept_front;

constexpr int most_row_registers = largest_in_registers / row_register + 1;

/// The transfer of rows of a matrix into the same registers of rows of a front.
struct RegisterMove {
  std::int32_t source =
      0;  ///< of the entry for lane 0, from RegisterFront::values or from the child's rows; may be before their begin
  std::int32_t target = 0;    ///< from the front's first row [doubles]
  std::int32_t child = -1;    ///< index from RegisterFront::child_begin on; -1: an element
  std::int16_t row_step = 0;  ///< of the source [doubles]
  std::int8_t rows = 0;
  std::int8_t registers = 1;                   ///< of a row
  std::uint8_t mask[most_row_registers] = {};  ///< lanes used, by register
  bool is_first = false;                       ///< the first at its target: written, with zero in the other lanes
  bool operator==(const RegisterMove&) const = default;
};

/// A run of adjacent unknowns, and their rows of the front.
struct UnknownRun {
  int unknown;
  int row;
  int length;
};

/// A child whose front is in registers as well.
struct RegisterChild {
  int front;                                ///< index in RegisterPlan::fronts
  std::int32_t run_begin = 0, run_end = 0;  ///< RegisterPlan::runs: rows of its boundary to rows of the parent
};

struct RegisterFront {
  tree::FrontId front = tree::none;
  int eliminated = 0, boundary = 0;
  int group = 0;             ///< RegisterPlan::groups
  bool is_exported = false;  ///< its parent is not in registers
  int move_begin = 0, move_end = 0;
  int gap_begin = 0, gap_end = 0;  ///< RegisterPlan::gaps: registers without contributions
  int child_begin = 0, child_end = 0;
  int own_begin = 0, own_end = 0;            ///< RegisterPlan::unknown_runs of eliminated unknowns
  int boundary_begin = 0, boundary_end = 0;  ///< and of its boundary, with rows counted on
  std::int64_t values = 0;                   ///< first entry of its element matrices, in the element store
  std::int64_t num_values = 0;               ///< their number of doubles
  std::int64_t factor = 0;                   ///< first double of the factor
  std::int64_t vector = 0;                   ///< first of the `eliminated` results of forward substitution
  std::int64_t schur = 0;                    ///< first double of its boundary's rows, in the group's memory
  int size() const { return eliminated + boundary; }
  int registers() const {
    return size() / row_register + 1;
  }  ///< of a row; the right-hand side is the last lane of the last
  int step() const { return registers() * row_register; }  ///< between rows of the front
  int schur_step() const { return (boundary / row_register + 1) * row_register; }
  std::int64_t schur_size() const { return static_cast<std::int64_t>(boundary) * schur_step(); }
  /// `eliminated` rows [L11, D^-1, U], then rows of L21, which symmetric fronts omit.
  std::int64_t factor_size(bool is_symmetric) const {
    return static_cast<std::int64_t>(eliminated) * (size() + (is_symmetric ? 0 : boundary));
  }
};

/// A leaf whose fronts are in registers, except the root's.
struct RegisterGroup {
  int front_begin = 0, front_end = 0;  ///< RegisterPlan::fronts, children first
  std::int64_t schur = 0;              ///< first double of its memory
};

struct RegisterPlan {
  std::vector<RegisterGroup> groups;  ///< by group of the lane plan; empty for groups that are not in registers
  std::vector<RegisterFront> fronts;
  std::vector<RegisterMove> moves;
  std::vector<std::int32_t> gaps;  ///< targets, as for moves
  std::vector<RegisterChild> children;
  std::vector<LaneRun> runs;
  std::vector<UnknownRun> unknown_runs;
  std::vector<int> front_of;  ///< by front of the tree: index in fronts, or -1
  std::int64_t schur_size = 0, factor_size = 0, vector_size = 0;
};

/// Whether a leaf's fronts fit into registers: all of them, or all but the root's, which determines the rank.
bool fits_registers(const tree::Tree& tree, tree::SubdomainId leaf);

/// The rows of an element are contiguous in the element store, from LanePlan::element_first on.
RegisterPlan make_register_plan(const blocks::BlockGraph& graph, const tree::Tree& tree, const LanePlan& lanes,
                                bool is_symmetric);

}  // namespace bough::solve
