#pragma once
/// Operations of a step on nodes, on any group: prediction, Newton corrections, updates of velocities, local errors.
/// Eight nodes are computed at once, one in each lane of a pack; results are bitwise equal to those of scalar
/// arithmetic. Each function takes some of the eights of a NodeOrder, or its range [begin, end) of them, so that
/// threads can share the work. Internal to step.
#include <cstdint>
#include <span>

#include "alpha_rule.hpp"
#include "bough/step/system.hpp"
#include "drift.hpp"

namespace bough::step {

/// A change whose square may not be finite: the iteration is lost.
inline constexpr double too_far = 1e100;
/// Largest rotation of a node in one step [rad]: below pi, where the logarithm ceases to be unique.
inline constexpr double largest_turn = 2.8;

/// A motion vector of a node, expanded to six components in the node's own axes.
template <int N>
motion::Vec6<double> vector_in_space(const plan::Plan& plan, std::size_t node, const lanes::Vec<double, N>& v) {
  if constexpr (N == 6)
    return v;
  else
    return plan.unknowns.expanded(&v[0], node);
}

/// Eight pairs (a, b) of nodes of elements, whose relative motions are measured. If a < 0, the motion of b is measured
/// relative to the fixed ground. Unused lanes repeat the last pair.
struct PairLanes {
  int a[elements::num_lanes], b[elements::num_lanes];
  elements::LanePack per_length;  ///< 1 / length of the element [1/m]
};

/// Stores the increments of nodes that have not moved by them yet in `changes`, by node.
template <class G>
void note_changes(const NodesOn<G>& nodes, std::span<const NodeEight> eights, const NodeIncrements& increments,
                  NodeChange<G>* changes);

/// Applies a correction, H <- H exp(eta). In space the increment of the step is updated, too:
/// dq <- log(exp(dq) exp(eta)). On other groups the poses at both ends of the step determine dq, except its angle in a
/// plane, which they do not determine beyond half a turn: the angle is updated. changes: as of note_changes, or null.
template <class G>
void move_nodes(NodesOn<G>& nodes, std::span<const NodeEight> eights, const NodeIncrements& increments,
                NodeChange<G>* changes);

/// The frames of a step of generalized-alpha: what chooses them, and the step's start relative to them, which
/// predict_nodes writes. Both are empty where nothing flies.
template <class G>
struct Drifts {
  const DriftChoice<G>& choice;
  DriftedStart<G>& start;
};

/// Applies a correction of generalized-alpha in one pass: the poses and dq as above, all components of dq on every
/// group, and the velocities and accelerations that the rule assigns to dq. Returns the largest squared angle of dq.
/// Stores the changes as note_changes.
template <class G>
double correct_nodes(const AlphaRule& rule, const Drifts<G>& drifts, const NodesOn<G>& start, NodesOn<G>& state,
                     const NodeOrder& order, std::size_t begin, std::size_t end, const NodeIncrements& increments,
                     NodeChange<G>* changes);

/// Copies the nodes without unknowns from the start of a step to its end: they are at rest.
template <class G>
void keep_held(const NodesOn<G>& start, NodesOn<G>& state, const NodeOrder& order);

/// Predictor: chooses the frames of the nodes of `state`, and sets their poses, rates and dq from those of `start`.
/// Returns the largest squared angle of dq. degree: of the polynomial through past accelerations.
template <class G>
double predict_nodes(const AlphaRule& rule, const Drifts<G>& drifts, int degree, const NodesOn<G>& start,
                     NodesOn<G>& state, const NodeOrder& order, std::size_t begin, std::size_t end);

/// At the end of a step: stores the acceleration-like variable, and the changes of accelerations for the next
/// predictor, stores the squared errors of the predictors of order 0, 1, 2 by node, and returns the local error, the
/// size of dq and that of the second difference of accelerations. `arm` [m] converts angular to linear accelerations;
/// `per_length` [1/m] makes lengths relative.
template <class G>
Workspace::StepEnd finish_nodes(const AlphaRule& rule, const Drifts<G>& drifts, double arm, double per_length,
                                const NodesOn<G>& start, NodesOn<G>& state, const NodeOrder& order, std::size_t begin,
                                std::size_t end, Misses* misses);

/// The largest squared relative displacement or rotation of the pairs (Corrections::relative_size); infinite if one
/// exceeds the bound too_far or is not a number.
template <class G>
double largest_change(std::span<const PairLanes> pairs, const NodeChange<G>* changes);

/// Places node `node` of `to` at H exp(d), H being its pose in `from`, and sets dq = d.
template <class G>
void place_node(const NodesOn<G>& from, std::size_t node, const typename G::template Vector<double>& d, NodesOn<G>& to);

/// Applies an increment to one node: H <- H exp(eta), dq <- log(exp(dq) exp(eta)).
template <class G>
void move_node(NodesOn<G>& nodes, std::size_t node, const typename G::template Vector<double>& eta);

}  // namespace bough::step
