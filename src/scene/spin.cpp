#include "bough/scene/spin.hpp"

#include <algorithm>
#include <cmath>

#include "bough/motion/norm.hpp"

namespace bough::scene {

using motion::norm;

std::optional<Spin> spin_of(std::span<const PlaceVelocity> velocities) {
  constexpr double same = 1e-6;
  if (velocities.empty()) return std::nullopt;
  const Vec3 w = velocities.front().angular;
  Spin spin;
  spin.rate = norm(w);
  if (!(spin.rate > 0.0)) return std::nullopt;
  spin.axis = (1.0 / spin.rate) * w;
  const PlaceVelocity& first = velocities.front();
  spin.point = first.x + (1.0 / spin.rate) * cross(spin.axis, first.linear);
  double speed = 0.0;
  for (const PlaceVelocity& v : velocities) speed = std::max(speed, norm(v.linear));
  for (const PlaceVelocity& v : velocities) {
    const PlaceVelocity own = spin.at(v.x);
    const double allowed = same * std::max(speed, spin.rate * norm(Vec3(v.x - spin.point)));
    if (norm(Vec3(own.angular - v.angular)) > same * spin.rate || norm(Vec3(own.linear - v.linear)) > allowed)
      return std::nullopt;
  }
  return spin;
}

std::optional<std::vector<PlaceVelocity>> velocities_of_frames(const Scene& scene, const Poses& poses) {
  const std::vector<std::size_t>& carrying = poses.frames().above_ground();
  std::vector<PlaceVelocity> velocities;
  for (std::size_t i = 0; i < scene.frames.size(); ++i) {
    const FrameDef& f = scene.frames[i];
    if (!f.motion || std::find(carrying.begin(), carrying.end(), i) != carrying.end()) continue;
    const motion::FrameMotion m = motion_at(*f.motion, 0.0);
    if (dot(m.velocity, m.velocity) == 0.0 && dot(m.angular_velocity, m.angular_velocity) == 0.0) continue;
    const auto parent = poses.of(std::string_view(f.placement.frame));
    const auto pose = poses.frames().pose(i);
    if (!parent || !pose || poses.is_moving(f.placement.frame)) return std::nullopt;
    velocities.push_back({pose->x, parent->R * m.velocity, parent->R * m.angular_velocity});
  }
  return velocities;
}

}  // namespace bough::scene
