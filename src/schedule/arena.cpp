#ifdef BOUGH_HAS_TBB
#include "arena.hpp"

#include <tbb/info.h>

namespace bough::schedule {

namespace {

/// oneTBB looks without a lock whether a global_control lives when an arena starts (2021.8, found by the thread
/// sanitizer). Runs beside each other in one process start and end theirs one by one.
std::mutex& arenas_start() {
  static std::mutex mutex;
  return mutex;
}

}  // namespace

Arena::~Arena() {
  const std::lock_guard lock(arenas_start());
  allowance_.reset();
}

tbb::task_arena& Arena::started() {
  std::call_once(is_started_, [this] {
    const std::lock_guard lock(arenas_start());
    if (count_ > tbb::info::default_concurrency())
      allowance_ = std::make_unique<tbb::global_control>(tbb::global_control::max_allowed_parallelism,
                                                         static_cast<std::size_t>(count_));
    arena_.initialize(count_);
  });
  return arena_;
}

}  // namespace bough::schedule
#endif
