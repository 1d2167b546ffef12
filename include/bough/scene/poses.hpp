#pragma once
/// Poses at the start, through any depth of fixed frames.
#include <optional>
#include <string>

#include "bough/scene/scene.hpp"

namespace bough::scene {

/// Pose of a placement in the inertial frame. A frame that is not there, or a circle of frames, ends the chain: `problems_in` tells of those.
Frame resolve(const Scene& scene, const Placement& placement);

/// Pose at the start of a node or body, of the ground ("" or "ground") or of a fixed frame; nothing when there is no such name.
std::optional<Frame> initial_pose(const Scene& scene, const std::string& name);

}  // namespace bough::scene
