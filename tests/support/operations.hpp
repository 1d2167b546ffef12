#pragma once
/// Counts what looking for names costs: comparisons of texts (memcmp, bcmp) and allocations of memory, of which neither
/// depends on the machine or on what else runs on it. Include it in one file of a program: it defines the functions
/// that it counts.
#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <new>

namespace bough::test {

struct Operations {
  long comparisons = 0, allocations = 0;
};
inline Operations operations;  ///< of one thread

/// Those of a job.
inline Operations operations_of(const std::function<void()>& job) {
  const Operations before = operations;
  job();
  return {operations.comparisons - before.comparisons, operations.allocations - before.allocations};
}

/// Comparisons for eight times the size over those for the size, or the same of allocations if that is more: 8 if they
/// are in proportion, 64 if they are quadratic.
inline double growth_by_eight(const std::function<void(int)>& job, int size) {
  const Operations small = operations_of([&] { job(size); }), large = operations_of([&] { job(8 * size); });
  const auto ratio = [](long a, long b) { return static_cast<double>(a) / static_cast<double>(b); };
  return std::max(ratio(large.comparisons, small.comparisons), ratio(large.allocations, small.allocations));
}

inline constexpr double linear_by_eight = 14.0;  ///< searches in trees make 11

}  // namespace bough::test

/// Takes the place of that of the C library for all code of the program.
extern "C" int memcmp(const void* a, const void* b, std::size_t n) noexcept {
  ++bough::test::operations.comparisons;
  const auto *x = static_cast<const unsigned char*>(a), *y = static_cast<const unsigned char*>(b);
  for (std::size_t i = 0; i < n; ++i)
    if (x[i] != y[i]) return x[i] < y[i] ? -1 : 1;
  return 0;
}
/// What clang calls where only equality matters.
extern "C" int bcmp(const void* a, const void* b, std::size_t n) noexcept { return memcmp(a, b, n); }

void* operator new(std::size_t size) {
  ++bough::test::operations.allocations;
  if (void* memory = std::malloc(size > 0 ? size : 1)) return memory;
  throw std::bad_alloc();
}
// Where g++ inlines the operator delete but not the operator new, it takes free for the wrong partner.
[[gnu::noinline]] void operator delete(void* memory) noexcept { std::free(memory); }
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept { std::free(memory); }
