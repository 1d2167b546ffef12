#pragma once
/// One run with a watched walker, and what it left behind. Internal to study.
#include <functional>
#include <optional>
#include <vector>

#include "bough/run/simulate.hpp"
#include "bough/schedule/timed_walker.hpp"

namespace bough::study {

struct WatchedRun {
  records::Summary summary;
  schedule::WalkTimes start;    ///< what was watched before the first step: consistent start, first accelerations
  schedule::WalkTimes times;    ///< in all
  std::vector<double> steps;    ///< wall time of each accepted step [s]
  std::vector<double> watched;  ///< of those whose visits were watched
  struct StepMark {
    double begin, seconds;  ///< since the watch began [s]
  };
  std::vector<StepMark> kept_steps;  ///< of the steps whose events were kept
};

struct WatchedRunOptions {
  int threads = 1;
  long steps = 200;          ///< most accepted steps
  bool keep_events = false;  ///< from the third step on, or from the first where there are fewer
  bool want_motion = false;
};

/// Runs a scene. Visits are watched in the first 16 steps, and in every seventh after them: what a watch costs is a
/// share of small steps, and medians ask for no more. (An odd number, as factors are often renewed in every second
/// step.) `look` is called once after the last step.
WatchedRun watch_run(const scene::Scene& scene, const WatchedRunOptions& options, records::Recorder& recorder,
                     const run::ProgressCallback& progress, const std::function<void(step::System&)>& look = {});

/// A recorder that keeps nothing.
class NullRecorder final : public records::Recorder {
 public:
  void begin(const records::HistoryHeader&) override {}
  void row(const records::HistoryRow&) override {}
  void motion(const records::MotionFrame&) override {}
  void end(const records::Summary&) override {}
};

/// The tree of visits that a run spent most of its factorizations on, among those with so many visits; null where
/// none was walked.
const schedule::TreeTimes* walked_tree(const schedule::WalkTimes& times, std::size_t num_visits);

}  // namespace bough::study
