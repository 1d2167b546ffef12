#include "twins.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <limits>
#include <mutex>
#include <numeric>
#include <span>

#include "bough/io/number_text.hpp"
#include "bough/run/estimate.hpp"
#include "bough/run/simulation.hpp"
#include "bough/scene/analysis_kinds.hpp"
#include "bough/schedule/side_by_side.hpp"
#include "error_doubts.hpp"
#include "trust.hpp"
#include "twin_errors.hpp"

namespace bough::run {

using records::RunStatus;

namespace {

/// Passes a run on to its recorder, all but the end, and keeps its rows: all of them, or at least half of `most` at even
/// distances.
class Relay final : public records::Recorder {
 public:
  explicit Relay(records::Recorder& to, std::size_t most = std::numeric_limits<std::size_t>::max())
      : to_(to), most_(most) {}

  void begin(const records::HistoryHeader& header) override { to_.begin(header); }
  void row(const records::HistoryRow& row) override {
    if (count_++ % every_ == 0) {
      rows.push_back(row);
      if (rows.size() >= most_) halve();
    }
    to_.row(row);
  }
  void motion(const records::MotionFrame& frame) override { to_.motion(frame); }
  void parts(const records::MotionParts& parts) override { to_.parts(parts); }
  void end(const records::Summary&) override {}
  bool keeps_states() const override { return to_.keeps_states(); }
  void state(const records::StoredState& state) override { to_.state(state); }
  bool keeps_checkpoints() const override { return to_.keeps_checkpoints(); }
  bool is_checkpoint_due(double time, bool is_last) override { return to_.is_checkpoint_due(time, is_last); }
  void checkpoint(std::string_view state) override { to_.checkpoint(state); }
  std::string resume(const records::HistoryHeader& header) override {
    std::string state = to_.resume(header);
    goes_on = !state.empty();
    return state;
  }

  std::vector<records::HistoryRow> rows;
  bool goes_on = false;  ///< the run goes on from a checkpoint, and rows before it are not here

 private:
  void halve() {
    for (std::size_t k = 1; 2 * k < rows.size(); ++k) rows[k] = std::move(rows[2 * k]);
    rows.resize((rows.size() + 1) / 2);
    every_ *= 2;
  }

  records::Recorder& to_;
  std::size_t most_, count_ = 0, every_ = 1;
};

MemberSeries series_of(std::span<const records::HistoryRow> rows) {
  MemberSeries series;
  for (const records::HistoryRow& row : rows) {
    series.times.push_back(row.time);
    series.values.push_back(row.values);
  }
  return series;
}

/// Keeps the rows of a twin.
class RowKeeper final : public records::Recorder {
 public:
  explicit RowKeeper(MemberSeries& to) : to_(to) {}
  void begin(const records::HistoryHeader&) override {}
  void row(const records::HistoryRow& row) override {
    to_.times.push_back(row.time);
    to_.values.push_back(row.values);
  }
  void motion(const records::MotionFrame&) override {}
  void end(const records::Summary&) override {}

 private:
  MemberSeries& to_;
};

/// Times at which members are compared in dynamics: ends of the longest steps of any member, about as dense as the rows of
/// the history.
std::vector<double> times_to_compare(const scene::Scene& scene, double start, const Twins& twins) {
  constexpr double most = 1e5, round_off = 1e-9;
  double longest = 1.0;
  for (const Twin& t : twins.members)
    if (!t.is_of_mesh) longest = std::max(longest, t.factor);
  const double end = scene.analysis.end_time, step = longest * scene.analysis.step_size;
  const double every =
      std::max({1.0, std::round(scene.output.stride / longest), std::ceil((end - start) / (most * step))});
  std::vector<double> times;
  for (double k = 0.0; start + k * every * step < end - round_off * step; ++k)
    times.push_back(start + k * every * step);
  times.push_back(end);
  return times;
}

/// Times of rows of a run at which twins are compared with it after its end: where the longest of their steps end, if
/// some of the rows are there.
std::vector<double> times_of_rows(const std::vector<records::HistoryRow>& rows, double longest_step) {
  constexpr double round_off = 1e-6;  // of a step
  constexpr std::size_t fewest = 8;
  std::vector<double> at_ends, all;
  for (const records::HistoryRow& row : rows) {
    const double steps = (row.time - rows.front().time) / longest_step;
    if (std::abs(steps - std::round(steps)) < round_off) at_ends.push_back(row.time);
    all.push_back(row.time);
  }
  return at_ends.size() < fewest ? all : at_ends;
}

constexpr std::size_t most_rows = 2048;  ///< of a run that its twins are compared with only if it is doubted

/// A run and its twins, while they go on side by side or one after the other.
class RunWithItsTwins {
 public:
  RunWithItsTwins(const scene::Scene& scene, const SimulateOptions& options, records::Recorder& recorder,
                  const ProgressCallback& progress)
      : scene_(scene),
        options_(options),
        recorder_(recorder),
        progress_(progress),
        relay_(recorder, scene.analysis.errors.any() ? std::numeric_limits<std::size_t>::max() : most_rows) {}

