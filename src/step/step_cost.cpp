#include "bough/step/step_cost.hpp"

#include <type_traits>
#include <vector>

#include "element_parts.hpp"

namespace bough::step {

namespace {

// Fitted by hand to the phases of steps of chains, cantilevers and lattices (bench_step, bench_lean). The costs of
// elements are those of the machine of src/elements/README.md.
/// Costs of a tangent and of moving a node in time, relative to those in space, as elements::residual_part.
template <class G>
constexpr double tangent_part = 1.0;
template <class G>
constexpr double node_part = 1.0;
template <>
constexpr double tangent_part<motion::Se2> = 0.15;
template <>
constexpr double node_part<motion::Se2> = 0.14;
template <>
constexpr double tangent_part<motion::Translations<3>> = 0.14;
template <>
constexpr double tangent_part<motion::Translations<1>> = 0.04;
template <int N>
constexpr double node_part<motion::Translations<N>> = 0.16;
constexpr double per_sum = 20e-9;   ///< gathering, summing and measuring residuals, per element and evaluation [s]
constexpr double per_node = 90e-9;  ///< moving a node with its velocity and acceleration, per iteration [s]
constexpr double per_front_lanes = 1.6e-7, per_flop_lanes = 2.5e-11;
constexpr double per_front = 1.7e-6, per_flop = 4.8e-11;
constexpr double per_flop_of_others = 1.1e-9;  ///< time per flop of monolithic solvers
// Time of a solution [s]: per front eliminated alone, and per byte of factors and element matrices, which come from
// memory if they do not fit into the caches.
constexpr double per_front_solved = 1.5e-7, per_byte_near = 1.1e-11, per_byte_far = 5e-11;
constexpr double bytes_near = 16e6;
// Per dependent row, from N windows of four-bars in space, N = 40 to 160: the front in which its loop closes is
// factored with pivoting, and its null vectors are computed; least multipliers and consistent right-hand sides.
constexpr double per_dependent_row = 5e-6, per_dependent_row_solved = 7e-7;

/// Elements of one kind are evaluated eight at a time where there are at least `least_lanes` of them. How they are put
/// together depends on the number of threads, of which the cost must not depend, since it decides on factorizations.
template <class G>
void add_elements(const plan::Plan& plan, StepCost& cost) {
  std::vector<int> present;  // by array of elements
  std::vector<std::size_t> first;
  for (std::size_t e = 0; e < plan.directory.size(); ++e) {
    const auto array = static_cast<std::size_t>(plan.directory[e].array);
    if (plan.graph.element_begin[e] == plan.graph.element_begin[e + 1]) continue;  // no unknown sees it
    if (is_idle_joint(plan, plan.joint_of_element[e])) continue;
    if (array >= present.size()) {
      present.resize(array + 1, 0);
      first.resize(array + 1, 0);
    }
    if (present[array]++ == 0) first[array] = e;
  }
  for (std::size_t array = 0; array < present.size(); ++array) {
    if (present[array] == 0) continue;
    plan::with_element(plan.elements, plan.directory[first[array]], [&](const auto& element) {
      const elements::Cost& c = std::decay_t<decltype(element)>::cost;
      const bool in_lanes = present[array] >= least_lanes;
      const int packs = (present[array] + solve::lanes_wide - 1) / solve::lanes_wide;
      const double count = in_lanes ? packs * solve::lanes_wide : present[array], sums = present[array] * per_sum;
      cost.residual += elements::residual_part<G> * count * (in_lanes ? c.lane : c.alone) + sums;
      cost.tangent += tangent_part<G> * count * (in_lanes ? c.lane_tangent : c.alone_tangent) + sums;
    });
  }
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
StepCost estimate_on(const System& system) {
  const plan::Plan& plan = system.plan();
  StepCost cost;
  add_elements<G>(plan, cost);
  const solve::SolverCounters counters = system.linear().solver().counters();
  const auto bytes = static_cast<double>(counters.memory_bytes);
  double alone = 0.0;      // fronts
  double dependent = 0.0;  // rows
  if (system.linear().solver().hierarchical() != nullptr) {
    const auto in_lanes = static_cast<double>(counters.fronts_in_lanes);
    dependent = expected_dependent_rows<G>(plan);
    alone = system.linear().tree().num_fronts() - in_lanes;
    cost.factor = in_lanes * per_front_lanes + alone * per_front + counters.flops_in_lanes * per_flop_lanes +
                  (counters.factor_flops - counters.flops_in_lanes) * per_flop + dependent * per_dependent_row;
  } else {
    cost.factor = system.linear().tree().subdomains.back().subtree_flops * per_flop_of_others;
  }
  cost.solve = alone * per_front_solved + bytes * (bytes < bytes_near ? per_byte_near : per_byte_far) +
               dependent * per_dependent_row_solved;
  cost.update = static_cast<double>(plan.nodes.size()) * per_node * (plan.is_dynamic ? node_part<G> : 1.0);
  return cost;
}

}  // namespace

StepCost estimate_step_cost(const System& system) {
  return system.plan().with_group([&]<class G>() { return estimate_on<G>(system); });
}

}  // namespace bough::step
