#include <sys/utsname.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <ctime>
#include <exception>
#include <fstream>
#include <mutex>
#include <thread>

#include "bough/lanes/instruction_set.hpp"
#include "bough/study/errors.hpp"
#include "bough/study/sweep.hpp"
#include "references.hpp"
#include "sampled_run.hpp"

namespace bough::study {
namespace {

/// f(0) to f(count - 1) on several threads, in any order. The first exception is passed on.
template <class F>
void for_each_index(std::size_t count, int threads, const F& f) {
  std::atomic<std::size_t> next{0};
  std::exception_ptr trouble;
  std::mutex guard;
  const auto work = [&] {
    for (std::size_t k = next++; k < count; k = next++) {
      try {
        f(k);
      } catch (...) {
        const std::lock_guard lock(guard);
        if (!trouble) trouble = std::current_exception();
        next = count;
      }
    }
  };
  std::vector<std::thread> others;
  for (int t = 1; t < std::min(threads, static_cast<int>(count)); ++t) others.emplace_back(work);
  work();
  for (std::thread& other : others) other.join();
  if (trouble) std::rethrow_exception(trouble);
}

SweepMachine this_machine() {
  SweepMachine machine;
  machine.processor = "unknown";
  machine.instruction_set = lanes::instruction_set().name;
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);)
    if (line.starts_with("model name") && line.find(": ") != std::string::npos) {
      machine.processor = line.substr(line.find(": ") + 2);
      break;
    }
  if (utsname names{}; uname(&names) == 0)
    machine.system = std::string(names.sysname) + " " + names.release + " " + names.machine;
  machine.cores = static_cast<int>(std::thread::hardware_concurrency());
  return machine;
}

std::string date_of_today() {
  const std::time_t now = std::time(nullptr);
  std::tm utc{};
  gmtime_r(&now, &utc);
  char text[32];
  return {text, std::strftime(text, sizeof text, "%Y-%m-%d %H:%M UTC", &utc)};
}

/// Choices along all axes except one.
std::string label_of(const io::StudyGrid& grid, const std::vector<std::size_t>& c, std::size_t left_out) {
  std::string label;
  for (std::size_t a = 0; a < grid.axes.size(); ++a) {
    if (a == left_out) continue;
    const io::StudyAxis& axis = grid.axes[a];
    label += (label.empty() ? "" : ", ") + axis.name + " " + axis.choices[c[a]].label;
  }
  return label;
}

int threads_of(const io::StudyGrid& grid, const SweepRun& run) {
  for (std::size_t a = 0; a < grid.axes.size(); ++a)
    if (const int threads = grid.axes[a].choices[run.choices[a]].threads; threads > 0) return threads;
  return 1;
}

/// Whether the abscissa of a grid is the size of steps in time.
bool is_over_steps(const io::StudyGrid& grid) {
  const std::vector<io::StudyChoice>& choices = grid.axes[grid.abscissa].choices;
  return std::all_of(choices.begin(), choices.end(), [](const io::StudyChoice& choice) {
    return std::any_of(choice.overrides.begin(), choice.overrides.end(),
                       [](const std::string& o) { return o.starts_with("/analysis/step_size="); });
  });
}

/// A study in progress.
class Sweep {
 public:
  Sweep(const io::StudySpec& spec, const SweepOptions& options)
      : options_(options), limits_{spec.time_limit, &options_.stop}, cache_(options.cache) {
    result_.spec = spec;
    result_.threads = options.threads;
    result_.repetitions = options.repetitions > 0 ? options.repetitions : spec.repetitions;
    result_.machine = this_machine();
    result_.date = date_of_today();
    plan_runs();
  }

  SweepResult run() {
    compute_references();
    measure_errors();
    measure_times();
    make_series();
    make_pairs();
    advise();
    result_.was_stopped = is_stopped();
    return std::move(result_);
  }

 private:
  bool is_stopped() const { return options_.stop && options_.stop(); }

  void tell(const std::string& what, std::size_t done, std::size_t all) {
    const std::lock_guard lock(guard_);
    if (options_.progress) options_.progress(what, done, all);
  }

