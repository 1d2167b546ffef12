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

/// Row scales of every row of a front and inverse column scales of what it eliminates, in packs; 1 for padding. Fronts whose scales are the same in every
/// lane, as those of equal links are, share them: what every factorization reads then stays in the nearest cache.
class LaneScales {
 public:
  /// Room for scales of all fronts, if they all should differ; memory that is not written is not taken from the system.
  explicit LaneScales(const LanePlan& lanes);
  /// Takes the scales of all fronts of that plan anew. No allocation.
  void set(const LanePlan& lanes, const tree::Tree& tree, const Scales& scales);
  const double* row(int front) const { return values_.data() + begin_[static_cast<std::size_t>(front)]; }
  const double* inverse_column(const LaneFront& f, int front) const { return row(front) + f.size() * lanes_wide; }
  std::int64_t memory_bytes() const;  ///< of what has been written

 private:
  LaneDoubles values_;               ///< of fronts that differ
  std::vector<std::int64_t> begin_;  ///< by front
  std::vector<int> table_;           ///< a front with scales of its own by their hash, -1: none
};

}  // namespace bough::solve
