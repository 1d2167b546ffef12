#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "bough/io/number_text.hpp"
#include "bough/plan/history_header.hpp"
#include "bough/results/observe.hpp"
#include "dependent_rows.hpp"
#include "effective_options.hpp"
#include "largest_load.hpp"
#include "not_judged.hpp"
#include "run.hpp"
#include "solver_figures.hpp"
#include "trust.hpp"

namespace bough::run {

using records::RunStatus;
using records::Summary;

namespace {

/// What the scene expects, then what it measures in the same way.
std::vector<scene::Expected> figures_asked_for(const scene::Scene& scene) {
  std::vector<scene::Expected> figures = scene.expected;
  for (const scene::Measure& m : scene.measures) {
    if (!Measures::is_figure(m)) continue;
    scene::Expected figure;
    figure.quantity = m.quantity;
    figure.figure = static_cast<scene::FigureKind>(m.kind);
    figure.time = m.time;
    figure.level = m.level;
    figures.push_back(std::move(figure));
  }
  return figures;
}

/// What a measure is held against what it has to be; `how` tells how it was taken, and whether its time was reached.
records::ExpectedResult held_against(const scene::Expected& given, const records::MeasureResult& measured,
                                     records::ExpectedResult how) {
  how.name = measured.name;
  how.value = measured.value.value_or(0.0);
  how.reference = given.value;
  how.tolerance = given.allowed();
  how.source = given.source;
  how.has_value = measured.value.has_value();
  how.holds = how.reached && measured.value && std::abs(how.value - how.reference) <= how.tolerance;
  return how;
}

}  // namespace

Run::Run(const scene::Scene& scene, const SimulateOptions& options, records::Recorder& recorder,
         const ProgressCallback& progress)
    : scene_(scene),
      options_(step::make_step_options(scene.analysis)),
      recorder_(recorder),
      progress_(progress),
      stops_(options.stops),
      before_step_(options.before_step),
      stopped_by_(options.stopped_by),
      after_run_(options.after_run),
      want_motion_(options.want_motion || scene.output.motion),
      plan_(plan::make_plan(scene)),
      threads_(scene.solver.tasks && !plan_.took("small") ? std::max(1, options.threads) : 1),
      system_(plan_, scene.solver, options.wrap_walker ? options.wrap_walker(threads_.walker()) : threads_.walker()),
      state_(step::make_initial_state(plan_)),
      work_meter_(plan_),
      energy_meter_(plan_),
      asked_(figures_asked_for(scene)),
      figures_(scene, asked_, plan_, plan::make_header(plan_), options.stops, options.sample),
      measures_(scene, plan::make_header(plan_)),
      springs_(plan_) {
  options_.reuse_factors = plan_.took("reuse");
  if (plan_.is_dynamic) integrator_ = step::make_integrator(system_, scene.solver, options_);
  if (is_alpha() && (options_.step_control || scene.output.checks))
    local_error_.emplace(system_, options_, scene.analysis.end_time);
  if (plan_.is_dynamic && options_.step_control) {
    controller_.emplace(options_.step_control->tolerance);
    limit_watch_.emplace(plan_);
    if (EnergyError::is_needed(plan_)) {
      energy_error_.emplace(plan_, scene.analysis.end_time, work_meter_.mass());
      displaced_ = state_;  // a step does not allocate
    }
  }
  if (watches_error()) {
    const auto shows_reaction = [](const plan::SensorPlan& s) {
      return s.sensor.kind == scene::SensorKind::joint_reaction;
    };
    if (std::any_of(plan_.sensors.begin(), plan_.sensors.end(), shows_reaction)) reactions_.emplace(system_);
  }
  summary_.scene = scene.name;
  summary_.title = scene.title;
  summary_.threads = threads_.count();
  summary_.options = effective_options(scene, options_);
  summary_.header = plan::make_header(plan_);
  if (local_error_ && scene.output.checks) {
    error_watch_.emplace(plan_);
    displaced_ = state_;  // a step does not allocate
    for (auto* values : {&values_before_, &values_now_, &values_displaced_})
      values->reserve(summary_.header.columns.size());
    looks_every_ = looks_every(scene.analysis.end_time / scene.analysis.step_size);
  }
  summary_.notes = plan_.notes;
  summary_.checks.evaluated = scene.output.checks;
  if (!plan_.is_dynamic) stability_.emplace(scene, system_);
  summary_.follows_path = !plan_.is_dynamic && options_.arc_length.has_value();
}

Summary Run::run() {
  const auto start = std::chrono::steady_clock::now();
  recorder_.begin(summary_.header);
  summary_.status = RunStatus::failed;
  threads_.keep_together([&] {
    if (scene_.analysis.kind == scene::AnalysisKind::statics)
      (void)(options_.arc_length ? run_path() : run_statics());
    else
      run_dynamics();
  });
  summary_.times.total = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  finish();
  recorder_.end(summary_);
  return summary_;
}

bool Run::fail(const std::string& cause) {
  summary_.status = RunStatus::failed;
  summary_.cause = cause;
  return false;
}

void Run::watch_dependent_rows() {
  const int deficiency = system_.linear().solver().last_status().deficiency;
  least_dependent_rows_ = std::min(least_dependent_rows_, deficiency);
  if (deficiency <= dependent_rows_) return;
  dependent_rows_ = deficiency;
  dependent_since_ = state_.time;
  not_unique_ = dependent_groups_text(system_);
}

/// Rows that depend on others all the time leave the motion as it is. Where they come to depend the rank of the
/// constraints drops: parts can then move
/// in more ways than elsewhere, and the equations do not say which way the motion goes on.
void Run::note_dependent_rows() {
  if (dependent_rows_ <= 0) return;
  std::string text = std::to_string(dependent_rows_) + " constraint row(s) depend on others";
  if (least_dependent_rows_ < dependent_rows_)
    text += (plan_.is_dynamic ? " at time " : " at load factor ") + io::rounded_text(dependent_since_, 6) + ", and " +
            std::to_string(std::max(0, least_dependent_rows_)) +
            " elsewhere: the mechanism passes a singular position, where it can go on in more than one way, and the "
            "reactions of these are not unique: ";
  else if (plan_.is_dynamic)
    text += ": the motion is unique, the reactions of these are not: ";
  else
    text += ": the reactions of these are not unique: ";
  note(text + not_unique_);
}

void Run::note(const std::string& text) {
  if (std::find(summary_.notes.begin(), summary_.notes.end(), text) == summary_.notes.end())
    summary_.notes.push_back(text);
}

void Run::count(const step::StepReport& report) {
  if (!report.converged) return reject(report, report.cause);
  ++summary_.steps.accepted;
  summary_.steps.newton_iterations += report.iterations;
  watch_floor(report);
  watch_dependent_rows();
}

void Run::reject(const step::StepReport& report, const std::string& cause) {
  if (cause.empty()) throw std::logic_error("a step was rejected without a cause");
  ++summary_.steps.rejected;
  summary_.steps.newton_iterations += report.iterations;
  if (first_rejection_.empty())
    first_rejection_ = "the first rejected step was that from " + std::to_string(state_.time) + ": " + cause;
}

/// What steps leave unbalanced at the floor counts against the largest forces of the run: at rest there are none to
/// compare with.
void Run::watch_floor(const step::StepReport& report) {
  const step::ResidualSize& r = report.residual;
  const double arm = system_.moment_arm();
  largest_force_ = std::max({largest_force_, r.force_scale, r.moment_scale / arm});
  if (!report.at_floor) return;
  summary_.checks.round_off_floor_reached = true;
  ++summary_.checks.steps_at_floor;
  unbalanced_force_ = std::max({unbalanced_force_, r.force, r.moment / arm});
}

bool Run::watch_vibrations() {
  if (const auto text = vibrations_.look(*integrator_, state_.time)) note(*text);
  if (!vibrations_.seen()) return true;
  balance_.compare(energy_meter_.eval(system_, state_), work_meter_.supply());
  const auto cause = vibrations_.judge(balance_, state_.time);
  return cause ? fail(*cause) : true;
}

/// Bytes of one picture, compressed, as measured on lattices of 10 512 tubes and rectangular bars, largest ones: of a
/// point of a beam 50 in motion.bin (49 to 50), in a VTU file 93 and 13.2 for a corner of its section (16 corners:
/// 297 to 305; 4: 143 to 147).
constexpr double bytes_per_point = 50.0, vtu_bytes_per_point = 93.0, vtu_bytes_per_corner = 13.2;
struct PictureBytes {
  double motion = 200.0;  ///< in motion.bin
  double vtu = 4000.0;    ///< of the file for other programs
};
PictureBytes bytes_of(const records::MotionFrame& frame, const records::MotionParts& parts) {
  PictureBytes bytes;
  const auto others = static_cast<double>(frame.bodies.size() + frame.links.size() + frame.arrows.size());
  bytes.motion += 36.0 * others;
  bytes.vtu += 100.0 * others;
  for (const int mesh : parts.bodies)
    if (mesh >= 0) bytes.vtu += 16.0 * static_cast<double>(parts.meshes[static_cast<std::size_t>(mesh)].points.size());
  for (std::size_t k = 0; k < frame.curves.size(); ++k) {
    const auto points = static_cast<double>(frame.curves[k].points.size());
    const int outline = k < parts.curves.size() ? parts.curves[k].outline : -1;
    double corners = 0.0;
    if (outline >= 0)
      for (const auto& loop : parts.outlines[static_cast<std::size_t>(outline)].loops)
        corners += static_cast<double>(loop.size());
    bytes.motion += bytes_per_point * points;
    bytes.vtu += (vtu_bytes_per_point + vtu_bytes_per_corner * corners) * points;
  }
  return bytes;
}

/// At most 101 pictures, and so many that motion.bin stays below 120 MB and all files below 200 MB: where those for
/// other programs are too large for that, every second or third or so of the pictures has one.
void Run::plan_pictures(const records::MotionFrame& frame, const records::MotionParts& parts) {
  if (scene_.output.motion_stride > 0) return;
  constexpr double most = 200e6, most_motion = 120e6;
  const PictureBytes bytes = bytes_of(frame, parts);
  most_intervals_ = static_cast<int>(std::clamp(most_motion / bytes.motion - 1.0, 2.0, 100.0));
  const double left = most - bytes.motion * (most_intervals_ + 1);
  others_every_ = static_cast<int>(std::ceil(most_intervals_ / std::max(1.0, left / bytes.vtu - 1.0)));
  if (most_intervals_ == 100 && others_every_ == 1) return;
  note("of the motion " + std::to_string(most_intervals_ + 1) + " pictures are kept, and every " +
       (others_every_ == 1 ? std::string() : std::to_string(others_every_) + "th ") +
       "one as a VTU file, so that all stay below 200 MB; output.motion_stride keeps as many as it says");
}

void Run::record(int iterations, bool is_last) {
  const step::PhaseTimer timer{system_.clock(), summary_.times.output};
  const long row = rows_++;
  summary_.step_size = std::max(summary_.step_size, last_step_);
  const bool due = is_due(row, is_last);
  if ((due || !measures_.empty()) && !plan_.sensors.empty()) {
    results::eval_sensors(system_, state_, energy_meter_, values_);
    if (due && error_watch_) error_watch_->see(values_);
    if (!measures_.empty()) measures_.add(state_.time, values_);
  }
  if (due) springs_.look(system_, state_);
  if (due && scene_.output.checks) check();
  if (due) {
    row_.time = state_.time;
    row_.step_size = rows_ == 1 ? 0.0 : last_step_;
    row_.iterations = iterations;
    row_.values = values_;
    gate_.look_at(summary_.header, row_);
    recorder_.row(row_);
  }
  if (is_motion_due(row, is_last)) {
    records::MotionFrame frame = results::eval_motion(system_, state_);
    gate_.look_at(frame);
    if (!tells_parts_) {
      const records::MotionParts parts = results::make_parts(scene_, system_);
      plan_pictures(frame, parts);
      recorder_.parts(parts);
      tells_parts_ = true;
    }
    frame.for_others = pictures_++ % others_every_ == 0 || is_last;
    recorder_.motion(frame);
    while (next_picture_ < most_intervals_ &&
           state_.time >= (1.0 - 1e-9) * picture_end() * next_picture_ / most_intervals_)
      ++next_picture_;
  }
  figures_.add(system_, state_, energy_meter_);
}

void Run::take_figures() {
  summary_.expected = figures_.results(summary_);
  const std::vector<records::MeasureResult> of_whole_run = measures_.results();
  summary_.measures.clear();
  std::vector<records::ExpectedResult> of_measures;
  std::size_t next_figure = scene_.expected.size(), next_measure = 0;
  for (const scene::Measure& m : scene_.measures) {
    records::MeasureResult measured{m.name, std::nullopt};
    records::ExpectedResult how;
    if (Measures::is_figure(m)) {
      how = summary_.expected[next_figure++];
      if (how.reached && how.has_value && std::isfinite(how.value)) measured.value = how.value;
    } else {
      measured = of_whole_run[next_measure++];
      how.taken = "from the ends of all accepted steps";
      how.reached = is_time_reached(m);
    }
    if (summary_.status != RunStatus::ok) measured.value.reset();  // what a part of a run shows is no figure of it
    if (m.expected) of_measures.push_back(held_against(*m.expected, measured, std::move(how)));
    summary_.measures.push_back(std::move(measured));
  }
  summary_.expected.resize(scene_.expected.size());
  summary_.expected.insert(summary_.expected.end(), of_measures.begin(), of_measures.end());
}

/// Whether the run gets to the time of a measure, if it has one: a run in time may be made shorter.
bool Run::is_time_reached(const scene::Measure& m) const {
  return !m.time || !plan_.is_dynamic || *m.time <= scene_.analysis.end_time * (1.0 + 1e-12);
}

bool Run::is_due(long row, bool is_last) const { return row % std::max(1, scene_.output.stride) == 0 || is_last; }

bool Run::is_motion_due(long row, bool is_last) const {
  if (!want_motion_ || is_last) return want_motion_;
  if (scene_.output.motion_stride > 0) return row % scene_.output.motion_stride == 0;
  if (scene_.analysis.arc_length) return true;  // the path's length is not known before its end
  // The first step that ends at or beyond the next of a hundred equal parts of the run.
  return row == 0 || state_.time >= (1.0 - 1e-9) * picture_end() * next_picture_ / most_intervals_;
}

bool Run::report_progress(const step::StepReport& report, double end) {
  if (!progress_) return true;
  records::Progress p;
  p.time = state_.time;
  p.end_time = end;
  p.step_size = last_step_;
  p.iterations = report.iterations;
  p.step = summary_.steps.accepted;
  if (progress_(p)) return true;
  summary_.status = RunStatus::interrupted;
  summary_.cause = "stopped by " + (stopped_by_ ? stopped_by_() : std::string("the user")) + " at time " +
                   std::to_string(state_.time);
  return false;
}

bool Run::may_try(double target) {
  if (!before_step_ || before_step_(system_, state_, {options_, summary_.steps.accepted + 1, target})) return true;
  summary_.status = RunStatus::interrupted;
  summary_.cause = "stopped before the step to " + std::to_string(target);
  return false;
}

void Run::check() {
  records::Checks& c = summary_.checks;
  const step::Violations gaps = system_.constraint_violations(state_);
  gate_.look_at("the violation of constraints", gaps.position, state_.time);
  c.constraint_violation_position = std::max(c.constraint_violation_position, gaps.position);
  if (gaps.relative_position > c.relative_violation_position) {
    c.relative_violation_position = gaps.relative_position;
    open_joint_ = gaps.open_joint;
  }
  if (!plan_.is_dynamic) return;
  gate_.look_at("the violation of constraints by velocities", gaps.velocity, state_.time);
  c.constraint_violation_velocity = std::max(c.constraint_violation_velocity, gaps.velocity);
  if (gaps.relative_velocity * last_step_ > c.relative_violation_step) {
    c.relative_violation_step = gaps.relative_velocity * last_step_;
    fast_joint_ = gaps.fast_joint;
  }
  const results::Energies energies = energy_meter_.eval(system_, state_);
  gate_.look_at(energies, state_.time, [this] { return results::eval_motion(system_, state_); });
  gate_.look_at("the work of loads and drives", work_meter_.supply().work, state_.time);
  gate_.look_at("the energy taken by dampers", work_meter_.supply().dissipation, state_.time);
  balance_.compare(energies, work_meter_.supply());
  if (error_watch_)
    error_watch_->see_energies(state_.time, energies.kinetic, energies.strain + energies.potential,
                               balance_.last_energy_error(), balance_.energy_scale());
}

/// What energies cannot tell: their own round-off and that of weights at work over the size of the structure, and the
/// motion that the tolerance of Newton's iteration leaves open over the whole run.
double Run::energy_round_off() const {
  constexpr double digits = 64.0 * 0x1p-53;  // sums over elements and steps lose some
  const double mass = work_meter_.mass(), size = plan_.length_scale;
  const double open = options_.tolerance * size / scene_.analysis.end_time;
  return digits * (mass * std::sqrt(lanes::dot(plan_.gravity, plan_.gravity)) * size + balance_.largest_energies()) +
         0.5 * mass * open * open;
}

void Run::estimate_solution_error() {
  if (system_.counts().factorizations == 0) return;
  constexpr double least_motion = 1e-12;  // of the structure: less is a few roundings of places
  std::vector<double> rhs(system_.num_unknowns()), x(system_.num_unknowns());
  if (system_.evaluate(state_, {}, false)) return;
  for (std::size_t i = 0; i < rhs.size(); ++i) rhs[i] = -system_.residual()[i];
  if (system_.linear().solve(rhs.data(), x.data())) return;
  double moved = least_motion, shift = 0.0;
  const std::vector<elements::NodeMotion>& nodes = system_.nodes(state_);
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    const motion::Frame<double>& from = plan_.nodes[n].pose;
    const motion::Vec6<double> eta = system_.node_part(x.data(), static_cast<int>(n));
    for (int i = 0; i < 3; ++i) {
      moved = std::max(moved, std::abs(nodes[n].x.hi[i] - from.x[i]) / plan_.length_scale);
      shift = std::max({shift, std::abs(eta[i]) / plan_.length_scale, std::abs(eta[3 + i])});
    }
    for (int i = 0; i < 9; ++i) moved = std::max(moved, std::abs(nodes[n].R.m[i] - from.R.m[i]));
  }
  summary_.solver.emplace_back("solution_error_estimate", shift / moved);
}

