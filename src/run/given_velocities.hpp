#pragma once
#include <vector>

#include "bough/records/run.hpp"
#include "bough/step/state.hpp"

namespace bough::run {

/// Velocities that the scene gives (parts of them other than zero) and that differ in `start`, a consistent state, by
/// more than round-off: by name, of a beam where it differs most; the largest change first.
std::vector<records::ChangedVelocity> changed_velocities(const plan::Plan& plan, const step::State& start);

}  // namespace bough::run
