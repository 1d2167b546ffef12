#include "bough/scene/poses.hpp"

#include <algorithm>

namespace bough::scene {

Frame resolve(const Scene& scene, const Placement& placement) {
  Frame pose = placement.pose;
  std::string parent = placement.frame;
  for (std::size_t depth = 0; !parent.empty() && depth <= scene.frames.size(); ++depth) {
    const auto frame =
        std::find_if(scene.frames.begin(), scene.frames.end(), [&](const FrameDef& f) { return f.name == parent; });
    if (frame == scene.frames.end()) break;
    pose = motion::compose(frame->placement.pose, pose);
    parent = frame->placement.frame;
  }
  return pose;
}

std::optional<Frame> initial_pose(const Scene& scene, const std::string& name) {
  if (name.empty() || name == "ground") return Frame::identity();
  for (const Node& n : scene.nodes)
    if (n.name == name) return resolve(scene, n.placement);
  for (const Body& b : scene.bodies)
    if (b.name == name) return resolve(scene, b.placement);
  for (const FrameDef& f : scene.frames)
    if (f.name == name) return resolve(scene, {Frame::identity(), name});
  return std::nullopt;
}

}  // namespace bough::scene
