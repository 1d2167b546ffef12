#pragma once
/// A scene as rigid parts and what holds them to each other: internal to plan.
#include <map>
#include <set>
#include <string>
#include <vector>

#include "bough/plan/unknowns.hpp"
#include "bough/scene/poses.hpp"
#include "bough/scene/scene.hpp"
#include "linkage.hpp"

namespace bough::plan {

/// What counts as holding, and what as one part.
struct LinkageChoice {
  bool beams_are_rigid = true;   ///< false: beams hold nothing, they bend
  bool drives_hold = false;      ///< prescribed coordinates and motions that vary
  bool stiffness_holds = false;  ///< springs, bushings, springs in joints
  bool mass_holds = false;       ///< every motion that some inertia resists: what is left is without
};

class SceneLinkage {
 public:
  SceneLinkage(const scene::Scene& scene, const scene::Poses& poses, const LinkageChoice& choice);

  /// Holds all parts to the motions that a scene in a plane, without rotation or on a line has. normal: of the plane.
  void restrict_to(Motions motions, const Vec3d& normal);

  Linkage linkage;
  std::vector<std::string> names;         ///< by part; the ground's is empty
  std::vector<bool> has_beam;             ///< by part
  int part_of(const std::string& place);  ///< the ground for frames

 private:
  void add_joint(const scene::Joint& j);
  void add_motion(const scene::PrescribedMotion& m);
  void add_stiffness();
  void add_point_masses();
  void add_masses(const scene::Body& b);
  void hold(const std::string& place, std::vector<Twist> rows);

  const scene::Scene& scene_;
  const scene::Poses& poses_;
  LinkageChoice choice_;
  std::map<std::string, int> part_of_;
};

}  // namespace bough::plan
