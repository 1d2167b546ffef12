#pragma once
/// Symbolic block elimination on a quotient graph. Internal to tree.
#include <span>
#include <vector>

#include "adjacency.hpp"

namespace bough::tree {

/// A front under construction: its eliminated blocks, its boundary, and the elements and children assembled in it.
struct Group {
  std::vector<int> eliminated;  ///< block ids, in order
  std::vector<int> boundary;    ///< block ids
  std::vector<int> elements;    ///< mechanical elements assembled here
  std::vector<int> children;    ///< group ids assembled here
  bool alive = true;            ///< false once merged into its parent
};

/// The matrix as a set of cliques: at first the elements, later, as blocks are eliminated, the groups that replace
/// them. Each live clique is a list of blocks. Eliminating blocks merges all cliques that contain them into one new
/// clique without them.
class Quotient {
 public:
  explicit Quotient(const Adjacency& adjacency);

  /// Eliminates motion blocks, and with them the multipliers that one of these blocks can carry (a block of n unknowns
  /// carries n multipliers, so that the pivots exist) and the multipliers whose motion blocks are all eliminated.
  /// `forced`: live cliques that are assembled here in any case (numbers as from live_clique_of_*). Returns the id of
  /// the new group.
  int eliminate(const std::vector<int>& motion_blocks, const std::vector<int>& forced = {});

  /// Eliminates the motion blocks of a set one by one, always the one with the fewest unknowns left in its front
  /// (minimum degree; ties to the smaller id). Groups are appended.
  void eliminate_by_minimum_degree(const std::vector<int>& motion_blocks);

  /// Eliminates all remaining blocks in one group, which assembles the given live cliques.
  int eliminate_rest(const std::vector<int>& rest, const std::vector<int>& forced);

  int clique_of_group(int group) const { return num_elements_ + group; }
  bool is_live(int clique) const { return live_[static_cast<std::size_t>(clique)] != 0; }
  bool is_eliminated(int block) const { return eliminated_[static_cast<std::size_t>(block)] != 0; }

  std::vector<Group> groups;

 private:
  std::span<const int> blocks_of_clique(int clique) const;
  const std::vector<int>& live_cliques(int block);
  int degree(int block);
  void collect(const std::vector<int>& motion_blocks, const std::vector<int>& forced);
  void take_multipliers(const std::vector<int>& motion_blocks, std::vector<int>& taken);
  int finish(std::vector<int> eliminated);
  bool all_constrained_gone(int multiplier) const;

  const Adjacency& adjacency_;
  int num_elements_;
  std::vector<char> live_;                 ///< by clique
  std::vector<char> eliminated_;           ///< by block
  std::vector<int> capacity_;              ///< by block: number of multipliers that it can still carry
  std::vector<std::vector<int>> cliques_;  ///< by block: cliques that contain it (dead ones are removed when they are
                                           ///< met)
  std::vector<int> absorbed_;              ///< cliques merged by the present elimination
  std::vector<int> united_;                ///< their blocks
  std::vector<int> block_stamp_, clique_stamp_;
  int stamp_ = 0;
};

/// Merges groups [first, end) of one leaf into their parents where the merger causes no fill, or where the fill is
/// cheaper than visiting one more front [flop]. missing: number of unknowns by which the counted boundaries are too
/// small.
void amalgamate(std::vector<Group>& groups, int first, const Adjacency& adjacency, double visit_flops, int missing);

}  // namespace bough::tree
