#pragma once
/// Which node carries which: a spanning tree of the structure, along which large increments are applied.
#include <vector>

#include "bough/motion/quaternion.hpp"
#include "bough/plan/plan.hpp"

namespace bough::step {

/// A rigid motion in the axes of the frame that moves, H <- H S: small motions keep all their digits.
struct RigidMotion {
  motion::Quaternion<double> turn;
  motion::Vec3<double> shift;
};

/// Parents before children. Beams are taken up first, then joints, those that leave the least freedom before others, then springs and
/// bushings: a loop closes where a mismatch makes the least force, at best in constraint rows, which the next iteration closes.
struct MotionTree {
  struct Link {
    int parent = -1;  ///< node, or -1: the inertial frame
    int node = 0;
    const elements::Port *parent_port = nullptr, *port = nullptr;  ///< of the plan's beam between them, else null
  };
  std::vector<Link> links;  ///< one for every node

  /// Scratch of an update, by node.
  std::vector<RigidMotion> motions;
  std::vector<motion::Frame<double>> relative;   ///< to the parent, at the end
  std::vector<motion::Vec6<double>> own_twists;  ///< relative to the parent, at the end, by unit of the factor
  std::vector<motion::Vec6<double>> twists;      ///< the same relative to the inertial frame
};

MotionTree make_motion_tree(const plan::Plan& plan);

}  // namespace bough::step
