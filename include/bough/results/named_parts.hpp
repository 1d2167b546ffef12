#pragma once
/// The state of a run by the names of the scene's parts, and the start of another run from it.
#include <optional>
#include <string>
#include <vector>

#include "bough/records/stored_state.hpp"
#include "bough/scene/scene.hpp"
#include "bough/step/system.hpp"

namespace bough::results {

/// Nodes, bodies and inner nodes of beams, each with the node of the plan with which it moves.
class NamedParts {
 public:
  NamedParts(const scene::Scene& scene, const plan::Plan& plan);

  records::StoredState store(const step::System& system, const step::State& state) const;

  /// What came of a start.
  struct Taken {
    std::string refusal;                ///< why the state cannot be that of this scene, in words; empty: it was taken
    std::vector<std::string> as_scene;  ///< parts that the state does not have, and that start as the scene says
    std::vector<std::string> left;      ///< parts of the state that the scene does not have
  };
  /// Moves the nodes of a state to where its parts were, with their velocities; turns of joints, states and inputs of
  /// signals are taken over, too. What several parts have in common that are one here, or what does not move here, has
  /// to agree. Precondition: the laws of the system are those of the state's time. The state is not consistent yet.
  Taken take(const records::StoredState& stored, const step::System& system, step::State& state) const;

 private:
  struct Part {
    std::string name;
    elements::Port port;
  };
  std::string disagreement(const records::StoredState& stored, const step::System& system,
                           const step::State& state) const;

  std::vector<Part> parts_;
  std::vector<records::StoredBeam> beams_;
  std::string frame_;
};

}  // namespace bough::results
