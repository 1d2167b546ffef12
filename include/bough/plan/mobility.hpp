#pragma once
/// Degrees of freedom at the start: the freedoms that joints leave to rigid parts, the conditions that close loops, and
/// motions that are locked, unresisted or without inertia.
#include <string>
#include <vector>

namespace bough::plan {

/// One mechanism: nodes, bodies and beams that joints connect, where the ground does not count as a connection. Beams
/// are taken to be rigid.
struct MobilityPart {
  std::vector<std::string> names;
  int joints = 0;
  int freedoms = 0;      ///< left by the joints of a spanning tree; 6 more if the part is not connected to the ground
  int closing_rows = 0;  ///< conditions of the joints that close loops
  int rank = 0;          ///< how many of these are independent
  int drives = 0;        ///< prescribed coordinates
  bool has_beams = false, reaches_ground = false;
  bool is_counted = true;  ///< false: the loops have too many joints to compute the rank, which is taken to be full
  int degrees_of_freedom() const { return freedoms - rank; }
};

struct Mobility {
  std::vector<MobilityPart> parts;
  /// Rigid mechanisms that cannot move, each with the joint whose axis prevents it; in dynamics.
  std::vector<std::string> locked;
  /// Motions against which there is no stiffness, only loads; in statics.
  std::vector<std::string> free;
  /// Motions without any mass or inertia; in dynamics.
  std::vector<std::string> massless;
  int degrees_of_freedom() const;
};

}  // namespace bough::plan
