#pragma once
/// Grids of bars on pins: each window is a loop of bodies, three of whose constraint rows depend on the others.
#include "random_scene.hpp"

namespace bough::test {

struct LoopOptions {
  int columns = 4, floors = 1;
  double tilt = 0.3;          ///< of the upright bars [rad]
  double step = 1e-3;         ///< masses are divided by its square
  double own_inertia = 0.01;  ///< of a bar about its axis
  double misaligned = 0.0;    ///< by how much the axis of the second pin of the first coupler is off [rad]
  bool long_bar = false;      ///< a bar from the first to the last pin of the uppermost floor: a loop around the others
};

/// Upright bars stand on the ground and on each other, couplers connect their ends.
Scene make_loops(const LoopOptions& options);

}  // namespace bough::test
