#pragma once
/// How the cost of something grows with its size, by the processor's time of this thread: other programs do not count.
#include <time.h>

#include <algorithm>
#include <functional>

namespace bough::test {

inline double thread_seconds() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

/// Least time of three runs of one size.
inline double least_seconds(const std::function<void()>& run) {
  double least = 1e300;
  for (int k = 0; k < 3; ++k) {
    const double start = thread_seconds();
    run();
    least = std::min(least, thread_seconds() - start);
  }
  return least;
}

/// Time of sixteen times the size over that of the size: 16 and what caches and allocation add where cost is linear, 256
/// where it is quadratic.
inline double growth_by_sixteen(const std::function<std::function<void()>(int)>& prepare, int size) {
  const double small = least_seconds(prepare(size));
  return least_seconds(prepare(16 * size)) / std::max(small, 1e-4);
}

inline constexpr double linear_by_sixteen = 80.0;  ///< far from both

}  // namespace bough::test
