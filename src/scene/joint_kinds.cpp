#include "bough/scene/joint_kinds.hpp"

#include <algorithm>

namespace bough::scene {
namespace {

using motion::RowKind;
using Rows = std::vector<JointRow>;

Rows operator+(Rows a, const Rows& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

std::vector<JointType> make_types() {
  // What joints are made of. Axis 2, the third, is the joint's own.
  const Rows line = {{RowKind::along, {0, 0}}, {RowKind::along, {1, 0}}};    // the origin on axis 3 of the first
  const Rows plane = {{RowKind::along, {2, 0}}};                             // the origin in the plane normal to it
  const Rows point = line + plane;                                           // both origins at one point
  const Rows axis = {{RowKind::across, {0, 2}}, {RowKind::across, {1, 2}}};  // axes 3 parallel
  const Rows orientation = {{RowKind::across, {0, 1}}, {RowKind::across, {1, 2}}, {RowKind::across, {2, 0}}};
  const Rows right_angle = {{RowKind::across, {0, 1}}};
  const Rows spin = {{RowKind::angle}};  // no rotation about axis 3
  const Rows screw = {{RowKind::screw}};

  const JointCoordinate angle = {"angle", RowKind::angle}, displacement = {"displacement", RowKind::along};
  const std::vector<JointCoordinate> no_coordinates = {};
  return {
      {JointKind::fixed,
       "fixed",
       point + orientation,
       no_coordinates,
       JointAxes::none,
       {{4, 1.0, 0.7}},
       "The second moves as a part of the first."},
      {JointKind::revolute,
       "revolute",
       point + axis,
       {angle},
       JointAxes::one,
       {{12, 0.7, 1.4}},
       "Rotation about axis 3."},
      {JointKind::spherical,
       "spherical",
       point,
       no_coordinates,
       JointAxes::none,
       {{12, 1.0, 0.4}, {12, 0.8, 0.75}, {12, 0.45, 1.0}},
       "Rotation about a point."},
      {JointKind::prismatic,
       "prismatic",
       line + orientation,
       {displacement},
       JointAxes::one,
       {{4, 0.6, 2.4}},
       "Displacement along axis 3."},
      {JointKind::cylindrical,
       "cylindrical",
       line + axis,
       {angle, displacement},
       JointAxes::one,
       {{12, 0.6, 2.4}},
       "Rotation about axis 3 and displacement along it."},
      {JointKind::universal,
       "universal",
       point + right_angle,
       no_coordinates,
       JointAxes::two,
       {{4, 1.0, 0.5}, {8, 0.5, 1.2}},
       "Rotation about axis 1, fixed in the first, and about axis 2, fixed in the second; both stay perpendicular."},
      {JointKind::planar,
       "planar",
       plane + axis,
       {angle},
       JointAxes::one,
       {{4, 2.0, 0.2}},
       "Displacement in the plane normal to axis 3, and rotation about axis 3."},
      {JointKind::screw,
       "screw",
       line + axis + screw,
       {angle, displacement},
       JointAxes::one,
       {{12, 0.7, 1.4}},
       "Rotation about axis 3 with a displacement along it of `pitch` a turn."},
      {JointKind::constant_velocity,
       "constant_velocity",
       point + spin,
       no_coordinates,
       JointAxes::one,
       {{12, 1.0, 0.5}, {12, 0.5, 1.2}},
       "Bending of two shafts along axes 3, at whose every angle both turn at one rate: the rotation of the second "
       "against the first is about an axis normal to axis 3. Shafts that are bent at the start have their own "
       "rotations "
       "in first and second."},
      {JointKind::distance,
       "distance",
       {{RowKind::distance}},
       {{"displacement", RowKind::distance}},
       JointAxes::none,
       {{12, 0.8, 0.5}},
       "All motions that keep the distance between two points, as a rod between two ball joints does; a drive "
       "prescribes "
       "the distance, which is its displacement."},
      {JointKind::strut,
       "strut",
       {},
       {{"displacement", RowKind::distance}},
       JointAxes::none,
       {{12, 0.5, 2.0}},
       "All motions. Springs, dampers, efforts and drives act along the line between two points, whose distance is its "
       "displacement, as in a cylinder or a servo."},
  };
}

/// "u = 0", "u1 = u2 = 0", "e1.R e3 = e2.R e3 = 0": rows of one kind are one chain of equations.
std::string text_of(const Rows& rows, RowKind kind) {
  std::string text;
  int count = 0;
  for (const JointRow& row : rows) {
    if (row.kind != kind) continue;
    text += with_axes(motion::traits_of(kind).equation, row.axes) + " = ";
    ++count;
  }
  if (kind == RowKind::along && count == 3) return "u = 0";
  return count == 0 ? "" : text + "0";
}

}  // namespace

const JointCoordinate* JointType::coordinate(const std::string& named) const {
  const auto at =
      std::find_if(coordinates.begin(), coordinates.end(), [&](const JointCoordinate& c) { return c.name == named; });
  return at == coordinates.end() ? nullptr : &*at;
}

bool JointType::has_pitch() const {
  return std::any_of(rows.begin(), rows.end(), [](const JointRow& row) { return row.kind == RowKind::screw; });
}

bool JointType::has_common_frame() const {
  const auto is_between_points = [](const auto& of) { return motion::traits_of(of.kind).is_between_points; };
  return std::none_of(rows.begin(), rows.end(), is_between_points) &&
         std::none_of(coordinates.begin(), coordinates.end(), is_between_points);
}

bool JointType::holds(const JointCoordinate& coordinate) const {
  return std::any_of(rows.begin(), rows.end(), [&](const JointRow& row) {
    return row.kind == coordinate.kind && motion::traits_of(row.kind).is_between_points;
  });
}

bool JointType::joins_points() const { return motion::joins_points(rows); }

const std::vector<JointType>& joint_types() {
  static const std::vector<JointType>& types =
      *new std::vector<JointType>(make_types());  // texts refer to it to the end
  return types;
}

const JointType& type_of(JointKind kind) { return joint_types().at(static_cast<std::size_t>(kind)); }

std::optional<JointKind> joint_kind_named(const std::string& name) {
  for (const JointType& type : joint_types())
    if (type.name == name) return type.kind;
  return std::nullopt;
}

std::string to_string(JointKind kind) { return type_of(kind).name; }

std::string with_axes(std::string text, const motion::Se3::Direction<double>& axes) {
  for (const auto& [mark, axis] : {std::pair{"{i}", axes.i}, std::pair{"{j}", axes.j}})
    if (const std::size_t at = text.find(mark); at != std::string::npos) text.replace(at, 3, std::to_string(axis + 1));
  return text;
}

std::string equations_of(const JointType& type) {
  std::string text;
  for (std::size_t k = 0; k < std::size(motion::row_traits); ++k)
    if (const std::string one = text_of(type.rows, static_cast<RowKind>(k)); !one.empty())
      text += (text.empty() ? "" : "; ") + one;
  return text.empty() ? "none" : text;
}

RowValue eval_row(const JointRow& row, double pitch, const Frame& H) {
  motion::DualVec<double> gradient;
  const double value = motion::eval_coordinate<motion::Se3, double, double>(row.kind, row.axes, pitch_per_radian(pitch),
                                                                            H, 0.0, gradient);
  return {value, motion::wrench_vector(gradient)};
}

}  // namespace bough::scene
