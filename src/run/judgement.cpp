#include "judgement.hpp"

#include <sys/resource.h>

#include <algorithm>
#include <cmath>

#include "bough/scene/analysis_kinds.hpp"
#include "hidden_rows.hpp"
#include "solver_figures.hpp"
#include "trust.hpp"

namespace bough::run {

using records::RunStatus;
using records::Summary;

namespace {

/// Forces are compared at the least with this part of the largest energy over the size of the structure. Those of a
/// balanced rotor are all zero but for round-off, which is no reason to doubt them.
constexpr double part_of_energy = 1e-3;

void sum_up_work(const EndedRun& run, Summary& summary) {
  const step::WorkCounts& work = run.system.counts();
  summary.final_values = run.recording.last_values();
  summary.steps.factorizations = work.factorizations;
  summary.times.assemble = work.assemble;
  summary.times.factor = work.factor;
  summary.times.solve = work.solve;
  summary.times.update = work.update;
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  summary.memory_peak_bytes = static_cast<std::int64_t>(usage.ru_maxrss) * 1024;
  summary.checks.linear_backward_error_max = work.backward_error_max;
  summary.checks.linear_rank_error_max = work.rank_error_max;
}

/// Size of one more Newton correction at the end of the run, relative to the total displacement from the start.
void estimate_solution_error(step::System& system, const step::State& state, Summary& summary) {
  if (system.counts().factorizations == 0) return;
  constexpr double least_motion = 1e-12;  // of the size of the structure: less is a few roundings of positions
  const plan::Plan& plan = system.plan();
  std::vector<double> x(system.places().size());
  if (system.evaluate(state, {}, false)) return;
  if (system.linear().solve(system.right_hand_side().data(), x.data())) return;
  double moved = least_motion, shift = 0.0;
  const std::vector<elements::NodeMotion>& nodes = nodes_in_space(system.plan(), state);
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    const motion::Frame<double>& from = plan.nodes[n].pose;
    const motion::Vec6<double> eta = system.places().node_part(x.data(), static_cast<int>(n));
    for (int i = 0; i < 3; ++i) {
      moved = std::max(moved, std::abs(nodes[n].x.hi[i] - from.x[i]) / plan.length_scale);
      shift = std::max({shift, std::abs(eta[i]) / plan.length_scale, std::abs(eta[3 + i])});
    }
    for (int i = 0; i < 9; ++i) moved = std::max(moved, std::abs(nodes[n].R.m[i] - from.R.m[i]));
  }
  summary.solver.emplace_back("solution_error_estimate", shift / moved);
}

/// Forms differ in what they do at interfaces.
void note_missing_interfaces(const EndedRun& run) {
  const scene::SolverForm form = run.scene.solver.form;
  if (form == scene::SolverForm::local || form == scene::SolverForm::monolithic) return;
  if (run.system.linear().tree().num_subdomains() == 1)
    run.recording.account().note(
        "the form of the solver has nothing to act on: the tree is one sub-domain without an interface, on which all "
        "forms are the same; \"depth\" or a smaller \"leaf_size\" in /solver cuts it");
}

}  // namespace

void judge(const EndedRun& run) {
  Recording& recording = run.recording;
  Account& account = recording.account();
  Summary& summary = recording.summary();
  const plan::Plan& plan = run.system.plan();
  sum_up_work(run, summary);
  recording.conservation().sum_up(summary.checks, run.options, run.scene.analysis.end_time);
  const double least_force = plan.is_dynamic ? part_of_energy * summary.checks.energy_scale / plan.length_scale : 0.0;
  summary.checks.unbalanced_at_floor = account.unbalanced_at_floor(least_force);
  run.analysis.end_errors();
  if (const ErrorWatch* watch = recording.error_watch()) summary.sensor_errors = watch->errors(summary.header);
  if (const auto rows = find_rows_in_space(run.scene, run.system, run.state))
    account.see_rows_in_space(rows->dependent, rows->groups);
  account.note_dependent_rows();
  run.analysis.add_notes();
  account.note_steps();
  recording.take_figures();
  if (summary.status == RunStatus::ok) {
    recording.gate().look_at(run.state, plan);
    recording.gate().look_at(summary);
    const std::string& cause = recording.gate().cause();
    if (!cause.empty() && !account.fail(cause)) recording.take_figures();  // no expected figure of a failed run holds
  }
  summary.solver = solver_figures(run.system, account.dependent_rows());
  note_missing_interfaces(run);
  if (summary.status == RunStatus::ok) {
    // What looks at one state leaves matrices in the solver that it has not factored.
    if (!scene::type_of(run.scene.analysis.kind).is_of_instant) look_at_last_factor(run.system, summary);
    if (run.analysis.ends_in_correction()) estimate_solution_error(run.system, run.state, summary);
  }
  run.analysis.sum_up();
  summary.not_judged = run.analysis.not_judged();
  summary.doubts = doubts_of(
      summary, plan.is_dynamic, {},
      {least_force, run.analysis.errors_grow_in(), run.is_estimate_checked ? estimate_beside_twins : "error"});
  if (const std::string passed = recording.springs().text(); !passed.empty())
    summary.doubts.push_back({"springs", passed});
  if (const std::string far = recording.far_forces().text(); !far.empty()) summary.doubts.push_back({"round-off", far});
  run.analysis.add_doubts();
}

}  // namespace bough::run
