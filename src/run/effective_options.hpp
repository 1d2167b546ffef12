#pragma once
#include "bough/records/run.hpp"
#include "bough/scene/scene.hpp"
#include "bough/step/options.hpp"

namespace bough::run {

/// The options a run really used, as JSON pointers and values.
records::EffectiveOptions effective_options(const scene::Scene& scene, const step::StepOptions& options);

}  // namespace bough::run
