#pragma once
/// Memory that begins on a cache line, so that a pack of eight doubles never straddles two; what is large on large pages, so that columns
/// of a front are not one miss of the page table each. Internal to solve.
#include <cstddef>
#include <new>
#if defined(__linux__)
#include <sys/mman.h>
#endif

namespace bough::solve {

template <class T>
struct LineAllocator {
  using value_type = T;
  LineAllocator() = default;
  template <class U>
  LineAllocator(const LineAllocator<U>&) {}  // NOLINT(google-explicit-constructor): as the standard asks
  T* allocate(std::size_t n) {
    void* p = ::operator new(n * sizeof(T), alignment_of(n));
#if defined(__linux__)
    if (is_large(n)) (void)::madvise(p, n * sizeof(T), MADV_HUGEPAGE);  // a wish: nothing is lost where it is not met
#endif
    return static_cast<T*>(p);
  }
  void deallocate(T* p, std::size_t n) { ::operator delete(p, alignment_of(n)); }
  bool operator==(const LineAllocator&) const { return true; }

 private:
  static constexpr std::size_t line = 64, large_page = std::size_t{1} << 21;
  static bool is_large(std::size_t n) { return n * sizeof(T) >= 2 * large_page; }
  static std::align_val_t alignment_of(std::size_t n) { return std::align_val_t{is_large(n) ? large_page : line}; }
};

}  // namespace bough::solve
