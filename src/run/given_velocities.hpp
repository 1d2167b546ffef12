#pragma once
#include <vector>

#include "bough/records/run.hpp"
#include "bough/step/state.hpp"

namespace bough::run {

/// Initial velocities given by the scene (their nonzero parts) that differ from those of the consistent state `start`
/// by more than round-off. Each has its name; a beam has one entry, where it differs most. The largest change comes
/// first. moved: the nodes with the velocities that they have in an equilibrium to which the start was moved; empty: it
/// was not.
std::vector<records::ChangedVelocity> changed_velocities(const plan::Plan& plan, const step::State& start,
                                                         const std::vector<elements::NodeMotion>& moved = {});

}  // namespace bough::run
