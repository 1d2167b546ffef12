#pragma once
/// Tree of frames: each frame is placed in a parent frame, fixed there or moving by laws of time.
#include <cstddef>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "bough/scene/scene.hpp"

namespace bough::scene {

/// Returns the index of a frame in scene.frames by its name; none where there is no such frame.
using FindFrame = std::function<std::optional<std::size_t>(const std::string&)>;

/// The frames of a scene as a tree: parents, poses at the start, and which of them move. It is built by one pass over
/// the frames without recursion, so that frames may be nested to any depth. The ground is the inertial frame, or the
/// frame in which the analysis is described (Analysis::frame). A frame without a named parent is placed in the ground,
/// unless the ground is described, directly or through other frames, in it.
class FrameTree {
 public:
  static constexpr std::size_t none = std::numeric_limits<std::size_t>::max();

  FrameTree(const Scene& scene, const FindFrame& find);

  /// Index of the parent frame; none where the parent is the ground or does not exist.
  std::size_t parent(std::size_t frame) const { return parent_[frame]; }
  /// The frames from the analysis' frame up to the one without a parent. The list ends early where a name is not found
  /// or where the frames form a circle.
  const std::vector<std::size_t>& above_ground() const { return ground_; }
  /// Pose at the start, relative to the ground. None where an ancestor does not exist or the frame is its own ancestor.
  const std::optional<Frame>& pose(std::size_t frame) const { return frames_[frame].pose; }
  /// Whether the frame moves relative to the ground, by its own laws or by those of an ancestor.
  bool is_moving(std::size_t frame) const { return frames_[frame].moves; }
  /// Whether the frame is its own ancestor, directly or through other frames.
  bool stands_in_itself(std::size_t frame) const { return frames_[frame].circles; }

 private:
  struct OfFrame {
    std::optional<Frame> pose;
    bool moves = false, circles = false, known = false;
  };
  void settle_ground(const Scene& scene);
  void settle(const Scene& scene, const std::vector<std::size_t>& way);

  std::vector<std::size_t> parent_, ground_;
  std::vector<bool> is_lost_;  ///< an ancestor does not exist
  std::vector<OfFrame> frames_;
};

}  // namespace bough::scene
