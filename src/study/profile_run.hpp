#pragma once
/// One run with a timed walker, and its measurements. Internal to study.
#include <functional>
#include <optional>
#include <vector>

#include "bough/run/simulate.hpp"
#include "bough/schedule/timed_walker.hpp"

namespace bough::study {

struct WatchedRun {
  records::Summary summary;
  schedule::WalkTimes start;    ///< times before the first step: consistent start, first accelerations
  schedule::WalkTimes times;    ///< times of the whole run
  std::vector<double> steps;    ///< wall time of each accepted step [s]
  std::vector<double> watched;  ///< wall times of the steps whose visits were timed
  struct StepMark {
    double begin, seconds;  ///< since the timing began [s]
  };
  std::vector<StepMark> kept_steps;  ///< steps whose events were kept
};

struct WatchedRunOptions {
  int threads = 1;
  long steps = 200;          ///< most accepted steps
  bool keep_events = false;  ///< from the third step on, or from the first if there are fewer
  bool want_motion = false;
};

/// Runs a scene. Visits are timed in the first 16 steps and in every seventh step after them: timing is a noticeable
/// share of small steps, and medians do not need more. (The interval is odd because factorizations are often renewed in
/// every second step.) `look` is called once after the last step.
WatchedRun watch_run(const scene::Scene& scene, const WatchedRunOptions& options, records::Recorder& recorder,
                     const run::ProgressCallback& progress,
                     const std::function<void(step::System&, const step::State&)>& look = {});

/// A recorder that discards everything.
class NullRecorder final : public records::Recorder {
 public:
  void begin(const records::HistoryHeader&) override {}
  void row(const records::HistoryRow&) override {}
  void motion(const records::MotionFrame&) override {}
  void end(const records::Summary&) override {}
};

/// The tree on which a run spent most of its factorizations, among those with the given number of visits; null if none
/// was walked.
const schedule::TreeTimes* walked_tree(const schedule::WalkTimes& times, std::size_t num_visits);

}  // namespace bough::study
