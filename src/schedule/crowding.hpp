#pragma once
/// Whether other programs take this process's processors away.
#include <chrono>

namespace bough::schedule {

/// Told by how often the threads of the process lose a processor that they would have kept (involuntary switches). A
/// process that has its processors to itself meets a few tens of them a second; beside one loop on two processors it
/// is 400 to 1200. Times, by contrast, tell little: elements with tangents take four times as long as without.
///
/// While it lasts the sign is gone, since who gives way is no longer interrupted; so it is taken to last for a while,
/// and for longer each time that it is found again at once. All objects of the process share how long, so that short
/// runs need not find it anew.
class Crowding {
 public:
  /// Looks every few milliseconds at most; in between the last answer stands. Costs one reading of the clock.
  bool look();

 private:
  using Clock = std::chrono::steady_clock;

  Clock::time_point begin_{}, next_look_{};  ///< of the switches that are counted
  long switches_ = -1;                       ///< at `begin_`; -1: never looked
  bool is_crowded_ = false;
};

}  // namespace bough::schedule
