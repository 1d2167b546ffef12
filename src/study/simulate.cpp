#include "bough/study/simulate.hpp"

#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include "bough/results/balance.hpp"
#include "bough/results/observe.hpp"
#include "bough/schedule/threads.hpp"
#include "bough/step/advance.hpp"
#include "effective_options.hpp"
#include "solver_figures.hpp"
#include "vibration_watch.hpp"

namespace bough::study {

namespace {

using results::RunStatus;
using results::Summary;

/// One run as it goes: state, observers, summary.
class Run {
 public:
  Run(const scene::Scene& scene, const SimulateOptions& options, results::Recorder& recorder,
      const ProgressCallback& progress)
      : scene_(scene),
        options_(step::make_step_options(scene.analysis)),
        recorder_(recorder),
        progress_(progress),
        before_step_(options.before_step),
        want_motion_(options.want_motion || scene.output.motion),
        threads_(std::max(1, scene.solver.tasks ? options.threads : 1)),
        plan_(plan::make_plan(scene)),
        system_(plan_, scene.solver, threads_.walker()),
        state_(step::make_initial_state(plan_)),
        work_meter_(plan_) {
    if (plan_.is_dynamic && options_.integrator == scene::Integrator::variational)
      variational_.emplace(system_, scene.solver, options_.newmark_beta);
    summary_.scene = scene.name;
    summary_.title = scene.title;
    summary_.threads = threads_.count();
    summary_.options = effective_options(scene, options_);
    summary_.header = results::make_header(plan_);
    summary_.notes = plan_.notes;
    summary_.checks.evaluated = scene.output.checks;
    for (const scene::Expected& e : scene.expected) {
      const auto column = std::find(summary_.header.columns.begin(), summary_.header.columns.end(), e.quantity);
      if (column != summary_.header.columns.end())
        expected_columns_.push_back(static_cast<std::size_t>(column - summary_.header.columns.begin()));
      else
        expected_columns_.push_back(std::numeric_limits<std::size_t>::max());
      expected_values_.push_back(std::numeric_limits<double>::quiet_NaN());
      expected_distance_.push_back(std::numeric_limits<double>::infinity());
    }
  }

  Summary run() {
    const auto start = std::chrono::steady_clock::now();
    recorder_.begin(summary_.header);
    summary_.status = RunStatus::failed;
    if (scene_.analysis.kind == scene::AnalysisKind::statics)
      run_statics();
    else
      run_dynamics();
    summary_.times.total = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    finish();
    recorder_.end(summary_);
    return summary_;
  }

 private:
  bool fail(const std::string& cause) {
    summary_.status = RunStatus::failed;
    summary_.cause = cause;
    return false;
  }

  /// Keeps the largest deficiency of an accepted step, with the reactions that were not unique then.
  void watch_dependent_rows() {
    const int deficiency = system_.solver().last_status().deficiency;
    if (deficiency <= dependent_rows_) return;
    dependent_rows_ = deficiency;
    not_unique_.clear();
    for (int b : system_.solver().blocks_not_unique())
      not_unique_ += (not_unique_.empty() ? "" : ", ") + system_.block_name(b);
  }

  void note(const std::string& text) {
    if (std::find(summary_.notes.begin(), summary_.notes.end(), text) == summary_.notes.end())
      summary_.notes.push_back(text);
  }

  void count(const step::StepReport& report, bool accepted) {
    (accepted ? summary_.steps.accepted : summary_.steps.rejected) += 1;
    summary_.steps.newton_iterations += report.iterations;
    if (accepted && report.at_floor) summary_.checks.round_off_floor_reached = true;
    if (accepted) watch_dependent_rows();
    if (!accepted && first_rejection_.empty())
      first_rejection_ = "the first rejected step was that from " + std::to_string(state_.time) + ": " + report.cause;
  }

  /// The variational integrator damps nothing: ends a run whose unresolved vibrations make energy out of nothing.
  bool watch_vibrations() {
    if (!variational_) return true;
    if (const auto text = vibrations_.look(*variational_, state_.time)) note(*text);
    if (!vibrations_.seen()) return true;
    balance_.compare(results::eval_measures(system_, state_), work_meter_.supply());
    const auto cause = vibrations_.judge(balance_, state_.time);
    return cause ? fail(*cause) : true;
  }

