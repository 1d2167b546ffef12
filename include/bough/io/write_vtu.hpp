#pragma once
/// The moving structure for ParaView: one VTU file per frame and a PVD file that lists them with their times.
#include <filesystem>
#include <string>
#include <vector>

#include "bough/records/run.hpp"

namespace bough::io {

/// An unstructured grid, VTK XML format 1.0, little-endian, appended raw, each array compressed by zlib.
/// Cells: per beam its axis as a polyline, and its section, cut into triangles, as wedges from point to point; per body
/// the triangles of its surface, or its centre as a vertex; per joint, spring and bushing a line; per load a vertex.
/// Cell data: `kind` (0 beam, 1 body, 2 link, 3 load), `part` (index within its kind), `subdomain` (leaf of the
/// solver's tree that holds a beam's element; -1 elsewhere). Field data: `beam_names`, `body_names`, `link_names`,
/// `load_names`. Point data, float32: `force` (N, Q2, Q3) [N], `moment` (T, M2, M3) [N m], `strain` (e1, g2, g3),
/// `curvature` (k1, k2, k3) [1/m] in section axes, of loads force and moment in those of the ground; `velocity`
/// [m/s]; `axis_1`, `axis_2`, `axis_3` (section axes, on axes of beams; zero elsewhere). Points are float32, and
/// float64 where that would take more than a ten-thousandth of the size of the structure.
std::string vtu_text(const records::MotionFrame& frame, const records::MotionParts& parts = {});

struct PvdEntry {
  double time = 0.0;
  std::string file;  ///< relative to the PVD file
  void checkpoint(records::Archive& archive) { archive(time, file); }
};
/// Readers sort pictures by their time steps. Where times do not grow, as load factors along a path do not, the time
/// steps are therefore the numbers of the pictures; the files keep their times as `TimeValue`.
std::string pvd_text(const std::vector<PvdEntry>& entries);

}  // namespace bough::io
