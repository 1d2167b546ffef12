#pragma once
/// A second thread that may lose its processor at any time, and the division of work with it.
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>

#include "bough/tree/walker.hpp"

namespace bough::schedule {

/// One thread, the owner, works, and another one, the helper, assists. A walk is divided into two halves. The helper
/// processes the second half while the owner processes the first, and then the owner completes the part of the second
/// half that the helper has not reached. The owner never waits for a thread without a processor, except when the helper
/// loses its processor in the middle of a visit, which costs one or two clock ticks.
///
/// A fair scheduler takes the processor from a thread that had more than its share, and gives it at once to a thread
/// that wakes up and had less. The helper therefore works in bursts that are shorter than a scheduler's slice, sleeps
/// between them, and is woken only while it has had less than its share of the time. If a thread yields its processor
/// instead of sleeping (as idle threads of oneTBB do a hundred times before they sleep), it gets the processor back
/// only with a clock tick, milliseconds later. The helper is kept off the owner's processor, since the system may
/// otherwise place a woken thread there.
class Helper {
 public:
  Helper();
  ~Helper();
  Helper(const Helper&) = delete;
  Helper& operator=(const Helper&) = delete;

  /// Run by the helper's thread after `call`, until `dismiss`, or until no work was offered for 5 ms and no part of a
  /// walk is being shared: the thread may be the only one available to other objects of the process. Returns at once if
  /// the owner's own thread calls it or if nobody called for help.
  void serve();

  // All following functions are for the owner, except `run_chunks`.

  /// Whether another thread has to be sent to `serve`, because none is there or on its way. The caller becomes the
  /// owner.
  bool call();

  /// Makes the serving thread return soon.
  void dismiss();

  /// For tests: bursts ignore the helper's share of the time.
  void set_tireless(bool yes) { is_tireless_ = yes; }

  void walk_up(const tree::Tree& tree, tree::Visit visit);
  void walk_down(const tree::Tree& tree, tree::Visit visit);
  /// May be called inside visits, where the calling thread does all chunks itself; outside of walks the chunks are
  /// shared.
  void run_chunks(std::int64_t count, std::int64_t grain, tree::Chunk chunk);

 private:
  using Clock = std::chrono::steady_clock;
  enum class Stage { absent, called, ready, offered, taken, done, dismissed };

  /// run(context, k) for k = begin, begin + 1, ... end - 1, in this order.
  struct Part {
    void (*run)(void* context, std::int64_t k) = nullptr;
    void* context = nullptr;
    std::int64_t begin = 0, end = 0;
  };

  /// Runs both parts, which must be independent of each other.
  void share(const Part& mine, const Part& other);
  /// Offers the other part, or the rest of it, if the helper is present and within its share of the time.
  void offer();
  /// Waits until the helper no longer works on the other part.
  void recall();
  void count_burst();
  void burst();

  struct Places;
  std::unique_ptr<Places> places_;
  std::mutex mutex_;
  std::condition_variable to_helper_, to_owner_;
  std::atomic<Stage> stage_{Stage::absent};
  std::atomic<bool> is_recalled_{false};
  Part other_;               ///< begin: the next item to do. It belongs to the helper while the stage is `taken`
  Clock::duration spent_{};  ///< in the last burst; it belongs to the helper in the same stage
  Clock::duration credit_{};
  Clock::time_point credit_at_{};
  std::atomic<bool> is_sharing_{false};
  bool is_tireless_ = false;
};

}  // namespace bough::schedule
