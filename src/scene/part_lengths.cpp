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

PartLengths::PartLengths(const Scene& scene, const Poses& poses) {
  for (const Node& n : scene.nodes) extents_[n.name].include(Vec3::zero());
  for (const Body& b : scene.bodies) {
    Extent& extent = extents_[b.name];
    extent.include(b.center_of_mass);
    const double trace = b.inertia(0, 0) + b.inertia(1, 1) + b.inertia(2, 2);
    if (b.mass > 0.0 && trace > 0.0) extent.least = std::sqrt(0.5 * trace / b.mass);
  }
  const auto hold = [this](const Attachment& a) {
    if (const auto part = extents_.find(a.to); part != extents_.end()) part->second.include(a.offset.x);
  };
  const auto hold_both = [&hold](const auto& list) {
    for (const auto& item : list) {
      hold(item.first);
      hold(item.second);
    }
  };
  hold_both(scene.joints);
  hold_both(scene.springs);
  hold_both(scene.bushings);
  for (const PrescribedMotion& m : scene.motions) hold(m.at);
  for (const Beam& b : scene.beams) {
    hold({b.start, {Mat3::identity(), b.start_offset.value_or(Vec3::zero())}});
    hold({b.end, {Mat3::identity(), b.end_offset.value_or(Vec3::zero())}});
    const double length = poses.length_of(b);
    for (const std::string& place : {b.start, b.end, b.name})
      extents_[place].least = std::max(extents_[place].least, length);
  }
}

double PartLengths::of(const std::string& place) const {
  auto part = extents_.find(place);
  if (part == extents_.end()) part = extents_.find(place.substr(0, place.rfind('.')));
  return part == extents_.end() ? 0.0 : part->second.length();
}

double PartLengths::of_joint(const Attachment& first, const Attachment& second, double size) const {
  constexpr double least_part = 1e-6;
  const double length = std::max(of(first.to), of(second.to));
  return length > 0.0 ? std::max(length, least_part * size) : size;
}

}  // namespace bough::scene
