#pragma once
/// A plan is a scene translated to the model that is computed: nodes, elements, time functions, block graph. It does
/// not change after make_plan.
#include <span>
#include <string>
#include <type_traits>
#include <variant>
#include <vector>

#include "bough/blocks/block_graph.hpp"
#include "bough/laws/formula.hpp"
#include "bough/laws/law.hpp"
#include "bough/motion/compensated.hpp"
#include "bough/motion/quaternion.hpp"
#include "bough/plan/elements_of.hpp"
#include "bough/plan/mobility.hpp"
#include "bough/plan/unknowns.hpp"
#include "bough/scene/scene.hpp"

namespace bough::plan {

struct NodePlan {
  std::string name;  ///< of the scene's node or body, or `<beam>.<k>`; of several welded nodes, the name of one of them
  motion::Frame<double> pose;  ///< at the start
  motion::Vec6<double> twist;  ///< at the start, own axes, as given (not yet consistent)
  /// A point mass on which forces act at its origin alone: nothing depends on its rotation, and it has none.
  bool is_point = false;
};

/// A node whose initial velocity is given in the scene, by the name of a node, of a body, or of a beam (then for each
/// of its nodes). NodePlan::twist holds that velocity.
struct GivenVelocity {
  std::string of;
  int node = 0;
  motion::Frame<double> offset =
      motion::Frame<double>::identity();  ///< pose of the named part relative to the node, where several were welded to
                                          ///< one node
  bool has_angular = true;                ///< the angular velocity was given, too
};

/// A constraint element and its origin in the scene.
struct JointPlan {
  std::string name;
  int element = 0;           ///< global element id
  int block = -1;            ///< multiplier block; -1: no row is an unknown, or the joint holds a node of Plan::held;
  int multiplier_begin = 0;  ///< in the array of all multipliers
  /// Numbers of its rows that are unknowns, in order. All other rows are satisfied by every motion that the scene has,
  /// and their multipliers are zero.
  std::vector<int> rows;
  std::string what;  ///< "joint", "prescribed motion"
  /// Length of the larger of the two parts that it connects, for judging gaps [m] (scene::PartLengths).
  double length = 1.0;
};

/// A node that joints hold at rest, in the ground or in the observer's frame. It has no unknowns, and the multipliers
/// of these joints are no unknowns either: they follow from the equilibrium of the node, W multipliers + (all other
/// forces) = 0.
struct HeldNode {
  int node = 0;
  std::vector<int> joints;  ///< indices in Plan::joints; the joints have together as many `rows` as a node has unknowns
  /// W^-1, row-major: maps a wrench in the unknowns of the node to the multipliers of `rows`, joint after joint.
  std::vector<double> inverse;
};

/// A body of the scene. Its frame is the frame of a node, or has an offset from the node to which it is welded.
struct BodyPlan {
  std::string name;
  elements::Port frame;
  motion::Vec3<double> center;              ///< of mass, in the body's frame [m]
  std::vector<elements::Port> attachments;  ///< attachment points of beams, joints and couplings, for pictures
};

/// A fixed joint whose two sides became one node (decision "welded"). It is no element, but pictures show it.
struct WeldPlan {
  std::string name;
  elements::Port first, second;
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

/// A time function, and where the scene uses it.
struct LawPlan {
  laws::Law law;
  std::string user;  ///< "/loads/2" style owner in words, for messages
  bool at_start =
      false;  ///< evaluated at time 0 whatever the load factor: motion of the frame in which statics is described
};

/// A frame of prescribed motion, or a fixed frame between such frames. Parents come before their children.
///   pose in the parent:  x_i = laws[position_i] or constant,  R = R_0 exp(laws[angle_1] ~axis_1) exp(laws[angle_2]
///     ~axis_2) ...
struct FramePlan {
  struct Turn {
    motion::Vec3<double> axis;  ///< unit, in the axes reached before it
    int angle = 0;              ///< law
  };
  std::string name;
  int parent = -1;           ///< in Plan::frames; -1: the inertial frame
  bool in_observer = false;  ///< placed in Plan::observer, directly or through other frames
  motion::Frame<double> pose = motion::Frame<double>::identity();  ///< (R_0, constant x)
  int position[3] = {-1, -1, -1};                                  ///< laws; -1: constant
  std::vector<Turn> turns;
};

/// A simplification of the model, whether it was taken, and why. All decisions are made before memory is allocated.
struct Decision {
  std::string name;
  std::string what;    ///< what the decision means, and the exact condition for taking it
  std::string reason;  ///< why it was taken, or the first reason against it
  bool taken = false;
  bool barred = false;         ///< excluded by Scene::without
  bool can_be_barred = false;  ///< is one of scene::decision_names(); all others follow from the scene and cannot be
                               ///< excluded
};

/// A law derived from another one: a component, in the ground's axes, of a vector fixed in a frame, times a factor.
///   laws[law] = laws[factor] (R vector)_row
struct TurnedLawPlan {
  int law = 0, factor = 0, frame = 0, row = 0;
  motion::Vec3<double> vector;
};

/// What the equation of a signal evaluates.
enum class SignalRule : std::uint8_t {
  coordinate,  ///< of the relative motion of two frames
  rate,        ///< of such a coordinate
  effort,      ///< along such a coordinate: of springs and dampers, of laws, and of a constraint
  function,    ///< a law, with another signal in the place of time
  surface,     ///< a table of two other signals or laws
  formula,     ///< of other signals and laws
  state,       ///< the same, for the signal's rate
  input,       ///< a number that is given from outside
};

/// A signal that changes with the motion: an unknown s with one equation, s = f or s' = f. Plan::signals holds them
/// such that each comes after those of whose present values it is made. Signals that are laws of time are Plan::laws
/// alone. A signal that no element reads, itself or by other signals, only observes: it comes after all others, has
/// neither a block nor an element, and is evaluated when a state has been accepted.
struct SignalPlan {
  std::string name;
  std::string unit;  ///< empty: a pure number, or not known
  SignalRule rule = SignalRule::formula;
  int law = -1;      ///< its place among the values of laws, where elements and other signals read it
  int element = -1;  ///< of the block graph, after those of the directory
  int block = -1;
  /// coordinate, rate, effort: a joint without rows, whose only effort has the coordinate; that of `effort` has the
  /// stiffness, rest and damping of all springs and dampers along it, counted along the motion. On the group of a
  /// reduced model it is in ModelOn::readings.
  elements::Joint reading;
  std::string joint_name;  ///< of the joint whose coordinate it is; else empty
  int joint = -1;          ///< index of that in Plan::joints
  int row = -1;            ///< effort: the row of the joint whose multiplier, with the sign changed, is added; -1: none
  int row_in_block = -1;   ///< its place among the unknowns of the joint; -1: none of them
  std::vector<int> nodes;  ///< that it reads and that have unknowns, none twice
  laws::Law function;      ///< function
  laws::Surface surface;   ///< surface
  laws::Formula formula;   ///< formula, state
  std::vector<int> inputs;   ///< by place among the values of laws; those of an effort are added
  std::vector<int> signals;  ///< indices in Plan::signals of the inputs that are unknowns, itself not included
  double start = 0.0;        ///< state, input

