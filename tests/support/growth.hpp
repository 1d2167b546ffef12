#pragma once
/// Growth of a cost with the size of the input, measured in processor time of this thread, so that other programs have
/// little influence.
#include <time.h>

#include <algorithm>
#include <functional>
#include <stdexcept>
#include <string>
#include <unordered_map>
#include <vector>

namespace bough::test {

inline double thread_seconds() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

/// Least time of five runs of one size.
inline double least_seconds(const std::function<void()>& run) {
  double least = 1e300;
  for (int k = 0; k < 5; ++k) {
    const double start = thread_seconds();
    run();
    least = std::min(least, thread_seconds() - start);
  }
  return least;
}

/// A job of linear cost: n names are put into a table and looked up.
inline void fill_table(int n) {
  std::unordered_map<std::string, std::vector<double>> table;
  for (int i = 0; i < n; ++i) table["thing number " + std::to_string(i)].assign(8, 1.0 * i);
  double sum = 0.0;
  for (int i = 0; i < n; ++i) sum += table.at("thing number " + std::to_string(i)).back();
  if (sum < 0.0) throw std::logic_error("a sum of squares is negative");
}

/// Cost of sixteen times the size over the cost of the size: 16 if it is linear, 256 if it is quadratic. Large inputs
/// exceed the caches, the more so the busier the machine is, so growth is measured relative to that of a linear job of
/// the same sizes.
inline double growth_by_sixteen(const std::function<std::function<void()>(int)>& prepare, int size) {
  const double small = least_seconds(prepare(size)), small_table = least_seconds([=] { fill_table(size); });
  const double large = least_seconds(prepare(16 * size)), large_table = least_seconds([=] { fill_table(16 * size); });
  return 16.0 * large / std::max(small, 1e-4) / std::max(large_table / small_table, 16.0);
}

inline constexpr double linear_by_sixteen = 80.0;  ///< between 16 and 256, far from both

}  // namespace bough::test