  scene::Scene scene_of(const std::vector<std::string>& overrides) const {
    return study_scene(result_.spec, overrides);
  }
  scene::Scene scene_of(const SweepRun& run) const {
    return scene_of(io::overrides_of(result_.spec, result_.spec.grids[run.grid], run.choices));
  }

  void plan_runs() {
    for (std::size_t g = 0; g < result_.spec.grids.size(); ++g) {
      const io::StudyGrid& grid = result_.spec.grids[g];
      for (std::vector<std::size_t>& c : io::combinations_of(grid)) {
        SweepRun run;
        run.grid = g;
        run.label = label_of(grid, c, grid.axes.size());
        run.abscissa = grid.axes[grid.abscissa].choices[c[grid.abscissa]].number;
        run.choices = std::move(c);
        run.errors.resize(result_.spec.quantities.size());
        result_.runs.push_back(std::move(run));
      }
    }
    values_.resize(result_.runs.size());
  }

  void compute_references() {
    ReferenceRuns references = plan_references(result_.spec);
    const std::vector<double> times = io::sample_times(result_.spec);
    std::atomic<std::size_t> done{0};
    // the time limit of runs does not apply to computed references, which may take longer
    const RunLimits unlimited{0.0, &options_.stop};
    for_each_index(references.runs.size(), options_.threads, [&](std::size_t k) {
      ReferenceRun& r = references.runs[k];
      if (std::optional<io::History> kept = cache_.find(r.from)) {
        r.run.samples = std::move(*kept);
        r.run.sample_times = times;
        r.run.summary.status = records::RunStatus::ok;
        r.is_cached = true;
      } else {
        r.run = run_sampled(scene_of(r.overrides), times, 1, unlimited);
        if (r.run.ok()) cache_.keep(r.from, r.run.samples);
      }
      tell("references", ++done, references.runs.size());
    });
    for (std::size_t g = 0; g < result_.spec.grids.size(); ++g) {
      references_.push_back(make_reference(result_.spec, references, g));
      result_.references.push_back(references_.back().told);
    }
  }

  void measure_errors() {
    const std::vector<double> times = io::sample_times(result_.spec);
    std::atomic<std::size_t> done{0};
    for_each_index(result_.runs.size(), options_.threads, [&](std::size_t k) {
      SweepRun& run = result_.runs[k];
      if (is_stopped()) return;
      const SampledRun sampled =
          run_sampled(scene_of(run), times, threads_of(result_.spec.grids[run.grid], run), limits_);
      note(run, sampled);
      tell("errors", ++done, result_.runs.size());
    });
  }

  void note(SweepRun& run, const SampledRun& sampled) {
    run.status = sampled.summary.status;
    run.cause = sampled.summary.cause;
    run.steps = sampled.summary.steps;
    run.num_samples = sampled.samples.rows.size();
    run.solver = sampled.summary.solver;
    run.solver.emplace_back("linear_backward_error_max", sampled.summary.checks.linear_backward_error_max);
    run.final_values = sampled.summary.final_values;
    const GridReference& reference = references_[run.grid];
    if (!sampled.ok() || !reference.told.trouble.empty()) return;
    for (std::size_t q = 0; q < run.errors.size(); ++q) {
      const io::StudyQuantity& quantity = result_.spec.quantities[q];
      Samples values = sampled.of(quantity.columns);
      run.errors[q] = eval_errors(quantity.kind, values, reference.values[q], reference.told.scales[q]);
      if (is_over_steps(result_.spec.grids[run.grid])) values_of(run).push_back(std::move(values));
    }
  }
  std::vector<Samples>& values_of(const SweepRun& run) {
    return values_[static_cast<std::size_t>(&run - result_.runs.data())];
  }

  /// Rounds over all runs, alternately forwards and backwards, so that a temporary load of the machine affects all runs
  /// alike.
  void measure_times() {
    const std::size_t count = result_.runs.size(), all = count * static_cast<std::size_t>(result_.repetitions);
    for (int round = 0; round < result_.repetitions; ++round)
      for (std::size_t k = 0; k < count; ++k) {
        SweepRun& run = result_.runs[round % 2 == 0 ? k : count - 1 - k];
        if (is_stopped()) return;
        if (run.status == records::RunStatus::ok) time(run);
        tell("run times", static_cast<std::size_t>(round) * count + k + 1, all);
      }
  }

