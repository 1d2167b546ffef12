#pragma once
/// The equilibrium in which a rotor starts that is described in the inertial frame.
#include <optional>

#include "bough/scene/spin.hpp"
#include "bough/step/find_equilibrium.hpp"

namespace bough::run {

/// The rotation about a fixed axis that a scene has at time 0: of the frames that move, of the initial velocities that
/// are given and of drives of the ground that prescribe a rate, all of them one rotation. Nothing where nothing turns,
/// or not all as one, or where what the ground holds does not let it turn.
std::optional<scene::Spin> spin_at_start(const scene::Scene& scene, const plan::Plan& plan);

/// Moves the nodes to the equilibrium relative to a frame with this rotation, with the centrifugal forces of it and the
/// loads of time 0, and gives all of them its velocities. It is found on a plan of the same scene described in that
/// frame, in which drives and frames keep their places.
step::EquilibriumReport find_turning_equilibrium(const scene::Scene& scene, const plan::Plan& plan,
                                                 const scene::Spin& spin, const step::StepOptions& options,
                                                 step::State& state);

}  // namespace bough::run
