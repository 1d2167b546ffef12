#pragma once
/// Independent tasks beside each other.
#include <functional>
#include <vector>

namespace bough::schedule {

/// Runs all tasks on up to `threads` threads of a oneTBB arena of its own, and returns when all have ended. The tasks
/// are begun in their order. With one thread, or without TBB, they run one after the other in the calling thread. An
/// exception is passed on after all tasks have ended, of several that of the first task in their order. Tasks may make
/// `Threads` of their own.
void run_side_by_side(int threads, const std::vector<std::function<void()>>& tasks);

}  // namespace bough::schedule
