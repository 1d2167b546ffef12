#pragma once
/// Shared by the files of System.
#include <algorithm>
#include <atomic>
#include <cstdint>

#include "bough/step/system.hpp"

namespace bough::step {

/// Items a task takes at once; chunks do not depend on the number of threads.
inline constexpr std::size_t most_unknowns = 24;  ///< of an element: a beam of four nodes
/// Pairs of nodes are counted by eights.
inline constexpr std::int64_t element_grain = 256, block_grain = 64, pair_grain = 16, batch_grain = 8;

inline constexpr int least_lanes = 3;  ///< elements that are evaluated as eight

inline constexpr double folded =
    -0.95;  ///< cosine of the angle between the ends of a beam element, below which it is bent too far

/// The smallest of the numbers that threads note.
class FirstBad {
 public:
  explicit FirstBad(std::int64_t none) : first_(none) {}
  void note(std::int64_t id) {
    std::int64_t known = first_.load(std::memory_order_relaxed);
    while (id < known && !first_.compare_exchange_weak(known, id, std::memory_order_relaxed)) {
    }
  }
  std::int64_t get() const { return first_.load(std::memory_order_relaxed); }

 private:
  std::atomic<std::int64_t> first_;
};

inline constexpr double too_far = 1e100;  ///< a change whose square may not be finite: the iteration is lost

/// Calls f(block, size, node) for every part of an element's unknowns, in their order: its nodes, then, with node -1,
/// the rows of a joint (index in Plan::joints, or -1). block -1: no unknowns of the system.
template <class F>
void for_each_part(const plan::Plan& plan, std::size_t element, int joint, F&& f) {
  plan::with_element(plan.elements, plan.directory[element], [&](const auto& e) {
    for (const elements::Port& p : e.ports)
      if (p.node != elements::ground)
        f(plan.block_of_node[static_cast<std::size_t>(p.node)], plan.unknowns.count, p.node);
  });
  if (joint < 0) return;
  const plan::JointPlan& j = plan.joints[static_cast<std::size_t>(joint)];
  if (!j.rows.empty()) f(j.block, static_cast<int>(j.rows.size()), -1);
}

/// Entries of an element's residual and of its magnitude in the order of System::parts_: for its nodes, of
/// `node_unknowns` each, and its rows.
template <class S>
void join_parts(int node_unknowns, int num_unknowns, int num_rows, const S* residual, const S* magnitude, S* parts) {
  const int forces = num_unknowns - num_rows;
  for (int begin = 0, end = 0; begin < num_unknowns; begin = end) {
    end = begin < forces ? begin + node_unknowns : num_unknowns;
    for (int i = begin; i < end; ++i) *parts++ = residual[i];
    for (int i = begin; i < end; ++i) *parts++ = magnitude[i];
  }
}

/// The multipliers that an element on the group G of a joint takes: in space of all rows, in a plane of those that
/// are kept there, which `scratch` takes.
template <class G>
const double* multipliers_on(const plan::JointPlan& joint, const State& state, double* scratch) {
  const double* from = state.multipliers.data() + joint.multiplier_begin;
  if constexpr (std::is_same_v<G, motion::Se3>) return from;
  for (std::size_t r = 0; r < joint.rows.size(); ++r) scratch[r] = from[joint.rows[r]];
  return scratch;
}

/// Calls f(joint, multiplier, unknown, row) for every multiplier that is an unknown: its place in State::multipliers
/// and in the solver's vectors, and its number among the rows of the joint.
template <class F>
void for_each_multiplier(const System& system, F&& f) {
  const plan::Plan& plan = system.plan();
  for (std::size_t j = 0; j < plan.joints.size(); ++j) {
    const int block = plan.joints[j].block;
    if (block < 0) continue;
    const std::vector<int>& rows = plan.joints[j].rows;
    const auto multiplier = static_cast<std::size_t>(plan.joints[j].multiplier_begin);
    const auto unknown = static_cast<std::size_t>(system.block_begin(block));
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const auto row = static_cast<std::size_t>(rows[i]);
      f(static_cast<int>(j), multiplier + row, unknown + i, row);
    }
  }
}

/// The order that missed least, of equal ones the lowest.
inline int least_missed(const Workspace::Misses& misses) {
  return static_cast<int>(std::min_element(misses.begin(), misses.end()) - misses.begin());
}

}  // namespace bough::step
