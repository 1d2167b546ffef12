#include "bough/scene/components.hpp"

#include <stdexcept>

namespace bough::scene {

const std::vector<std::string>& components_of(SensorKind kind) {
  using List = std::vector<std::string>;
  static const List position = {"x", "y", "z"}, rotation = {"rx", "ry", "rz"}, quaternion = {"q0", "q1", "q2", "q3"},
                    velocity = {"vx", "vy", "vz", "wx", "wy", "wz"},
                    acceleration = {"ax", "ay", "az", "alx", "aly", "alz"}, force = {"N", "Q2", "Q3", "T", "M2", "M3"},
                    strain = {"e1", "g2", "g3", "k1", "k2", "k3"}, reaction = {"fx", "fy", "fz", "mx", "my", "mz"},
                    split = {"local_x",       "local_y",       "local_z",       "tangential_x", "tangential_y",
                             "tangential_z",  "coriolis_x",    "coriolis_y",    "coriolis_z",   "centripetal_x",
                             "centripetal_y", "centripetal_z", "razi_x",        "razi_y",       "razi_z",
                             "translation_x", "translation_y", "translation_z", "total_x",      "total_y",
                             "total_z"},
                    none = {};
  switch (kind) {
    case SensorKind::position:
      return position;
    case SensorKind::rotation:
      return rotation;
    case SensorKind::quaternion:
      return quaternion;
    case SensorKind::velocity:
      return velocity;
    case SensorKind::acceleration:
      return acceleration;
    case SensorKind::section_force:
      return force;
    case SensorKind::section_strain:
      return strain;
    case SensorKind::joint_reaction:
      return reaction;
    case SensorKind::acceleration_split:
      return split;
    default:
      return none;
  }
}

std::string unit_of(const Sensor& sensor, std::size_t component) {
  const bool is_first_half = component < 3;
  switch (sensor.kind) {
    case SensorKind::position:
    case SensorKind::joint_displacement:
      return "m";
    case SensorKind::rotation:
    case SensorKind::joint_angle:
      return "rad";
    case SensorKind::quaternion:
      return "";
    case SensorKind::velocity:
      return is_first_half ? "m/s" : "rad/s";
    case SensorKind::acceleration:
      return is_first_half ? "m/s^2" : "rad/s^2";
    case SensorKind::section_force:
    case SensorKind::joint_reaction:
      return is_first_half ? "N" : "N m";
    case SensorKind::section_strain:
      return is_first_half ? "" : "1/m";
    case SensorKind::joint_rate:
      return sensor.coordinate == "displacement" ? "m/s" : "rad/s";
    case SensorKind::kinetic_energy:
    case SensorKind::strain_energy:
    case SensorKind::potential_energy:
    case SensorKind::total_energy:
      return "J";
    case SensorKind::acceleration_split:
      return "m/s^2";
  }
  throw std::logic_error("a kind of sensor without a unit");
}

std::vector<std::string> columns_of(const Sensor& sensor) {
  const auto& components = components_of(sensor.kind);
  if (components.empty()) return {sensor.name};
  std::vector<std::string> r;
  for (const std::string& c : components) r.push_back(sensor.name + "." + c);
  return r;
}

const std::vector<std::string>& decision_names() {
  static const std::vector<std::string> names{"welded",    "line",     "translation", "planar", "held",
                                              "symmetric", "definite", "reuse",       "lanes",  "small"};
  return names;
}

const std::vector<std::string>& retired_decision_names() {
  static const std::vector<std::string> names{"driven"};
  return names;
}

std::vector<std::string> names_in_without() {
  std::vector<std::string> names = decision_names();
  names.insert(names.end(), retired_decision_names().begin(), retired_decision_names().end());
  return names;
}

const JointCoordinate* coordinate_of(const Sensor& sensor, const JointType& joint) {
  switch (sensor.kind) {
    case SensorKind::joint_angle:
      return joint.coordinate("angle");
    case SensorKind::joint_displacement:
      return joint.coordinate("displacement");
    case SensorKind::joint_rate:
      return !sensor.coordinate.empty()   ? joint.coordinate(sensor.coordinate)
             : !joint.coordinates.empty() ? &joint.coordinates.front()
                                          : nullptr;
    default:
      return nullptr;
  }
}

std::string to_string(FigureKind kind) { return to_string(static_cast<MeasureKind>(kind)); }

std::string to_string(MeasureKind kind) {
  static const char* const names[] = {
      "value", "max", "min",        "time_of_max",   "time_of_min",        "range",  "period",
      "mean",  "rms", "percentile", "settling_time", "dominant_frequency", "cycles", "equivalent_range"};
  return names[static_cast<int>(kind)];
}

std::string to_string(SensorKind kind) {
  static const char* const names[] = {"position",      "rotation",           "quaternion",     "velocity",
                                      "acceleration",  "section_force",      "section_strain", "joint_reaction",
                                      "joint_angle",   "joint_displacement", "joint_rate",     "kinetic_energy",
                                      "strain_energy", "potential_energy",   "total_energy",   "acceleration_split"};
  return names[static_cast<int>(kind)];
}

}  // namespace bough::scene
