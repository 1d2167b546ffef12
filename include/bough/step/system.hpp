#pragma once
/// A plan with its tree, its linear solver and the buffers to evaluate it: residuals, tangents, linear solutions.
/// Allocates when made, not afterwards.
#include <array>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "bough/step/instant.hpp"
#include "bough/step/linear_solution.hpp"
#include "bough/step/motion_tree.hpp"
#include "bough/step/state.hpp"

namespace bough::step {

/// Largest entries of a residual or constraint violation, forces and moments, lengths and angles apart.
struct ResidualSize {
  double force = 0.0, moment = 0.0;              ///< |sum of contributions|
  double force_scale = 0.0, moment_scale = 0.0;  ///< largest sum of |contributions| at a node
  double length = 0.0, angle = 0.0;              ///< constraint violations
  int worst_force_node = -1, worst_moment_node = -1, worst_joint = -1;
};

/// Residual that iterations could not make smaller although they contracted: zero until one met it, and again after 64
/// iterations, since forces change.
class RoundOffMemory {
 public:
  const ResidualSize& size() const { return size_; }
  void note(const ResidualSize& r) { size_ = r; }
  /// To be called when an iteration has ended.
  void count_iteration() {
    if (++age_ < lasts) return;
    size_ = {};
    age_ = 0;
  }

 private:
  static constexpr int lasts = 64;
  ResidualSize size_;
  int age_ = 0;
};

/// Largest |Phi| and |Phi'| over all rows of joints, and the same in no unit of length: lengths relative to
/// Plan::length_scale.
struct Violations {
  double position = 0.0, relative_position = 0.0;  ///< [m] or [rad], [-]
  double velocity = 0.0, relative_velocity = 0.0;  ///< [m/s] or [rad/s], [1/s]
  int open_joint = -1, fast_joint = -1;            ///< where the relative ones are, in Plan::joints; -1: nowhere
};

/// Buffers of the verbs in advance.hpp, sized once: a step does not allocate.
struct Workspace {
  std::vector<double> rhs, x;  ///< of the linear system
  State start;                 ///< of a step
  State before;                ///< statics: where an iteration started
  /// Squares of how far quantities are from where polynomials of order 0, 1 and 2 through past ones had them be.
  using Misses = std::array<double, 3>;
  /// What the end of a step tells about a chunk of nodes.
  struct StepEnd {
    Misses misses{};                      ///< of accelerations
    double error = 0.0, increment = 0.0;  ///< as State::local_error and State::increment
  };
  std::vector<StepEnd> step_ends;  ///< by chunk of nodes
  std::vector<double> chunk_most;  ///< by chunk of nodes: the largest of something
};

template <class G>
class LaneBatches;
class HeldNodes;
struct PairLanes;
struct IncrementsOf;
struct ElementResults;

class System {
 public:
  System(const plan::Plan& plan, const scene::Solver& solver, const tree::Walker& walker);
  ~System();

  const plan::Plan& plan() const { return plan_; }
  /// Elements that are evaluated together.
  std::span<const solve::ElementBatch> batches() const;
  /// Factors and solutions of the tangents that evaluate leaves.
  LinearSolution& linear() { return linear_; }
  const LinearSolution& linear() const { return linear_; }
  const tree::Walker& walker() const { return walker_; }
  WorkCounts& counts() { return counts_; }
  CpuClock& clock() { return clock_; }
  Workspace& work() { return work_; }

  /// Values of all time functions at t (right or left limit). A value that is not finite is told with its owner and
  /// the time.
  [[nodiscard]] std::optional<Trouble> set_time(double time, laws::Side side = laws::Side::left);
  /// A state in space, whatever the scene's group: for whom reads results, not for steps.
  elements::Field field(const State& state, const elements::Slopes& slopes = {}, bool with_inertia = true) const;
  /// The same for whom looks at some nodes only; the others are not to be read. scratch: keeps these nodes.
  elements::Field field_of(const State& state, std::span<const int> nodes,
                           std::vector<elements::NodeMotion>& scratch) const;
  /// A state as the elements on the group G see it; only on the group of the scene.
  template <class G>
  elements::FieldOn<G, double> field_on(const State& state, const elements::Slopes& slopes = {},
                                        bool with_inertia = true) const;
  const std::vector<elements::NodeMotion>& nodes(const State& state) const { return nodes_in_space(plan_, state); }

