#pragma once
/// Degrees of freedom at the start: what joints leave to rigid parts, what the closing of loops takes, and what is
/// odd about the rest.
#include <string>
#include <vector>

namespace bough::plan {

/// One mechanism: nodes, bodies and beams that joints connect, the ground not counted as a connection. Beams are
/// taken as rigid.
struct MobilityPart {
  std::vector<std::string> names;
  int joints = 0;
  int freedoms = 0;      ///< that the joints of a spanning tree leave; 6 more where nothing ties the part to the ground
  int closing_rows = 0;  ///< conditions of the joints that close loops
  int rank = 0;          ///< how many of these are independent
  int drives = 0;        ///< prescribed coordinates
  bool has_beams = false, reaches_ground = false;
  bool is_counted = true;  ///< false: too many joints in loops; the rank is taken to be full
  int degrees_of_freedom() const { return freedoms - rank; }
};

struct Mobility {
  std::vector<MobilityPart> parts;
  /// Rigid mechanisms that cannot move, with the joint whose axis locks them; dynamics.
  std::vector<std::string> locked;
  /// Motions that nothing but loads resists; statics.
  std::vector<std::string> free;
  /// Motions that no mass or inertia resists; dynamics.
  std::vector<std::string> massless;
  int degrees_of_freedom() const;
};

}  // namespace bough::plan
