#include "sampled_run.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>
#include <stdexcept>

#include "bough/io/number_text.hpp"
#include "bough/io/read_scene.hpp"
#include "bough/run/simulate.hpp"
#include "instruction_counter.hpp"

namespace bough::study {
namespace {

constexpr double same_time = 1e-9;   // relative to the end time: times within it are equal
constexpr int no_rows = 1000000000;  // stride beyond any run

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

double process_cpu_seconds() {
  timespec t{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

/// Keeps the header only; rows are stored as samples.
class HeaderKeeper final : public records::Recorder {
 public:
  explicit HeaderKeeper(SampledRun& run) : run_(run) {}
  void begin(const records::HistoryHeader& header) override { run_.samples.header = header; }
  void row(const records::HistoryRow&) override {}
  void motion(const records::MotionFrame&) override {}
  void end(const records::Summary&) override {}

 private:
  SampledRun& run_;
};

/// Reads the clocks at the begin and at the end of the steps.
class Stopwatch final : public records::Recorder {
 public:
  explicit Stopwatch(TimedRun& run, bool count_instructions) : run_(run) {
    if (count_instructions) counter_.emplace();
  }
  void begin(const records::HistoryHeader&) override {
    if (counter_) counter_->start();
    cpu_ = process_cpu_seconds();
    wall_ = Clock::now();
  }
  void row(const records::HistoryRow&) override {}
  void motion(const records::MotionFrame&) override {}
  void end(const records::Summary&) override {
    run_.wall = seconds_since(wall_);
    run_.cpu = process_cpu_seconds() - cpu_;
    if (counter_) run_.instructions = counter_->stop();
  }

 private:
  TimedRun& run_;
  std::optional<InstructionCounter> counter_;
  double cpu_ = 0.0;
  Clock::time_point wall_;
};

/// Runs a scene within limits; a run that was interrupted counts as failed.
records::Summary run_limited(const scene::Scene& scene, const std::vector<double>& sample_times, int threads,
                             const RunLimits& limits, records::Recorder& recorder, bool& was_stopped,
                             run::SimulateOptions options = {}) {
  const Clock::time_point start = Clock::now();
  bool is_late = false;
  options.threads = threads;
  options.stops = sample_times;
  options.before_step = [&](step::System&, const step::State&, const run::BeforeStep&) {
    was_stopped = limits.stop != nullptr && *limits.stop && (*limits.stop)();
    is_late = limits.time_limit > 0.0 && seconds_since(start) > limits.time_limit;
    return !was_stopped && !is_late;
  };
  records::Summary summary = run::simulate(scene, options, recorder);
  if (is_late) {
    summary.status = records::RunStatus::failed;
    summary.cause = "it takes longer than the time_limit of " + io::rounded_text(limits.time_limit, 6) + " s";
  }
  return summary;
}

}  // namespace

std::vector<std::vector<double>> SampledRun::of(const std::vector<std::size_t>& columns) const {
  std::vector<std::vector<double>> values(sample_times.size());
  std::size_t k = 0;
  for (const records::HistoryRow& row : samples.rows) {
    while (k < sample_times.size() && std::abs(sample_times[k] - row.time) > same_time * sample_times.back()) ++k;
    if (k == sample_times.size()) break;
    for (const std::size_t c : columns) values[k].push_back(row.values[c]);
  }
  return values;
}

scene::Scene study_scene(const io::StudySpec& spec, const std::vector<std::string>& overrides) {
  io::SceneFile file = io::read_scene_text(spec.scene_text, spec.scene_name, overrides, spec.scene_folder);
  if (!file.ok()) throw std::logic_error("a study runs sound scenes only: " + file.problems.front().text());
  return std::move(file.scene);
}

SampledRun run_sampled(scene::Scene scene, const std::vector<double>& sample_times, int threads,
                       const RunLimits& limits) {
  scene.output = {};
  scene.analysis.errors = {};
  scene.output.checks = false;
  scene.output.stride = no_rows;
  SampledRun run;
  run.sample_times = sample_times;
  HeaderKeeper header(run);
  run::SimulateOptions options;
  options.sample = [&run](double time, const std::vector<double>& values) {
    records::HistoryRow row;
    row.time = time;
    row.values = values;
    run.samples.rows.push_back(std::move(row));
  };
  run.summary = run_limited(scene, sample_times, threads, limits, header, run.was_stopped, options);
  return run;
}

TimedRun run_timed(scene::Scene scene, const std::vector<double>& sample_times, int threads, const RunLimits& limits,
                   bool count_instructions) {
  scene.output = {};
  scene.analysis.errors = {};
  scene.output.checks = false;
  scene.output.stride = no_rows;
  TimedRun run;
  Stopwatch watch(run, count_instructions);
  run.summary = run_limited(scene, sample_times, threads, limits, watch, run.was_stopped);
  return run;
}

}  // namespace bough::study
