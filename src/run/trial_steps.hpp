#pragma once
/// Work and time of a step, counted and measured over the first steps of a run.
#include <optional>

#include "bough/scene/scene.hpp"

namespace bough::run {

/// Numbers per step.
struct StepWork {
  double iterations = 0.0, evaluations = 0.0, factorizations = 0.0, checks = 0.0;
  double seconds = 0.0;  ///< CPU time [s]; 0: not measured
  int trial_steps = 0;   ///< from which these numbers come; 0: they are the usual ones
};

/// Takes the first `steps` accepted steps of a run on one thread, without results. Counts the work of the later half of
/// them, which the start disturbs less, and measures its time. Takes fewer steps if the run ends or fails before;
/// nothing if it takes none.
std::optional<StepWork> try_steps(const scene::Scene& scene, int steps);

}  // namespace bough::run
