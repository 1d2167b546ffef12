#pragma once
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <memory>
#include <mutex>

namespace bough::schedule {

/// A oneTBB arena of so many threads. It starts when it is first used: oneTBB takes a third of a millisecond to examine
/// the machine, which a run without tasks does not pay.
class Arena {
 public:
  explicit Arena(int count) : count_(count) {}
  ~Arena();
  Arena(const Arena&) = delete;
  Arena& operator=(const Arena&) = delete;

  tbb::task_arena& started();

 private:
  int count_;
  tbb::task_arena arena_;
  std::once_flag is_started_;
  std::unique_ptr<tbb::global_control> allowance_;  ///< oneTBB needs it for more threads than the machine has
};

}  // namespace bough::schedule