  /// Residual of all elements (and element matrices when `tangent`), then summed over nodes into residual().
  [[nodiscard]] std::optional<Trouble> evaluate(const State& state, const elements::Slopes& slopes, bool tangent);
  /// By block, in the order of the solver.
  const std::vector<double>& residual() const { return residual_; }
  /// To be called before matrices are set or added to, which several threads may then do: what is known of those
  /// present holds no longer. are_symmetric: they will be, to the last bit.
  void begin_matrices(bool are_symmetric = false);
  /// Puts an element's matrix, row-major in all of its unknowns, in the place of its tangent, or adds it there.
  void set_matrix(int element, int num_unknowns, const double* entries);
  void add_matrix(int element, int num_unknowns, const double* entries);
  /// Of the residual last evaluated, without the worst nodes and joint: name_worst looks for these, for messages.
  ResidualSize residual_size() const;
  void name_worst(ResidualSize& size) const;
  /// What round-off alone leaves in the residual: sum |K| eps |coordinates|, by force and moment, K the element
  /// matrices now present.
  const ResidualSize& round_off_floor() const;
  /// The same of elements between two ports alone, which answer to differences of rounded poses. Inertia of a body
  /// answers to the increment of a step, which is rounded much less.
  const ResidualSize& round_off_of_poses() const;
  /// What iterations of this run could not make smaller.
  RoundOffMemory& met_round_off() { return met_round_off_; }
  const RoundOffMemory& met_round_off() const { return met_round_off_; }

  /// Multipliers of the next step of generalized-alpha, by the polynomial of State::multiplier_order.
  void predict_multipliers(const State& start, State& state) const;
  /// What the next prediction goes by, from the step between the two states.
  void note_multipliers(const State& start, State& state) const;
  /// An element's matrix now present, row-major, and the unknowns of its rows.
  solve::ConstElementView matrix_of(int element, std::vector<std::int64_t>& unknowns) const;

  /// Size of an increment: the largest change of relative motions, of elements' nodes with respect to each other,
  /// lengths relative to the element [-] and angles [rad], which no rigid motion of the whole changes:
  ///   |R_b w_b - R_a w_a|,  |R_b u_b - R_a u_a - (R_a w_a) x (x_b - x_a)| / length          for increments (u; w) of
  ///     nodes a and b
  double relative_size(const State& state, const double* x) const;
  /// Applies a solution: each node moves by its own increment, H <- H exp(eta), multipliers grow by theirs. Returns
  /// relative_size.
  double apply(State& state, const double* x);
  /// Applies `factor` of a solution, nodes carrying each other along the motion tree; statics only (State's dq is
  /// left alone).
  ///   S_b = (H_ab^-1 S_a H_ab) exp(factor (eta_b - Ad(H_ab)^-1 eta_a)),  H_b <- H_b S_b   for a node b that a carries
  /// Agrees with apply to first order, but relative motions take their increments exactly: a beam that bends far in
  /// one go is not stretched, as it is where nodes move alone, along their tangents.
  void apply_along_tree(State& state, const double* x, double factor);
  /// Solves once more at an equilibrium, with the matrix that led there. A node's place is rounded, by u |x|, and a
  /// stiff element answers with forces of EA u |x| / L that no load balances; with the eta found here, kept apart in
  /// State::unsettled, forces f + K eta are in equilibrium to round-off of their own size. Multipliers take their
  /// part. Says nothing where the solution fails: then there is no `unsettled`.
  void settle(State& state);
  /// Power of the present residual at the end of the path that apply_along_tree took last with `x`:  sum of residual
  /// . d(increment)/d(factor).
  double power_along_tree(const double* x);

  /// Multipliers of joints that hold nodes without unknowns (Plan::held), from the balance of these nodes as they are
  /// now; laws of its time are set. To be called for every state that is accepted. more: forces by node, own axes,
  /// beside those of elements.
  void recover_multipliers(State& state, const std::vector<motion::Vec6<double>>* more = nullptr) const;
  /// The largest of these multipliers that inertia asks for where velocities jump by a solution x of [M G^T; G 0].
  double largest_held_impulse(const State& state, const double* x) const;

