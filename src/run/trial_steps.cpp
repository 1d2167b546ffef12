#include "trial_steps.hpp"

#include <limits>
#include <vector>

#include "bough/run/simulation.hpp"
#include "bough/step/cpu_clock.hpp"

namespace bough::run {

std::optional<StepWork> try_steps(const scene::Scene& scene, int steps) {
  scene::Scene trial = scene;
  trial.output.stride = std::numeric_limits<int>::max();
  trial.output.motion = false;
  trial.expected.clear();
  trial.measures.clear();
  struct Mark {
    step::WorkCounts counts;
    double seconds;
  };
  std::vector<Mark> before;  // by accepted step
  step::CpuClock clock(true);
  SimulateOptions options;
  options.before_step = [&](step::System& system, const step::State&, const BeforeStep& step) {
    if (before.size() < static_cast<std::size_t>(step.number))  // not at further attempts of a step
      before.resize(static_cast<std::size_t>(step.number), {system.counts(), clock.now()});
    return step.number <= steps;
  };
  static_cast<void>(Simulation(trial, options).run());  // without the checks of a finished run
  const std::size_t taken = before.empty() ? 0 : before.size() - 1;
  if (taken == 0) return std::nullopt;
  const auto& [begin, begin_seconds] = before[taken / 2];
  const auto& [end, end_seconds] = before.back();
  const auto counted = static_cast<double>(taken - taken / 2);
  const auto per_step = [&](long after, long earlier) { return static_cast<double>(after - earlier) / counted; };
  return StepWork{per_step(end.solutions, begin.solutions),
                  per_step(end.evaluations, begin.evaluations),
                  per_step(end.factorizations, begin.factorizations),
                  per_step(end.checks, begin.checks),
                  (end_seconds - begin_seconds) / counted,
                  static_cast<int>(taken)};
}

}  // namespace bough::run
