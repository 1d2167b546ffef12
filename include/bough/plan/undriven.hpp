#pragma once
/// Motions that an analysis of a prescribed motion cannot leave free.
#include <string>
#include <vector>

#include "bough/plan/plan.hpp"

namespace bough::plan {

/// What drives leave free in a scene whose analysis integrates no motion, in words: rigid motions at the start, beams
/// that bend, states of signals. With one of them the scene is not computed. Empty for all other analyses.
std::vector<std::string> undriven_motions(const scene::Scene& scene, const Plan& plan);

}  // namespace bough::plan
