#pragma once
/// One simulation as it goes: state, observers, summary. simulate.cpp sets up, records and sums up; run_statics.cpp
/// and run_dynamics.cpp step.
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "bough/results/balance.hpp"
#include "bough/results/spring_watch.hpp"
#include "bough/run/measures.hpp"
#include "bough/run/simulate.hpp"
#include "bough/schedule/threads.hpp"
#include "bough/step/advance.hpp"
#include "bough/step/arc_length.hpp"
#include "bough/step/integrator.hpp"
#include "bough/step/step_control.hpp"
#include "energy_error.hpp"
#include "error_watch.hpp"
#include "expected_figures.hpp"
#include "finite_gate.hpp"
#include "limit_watch.hpp"
#include "path_search.hpp"
#include "reaction_watch.hpp"
#include "stability_watch.hpp"
#include "vibration_watch.hpp"

namespace bough::run {

/// Steps of one size between two looks at local errors, in a run of so many.
long looks_every(double steps);

class Run {
 public:
  Run(const scene::Scene& scene, const SimulateOptions& options, records::Recorder& recorder,
      const ProgressCallback& progress);
  records::Summary run();

 private:
  bool fail(const std::string& cause);
  /// Keeps the largest and the least deficiency of accepted steps, with the reactions that were not unique at the
  /// largest.
  void watch_dependent_rows();
  void note_dependent_rows();
  void note(const std::string& text);
  /// Counts a step that was accepted, or rejected because it did not converge.
  void count(const step::StepReport& report);
  /// Counts a step that was rejected, for this cause, converged or not.
  void reject(const step::StepReport& report, const std::string& cause);
  void watch_floor(const step::StepReport& report);
  /// The variational integrator, for which this is, damps nothing: ends a run whose unresolved vibrations make energy
  /// out of nothing.
  bool watch_vibrations();
  /// Records the state (as its time's left limit, or right limit at a start).
  void record(int iterations, bool is_last);
  bool report_progress(const step::StepReport& report, double end);
  bool may_try(double target);
  /// Balances and violations of the present state.
  void check();
  double energy_round_off() const;
  /// Work and energies are looked at in every step.
  bool has_balance() const { return scene_.output.checks || is_variational(); }
  bool is_variational() const { return plan_.is_dynamic && options_.integrator == scene::Integrator::variational; }
  bool is_alpha() const { return plan_.is_dynamic && options_.integrator == scene::Integrator::generalized_alpha; }
  bool run_statics();
  bool take_load_step(double from, double width, bool is_last);
  bool run_path();
  /// What a step along the path comes by.
  struct PathStep {
    step::State end;
    std::optional<PathPoint> limit, stop;  ///< where the load turns; where the run ends
    bool stops_after_limit = false;
    std::vector<records::Bifurcation> bifurcations;
    std::optional<step::StabilityLook> look;  ///< at its end, where no other equilibrium was looked at since
    const step::State& last() const { return stop ? stop->state : end; }
  };
  bool take_path_step(double& length);
  bool try_path_step(double& length, PathStep& step, step::StepReport& report, int& cuts);
  std::string look_at_step(double length, bool is_last_try, PathStep& step);
  bool passes_end(double from, double to, std::size_t limit_points) const;
  std::string look_at_stability(double length, bool is_last_try, PathStep& step);
  std::string find_bifurcation(PathPlace& from, PathPlace to, int unstable_there, PathStep& step);
  bool look_within(PathPlace from, PathPlace to);
  PathPoint find_end(PathPlace from, PathPlace to, const step::State& beyond);
  void accept_bifurcation(records::Bifurcation&& bifurcation);
  void accept_limit_point(const PathPoint& limit, bool is_maximum, int iterations);
  bool run_dynamics();
  bool run_controlled_segment(double begin, double end, double total_end);
  bool take_controlled_steps(double stop, double total_end);
  bool measure_controlled();
  bool accept_controlled(const step::StepReport& report, bool is_last);
  /// Whether steps of a fixed size tell their errors.
  bool watches_error() const { return local_error_ && scene_.output.checks && !options_.single_solution; }
  bool look_at_error();
  /// Looks at reactions where these ask for it.
  bool watch_reactions();
  /// How far one more correction would move the end of the run, over what it has moved from the start.
  void estimate_solution_error();
  void add_error(double duration, double size);
  void see_before_look();
  void watch_errors(double norm);
  std::vector<double> stops_between(double begin, double end) const;
  bool set_step_size(double size);
  void keep_or_restore(bool is_first_failure);
  bool is_due(long row, bool is_last) const;
  bool is_motion_due(long row, bool is_last) const;
  void choose_bdf_order(double step_size);
  bool start_segment(double step_size, bool is_first);
  void note_moved_start(const step::StartReport& consistent);
  bool run_segment(double begin, double end, double& sum_of_cuts);
  void finish();
  /// Expected figures and measures of what was run.
  void take_figures();
  bool is_time_reached(const scene::Measure& m) const;
  void finish_statics();

