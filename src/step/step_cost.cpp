#include "bough/step/step_cost.hpp"

#include <type_traits>

#include "bough/plan/element_cost.hpp"
#include "system_parts.hpp"

namespace bough::step {

namespace {

// Fitted by hand to runs of chains and lattices on the machine of src/elements/README.md.
constexpr double planar_share = 0.45;  ///< of an element in space
constexpr double per_sum = 55e-9;      ///< gathering, adding and sizing up, an element and evaluation [s]
constexpr double per_node = 110e-9;    ///< moving a node with its velocity and acceleration, an iteration [s]
constexpr double per_front_lanes = 3.5e-6 / solve::lanes_wide, per_flop_lanes = 3.6e-10 / solve::lanes_wide;
constexpr double per_front = 1.5e-6, per_flop = 1.1e-10;
constexpr double per_flop_of_others = 10.0 * per_flop;  ///< of monolithic solvers
constexpr double per_byte = 6e-11;  ///< of factor and element matrices, a solution and its check [s]

void add_elements(const plan::Plan& plan, const solve::ElementBatch& batch, StepCost& cost) {
  int present = 0, first = -1;
  for (int id : batch.element) {
    if (id < 0) continue;
    ++present;
    first = first < 0 ? id : first;
  }
  if (first < 0) return;
  const bool in_lanes = batch.stride == solve::lanes_wide && present >= least_lanes;
  plan::with_element(plan.elements, plan.directory[static_cast<std::size_t>(first)], [&](const auto& element) {
    const plan::ElementCost& c = plan::cost<std::decay_t<decltype(element)>>;
    const double count = (plan.planar ? planar_share : 1.0) * (in_lanes ? solve::lanes_wide : present),
                 sums = present * per_sum;
    cost.residual += count * (in_lanes ? c.lane : c.alone) + sums;
    cost.tangent += count * (in_lanes ? c.lane_tangent : c.alone_tangent) + sums;
  });
}

}  // namespace

StepCost estimate_step_cost(const plan::Plan& plan, const tree::Tree& tree, const solve::AnySolver& solver) {
  StepCost cost;
  for (const solve::ElementBatch& batch : solver.batches()) add_elements(plan, batch, cost);
  const solve::SolverCounters counters = solver.counters();
  if (solver.hierarchical() != nullptr) {
    const auto in_lanes = static_cast<double>(counters.fronts_in_lanes);
    cost.factor = in_lanes * per_front_lanes + (tree.num_fronts() - in_lanes) * per_front +
                  counters.flops_in_lanes * per_flop_lanes +
                  (counters.factor_flops - counters.flops_in_lanes) * per_flop;
  } else {
    cost.factor = tree.subdomains.back().subtree_flops * per_flop_of_others;
  }
  cost.solve = per_byte * static_cast<double>(counters.memory_bytes);
  cost.update = static_cast<double>(plan.nodes.size()) * per_node;
  return cost;
}

}  // namespace bough::step