  bool reads_motion() const { return rule <= SignalRule::effort; }
  bool is_state() const { return rule == SignalRule::state; }
  /// Whether its value depends on motions of nodes, and not on a multiplier and laws alone.
  bool reads_nodes() const {
    return reads_motion() && (reading.efforts[0].stiffness != 0.0 || reading.efforts[0].damping != 0.0);
  }
};

/// What is read of all that acts along a coordinate of a joint, on the second (scene::EffortParts).
struct EffortPlan {
  elements::Effort elastic;  ///< all springs and dampers that are read, counted along the motion
  std::vector<int> laws;     ///< of the efforts, by place among the values of laws
  int row = -1;              ///< of the joint, whose multiplier, with the sign changed, is added; -1: none
};

struct SensorPlan {
  scene::Sensor sensor;
  elements::Port port;                  ///< of point sensors
  int beam = -1;                        ///< index in Plan::beams
  int joint = -1;                       ///< index in Plan::joints (reaction, coordinate)
  int signal = -1;                      ///< its place among the values of laws
  std::string signal_unit;              ///< empty: a pure number, or not known
  std::vector<int> subdomain;           ///< the child to take at each level of the tree of the solver
  motion::RowKind coordinate = {};      ///< of the joint, if that is measured
  std::vector<int> elements;            ///< force: global ids of those whose forces on their last ports are added
  EffortPlan effort;                    ///< along that
  elements::Port frame;                 ///< port of the frame of the observer, or in whose axes the result is resolved
  std::vector<elements::Port> chain;    ///< parts on whose motions values depend, besides the sensor's point: of an
                                        ///< acceleration_split its frames, otherwise `frame`, if it is given
  std::vector<std::string> components;  ///< "" for a scalar
};

/// Initial position of a node of a reduced model, on its group and in space.
template <class G>
struct NodeStartOn {
  motion::Mat3<double> basis;           ///< Plan::axes in the axes of the node
  motion::Quaternion<double> rotation;  ///< in space
  motion::PositionPair<double> place;   ///< position in space [m]
  /// Rotation on the group: in a plane the direction of the first axis of `basis`, (cos, sin).
  [[no_unique_address]] typename G::template Rotation<double> turn;
  motion::PositionPair<double, G::translations> x;  ///< coordinates along Plan::axes from Plan::origin [m]
};

/// A reduced model: the scene on a group that has fewer motions than SE(3).
template <class G>
struct ModelOn {
  ArraysOn<G> elements;                        ///< at the indices of Plan::elements
  std::vector<elements::JointOn<G>> readings;  ///< by signal
  std::vector<NodeStartOn<G>> nodes;           ///< in the order of Plan::nodes
};
/// In space, the model is the plan itself.
template <>
struct ModelOn<motion::Se3> {};

/// An effort of a joint that is a law f(q) of the coordinate q along which it acts, as a spring with a table is: a
/// signal of kind "function" of a signal that reads q. It has the energy
///   U(q) = -int_rest^q f(s) ds     [J], rest and f being those of the effort.
struct EnergyStore {
  int joint = -1;      ///< index in Plan::joints
  int effort = -1;     ///< index in the efforts of the joint's element
  laws::Law supplied;  ///< -U, over q; a formula's values are quadratures to round-off
};

/// What rows that depend on each other within a precision may disagree by, and given velocities by what they allow: a
/// loop has some ten joints, each off by the precision.
constexpr double disagreement_within(double precision) { return 16.0 * precision; }

struct Plan {
  std::string scene_name;
  bool is_dynamic = true;
  motion::Vec3<double> gravity;  ///< times laws[gravity_law]
  int gravity_law = 0;
  std::vector<NodePlan> nodes;
  std::vector<GivenVelocity> given_velocities;  ///< in the scene's order
  ElementArrays elements;
  std::vector<ElementPlace> directory;     ///< by global element id
  std::vector<std::string> element_owner;  ///< name of the part of the scene that each element belongs to
  std::vector<JointPlan> joints;
  std::vector<int> joint_of_element;  ///< index in joints, by global element id; -1: the element is no joint
  /// Indices in joints of those whose turns are counted: a row, an effort, a signal or a sensor reads their angle.
  std::vector<int> turning_joints;
  int num_multipliers = 0;
  std::vector<BeamPlan> beams;
  std::vector<LawPlan> laws;
  std::vector<FramePlan> frames;
  int observer = -1;  ///< index in frames of the frame in which nodes, ground and results are described; -1: the
                      ///< inertial frame
  std::vector<TurnedLawPlan> turned_laws;
  std::vector<SignalPlan> signals;
  int num_driving_signals = 0;                       ///< the first ones, which are unknowns of the system
  std::vector<int> signal_of_law;                    ///< by law: index in signals; -1: none. Empty where signals is
  bool signals_drive = false;                        ///< a signal is a law of a row of a joint
  bool signals_read_multipliers = false;             ///< a signal reads the force of a drive or of a row
  std::vector<std::vector<int>> signals_of_element;  ///< by global element id: those it reads. Empty where signals is
  std::vector<EnergyStore> energy_stores;
  /// Some motion of beams may have no inertia: sections without rotary inertia. Their rotations are those of statics at
  /// every instant.
  bool has_massless_rotations = false;
  std::vector<SensorPlan> sensors;
  std::vector<BodyPlan> bodies;  ///< in the scene's order
  std::vector<WeldPlan> welds;   ///< empty unless the decision "welded" was taken
  NodeUnknowns unknowns;
  /// The scene on the group on which its nodes move.
  motion::Groups::OneOf<ModelOn> model;
  /// Of a reduced model: axes of the ground along which its nodes move, as columns (of a plane two along it and its
  /// normal, of a line first the one along it), and the origin of coordinates.
  motion::Mat3<double> axes = motion::Mat3<double>::identity();
  motion::Vec3<double> origin = motion::Vec3<double>::zero();
  std::vector<Decision> decisions;
  bool took(const std::string& decision) const;
  std::string not_conservative;  ///< why the loads have no potential, in words; empty: they have one
  std::vector<HeldNode> held;    ///< empty unless the decision "held" was taken
  /// Blocks: nodes with unknowns, signals, then one per joint that has rows which are unknowns. Elements: those of the
  /// directory, whose unknowns are followed by the signals that they read, then one for the equation of each signal.
  blocks::BlockGraph graph;
  std::vector<int> block_of_node;  ///< -1: held
  double length_scale = 1.0;       ///< [m], size of the structure
  /// Relative precision in which places and directions of the scene are written, if its unknowns were chosen within it,
  /// or rows of joints may depend on each other within it; 0: the scene is taken as it stands.
  double precision = 0.0;
  double disagreement() const { return disagreement_within(precision); }
  Mobility mobility;
  std::vector<std::string> notes;  ///< choices that the plan made where the scene leaves them open, in words