  const scene::Scene& scene_;
  step::StepOptions options_;
  records::Recorder& recorder_;
  const ProgressCallback& progress_;
  const std::vector<double>& stops_;
  const decltype(SimulateOptions::before_step)& before_step_;
  const decltype(SimulateOptions::stopped_by)& stopped_by_;
  const decltype(SimulateOptions::after_run)& after_run_;
  bool want_motion_;
  /// Pictures whose stride is not given: every interval of the run has one, the intervals tell how many there are.
  int most_intervals_ = 100, next_picture_ = 1;
  int others_every_ = 1, pictures_ = 0;  ///< every so many pictures are written for other programs, too
  void plan_pictures(const records::MotionFrame& frame, const records::MotionParts& parts);
  double picture_end() const { return plan_.is_dynamic ? scene_.analysis.end_time : 1.0; }
  bool tells_parts_ = false;  ///< the recorder knows what the parts of pictures are
  plan::Plan plan_;
  schedule::Threads threads_;
  step::System system_;
  std::unique_ptr<step::Integrator> integrator_;  ///< dynamics
  step::State state_;
  step::State tried_;  ///< from which the first try of a step that failed set out
  results::WorkMeter work_meter_;
  results::EnergyMeter energy_meter_;
  records::Summary summary_;
  results::Balance balance_;
  FiniteGate gate_;
  std::vector<double> values_;
  records::HistoryRow row_;             ///< the last one recorded
  std::vector<scene::Expected> asked_;  ///< what the scene expects, then what it measures in the same way
  ExpectedFigures figures_;
  Measures measures_;
  double largest_force_ = 0.0, unbalanced_force_ = 0.0;  ///< of accepted steps; of those at the floor of round-off
  std::string first_rejection_, not_unique_;
  int open_joint_ = -1, fast_joint_ = -1;  ///< of the largest relative violations seen, in Plan::joints
  int dependent_rows_ = 0, least_dependent_rows_ = std::numeric_limits<int>::max();
  double dependent_since_ = 0.0;                 ///< when the largest number was met first: time or load factor
  std::optional<step::ArcLengthPath> path_;      ///< statics by arc length
  step::State path_start_;                       ///< of its present step
  step::ArcLengthPath::Vectors path_direction_;  ///< of the path there
  step::StabilityLook start_look_;               ///< there
  std::optional<StabilityWatch> stability_;      ///< statics
  bool path_done_ = false;
  std::optional<step::LocalError> local_error_;  ///< of generalized-alpha where checks or step control ask for it
  std::optional<step::StepController> controller_;
  std::optional<LimitWatch> limit_watch_;    ///< of controlled steps
  std::optional<EnergyError> energy_error_;  ///< of these, where sensors show forces or energies
  double wanted_size_ = 0.0;                 ///< of the next controlled step [s]
  double looked_at_ = 0.0;                   ///< time of the last look at a local error, at fixed steps
  double unfiltered_looked_ = 0.0;           ///< largest unfiltered error at a look
  long steps_since_look_ = 0;
  long looks_every_ = 1;                   ///< steps of one size between two looks at local errors
  bool looking_ = false;                   ///< at the second of two steps
  std::optional<ErrorWatch> error_watch_;  ///< where local errors are known and checks made
  std::vector<double> values_before_, values_now_, values_displaced_;  ///< of sensors of motions at a look
  step::State displaced_;
  VibrationWatch vibrations_;
  results::SpringWatch springs_;
  std::optional<ReactionWatch> reactions_;  ///< where checks are made and sensors show reactions
  long rows_ = 0;
  double last_step_ = 0.0;
};

}  // namespace bough::run
