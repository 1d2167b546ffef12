#pragma once
/// Names of what sensors give and what joints leave free.
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "bough/scene/scene.hpp"

namespace bough::scene {

/// Components of a sensor in the order of its columns; empty for a scalar, whose column is the sensor's name alone.
///   position x y z | rotation rx ry rz | quaternion q0 q1 q2 q3 | velocity vx vy vz wx wy wz | acceleration ax ay az
///     alx aly alz
///   section_force N Q2 Q3 T M2 M3 | section_strain e1 g2 g3 k1 k2 k3 | joint_reaction fx fy fz mx my mz
const std::vector<std::string>& components_of(SensorKind kind);

/// Unit of a component of a sensor, by its place in components_of; empty: a pure number.
std::string unit_of(const Sensor& sensor, std::size_t component);

/// Columns "<sensor>.<component>", or "<sensor>".
std::vector<std::string> columns_of(const Sensor& sensor);

/// Coordinates of a joint that can be driven, measured or sprung: "angle" (about axis 3), "displacement" (along axis
/// 3). revolute and planar: angle; prismatic: displacement; cylindrical and screw: both (of a screw they depend on
/// each other); others none.
const std::vector<std::string>& coordinates_of(JointKind kind);

/// What a plan may leave out (plan::Decision), as in Scene::without.
const std::vector<std::string>& decision_names();
/// Names of former decisions, which scenes may still bar: nothing follows from them but a note.
const std::vector<std::string>& retired_decision_names();
/// What a scene may bar: both of the above.
std::vector<std::string> names_in_without();

/// All kinds of joints, in the order of the schema.
inline constexpr std::array<JointKind, 8> joint_kinds{
    JointKind::fixed,       JointKind::revolute,  JointKind::spherical, JointKind::prismatic,
    JointKind::cylindrical, JointKind::universal, JointKind::planar,    JointKind::screw};

/// The kind of this name in files; nothing where none has it.
std::optional<JointKind> joint_kind_named(const std::string& name);

/// The coordinate whose rate a sensor measures: the one that it names, or else the first that the joint has.
std::string rate_coordinate(const Sensor& sensor, JointKind kind);

/// Names as in files.
std::string to_string(JointKind kind);
std::string to_string(SensorKind kind);
std::string to_string(FigureKind kind);
std::string to_string(MeasureKind kind);

/// Figures that FigureKind and MeasureKind share come first in both, in the same order.
static_assert(static_cast<int>(MeasureKind::period) == static_cast<int>(FigureKind::period));

}  // namespace bough::scene
