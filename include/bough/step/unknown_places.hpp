#pragma once
/// Places of nodes, joints and their multipliers in the vectors of unknowns of the linear solver.
#include <cstdint>
#include <type_traits>
#include <vector>

#include "bough/plan/plan.hpp"

namespace bough::step {

/// Increments of nodes in a vector x of unknowns.
struct NodeIncrements {
  const double* x;
  const std::int64_t* unknown_begin;  ///< by node; -1: it has no unknowns
  const char* is_point;               ///< by node: it has displacements alone; null: there is no such node
};

class UnknownPlaces {
 public:
  /// unknown_begin: the first unknown of each block of the plan's graph, and their number; it must outlive this object.
  UnknownPlaces(const plan::Plan& plan, const std::vector<std::int64_t>& unknown_begin);

  std::size_t size() const { return static_cast<std::size_t>(block_begin_.back()); }
  int num_blocks() const { return plan_.graph.num_blocks(); }
  std::int64_t block_begin(int block) const { return block_begin_[static_cast<std::size_t>(block)]; }
  int block_size(int block) const { return static_cast<int>(block_begin(block + 1) - block_begin(block)); }
  /// First unknown of a node; -1: it has none.
  std::int64_t node_begin(int node) const { return node_begin_[static_cast<std::size_t>(node)]; }
  NodeIncrements increments(const double* x) const {
    return {x, node_begin_.data(), plan_.unknowns.is_point.empty() ? nullptr : plan_.unknowns.is_point.data()};
  }

  /// The motion of a node in a vector of unknowns, (linear; angular) in its own axes. A node without unknowns does not
  /// move.
  motion::Vec6<double> node_part(const double* x, int node) const {
    const std::int64_t begin = node_begin(node);
    if (begin < 0) return motion::Vec6<double>::zero();
    return plan_.unknowns.expanded(x + begin, static_cast<std::size_t>(node));
  }
  /// The same on the group of the scene.
  template <class G>
  typename G::template Vector<double> part_on(const double* x, int node) const {
    if constexpr (std::is_same_v<G, motion::Se3>) return node_part(x, node);
    const std::int64_t begin = node_begin(node);
    typename G::template Vector<double> v = G::template Vector<double>::zero();
    const int count = begin < 0 ? 0 : plan_.unknowns.count_of(static_cast<std::size_t>(node));
    for (int i = 0; i < count; ++i) v[i] = x[begin + i];
    return v;
  }
  /// Sets the unknowns of a node from a motion, or the entries of a right-hand side from a wrench. Does nothing for a
  /// node without unknowns.
  void set_node_part(double* x, int node, const motion::Vec6<double>& eta) const {
    const std::int64_t begin = node_begin(node);
    if (begin >= 0) plan_.unknowns.project(eta, static_cast<std::size_t>(node), x + begin);
  }
  /// The same on the group of a reduced model.
  template <int N>
  void set_node_part(double* x, int node, const lanes::Vec<double, N>& eta) const {
    const std::int64_t begin = node_begin(node);
    const int count = begin < 0 ? 0 : plan_.unknowns.count_of(static_cast<std::size_t>(node));
    for (int i = 0; i < count; ++i) x[begin + i] = eta[i];
  }

  /// A multiplier that is an unknown.
  struct Multiplier {
    std::size_t multiplier;  ///< index in State::multipliers
    std::size_t unknown;
    bool is_of_length;  ///< of a constraint of a length, not of an angle: the multiplier is a force
  };
  /// Joint after joint, each in the order of its rows.
  const std::vector<Multiplier>& multipliers() const { return multipliers_; }
  /// The unknown of each signal, in the order of Plan::signals.
  const std::vector<std::size_t>& signals() const { return signals_; }

 private:
  const plan::Plan& plan_;
  const std::vector<std::int64_t>& block_begin_;
  std::vector<std::int64_t> node_begin_;
  std::vector<Multiplier> multipliers_;
  std::vector<std::size_t> signals_;
};

}  // namespace bough::step
