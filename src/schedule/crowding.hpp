#pragma once
/// Detects whether other programs take processors away from this process.
#include <chrono>

namespace bough::schedule {

/// The sign is the rate at which the threads of the process lose a processor that they would have kept (involuntary
/// context switches). A process with processors of its own has a few tens of them per second; beside one busy loop on
/// two processors it has 400 to 1200. Measured durations are a poor sign: elements with tangents take four times as
/// long as without.
///
/// Once threads give way voluntarily they are not interrupted any more, and the sign disappears. Crowding is therefore
/// assumed to last for some time, and for longer each time that it is found again immediately. All objects of the
/// process share this duration, so that short runs need not detect crowding anew.
class Crowding {
 public:
  /// Whether there is crowding. The answer is renewed every few milliseconds; in between the last one is returned.
  /// Costs one reading of the clock.
  bool look();

 private:
  using Clock = std::chrono::steady_clock;

  Clock::time_point begin_{}, next_look_{};  ///< of the switches that are counted
  long switches_ = -1;                       ///< number of switches at `begin_`; -1: not yet read
  bool is_crowded_ = false;
};

}  // namespace bough::schedule
