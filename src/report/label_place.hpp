#pragma once
/// Where a label may stand beside a line of a drawing, off what else is drawn there. All in pixels, y downwards.
#include <vector>

namespace bough::report {

struct Segment {
  double x0, y0, x1, y1;
};
struct Box {
  double left, top, right, bottom;
};
struct LabelPlace {
  double x, y;  ///< of the text's base line, at its start or end
  bool is_end;  ///< the text ends there
};

/// Box of a label of this width in letters of 12 px.
Box box_of(const LabelPlace& place, double width);

/// Whether any part of a segment lies in a box.
bool meets(const Segment& segment, const Box& box);

/// Beside `line`, from its first end on, preferably below it: the first place within `area` at which the label meets
/// nothing of `drawn`, the line itself included; where there is none, that at which it meets least.
LabelPlace place_label(const Segment& line, double width, const std::vector<Segment>& drawn, const Box& area);

}  // namespace bough::report
