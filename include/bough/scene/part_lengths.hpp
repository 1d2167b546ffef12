#pragma once
/// How large the parts are that meet in a joint: what a gap in it is compared with.
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "bough/scene/poses.hpp"
#include "bough/scene/scene.hpp"

namespace bough::scene {

/// Lengths of nodes and bodies by what takes hold of them [m]. Built once from the whole scene; keeps a reference to
/// the poses, which have to outlive it. A length is the
/// largest of
///   the diagonal of the box, in the part's frame, around its centre of mass and all places where joints,
///   couplings and beams take hold,
///   its radius of gyration,
///   the longest beam that ends there.
class PartLengths {
 public:
  PartLengths(const Scene& scene, const Poses& poses);

  /// Length of a node, a body, or an inner node of a beam (the length of the beam); 0 for the ground, frames and
  /// points.
  double of(const std::string& place) const;

  /// Length of the larger of the two parts that a joint connects. If both are points, the size of the whole scene is
  /// used instead. The result is at least a millionth of that size, below which differences of positions are round-off.
  double of_joint(const Attachment& first, const Attachment& second, double size) const;

 private:
  struct Extent {
    Vec3 low, high;
    bool has_points = false;
    double least = 0.0;
    void include(const Vec3& x);
    double length() const;
  };

  /// Place in extents_; none for what is no node, body or beam.
  std::optional<std::size_t> find(std::string_view name) const;

  const Poses& poses_;
  std::size_t first_body_, first_beam_;
  std::vector<Extent> extents_;  ///< nodes, bodies and beams in the scene's order
};

}  // namespace bough::scene