  /// d(residual)/dt with accelerations and multipliers held. step_size: over which third derivatives of prescribed
  /// frames are differenced, 0: they are left out.
  void evaluate_rate(const State& state, std::vector<double>& rate, double step_size = 0.0);
  /// Constraint rows and their first three time derivatives (jerk may be null: then 0), by multiplier.
  void constraint_series(const State& state, const motion::Vec6<double>* jerk, double step_size,
                         std::vector<lanes::Taylor<double, 3>>& out) const;
  /// All of the next two at once.
  Violations constraint_violations(const State& state) const;
  /// Largest |Phi| (order 0) or |Phi'| (order 1) over all rows and the joint it belongs to.
  double constraint_violation(const State& state, int order, int* joint = nullptr) const;
  /// The same in no unit of length: lengths relative to those of the parts that meet in the joint (JointPlan::length),
  /// angles as they are [-] (order 0), [1/s] (order 1).
  double relative_violation(const State& state, int order, int* joint = nullptr) const;

  /// Arm that turns the scale of forces into one of moments [m]: the longest element, or the whole where none has a
  /// length.
  double moment_arm() const { return moment_arm_; }
  /// Index in plan().joints, or -1.
  int joint_of_element(int element) const { return joint_of_element_[static_cast<std::size_t>(element)]; }
  /// The motion of a node in a vector of unknowns, (linear; angular) in its own axes.
  /// A node without unknowns does not move.
  motion::Vec6<double> node_part(const double* x, int node) const {
    const std::int64_t begin = node_begin(node);
    if (begin < 0) return motion::Vec6<double>::zero();
    return plan_.unknowns.expanded(x + begin, static_cast<std::size_t>(node));
  }
  /// The same on the scene's group.
  template <class G>
  typename G::template Vector<double> part_on(const double* x, int node) const {
    if constexpr (std::is_same_v<G, motion::Se3>) return node_part(x, node);
    const std::int64_t begin = node_begin(node);
    typename G::template Vector<double> v = G::template Vector<double>::zero();
    for (int i = 0; i < G::dof && begin >= 0; ++i) v[i] = x[begin + i];
    return v;
  }
  /// Sets the unknowns of a node, where it has some, from a motion, or the entries of a right-hand side from a wrench.
  void set_node_part(double* x, int node, const motion::Vec6<double>& eta) const {
    const std::int64_t begin = node_begin(node);
    if (begin >= 0) plan_.unknowns.project(eta, static_cast<std::size_t>(node), x + begin);
  }
  void set_node_part(double* x, int node, const motion::Vec3<double>& eta) const {  ///< of a scene in a plane
    const std::int64_t begin = node_begin(node);
    for (int i = 0; i < 3 && begin >= 0; ++i) x[begin + i] = eta[i];
  }
  /// First unknown of a node; -1: it has none.
  std::int64_t node_begin(int node) const { return node_begin_[static_cast<std::size_t>(node)]; }
  int num_blocks() const { return plan_.graph.num_blocks(); }
  std::int64_t block_begin(int block) const { return linear_.tree().unknown_begin[static_cast<std::size_t>(block)]; }
  int block_size(int block) const { return static_cast<int>(block_begin(block + 1) - block_begin(block)); }
  std::size_t num_unknowns() const { return static_cast<std::size_t>(linear_.tree().unknown_begin.back()); }
  const std::vector<double>& law_values() const { return instant_.law_values(); }
  /// Motion of the frame in which everything is described, in the inertial one; null where that is the inertial frame
  /// itself.
  const elements::CarrierMotion* observer() const { return instant_.observer(); }

 private:
  /// sum |K| eps |coordinates| over the elements that count.
  template <class Counts>
  ResidualSize sum_round_off(Counts&& counts) const;
  struct ChunkSize {
    ResidualSize size;
    bool is_finite;
  };

  /// A sum of parts of elements: of a block or, after all blocks, of the forces on a node that is held.
  struct Sum {
    std::int64_t use_begin, use_end;  ///< in uses_
    std::int64_t unknown;             ///< the first
    int size;
    int owner;  ///< node or joint
  };

