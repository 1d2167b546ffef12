#include "crowding.hpp"

#include <sys/resource.h>

#include <algorithm>
#include <mutex>
#include <utility>

namespace bough::schedule {

namespace {

using Clock = std::chrono::steady_clock;
using namespace std::chrono_literals;

constexpr auto between_looks = 8ms;
constexpr auto window = 40ms;       // after this time the count starts again
constexpr auto probe = 16ms;        // as `window`, directly after a period of crowding
constexpr long many_switches = 14;  // within a window: 350 per second; without other programs bursts of 11 occur
constexpr long many_in_probe = 5;   // a lower limit, since there was crowding a moment ago
constexpr Clock::duration shortest_while = 250ms, longest_while = 2s;

long count_switches() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return usage.ru_nivcsw;
}

/// The time until which the processors are assumed to be crowded, for the whole process.
class While {
 public:
  Clock::time_point end() const {
    const std::lock_guard lock(mutex_);
    return end_;
  }

  void begin(Clock::time_point now) {
    const std::lock_guard lock(mutex_);
    if (now < end_) return;  // another thread has just found the same
    length_ = now - end_ < 2 * window ? std::min(2 * length_, longest_while) : shortest_while;
    end_ = now + length_;
  }

 private:
  mutable std::mutex mutex_;
  Clock::time_point end_{};
  Clock::duration length_ = shortest_while;
};

While& while_crowded() {
  static While of_the_process;
  return of_the_process;
}

}  // namespace

bool Crowding::look() {
  const auto now = Clock::now();
  if (now < next_look_) return is_crowded_;
  next_look_ = now + between_looks;
  const long switches = count_switches();
  const bool is_probe = now - while_crowded().end() < window;
  const bool counts =
      switches_ >= 0 && !is_crowded_ && now - begin_ <= window + between_looks;  // a longer window is ignored
  if (counts && switches - switches_ >= (is_probe ? many_in_probe : many_switches)) while_crowded().begin(now);
  const bool was_crowded = std::exchange(is_crowded_, now < while_crowded().end());
  if (switches_ < 0 || is_crowded_ || was_crowded || now - begin_ >= (is_probe ? probe : window)) {
    begin_ = now;
    switches_ = switches;
  }
  return is_crowded_;
}

}  // namespace bough::schedule
