#pragma once
/// Which nodes belong together: internal to plan.
#include <numeric>
#include <vector>

#include "bough/elements/port.hpp"

namespace bough::plan {

/// Disjoint sets of nodes; the ground is the last one.
class Sets {
 public:
  explicit Sets(std::size_t nodes) : parent_(nodes + 1) { std::iota(parent_.begin(), parent_.end(), std::size_t{0}); }
  std::size_t ground() const { return parent_.size() - 1; }
  /// The member that stands for a node's set.
  std::size_t of(std::size_t node) {
    while (parent_[node] != node) node = parent_[node] = parent_[parent_[node]];
    return node;
  }
  /// What stood for the set of b stands for both.
  void join(std::size_t a, std::size_t b) { parent_[of(a)] = of(b); }
  std::size_t index(const elements::Port& port) const {
    return port.node == elements::ground ? ground() : static_cast<std::size_t>(port.node);
  }
  std::size_t of(const elements::Port& port) { return of(index(port)); }

 private:
  std::vector<std::size_t> parent_;
};

}  // namespace bough::plan
