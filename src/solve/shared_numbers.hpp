#pragma once
/// Arrays of numbers of which many are equal. Internal to solve.
#include <cstdint>
#include <vector>

#include "line_allocator.hpp"

namespace bough::solve {

/// Doubles on the boundary of a cache line.
using LaneDoubles = std::vector<double, LineAllocator<double>>;

/// Arrays written one after the other. Arrays with equal bits are stored once, so that the arrays that a walk reads
/// stay in the nearest cache.
class SharedNumbers {
 public:
  /// Reserves memory for `count` arrays of `numbers` doubles in total if all differ; memory that is not written is not
  /// taken from the system.
  SharedNumbers(std::int64_t count, std::int64_t numbers);
  void clear();
  /// The next array, filled with `value`, to be written until end(). No allocation. size: a multiple of a line.
  double* begin(std::int64_t size, double value);
  void end();
  const double* of(int index) const { return values_.data() + begin_[static_cast<std::size_t>(index)]; }
  std::int64_t memory_bytes() const;  ///< of the arrays written

 private:
  LaneDoubles values_;
  std::vector<std::int64_t> begin_, size_;  ///< by array
  std::vector<int> table_;                  ///< index of a stored array by its hash; -1: none
  std::size_t count_ = 0;
};

}  // namespace bough::solve
