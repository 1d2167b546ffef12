#pragma once
/// What a run of a scene takes, told from the scene alone: before anything is allocated for it.
#include <string>

#include "bough/scene/scene.hpp"

namespace bough::run {

/// Counts are those of the scene in space, before the plan leaves anything out. Memory and time are sums over nodes,
/// elements and joints, with figures of chains and lattices that were measured on one machine: within a factor of two
/// for these, too little for solids of beams.
struct Estimate {
  double nodes = 0.0, elements = 0.0, joints = 0.0;
  double unknowns = 0.0;      ///< six a node, and the rows of all joints
  double steps = 0.0;         ///< of a run in time, or load steps
  double memory_bytes = 0.0;  ///< of the process that runs it
  double step_seconds = 0.0;  ///< on one thread
  double seconds() const { return steps * step_seconds; }
};

/// Cost: one pass over the lists of the scene. Precondition: problems_in(scene) is empty.
Estimate estimate_run(const scene::Scene& scene);

/// Empty where a run stays within `limit` bytes; else the numbers and what to do, in words. Motion in a plane or
/// without rotation takes about half: where that decides, and only there, a plan is made.
std::string refusal(const scene::Scene& scene, double limit);

}  // namespace bough::run