  /// Records the state (as its time's left limit, or right limit at a start).
  void record(int iterations, bool is_last) {
    const double before = static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
    const long row = rows_++;
    const bool due = row % std::max(1, scene_.output.stride) == 0 || is_last;
    if (due || near_expected()) {
      results::eval_sensors(system_, state_, values_);
      watch_expected();
    }
    if (due && scene_.output.checks) check();
    if (due) {
      results::HistoryRow out;
      out.time = state_.time;
      out.step_size = rows_ == 1 ? 0.0 : last_step_;
      out.iterations = iterations;
      out.values = values_;
      recorder_.row(out);
      summary_.final_values = values_;
    }
    if (want_motion_ && (row % std::max(1, scene_.output.motion_stride) == 0 || is_last))
      recorder_.motion(results::eval_motion(system_, state_));
    summary_.times.output += static_cast<double>(std::clock()) / CLOCKS_PER_SEC - before;
  }

  /// Whether this may be the step next to the time of an expected figure.
  bool near_expected() const {
    return std::any_of(scene_.expected.begin(), scene_.expected.end(), [this](const scene::Expected& e) {
      return e.time && std::abs(*e.time - state_.time) <= scene_.analysis.step_size;
    });
  }

  void watch_expected() {
    for (std::size_t i = 0; i < scene_.expected.size(); ++i) {
      if (expected_columns_[i] >= values_.size()) continue;
      const double distance = scene_.expected[i].time ? std::abs(*scene_.expected[i].time - state_.time) : 0.0;
      if (distance <= expected_distance_[i]) {
        expected_distance_[i] = distance;
        expected_values_[i] = values_[expected_columns_[i]];
      }
    }
  }

  bool report_progress(const step::StepReport& report, double end) {
    if (!progress_) return true;
    results::Progress p;
    p.time = state_.time;
    p.end_time = end;
    p.step_size = last_step_;
    p.iterations = report.iterations;
    p.step = summary_.steps.accepted;
    if (progress_(p)) return true;
    summary_.status = RunStatus::interrupted;
    summary_.cause = "stopped by the user at time " + std::to_string(state_.time);
    return false;
  }

  bool may_try(double target) {
    if (!before_step_ || before_step_(system_, state_, {options_, summary_.steps.accepted + 1, target})) return true;
    summary_.status = RunStatus::interrupted;
    summary_.cause = "stopped before the step to " + std::to_string(target);
    return false;
  }

  /// Balances and violations of the present state.
  void check() {
    summary_.checks.constraint_violation_position =
        std::max(summary_.checks.constraint_violation_position, system_.constraint_violation(state_, 0));
    if (!plan_.is_dynamic) return;
    summary_.checks.constraint_violation_velocity =
        std::max(summary_.checks.constraint_violation_velocity, system_.constraint_violation(state_, 1));
    balance_.compare(results::eval_measures(system_, state_), work_meter_.supply());
  }

  /// Work and energies are looked at in every step.
  bool has_balance() const { return scene_.output.checks || variational_.has_value(); }

  bool run_statics();
  bool run_dynamics();
  bool start_segment(double step_size, bool is_first);
  bool run_segment(double begin, double end, double& sum_of_cuts);
  void finish();

