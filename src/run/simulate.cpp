#include "bough/run/simulate.hpp"

#include "bough/run/simulation.hpp"

namespace bough::run {

records::Summary simulate(const scene::Scene& scene, const SimulateOptions& options, records::Recorder& recorder,
                          const ProgressCallback& progress) {
  Simulation simulation(scene, options, &recorder, progress);
  (void)simulation.run();
  return simulation.finish();
}

}  // namespace bough::run
