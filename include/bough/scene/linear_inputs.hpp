#pragma once
/// Inputs of the linearised equations as signals: what moves a load, a prescribed coordinate or an effort is its law,
/// plus a signal of kind input that is zero in the state that the equations are about.
#include <string>
#include <vector>

#include "bough/scene/scene.hpp"

namespace bough::scene {

/// What an input acts on.
struct InputPlace {
  enum class Kind : std::uint8_t { none, point_load, line_load, displacement, angle, drive, effort, signal };
  Kind kind = Kind::none;
  std::size_t index = 0;  ///< in the scene's list of such parts
  std::size_t part = 0;   ///< of a displacement the axis, of a drive or an effort its number in the joint
  std::string unit;       ///< of the input; empty: a pure number, as the factor of a load
  std::string fault;      ///< of kind none: why there is no such place
  std::string hint;       ///< and what to do
};

/// Finds the place of an input by the names that it gives.
InputPlace place_of(const Scene& scene, const LinearInput& input);

/// "shaker.x", "tip_load"
std::string name_of(const LinearInput& input);

/// A scene whose analysis names inputs (Analysis::linear), with a signal of kind input for each, of the name that
/// name_of gives it unless it is such a signal already. At the values that inputs have at a start, 0, it moves as the
/// scene does. Precondition: all inputs have places.
Scene with_inputs(const Scene& scene);

/// The name of the signal of each input of such a scene.
std::vector<std::string> signals_of_inputs(const Scene& scene);

}  // namespace bough::scene
