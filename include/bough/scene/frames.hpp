#pragma once
/// Frames that stand in each other, fixed or moving by laws of time.
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "bough/scene/scene.hpp"

namespace bough::scene {

/// Index in scene.frames by name; nothing where there is no such frame.
using FindFrame = std::function<std::optional<std::size_t>(const std::string&)>;

/// Pose of a placement at the start, in the ground: the inertial frame, or the frame the analysis is described in. A frame that no other
/// frame names as the ground's own, or as one that the ground stands in, stands in the ground. Nothing where a frame is not found or stands in
/// itself.
std::optional<Frame> pose_in_ground(const Scene& scene, const Placement& placement, const FindFrame& find);

/// Names from a frame up to the one that stands in nothing, the frame first; ends where a name is not found, is "ground" or comes again.
std::vector<std::size_t> frames_above(const Scene& scene, const std::string& name, const FindFrame& find);

/// Whether the frame moves in the ground, or a frame that it stands in does.
bool is_moving(const Scene& scene, const std::string& name, const FindFrame& find);

}  // namespace bough::scene
