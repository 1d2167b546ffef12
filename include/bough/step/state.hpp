#pragma once
/// Everything that changes during a run, as plain data: two equal states continue equally. Nodes move on the group of
/// the scene (motion::Groups). Whoever looks at a scene in space asks for nodes_in_space.
#include <span>
#include <utility>
#include <variant>
#include <vector>

#include "bough/elements/evaluate.hpp"
#include "bough/motion/quaternion.hpp"
#include "bough/plan/plan.hpp"
#include "bough/step/node_vectors.hpp"
#include "bough/tree/walker.hpp"

namespace bough::step {

/// Nodes that move on the group G. Vectors are in the nodes' own axes.
template <class G>
struct NodesOn {
  using Group = G;
  using Vector = typename G::template Vector<double>;
  std::vector<elements::NodeMotionOn<G, double>> motion;  ///< R, x, v, dv/dt, and dq since the last accepted step
  std::vector<motion::Quaternion<double>> rotation;       ///< on SE(3), where R is made from it; else empty
  NodeVectors<G> algorithmic;         ///< a_n at the end of a step, the acceleration-like variable of generalized-alpha
  NodeVectors<G> acceleration_trend;  ///< change of dv/dt over the last step, of generalized-alpha
  NodeVectors<G> trend_change;        ///< change of that from the step before; zero after a start
  std::vector<Vector> momentum;       ///< p_n of the variational integrator; else empty

  void checkpoint(records::Archive& archive) {
    archive(motion, rotation, algorithmic, acceleration_trend, trend_change, momentum);
  }
  /// As many nodes as there are in `like`.
  void resize_as(const NodesOn& like) {
    motion.resize(like.motion.size());
    rotation.resize(like.rotation.size());
    algorithmic.resize_as(like.algorithmic);
    acceleration_trend.resize_as(like.acceleration_trend);
    trend_change.resize_as(like.trend_change);
  }
};
using SpatialNodes = NodesOn<motion::Se3>;

/// Values by signal (Plan::signals). Rates are those of states, zero for other signals.
struct SignalValues {
  std::vector<double> value, rate;
  std::vector<double> given;        ///< of inputs, as they were set last; zero for other signals
  std::vector<double> algorithmic;  ///< a_n of generalized-alpha for states
  std::vector<double> trend;        ///< change over the last step: of a state's rate, of another signal's value
  void checkpoint(records::Archive& archive) { archive(value, rate, given, algorithmic, trend); }
};

struct State {
  double time = 0.0;       ///< [s], or the load factor in statics
  double step_size = 0.0;  ///< h that NodesOn::algorithmic belongs to [s]; 0 before the start
  /// Order of the polynomial through past dv/dt that would have been nearest to the last step: 0, 1 or 2.
  int predictor_order = 0;
  /// Of the last step of generalized-alpha, the largest over all nodes, lengths over the size of the structure: its
  /// local error without the filter of stiff parts (step_control.hpp), 0 after a start; and dq.
  double local_error = 0.0, increment = 0.0;
  /// The local error of velocities of that step, without the filter too, as the change of dq that changes velocities by
  /// as much (AlphaRule::velocity_error), lengths over the size of the structure; 0 after a start.
  double velocity_error = 0.0;
  double last_step = 0.0;  ///< h that dq spans, of the variational integrator [s]; 0 at a start
  /// Statics: increments in space that nodes still lack and their digits cannot hold; else empty.
  std::vector<motion::Vec6<double>> unsettled;
  std::vector<double> multipliers;
  std::vector<double> multiplier_trend;         ///< change of multipliers over the last step; zero after a start
  std::vector<double> multiplier_trend_change;  ///< change of that from the step before; zero after a start
  int multiplier_order = 0;                     ///< as predictor_order
  SignalValues signals;
  /// Angle of each joint at the last accepted step, where it is counted (Plan::turning_joints); else 0 [rad].
  std::vector<double> turns;
  /// By at least this angle relative rotations may still change before an element can be past a limit of its shape
  /// (check_shape) [rad]; 0: not known. A change of nodes by anything but a step of generalized-alpha resets it.
  double shape_margin = 0.0;

  void checkpoint(records::Archive& archive) {
    if (archive.is_reading()) begin_change();
    archive(nodes_, time, step_size, predictor_order, local_error, increment, velocity_error, last_step, unsettled,
            multipliers, multiplier_trend, multiplier_trend_change, multiplier_order, signals, turns, shape_margin);
  }