  const scene::Scene& scene_;
  step::StepOptions options_;
  results::Recorder& recorder_;
  const ProgressCallback& progress_;
  const decltype(SimulateOptions::before_step)& before_step_;
  bool want_motion_;
  schedule::Threads threads_;
  plan::Plan plan_;
  step::System system_;
  std::optional<step::Variational> variational_;  ///< when chosen
  step::State state_;
  results::WorkMeter work_meter_;
  Summary summary_;
  results::Balance balance_;
  std::vector<double> values_;
  std::vector<std::size_t> expected_columns_;
  std::vector<double> expected_values_, expected_distance_;
  std::string first_rejection_, not_unique_;
  int dependent_rows_ = 0;
  VibrationWatch vibrations_;
  long rows_ = 0;
  double last_step_ = 0.0;
};

/// Load steps with cut-back: a step that fails is halved, and doubled again after success.
bool Run::run_statics() {
  if (const auto t = system_.set_time(0.0)) return fail(t->text);
  record(0, false);
  const int steps = std::max(1, scene_.analysis.load_steps);
  for (int k = 0; k < steps; ++k) {
    int level = 0;  // the step is cut into 2^level parts
    long part = 0;  // parts of the present level done
    while (part < (1L << level)) {
      const double from = static_cast<double>(k) / steps, width = 1.0 / steps;
      const double target = part + 1 == (1L << level) && k + 1 == steps
                                ? 1.0
                                : from + width * static_cast<double>(part + 1) / static_cast<double>(1L << level);
      if (!may_try(target)) return false;
      const double before = state_.time;
      const step::StepReport report = step::equilibrate(system_, state_, options_, target);
      count(report, report.converged);
      if (!report.converged) {
        if (++level > options_.max_cuts)
          return fail("no equilibrium at load factor " + std::to_string(target) + ": " + report.cause);
        part *= 2;
        continue;
      }
      last_step_ = target - before;
      step::accept_turns(system_, state_);
      ++part;
      while (level > 0 && part % 2 == 0) {
        part /= 2;
        --level;
      }
      record(report.iterations, target == 1.0);
      if (!report_progress(report, 1.0)) return false;
    }
  }
  summary_.status = RunStatus::ok;
  return true;
}

bool Run::start_segment(double step_size, bool is_first) {
  elements::Measures before;
  if (!is_first && has_balance()) before = results::eval_measures(system_, state_);
  const step::StartReport consistent = step::make_consistent(system_, state_, is_first, step_size);
  if (!consistent.ok) return fail(consistent.cause);
  if (is_first && consistent.position_correction > 1e-9)
    note("the start was moved by up to " + std::to_string(consistent.position_correction) +
         " (relative) to close the joints");
  if (consistent.velocity_change > 1e-9) {
    char text[160];
    std::snprintf(
        text, sizeof text,
        "velocities were made consistent with joints and drives at time %.6g by impulses of up to %.3g N s (N m s)",
        state_.time, consistent.velocity_impulse);
    note(text);
  }
  if (has_balance()) {
    const elements::Measures now = results::eval_measures(system_, state_);
    work_meter_.begin(system_, state_);
    if (is_first)
      balance_.begin(now);
    else
      balance_.jump(before, now);
  }
  if (is_first) record(0, false);
  if (variational_) {
    const auto t = variational_->start(state_);
    return t ? fail(t->text) : true;
  }
  const step::StartReport started = step::start_alpha(system_, state_, options_, step_size);
  if (!started.ok) return fail(started.cause);
  return true;
}

/// Steps of equal size from one breakpoint to the next; a step that fails is halved, and the size grows back after four easy steps.
bool Run::run_segment(double begin, double end, double& total_end) {
  const double wanted = scene_.analysis.step_size;
  const long steps = std::max(1L, static_cast<long>(std::ceil((end - begin) / wanted - 1e-9)));
  const double h = (end - begin) / static_cast<double>(steps);
  int level = 0, easy = 0;
  long done = 0;  // in units of h / 2^level
  if (!start_segment(h, begin == 0.0)) return false;
  while (done < (steps << level)) {
    const double size = h / static_cast<double>(1L << level);
    if (variational_) {
      state_.step_size = size;
    } else if (const auto changed = step::change_step_size(system_, state_, options_, size); !changed.ok) {
      return fail(changed.cause);
    }
    const long next = done + 1;
    const double target = next == (steps << level) ? end : begin + static_cast<double>(next) * size;
    if (!may_try(target)) return false;
    const step::StepReport report = variational_ ? variational_->advance(state_, options_, target)
                                                 : step::advance(system_, state_, options_, target);
    count(report, report.converged);
    if (!report.converged) {
      easy = 0;
      if (++level > options_.max_cuts)
        return fail("the step at time " + std::to_string(state_.time) + " fails down to a step size of " +
                    std::to_string(size) + ": " + report.cause +
                    (vibrations_.seen() ? "; " + std::string(undamped) : ""));
      done *= 2;
      continue;
    }
    done = next;
    last_step_ = size;
    if (options_.single_solution && summary_.steps.accepted == 1)
      note("one linear solution per step: residuals are not driven to the tolerance");
    step::accept_turns(system_, state_);
    if (has_balance()) work_meter_.add(system_, state_, size);
    const bool goes_on = watch_vibrations();
    record(report.iterations, target == total_end || !goes_on);
    if (!goes_on) return false;
    if (!report_progress(report, total_end)) return false;
    if (level > 0 && done % 2 == 0 && ++easy >= 4 && report.iterations <= options_.max_iterations / 2) {
      done /= 2;
      --level;
      easy = 0;
    }
  }
  return true;
}

bool Run::run_dynamics() {
  double end = scene_.analysis.end_time;
  std::vector<double> cuts{0.0, end};
  for (const plan::LawPlan& law : plan_.laws)
    for (double t : law.law.breakpoints(0.0, end)) cuts.push_back(t);
  std::sort(cuts.begin(), cuts.end());
  const double least = 1e-9 * scene_.analysis.step_size;
  std::vector<double> times{0.0};
  for (double t : cuts)
    if (t > times.back() + least && t < end - least) times.push_back(t);
  times.push_back(end);
  for (std::size_t k = 0; k + 1 < times.size(); ++k)
    if (!run_segment(times[k], times[k + 1], end)) return false;
  summary_.status = RunStatus::ok;
  return true;
}

void Run::finish() {
  const step::WorkCounts& work = system_.counts();
  summary_.steps.factorizations = work.factorizations;
  summary_.times.assemble = work.assemble;
  summary_.times.factor = work.factor;
  summary_.times.solve = work.solve;
  summary_.times.update = work.update;
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  summary_.memory_peak_bytes = static_cast<std::int64_t>(usage.ru_maxrss) * 1024;
  summary_.checks.linear_backward_error_max = work.backward_error_max;
  summary_.checks.energy_balance = balance_.energy_error();
  summary_.checks.energy_scale = balance_.energy_scale();
  summary_.checks.numerical_dissipation = std::max(0.0, -balance_.last_energy_error());
  summary_.checks.momentum_balance = balance_.momentum_error();
  if (dependent_rows_ > 0)
    note(std::to_string(dependent_rows_) +
         " constraint row(s) depend on others: the motion is unique, the reactions of these are not: " + not_unique_);
  if (!first_rejection_.empty() && summary_.status != RunStatus::failed) note(first_rejection_);
  if (summary_.checks.round_off_floor_reached)
    note("some steps were accepted at the round-off floor of the residual, above the tolerance asked for");
  for (std::size_t i = 0; i < scene_.expected.size(); ++i) {
    results::ExpectedResult e;
    const scene::Expected& given = scene_.expected[i];
    e.name = given.quantity + (given.time ? " at " + std::to_string(*given.time) : "");
    e.value = expected_values_[i];
    e.reference = given.value;
    e.tolerance = given.tolerance;
    e.reached = !given.time || !plan_.is_dynamic || *given.time <= scene_.analysis.end_time * (1.0 + 1e-12);
    const bool at_time = !given.time || expected_distance_[i] <= 0.5 * scene_.analysis.step_size;
    e.holds =
        summary_.status == RunStatus::ok && e.reached && at_time && std::abs(e.value - e.reference) <= e.tolerance;
    e.source = given.source;
    summary_.expected.push_back(e);
  }
  summary_.solver = solver_figures(system_, dependent_rows_);
}

}  // namespace

Summary simulate(const scene::Scene& scene, const SimulateOptions& options, results::Recorder& recorder,
                 const ProgressCallback& progress) {
  Run run(scene, options, recorder, progress);
  return run.run();
}

}  // namespace bough::study
