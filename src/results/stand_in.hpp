#pragma once
/// What pictures show of a body without a shape.
#include <optional>
#include <vector>

#include "bough/scene/scene.hpp"

namespace bough::results {

/// The homogeneous solid of the body's mass and principal inertia: of three different moments the cuboid, edge
/// a1^2 = 6 (J2 + J3 - J1) / m; of two equal ones, J about the axis and Jt across, the cylinder with radius^2 = 2 J / m
/// and length^2 = (12 Jt - 6 J) / m; of three equal ones, or where the body's axes are no principal axes, the sphere.
/// A sphere tells no direction: a body that is held at several places is then drawn as bars from its centre of mass to
/// each of them. arms: these places in the body's axes, from the centre of mass [m]. None for a point mass.
std::optional<scene::Mesh> stand_in(const scene::Body& body, const std::vector<motion::Vec3<double>>& arms);

}  // namespace bough::results
