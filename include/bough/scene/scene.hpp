#pragma once
/// A scene is the user's description of a model: plain data in SI units and radians. Parts have names and refer to each
/// other by name (an empty name means absent). Nothing is derived here; `plan` turns a scene into elements.
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "bough/laws/formula.hpp"
#include "bough/laws/law.hpp"
#include "bough/laws/surface.hpp"
#include "bough/motion/se3.hpp"
#include "bough/scene/coupling_kind.hpp"
#include "bough/scene/moving_frame.hpp"
#include "bough/scene/shape_kinds.hpp"

namespace bough::scene {

using Vec3 = motion::Vec3<double>;
using Vec6 = motion::Vec6<double>;
using Mat3 = motion::Mat3<double>;
using Mat6 = motion::Mat6<double>;
using Frame = motion::Frame<double>;

/// Pose in a named frame (empty: the ground). In a moving frame it is the pose at the start.
struct Placement {
  Frame pose = Frame::identity();
  std::string frame;
};

/// A frame placed in another one, fixed there or moving by laws of time. In either case the placement is the pose at
/// time 0.
struct FrameDef {
  std::string name;
  Placement placement;
  std::optional<MovingFrame> motion = {};
};

struct Material {
  std::string name;
  double young = 0.0;    ///< E [Pa]
  double shear = 0.0;    ///< G [Pa] (the reader derives it from Poisson's ratio where that is given)
  double density = 0.0;  ///< [kg/m^3]
};

/// Beam section about the reference axis, axes (1 along the beam, 2, 3), order (N, Q2, Q3, T, M2, M3).
struct Section {
  std::string name;
  Mat6 stiffness;                          ///< [N, N m, N m^2], symmetric positive definite
  Mat6 mass;                               ///< per length [kg/m, kg, kg m], symmetric positive semi-definite
  Mat6 damping;                            ///< of strain rates [N s, N m s, N m^2 s]; zero when absent
  std::optional<SectionShape> shape = {};  ///< for pictures only: stiffness and mass are those given above
};

struct Node {
  std::string name;
  Placement placement;
};

/// Rigid body or point mass. Its frame is a node of its own name.
struct Body {
  std::string name;
  Placement placement;                  ///< of the body's reference frame
  double mass = 0.0;                    ///< [kg]
  Mat3 inertia = Mat3::zero();          ///< about the centre of mass, in the body's axes [kg m^2]
  Vec3 center_of_mass = Vec3::zero();   ///< in the body's frame [m]
  bool is_point_mass = false;           ///< its rotation has no inertia, and is held unless another part holds it
  std::optional<BodyShape> shape = {};  ///< shape about the centre of mass, for pictures only: the inertia is the one
                                        ///< given above
  std::shared_ptr<const Mesh> looks = {};  ///< drawn instead of the shape; not used in the computation
};

/// A frame fixed to a node, a body, a frame or the ground: the pose `offset` in the frame of `to`. An empty `to` is the
/// ground, named "ground" in files. The ground is the frame in which the scene is described: the inertial frame, or
/// Analysis::frame.
struct Attachment {
  std::string to;
  Frame offset = Frame::identity();
};

enum class BeamCurve : std::uint8_t {
  straight,   ///< from the start to the end
  curvature,  ///< constant body curvature over a given length: circles and helices, exactly
};

/// A beam from one attachment to another. Its inner nodes are made by the plan and named `<beam>.<k>` (k = 0 at the
/// start).
struct Beam {
  std::string name;
  std::string section;
  std::string start, end;            ///< nodes or bodies
  std::optional<Vec3> start_offset;  ///< position of the beam's ends in the frames of `start` and `end` [m]
  std::optional<Vec3> end_offset;
  BeamCurve curve = BeamCurve::straight;
  Vec3 axis_2 = Vec3::
      zero();  ///< vector, of the ground or of `frame`, to which section axis 2 at the start is as close as possible;
               ///< zero: chosen
  std::string frame;              ///< frame in which axis_2 and curvature start are given
  double twist = 0.0;             ///< rotation of the section about axis 1 from start to end [rad] (straight)
  Vec3 curvature = Vec3::zero();  ///< body components (k1, k2, k3) [1/m] (curvature)
  double length = 0.0;            ///< [m] (curvature)
  Vec3 tangent = Vec3::zero();    ///< axis 1 at the start (curvature)
  int elements = 1;
  int order = 1;  ///< polynomial order of the element: 1 (two nodes), 2, 3
};

enum class JointKind : std::uint8_t {
  fixed,
  revolute,
  spherical,
  prismatic,
  cylindrical,
  universal,
  planar,
  screw,
  constant_velocity,
  distance,
  strut,
};

/// Spring, damper and effort along a joint's free coordinate `coordinate` ("angle" or "displacement").
struct JointForce {
  std::string coordinate;
  double stiffness = 0.0;  ///< [N m/rad] or [N/m]
  double rest = 0.0;       ///< [rad] or [m]
  double damping = 0.0;
  laws::Law effort;       ///< torque [N m] or force [N] on the second body along the axis
  std::string signal;     ///< the signal that gives the effort in place of the law; empty: none
  std::string name = {};  ///< by which signals and sensors read it alone; may be empty
};

/// Prescribes a coordinate of a joint as a function of time.
struct JointDrive {
  std::string coordinate;
  bool is_rate = false;  ///< the law gives the rate; it is integrated exactly from the initial value
  laws::Law law;
  std::string signal;  ///< the signal that is the coordinate in place of the law; empty: none
};

/// joint_kinds.hpp says which axes of the joint frames each kind uses, and what it leaves free.
struct Joint {
  std::string name;
  JointKind kind = JointKind::fixed;
  Attachment first, second;  ///< a reaction is the wrench of the first body on the second, at the second's joint frame
  double pitch = 0.0;        ///< screw: displacement per turn [m]
  std::vector<JointForce> forces;
  std::vector<JointDrive> drives;
};

/// A factor over time (statics: over the load factor), or the signal that gives it [-].
struct Factor {
  laws::Law law;
  std::string signal;  ///< in place of the law; empty: none

