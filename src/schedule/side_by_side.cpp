#include "bough/schedule/side_by_side.hpp"

#include <algorithm>
#include <atomic>
#include <exception>
#ifdef BOUGH_HAS_TBB
#include <tbb/task_group.h>

#include "arena.hpp"
#endif

namespace bough::schedule {

void run_side_by_side(int threads, const std::vector<std::function<void()>>& tasks) {
  std::vector<std::exception_ptr> failures(tasks.size());
  std::atomic<std::size_t> next{0};
  const auto work = [&] {
    for (std::size_t k; (k = next++) < tasks.size();) {
      try {
        tasks[k]();
      } catch (...) {
        failures[k] = std::current_exception();
      }
    }
  };
#ifdef BOUGH_HAS_TBB
  const int count = std::min(threads, static_cast<int>(tasks.size()));
  if (count > 1) {
    Arena arena(count);
    arena.started().execute([&] {
      tbb::task_group others;
      for (int t = 1; t < count; ++t) others.run(work);
      work();
      others.wait();
    });
  }
#else
  (void)threads;
#endif
  work();
  for (const std::exception_ptr& failure : failures)
    if (failure) std::rethrow_exception(failure);
}

}  // namespace bough::schedule