  void time(SweepRun& run) {
    const int threads = threads_of(result_.spec.grids[run.grid], run);
    const TimedRun timed = run_timed(scene_of(run), io::sample_times(result_.spec), threads, limits_, threads == 1);
    if (timed.was_stopped) return;
    run.wall.push_back(timed.wall);
    run.cpu.push_back(timed.cpu);
    if (timed.instructions) run.instructions = timed.instructions;
    if (timed.summary.status != records::RunStatus::ok) {
      run.status = timed.summary.status;
      run.cause = "a repetition failed: " + timed.summary.cause;
    }
    run.is_repeatable = run.is_repeatable && timed.summary.final_values == run.final_values;
  }

  void make_series() {
    for (std::size_t k = 0; k < result_.runs.size(); ++k) {
      const SweepRun& run = result_.runs[k];
      const io::StudyGrid& grid = result_.spec.grids[run.grid];
      std::string label = label_of(grid, run.choices, grid.abscissa);
      if (label.empty()) label = grid.name;
      auto found = std::find_if(result_.series.begin(), result_.series.end(),
                                [&](const SweepSeries& s) { return s.grid == run.grid && s.label == label; });
      if (found == result_.series.end()) {
        result_.series.push_back({run.grid, label, {}, {}});
        found = result_.series.end() - 1;
      }
      found->runs.push_back(k);
    }
    for (SweepSeries& series : result_.series) fit(series);
  }

  /// Appends a series of pairs to every series over steps that are halved and whose orders theory states.
  void make_pairs() {
    const std::size_t count = result_.series.size();
    for (std::size_t s = 0; s < count; ++s) {
      const std::vector<std::size_t> runs = result_.series[s].runs;  // from coarse to fine
      SweepSeries pairs{result_.series[s].grid, result_.series[s].label + ", pairs extrapolated", {}, {}};
      if (!is_over_steps(result_.spec.grids[pairs.grid])) continue;
      for (std::size_t k = 1; k < runs.size(); ++k) {
        constexpr double round_off = 1e-9;
        const SweepRun &fine = result_.runs[runs[k]], &coarse = result_.runs[runs[k - 1]];
        if (std::abs(coarse.abscissa - 2.0 * fine.abscissa) > round_off * coarse.abscissa) continue;
        if (values_[runs[k]].empty() || values_[runs[k - 1]].empty()) continue;
        pairs.runs.push_back(result_.runs.size());
        result_.runs.push_back(pair_of(runs[k], runs[k - 1], result_.series[s].fits));
      }
      if (pairs.runs.empty()) continue;
      fit(pairs);
      for (OrderFit& f : pairs.fits) {  // theory is that of single runs
        f.expected = unmeasured;
        f.theory = f.explanation = {};
        judge(f);
      }
      result_.series.push_back(std::move(pairs));
    }
  }

  SweepRun pair_of(std::size_t k_fine, std::size_t k_coarse, const std::vector<OrderFit>& fits) const {
    const SweepRun &fine = result_.runs[k_fine], &coarse = result_.runs[k_coarse];
    SweepRun pair = fine;
    pair.label += ", extrapolated with twice the step";
    pair.pair = {k_fine, k_coarse};
    pair.solver.clear();
    pair.final_values.clear();
    pair.steps.accepted += coarse.steps.accepted;
    pair.steps.rejected += coarse.steps.rejected;
    pair.steps.newton_iterations += coarse.steps.newton_iterations;
    pair.steps.factorizations += coarse.steps.factorizations;
    if (pair.instructions && coarse.instructions)
      *pair.instructions += *coarse.instructions;
    else
      pair.instructions.reset();
    const auto add = [](std::vector<double>& to, const std::vector<double>& more) {
      to.resize(std::min(to.size(), more.size()));
      for (std::size_t i = 0; i < to.size(); ++i) to[i] += more[i];
    };
    add(pair.wall, coarse.wall);
    add(pair.cpu, coarse.cpu);
    const GridReference& reference = references_[fine.grid];
    pair.told_over_true.assign(pair.errors.size(), unmeasured);
    for (std::size_t q = 0; q < pair.errors.size(); ++q) {
      pair.errors[q] = {};
      const double order = fits[q].expected;
      if (std::isnan(order)) continue;
      const io::QuantityKind kind = result_.spec.quantities[q].kind;
      const double scale = reference.told.scales[q];
      const Samples limit = extrapolated(kind, values_[k_fine][q], values_[k_coarse][q], order);
      pair.errors[q] = eval_errors(kind, limit, reference.values[q], scale);
      pair.told_over_true[q] = eval_errors(kind, values_[k_fine][q], limit, scale).max / fine.errors[q].max;
    }
    return pair;
  }