  bool is_given() const { return law.node() != nullptr || !signal.empty(); }
};

/// A coupling of the catalogue of elements (elements/coupling.hpp), read by couplings.hpp.
struct Coupling {
  const CouplingKind* kind = nullptr;
  std::string name;
  Attachment first, second;
  std::vector<double> values;   ///< of the kind's fields, one after the other; matrices row by row
  std::vector<Factor> factors;  ///< of its fields that are laws
};

enum class LoadAxes : std::uint8_t { space, body };  ///< space: dead load, fixed in space; body: follower load, which
                                                     ///< turns with the part

struct PointLoad {
  std::string name;
  Attachment at;
  LoadAxes axes = LoadAxes::space;
  std::string frame;  ///< with axes space: components in this frame's axes, turning with it; empty: the ground's
  Vec3 force = Vec3::zero();   ///< [N], times the law
  Vec3 moment = Vec3::zero();  ///< [N m], times the law
  laws::Law law;               ///< factor over time (statics: over the load factor)
  std::string signal;          ///< the signal that is the factor in place of the law; empty: none
};

struct LineLoad {
  std::string name;
  std::string beam;
  LoadAxes axes = LoadAxes::space;
  std::string frame;           ///< as of a point load
  Vec3 force = Vec3::zero();   ///< per reference length [N/m]
  Vec3 moment = Vec3::zero();  ///< [N]
  laws::Law law;
  std::string signal;  ///< as of a point load
};

/// Prescribed motion of a node or body along and about the ground's axes from its initial pose: a joint to the ground
/// for the components chosen.
struct PrescribedMotion {
  std::string name;
  Attachment at;
  /// x y z [m] translations along the ground's axes; rotations only as one axis with an angle that counts turns.
  std::optional<laws::Law> displacement[3];
  std::string displacement_signal[3];  ///< signals in place of these laws, which are given then; empty: none
  std::optional<Vec3> rotation_axis;   ///< given: orientation is exp(angle(t) axis) times the initial one
  laws::Law angle;
  std::string angle_signal;
  bool hold_rotation = false;  ///< orientation held at its initial value
  bool is_rate = false;
};

struct InitialVelocity {
  std::string of;  ///< node, body, or beam (then all its nodes, as a rigid motion about its start)
  LoadAxes axes = LoadAxes::space;
  std::string frame;  ///< velocities are relative to this frame, whose own velocity is added; with axes space,
                      ///< components are in its axes
  Vec3 velocity = Vec3::zero();  ///< of the frame's origin [m/s]
  Vec3 angular_velocity = Vec3::zero();
  /// False: it was not given. A point mass, or a node without beams, then turns with what holds it, since no inertia of
  /// its own asks for another rotation; for all else it is zero.
  bool has_angular_velocity = true;
};

enum class SignalKind : std::uint8_t {
  joint_angle,
  joint_displacement,
  joint_rate,
  joint_effort,    ///< along a coordinate, of all that acts there or of one part of that (joint_efforts.hpp) [N], [N m]
  spring_tension,  ///< [N]
  position,        ///< of a point, along an axis of the ground or of a frame [m]
  velocity,        ///< the rate of that [m/s]
  time,            ///< a law of time
  function,        ///< a law, of another signal in the place of time
  surface,         ///< a table of two signals
  formula,         ///< of other signals
  state,           ///< x' = formula of signals, itself included
  input,           ///< a number that a program sets between steps
  force,           ///< component of the force of a prescribed motion or a load on its part [N], [N m]
};

/// A number that changes with the motion, for drives, efforts and loads. All signals at one instant belong to the same
/// motion: none lags behind.
struct Signal {
  std::string name;  ///< a word of formulas
  SignalKind kind = SignalKind::formula;
  std::string joint;
  std::string coordinate;           ///< joint_rate, joint_effort: "angle" or "displacement"; empty: the only one
  std::string spring;               ///< spring_tension
  std::string part;                 ///< force: a prescribed motion or a load; the component is the `coordinate`
  Attachment at;                    ///< position, velocity
  int axis = 0;                     ///< position, velocity: 0, 1 or 2
  std::string frame;                ///< position, velocity: what sees the point, in whose axes; empty: the ground
  laws::Law law;                    ///< time, function
  std::string of;                   ///< function: the signal in the place of time; joint_effort: its part; empty: all
  laws::Surface surface;            ///< surface: of the two `inputs`
  laws::Formula formula;            ///< formula, state: in the values of `inputs`
  std::vector<std::string> inputs;  ///< names of signals
  double start = 0.0;               ///< state: at the start of dynamics; input: until it is set
  std::string unit;                 ///< of its value, for results; "-": a pure number; empty: it is derived
};

enum class SensorKind : std::uint8_t {
  position,
  rotation,
  quaternion,
  velocity,
  acceleration,
  section_force,
  section_strain,
  joint_reaction,
  joint_angle,
  joint_displacement,
  joint_rate,
  kinetic_energy,
  strain_energy,
  potential_energy,
  total_energy,
  acceleration_split,
  relative_position,
  signal,
  interface_force,
  force,
  joint_effort,
  section_force_extremes,
};

struct Sensor {
  std::string name;
  SensorKind kind = SensorKind::position;
  Attachment at;          ///< node or body with offset (position, rotation, velocity, acceleration)
  std::string beam;       ///< section sensors, or a point on a beam's axis
  double station = 0.0;   ///< fraction of the beam's length, 0 to 1
  std::string component;  ///< section_force_extremes: which section resultant
  std::string joint;
  std::string coordinate;  ///< joint_rate, joint_effort: "angle" or "displacement"; empty: the only one the joint has
  std::string of;          ///< joint_effort: the part read (joint_efforts.hpp); empty: all
  LoadAxes axes = LoadAxes::space;  ///< resolved in the ground's axes, or those of `frame`, or in the body's own
  /// The frame of the observer of a point's motion, in whose axes it and reactions are resolved; empty: the ground. For
  /// an acceleration_split only the axes.
  std::string frame;
  std::string signal;              ///< signal: its name
  std::string part;                ///< force: a prescribed motion, coupling, load or joint
  std::string subdomain;           ///< interface_force: the child to take at each level of the tree, as "0.1"
  std::vector<std::string> chain;  ///< acceleration_split: frames, nodes or bodies, each moving in the previous one
};

enum class AnalysisKind : std::uint8_t {
  statics,
  dynamics,
  inverse_dynamics,
  modes,
  response,
  linear_model,
  buckling,
  campbell,
};
enum class Newton : std::uint8_t { full, single };
enum class Integrator : std::uint8_t { generalized_alpha, variational, bdf };

/// Step sizes chosen so that local errors stay within a tolerance (generalized-alpha).
struct StepControl {
  /// Tolerance of the sum of local errors over the run, relative to reference magnitudes: the size of the structure, 1
  /// rad, and the largest speeds so far [-].
  double tolerance = 1e-4;
  double position_tolerance = 0.0;          ///< absolute tolerance that is added to the relative one [m]
  double rotation_tolerance = 0.0;          ///< [rad]
  double velocity_tolerance = 0.0;          ///< [m/s]
  double angular_velocity_tolerance = 0.0;  ///< [rad/s]
  double largest_step = 0.0;                ///< [s]; 0: a fiftieth of the end time
};

/// Statics along the path of equilibria, past limit points of the load.
struct ArcLength {
  /// Size of the first step [-]: root mean square over the nodes of displacements, divided by the size of the
  /// structure, and of rotations [rad]. 0: chosen from the curvature of the path at its start.
  double step = 0.0;
  double largest_step = 0.0;  ///< [-]; 0: four times the first step if that is given, otherwise 0.2
  int max_steps = 1000;
  /// The run ends where the load factor passes this value, after the number of limit points given below.
  double end_load_factor = 1.0;
  int after_limit_points = 0;
  int end_at_limit_point = 0;  ///< the run ends at the limit point of this number instead; 0: it does not end at limit
                               ///< points
};

/// Errors of the results that a run measures. Further runs beside it, its twins, have other steps or other meshes, and
/// what they differ by tells how far the run is from the limit of small steps and fine meshes.
struct ErrorsWanted {
  bool time = false;  ///< of the step size; in statics of the load steps
  bool mesh = false;  ///< of the numbers of elements of all beams
  bool any() const { return time || mesh; }
};

/// Errors that results may have, given instead of a step size and of numbers of elements: the run finds those that
/// reach them.
struct Accuracy {
  double relative = 0.0;        ///< of the range of a sensor, or of the magnitude of a measure [-]
  double absolute = 0.0;        ///< in the unit of what it is of; allowed beside the relative one
  std::vector<std::string> of;  ///< names of sensors, of their columns and of measures; empty: all sensors
  bool mesh = true;             ///< errors by the numbers of elements count, too
};

/// Where dynamics begins: in the poses that the scene gives, or in the equilibrium under the loads of t = 0.
enum class StartKind : std::uint8_t { given, equilibrium };

/// What is asked of modes of vibration; about a state or an equilibrium is Analysis::start.
struct ModesAsked {
  int count = 10;        ///< vibrations
  double shift = 0.0;    ///< frequency near which they are looked for [Hz]; 0: the slowest
  bool damping = false;  ///< dampers count
};

/// An input of the linearised equations: a number u that is added to the factor of a load, to a prescribed coordinate,
/// to an effort along a joint's coordinate, or to an input signal (linear_inputs.hpp).
struct LinearInput {
  std::string of;         ///< a point or line load, a prescribed motion, a joint, or a signal of kind input
  std::string component;  ///< of a prescribed motion "x", "y", "z" or "angle", of a joint its coordinate; empty: the
                          ///< only one
  /// One-sided power spectral density, [Hz, square of the unit of u / Hz], frequencies ascending; empty: none is asked.
  std::vector<std::pair<double, double>> spectrum;
};

/// What is asked of the linearised equations between inputs and sensors. About which state is Analysis::start.
struct LinearAsked {
  std::vector<LinearInput> inputs;
  std::vector<std::string> outputs;  ///< names of sensors; empty: all
  std::vector<double> frequencies;   ///< of the response [Hz], ascending
};

/// What is asked of buckling: load factors at which the tangent of the loaded structure becomes singular.
struct BucklingAsked {
  int count = 1;                 ///< critical load factors
  double largest_factor = 1000;  ///< beyond which none is looked for
};

struct Scene;

/// What is asked of modes over a parameter. How many modes, next to which frequency and whether dampers count is
/// Analysis::modes.
struct CampbellAsked {
  std::string parameter;       ///< JSON pointer
  std::vector<double> values;  ///< that it takes, ascending
  /// rad/s of a unit of the parameter where it is a speed; 0: it is none.
  double speed = 0.0;
  std::vector<double> orders;                        ///< multiples of the speed that excite
  std::vector<std::shared_ptr<const Scene>> scenes;  ///< the scene with each of these values
};

struct Analysis {
  AnalysisKind kind = AnalysisKind::dynamics;
  /// The frame in which the scene is described, which is the "ground" of all parts that name no frame. Empty: the
  /// inertial frame. Gravity is always given in the inertial frame. In statics the frame has to move steadily: its laws
  /// are evaluated at time 0, and its inertial loads grow with the load factor.
  std::string frame;
  // statics
  int load_steps = 1;
  std::optional<ArcLength> arc_length;  ///< instead of load steps
  bool unstable = false;                ///< unstable equilibria are expected: the run casts no doubt on them
  // dynamics
  StartKind start = StartKind::given;  ///< also of what modes and linearised equations are about
  double end_time = 0.0;               ///< [s]
  double step_size = 1e-3;             ///< h [s]; of the first step where sizes are controlled
  std::optional<StepControl> step_control;
  Integrator integrator = Integrator::generalized_alpha;
  double spectral_radius = 0.8;  ///< of generalized-alpha
  int bdf_order = 0;             ///< of backward differences: 2 or 3; 0: 3, but 2 where undamped vibrations would grow
  double newmark_beta = 0.3;     ///< of the variational integrator, for vibrations
  ModesAsked modes;
  LinearAsked linear;
  BucklingAsked buckling;
  CampbellAsked campbell;
  // both
  Newton newton = Newton::full;
  double tolerance = 1e-8;  ///< of relative motions and of residuals relative to their contributions [-]
  int max_iterations = 20;
  int max_cuts = 10;  ///< halvings of a step before the run fails
  ErrorsWanted errors;
  std::optional<Accuracy> accuracy;  ///< step_size and numbers of elements are then those of a first trial
};

/// How the linear system is solved along the tree of sub-domains, or as a whole.
enum class SolverForm : std::uint8_t {
  local,      ///< sub-domains are condensed to their interfaces, boundary last, without a penalty
  augmented,  ///< the same through the flexibility of each interface, to which a penalty is added
  global,     ///< sub-domains torn apart and tied to each other by multipliers
  hybrid,     ///< the same, with some nodes kept on an interface mesh
  monolithic  ///< one factorization by a library
};
enum class SolverLibrary : std::uint8_t { klu, sparse_lu, umfpack, cholmod };

struct Solver {
  SolverForm form = SolverForm::local;
  SolverLibrary library = SolverLibrary::klu;  ///< of form monolithic
  bool iterate_interface = false;              ///< of forms global and hybrid
  int leaf_size = 0;                           ///< elements; 0 = chosen
  int depth = -1;                              ///< -1 = chosen
  double penalty_factor = 1.0;                 ///< of form augmented, times the interface's own stiffness
  bool tasks = true;
  int threads = 1;  ///< threads for this scene where several scenes share the machine; results do not depend on it
};

struct Output {
  int stride = 1;         ///< history rows: every n-th accepted step
  bool motion = false;    ///< write motion.pvd and VTU
  int motion_stride = 0;  ///< pictures: every n-th step; 0: at most 101, evenly over the run
  bool checks = true;     ///< balances and constraint violations, at the times of history rows
  /// Between two checkpoints of a run: wall clock [s], 0: none at all; and time of the run [s], or load factor, 0: not
  /// by that.
  double checkpoint = 300.0, checkpoint_time = 0.0;
  std::vector<std::string> formats;  ///< of files for other programs, besides those of every run
};

/// How a figure is derived from a quantity: its value at the end or at a given time, the extremes over the run and the
/// times at which they are first reached, the range between the extremes, or the mean time between upward crossings of
/// a level.
enum class FigureKind : std::uint8_t { value, max, min, time_of_max, time_of_min, range, period };

struct Expected {
  std::string quantity;  ///< "<sensor>.<component>" or "<sensor>"
  FigureKind figure = FigureKind::value;
  std::optional<double> time;   ///< of `value`; none: at the end
  std::optional<double> level;  ///< of `period`; none: 0
  double value = 0.0;
  double tolerance = 0.0;           ///< absolute, >= 0
  double relative_tolerance = 0.0;  ///< of |value|, >= 0; one of the two is above 0
  std::string source;

