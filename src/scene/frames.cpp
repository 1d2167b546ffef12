#include "bough/scene/frames.hpp"

#include <algorithm>

namespace bough::scene {

std::vector<std::size_t> frames_above(const Scene& scene, const std::string& name, const FindFrame& find) {
  std::vector<std::size_t> r;
  for (const std::string* at = &name; !at->empty() && *at != "ground";) {
    const auto index = find(*at);
    if (!index || std::find(r.begin(), r.end(), *index) != r.end()) break;
    r.push_back(*index);
    at = &scene.frames[*index].placement.frame;
  }
  return r;
}

std::optional<Frame> pose_in_ground(const Scene& scene, const Placement& placement, const FindFrame& find) {
  const std::vector<std::size_t> ground = frames_above(scene, scene.analysis.frame, find);
  Frame pose = placement.pose;
  const std::string* parent = &placement.frame;
  for (std::size_t depth = 0; depth <= scene.frames.size(); ++depth) {
    if (parent->empty() || *parent == "ground") return pose;
    const auto index = find(*parent);
    if (!index) return std::nullopt;
    if (const auto at = std::find(ground.begin(), ground.end(), *index); at != ground.end()) {
      // The ground stands in this frame, or is it: up from the ground, then back.
      Frame up = Frame::identity();
      for (auto i = ground.begin(); i != at; ++i) up = motion::compose(scene.frames[*i].placement.pose, up);
      return at == ground.begin() ? pose : motion::compose(motion::inverse(up), pose);
    }
    pose = motion::compose(scene.frames[*index].placement.pose, pose);
    parent = &scene.frames[*index].placement.frame;
  }
  return std::nullopt;  // a frame stands in itself
}

bool is_moving(const Scene& scene, const std::string& name, const FindFrame& find) {
  const std::vector<std::size_t> ground = frames_above(scene, scene.analysis.frame, find);
  std::vector<std::size_t> way = frames_above(scene, name, find);
  // Of both ways up, only what is not common moves one against the other.
  const auto common = std::find_if(way.begin(), way.end(), [&](std::size_t i) {
    return std::find(ground.begin(), ground.end(), i) != ground.end();
  });
  const auto moves = [&](std::size_t i) { return scene.frames[i].motion.has_value(); };
  if (std::any_of(way.begin(), common, moves)) return true;
  if (common == way.end()) return false;
  return std::any_of(ground.begin(), std::find(ground.begin(), ground.end(), *common), moves);
}

}  // namespace bough::scene
