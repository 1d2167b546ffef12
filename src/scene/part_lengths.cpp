#include "bough/scene/part_lengths.hpp"

#include <algorithm>
#include <cmath>

namespace bough::scene {

void PartLengths::Extent::include(const Vec3& x) {
  for (int k = 0; k < 3; ++k) {
    low[k] = has_points ? std::min(low[k], x[k]) : x[k];
    high[k] = has_points ? std::max(high[k], x[k]) : x[k];
  }
  has_points = true;
}

double PartLengths::Extent::length() const {
  const double diagonal = has_points ? std::hypot(high[0] - low[0], high[1] - low[1], high[2] - low[2]) : 0.0;
  return std::max(diagonal, least);
}

PartLengths::PartLengths(const Scene& scene, const Poses& poses)
    : poses_(poses),
      first_body_(scene.nodes.size()),
      first_beam_(first_body_ + scene.bodies.size()),
      extents_(first_beam_ + scene.beams.size()) {
  for (std::size_t i = 0; i < first_body_; ++i) extents_[i].include(Vec3::zero());
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    const Body& b = scene.bodies[i];
    Extent& extent = extents_[first_body_ + i];
    extent.include(b.center_of_mass);
    const double trace = b.inertia(0, 0) + b.inertia(1, 1) + b.inertia(2, 2);
    if (b.mass > 0.0 && trace > 0.0) extent.least = std::sqrt(0.5 * trace / b.mass);
  }
  const auto hold = [this](const Attachment& a) {
    if (const auto part = find(a.to)) extents_[*part].include(a.offset.x);
  };
  const auto hold_both = [&hold](const auto& list) {
    for (const auto& item : list) {
      hold(item.first);
      hold(item.second);
    }
  };
  hold_both(scene.joints);
  hold_both(scene.couplings);
  for (const PrescribedMotion& m : scene.motions) hold(m.at);
  for (std::size_t i = 0; i < scene.beams.size(); ++i) {
    const Beam& b = scene.beams[i];
    const double length = poses.length_of(b);
    extents_[first_beam_ + i].least = length;
    const auto end_at = [&](const std::string& place, const std::optional<Vec3>& offset) {
      const auto part = find(place);
      if (!part) return;
      extents_[*part].include(offset.value_or(Vec3::zero()));
      extents_[*part].least = std::max(extents_[*part].least, length);
    };
    end_at(b.start, b.start_offset);
    end_at(b.end, b.end_offset);
  }
}

std::optional<std::size_t> PartLengths::find(std::string_view name) const {
  const auto thing = poses_.find(name);
  if (!thing) return std::nullopt;
  switch (thing->kind) {
    case ThingKind::node:
      return thing->index;
    case ThingKind::body:
      return first_body_ + thing->index;
    case ThingKind::beam:
      return first_beam_ + thing->index;
    default:
      return std::nullopt;
  }
}

double PartLengths::of(const std::string& place) const {
  auto part = find(place);
  if (!part) part = find(std::string_view(place).substr(0, place.rfind('.')));
  return part ? extents_[*part].length() : 0.0;
}

double PartLengths::of_joint(const Attachment& first, const Attachment& second, double size) const {
  constexpr double least_part = 1e-6;
  const double length = std::max(of(first.to), of(second.to));
  return length > 0.0 ? std::max(length, least_part * size) : size;
}

}  // namespace bough::scene
