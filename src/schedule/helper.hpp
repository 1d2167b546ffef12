#pragma once
/// A second thread that may lose its processor at any time, and how one thread works on beside it.
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <memory>
#include <mutex>

#include "bough/tree/walker.hpp"

namespace bough::schedule {

/// One thread, the owner, works; another serves. A walk is cut in two; the helper goes through the second half while
/// the owner does the first, and the owner then does what the helper has left, however little that one has done.
/// Nobody waits for a thread without a processor, unless it loses it in the middle of a visit, which costs a clock
/// tick or two.
///
/// A scheduler that is fair takes the processor from whoever had more than his share, and gives it at once to whoever
/// wakes up and had less. So the helper works in bursts shorter than a scheduler's slice, sleeps between them, and is
/// woken only while it has had less than its share of the time. To give a processor up instead of sleeping (as idle
/// threads of oneTBB do, a hundred times before they sleep) is to get it back with a clock tick, milliseconds later.
/// The helper is kept off the owner's processor: whoever is woken up may else be put beside his waker.
class Helper {
 public:
  Helper();
  ~Helper();
  Helper(const Helper&) = delete;
  Helper& operator=(const Helper&) = delete;

  /// Serves after a `call`, until `dismiss` or until nothing was offered for 5 ms and no part of a walk is being
  /// shared: the thread may be the only one that others of the process could have. The owner's own call returns at
  /// once, as does one that was not asked for.
  void serve();

  // All that follows is for the owner, except `run_chunks`.

  /// Whether another thread has to be sent to `serve`, because none is there or on its way. The caller is the owner
  /// from then on.
  bool call();

  /// Whoever serves returns soon.
  void dismiss();

  /// Bursts without regard to the helper's share of the time: for tests.
  void set_tireless(bool yes) { is_tireless_ = yes; }

  void walk_up(const tree::Tree& tree, tree::Visit visit);
  void walk_down(const tree::Tree& tree, tree::Visit visit);
  /// Visits may call it. They, whoever makes them, do all chunks themselves; outside of walks they are shared.
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

  /// Both parts, which do not depend on one another.
  void share(const Part& mine, const Part& other);
  /// Offers the other part, or what is left of it, if the helper is there and has time to spend.
  void offer();
  /// Until the helper no longer works on the other part.
  void recall();
  void count_burst();
  void burst();

  struct Places;
  std::unique_ptr<Places> places_;
  std::mutex mutex_;
  std::condition_variable to_helper_, to_owner_;
  std::atomic<Stage> stage_{Stage::absent};
  std::atomic<bool> is_recalled_{false};
  Part other_;               ///< begin: what is to be done next. The helper's while the stage is `taken`
  Clock::duration spent_{};  ///< in the last burst; the helper's likewise
  Clock::duration credit_{};
  Clock::time_point credit_at_{};
  std::atomic<bool> is_sharing_{false};
  bool is_tireless_ = false;
};

}  // namespace bough::schedule