  /// Largest difference from the value.
  double allowed() const { return tolerance + relative_tolerance * std::abs(value); }
};

/// How a measure is derived from a quantity over a run: the figures of FigureKind, and further ones that need the whole
/// history.
enum class MeasureKind : std::uint8_t {
  value,
  max,
  min,
  time_of_max,
  time_of_min,
  range,
  period,
  mean,                ///< over time
  rms,                 ///< root mean square over time
  percentile,          ///< the value that the quantity does not exceed for `percent` of the time
  settling_time,       ///< time after which the quantity differs from `target` by no more than `band`
  dominant_frequency,  ///< [1/s]
  cycles,              ///< number of rainflow cycles of a range of at least `range`
  equivalent_range  ///< range of `cycles` equal cycles that do the same damage, with exponent m: the damage-equivalent
                    ///< load
};

/// A figure of a run: a column of batches and sweeps.
struct Measure {
  std::string name;
  std::string quantity;    ///< "<sensor>.<component>" or "<sensor>"; empty: the expression
  std::string expression;  ///< of `names`
  std::vector<std::pair<std::string, std::string>> names;  ///< in the expression, each with its quantity
  bool is_of_measures = false;  ///< these quantities are earlier measures, and the value is that of the expression
  MeasureKind kind = MeasureKind::value;
  std::optional<double> from, to;  ///< part of the run that counts; none: its start, its end
  std::optional<double> time;      ///< of `value`; none: at the end
  std::optional<double> level;     ///< of `period`; none: 0
  double percent = 50.0;           ///< of `percentile`
  double band = 0.0;               ///< of `settling_time`
  std::optional<double> target;    ///< of `settling_time`; none: the value at the end
  double range = 0.0;              ///< of `cycles`
  double exponent = 10.0;          ///< of `equivalent_range`: m, of the S-N line
  std::optional<double> cycles;    ///< of `equivalent_range`; none: one a second
  /// Expected value of the measure. Only value, tolerances and source are used; the rest is given by the measure.
  std::optional<Expected> expected;
};

struct Scene {
  std::string name;  ///< file name without ending
  std::string title;
  Vec3 gravity = Vec3::zero();  ///< [m/s^2], inertial
  laws::Law gravity_law;        ///< factor over time
  std::vector<FrameDef> frames;
  std::vector<Material> materials;
  std::vector<Section> sections;
  std::vector<Node> nodes;
  std::vector<Body> bodies;
  std::vector<Beam> beams;
  std::vector<Joint> joints;
  std::vector<Coupling> couplings;
  std::vector<PointLoad> point_loads;
  std::vector<LineLoad> line_loads;
  std::vector<PrescribedMotion> motions;
  std::vector<InitialVelocity> initial_velocities;
  std::vector<Signal> signals;
  std::vector<Sensor> sensors;
  Analysis analysis;
  Solver solver;
  Output output;
  std::vector<std::string> without;  ///< decisions of the plan that must not be taken ("planar", ...)
  std::vector<Expected> expected;
  std::vector<Measure> measures;
};

}  // namespace bough::scene
