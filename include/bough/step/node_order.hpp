#pragma once
/// Nodes in groups of eight, by the visits of the solver's walks in which their unknowns are found.
#include <array>
#include <span>
#include <vector>

#include "bough/plan/plan.hpp"
#include "bough/solve/report.hpp"
#include "bough/step/visit_ranges.hpp"

namespace bough::step {

/// Nodes that are moved together, one in each lane of a pack. Lanes from `count` on repeat the last node, so that
/// maxima over lanes need no special case.
struct NodeEight {
  std::array<int, 8> node{};
  int count = 0;
  bool is_run = false;  ///< eight nodes one after the other
};

class NodeOrder {
 public:
  NodeOrder(const plan::Plan& plan, const solve::SolverVisits& visits);

  /// Visit after visit, then the nodes without unknowns; within each in ascending order of nodes.
  const std::vector<NodeEight>& eights() const { return eights_; }
  /// The eights of nodes without unknowns, which no correction moves.
  std::span<const NodeEight> held_eights() const {
    return std::span(eights_).subspan(static_cast<std::size_t>(by_visit_.count()));
  }
  const VisitRanges& by_visit() const { return by_visit_; }
  /// Where a node is: in lane `lane` of an eight, and in `copies` - 1 lanes behind it.
  struct Place {
    std::size_t eight;
    int lane, copies;
  };
  Place place(std::size_t node) const { return places_[node]; }
  std::size_t num_nodes() const { return places_.size(); }

 private:
  std::vector<NodeEight> eights_;
  VisitRanges by_visit_;
  std::vector<Place> places_;  ///< by node
};

}  // namespace bough::step
