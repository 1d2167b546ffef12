#include "trial_steps.hpp"

#include <limits>
#include <vector>

#include "bough/run/simulation.hpp"

namespace bough::run {

std::optional<StepWork> try_steps(const scene::Scene& scene, int steps) {
  scene::Scene trial = scene;
  trial.output.stride = std::numeric_limits<int>::max();
  trial.output.motion = false;
  trial.expected.clear();
  trial.measures.clear();
  std::vector<step::WorkCounts> before;  // by accepted step
  SimulateOptions options;
  options.before_step = [&](step::System& system, const step::State&, const BeforeStep& step) {
    before.resize(static_cast<std::size_t>(step.number), system.counts());  // not at further attempts of a step
    return step.number <= steps;
  };
  static_cast<void>(Simulation(trial, options).run());  // without the checks of a finished run
  const std::size_t taken = before.empty() ? 0 : before.size() - 1;
  if (taken == 0) return std::nullopt;
  const step::WorkCounts &begin = before[taken / 2], &end = before.back();
  const auto per_step = [&](long after, long earlier) {
    return static_cast<double>(after - earlier) / static_cast<double>(taken - taken / 2);
  };
  return StepWork{per_step(end.solutions, begin.solutions), per_step(end.evaluations, begin.evaluations),
                  per_step(end.factorizations, begin.factorizations), per_step(end.checks, begin.checks),
                  static_cast<int>(taken)};
}

}  // namespace bough::run
