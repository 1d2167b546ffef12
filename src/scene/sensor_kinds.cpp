#include "bough/scene/sensor_kinds.hpp"

#include <algorithm>
#include <charconv>

namespace bough::scene {
namespace {

using Components = std::vector<SensorComponent>;

/// Components of one unit.
Components in(const std::string& unit, const std::vector<std::string>& names) {
  Components r;
  for (const std::string& name : names) r.push_back({name, unit});
  return r;
}
Components operator+(Components a, const Components& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

std::vector<SensorType> make_types() {
  using F = SensorField;
  using enum SensorOf;
  using enum SensorShows;
  const std::vector<F> seen = {F::axes, F::observer};
  const std::vector<std::string> parts = {"local", "tangential",  "coriolis", "centripetal",
                                          "razi",  "translation", "total"};
  Components split;
  for (const std::string& part : parts) split = split + in("m/s^2", {part + "_x", part + "_y", part + "_z"});
  return {
      {SensorKind::position, "position", point, pose, in("m", {"x", "y", "z"}), seen, "Position of a point."},
      {SensorKind::rotation, "rotation", point, pose, in("rad", {"rx", "ry", "rz"}), seen,
       "Rotation vector from the ground's axes."},
      {SensorKind::quaternion, "quaternion", point, pose, in("", {"q0", "q1", "q2", "q3"}), seen,
       "Rotation from the ground's axes, the scalar first."},
      {SensorKind::velocity, "velocity", point, rate, in("m/s", {"vx", "vy", "vz"}) + in("rad/s", {"wx", "wy", "wz"}),
       seen, "Velocity of a point and angular velocity."},
      {SensorKind::acceleration, "acceleration", point, force,
       in("m/s^2", {"ax", "ay", "az"}) + in("rad/s^2", {"alx", "aly", "alz"}), seen,
       "Acceleration of a point and angular acceleration."},
      {SensorKind::section_force,
       "section_force",
       section,
       force,
       in("N", {"N", "Q2", "Q3"}) + in("N m", {"T", "M2", "M3"}),
       {},
       "Section resultants, in section axes."},
      {SensorKind::section_strain,
       "section_strain",
       section,
       force,
       in("", {"e1", "g2", "g3"}) + in("1/m", {"k1", "k2", "k3"}),
       {},
       "Section strains, in section axes."},
      {SensorKind::joint_reaction, "joint_reaction", reaction, force,
       in("N", {"fx", "fy", "fz"}) + in("N m", {"mx", "my", "mz"}), seen,
       "Wrench of the first on the second at the second's joint frame. Axes body: those of that frame."},
      {SensorKind::joint_angle,
       "joint_angle",
       coordinate,
       pose,
       in("rad", {""}),
       {},
       "Angle of a joint, the second relative to the first; turns are counted.",
       "angle"},
      {SensorKind::joint_displacement,
       "joint_displacement",
       coordinate,
       pose,
       in("m", {""}),
       {},
       "Displacement of a joint, the second relative to the first.",
       "displacement"},
      {SensorKind::joint_rate,
       "joint_rate",
       coordinate,
       rate,
       in("rad/s", {""}),
       {F::coordinate},
       "Rate of a coordinate of a joint; of a displacement in m/s."},
      {SensorKind::kinetic_energy,
       "kinetic_energy",
       whole,
       energy,
       in("J", {""}),
       {},
       "Of the whole, in the inertial frame."},
      {SensorKind::strain_energy,
       "strain_energy",
       whole,
       energy,
       in("J", {""}),
       {},
       "Of all beams, springs, bushings, other couplings and springs of joints."},
      {SensorKind::potential_energy,
       "potential_energy",
       whole,
       energy,
       in("J", {""}),
       {},
       "Of gravity, in the inertial frame."},
      {SensorKind::total_energy, "total_energy", whole, energy, in("J", {""}), {}, "Sum of the three energies."},
      {SensorKind::acceleration_split,
       "acceleration_split",
       point,
       force,
       split,
       {F::chain, F::axes_of},
       "Inertial acceleration of a point, split along a chain of frames that move in each other, the first in the "
       "inertial frame (Harithuddin, Trivailo, Jazar 2015); translation is that of the origin of the last frame, total "
       "the sum."},
      {SensorKind::relative_position,
       "relative_position",
       point,
       pose,
       in("m", {"x", "y", "z"}),
       {F::axes_of},
       "Position of a point from the origin of another part, in the axes of that part, which is given as `frame`."},
      {SensorKind::signal, "signal", SensorOf::signal, force, in("its own", {""}), {}, "Value of a signal."},
      {SensorKind::interface_force, "interface_force", subdomain, force,
       in("N", {"fx", "fy", "fz"}) + in("N m", {"mx", "my", "mz"}), seen,
       "Wrench of the rest of the structure on a sub-domain of the solver's tree at one node of its interface, the "
       "local "
       "Lagrange multipliers there; without `at` the resultant at all nodes, about their mean position."},
      {SensorKind::force, "force", SensorOf::part, SensorShows::force,
       in("N", {"fx", "fy", "fz"}) + in("N m", {"mx", "my", "mz"}), seen,
       "Wrench of a prescribed motion or a load on its part, at the place where it acts (of a line load "
       "about the start of its beam), or of a spring or bushing on its second, at that end. Axes body: "
       "those of the part at that place, of a bushing those of its stiffness, carried by the second."},
      {SensorKind::joint_effort,
       "joint_effort",
       coordinate,
       force,
       in("N m", {""}),
       {F::coordinate, F::effort_part},
       "Torque on the second along a coordinate of a joint, of all that acts along it or of one part of that; of a "
       "displacement the force in N."},
      {SensorKind::section_force_extremes,
       "section_force_extremes",
       SensorOf::beam,
       SensorShows::force,
       in("N", {"least", "largest"}) + in("", {"least_at", "largest_at"}),
       {F::resultant},
       "Least and largest value of a section resultant along a beam, and their stations; of a moment in N m."},
  };
}

}  // namespace

bool SensorType::takes(SensorField field) const {
  return std::find(fields.begin(), fields.end(), field) != fields.end();
}

const std::vector<SensorType>& sensor_types() {
  static const std::vector<SensorType>& types = *new std::vector<SensorType>(make_types());  // as joint_types()
  return types;
}

std::optional<std::vector<int>> read_path(const std::string& path) {
  std::vector<int> children;
  for (std::size_t begin = 0; begin <= path.size();) {
    const std::size_t end = std::min(path.find('.', begin), path.size());
    int child = -1;
    const auto [last, error] = std::from_chars(path.data() + begin, path.data() + end, child);
    if (error != std::errc{} || last != path.data() + end || child < 0) return std::nullopt;
    children.push_back(child);
    begin = end + 1;
  }
  return children;
}

const SensorType& type_of(SensorKind kind) { return sensor_types().at(static_cast<std::size_t>(kind)); }

std::optional<SensorKind> sensor_kind_named(const std::string& name) {
  for (const SensorType& type : sensor_types())
    if (type.name == name) return type.kind;
  return std::nullopt;
}

std::string to_string(SensorKind kind) { return type_of(kind).name; }

std::string components_text(const SensorType& type) {
  std::string text;
  for (std::size_t k = 0; k < type.components.size(); ++k) {
    const SensorComponent& c = type.components[k];
    if (!c.name.empty()) text += (text.empty() ? "" : " ") + c.name;
    const bool is_last = k + 1 == type.components.size() || type.components[k + 1].unit != c.unit;
    if (is_last) text += (text.empty() ? "[" : " [") + (c.unit.empty() ? "-" : c.unit) + "]";
  }
  return text;
}

std::vector<std::string> components_of(SensorKind kind) {
  std::vector<std::string> names;
  for (const SensorComponent& c : type_of(kind).components)
    if (!c.name.empty()) names.push_back(c.name);
  return names;
}

std::string unit_of(const Sensor& sensor, std::size_t component) {
  const SensorType& type = type_of(sensor.kind);
  if (type.takes(SensorField::resultant) && !type.components.at(component).unit.empty())
    for (const SensorComponent& c : type_of(SensorKind::section_force).components)
      if (c.name == sensor.component) return c.unit;
  if (!type.takes(SensorField::coordinate)) return type.components.at(component).unit;
  const bool is_effort = sensor.kind == SensorKind::joint_effort;
  for (const JointType& joint : joint_types())
    if (const JointCoordinate* c = joint.coordinate(sensor.coordinate))
      return c->is_length() ? (is_effort ? "N" : "m/s") : is_effort ? "N m" : "rad/s";
  return type.components.at(component).unit;
}

std::vector<std::string> columns_of(const Sensor& sensor) {
  std::vector<std::string> columns;
  for (const SensorComponent& c : type_of(sensor.kind).components)
    columns.push_back(c.name.empty() ? sensor.name : sensor.name + "." + c.name);
  return columns;
}

const JointCoordinate* coordinate_of(const Sensor& sensor, const JointType& joint) {
  const SensorType& type = type_of(sensor.kind);
  if (type.of != SensorOf::coordinate || joint.coordinates.empty()) return nullptr;
  const std::string& name = type.coordinate.empty() ? sensor.coordinate : type.coordinate;
  return name.empty() ? &joint.coordinates.front() : joint.coordinate(name);
}

}  // namespace bough::scene
