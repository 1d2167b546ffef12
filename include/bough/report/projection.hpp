#pragma once
/// Parallel projections of points in space to the plane of a drawing, with equal axes.
#include <array>
#include <optional>
#include <string_view>
#include <vector>

#include "bough/records/run.hpp"

namespace bough::report {

/// xy, xz, yz: first axis to the right, second up. iso: seen from (1, -1, 1), x to the right and down, y to the right
/// and up, z up. automatic: the plane of a planar motion, else iso.
enum class View { automatic, xy, xz, yz, iso };

std::optional<View> view_named(std::string_view name);  ///< "auto", "xy", "xz", "yz", "iso"
std::string_view name_of(View view);

struct Point2 {
  double u = 0.0, v = 0.0;  ///< to the right and up, in the unit of the points
};

/// u = right . x, v = up . x; `right` and `up` orthonormal.
struct Projection {
  std::array<double, 3> right{}, up{};
  Point2 operator()(const double* x) const {
    return {right[0] * x[0] + right[1] * x[1] + right[2] * x[2], up[0] * x[0] + up[1] * x[1] + up[2] * x[2]};
  }
};
Projection projection_of(View view);  ///< of anything but automatic

/// Smallest box around everything drawn in all frames.
struct Box {
  std::array<double, 3> low{}, high{};
  bool empty = true;
};
Box box_of(const std::vector<records::MotionFrame>& frames);

/// Resolves `automatic`: the plane across the axis along which the motion extends less than 2 % of its largest extent.
View resolve_view(View view, const Box& box);

}  // namespace bough::report
