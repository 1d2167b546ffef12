#pragma once
/// A walker that times the visits of another one. The solver that is walked knows nothing of it.
#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "bough/tree/walker.hpp"

namespace bough::schedule {

constexpr int num_works = 6;   ///< of tree::Work
constexpr int num_stages = 4;  ///< of tree::Stage

/// All walks of one kind over one tree [s]. Samples are rows of num_visits; every `stride`-th walk was sampled.
struct WorkTimes {
  std::int64_t walks = 0;
  std::int64_t stride = 1;
  std::vector<float> visit;  ///< duration of each visit, by sample and visit
  std::vector<float> wait;   ///< upward: from when the last of its children was done until its start
  std::array<std::vector<float>, num_stages> stage;  ///< parts of the visits; factor only
  std::vector<float> wall;                           ///< by sample: duration of the whole walk
  double wall_sum = 0.0;                             ///< over all walks
};

struct TreeTimes {
  int num_visits = 0;
  std::array<WorkTimes, num_works> work;  ///< by tree::Work
};

/// Chunks of one kind.
struct ChunkTimes {
  std::int64_t count = 0;     ///< of calls
  double wall_sum = 0.0;      ///< over all calls [s]
  double work_sum = 0.0;      ///< over all chunks [s]
  std::int64_t grain = 1;     ///< items of a chunk
  std::vector<double> chunk;  ///< summed over the calls, by chunk [s]; of tree::Work::evaluate
};

/// One visit or chunk as it happened.
struct TimedEvent {
  tree::Work work = tree::Work::other;
  bool is_chunk = false;
  int item = 0;  ///< visit, or first item of the chunk
  int thread = 0;
  float seconds = 0.0f;
  double begin = 0.0;  ///< since the watch began [s]
};

struct WalkTimes {
  std::vector<TreeTimes> trees;  ///< in the order in which they were first walked
  std::array<ChunkTimes, num_works> chunks;
  std::vector<double> thread_busy;  ///< seconds in visits and chunks, by thread
  std::vector<TimedEvent> events;
  std::int64_t events_left_out = 0;
  double seconds_per_tick = 0.0;
};

/// Limits of what is kept.
struct TimedWalkerOptions {
  std::int64_t most_samples = 1 << 20;  ///< values of each series; above it every other sample is dropped.
  std::int64_t most_events = 50000;
};

/// Times every visit whose Visit::work is named, and every chunk that is not part of a visit. Costs two readings of
/// the clock a visit and one a stage (some 30 instructions each), and a row of numbers per sampled walk. Visits of
/// one walk may run on any thread; walks must not overlap.
class TimedWalker {
 public:
  explicit TimedWalker(const tree::Walker& inner, const TimedWalkerOptions& options = {});
  ~TimedWalker();
  TimedWalker(const TimedWalker&) = delete;
  TimedWalker& operator=(const TimedWalker&) = delete;

  /// Valid while this object lives.
  tree::Walker walker();
  /// Between false and true walks and chunks are passed on as they are. All are watched at first.
  void watch(bool on);
  /// Events are kept only between true and false. They are not at first.
  void keep_events(bool keep);
  /// Ticks since the watch began, for events of one's own; WalkTimes::seconds_per_tick tells their length in the end.
  std::uint64_t now() const;
  /// Everything so far.
  WalkTimes times() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace bough::schedule
