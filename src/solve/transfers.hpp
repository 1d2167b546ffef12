#pragma once
/// Transfers to and from memory while a front is eliminated. Internal to solve.
#include <cstdint>

namespace bough::solve {

/// Lines of memory that are prefetched or written past the caches, a few at a time between parts of a computation. All
/// at once they would fill the few buffers of a core for lines in transfer, and the computation would wait until the
/// last line has got a buffer.
class Transfers {
 public:
  /// Brings packs to the second cache.
  void fetch(const double* packs, std::int64_t count) { add(packs, nullptr, count); }
  /// Copies packs to lines of memory without reading these lines. `from` must be valid until finish(); all threads see
  /// the written lines after end_writes().
  void write(const double* from, std::int64_t count, double* to) { add(from, to, count); }
  /// Distributes all pending transfers evenly over the next `steps` calls of step().
  void spread(int steps);
  void step() {
    if (next_ < count_) move(share_);
  }
  /// Does all remaining transfers.
  void finish();
  /// Delays later stores until the lines written past the caches are in memory.
  static void end_writes();

 private:
  struct Range {
    const double* from;
    double* to;  ///< null: only prefetched
    std::int64_t count;
  };
  static constexpr int room = 64;

  void add(const double* from, double* to, std::int64_t count);
  void move(std::int64_t count);

  Range ranges_[room];
  int count_ = 0, next_ = 0;
  std::int64_t done_ = 0;                 ///< of the present range
  std::int64_t waiting_ = 0, share_ = 0;  ///< packs
};

}  // namespace bough::solve
