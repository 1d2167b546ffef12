#pragma once
/// Memory and time of a run, estimated from the scene alone, before memory is allocated for it.
#include <string>

#include "bough/scene/scene.hpp"

namespace bough::run {

/// Counts are those of the scene in space, before the plan omits unknowns. Memory and time are sums over nodes,
/// elements and joints with costs measured for chains and lattices on one machine. For these they are right within a
/// factor of two; for solids of beams they are too small.
struct Estimate {
  double nodes = 0.0, elements = 0.0, joints = 0.0;
  double unknowns = 0.0;      ///< six per node, and the rows of all joints
  double steps = 0.0;         ///< of a run in time, or load steps
  double memory_bytes = 0.0;  ///< of the whole process
  double step_seconds = 0.0;  ///< on one thread
  double seconds() const { return steps * step_seconds; }
  double scene_bytes() const { return memory_bytes - program_bytes; }  ///< without the program itself

  static constexpr double program_bytes = 15e6;
};

/// Cost: one pass over the lists of the scene. Precondition: problems_in(scene) is empty.
Estimate estimate_run(const scene::Scene& scene);

/// Empty if a run, and the twins that its analysis wants beside it, stay within `limit` bytes; else a message with the numbers and a remedy. Motion in a plane or
/// without rotation takes about half of the memory; a plan is made only if this decides, of a scene whose plan would take
/// long with few elements a beam, and not where that is too large as well: it is taken to move in space.
std::string refusal(const scene::Scene& scene, double limit);

}  // namespace bough::run