  void place_parts();
  void set_parts(std::size_t element, const double* residual, const double* magnitude);
  int num_unknowns_of(std::size_t element) const;
  void find_pairs();
  void find_unsettled(State& state);
  template <int Count>
  ChunkSize sum_nodes(std::size_t begin, std::size_t end);
  void copy_rows(std::size_t begin, std::size_t end, ChunkSize& chunk);
  void sum_held_node(const Sum& sum, ChunkSize& chunk) const;
  void sum_parts(std::int64_t begin, std::int64_t end);
  double largest_violation(const State& state, int order, bool is_relative, int* joint) const;
  void add_multipliers(State& state, const double* x, double factor) const;

  /// Puts (A + A^T) / 2 in place of the tangents of a batch.
  void symmetrise(const solve::ElementBatch& batch);
  template <class G>
  std::span<const solve::ElementBatch> batches_on() const;
  template <class G>
  const LaneBatches<G>& lanes_on() const;
  template <class G>
  void evaluate_on(const State& state, const elements::FieldOn<G, double>& field, bool tangent);
  template <class G>
  void evaluate_alone(std::size_t id, const State& state, const elements::FieldOn<G, double>& field,
                      const ElementResults& to);
  IncrementsOf increments() const;
  template <class E>
  void evaluate_reduced(const E& e, std::size_t id, const elements::Field& field, const double* multipliers,
                        double turns, bool tangent);
  template <class G>
  void add_rates(const State& state, double step_size, std::vector<double>& rate);
  bool sum_as_seen(const State& state, std::vector<double>& sum);
  const plan::JointPlan* joint_plan_of(std::size_t element) const {
    const int j = joint_of_element_[element];
    return j < 0 ? nullptr : &plan_.joints[static_cast<std::size_t>(j)];
  }

  const plan::Plan& plan_;
  Instant instant_;
  std::unique_ptr<LaneBatches<motion::Se3>> spatial_lanes_;
  std::unique_ptr<LaneBatches<motion::Se2>> planar_lanes_;  ///< of a scene in a plane; else null
  std::unique_ptr<HeldNodes> held_;                         ///< none where the solver knows all nodes
  tree::Walker walker_;
  CpuClock clock_;
  WorkCounts counts_;
  LinearSolution linear_;
  Workspace work_;
  mutable Instant::Series row_series_;  ///< scratch of constraint_violation
  mutable std::vector<Violations> violation_parts_;
  std::vector<std::int64_t> element_begin_;  ///< unknowns of the elements before it
  /// Parts of an element, from 2 element_begin_ on: of each of its nodes, then of its rows, entries of the residual
  /// and then the sums of |terms| of these.
  std::vector<double> parts_;
  std::vector<int> joint_of_element_;     ///< index in plan.joints or -1
  std::vector<std::int64_t> node_begin_;  ///< first unknown of each node, or -1
  std::vector<Sum> sums_;                 ///< nodes, then joints, then held nodes, each in the order of blocks
  std::int64_t num_node_sums_ = 0, num_row_sums_ = 0;
  std::vector<std::int64_t> uses_;  ///< places in parts_ that add up, fixed order
  std::vector<double> residual_;
  mutable std::optional<ResidualSize> round_off_floor_;     ///< of the element matrices now present, once asked for
  mutable std::optional<ResidualSize> round_off_of_poses_;  ///< likewise
  mutable std::vector<double> floor_;                       ///< scratch of round_off_floor
  mutable std::vector<std::int64_t> floor_unknowns_;        ///< scratch of round_off_floor
  std::vector<ChunkSize> chunk_sizes_;                      ///< of residual_, by chunk of sums
  std::vector<char> is_length_;  ///< by unknown: whether it is the multiplier of a length, in blocks of joints
  struct MultiplierPlace {
    std::size_t multiplier, unknown;
  };
  std::vector<MultiplierPlace> multiplier_places_;
  std::vector<PairLanes> pairs_;  ///< whose relative motions relative_size looks at
  mutable std::vector<double> chunk_max_;
  std::vector<double> element_length_;  ///< size of each element, for relative changes [m]
  double moment_arm_ = 0.0;
  MotionTree motion_tree_;  ///< empty in dynamics
  RoundOffMemory met_round_off_;
  std::vector<double> seen_parts_;  ///< scratch of sum_as_seen: residuals of elements, from element_begin_ on
};

}  // namespace bough::step
