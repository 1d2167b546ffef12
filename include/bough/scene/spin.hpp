#pragma once
/// A rotation at time 0 that all of a scene may take part in, as a rotor does.
#include <optional>
#include <span>

#include "bough/scene/poses.hpp"

namespace bough::scene {

/// A velocity at a place: of the point x, in the ground's axes.
struct PlaceVelocity {
  Vec3 x = Vec3::zero(), linear = Vec3::zero(), angular = Vec3::zero();
};

/// A rotation about a fixed axis: v(x) = rate axis x (x - point).
struct Spin {
  Vec3 point = Vec3::zero(), axis = Vec3::unit(2);  ///< a point of the axis; unit vector
  double rate = 0.0;                                ///< [rad/s], > 0
  PlaceVelocity at(const Vec3& x) const { return {x, cross(rate * axis, Vec3(x - point)), rate * axis}; }
};

/// The one rotation, if there is one, that has all these velocities (relative tolerance 1e-6).
std::optional<Spin> spin_of(std::span<const PlaceVelocity> velocities);

/// Velocities at time 0 of the frames that move in frames at rest, of those that do not carry the ground. Nothing where
/// one moves in another that moves.
std::optional<std::vector<PlaceVelocity>> velocities_of_frames(const Scene& scene, const Poses& poses);

}  // namespace bough::scene
