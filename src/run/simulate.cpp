#include "bough/run/simulate.hpp"

#include "bough/run/simulation.hpp"
#include "twins.hpp"

namespace bough::run {

records::Summary simulate(const scene::Scene& scene, const SimulateOptions& options, records::Recorder& recorder,
                          const ProgressCallback& progress) {
  if (scene.analysis.errors.any()) return simulate_with_twins(scene, options, recorder, progress);
  Simulation simulation(scene, options, &recorder, progress);
  (void)simulation.run();
  return simulation.finish();
}

}  // namespace bough::run
