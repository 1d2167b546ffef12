#include "profile_run.hpp"

#include <chrono>
#include <memory>

namespace bough::study {

constexpr long all_watched = 16, watched_stride = 7;

WatchedRun watch_run(const scene::Scene& scene, const WatchedRunOptions& options, records::Recorder& recorder,
                     const run::ProgressCallback& progress,
                     const std::function<void(step::System&, const step::State&)>& look) {
  using Clock = std::chrono::steady_clock;
  WatchedRun run;
  std::unique_ptr<schedule::TimedWalker> watch;
  Clock::time_point step_begin;
  std::uint64_t mark_begin = 0;
  std::vector<std::pair<std::uint64_t, std::uint64_t>> marks;  // begin and end of steps
  long tried = 0;
  bool is_watched = true;
  const long first_kept = options.steps >= 3 ? 3 : 1;  // caches and pages are cold in the first steps
  run::SimulateOptions simulate_options;
  simulate_options.threads = options.threads;
  simulate_options.want_motion = options.want_motion;
  simulate_options.wrap_walker = [&](const tree::Walker& inner) {
    watch = std::make_unique<schedule::TimedWalker>(inner);
    return watch->walker();
  };
  simulate_options.before_step = [&](step::System&, const step::State&, const run::BeforeStep& attempt) {
    if (attempt.number > options.steps) return false;
    if (tried++ == 0) run.start = watch->times();
    is_watched = attempt.number <= all_watched || attempt.number % watched_stride == 0;
    watch->watch(is_watched);
    if (options.keep_events && is_watched && attempt.number >= first_kept) {
      watch->keep_events(true);
      mark_begin = watch->now();
    }
    step_begin = Clock::now();
    return true;
  };
  simulate_options.after_run = [&](step::System& system, const step::State& state) {
    run.times = watch->times();
    for (const auto& [begin, end] : marks)
      run.kept_steps.push_back({static_cast<double>(begin) * run.times.seconds_per_tick,
                                static_cast<double>(end - begin) * run.times.seconds_per_tick});
    if (look) look(system, state);
  };
  const auto on_step = [&](const records::Progress& p) {
    run.steps.push_back(std::chrono::duration<double>(Clock::now() - step_begin).count());
    if (is_watched) run.watched.push_back(run.steps.back());
    if (options.keep_events && is_watched && p.step >= first_kept && marks.size() < 1000)
      marks.emplace_back(mark_begin, watch->now());
    return progress ? progress(p) : true;
  };
  scene::Scene alone = scene;
  alone.analysis.errors = {};  // twins beside it would take its processors
  run.summary = run::simulate(alone, simulate_options, recorder, on_step);
  return run;
}

const schedule::TreeTimes* walked_tree(const schedule::WalkTimes& times, std::size_t num_visits) {
  const schedule::TreeTimes* best = nullptr;
  const auto cost = [](const schedule::TreeTimes& t) {
    return t.work[static_cast<std::size_t>(tree::Work::factor)].wall_sum;
  };
  for (const schedule::TreeTimes& t : times.trees)
    if (t.num_visits == static_cast<int>(num_visits) && (best == nullptr || cost(t) > cost(*best))) best = &t;
  return best;
}

}  // namespace bough::study
