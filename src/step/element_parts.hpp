#pragma once
/// The parts of an element's residual, and sizes of the pieces of work that are shared among threads. Internal to step.
#include <cstddef>
#include <cstdint>

#include "bough/plan/plan.hpp"
#include "bough/step/state.hpp"

namespace bough::step {

/// Of an element: a joint with six rows of which signals drive two, four efforts that are signals, and two signals that
/// read its efforts. A line load on a beam of four nodes has 25.
inline constexpr std::size_t most_unknowns = 26;

/// Numbers of items that a task takes at once; chunks do not depend on the number of threads.
inline constexpr std::int64_t element_grain = 256, block_grain = 64, batch_grain = 8;

inline constexpr int least_lanes = 3;  ///< elements that are evaluated as eight

/// Calls f(block, size, node) for every part of an element's unknowns, in their order: its nodes, then, with node -1,
/// the rows of a joint and the signals that it reads. block -1: these have no unknowns in the linear system.
template <class F>
void for_each_part(const plan::Plan& plan, std::size_t element, F&& f) {
  plan::with_element(plan.elements, plan.directory[element], [&](const auto& e) {
    for (const elements::Port& p : e.ports)
      if (p.node != elements::ground)
        f(plan.block_of_node[static_cast<std::size_t>(p.node)], plan.unknowns.count, p.node);
  });
  const plan::JointPlan* const joint = plan.joint_of(element);
  if (joint != nullptr && !joint->rows.empty()) f(joint->block, static_cast<int>(joint->rows.size()), -1);
  for (const int signal : plan::signals_of(plan, element))
    f(plan.signals[static_cast<std::size_t>(signal)].block, 1, -1);
}

/// How many of the `size` unknowns of a part, as given by for_each_part, are in the linear system. They come first.
inline int num_kept(const plan::Plan& plan, int block, int size, int node) {
  if (block < 0) return 0;
  return node < 0 ? size : plan.unknowns.count_of(static_cast<std::size_t>(node));
}

/// Whether an element is a joint none of whose rows is an unknown, in a scene whose nodes do not turn: it neither
/// pushes nor pulls on its nodes, and no motion changes its rows.
inline bool is_idle_joint(const plan::Plan& plan, int joint) {
  return joint >= 0 && plan.joints[static_cast<std::size_t>(joint)].rows.empty() &&
         !plan.with_group([]<class G>() { return G::turns; });
}

/// Entries of an element's residual and of its magnitude in the order of ResidualSums::parts: for its nodes, of
/// `node_unknowns` each (an integral constant where the compiler should know it), and its rows, with which the signals
/// that it reads are counted.
template <class Count, class S>
void join_parts(Count node_unknowns, int num_unknowns, int num_rows, const S* residual, const S* magnitude, S* parts) {
  const auto join = [&](auto count) {
    for (int i = 0; i < count; ++i) parts[i] = residual[i];
    for (int i = 0; i < count; ++i) parts[count + i] = magnitude[i];
    residual += count;
    magnitude += count;
    parts += 2 * count;
  };
  for (int begin = 0; begin < num_unknowns - num_rows; begin += node_unknowns) join(node_unknowns);
  if (num_rows > 0) join(num_rows);
}

/// The multipliers that an element on the group G of a joint takes: in space of all rows, on another group of those
/// that are kept there, which `scratch` takes.
template <class G>
const double* multipliers_on(const plan::JointPlan& joint, const State& state, double* scratch) {
  const double* from = state.multipliers.data() + joint.multiplier_begin;
  if constexpr (std::is_same_v<G, motion::Se3>) return from;
  for (std::size_t r = 0; r < joint.rows.size(); ++r) scratch[r] = from[joint.rows[r]];
  return scratch;
}

}  // namespace bough::step
