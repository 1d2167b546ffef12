#pragma once
/// Results of a run as it passes them to a recorder: plain data, independent of file formats.
#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bough/records/archive.hpp"
#include "bough/records/table.hpp"
#include "bough/scene/outlines.hpp"

namespace bough::records {

/// One row of the history: the values follow the columns of `HistoryHeader`.
struct HistoryHeader {
  std::vector<std::string> columns;  ///< "<sensor>.<component>" or "<sensor>"
  /// What a column shows, in the order of `columns`; empty if not known.
  struct About {
    std::string unit;      ///< "m", "rad/s", ...; empty: a pure number, or, of a signal, not known
    std::string quantity;  ///< the kind of its sensor
    std::string part;      ///< node, body, beam or joint that is measured; empty: the whole structure
  };
  std::vector<About> about = {};
  bool runs_over_load = false;  ///< the independent variable is the load factor instead of time
};
struct HistoryRow {
  double time = 0.0;  ///< [s], or the load factor
  double step_size = 0.0;
  int iterations = 0;
  std::vector<double> values;
  void checkpoint(Archive& archive) { archive(time, step_size, iterations, values); }
};

/// The moving structure at one time, for pictures and VTU.
struct CurvePoint {
  double position[3];
  double axes[9];           ///< rotation matrix, row-major: columns are the section's axes
  double force[6];          ///< section resultants (N, Q2, Q3, T, M2, M3)
  double strain[6] = {};    ///< (e1, g2, g3, k1, k2, k3)
  double velocity[3] = {};  ///< of the axis [m/s]
};
struct Curve {
  std::string name;
  std::vector<CurvePoint> points;
  void checkpoint(Archive& archive) { archive(name, points); }
};
struct BodyPose {
  std::string name;
  double position[3];  ///< of the body's reference point
  double axes[9];
  double center[3];  ///< centre of mass
  std::vector<std::array<double, 3>> attachments =
      {};                   ///< attachment points of joints, springs and beams, drawn as spokes from the centre
  double velocity[3] = {};  ///< of the centre of mass [m/s]
  void checkpoint(Archive& archive) { archive(name, position, axes, center, attachments, velocity); }
};
struct Link {
  std::string name;  ///< joint or spring, drawn as a segment (a joint may have length 0)
  double first[3];
  double second[3];
  double axes[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};  ///< joint frame on the first side; unused for springs
  double first_velocity[3] = {};                 ///< of both sides [m/s]
  double second_velocity[3] = {};
  void checkpoint(Archive& archive) { archive(name, first, second, axes, first_velocity, second_velocity); }
};
struct FramePose {
  std::string name;
  double position[3];
  double axes[9];
  double velocity[3] = {};  ///< of the origin [m/s]
  void checkpoint(Archive& archive) { archive(name, position, axes, velocity); }
};
/// A point load, or one point of a line load: its present value in the axes of the ground.
struct Arrow {
  std::string name;
  double position[3];
  double force[3];             ///< [N], of a line load [N/m]
  double moment[3];            ///< [N m], of a line load [N]
  bool is_per_length = false;  ///< of a line load, per reference length
  double velocity[3] = {};     ///< of the point on which it acts [m/s]
  void checkpoint(Archive& archive) { archive(name, position, force, moment, is_per_length, velocity); }
};
/// Value of a signal that changes with the motion, in its own unit.
struct SignalValue {
  std::string name;
  double value = 0.0;
  void checkpoint(Archive& archive) { archive(name, value); }
};
/// The motion between two frames follows from places and velocities, as cubics. After a turn by phi these are off by
/// phi^4/384 of the radius, here 1e-3 [rad].
inline constexpr double largest_turn = 0.75;
struct MotionFrame {
  double time = 0.0;
  /// How far a part has been turned since the frame before, at most, at any time in between [rad].
  double turn = 0.0;
  std::vector<Curve> curves;
  std::vector<BodyPose> bodies;
  std::vector<Link> links;
  std::vector<FramePose> frames = {};
  std::vector<Arrow> arrows = {};
  std::vector<SignalValue> signals = {};
  bool for_others = true;  ///< frame is also written to files for other programs, which are larger
  void checkpoint(Archive& archive) { archive(time, turn, curves, bodies, links, frames, arrows, signals, for_others); }
};
/// Properties of the parts in all frames of a motion, in the order of the frames' lists; given once.
struct MotionParts {
  struct Curve {
    int outline = -1;             ///< of its section, in `outlines`; -1: the section has no shape
    std::vector<int> subdomains;  ///< leaf of the tree that holds each element, in order along the axis
  };
  struct Link {
    std::string kind;  ///< of the joint, "spring", "damper", "spring and damper", "bushing", "prescribed motion"
  };
  std::vector<scene::Outline> outlines;
  std::vector<scene::Mesh> meshes;
  std::vector<Curve> curves;
  std::vector<int> bodies;  ///< surface of each, in `meshes`; -1: it has no shape
  std::vector<Link> links;
  std::vector<std::string> signal_units = {};  ///< empty: a pure number, or not known
};

enum class RunStatus : std::uint8_t { ok, failed, interrupted };

struct StepCounts {
  long accepted = 0, rejected = 0, newton_iterations = 0, factorizations = 0;
  long rejected_for_error = 0;  ///< of those rejected, by step control
  long size_changes = 0;        ///< changes of the step size by step control
};
struct StepTimes {
  double prepare = 0.0;  ///< before the first step: plan, tree of sub-domains, symbolic factorization; wall [s]
  double total = 0.0;    ///< of the simulation after that; wall [s]
  double cpu = 0.0;      ///< the same in CPU seconds, summed over threads
  double assemble = 0.0, factor = 0.0, solve = 0.0, update = 0.0, output = 0.0;  ///< parts of cpu
};
/// Balances and violations of constraints: the largest values at the times of history rows. Not evaluated if the scene
/// switches checks off.
struct Checks {
  bool evaluated = true;
  double energy_balance = 0.0;         ///< largest |kinetic + strain + potential - work + dissipation - start| [J]
  double energy_scale = 0.0;           ///< largest sum of the parts' magnitudes [J]
  double energy_round_off = 0.0;       ///< energies below this are round-off or what the tolerance leaves open [J]
  double numerical_dissipation = 0.0;  ///< energy taken by the integrator up to the end [J]; 0 where it gave some
  double momentum_balance = 0.0;       ///< largest |momentum - impulse - start| [kg m/s]
  double momentum_scale = 0.0;         ///< largest momentum and impulse [kg m/s]
  /// The same about the inertial origin [kg m^2/s]; zero where the moment of gravity is not known.
  double angular_momentum_balance = 0.0, angular_momentum_scale = 0.0;
  double constraint_violation_position = 0.0;  ///< [m] or [rad]
  double constraint_violation_velocity = 0.0;  ///< [m/s] or [rad/s]
  double linear_backward_error_max = 0.0;
  double linear_rank_error_max = 0.0;  ///< error caused by treating constraint rows as dependent:
                                       ///< solve::SolveReport::rank_error
  /// Local errors of the time steps (at fixed step sizes: of some of them) [-]. For positions and rotations, relative
  /// to the size of the structure and 1 rad: the largest, and the sum over the run. For velocities, relative to the
  /// largest speeds so far: the largest.
  bool local_error_known = false;
  double local_error_max = 0.0, local_error_sum = 0.0, local_error_max_velocity = 0.0;
  bool round_off_floor_reached = false;
  long steps_at_floor = 0;           ///< steps accepted at the round-off floor of the residual, above the tolerance
  double unbalanced_at_floor = 0.0;  ///< largest residual force or moment of these steps, over the largest force or
                                     ///< moment of the run [-]
  double energy_gained =
      0.0;  ///< energy that the integrator had added by the end, as a part of energy_balance [J]; 0 where it removed
            ///< some
  /// Largest violation of positions relative to the length of the connected parts, of angles in radians [-], and its
  /// joint.
  double relative_violation_position = 0.0;
  std::string open_joint;
  /// Largest violation of velocities times the step size, i.e. the gap that opens within one step, relative to the
  /// length of the connected parts [-], and its joint.
  double relative_violation_step = 0.0;
  std::string fast_joint;
  void checkpoint(Archive& archive) {
    archive(evaluated, energy_balance, energy_scale, energy_round_off, numerical_dissipation, momentum_balance,
            momentum_scale, angular_momentum_balance, angular_momentum_scale, constraint_violation_position,
            constraint_violation_velocity, linear_backward_error_max, linear_rank_error_max, local_error_known,
            local_error_max, local_error_sum, local_error_max_velocity, round_off_floor_reached, steps_at_floor,
            unbalanced_at_floor, energy_gained, relative_violation_position, open_joint, relative_violation_step,
            fast_joint);
  }
};
/// Figures of one level of the tree of sub-domains, evaluated with the last factorization of a run.
struct LevelFigures {
  int level = 0;  ///< 0 at the root
  int subdomains = 0;
  int interface_unknowns = 0;   ///< of the largest interface to the level above; 0 at the root
  double condition = 0.0;       ///< of the worst interface, in scaled variables [-]; 0: not computed
  double backward_error = 0.0;  ///< of the unknowns eliminated there, normwise [-]
};
/// Estimate of the error that the time steps leave in a column of the history at the end of a run.
struct SensorError {
  std::string column;
  double of_steps = 0.0;   ///< due to the local errors of the steps, in the unit of the column
  double of_energy = 0.0;  ///< due to the energy that the integrator dissipates, which slows motions down
  double range = 0.0;      ///< range of the values of the sensor's columns that have this unit
  double relative() const { return (of_steps + of_energy) / range; }
};
/// An initial velocity given in the scene that is incompatible with joints, drives or other given velocities.
struct ChangedVelocity {
  std::string of;                    ///< node, body or beam
  bool is_angular = false;           ///< the angular velocity, else the velocity
  std::array<double, 3> asked, got;  ///< given in the scene, and consistent one at the start; axes of the ground [m/s]
                                     ///< or [rad/s]
  double change = 0.0;               ///< magnitude of the change, over the largest speed of the structure [-]
  void checkpoint(Archive& archive) { archive(of, is_angular, asked, got, change); }
};
/// The change of a joint's reaction that one more Newton correction would cause, at the time when this change is
/// largest.
struct UnsureReaction {
  std::string joint;
  double time = 0.0;
  double size = 0.0, error = 0.0;  ///< the reaction at that time, and the change [N]; moments are divided by the size
                                   ///< of an element
  double largest = 0.0;            ///< largest reaction of the run [N]
  void checkpoint(Archive& archive) { archive(joint, time, size, error, largest); }
};
/// A reason to examine a run before its results are used.
struct Doubt {
  std::string about;  ///< "run", "initial velocities", "energy", "error", "linear solutions", "condition", ...
  std::string text;
};
/// A limit point: the load factor has an extremum along the path of equilibria.
struct LimitPoint {
  double load_factor = 0.0;  ///< if not located: from a parabola through points on both sides
  bool is_maximum = true;
  bool is_located = true;
};
/// A bifurcation: another branch crosses the path of equilibria. The number of unstable directions changes although the
/// load factor has no extremum.
struct Bifurcation {
  double load_factor = 0.0;
  std::string mode;     ///< the part that moves most in the direction of the other branch, in words
  bool is_lost = true;  ///< stability is lost along the path; otherwise it is regained
  void checkpoint(Archive& archive) { archive(load_factor, mode, is_lost); }
};
/// Stability of static equilibria under loads that are held constant. Under loads without a potential, an even number
/// of unstable directions and flutter are not detected.
struct Stability {
  struct Between {
    double before = 0.0, after = 0.0;  ///< load factors of neighbouring equilibria
  };
  bool is_known = false;              ///< at the end
  bool is_declared = false;           ///< the scene states that equilibria may be unstable
  std::string not_conservative;       ///< why the loads have no potential; empty: they have one
  int unstable_directions = 0;        ///< at the end; for loads without a potential: 1 if their number is odd
  std::optional<Between> first_lost;  ///< between which equilibria the first unstable one was found
  std::string mode;          ///< the part that moves most in an unstable direction, in words: at the end, or where
                             ///< stability was lost
  std::string hidden;        ///< which motions the plan excluded, if the last equilibrium is unstable in one of them
  std::string hidden_mode;   ///< the part that moves most in that motion
  std::string largest_load;  ///< at the end, in words; empty: there is none
  void checkpoint(Archive& archive) {
    archive(is_known, is_declared, not_conservative, unstable_directions, first_lost, mode, hidden, hidden_mode,
            largest_load);
  }
};
struct ExpectedResult {
  std::string name;
  double value = 0.0, reference = 0.0, tolerance = 0.0;
  bool holds = false;
  std::string source;
  bool reached = true;     ///< false: the run ended before the time of the figure, so the figure cannot be judged
  bool has_value = true;   ///< false: the history does not define the figure (a period without crossings, say); the
                           ///< expectation then fails
  std::string taken = {};  ///< how the value was taken from the run, in words: at the end of a step, interpolated ...
  /// "holds", "fails" or "not reached".
  const char* verdict() const { return !reached ? "not reached" : holds ? "holds" : "fails"; }
};
/// Value of a measure of the scene. There is none if the run ended too early, if a quantity is not finite, or if the
/// history does not define it (a period without crossings).
struct MeasureResult {
  std::string name;
  std::optional<double> value;
};
/// The options as they were used, defaults included: JSON pointer (without the leading slash) and JSON text of each
/// value.
using EffectiveOptions = std::vector<std::pair<std::string, std::string>>;

struct MeasuredErrors;  // errors.hpp
struct LinearModel;     // linear_model.hpp

struct Summary {
  RunStatus status = RunStatus::failed;
  std::string cause;
  std::string scene, title;
  int threads = 1;
  EffectiveOptions options;
  StepCounts steps;
  StepTimes times;
  std::int64_t memory_peak_bytes = 0;
  Checks checks;
  std::vector<ChangedVelocity> changed_velocities;  ///< by how much they were changed, the largest first
  std::vector<UnsureReaction> unsure_reactions;     ///< of joints with sensors of their reactions
  bool follows_path = false;                        ///< statics by arc length
  std::vector<LimitPoint> limit_points;             ///< of these, in the order of the path
  std::vector<Bifurcation> bifurcations;            ///< of these, in the order of the path
  std::optional<Stability> stability;               ///< of statics
  std::vector<std::string>
      notes;  ///< warnings in words: dependent constraints, impulses at the start, floors reached ...
  HistoryHeader header;
  std::vector<double> final_values;  ///< by header
  std::vector<ExpectedResult> expected;
  std::vector<MeasureResult> measures;     ///< in the order of the scene
  std::vector<Table> tables;               ///< results that are no history, as modes
  std::vector<Doubt> doubts;               ///< why the run should not be trusted, in words; empty: nothing was found
  std::vector<SensorError> sensor_errors;  ///< of sensors of motions, where local errors are known
  std::string not_judged;                  ///< of which sensors no error in time was estimated and why, in words
  double step_size = 0.0;                  ///< longest of the run [s]
  std::string
      instability;  ///< why the integrator may make vibrations grow, and what to do; empty: nothing is known of such
  std::vector<LevelFigures> levels;  ///< of the hierarchical solver
  std::vector<std::pair<std::string, double>>
      solver;  ///< figures of the tree: sub-domains, levels, interface unknowns, condition, ...
  std::shared_ptr<const MeasuredErrors> errors;     ///< by twins of the run; null: none ran
  std::shared_ptr<const LinearModel> linear_model;  ///< null: none was asked for
  /// What changes while the run goes on; the rest follows from the scene, or is completed at the end.
  void checkpoint(Archive& archive) {
    archive(status, cause, options, steps, times, checks, changed_velocities, limit_points, bifurcations, notes,
            step_size, instability);
  }
};

struct StoredState;  // stored_state.hpp

/// Receives a run as it goes. A writer throws std::runtime_error where it cannot write; the run then fails with that
/// cause.
class Recorder {
 public:
  virtual ~Recorder() = default;
  virtual void begin(const HistoryHeader& header) = 0;
  virtual void row(const HistoryRow& row) = 0;
  virtual void motion(const MotionFrame& frame) = 0;
  /// Before the first frame of a motion.
  virtual void parts(const MotionParts& /*parts*/) {}
  virtual void end(const Summary& summary) = 0;

  /// Whether states are to be handed out from which other scenes can start: at pictures for other programs, and at the
  /// end.
  virtual bool keeps_states() const { return false; }
  virtual void state(const StoredState& /*state*/) {}

  /// Whether checkpoints may be asked for: a run then keeps what it needs to make its factorization again.
  virtual bool keeps_checkpoints() const { return false; }
  /// Whether one is due after a step that was accepted at this time [s], or load factor; is_last: the run is to stop.
  virtual bool is_checkpoint_due(double /*time*/, bool /*is_last*/) { return false; }
  /// Keeps the state of the run (an Archive), which belongs to all that was recorded so far.
  virtual void checkpoint(std::string_view /*state*/) {}
  /// The state that the run is to go on from, as if it had not been interrupted; what was recorded since is taken back.
  /// Empty: the run begins. Asked for instead of `begin`.
  virtual std::string resume(const HistoryHeader& /*header*/) { return {}; }
};

/// Told of progress; returns false to ask the run to stop (interrupted).
struct Progress {
  double time = 0.0, end_time = 0.0, step_size = 0.0;
  int iterations = 0;
  long step = 0;
};

}  // namespace bough::records
