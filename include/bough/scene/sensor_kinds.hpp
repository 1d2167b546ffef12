#pragma once
/// The kinds of sensors as a table. What a kind is in files, in checks, in histories and in texts follows from its
/// entry; how it is evaluated stands in the table of kernels in `results`.
#include <optional>
#include <string>
#include <vector>

#include "bough/scene/joint_kinds.hpp"

namespace bough::scene {

/// What a sensor is attached to.
enum class SensorOf : std::uint8_t {
  point,       ///< a point of a node, a body, a frame or the ground (`at`), or of a beam's axis (`beam`, `station`)
  section,     ///< a section of a beam (`beam`, `station`)
  beam,        ///< the whole of a beam (`beam`)
  reaction,    ///< a joint
  coordinate,  ///< a coordinate of a joint
  signal,      ///< a signal of the scene
  subdomain,   ///< a sub-domain of the tree of the solver
  part,        ///< a prescribed motion, coupling or load (`of`)
  whole,       ///< nothing: it measures the whole structure
};

/// What values depend on. Those of `pose` and `rate` can be interpolated between steps; forces and energies cannot: in
/// a stiff part, they respond to the smallest error of a position.
enum class SensorShows : std::uint8_t {
  pose,
  rate,   ///< velocities
  force,  ///< accelerations, forces or strains
  energy,
};

/// Fields that some kinds take besides those of what they are attached to.
enum class SensorField : std::uint8_t {
  axes,         ///< of the ground or of the body
  observer,     ///< `frame`: a frame from which the motion is seen and in whose axes it is given
  axes_of,      ///< `frame`: a frame, a node or a body in whose axes it is given
  chain,        ///< `frames`
  coordinate,   ///< of a joint
  effort_part,  ///< `of`
  resultant,    ///< `component`: one of a section force
};

struct SensorComponent {
  std::string name;  ///< empty: the only one
  std::string unit;  ///< empty: a pure number
};

struct SensorType {
  SensorKind kind;
  std::string name;  ///< in files
  SensorOf of;
  SensorShows shows;
  std::vector<SensorComponent> components;
  std::vector<SensorField> fields;
  std::string about;
  std::string coordinate = {};  ///< that it measures; empty: the one that the sensor names

  bool takes(SensorField field) const;
};

/// All kinds, in the order of SensorKind.
const std::vector<SensorType>& sensor_types();
const SensorType& type_of(SensorKind kind);
/// The kind of this name in files; nothing where none has it.
std::optional<SensorKind> sensor_kind_named(const std::string& name);
std::string to_string(SensorKind kind);

/// Components for readers: "vx vy vz [m/s] wx wy wz [rad/s]".
std::string components_text(const SensorType& type);

/// Names of the components of a sensor in the order of its columns; empty for a scalar.
std::vector<std::string> components_of(SensorKind kind);
/// Unit of a component of a sensor, by its place; empty: a pure number. The coordinate of a joint has to be named. That of
/// a signal is in units_of_signals.
std::string unit_of(const Sensor& sensor, std::size_t component);
/// The children to take from the root, of a path as "0.1"; nothing where it is none.
std::optional<std::vector<int>> read_path(const std::string& path);
/// Columns "<sensor>.<component>", or "<sensor>".
std::vector<std::string> columns_of(const Sensor& sensor);

/// The coordinate of a joint that a sensor measures, or whose rate it measures: the one that its kind or the sensor
/// names, otherwise the first. nullptr if the joint has no such coordinate, or the sensor measures none.
const JointCoordinate* coordinate_of(const Sensor& sensor, const JointType& joint);

}  // namespace bough::scene