  records::Summary run_side_by_side(const std::function<void(records::Summary&)>& judge) {
    twins_ = make_twins(scene_);
    if (scene::type_of(scene_.analysis.kind).integrates)
      times_ = times_to_compare(scene_, options_.from ? start_time(*options_.from) : 0.0, twins_);
    run_tasks({[this] { simulate_run(); }});
    conclude();
    if (judge) judge(summary_);
    recorder_.end(summary_);
    return std::move(summary_);
  }

  records::Summary run_and_check() {
    simulate_run();
    if (is_estimate_doubted(summary_)) check();
    recorder_.end(summary_);
    return std::move(summary_);
  }

 private:
  /// Runs these tasks and all twins, long ones first.
  void run_tasks(std::vector<std::function<void()>> tasks) {
    runs_.resize(twins_.members.size());
    std::vector<std::size_t> order(twins_.members.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(),
                     [this](std::size_t a, std::size_t b) { return twins_.members[a].cost > twins_.members[b].cost; });
    for (const std::size_t k : order) tasks.emplace_back([this, k] { simulate_twin(k); });
    schedule::run_side_by_side(options_.threads, tasks);
  }

  /// Its part of the threads, by its part of the work.
  int threads_for(double cost) const {
    double all = 1.0;
    for (const Twin& t : twins_.members) all += t.cost;
    return std::max(1, static_cast<int>(std::lround(options_.threads * cost / all)));
  }

  /// Samples a member at the times at which members are compared, besides the stops that the caller has.
  void sample_into(MemberSeries& series, SimulateOptions& options) const {
    if (times_.empty()) return;
    const std::vector<double> others = options.stops;
    const auto pass_on = options.sample;
    options.stops.insert(options.stops.end(), times_.begin(), times_.end());
    std::sort(options.stops.begin(), options.stops.end());
    options.stops.erase(std::unique(options.stops.begin(), options.stops.end()), options.stops.end());
    options.sample = [this, &series, others, pass_on](double time, const std::vector<double>& values) {
      if (std::binary_search(times_.begin(), times_.end(), time)) {
        series.times.push_back(time);
        series.values.push_back(values);
      }
      if (pass_on && std::binary_search(others.begin(), others.end(), time)) pass_on(time, values);
    };
  }

  void simulate_run() {
    try {
      SimulateOptions options = options_;
      options.threads = threads_for(1.0);
      options.measured = scene_.analysis.errors;
      options.checks_estimate = !options.measured.any();
      sample_into(series_, options);
      Simulation simulation(scene_, std::move(options), &relay_, [this](const records::Progress& p) {
        last_ = p;
        return !progress_ || progress_(p);
      });
      size_ = simulation.size();
      (void)simulation.run();
      summary_ = simulation.finish();
      is_stopped_ = summary_.status != RunStatus::ok;
    } catch (...) {
      is_stopped_ = true;
      throw;
    }
    has_ended_ = true;
  }

  /// Whether a twin goes on. After the end of the run twins ask for it in its place.
  bool may_go_on() {
    if (is_stopped_) return false;
    if (!has_ended_ || !progress_) return true;
    const std::lock_guard lock(asking_);
    if (!progress_(last_)) is_stopped_ = true;
    return !is_stopped_;
  }

  void simulate_twin(std::size_t k) {
    const Twin& twin = twins_.members[k];
    TwinRun& run = runs_[k];
    run.is_of_mesh = twin.is_of_mesh;
    run.factor = twin.factor;
    if (is_stopped_) return;
    const auto begun = std::chrono::steady_clock::now();
    SimulateOptions options;
    options.threads = threads_for(twin.cost);
    options.from = options_.from;
    options.before_step = [this](step::System&, const step::State&, const BeforeStep&) { return may_go_on(); };
    sample_into(run.series, options);
    MemberSeries rows;
    RowKeeper keeper(rows);
    try {
      run.summary = simulate(twin.scene, options, keeper);
    } catch (const std::exception& e) {
      run.summary.status = RunStatus::failed;
      run.summary.cause = e.what();
    }
    if (times_.empty()) run.series = std::move(rows);
    run.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
  }

  /// Twins in longer steps cost three quarters of the run. Where they do not resolve what happens, one in half the step
  /// decides, if it is not long.
  void check() {
    scene::Scene wanted = scene_;
    wanted.analysis.errors = {.time = true};
    twins_ = make_twins(wanted);
    times_ = times_of_rows(relay_.rows, twins_.members.empty() ? 1.0 : twins_.members.back().scene.analysis.step_size);
    series_ = series_of(relay_.rows);
    if (summary_.status == RunStatus::ok && !relay_.goes_on && twins_.members.size() >= 2) {
      run_tasks({});
      if (!is_stopped_ && decides(wanted, "steps twice and four times as long")) return;
      Twin half = twin_in_time(scene_, 0.5);
      if (!is_stopped_ && estimate_run(half.scene).seconds() < most_unasked_seconds) {
        std::vector<TwinRun> others = std::move(runs_);
        twins_.members.assign(1, std::move(half));
        run_tasks({});
        runs_.insert(runs_.end(), std::make_move_iterator(others.begin()), std::make_move_iterator(others.end()));
        if (!is_stopped_ && decides(wanted, "steps half, twice and four times as long")) return;
      }
    }
    keep_estimates_doubt(summary_, undecided_);
  }