  void fit(SweepSeries& series) {
    const io::StudyGrid& grid = result_.spec.grids[series.grid];
    const bool larger = grid.axes[grid.abscissa].larger_is_finer;
    const auto size = [&](std::size_t k) {
      const double x = result_.runs[k].abscissa;
      return larger ? 1.0 / x : x;
    };
    std::stable_sort(series.runs.begin(), series.runs.end(),
                     [&](std::size_t a, std::size_t b) { return size(a) > size(b); });
    std::vector<double> h;
    for (const std::size_t k : series.runs) h.push_back(size(k));
    for (std::size_t q = 0; q < result_.spec.quantities.size(); ++q) {
      std::vector<double> errors;
      for (const std::size_t k : series.runs) errors.push_back(result_.runs[k].errors[q].max);
      OrderFit f = fit_order(h, errors, references_[series.grid].told.uncertainties[q]);
      for (std::size_t& k : f.runs) k = series.runs[k];
      for (const io::StudyOrder& o : grid.orders) {
        if (o.quantity != q) continue;
        f.expected = o.order;
        f.theory = o.theory;
        f.explanation = o.explanation;
      }
      judge(f);
      series.fits.push_back(std::move(f));
    }
  }

  void advise() {
    for (std::size_t q = 0; q < result_.spec.quantities.size(); ++q) {
      std::vector<std::string> kinds;
      for (const SweepReference& reference : result_.references)
        if (std::find(kinds.begin(), kinds.end(), reference.errors_of[q]) == kinds.end())
          kinds.push_back(reference.errors_of[q]);
      for (const std::string& kind : kinds) advise(q, kind);
    }
  }

  void advise(std::size_t q, const std::string& kind) {
    for (const double wanted : result_.spec.wanted) {
      SweepAdvice advice{q, kind, wanted, std::nullopt};
      double quickest = HUGE_VAL;
      for (std::size_t k = 0; k < result_.runs.size(); ++k) {
        const SweepRun& run = result_.runs[k];
        const double seconds = spread_of(run.wall).median;
        if (result_.references[run.grid].errors_of[q] != kind) continue;
        if (run.status != records::RunStatus::ok || std::isnan(seconds) || std::isnan(run.errors[q].max)) continue;
        if (run.errors[q].max > wanted || seconds >= quickest) continue;
        quickest = seconds;
        advice.run = k;
      }
      result_.advice.push_back(advice);
    }
  }

  SweepOptions options_;
  RunLimits limits_;
  ReferenceCache cache_;
  SweepResult result_;
  std::vector<GridReference> references_;
  std::vector<std::vector<Samples>> values_;  ///< by run and quantity, where its grid is one over steps
  std::mutex guard_;
};

}  // namespace

SweepResult run_sweep(const io::StudySpec& spec, const SweepOptions& options) { return Sweep(spec, options).run(); }

std::size_t SweepResult::num_runs() const {
  return static_cast<std::size_t>(
      std::count_if(runs.begin(), runs.end(), [](const SweepRun& run) { return !run.pair; }));
}

std::size_t SweepResult::num_failed() const {
  return static_cast<std::size_t>(std::count_if(
      runs.begin(), runs.end(), [](const SweepRun& run) { return run.status != records::RunStatus::ok; }));
}

std::size_t SweepResult::num_orders(Verdict verdict) const {
  std::size_t count = 0;
  for (const SweepSeries& s : series)
    count += static_cast<std::size_t>(
        std::count_if(s.fits.begin(), s.fits.end(), [&](const OrderFit& f) { return f.verdict == verdict; }));
  return count;
}

}  // namespace bough::study
