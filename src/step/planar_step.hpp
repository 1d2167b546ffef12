#pragma once
/// Steps of generalized-alpha that iterate in the plane: nodes move by three numbers instead of six, eight at a time, and go back to space when
/// they are asked for. What only steps look at stays in lanes, from one to the next as well. Internal to step.
#include <array>
#include <cstdint>
#include <vector>

#include "alpha_rule.hpp"
#include "bough/step/system.hpp"
#include "bough/tree/walker.hpp"
#include "planar_system.hpp"

namespace bough::step {

/// Two nodes of an element, a < 0: b alone, against what does not move.
struct NodePair {
  int a, b;
  double per_length;  ///< 1 / length of the element [1/m]
};

class PlanarStep {
 public:
  /// node_begin: first unknown of each node, or -1. Plan and system are read while steps are taken.
  PlanarStep(const plan::Plan& plan, PlanarSystem& system, const std::vector<std::int64_t>& node_begin,
             const std::vector<NodePair>& pairs);

  /// Whether a step is under way: nodes of the PlanarSystem are its own, those of States are not looked at.
  bool is_under_way() const { return is_under_way_; }

  /// Whether the last step ended in `state`, whose nodes are behind.
  bool knows(const State& state) const { return state.behind == number_; }
  /// Nodes where the step starts from, then as the rule predicts them. is_end: `start` is the end of the last step, whether its nodes are behind or not.
  void enter(const State& start, bool is_end, const AlphaRule& rule, const tree::Walker& walker);
  /// H <- H exp(eta), dq <- log(exp(dq) exp(eta)), velocities and accelerations by the rule. Returns the size of the increment,
  /// as System::relative_size.
  double apply(const double* x, const tree::Walker& walker);
  /// A node that turns further than `angle` [rad] in the step, or -1.
  int turned_beyond(double angle) const;
  /// The first element that is a beam folded as check_shape forbids, or the number of elements.
  std::int64_t first_folded(const tree::Walker& walker) const;
  /// Joints that can flip in the plane, as elements. All others have no rows of angles there, or hold nodes at rest.
  const std::vector<int>& joints_with_angles() const { return joints_with_angles_; }
  /// Ends the step, which the next one may start from; ends: by chunk of nodes, angular accelerations counted by `arm` [m].
  void finish(double arm, std::vector<Workspace::StepEnd>& ends, const tree::Walker& walker);
  /// Leaves the nodes of `state`, which is the end of the last step from `start`, behind: those of `start` become its own.
  void keep(State& start, State& state) const;
  /// Writes the nodes of `state`, which is the end of the last step, its algorithmic, acceleration_trend and trend_change.
  /// Whether others were written before changes nothing.
  void write(State& state, const tree::Walker& walker);
  /// The same for the nodes of `watch` and their neighbours in lanes alone: `state`, whose nodes are behind, stays so but for these.
  void watch(const std::vector<int>& nodes);
  void write_watched(State& state, const tree::Walker& walker);
  void abandon() { is_under_way_ = false; }
  /// accept_turns of a state whose nodes are behind.
  void count_turns(State& state, const tree::Walker& walker) const;

 private:
  using Pack = elements::LanePack;
  /// A pose as it was read from space, there and in the plane.
  struct ReadLanes {
    motion::PositionPair<Pack> place;
    motion::Quaternion<Pack> rotation;
    motion::Vec2<Pack> turn;
    motion::PositionPair<Pack, 2> x;
  };
  /// Where a step starts: turn, position [m], velocity, its derivative and the change of that over the last step, a_n, the last step's increment.
  struct StartLanes {
    motion::Vec2<Pack> turn;
    motion::PositionPair<Pack, 2> x;
    motion::Vec3<Pack> v, a, trend, trend_change, algorithmic, dq;
  };
  /// Where nodes stand, and how far they moved in the step.
  struct MoverLanes {
    motion::Vec2<Pack> turn;
    motion::PositionPair<Pack, 2> x;
    motion::Vec3<Pack> dq;
    void move(const motion::Vec3<Pack>& eta);
    void follow(const StartLanes& start, const Pack& eta_w);
  };
  void place_pairs(const std::vector<NodePair>& pairs, const std::vector<std::int64_t>& node_begin);
  std::size_t count_of(std::size_t group) const;
  bool moves(int node) const { return node != elements::ground && unknowns_[static_cast<std::size_t>(node)] >= 0; }
  void read_nodes(const State& start, std::size_t group);
  void show_nodes(std::size_t group, Pack& turned);
  void finish_nodes(double arm, std::size_t group, Workspace::StepEnd& end);
  void write_nodes(State& state, std::size_t group) const;
  double largest_change(const double* x, std::int64_t begin, std::int64_t end) const;

  /// Eight pairs of nodes: the first four numbers of each node, its turn and its place to the digits of a double, and its first unknown, -1: at rest.
  struct PairLanes {
    struct Side {
      const double* node[nodes_in_lanes];
      std::int64_t unknown[nodes_in_lanes];
    } a, b;
    Pack per_length;
  };
  /// What turns with two nodes of an element, -1: the ground, and by how much more the second is turned as the element is made.
  struct Ends {
    std::int64_t owner;  ///< a beam's element, or a joint
    int a, b;
    motion::Vec2<double> between;
  };
  template <class E>
  static Ends ends_of(const E& e, std::int64_t owner, int port);
  motion::Vec2<double> turn_of(int node) const;

  /// A joint about the normal, which counts its turns: the angle is `sign` times the one from the first port to the second.
  struct TurnCounter {
    Ends ends;
    double sign;
  };
  void watch_turns(std::size_t joint);

  const plan::Plan& plan_;
  PlanarSystem& system_;
  AlphaRule rule_{};
  // By eight nodes; spare lanes of the last eight repeat its last node.
  std::vector<motion::Mat3<Pack>> bases_;
  std::vector<StartLanes> starts_;
  std::vector<MoverLanes> movers_;
  std::vector<ReadLanes> read_;         ///< displacements since then go to space
  std::vector<std::int64_t> unknowns_;  ///< the first of each node, lane by lane, -1: at rest
  std::vector<PairLanes> pairs_;        ///< spare lanes of the last repeat its last pair
  std::vector<Ends> beam_ends_;
  std::vector<int> joints_with_angles_;
  std::vector<TurnCounter> turn_counters_;
  std::vector<double> chunk_max_;  ///< squares of changes, by chunk of pairs
  std::vector<double> turn_max_;   ///< of |dq_w|, by chunk of nodes [rad]
  std::vector<std::size_t> watched_groups_;
  std::int64_t number_ = 0;  ///< of what the lanes hold: counts reading and finished steps
  bool is_under_way_ = false;
};

/// The trouble with a state whose nodes were left behind by a step that was not the System's last.
Trouble lost_nodes(const State& state);

}  // namespace bough::step
