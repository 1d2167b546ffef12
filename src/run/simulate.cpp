#include "bough/run/simulate.hpp"

#include "accuracy.hpp"
#include "bough/run/estimate.hpp"
#include "bough/run/simulation.hpp"
#include "bough/scene/analysis_kinds.hpp"
#include "twins.hpp"

namespace bough::run {

namespace {

/// Twins in longer steps take three quarters of the time of the run.
bool can_check(const scene::Scene& scene) {
  const scene::Analysis& analysis = scene.analysis;
  return scene::type_of(analysis.kind).integrates && !analysis.step_control && scene.output.checks &&
         estimate_run(scene).seconds() < most_unasked_seconds;
}

}  // namespace

records::Summary simulate(const scene::Scene& scene, const SimulateOptions& options, records::Recorder& recorder,
                          const ProgressCallback& progress) {
  if (scene.analysis.accuracy) return simulate_to_accuracy(scene, options, recorder, progress);
  if (scene.analysis.errors.any()) return simulate_with_twins(scene, options, recorder, progress);
  if (options.checks_estimate && can_check(scene)) return simulate_and_check(scene, options, recorder, progress);
  SimulateOptions alone = options;
  alone.checks_estimate = false;
  Simulation simulation(scene, std::move(alone), &recorder, progress);
  (void)simulation.run();
  return simulation.finish();
}

}  // namespace bough::run
