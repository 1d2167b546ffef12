#pragma once
/// Scenes of the benchmarks, made in code. All consist of one steel bar of 20 mm x 20 mm (E 2.1e11 Pa, nu 0.3, 7850
/// kg/m^3); gravity is along -z.
#include "bough/scene/scene.hpp"

namespace bough::bench {

/// How a structure of beams is held at the ground.
enum class Support {
  clamp,   ///< fixed joints: six multipliers each
  spring,  ///< bushings: no multipliers, so that the tangent has none and its symmetric part is positive definite
};

/// Links of 1 m, four two-node beam elements each, revolute joints about y between them and to the ground, straight
/// along x.
scene::Scene make_chain(int links);
/// Rigid bodies with the mass and inertia of these links, and the same joints.
scene::Scene make_rigid_chain(int links);
/// A hub on a spring with `arms` arms of `nodes` nodes, 0.25 m apart, rigidly joined, spread over a sphere.
scene::Scene make_star(int arms, int nodes);
/// n x n nodes, 0.25 m apart in the plane of x and y, beams rigidly joined at them, held along the edge x = 0.
scene::Scene make_lattice_2d(int n, Support support);
/// n x n x n nodes with the same distances and joints, held on the face x = 0 by springs.
scene::Scene make_lattice_3d(int n);

}  // namespace bough::bench
