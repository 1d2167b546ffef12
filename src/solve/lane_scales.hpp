#pragma once
/// Scales of fronts in lanes. Internal to solve.
#include <cstdint>
#include <vector>

#include "element_store.hpp"
#include "lane_plan.hpp"
#include "line_allocator.hpp"

namespace bough::solve {

/// Doubles on the boundary of a cache line.
using LaneDoubles = std::vector<double, LineAllocator<double>>;

/// Row scales of every row of a front and inverse column scales of its eliminated unknowns, in packs; 1 for padding.
class LaneScales {
 public:
  explicit LaneScales(const LanePlan& lanes);
  /// Computes the scales of all fronts of the plan anew. No allocation.
  void set(const LanePlan& lanes, const tree::Tree& tree, const Scales& scales);
  const double* row(int front) const { return values_.data() + begin_[static_cast<std::size_t>(front)]; }
  const double* inverse_column(const LaneFront& f, int front) const { return row(front) + f.size() * lanes_wide; }
  std::int64_t memory_bytes() const {
    return static_cast<std::int64_t>(values_.capacity() * sizeof(double) + begin_.capacity() * sizeof(std::int64_t));
  }

 private:
  LaneDoubles values_;
  std::vector<std::int64_t> begin_;  ///< by front
};

}  // namespace bough::solve
