#pragma once
/// The kinds of joints as a table. What a kind is in files, in checks, in the plan, in pictures and in texts follows
/// from its entry; a kind made of known rows is an entry and a name in JointKind.
#include <optional>
#include <string>
#include <vector>

#include "bough/motion/coordinates.hpp"
#include "bough/scene/scene.hpp"

namespace bough::scene {

/// A coordinate of the relative pose that is held at 0, with the axes of both joint frames (from 0) that it compares.
struct JointRow {
  motion::RowKind kind;
  motion::Se3::Direction<double> axes = motion::Se3::Direction<double>::axial();
};

/// A coordinate along axis 3 that can be driven, sprung and measured: the motion of the second relative to the first.
struct JointCoordinate {
  std::string name;
  motion::RowKind kind;
  bool is_length() const { return motion::traits_of(kind).is_length; }
};

/// The axes that the joint frames are made from: none; axis 3 of both; or axis 1 of the first and axis 2 of the second,
/// which are perpendicular.
enum class JointAxes : std::uint8_t { none, one, two };

/// A prism about axis 3 of a joint frame, in units of the size in which joints are drawn.
struct GlyphPrism {
  int sides;
  double radius, half_length;
};

struct JointType {
  JointKind kind;
  std::string name;  ///< in files
  std::vector<JointRow> rows;
  std::vector<JointCoordinate> coordinates;
  JointAxes axes;
  std::vector<GlyphPrism> glyph;
  std::string about;  ///< what it leaves free, for schema and texts

  const JointCoordinate* coordinate(const std::string& named) const;  ///< nullptr: it has none of this name
  bool has_pitch() const;                                             ///< a row is a screw
  bool holds(const JointCoordinate& coordinate) const;                ///< at its initial value, unless it is driven
  bool has_common_frame() const;  ///< the frames of both sides coincide at the start, in what the rows hold
  bool joins_points() const;      ///< it takes hold of points of both parts and of no direction
  /// Parts turn or slide about a common axis 3.
  bool has_common_axis() const { return axes == JointAxes::one && !coordinates.empty(); }
};

/// All kinds, in the order of JointKind.
const std::vector<JointType>& joint_types();
const JointType& type_of(JointKind kind);
/// The kind of this name in files; nothing where none has it.
std::optional<JointKind> joint_kind_named(const std::string& name);
std::string to_string(JointKind kind);

/// Its rows for readers: "u = 0; e1.R e3 = e2.R e3 = 0".
std::string equations_of(const JointType& type);
/// A text of motion::RowTraits with the numbers of the axes that a row compares, from 0 in the row and 1 in the text.
std::string with_axes(std::string text, const motion::Se3::Direction<double>& axes);

/// Value of a coordinate at H, the pose of the second joint frame in the first, and its gradient (force; moment) in
/// the axes of the second. Angles are between -pi and pi. pitch: per turn [m], of a screw.
struct RowValue {
  double value;
  Vec6 gradient;
};
RowValue eval_row(const JointRow& row, double pitch, const Frame& H);

/// Displacement per radian [m/rad], from that per turn.
constexpr double pitch_per_radian(double pitch) { return pitch / (2.0 * 3.14159265358979323846); }

}  // namespace bough::scene
