#pragma once
/// Translates a scene to rigid parts and their connections. Internal to plan.
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "bough/plan/unknowns.hpp"
#include "bough/scene/joint_kinds.hpp"
#include "bough/scene/poses.hpp"
#include "bough/scene/scene.hpp"
#include "linkage.hpp"

namespace bough::plan {

/// What forces that signals drive hold in statics. Their stiffness is the product of the directions in which they act
/// and of the coordinates that their signals read, so that it resists a motion only if it moves along both. `reads`
/// counts the coordinates as held, `acts` the directions; what either leaves free is free for certain.
enum class SignalsHold : std::uint8_t { nothing, reads, acts };

/// Which parts of a scene count as rigid connections.
struct LinkageChoice {
  bool beams_are_rigid = true;  ///< false: beams are flexible and connect nothing
  /// Prescribed coordinates and motions that vary count as fixed, and so do rotations of point masses without effect.
  bool drives_hold = false;
  bool stiffness_holds = false;  ///< couplings and springs in joints count as rigid
  SignalsHold signals = SignalsHold::nothing;
  /// Every motion with inertia counts as held, so that motions without inertia remain. Beams that are not rigid then
  /// count as massive at all their nodes.
  bool mass_holds = false;
  bool nothing_turns = false;  ///< a mass is inertia enough to hold a body
};

/// A linkage without parts, with the center and size of the box around all nodes and bodies and the places of all
/// joints. precision: relative, to which rows of joints are known; rows that depend on each other within it do.
Linkage empty_linkage(const scene::Scene& scene, const scene::Poses& poses, double precision = 0.0);

/// Signals of places and forces, as indices, on which forces depend that signals drive.
std::vector<std::size_t> places_read_by_forces(const scene::Scene& scene);

class SceneLinkage {
 public:
  /// empty: as above; the same for all linkages of a scene.
  SceneLinkage(const scene::Scene& scene, const scene::Poses& poses, const Linkage& empty, const LinkageChoice& choice);

  /// Restricts all parts to the motions of a scene in a plane, without rotation or on a line. normal: of the plane.
  void restrict_to(Motions motions, const Vec3d& normal);

  Linkage linkage;
  std::vector<std::string> names;         ///< by part; that of the ground is empty
  std::vector<bool> has_beam;             ///< by part
  int part_of(const std::string& place);  ///< part of a place; frames belong to the ground
  /// The row of a coordinate of a joint. H_a, H_b: poses of its frames.
  Twist row_of(const scene::Joint& j, const scene::JointRow& row, const motion::Frame<double>& H_a,
               const motion::Frame<double>& H_b) const;

 private:
  int add_part(const std::string& name);
  /// Place of a node or body in part_at_; none for all else.
  std::optional<std::size_t> place_of(std::string_view name) const;
  void add_joint(const scene::Joint& j);
  void add_motion(const scene::PrescribedMotion& m);
  void add_stiffness();
  void add_rows(LinkEdge& edge, const motion::Mat6<double>& stiffness, const motion::Frame<double>& frame,
                const Vec3d& x);
  void add_signals();
  void add_reading(const scene::Signal& signal);
  void add_action(const std::string& place, const Vec3d& x, const Vec3d& force, const Vec3d& moment);
  void add_load(const scene::PointLoad& load);
  void add_lateral(const scene::Joint& joint);
  void add_point_masses();
  void add_masses(const scene::Body& b);
  void add_masses(const scene::Beam& b);
  void hold(const std::string& place, std::vector<Twist> rows);

  const scene::Scene& scene_;
  const scene::Poses& poses_;
  LinkageChoice choice_;
  std::vector<int> part_at_;                            ///< by node, then by body, in the scene's order
  std::unordered_map<std::string, int> part_of_inner_;  ///< of nodes within flexible beams
};

}  // namespace bough::plan
