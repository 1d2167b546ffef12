#include "bough/report/projection.hpp"

#include <algorithm>
#include <cmath>

namespace bough::report {
namespace {

constexpr std::pair<std::string_view, View> names[] = {
    {"auto", View::automatic}, {"xy", View::xy}, {"xz", View::xz}, {"yz", View::yz}, {"iso", View::iso}};

constexpr double planar_below = 0.02;  // relative to the largest extent: smaller ones are hardly visible on paper

void include(Box& box, const double* x) {
  if (!(std::isfinite(x[0]) && std::isfinite(x[1]) && std::isfinite(x[2]))) return;
  for (std::size_t k = 0; k < 3; ++k) {
    box.low[k] = box.empty ? x[k] : std::min(box.low[k], x[k]);
    box.high[k] = box.empty ? x[k] : std::max(box.high[k], x[k]);
  }
  box.empty = false;
}

}  // namespace

std::optional<View> view_named(std::string_view name) {
  for (const auto& [known, view] : names)
    if (known == name) return view;
  return std::nullopt;
}

std::string_view name_of(View view) {
  for (const auto& [name, known] : names)
    if (known == view) return name;
  return "iso";
}

Projection projection_of(View view) {
  switch (view) {
    case View::xy:
      return {{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}};
    case View::xz:
      return {{1.0, 0.0, 0.0}, {0.0, 0.0, 1.0}};
    case View::yz:
      return {{0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}};
    case View::iso:
    case View::automatic:
      break;
  }
  const double a = 1.0 / std::sqrt(2.0), b = 1.0 / std::sqrt(6.0);
  return {{a, a, 0.0}, {-b, b, 2.0 * b}};
}

Box box_of(const std::vector<records::MotionFrame>& frames) {
  Box box;
  for (const records::MotionFrame& frame : frames) {
    for (const records::Curve& curve : frame.curves)
      for (const records::CurvePoint& point : curve.points) include(box, point.position);
    for (const records::BodyPose& body : frame.bodies) {
      include(box, body.center);
      for (const auto& point : body.attachments) include(box, point.data());
    }
    for (const records::Link& link : frame.links) {
      include(box, link.first);
      include(box, link.second);
    }
  }
  return box;
}

View resolve_view(View view, const Box& box) {
  if (view != View::automatic) return view;
  double extent[3];
  for (std::size_t k = 0; k < 3; ++k) extent[k] = box.high[k] - box.low[k];
  const double thin = planar_below * std::max({extent[0], extent[1], extent[2]});
  if (extent[1] <= thin) return View::xz;  // tested first, so that a motion along one line is drawn with z up
  if (extent[2] <= thin) return View::xy;
  if (extent[0] <= thin) return View::yz;
  return View::iso;
}

}  // namespace bough::report
