#pragma once
/// What goes to and from memory while a front is eliminated. Internal to solve.
#include <cstdint>

namespace bough::solve {

/// Lines of memory that are asked for or written past the caches, a few at a time between parts of a computation. All
/// at once they would fill the few buffers that a core has for lines under way, and the computation would wait until
/// the last of them has one.
class Transfers {
 public:
  /// Brings packs to the second cache.
  void fetch(const double* packs, std::int64_t count) { add(packs, nullptr, count); }
  /// Copies packs to lines of memory without reading what stands there. `from` must last until finish(); what was
  /// written is in memory for all threads after end_writes().
  void write(const double* from, std::int64_t count, double* to) { add(from, to, count); }
  /// Spreads all that waits evenly over the next `steps` calls of step().
  void spread(int steps);
  void step() {
    if (next_ < count_) move(share_);
  }
  /// All that is left.
  void finish();
  /// Holds up later stores until the lines written past the caches are in memory.
  static void end_writes();

 private:
  struct Range {
    const double* from;
    double* to;  ///< null: fetched only
    std::int64_t count;
  };
  static constexpr int room = 64;

  void add(const double* from, double* to, std::int64_t count);
  void move(std::int64_t count);

  Range ranges_[room];
  int count_ = 0, next_ = 0;
  std::int64_t done_ = 0;                 ///< of the range at hand
  std::int64_t waiting_ = 0, share_ = 0;  ///< packs
};

}  // namespace bough::solve
