#pragma once
#include "bough/results/records.hpp"
#include "bough/scene/scene.hpp"
#include "bough/step/options.hpp"

namespace bough::study {

/// The options a run really used, as JSON pointers and values.
results::EffectiveOptions effective_options(const scene::Scene& scene, const step::StepOptions& options);

}  // namespace bough::study
