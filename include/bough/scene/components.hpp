#pragma once
/// Names of the components of sensors, and of decisions.
#include <string>
#include <vector>

#include "bough/scene/joint_kinds.hpp"

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

/// Names of the decisions of the plan (plan::Decision) that Scene::without can bar.
const std::vector<std::string>& decision_names();
/// Names of decisions that no longer exist. A scene may still bar them; it gets a note and nothing else follows.
const std::vector<std::string>& retired_decision_names();
/// All names accepted in Scene::without: both lists above.
std::vector<std::string> names_in_without();

/// The coordinate of a joint that a sensor measures, or whose rate it measures: the one that its kind or the sensor
/// names, otherwise the first. nullptr if the joint has no such coordinate, or the sensor measures none.
const JointCoordinate* coordinate_of(const Sensor& sensor, const JointType& joint);

/// Names as in files.
std::string to_string(SensorKind kind);
std::string to_string(FigureKind kind);
std::string to_string(MeasureKind kind);

/// The figures that FigureKind and MeasureKind have in common come first in both enumerations, in the same order.
static_assert(static_cast<int>(MeasureKind::period) == static_cast<int>(FigureKind::period));

}  // namespace bough::scene
