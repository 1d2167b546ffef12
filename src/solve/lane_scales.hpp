#pragma once
/// Scales of fronts in lanes. Internal to solve.
#include <cstdint>
#include <vector>

#include "element_store.hpp"
#include "lane_plan.hpp"
#include "shared_numbers.hpp"

namespace bough::solve {

/// Row scales of every row of a front and inverse column scales of its eliminated unknowns, in packs; 1 for padding.
/// Fronts with equal scales in every lane, as those of equal links, share them, so that they stay in the nearest cache.
class LaneScales {
 public:
  /// Reserves memory for the scales of all fronts if all differ; memory that is not written is not taken from the
  /// system.
  explicit LaneScales(const LanePlan& lanes);
  /// Computes the scales of all fronts of the plan anew. No allocation.
  void set(const LanePlan& lanes, const tree::Tree& tree, const Scales& scales);
  const double* row(int front) const { return numbers_.of(front); }
  const double* inverse_column(const LaneFront& f, int front) const { return row(front) + f.size() * lanes_wide; }
  std::int64_t memory_bytes() const { return numbers_.memory_bytes(); }

 private:
  SharedNumbers numbers_;
};

}  // namespace bough::solve
