#include "bough/step/step_cost.hpp"

#include <algorithm>
#include <type_traits>

#include "bough/solve/front_cost.hpp"
#include "evaluation_work.hpp"

namespace bough::step {

namespace {

// Fitted to parts of steps that were timed one by one, in memory, at the last state of a run of every scene of
// data/gallery and data/scenarios, of rod_chain with 8 to 2048 links and of the lattice with 4 to 73 nodes a side.
// Logarithms of predicted over measured were made small.

/// Costs of elements relative to elements::Cost, which is that of loops over one element: in steps, lanes are gathered
/// and scattered.
struct KernelParts {
  double lanes, alone, lanes_tangent, alone_tangent;
};
template <class G>
constexpr KernelParts kernel_parts{1.45, 0.56, 1.5, 0.57};
template <>
constexpr KernelParts kernel_parts<motion::Se2>{0.36, 0.2, 0.26, 0.14};
template <int N>
constexpr KernelParts kernel_parts<motion::Translations<N>>{0.16, 0.16, 0.1, 0.1};
constexpr double kernels_at_rest = 0.52;  ///< part of it without velocities
constexpr double per_evaluation = 1.7e-7, per_sum = 1e-8, per_sum_tangent = 2.8e-8, per_signal = 2.2e-7;

constexpr double symmetric_alone = 1.4;  ///< pairs of pivots are searched for, and half of the entries are not there
constexpr double per_flop_of_others = 1.1e-9;  ///< time per flop of monolithic solvers

// Factors and element matrices that do not fit into the caches come from memory.
constexpr double per_solution = 1e-7, per_pack_solved = 2e-8, per_byte_far = 5.9e-11;
constexpr double bytes_near = 16e6;
/// Elements and nodes of a structure of that size come from memory, too; per byte of its solver.
constexpr double residual_far = 1.5e-11, tangent_far = 3.3e-11, update_far = 2e-11;
// Per dependent row, from N windows of four-bars in space, N = 40 to 160: the front in which its loop closes is
// factored with pivoting, and its null vectors are computed; least multipliers and consistent right-hand sides.
constexpr double per_dependent_row = 5e-6, per_dependent_row_solved = 7e-7, dependence_solved = 2.5e-6;
constexpr double per_unknown_checked = 2e-8, per_element_checked = 6e-9;

/// Nodes that move, their elements measured, and what is done once a step.
struct NodeCosts {
  double update, measure, end;
};
template <class G>
constexpr NodeCosts node_costs{1.6e-8, 5e-9, 3.5e-8};
template <>
constexpr NodeCosts node_costs<motion::Se3>{3.6e-8, 3.2e-8, 8e-8};
template <int N>
constexpr NodeCosts node_costs<motion::Translations<N>>{3e-9, 0.0, 1.5e-8};
constexpr double per_update = 1.4e-7, per_step = 6e-7, per_element_of_step = 6e-9;
constexpr NodeCosts node_costs_at_rest{1.6e-7, 0.0, 9e-7};
constexpr double per_update_at_rest = 3.5e-6;

template <class G>
void add_elements(const plan::Plan& plan, StepCost& cost) {
  const KernelParts& part = kernel_parts<G>;
  double elements = 0.0;
  for (const EvaluationWork& work : count_evaluations(plan)) {
    elements += work.elements;
    const double in_lanes = work.packs * solve::lanes_wide;
    plan::with_element(plan.elements, plan.directory[work.first], [&](const auto& element) {
      const elements::Cost& c = std::decay_t<decltype(element)>::cost;
      cost.residual += part.lanes * in_lanes * c.lane + part.alone * work.alone * c.alone;
      cost.tangent +=
          part.lanes_tangent * in_lanes * c.lane_tangent + part.alone_tangent * work.alone * c.alone_tangent;
    });
  }
  const double kernels = plan.is_dynamic || !plan.frames.empty() ? 1.0 : kernels_at_rest,
               others = per_evaluation + per_signal * static_cast<double>(plan.num_driving_signals);
  cost.residual = kernels * cost.residual + per_sum * elements + others;
  cost.tangent = kernels * cost.tangent + per_sum_tangent * elements + others;
}

/// Constraint rows that depend on others, from the numbers of freedoms and of conditions that close loops. Groups of
/// planar motions and of translations leave them out, and beams give way, so that their rows are independent.
template <class G>
int expected_dependent_rows(const plan::Plan& plan) {
  int rows = 0;
  if (!std::is_same_v<G, motion::Se3>) return rows;
  for (const plan::MobilityPart& part : plan.mobility.parts)
    if (!part.has_beams) rows += part.closing_rows - part.rank;
  return rows;
}

template <class G>
void add_solver(const System& system, StepCost& cost) {
  const LinearSolution& linear = system.linear();
  const solve::SolverCounters c = linear.solver().counters();
  const auto memory = static_cast<double>(c.memory_bytes);
  const double bytes_far = std::max(0.0, memory - bytes_near), far = per_byte_far * bytes_far;
  cost.residual += residual_far * bytes_far;
  cost.tangent += tangent_far * bytes_far;
  cost.update += update_far * bytes_far;
  cost.check = per_unknown_checked * static_cast<double>(linear.tree().num_unknowns()) +
               per_element_checked * system.plan().graph.num_elements() + far;
  if (linear.solver().hierarchical() == nullptr) {
    cost.factor = linear.tree().subdomains.back().subtree_flops * per_flop_of_others;
    cost.solve = per_solution + solve::front_cost::per_byte_solved * memory + far;
    return;
  }
  const double dependent = expected_dependent_rows<G>(system.plan());
  const auto packs = static_cast<double>(c.packs_of_fronts);
  const double alone = static_cast<double>(linear.tree().num_fronts() - c.fronts_in_lanes);
  const double fronts_alone = solve::front_cost::per_column * c.columns_alone +
                              solve::front_cost::per_panel * c.panels_alone +
                              solve::front_cost::per_flop * (c.factor_flops - c.flops_in_lanes);
  cost.factor = solve::front_cost::per_pack * packs + solve::front_cost::per_flop_of_pack * c.flops_of_packs +
                per_dependent_row * dependent + (linear.takes_symmetric_parts() ? symmetric_alone : 1.0) * fronts_alone;
  cost.solve = per_solution + per_pack_solved * packs + solve::front_cost::per_front_solved * alone +
               solve::front_cost::per_byte_solved * static_cast<double>(c.factor_bytes) + far +
               per_dependent_row_solved * dependent + (dependent > 0.0 ? dependence_solved : 0.0);
}

template <class G>
void add_nodes(const plan::Plan& plan, StepCost& cost) {
  const auto nodes = static_cast<double>(plan.nodes.size()), elements = static_cast<double>(plan.directory.size());
  const NodeCosts& of_node = plan.is_dynamic ? node_costs<G> : node_costs_at_rest;
  cost.update =
      (plan.is_dynamic ? per_update : per_update_at_rest) + of_node.update * nodes + of_node.measure * elements;
  cost.end = per_step + of_node.end * nodes + per_element_of_step * elements;
}

}  // namespace

StepCost estimate_step_cost(const System& system) {
  return system.plan().with_group([&]<class G>() {
    StepCost cost;
    add_elements<G>(system.plan(), cost);
    add_solver<G>(system, cost);
    add_nodes<G>(system.plan(), cost);
    return cost;
  });
}

}  // namespace bough::step
