#pragma once
/// Unknowns of a node: all six components of its increment, or only those in which the scene, or the node, can move.
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "bough/motion/types.hpp"

namespace bough::plan {

/// A set of motions that is invariant for a scene: from a state within it, no force leads out of it.
enum class Motions : std::uint8_t {
  spatial,      ///< all
  planar,       ///< displacements in a plane, rotation about its normal: 3 unknowns a node
  translation,  ///< no rotation: 3
  line,         ///< displacements along one line, no rotation: 1
};

/// x = P eta of an increment eta of a node, (linear; angular) in its own axes, and eta = P^T x:
///   P: `count` rows of [B^T 0; 0 B^T], B a rotation that belongs to the node: Plan::axes in the node's own axes.
/// The motions lie in the range of P^T, so nothing is lost.
struct NodeUnknowns {
  Motions motions = Motions::spatial;
  int count = 6;
  std::array<int, 6> component{0, 1, 2, 3, 4, 5};  ///< of (B^T u; B^T w), for each of the `count` unknowns
  std::vector<motion::Mat3<double>> basis;         ///< B by node; empty: identities
  /// By node: a point mass, which has displacements alone, the first unknowns of the others (NodePlan::is_point). Empty
  /// where there is none, and where nothing turns.
  std::vector<char> is_point;

  bool is_whole() const { return count == 6; }
  int translations() const { return motions == Motions::planar ? 2 : std::min(count, 3); }
  bool is_point_at(std::size_t node) const { return !is_point.empty() && is_point[node] != 0; }
  /// The number of unknowns of a node.
  int count_of(std::size_t node) const { return is_point_at(node) ? translations() : count; }
  bool is_length(int unknown) const { return component[static_cast<std::size_t>(unknown)] < 3; }

  /// P^T x, without rotation for a point. The most frequent case, planar, is written out: a loop that stores components
  /// one by one makes later reads of the whole vector wait for every store.
  motion::Vec6<double> expanded(const double* x, std::size_t node) const {
    if (motions == Motions::planar && !is_point_at(node)) {
      if (basis.empty())
        return lanes::join(motion::Vec3<double>{{x[0], x[1], 0.0}}, motion::Vec3<double>{{0.0, 0.0, x[2]}});
      const motion::Mat3<double>& b = basis[node];
      motion::Vec6<double> eta;
      for (int i = 0; i < 3; ++i) {
        eta[i] = b(i, 0) * x[0] + b(i, 1) * x[1];
        eta[3 + i] = b(i, 2) * x[2];
      }
      return eta;
    }
    motion::Vec6<double> eta = motion::Vec6<double>::zero();
    for (int i = 0; i < count_of(node); ++i) eta[component[static_cast<std::size_t>(i)]] = x[i];
    if (basis.empty()) return eta;
    return lanes::join(basis[node] * lanes::linear_part(eta), basis[node] * lanes::angular_part(eta));
  }
  /// P eta, for increments as well as wrenches; the first `count_of(node)` entries of it.
  void project(const motion::Vec6<double>& eta, std::size_t node, double* x) const {
    motion::Vec6<double> turned = eta;
    if (!basis.empty())
      turned = lanes::join(lanes::transpose_times(basis[node], lanes::linear_part(eta)),
                           lanes::transpose_times(basis[node], lanes::angular_part(eta)));
    for (int i = 0; i < count_of(node); ++i) x[i] = turned[component[static_cast<std::size_t>(i)]];
  }
};

}  // namespace bough::plan
