#pragma once
/// The moving structure for ParaView: one VTU file per frame and a PVD file that lists them with their times.
#include <filesystem>
#include <string>
#include <vector>

#include "bough/results/records.hpp"

namespace bough::io {

/// Sizes of what has no size of its own in a frame.
struct VtuOptions {
  double section_width = 0.0;  ///< side of the square section that is swept along a beam's curve [m], > 0
  double body_width = 0.0;     ///< side of the box that stands for a body [m], > 0
};

/// Widths that suit the structure's extent: 1 % and 4 % of the diagonal of its bounding box (1 m where that is 0).
VtuOptions vtu_options_for(const results::MotionFrame& frame);

/// An unstructured grid, VTK XML format 1.0, little-endian doubles appended raw.
/// Cells: per beam its axis as a polyline and the swept section as hexahedra; per body a box; per link a line.
/// Cell data: `kind` (0 beam, 1 body, 2 link), `part` (index within its kind, in the order of the frame).
/// Point data: `force` (N, Q2, Q3) [N] and `moment` (T, M2, M3) [N m] in section axes, `axis_1`, `axis_2`, `axis_3` (section or body
/// axes, inertial components); zero where a point has none.
std::string vtu_text(const results::MotionFrame& frame, const VtuOptions& options);

struct PvdEntry {
  double time = 0.0;
  std::string file;  ///< relative to the PVD file
};
std::string pvd_text(const std::vector<PvdEntry>& entries);

}  // namespace bough::io
