#pragma once
/// The end of a run: its summary is completed and judged.
#include "analysis.hpp"

namespace bough::run {

/// A run that has ended, with all that tells of it.
struct EndedRun {
  const scene::Scene& scene;
  const step::StepOptions& options;
  step::System& system;
  const step::State& state;
  Recording& recording;
  Analysis& analysis;
};

/// Completes the summary: counts and times of the work, checks, figures, the last factorization, doubts. A number that
/// is not finite makes the run a failed one.
void judge(const EndedRun& run);

}  // namespace bough::run
