#pragma once
/// A walker that wraps another one and times its visits. The solver that is walked is not aware of it.
#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "bough/tree/walker.hpp"

namespace bough::schedule {

constexpr int num_works = 6;   ///< of tree::Work
constexpr int num_stages = 5;  ///< of tree::Stage

/// Times of all walks of one kind over one tree [s]. Samples are rows of num_visits values; every `stride`-th walk was
/// sampled.
struct WorkTimes {
  std::int64_t walks = 0;
  std::int64_t stride = 1;
  std::vector<float> visit;                          ///< duration of each visit, by sample and visit
  std::vector<float> wait;                           ///< upward walks: from the end of its last child until its start
  std::array<std::vector<float>, num_stages> stage;  ///< parts of the visits: factor, forward, backward
  std::vector<float> shared;                         ///< factor: seconds of a visit in loops that threads share out
  std::vector<float> parts;                          ///< factor: into how many parts, on average over these seconds
  std::vector<float> wall;                           ///< duration of the whole walk, by sample
  double wall_sum = 0.0;                             ///< over all walks
};

struct TreeTimes {
  int num_visits = 0;
  std::array<WorkTimes, num_works> work;  ///< by tree::Work
};

/// Times of all chunks of one kind.
struct ChunkTimes {
  std::int64_t count = 0;     ///< of calls
  double wall_sum = 0.0;      ///< over all calls [s]
  double work_sum = 0.0;      ///< over all chunks [s]
  std::int64_t grain = 1;     ///< items of a chunk
  std::vector<double> chunk;  ///< summed over the calls, by chunk [s]; of tree::Work::evaluate
};

/// One visit or chunk, with its time.
struct TimedEvent {
  tree::Work work = tree::Work::other;
  bool is_chunk = false;
  int item = 0;  ///< visit, or first item of the chunk
  int thread = 0;
  float seconds = 0.0f;
  double begin = 0.0;  ///< since the timing began [s]
};

struct WalkTimes {
  std::vector<TreeTimes> trees;  ///< in the order in which they were first walked
  std::array<ChunkTimes, num_works> chunks;
  std::vector<double> thread_busy;  ///< seconds spent in visits and chunks, by thread
  std::vector<TimedEvent> events;
  std::int64_t events_left_out = 0;
  double seconds_per_tick = 0.0;
};

/// Limits of the amount of data kept.
struct TimedWalkerOptions {
  std::int64_t most_samples = 1 << 20;  ///< values of each series; above it every other sample is dropped.
  std::int64_t most_events = 50000;
};

/// Times every visit whose Visit::work is named, and every chunk that is not part of a visit. It costs two readings of
/// the clock per visit, one per stage (some 30 instructions each), and a row of numbers per sampled walk. The visits of
/// one walk may run on any thread; walks must not overlap.
class TimedWalker {
 public:
  explicit TimedWalker(const tree::Walker& inner, const TimedWalkerOptions& options = {});
  ~TimedWalker();
  TimedWalker(const TimedWalker&) = delete;
  TimedWalker& operator=(const TimedWalker&) = delete;

  /// Valid while this object exists.
  tree::Walker walker();
  /// After watch(false), walks and chunks are passed on without timing, until watch(true). Timing is on at first.
  void watch(bool on);
  /// Switches the recording of events on or off. It is off at first.
  void keep_events(bool keep);
  /// Ticks since the timing began, for events of the caller; WalkTimes::seconds_per_tick converts them at the end.
  std::uint64_t now() const;
  /// All times so far.
  WalkTimes times() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace bough::schedule