  bool decides(const scene::Scene& wanted, const std::string& runs) {
    const records::MeasuredErrors errors = measure_errors({wanted, summary_, series_, relay_.rows, runs_, {}, size_});
    undecided_ = "runs in " + runs + " differ by up to " +
                 io::rounded_text(100.0 * difference_from_twins(errors, summary_), 2) +
                 " % of a range, and not as errors of second order do";
    return check_estimate(errors, runs, summary_);
  }

  void conclude() {
    if (summary_.status != RunStatus::ok) {
      summary_.notes.emplace_back("no errors were measured: the run did not reach its end");
      return;
    }
    if (is_stopped_) {
      summary_.notes.emplace_back("no errors were measured: twins of the run were stopped");
      return;
    }
    if (times_.empty()) series_ = series_of(relay_.rows);
    if (relay_.goes_on)
      twins_.remarks.emplace_back("the run went on from a checkpoint: errors are those of the time since then");
    auto errors = std::make_shared<records::MeasuredErrors>(
        measure_errors({scene_, summary_, series_, std::move(relay_.rows), std::move(runs_), twins_.remarks, size_}));
    name_coarse_beams(*errors);
    judge_errors(*errors, errors_of(scene_), summary_);
    summary_.errors = std::move(errors);
  }

  /// Of columns with an error by the mesh that is doubted the cause is the beam whose elements change them most: in runs
  /// in which one beam alone has twice as many.
  void name_coarse_beams(records::MeasuredErrors& errors) {
    constexpr std::size_t most_beams = 8;
    const std::size_t beams = scene_.beams.size();
    const auto is_open = [](const records::ErrorOf& e) {
      return e.mesh.state != records::ErrorState::round_off && e.mesh.largest > TrustLimits{}.sensor_error * e.range;
    };
    if (beams < 2 || beams > most_beams || std::none_of(errors.columns.begin(), errors.columns.end(), is_open)) return;
    if (static_cast<double>(beams) * estimate_run(scene_).seconds() > most_unasked_seconds) return;
    twins_.members = twins_of_beams(scene_);
    runs_.clear();
    run_tasks({});
    if (is_stopped_) return;
    for (std::size_t c = 0; c < errors.columns.size(); ++c) {
      if (!is_open(errors.columns[c])) continue;
      std::vector<std::pair<double, std::string>> changes;
      double all = 0.0;
      for (std::size_t b = 0; b < beams; ++b) {
        if (runs_[b].summary.status != RunStatus::ok) continue;
        const Family pair({&runs_[b].series, &series_}, 1);
        double most = 0.0;
        for (const double d : pair.differences({ComparedColumns::Kind::number, c, 1}).fine)
          most = std::max(most, std::abs(d));
        changes.emplace_back(most, scene_.beams[b].name);
        all += most;
      }
      std::sort(changes.rbegin(), changes.rend());
      if (changes.empty() || !(all > 0.0)) continue;
      const auto share = [all](double of) { return io::rounded_text(100.0 * of / all, 3) + " %"; };
      std::string& cause = errors.columns[c].mesh.cause;
      if (!cause.empty()) cause += "; ";
      cause += "'" + changes[0].second + "' makes " + share(changes[0].first) + " of it";
      constexpr double most_of_it = 0.7;
      if (changes.size() > 1 && changes[0].first < most_of_it * all)
        cause += ", '" + changes[1].second + "' " + share(changes[1].first);
      cause += ", by runs in which one beam alone has twice as many elements";
    }
  }

  const scene::Scene& scene_;
  const SimulateOptions& options_;
  records::Recorder& recorder_;
  const ProgressCallback& progress_;
  Relay relay_;
  Twins twins_;
  std::vector<double> times_;  ///< in dynamics; else rows are compared
  MemberSeries series_;
  std::vector<TwinRun> runs_;
  records::Summary summary_;
  double size_ = 0.0;      ///< of the structure [m]
  std::string undecided_;  ///< what twins tell that do not decide on the doubt of the estimate
  records::Progress last_;
  std::atomic<bool> is_stopped_{false}, has_ended_{false};
  std::mutex asking_;
};

}  // namespace

records::Summary simulate_with_twins(const scene::Scene& scene, const SimulateOptions& options,
                                     records::Recorder& recorder, const ProgressCallback& progress,
                                     const std::function<void(records::Summary&)>& judge) {
  return RunWithItsTwins(scene, options, recorder, progress).run_side_by_side(judge);
}

records::Summary simulate_and_check(const scene::Scene& scene, const SimulateOptions& options,
                                    records::Recorder& recorder, const ProgressCallback& progress) {
  return RunWithItsTwins(scene, options, recorder, progress).run_and_check();
}

}  // namespace bough::run
