#pragma once
/// One simulation from a scene to results.
#include <functional>
#include <vector>

#include "bough/records/run.hpp"
#include "bough/scene/scene.hpp"
#include "bough/step/advance.hpp"

namespace bough::run {

/// A step that is about to be tried.
struct BeforeStep {
  const step::StepOptions& options;
  long number = 1;   ///< of the accepted steps, if it is accepted
  double end = 0.0;  ///< [s], or load factor
};

struct SimulateOptions {
  int threads = 1;           ///< of the tree's tasks, >= 1; results do not depend on it
  bool want_motion = false;  ///< hand out the moving structure even if the scene does not ask for it
  /// Times asked for beside those of expected figures, ascending: load steps and steps of chosen sizes end there,
  /// within steps of equal size sensors are interpolated.
  std::vector<double> stops = {};
  /// Told of the values of all sensors at each of the stops that the run comes to, by the header.
  std::function<void(double time, const std::vector<double>& values)> sample = {};
  /// Asked before every attempt of a step, with the state it starts from; false: stop here (interrupted), the system
  /// is no longer used.
  std::function<bool(step::System&, const step::State&, const BeforeStep&)> before_step = {};
  /// The walker that the solver gets instead of the one of the threads: another way of the same walks, a watched one
  /// say.
  std::function<tree::Walker(const tree::Walker&)> wrap_walker = {};
  /// What stopped a run that its progress callback ended, in words; default: the user.
  std::function<std::string()> stopped_by = {};
  /// Called once after the last step, whether the run went well or not.
  std::function<void(step::System&, const step::State&)> after_run = {};
};

/// Asked after every accepted step; false: stop here (interrupted).
using ProgressCallback = std::function<bool(const records::Progress&)>;

/// Runs a scene. Precondition: problems_in(scene) is empty. Failures of the run are told in the summary, never
/// thrown; what a recorder throws (std::runtime_error) ends the run as failed, too. The recorder's `end` is called in
/// every case but that one.
records::Summary simulate(const scene::Scene& scene, const SimulateOptions& options, records::Recorder& recorder,
                          const ProgressCallback& progress = {});

}  // namespace bough::run
