#pragma once
/// Position of a label beside a line of a drawing, clear of other lines. Coordinates are in pixels, y downwards.
#include <vector>

namespace bough::report {

struct Segment {
  double x0, y0, x1, y1;
};
struct Rectangle {
  double left, top, right, bottom;
};
struct LabelPlace {
  double x, y;  ///< of the text's base line, at its start or end
  bool is_end;  ///< the text ends there
};

/// The extent of a label of this width in letters of 12 px.
Rectangle rectangle_of(const LabelPlace& place, double width);

/// Whether any part of a segment lies in a rectangle.
bool meets(const Segment& segment, const Rectangle& box);

/// The first place beside `line` within `area`, from its first end on and first below it, at which the label meets no
/// segment of `drawn` (which includes the line itself). If there is none, the place with the fewest segments met.
LabelPlace place_label(const Segment& line, double width, const std::vector<Segment>& drawn, const Rectangle& area);

}  // namespace bough::report
