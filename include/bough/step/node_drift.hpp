#pragma once
/// Frames relative to which generalized-alpha describes nodes that fly.
#include <array>
#include <memory>
#include <vector>

#include "bough/step/node_vectors.hpp"

namespace bough::step {

/// What chooses the frame of each node, eight nodes in the lanes of a pack (src/step/drift.hpp). Made once.
template <class G>
struct DriftChoice {
  struct Eight {
    typename G::template Translation<elements::LanePack> moment;  ///< first moment of mass, in the node's axes [kg m]
    elements::LanePack mass;  ///< of a node's bodies and of its share of beams [kg]; 0 in lanes that repeat a node
    std::array<int, elements::num_lanes> assembly;  ///< to which a node belongs; -1: something ties it to the ground
  };
  std::vector<Eight> eights;                      ///< by NodeOrder::eights(); empty where nothing flies and turns
  std::vector<double> assembly_mass;              ///< [kg]
  typename G::template Translation<double> fall;  ///< acceleration of the frames, along the axes of the model [m/s^2]
  bool falls = false;                             ///< whether that is gravity, or zero
};

/// The start of a step as seen from these frames.
template <class G>
struct DriftedStart {
  using Vector = typename G::template Vector<elements::LanePack>;
  using Translation = typename G::template Translation<elements::LanePack>;
  struct Eight {
    Vector v, a, algorithmic;
    Translation way;       ///< of the frame over the step, in the node's axes at the start [m]
    Translation velocity;  ///< of the frame at the end of the step, along the axes of the model [m/s]
  };
  std::vector<Eight> eights;
  std::vector<typename G::template Translation<double>> frames;  ///< velocity of each assembly's frame at the start
};

}  // namespace bough::step