void Run::finish() {
  const step::WorkCounts& work = system_.counts();
  summary_.final_values = row_.values;
  summary_.steps.factorizations = work.factorizations;
  summary_.times.assemble = work.assemble;
  summary_.times.factor = work.factor;
  summary_.times.solve = work.solve;
  summary_.times.update = work.update;
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  summary_.memory_peak_bytes = static_cast<std::int64_t>(usage.ru_maxrss) * 1024;
  summary_.checks.linear_backward_error_max = work.backward_error_max;
  if (open_joint_ >= 0) summary_.checks.open_joint = plan_.joints[static_cast<std::size_t>(open_joint_)].name;
  if (fast_joint_ >= 0) summary_.checks.fast_joint = plan_.joints[static_cast<std::size_t>(fast_joint_)].name;
  summary_.checks.linear_rank_error_max = work.rank_error_max;
  summary_.checks.unbalanced_at_floor = largest_force_ > 0.0 ? unbalanced_force_ / largest_force_ : 0.0;
  summary_.checks.energy_balance = balance_.energy_error();
  summary_.checks.energy_scale = balance_.energy_scale();
  if (plan_.is_dynamic) summary_.checks.energy_round_off = energy_round_off();
  if (error_watch_) summary_.sensor_errors = error_watch_->errors(summary_.header);
  summary_.not_judged = error_not_judged(plan_, options_, scene_.output.checks, summary_.sensor_errors);
  summary_.checks.numerical_dissipation = std::max(0.0, -balance_.last_energy_error());
  summary_.checks.energy_gained = std::max(0.0, balance_.last_energy_error());
  summary_.checks.momentum_balance = balance_.momentum_error();
  note_dependent_rows();
  if (limit_watch_)
    if (const auto text = limit_watch_->text(plan_, options_.step_control->tolerance)) note(*text);
  if (!first_rejection_.empty() && summary_.status != RunStatus::failed) note(first_rejection_);
  if (plan_.took("symmetric") && !system_.linear().takes_symmetric_parts())
    note("the symmetric parts of tangents were given up for whole ones: Newton's iteration had slowed down");
  if (summary_.checks.round_off_floor_reached)
    note("some steps were accepted at the round-off floor of the residual, above the tolerance asked for");
  take_figures();
  if (summary_.status == RunStatus::ok) {
    gate_.look_at(state_, plan_);
    gate_.look_at(summary_);
    if (!gate_.cause().empty() && !fail(gate_.cause())) take_figures();  // of a run that failed none holds
  }
  summary_.solver = solver_figures(system_, dependent_rows_);
  if (reactions_) summary_.unsure_reactions = reactions_->found();
  if (summary_.status == RunStatus::ok) {
    look_at_last_factor(system_, summary_);
    if (!plan_.is_dynamic || is_alpha()) estimate_solution_error();
  }
  if (stability_) finish_statics();
  summary_.doubts = doubts_of(summary_, plan_.is_dynamic);
  if (const std::string passed = springs_.text(); !passed.empty()) summary_.doubts.push_back({"springs", passed});
  if (reactions_)
    if (const std::string wrong = reactions_->misplaced(); !wrong.empty()) summary_.doubts.push_back({"error", wrong});
  if (!after_run_) return;
  after_run_(system_, state_);
}

/// Stability at the end; and next to a critical load the tangent is nearly singular by nature, which is no fault of
/// the numbers.
void Run::finish_statics() {
  if (summary_.status == RunStatus::ok) stability_->look_at_end(state_);
  summary_.stability = stability_->seen();
  records::Stability& s = *summary_.stability;
  if (s.unstable_directions > 0 || s.first_lost || !s.hidden.empty())
    s.largest_load = largest_load(scene_, plan_, state_.time, work_meter_.mass());
}

Summary simulate(const scene::Scene& scene, const SimulateOptions& options, records::Recorder& recorder,
                 const ProgressCallback& progress) {
  Run run(scene, options, recorder, progress);
  return run.run();
}

}  // namespace bough::run
