#pragma once
/// A picture of one frame as PNG, drawn by the program itself: shaded triangles and lines with a depth buffer, in a
/// parallel projection. Needs no browser and no graphics hardware; the same frame gives the same bytes.
#include <string>

#include "bough/report/page.hpp"

namespace bough::report {

struct RasterOptions {
  View view = View::automatic;
  int width = 1000, height = 700;  ///< [px]
};

/// The motion at a time, interpolated between recorded frames. Precondition: run.motion is not empty.
/// Beams with their sections (those without one as lines), bodies with their surfaces or as spokes, springs and joints
/// as lines and squares, point loads as arrows. The scale is that of the box of all frames. Pictures of at least
/// 400 x 250 pixels show the axes, a length to scale and the time below.
std::string picture_png(const RunFiles& run, double time, const RasterOptions& options = {});

}  // namespace bough::report
