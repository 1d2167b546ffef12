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

/// Parents before children. Beams are taken up first, then joints, those that leave the least freedom before others,
/// then couplings: a loop closes where a mismatch makes the least force, at best in constraint rows, which
/// the next iteration closes.
struct MotionTree {
  struct Link {
    int parent = -1;  ///< node, or -1: the inertial frame
    int node = 0;
    int section = -1;           ///< in `sections`, where a beam lies between the two; -1: something else does
    bool to_reference = false;  ///< of a beam: `node` is the one that the beam measures from, `parent` the other
  };
  /// Up to eight beams of one kind that are moved in lockstep. Each has an entry in `sections` for every node but
  /// that from which it measures, in order.
  struct BeamGroup {
    int num_nodes = 0;
    int first_beam = 0, count = 0;  ///< in the plan's array of beams of so many nodes
    int first_section = 0;
  };
  /// How a correction moves a node relative to that from which its beam measures, H <- H S.
  struct Section {
    RigidMotion motion;
    motion::Vec6<double> end, strain_rate;  ///< elements::SectionWay::end; strain_rates of a strain point
    motion::Vec6<double> twist;             ///< at the end, by unit of the factor; set by power_along_tree
  };
  std::vector<Link> links;  ///< one for every node
  std::vector<BeamGroup> beams;

  /// Scratch of an update.
  std::vector<Section> sections;
  std::vector<RigidMotion> motions;              ///< by node
  std::vector<motion::Frame<double>> relative;   ///< to the parent, at the end
  std::vector<motion::Vec6<double>> own_twists;  ///< relative to the parent, at the end, by unit of the factor
  std::vector<motion::Vec6<double>> twists;      ///< the same relative to the inertial frame
};

MotionTree make_motion_tree(const plan::Plan& plan);

}  // namespace bough::step
