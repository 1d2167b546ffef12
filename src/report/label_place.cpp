#include "label_place.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace bough::report {
namespace {

constexpr double letter_height = 10.0, descent = 3.0;  // of letters of 12 px, above and below their base line
constexpr double gap = 5.0;                            // between the line and the nearest corner of the label
constexpr int num_places = 80;                         // along the line

}  // namespace

Rectangle rectangle_of(const LabelPlace& place, double width) {
  const double left = place.is_end ? place.x - width : place.x;
  return {left, place.y - letter_height, left + width, place.y + descent};
}

/// Clipping by Liang and Barsky.
bool meets(const Segment& s, const Rectangle& box) {
  const double dx = s.x1 - s.x0, dy = s.y1 - s.y0;
  double enters = 0.0, leaves = 1.0;
  const auto clip = [&](double speed, double room) {
    if (speed == 0.0) return room >= 0.0;
    const double at = room / speed;
    if (speed < 0.0)
      enters = std::max(enters, at);
    else
      leaves = std::min(leaves, at);
    return enters <= leaves;
  };
  return clip(-dx, s.x0 - box.left) && clip(dx, box.right - s.x0) && clip(-dy, s.y0 - box.top) &&
         clip(dy, box.bottom - s.y0);
}

LabelPlace place_label(const Segment& line, double width, const std::vector<Segment>& drawn, const Rectangle& area) {
  const bool rises = (line.x1 - line.x0) * (line.y1 - line.y0) <= 0.0;
  LabelPlace best{};
  std::ptrdiff_t least = -1;
  for (const bool is_below : {true, false})
    for (int k = 0; k < num_places; ++k) {
      const double part = (k + 0.5) / num_places;
      const double x = line.x0 + part * (line.x1 - line.x0), y = line.y0 + part * (line.y1 - line.y0);
      // Below a rising line there is room to its right, above it to its left; a corner of the label is next to the
      // line.
      const bool is_end = is_below != rises;
      const LabelPlace place{is_end ? x - gap : x + gap, is_below ? y + letter_height : y - descent, is_end};
      const Rectangle box = rectangle_of(place, width);
      if (box.left < area.left || box.right > area.right || box.top < area.top || box.bottom > area.bottom) continue;
      const std::ptrdiff_t met =
          std::count_if(drawn.begin(), drawn.end(), [&](const Segment& s) { return meets(s, box); });
      if (least >= 0 && met >= least) continue;
      least = met;
      best = place;
    }
  if (least < 0) return {line.x0, line.y0, false};
  return best;
}

}  // namespace bough::report
