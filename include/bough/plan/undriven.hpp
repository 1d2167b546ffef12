#pragma once
/// Motions that an analysis of a prescribed motion cannot leave free.
#include <string>
#include <vector>

#include "bough/plan/plan.hpp"

namespace bough::plan {

/// What drives leave free in a scene whose analysis integrates no motion, in words, all of it: rigid motions at the start
/// that have an effect, beams that bend, states of signals. With one of them the scene is not computed. Empty for all
/// other analyses.
std::vector<std::string> undriven_motions(const scene::Scene& scene, const Plan& plan);

/// Motions that drives leave free and that have no effect on anything else, as a rod's spin about its own axis between
/// two spherical joints: their number in space, and a note on them.
struct IdleMotions {
  int count = 0;
  std::string note;  ///< empty: there are none
};
IdleMotions idle_motions(const scene::Scene& scene, const Plan& plan);

}  // namespace bough::plan
