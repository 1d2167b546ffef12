#pragma once
/// What a scene is made of once it is understood: nodes, elements, time functions, block graph. Immutable after make_plan.
#include <string>
#include <vector>

#include "bough/blocks/block_graph.hpp"
#include "bough/laws/law.hpp"
#include "bough/plan/elements_of.hpp"
#include "bough/scene/scene.hpp"

namespace bough::plan {

struct NodePlan {
  std::string name;            ///< of the scene's node or body, or `<beam>.<k>`
  motion::Frame<double> pose;  ///< at the start
  motion::Vec6<double> twist;  ///< at the start, own axes, as given (not yet consistent)
};

/// A constraint element and where it comes from.
struct JointPlan {
  std::string name;
  int element = 0;           ///< global element id
  int block = -1;            ///< multiplier block
  int multiplier_begin = 0;  ///< in the array of all multipliers
  bool counts_turns = false;
  std::string what;  ///< "joint", "prescribed motion", "held rotation"
};

/// Elements of one beam of the scene, in order along its axis.
struct BeamPlan {
  std::string name;
  int order = 1;
  double length = 0.0;
  std::vector<int> elements;            ///< global ids
  std::vector<std::vector<int>> loads;  ///< global ids of the line loads on each element
  std::vector<int> nodes;               ///< of the whole axis, start to end
};

/// A time function with its place in Surroundings::laws.
struct LawPlan {
  laws::Law law;
  std::string user;  ///< "/loads/2" style owner in words, for messages
};

struct SensorPlan {
  scene::Sensor sensor;
  elements::Port port;                  ///< of point sensors
  int beam = -1;                        ///< index in Plan::beams
  int joint = -1;                       ///< index in Plan::joints (reaction, angle)
  std::vector<std::string> components;  ///< "" for a scalar
};

struct Plan {
  std::string scene_name;
  bool is_dynamic = true;
  motion::Vec3<double> gravity;  ///< times laws[gravity_law]
  int gravity_law = 0;
  std::vector<NodePlan> nodes;
  ElementArrays elements;
  std::vector<ElementPlace> directory;     ///< by global element id
  std::vector<std::string> element_owner;  ///< name of the scene's thing behind each element
  std::vector<JointPlan> joints;
  int num_multipliers = 0;
  std::vector<BeamPlan> beams;
  std::vector<LawPlan> laws;
  std::vector<SensorPlan> sensors;
  std::vector<int> body_nodes;  ///< nodes of the scene's bodies, in its order
  std::vector<motion::Vec3<double>> body_centers;
  blocks::BlockGraph graph;        ///< blocks: nodes, then one per joint
  double length_scale = 1.0;       ///< [m], size of the structure
  std::vector<std::string> notes;  ///< what the plan chose where the scene leaves it open, in words
};

/// Elements, nodes and graph of a scene. Precondition: problems_in(scene) is empty.
Plan make_plan(const scene::Scene& scene);

}  // namespace bough::plan
