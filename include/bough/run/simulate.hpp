#pragma once
/// One simulation from a scene to results.
#include <functional>
#include <memory>
#include <vector>

#include "bough/records/run.hpp"
#include "bough/records/stored_state.hpp"
#include "bough/scene/scene.hpp"
#include "bough/step/advance.hpp"

namespace bough::run {

/// A step that is about to be attempted.
struct BeforeStep {
  const step::StepOptions& options;
  long number = 1;   ///< its number among accepted steps, if it is accepted
  double end = 0.0;  ///< [s], or load factor
};

struct SimulateOptions {
  int threads = 1;           ///< >= 1; results do not depend on it
  bool want_motion = false;  ///< record the moving structure even if the scene does not request it
  /// State of another run in which dynamics starts (problems_of_start); none: the scene's own start.
  std::shared_ptr<const records::StoredState> from = {};
  /// Times at which sensors are sampled, ascending, in addition to those of expected figures. Load steps and steps of
  /// variable size end there; within steps of equal size sensors are interpolated.
  std::vector<double> stops = {};
  /// Called at each of these stops that the run reaches, with the values of all sensors in the order of the header.
  std::function<void(double time, const std::vector<double>& values)> sample = {};
  /// Errors that twins beside this run measure: it does not list them as not examined.
  scene::ErrorsWanted measured = {};
  /// Of `simulate`: twins check the estimate of the error in time where it doubts the run.
  bool checks_estimate = false;
  /// Called before every attempt of a step, with the state it starts from. If it returns false, the run ends here as
  /// interrupted, and the system is no longer used.
  std::function<bool(step::System&, const step::State&, const BeforeStep&)> before_step = {};
  /// Makes the walker that the solver uses from the walker of the threads, for example one that times its visits.
  std::function<tree::Walker(const tree::Walker&)> wrap_walker = {};
  /// Describes what stopped a run that its progress callback ended; default: "the user".
  std::function<std::string()> stopped_by = {};
  /// Called once after the last step, also if the run failed.
  std::function<void(step::System&, const step::State&)> after_run = {};
};

/// Why a scene cannot start from a state, one sentence a reason, as far as its plan need not be known for that; empty:
/// it can. What only the plan knows makes the run a failed one.
std::vector<std::string> problems_of_start(const scene::Scene& scene, const records::StoredState& from);
/// Time at which it starts from there [s]: that of the state, and 0 if the state is one of statics.
double start_time(const records::StoredState& from);

/// Called after every accepted step. If it returns false, the run ends here as interrupted.
using ProgressCallback = std::function<bool(const records::Progress&)>;

/// Runs a scene, beside twins of it where its analysis wants errors measured (scene::ErrorsWanted): these get the
/// threads, the start and the requests to stop of the options, and nothing else of them; the recorder gets the rows of
/// the run itself, and the summary with the errors. Precondition: problems_in(scene) is empty. Failures of the run are reported in the summary, never
/// thrown; an exception of the recorder (std::runtime_error) also ends the run as failed. The recorder's `end` is
/// called in every case but that one.
records::Summary simulate(const scene::Scene& scene, const SimulateOptions& options, records::Recorder& recorder,
                          const ProgressCallback& progress = {});

}  // namespace bough::run
