#include "bough/scene/frames.hpp"

#include <algorithm>

namespace bough::scene {

FrameTree::FrameTree(const Scene& scene, const FindFrame& find)
    : parent_(scene.frames.size(), none), is_lost_(scene.frames.size(), false), frames_(scene.frames.size()) {
  const std::size_t count = scene.frames.size();
  for (std::size_t i = 0; i < count; ++i) {
    const std::string& name = scene.frames[i].placement.frame;
    if (name.empty() || name == "ground") continue;
    parent_[i] = find(name).value_or(none);
    is_lost_[i] = parent_[i] == none;
  }
  std::vector<bool> is_on_way(count, false);
  const std::string& own = scene.analysis.frame;
  const auto first = own.empty() || own == "ground" ? std::nullopt : find(own);
  for (std::size_t i = first.value_or(none); i != none && !is_on_way[i]; i = parent_[i]) {
    is_on_way[i] = true;
    ground_.push_back(i);
  }
  settle_ground(scene);
  std::vector<std::size_t> way;
  for (std::size_t i = 0; i < count; ++i) {
    way.clear();
    for (std::size_t at = i; at != none && !frames_[at].known && !is_on_way[at]; at = parent_[at]) {
      is_on_way[at] = true;
      way.push_back(at);
    }
    settle(scene, way);
  }
}

/// Poses in the ground of the frame of the analysis, which is the ground, and of all frames that contain it.
void FrameTree::settle_ground(const Scene& scene) {
  Frame up = Frame::identity();
  bool moves = false;
  for (const std::size_t i : ground_) {
    frames_[i].pose = i == ground_.front() ? Frame::identity() : motion::inverse(up);
    frames_[i].moves = moves;
    frames_[i].circles = parent_[ground_.back()] != none;
    frames_[i].known = true;
    up = motion::compose(scene.frames[i].placement.pose, up);
    moves = moves || scene.frames[i].motion.has_value();
  }
}

/// way: frames from one upwards, to a frame whose parent is known, missing, or in `way` itself.
void FrameTree::settle(const Scene& scene, const std::vector<std::size_t>& way) {
  for (auto i = way.rbegin(); i != way.rend(); ++i) {
    OfFrame& frame = frames_[*i];
    const FrameDef& given = scene.frames[*i];
    frame.known = true;
    frame.moves = given.motion.has_value();
    if (parent_[*i] == none) {
      if (!is_lost_[*i]) frame.pose = given.placement.pose;
      continue;
    }
    const OfFrame& parent = frames_[parent_[*i]];
    frame.circles = !parent.known || parent.circles || parent_[*i] == *i;
    frame.moves = frame.moves || parent.moves;
    if (!frame.circles && parent.pose) frame.pose = motion::compose(*parent.pose, given.placement.pose);
  }
}

}  // namespace bough::scene
