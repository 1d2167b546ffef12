#pragma once
/// Disjoint sets of the nodes of a plan, and of the ground.
#include <numeric>
#include <vector>

#include "bough/elements/port.hpp"

namespace bough::plan {

/// Union-find over the nodes; the ground is the last member.
class Sets {
 public:
  explicit Sets(std::size_t nodes) : parent_(nodes + 1) { std::iota(parent_.begin(), parent_.end(), std::size_t{0}); }
  std::size_t ground() const { return parent_.size() - 1; }
  /// The representative of a node's set.
  std::size_t of(std::size_t node) {
    while (parent_[node] != node) node = parent_[node] = parent_[parent_[node]];
    return node;
  }
  /// Merges two sets; the representative of b becomes that of both.
  void join(std::size_t a, std::size_t b) { parent_[of(a)] = of(b); }
  std::size_t index(const elements::Port& port) const {
    return port.node == elements::ground ? ground() : static_cast<std::size_t>(port.node);
  }
  std::size_t of(const elements::Port& port) { return of(index(port)); }

 private:
  std::vector<std::size_t> parent_;
};

}  // namespace bough::plan
