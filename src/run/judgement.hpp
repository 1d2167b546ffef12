#pragma once
/// Completion and assessment of the summary at the end of a run.
#include "analysis.hpp"

namespace bough::run {

/// A run that has ended, with the objects that describe it.
struct EndedRun {
  const scene::Scene& scene;
  const step::StepOptions& options;
  step::System& system;
  const step::State& state;
  Recording& recording;
  Analysis& analysis;
  bool is_estimate_checked;  ///< by twins, beside the run or after it
};

/// Completes the summary: counts and times of the work, checks, figures, properties of the last factorization, doubts.
/// If a number is not finite, the status becomes failed.
void judge(const EndedRun& run);

}  // namespace bough::run