  template <class G>
  bool is_on() const {
    return std::holds_alternative<ModelOn<G>>(model);
  }
  /// Calls f<G>() with the group of the scene.
  template <class F>
  decltype(auto) with_group(F&& f) const {
    return std::visit([&]<class G>(const ModelOn<G>&) -> decltype(auto) { return f.template operator()<G>(); }, model);
  }
  /// The joint whose rows an element evaluates; null: the element is no joint.
  const JointPlan* joint_of(std::size_t element) const {
    const int j = joint_of_element[element];
    return j < 0 ? nullptr : &joints[static_cast<std::size_t>(j)];
  }
};

/// The signals that are unknowns of the system.
inline std::span<const SignalPlan> driving_signals(const Plan& plan) {
  return std::span(plan.signals).first(static_cast<std::size_t>(plan.num_driving_signals));
}
/// The signals that an element reads, as indices in Plan::signals.
inline std::span<const int> signals_of(const Plan& plan, std::size_t element) {
  if (plan.signals.empty()) return {};
  return plan.signals_of_element[element];
}

/// The coordinate that a signal reads, on the group G.
template <class G>
const elements::JointOn<G>& reading_on(const Plan& plan, std::size_t signal) {
  if constexpr (std::is_same_v<G, motion::Se3>)
    return plan.signals[signal].reading;
  else
    return std::get<ModelOn<G>>(plan.model).readings[signal];
}

/// The elements on the group G. Those in space always exist.
template <class G>
const ArraysOn<G>& arrays_on(const Plan& plan) {
  if constexpr (std::is_same_v<G, motion::Se3>)
    return plan.elements;
  else
    return std::get<ModelOn<G>>(plan.model).elements;
}
/// Components of a direction v, in the axes of the ground, along which the nodes of a reduced model move.
template <class G, class S>
typename G::template Translation<S> along_axes(const Plan& plan, const motion::Vec3<S>& v) {
  const motion::Vec3<S> along = lanes::transpose_times(lanes::cast<S>(plan.axes), v);
  typename G::template Translation<S> u;
  for (int i = 0; i < G::translations; ++i) u[i] = along[i];
  return u;
}

/// Elements, nodes and graph of a scene. Precondition: problems_in(scene) is empty.
Plan make_plan(const scene::Scene& scene);

}  // namespace bough::plan
