#pragma once
#include "bough/run/simulate.hpp"

namespace bough::run {

/// Runs a scene in steps and with a mesh that make the errors of its results as small as its analysis asks for
/// (scene::Accuracy). Trials, each with its twins, go from long steps to shorter ones and from few elements to more,
/// until errors measured by them are of their theoretical order and tell what is needed; then the run itself is made and
/// measured in the same way. Only it is recorded. What it fell short of is a doubt. Precondition: as of `simulate`, and
/// the analysis asks for an accuracy.
records::Summary simulate_to_accuracy(const scene::Scene& scene, const SimulateOptions& options,
                                      records::Recorder& recorder, const ProgressCallback& progress);

}  // namespace bough::run
