#pragma once
#include <string>

#include "bough/plan/plan.hpp"
#include "bough/records/run.hpp"
#include "bough/step/options.hpp"

namespace bough::run {

/// Of which sensors of a run in time no error in time was estimated, why, and how to learn of it; empty where there is
/// an estimate for all. checks: whether the scene asks for them. errors: the estimates that there are.
std::string error_not_judged(const plan::Plan& plan, const step::StepOptions& options, bool checks,
                             const std::vector<records::SensorError>& errors);

}  // namespace bough::run
