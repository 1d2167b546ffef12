#pragma once
/// What a step does to nodes, on either group: eight nodes at a time, one to a lane, with the bits of one node alone.
/// Functions take the nodes [begin, end), so that threads share the work. Internal to step.
#include <cstdint>
#include <span>

#include "alpha_rule.hpp"
#include "bough/step/system.hpp"

namespace bough::step {

/// How a vector of unknowns makes increments of nodes: first unknown by node, -1: none.
struct IncrementsOf {
  const plan::NodeUnknowns& unknowns;
  const std::int64_t* begin;
};

/// A vector of a node as one of space, own axes.
inline const motion::Vec6<double>& vector_in_space(const plan::Plan&, std::size_t, const motion::Vec6<double>& v) {
  return v;
}
inline motion::Vec6<double> vector_in_space(const plan::Plan& plan, std::size_t node, const motion::Vec3<double>& v) {
  return plan.unknowns.expanded(&v[0], node);
}

/// Eight pairs of nodes of an element; a < 0: b alone, against what does not move. Spare lanes repeat the last pair.
struct PairLanes {
  int a[elements::num_lanes], b[elements::num_lanes];
  elements::LanePack per_length;  ///< 1 / length of the element [1/m]
};

/// H <- H exp(eta), eta from a vector x of unknowns. In space dq <- log(exp(dq) exp(eta)); in a plane the angle of dq
/// alone is kept, which the pose does not tell beyond half a turn: follow_nodes finds the rest.
template <class G>
void move_nodes(NodesOn<G>& nodes, std::size_t begin, std::size_t end, const double* x, const IncrementsOf& increments);

/// Nodes as the rule predicts them, all of `state` from `start`. Returns the largest square of the angle of dq.
template <class G>
double predict_nodes(const AlphaRule& rule, int order, const NodesOn<G>& start, NodesOn<G>& state, std::size_t begin,
                     std::size_t end);

/// dq, and the velocities and accelerations that belong to it. Returns the largest square of the angle of dq.
template <class G>
double follow_nodes(const AlphaRule& rule, const NodesOn<G>& start, NodesOn<G>& state, std::size_t begin,
                    std::size_t end);

/// Trends of accelerations, and what the end of the step tells; angular accelerations count by `arm` [m].
template <class G>
Workspace::StepEnd finish_nodes(const AlphaRule& rule, double arm, double per_length, const NodesOn<G>& start,
                                NodesOn<G>& state, std::size_t begin, std::size_t end);

/// The largest square of a shift or a turn of the pairs; infinite where one is too far (System::relative_size).
template <class G>
double largest_change(const NodesOn<G>& nodes, std::span<const PairLanes> pairs, const double* x,
                      const IncrementsOf& increments);

/// Node n of `to` at H exp(d) of `from`, dq = d.
template <class G>
void place_node(const NodesOn<G>& from, std::size_t node, const typename G::template Vector<double>& d, NodesOn<G>& to);

/// One node.
template <class G>
void move_node(NodesOn<G>& nodes, std::size_t node, const typename G::template Vector<double>& eta);

}  // namespace bough::step
