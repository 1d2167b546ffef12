#pragma once
/// Makes a LanePlan: the groups of sub-domains (lane_plan.cpp) and their common fronts (lane_fronts.cpp). Internal to
/// solve.
#include <optional>

#include "bough/blocks/at.hpp"
#include "lane_plan.hpp"

namespace bough::solve {

class LanePlanner {
 public:
  LanePlanner(const blocks::BlockGraph& graph, const tree::Tree& tree, bool use_lanes, Symmetry symmetry)
      : graph_(graph),
        tree_(tree),
        use_lanes_(use_lanes),
        is_symmetric_(symmetry != Symmetry::general),
        moves_(is_symmetric_) {}

  LanePlan run();

 private:
  /// Elimination, and one pass over the front for its assembly.
  static double cost_of(int eliminated, int boundary) {
    const double n = eliminated + boundary;
    return tree::elimination_flops(eliminated, boundary) + n * n;
  }
  static bool is_empty_lane(const LaneFront& f, int lane) { return f.front[at(lane)] == tree::none; }
  const tree::Front& front(tree::FrontId f) const { return tree_.fronts[at(f)]; }
  const tree::Subdomain& subdomain(tree::SubdomainId s) const { return tree_.subdomains[at(s)]; }
  int count_of(tree::SubdomainId s) const { return subdomain(s).front_end - subdomain(s).front_begin; }

  // groups
  /// Largest front of every subtree, and whether a sub-domain's own fronts are a path.
  void measure_subdomains();
  /// Front of lane s at position k of `count` common fronts, or none. Paths are aligned at their tops.
  tree::FrontId front_at(tree::SubdomainId s, int k, int count) const;
  /// Flops of two sub-domains, and of the common fronts of both; none: their fronts do not correspond.
  struct Match {
    double common, a, b;
  };
  std::optional<Match> match(tree::SubdomainId a, tree::SubdomainId b) const;
  bool fits(tree::SubdomainId a, tree::SubdomainId b) const;
  /// Makes the group of these sub-domains and, before it, the groups below. `below_lanes`: the parent's is in lanes.
  int form(std::vector<tree::SubdomainId> subdomains, bool below_lanes);
  using Classes = std::vector<std::vector<tree::SubdomainId>>;  ///< sub-domains that can share groups
  /// The children of a group's sub-domains as they are grouped.
  Classes group_children(const std::vector<tree::SubdomainId>& subdomains) const;
  /// Seconds saved by lanes for these sub-domains and all below, in a factorization and the solutions that follow.
  double gain_of_lanes(const std::vector<tree::SubdomainId>& subdomains) const;
  void place_child(tree::SubdomainId s, Classes& classes) const;
  void fill_packs(Classes& classes) const;
  int close(std::vector<tree::SubdomainId> subdomains, bool in_lanes, const std::vector<int>& children);
  void set_levels();

  // common fronts
  int size_of(int element) const;
  void add_batch(const ElementBatch& batch, int size);
  void add_fronts(LaneGroup& group, tree::Subdomain& node);
  void add_unknowns(LaneFront& f);
  /// Row of the common front for a row of a lane's front.
  int common_row(const LaneFront& f, int lane, int row) const;
  void add_elements(LaneFront& f);
  LaneElement& find_slot(const LaneFront& f, int lane, const std::vector<Run>& blocks);
  void add_children(LaneFront& f);
  void add_moves(LaneFront& f);
  /// Places Schur complements and vectors in the group's scratch by first fit. They are needed until the parent has
  /// read them on the way up; vectors also on the way down. Those of the top are kept.
  void place_work(LaneGroup& group);

  const blocks::BlockGraph& graph_;
  const tree::Tree& tree_;
  bool use_lanes_, is_symmetric_;
  std::vector<int> largest_;
  std::vector<char> is_path_;
  MovePlanner moves_;
  LanePlan plan_;
};

}  // namespace bough::solve
