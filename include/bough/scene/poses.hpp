#pragma once
/// Poses at the start in the ground, through any depth of frames. The ground is the inertial frame, or the frame the
/// analysis is described in.
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>

#include "bough/scene/frames.hpp"
#include "bough/scene/scene.hpp"

namespace bough::scene {

/// Pose of a placement in the ground. The result is not meaningful where a frame does not exist or frames form a
/// circle; `problems_in` reports such scenes.
Frame resolve(const Scene& scene, const Placement& placement);

/// Pose at the start of a node or body, of the ground ("" or "ground"), of a fixed frame or of an inner node of a beam;
/// none when there is no such name. Each call searches the scene: for many names make a Poses.
std::optional<Frame> initial_pose(const Scene& scene, const std::string& name);

/// Kind of the part that a name refers to. Frames, nodes, bodies, beams, joints, couplings, loads and motions share one
/// set of names.
enum class ThingKind : std::uint8_t { frame, node, body, beam, joint, other };
struct Thing {
  ThingKind kind;
  std::size_t index;  ///< in the scene's list of its kind
};

/// The undeformed axis of a beam with the section axes along it, at the start in the ground.
struct BeamAxis {
  Frame start;          ///< section axes at the start, origin on the axis
  double length = 0.0;  ///< [m]
  /// Of a straight beam: from the start to the end [m], and the angle about axis 1 by which the sections turn over it
  /// [rad]. Of a curved one: (k1, k2, k3) [1/m].
  Vec3 span = Vec3::zero(), curvature = Vec3::zero();
  double twist = 0.0;
  bool is_straight = true;
  Frame at(double fraction) const;  ///< at a fraction of the length [0, 1]
};

/// Names and initial poses of a scene. Keeps a reference to the scene, which has to outlive it and not change.
class Poses {
 public:
  explicit Poses(const Scene& scene);

  /// The part with this name, the first one where several have it; none where no part has it.
  std::optional<Thing> find(std::string_view name) const;

  /// Initial pose of a frame, node, body or inner node of a beam ("<beam>.<k>", k = 0 .. elements * order) in the
  /// ground. "" and "ground" are the ground itself. None where there is no such part, or where a frame is its own
  /// ancestor.
  std::optional<Frame> of(std::string_view name) const;
  std::optional<Frame> of(const Thing& thing) const;  ///< none for what is no frame, node or body
  std::optional<Frame> of(const Placement& placement) const;
  std::optional<Frame> of(const Attachment& attachment) const;

  /// Index of a frame in the scene's list.
  std::optional<std::size_t> frame(const std::string& name) const;
  /// Whether a frame moves in the ground.
  bool is_moving(const std::string& frame_name) const;
  const FrameTree& frames() const { return frames_; }

  /// Axis of the undeformed beam: axis 1 of its sections runs along it. Straight: from start to end, turned about axis
  /// 1 by fraction * twist. Curved: H(0) exp(s (1, 0, 0; k)), s = fraction * length. Section axis 2 at the start is
  /// `axis_2` made perpendicular to axis 1; where axis_2 is zero, see default_axis_2. Nothing where an end is not
  /// found, the length is 0 or axis_2 runs along axis 1.
  std::optional<BeamAxis> axis_of(const Beam& beam) const;

  /// Length of the undeformed axis [m]; 0 where an end is not found.
  double length_of(const Beam& beam) const;

 private:
  std::optional<Frame> chain(const Placement& placement) const;

  const Scene& scene_;
  std::unordered_map<std::string_view, Thing> things_;  ///< by names that the scene holds
  FrameTree frames_;
};

/// Section axis 2 where none is given: such that axis 3 lies nearest to inertial z; for a beam along z, inertial y.
/// Not normalised.
Vec3 default_axis_2(const Vec3& axis_1);

/// Rotation with axis number k (1, 2, 3) along `main` and the one after it (cyclic) nearest to `next`. Nothing where
/// main is zero or next runs along it.
std::optional<Mat3> axes_from(int k, const Vec3& main, const Vec3& next);

}  // namespace bough::scene
