#pragma once
/// Frames that stand in each other, fixed or moving by laws of time.
#include <cstddef>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "bough/scene/scene.hpp"

namespace bough::scene {

/// Index in scene.frames by name; nothing where there is no such frame.
using FindFrame = std::function<std::optional<std::size_t>(const std::string&)>;

/// All frames of a scene: parents, poses at the start, what of them moves. Made by one walk over the frames without
/// recursion, so that a scene may nest them as deep as it likes. The ground is the inertial frame, or the frame the
/// analysis is described in; a frame that no other frame names as the ground's own, or as one that the ground stands
/// in, stands in the ground.
class FrameTree {
 public:
  static constexpr std::size_t none = std::numeric_limits<std::size_t>::max();

  FrameTree(const Scene& scene, const FindFrame& find);

  /// The frame that a frame stands in; none for the ground, and where there is no such frame.
  std::size_t parent(std::size_t frame) const { return parent_[frame]; }
  /// From the analysis' frame up to the one that stands in nothing; ends where a name is not found or comes again.
  const std::vector<std::size_t>& above_ground() const { return ground_; }
  /// At the start, in the ground. Nothing where it stands in a frame that is not there, or in itself.
  const std::optional<Frame>& pose(std::size_t frame) const { return frames_[frame].pose; }
  /// Whether it moves in the ground, itself or by a frame that it stands in.
  bool is_moving(std::size_t frame) const { return frames_[frame].moves; }
  /// Whether the way up from it never ends.
  bool stands_in_itself(std::size_t frame) const { return frames_[frame].circles; }

 private:
  struct OfFrame {
    std::optional<Frame> pose;
    bool moves = false, circles = false, known = false;
  };
  void settle_ground(const Scene& scene);
  void settle(const Scene& scene, const std::vector<std::size_t>& way);

  std::vector<std::size_t> parent_, ground_;
  std::vector<bool> is_lost_;  ///< stands in a frame that is not there
  std::vector<OfFrame> frames_;
};

}  // namespace bough::scene
