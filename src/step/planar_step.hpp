#pragma once
/// A step of generalized-alpha that iterates in the plane: nodes move by three numbers instead of six, eight at a time, and go back to space
/// once the iteration has ended. Internal to step.
#include <cstdint>
#include <vector>

#include "alpha_rule.hpp"
#include "bough/step/state.hpp"
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
  /// node_begin: first unknown of each node, or -1. All are read while steps are taken.
  PlanarStep(const plan::Plan& plan, PlanarSystem& system, const std::vector<std::int64_t>& node_begin,
             const std::vector<NodePair>& pairs);

  /// Whether a step is under way: nodes of the PlanarSystem are its own, those of States are not looked at.
  bool is_under_way() const { return is_under_way_; }

  /// Nodes where the step starts from, then as the rule predicts them.
  void enter(const State& start, const AlphaRule& rule, const tree::Walker& walker);
  /// H <- H exp(eta), dq <- log(exp(dq) exp(eta)), velocities and accelerations by the rule. Returns the size of the increment,
  /// as System::relative_size.
  double apply(const double* x, const tree::Walker& walker);
  /// A node that turns further than `angle` [rad] in the step, or -1.
  int turned_beyond(double angle) const;
  /// The first element that is a beam folded as check_shape forbids, or the number of elements.
  std::int64_t first_folded(const tree::Walker& walker) const;
  /// Joints that can flip in the plane, as elements. All others have no rows of angles there.
  const std::vector<int>& joints_with_angles() const { return joints_with_angles_; }
  /// Writes the nodes of `state`, which is the end of the step from `start`.
  void leave(const State& start, State& state, const tree::Walker& walker);
  void abandon() { is_under_way_ = false; }

 private:
  /// Where a step starts: turn, position [m], velocity, its derivative, a_n.
  template <class S>
  struct StartNode {
    motion::Vec2<S> turn;
    elements::planar::PairOf<S> x;
    motion::Vec3<S> v, a, algorithmic;
  };
  static constexpr int numbers_of_start = 15;
  static_assert(sizeof(StartNode<double>) == numbers_of_start * sizeof(double));
  template <class S>
  struct PlanarMover;

  void enter_nodes(const State& start, std::int64_t begin, std::int64_t end);
  void move_nodes(std::size_t begin, std::size_t count, const StartNode<elements::LanePack>& start,
                  PlanarMover<elements::LanePack> mover, const motion::Vec3<elements::LanePack>& eta, bool is_first);
  double largest_change(const double* x, std::int64_t begin, std::int64_t end) const;

  const plan::Plan& plan_;
  PlanarSystem& system_;
  const std::vector<std::int64_t>& node_begin_;
  const std::vector<NodePair>& pairs_;
  AlphaRule rule_{};
  std::vector<StartNode<double>> starts_;
  std::vector<int> joints_with_angles_;
  std::vector<double> chunk_max_;  ///< of increments, by chunk of pairs
  std::vector<double> turn_max_;   ///< of |dq_w|, by chunk of nodes [rad]
  bool is_under_way_ = false;
};

}  // namespace bough::step
