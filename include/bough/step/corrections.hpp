#pragma once
/// Corrections of a state: solutions of the linear system, applied to nodes and multipliers, and their sizes.
#include <array>
#include <memory>
#include <vector>

#include "bough/step/cpu_clock.hpp"
#include "bough/step/element_evaluation.hpp"
#include "bough/step/motion_tree.hpp"
#include "bough/step/node_order.hpp"

namespace bough::step {

struct PairLanes;

/// The increment of a node that is about to move by it, in the axes in which positions are given, and its position.
template <class G, class S>
struct NodeChangeOf {
  typename G::template Vector<S> increment;
  typename G::template Translation<S> place;
};
template <class G>
struct NodeChange : NodeChangeOf<G, double> {
  static constexpr int numbers = G::dof + G::translations;
};

/// Squared errors of predictions by polynomials of order 0, 1 and 2 through past values.
using Misses = std::array<double, 3>;
/// The order with the smallest error; of equal ones the lowest.
int least_missed(const Misses& misses);

class Corrections {
 public:
  Corrections(const plan::Plan& plan, const UnknownPlaces& places, const Instant& instant,
              const ElementLengths& lengths, const LinearSolution& linear, std::shared_ptr<const NodeOrder> order,
              const tree::Walker& walker, CpuClock& clock, WorkCounts& counts);
  ~Corrections();

  /// Size of a correction: the largest change of relative motions, of elements' nodes with respect to each other,
  /// lengths relative to the element [-] and angles [rad], which no rigid motion of the whole changes:
  ///   |R_b w_b - R_a w_a|,  |R_b u_b - R_a u_a - (R_a w_a) x (x_b - x_a)| / length          for increments (u; w) of
  ///     nodes a and b
  double relative_size(const State& state, const double* x);
  /// Applies a solution: each node moves by its own increment, H <- H exp(eta), multipliers grow by theirs. Returns
  /// relative_size.
  double apply(State& state, const double* x);

  /// The same in the visits of a downward walk, each of which knows the part of x that its nodes and multipliers, and
  /// those of its parents, have. `move(begin, end, changes)` moves a range of NodeOrder::eights() and stores their
  /// changes, by node; the multipliers of the visit grow by those of x; and the relative motions of its elements are
  /// measured. Signals are left as they are.
  template <class G, class Move>
  void apply_in_visit(int visit, State& state, const double* x, Move&& move);
  /// relative_size of the solution that all visits have applied.
  double applied_size() const;
  void add_signals(State& state, const double* x, double factor) const;
  /// Applies `factor` of a solution, nodes carrying each other along the motion tree; statics only (State's dq does not
  /// change).
  ///   S_b = (H_ab^-1 S_a H_ab) exp(factor (eta_b - Ad(H_ab)^-1 eta_a)),  H_b <- H_b S_b   for a node b that a carries
  /// It agrees with apply to first order, but relative motions take their increments exactly: a beam that bends far in
  /// one correction is not stretched, as it is where nodes move independently, along their tangents.
  void apply_along_tree(State& state, const double* x, double factor);
  /// Power of forces, by unknown, at the end of the path that apply_along_tree took last with `x`:  sum of force .
  /// d(increment)/d(factor).
  double power_along_tree(const double* forces, const double* x);
  /// Adds `factor` times the multipliers and signals of a solution.
  void add_multipliers(State& state, const double* x, double factor) const;

  /// Notes where nodes without unknowns are, for the relative changes that apply_in_visit measures.
  void note_held(const State& state);

  /// Predicts the multipliers at the end of the next step of generalized-alpha, by the polynomial of
  /// State::multiplier_order.
  void predict_multipliers(const State& start, State& state) const;
  /// Stores what the next prediction needs of the step between the two states.
  void note_multipliers(const State& start, State& state) const;

 private:
  void find_pairs(const LinearSolution& linear);
  template <class G>
  void measure_pairs(std::int64_t begin, std::int64_t end);
  void add_multipliers(State& state, const double* x, double factor, std::int64_t begin, std::int64_t end) const;

  const plan::Plan& plan_;
  const UnknownPlaces& places_;
  const Instant& instant_;
  const ElementLengths& lengths_;
  tree::Walker walker_;
  CpuClock& clock_;
  WorkCounts& counts_;
  MotionTree motion_tree_;  ///< empty in dynamics
  std::shared_ptr<const NodeOrder> order_;
  std::vector<PairLanes> pairs_;  ///< pairs of nodes whose relative motions relative_size measures
  VisitRanges pairs_by_visit_, multipliers_by_visit_;
  std::vector<UnknownPlaces::Multiplier> multipliers_;  ///< visit after visit
  std::vector<double> pair_sizes_;                      ///< squares; by chunk of pairs at the place of its first
  template <class G>
  using ChangesOn = std::vector<NodeChange<G>>;
  motion::Groups::OneOf<ChangesOn> changes_;  ///< by node
};

template <class G, class Move>
void Corrections::apply_in_visit(int visit, State& state, const double* x, Move&& move) {
  NodeChange<G>* const changes = std::get<ChangesOn<G>>(changes_).data();
  order_->by_visit().for_each(walker_, visit, eight_grain,
                              [&](std::int64_t begin, std::int64_t end) { move(begin, end, changes); });
  if (!multipliers_by_visit_.is_empty(visit))
    add_multipliers(state, x, 1.0, multipliers_by_visit_.begin(visit), multipliers_by_visit_.end(visit));
  pairs_by_visit_.for_each(walker_, visit, pair_grain,
                           [this](std::int64_t begin, std::int64_t end) { measure_pairs<G>(begin, end); });
}

}  // namespace bough::step
