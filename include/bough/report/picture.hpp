#pragma once
/// The moving structure as a drawing: positions over time laid over each other, coloured by time.
#include <string>
#include <vector>

#include "bough/report/projection.hpp"

namespace bough::report {

struct PictureOptions {
  View view = View::automatic;
  int num_positions = 9;    ///< superposed, 1 to 9
  bool is_static = false;   ///< frames are labelled by the load factor instead of the time [s]
  bool is_by_step = false;  ///< frames are labelled by the number of their step (by_step)
};

/// The drawing, and the path data of what it shows.
struct Picture {
  std::string svg;  ///< one <svg> element, styled by classes (style_text)
  struct Paths {
    double time = 0.0;
    std::string beams, bodies, springs, joints;  ///< path data in the drawing's coordinates [px]
  };
  std::vector<Paths> positions;
  View view = View::iso;  ///< as resolved
};

/// Equal axes, scale bar, axis triad, colour ramp of time and a legend of what occurs. frames: at least one;
/// non-finite points are skipped.
Picture make_picture(const std::vector<records::MotionFrame>& frames, const PictureOptions& options);

/// The drawing as a file of its own, with the styles for light and dark.
std::string standalone_svg(const Picture& picture, std::string_view title);

/// Styles of drawings and plots, light, and dark where the reader prefers it.
std::string_view style_text();

}  // namespace bough::report
