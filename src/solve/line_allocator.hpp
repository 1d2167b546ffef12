#pragma once
/// Memory that begins on a cache line, so that a pack of eight doubles never straddles two. Large blocks are on large
/// pages, so that not every column of a front causes a miss of the page table. Internal to solve.
#include <cstddef>
#include <cstdint>
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
  LineAllocator(const LineAllocator<U>&) {}  // NOLINT(google-explicit-constructor): as the standard requires
  T* allocate(std::size_t n) {
#if defined(__linux__)
    if (is_large(n)) return static_cast<T*>(map_large_pages(bytes_of(n)));
#endif
    return static_cast<T*>(::operator new (n * sizeof(T), std::align_val_t{line}));
  }
  void deallocate(T* p, std::size_t n) {
#if defined(__linux__)
    if (is_large(n)) return static_cast<void>(::munmap(p, bytes_of(n)));
#endif
    ::operator delete (p, std::align_val_t{line});
  }
  bool operator==(const LineAllocator&) const { return true; }

 private:
  static constexpr std::size_t line = 64, large_page = std::size_t{1} << 21;
  static bool is_large(std::size_t n) { return n * sizeof(T) >= 2 * large_page; }
  static std::size_t bytes_of(std::size_t n) { return (n * sizeof(T) + large_page - 1) / large_page * large_page; }
#if defined(__linux__)
  /// Allocated from the system, since memory that a heap reuses is on the small pages on which it was first written.
  static void* map_large_pages(std::size_t bytes) {
    void* room = ::mmap(nullptr, bytes + large_page, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (room == MAP_FAILED) throw std::bad_alloc();
    char* begin = static_cast<char*>(room);
    const std::size_t before = (large_page - reinterpret_cast<std::uintptr_t>(begin) % large_page) % large_page;
    if (before > 0) (void)::munmap(begin, before);
    (void)::munmap(begin + before + bytes, large_page - before);
    (void)::madvise(begin + before, bytes, MADV_HUGEPAGE);  // a hint: failure has no consequences
    return begin + before;
  }
#endif
};

}  // namespace bough::solve
