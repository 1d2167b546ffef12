#pragma once
#include <initializer_list>
#include <string>

#include "bough/plan/plan.hpp"
#include "bough/records/run.hpp"
#include "bough/step/options.hpp"

namespace bough::run {

/// Names the sensors of a run of time steps whose discretization error in time was not estimated, with the reason and a
/// way to find it out. Empty if there is an estimate for all. checks: whether the scene requests checks. errors: the
/// existing estimates.
std::string error_not_judged(const plan::Plan& plan, const step::StepOptions& options, bool checks,
                             const std::vector<records::SensorError>& errors);

/// The mesh, as a part of what is not judged.
inline constexpr const char* the_mesh = "the mesh is not examined, a run with twice as many elements tells";

/// Those that are not empty, in one line.
std::string one_line(std::initializer_list<std::string> parts);

}  // namespace bough::run