  std::size_t num_nodes() const {
    return std::visit([](const auto& nodes) { return nodes.motion.size(); }, nodes_);
  }
  /// Whether the nodes are on SE(3).
  bool is_in_space() const { return std::holds_alternative<SpatialNodes>(nodes_); }
  /// The nodes, for whom the scene's group is known.
  template <class G>
  const NodesOn<G>& on() const {
    return std::get<NodesOn<G>>(nodes_);
  }
  /// The same to be changed: what was made of them in space holds no longer.
  template <class G>
  NodesOn<G>& change() {
    begin_change();
    return std::get<NodesOn<G>>(nodes_);
  }
  void begin_change() {
    in_space_.nodes.clear();
    shape_margin = 0.0;
  }
  /// To be changed by several threads, after begin_change() by one; or where no node moves.
  template <class G>
  NodesOn<G>& changing() {
    return std::get<NodesOn<G>>(nodes_);
  }
  /// Calls f(nodes) on the scene's group.
  template <class F>
  decltype(auto) visit(F&& f) const {
    return std::visit(std::forward<F>(f), nodes_);
  }
  template <class F>
  decltype(auto) change_all(F&& f) {
    begin_change();
    return std::visit(std::forward<F>(f), nodes_);
  }
  /// Takes what elements read of a state, and leaves the rest.
  void take_what_elements_read(const State& from) {
    from.visit([this]<class G>(const NodesOn<G>& nodes) { emplace<G>().motion = nodes.motion; });
    time = from.time;
    unsettled = from.unsettled;
    multipliers = from.multipliers;
    signals = from.signals;
    turns = from.turns;
  }
  /// As many nodes as there are in `like`, on its group, whatever they were.
  template <class G>
  NodesOn<G>& resize_as(const State& like) {
    in_space_.nodes.reserve(like.in_space_.nodes.capacity());
    NodesOn<G>& nodes = emplace<G>();
    nodes.resize_as(like.on<G>());
    return nodes;
  }
  /// Takes nodes of any group in place of those that there are.
  template <class G>
  NodesOn<G>& emplace() {
    begin_change();
    if (!std::holds_alternative<NodesOn<G>>(nodes_)) nodes_.template emplace<NodesOn<G>>();
    return std::get<NodesOn<G>>(nodes_);
  }

 private:
  friend State make_initial_state(const plan::Plan& plan);
  friend const std::vector<elements::NodeMotion>& nodes_in_space(const plan::Plan& plan, const State& state);
  motion::Groups::OneOf<NodesOn> nodes_;
  /// Nodes of another group in space, once asked for; empty: not yet. A copy makes its own.
  struct InSpace {
    std::vector<elements::NodeMotion> nodes;
    InSpace() = default;
    InSpace(const InSpace& other) { nodes.reserve(other.nodes.capacity()); }
    InSpace& operator=(const InSpace& other) {
      nodes.clear();
      nodes.reserve(other.nodes.capacity());
      return *this;
    }
    InSpace(InSpace&&) = default;
    InSpace& operator=(InSpace&&) = default;
    ~InSpace() = default;
  };
  mutable InSpace in_space_;
};

/// The scene's own poses and twists, not yet consistent. Copies of it take no more memory later.
State make_initial_state(const plan::Plan& plan);

/// R, x, v, dv/dt and dq of all nodes in space, own axes of the nodes as the scene places them:
///   R = R_0 exp(theta n),  x = x_0 + A (p - p_0),  v = B (linear part; angular part)
/// theta and p - p_0 turn and displacement on the group since the start, A the axes of the model, B the same in those
/// of the node and n the normal of a plane among them (plan::NodeStartOn). Where nothing turns, R = R_0. Made once for
/// a state, which keeps them until it is changed.
const std::vector<elements::NodeMotion>& nodes_in_space(const plan::Plan& plan, const State& state);
/// Some of them alone, each named once, in their places of `to`, which has room for all. walker: null for one thread.
void copy_nodes_in_space(const plan::Plan& plan, const State& state, std::span<const int> nodes,
                         std::vector<elements::NodeMotion>& to, const tree::Walker* walker = nullptr);

/// The poses, twists, multipliers and turns of a state for steps in space.
State make_spatial(const plan::Plan& plan, const State& state);

/// H <- H exp(eta) of one node, and dq <- log(exp(dq) exp(eta)). Vectors are those of space, own axes; components that
/// the group of the scene lacks are left out.
void move_node(const plan::Plan& plan, State& state, std::size_t node, const motion::Vec6<double>& eta);
void set_velocity(const plan::Plan& plan, State& state, std::size_t node, const motion::Vec6<double>& v);
void set_acceleration(const plan::Plan& plan, State& state, std::size_t node, const motion::Vec6<double>& a);
/// v, dv/dt and dq of all nodes are zero.
void set_at_rest(State& state);

}  // namespace bough::step
