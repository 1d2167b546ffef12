#pragma once
/// A motion vector of each node, eight nodes in the lanes of a pack, as the passes over all nodes compute with them.
#include <vector>

#include "bough/elements/evaluate_lanes.hpp"

namespace bough::step {

/// Lanes behind the last node repeat it, so that maxima over lanes need no special case.
template <class G>
class NodeVectors {
 public:
  using Vector = typename G::template Vector<double>;
  using Lanes = typename G::template Vector<elements::LanePack>;

  void assign_zero(std::size_t count) {
    count_ = count;
    lanes_.assign((count + width - 1) / width, Lanes::zero());
  }
  void resize_as(const NodeVectors& like) {
    count_ = like.count_;
    lanes_.resize(like.lanes_.size());
  }

  Vector operator[](std::size_t n) const { return lanes::get_lane(lanes_[n / width], static_cast<int>(n % width)); }
  void set(std::size_t n, const Vector& v) {
    const std::size_t end = n + 1 == count_ ? width : n % width + 1;
    for (std::size_t l = n % width; l < end; ++l)
      for (int i = 0; i < G::dof; ++i) lanes_[n / width][i].set(static_cast<int>(l), v[i]);
  }
  /// Eight nodes, the first of which is `first`, a multiple of eight.
  Lanes& eight(std::size_t first) { return lanes_[first / width]; }
  const Lanes& eight(std::size_t first) const { return lanes_[first / width]; }

 private:
  static constexpr std::size_t width = elements::num_lanes;
  std::size_t count_ = 0;
  std::vector<Lanes> lanes_;
};

}  // namespace bough::step
