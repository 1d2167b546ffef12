#pragma once
#include "bough/run/simulate.hpp"

namespace bough::run {

/// Runs a scene beside its twins (make_twins), on the threads of the options, and measures the errors of its results.
/// The run itself, its rows and its pictures are those of a run without twins, bit by bit; the recorder gets them as they
/// come, and the summary, after `judge` if that is given, when all twins have ended. Precondition: as of `simulate`, and
/// the analysis wants errors.
records::Summary simulate_with_twins(const scene::Scene& scene, const SimulateOptions& options,
                                     records::Recorder& recorder, const ProgressCallback& progress,
                                     const std::function<void(records::Summary&)>& judge = {});

/// Estimated time of runs that nobody asked for, at most [s].
inline constexpr double most_unasked_seconds = 30.0;

/// Runs a scene and, if the estimate of its error in time doubts it, twins that decide on that doubt (check_estimate):
/// two with steps of twice and four times the size and, if they do not decide, one with half the size. The recorder gets
/// the summary after them.
records::Summary simulate_and_check(const scene::Scene& scene, const SimulateOptions& options,
                                    records::Recorder& recorder, const ProgressCallback& progress);

}  // namespace bough::run
