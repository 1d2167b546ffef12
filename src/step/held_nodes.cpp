#include "held_nodes.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "element_parts.hpp"

namespace bough::step {

using motion::Vec6;

HeldNodes::HeldNodes(const plan::Plan& plan, const TrimmedElements& trimmed) : plan_(plan) {
  std::vector<int> held_of_node(plan.nodes.size(), -1);
  for (std::size_t h = 0; h < plan.held.size(); ++h)
    held_of_node[static_cast<std::size_t>(plan.held[h].node)] = static_cast<int>(h);
  uses_.resize(plan.held.size());
  for (std::size_t e = 0; e < plan.directory.size(); ++e) {
    if (trimmed.leaves_out(e)) continue;
    int part = 0;
    for_each_part(plan, e, [&](int, int, int node) {
      const int held = node < 0 ? -1 : held_of_node[static_cast<std::size_t>(node)];
      if (held >= 0) uses_[static_cast<std::size_t>(held)].push_back({e, part});
      ++part;
    });
  }
}

/// Solves the balance of one held node for its multipliers. add_forces(use, node, forces) adds the forces of an
/// attached element, in the node's own axes, to `forces`.
template <class AddForces>
void HeldNodes::balance(std::size_t held, Vec6<double> forces, AddForces&& add_forces, double* multipliers) const {
  const plan::HeldNode& h = plan_.held[held];
  for (const Use& use : uses_[held]) add_forces(use, h.node, forces);
  const auto n = static_cast<std::size_t>(plan_.unknowns.count_of(static_cast<std::size_t>(h.node)));
  std::array<double, 6> wrench;
  plan_.unknowns.project(forces, static_cast<std::size_t>(h.node), wrench.data());
  for (std::size_t i = 0; i < n; ++i) {
    multipliers[i] = 0.0;
    for (std::size_t k = 0; k < n; ++k) multipliers[i] -= h.inverse[i * n + k] * wrench[k];
  }
}

template <class G>
void HeldNodes::recover_on(const elements::FieldOn<G, double>& field, const tree::Walker& walker, State& state,
                           const Vec6List* more) const {
  const bool is_settled = state.unsettled.empty();
  const auto add_forces = [&](const Use& use, int node, Vec6<double>& forces) {
    std::array<double, elements::max_rows> scratch;
    std::array<double, most_unknowns> residual;
    const int j = plan_.joint_of_element[use.element];
    const double* multipliers =
        j < 0 ? nullptr : multipliers_on<G>(plan_.joints[static_cast<std::size_t>(j)], state, scratch.data());
    const double turns = j < 0 ? 0.0 : state.turns[static_cast<std::size_t>(j)];
    plan::with_element(plan::arrays_on<G>(plan_), plan_.directory[use.element], [&](const auto& e) {
      if constexpr (std::is_same_v<G, motion::Se3>) {
        std::array<double, most_unknowns * most_unknowns> tangent;
        elements::evaluate(e, field, multipliers, turns, residual.data(), is_settled ? nullptr : tangent.data());
        for (int i = 0; i < 6; ++i) forces[i] += residual[static_cast<std::size_t>(6 * use.part + i)];
        const auto lacking = [&](int other) { return state.unsettled[static_cast<std::size_t>(other)]; };
        if (!is_settled) elements::add_tangent_times(e, tangent.data(), 6 * use.part, 6, lacking, forces.v);
      } else {
        elements::evaluate(e, field, multipliers, turns, residual.data(), nullptr);
        forces += plan_.unknowns.expanded(residual.data() + G::dof * use.part, static_cast<std::size_t>(node));
      }
    });
  };
  auto by_node = [&](std::int64_t begin, std::int64_t end) {
    for (auto h = static_cast<std::size_t>(begin); h < static_cast<std::size_t>(end); ++h) {
      std::array<double, 6> multipliers;
      const Vec6<double> given =
          more == nullptr ? Vec6<double>::zero() : (*more)[static_cast<std::size_t>(plan_.held[h].node)];
      balance(h, given, add_forces, multipliers.data());
      std::size_t k = 0;
      for (int j : plan_.held[h].joints) {
        const plan::JointPlan& joint = plan_.joints[static_cast<std::size_t>(j)];
        for (int row : joint.rows)
          state.multipliers[static_cast<std::size_t>(joint.multiplier_begin + row)] = multipliers[k++];
      }
    }
  };
  walker.for_each_chunk(static_cast<std::int64_t>(plan_.held.size()), element_grain, tree::make_chunk(by_node));
}

void HeldNodes::recover_multipliers(const Instant& instant, const tree::Walker& walker, State& state,
                                    const Vec6List* more) const {
  if (!plan_.is_dynamic) return recover_on<motion::Se3>(instant.field(state), walker, state, more);
  state.visit([&]<class G>(const NodesOn<G>&) { recover_on<G>(instant.field_on<G>(state), walker, state, more); });
}

double HeldNodes::largest_impulse(const Instant& instant, const UnknownPlaces& places, const State& state,
                                  const double* x) const {
  const elements::Field field = instant.field(state, {0.0, 0.0, true});
  const auto add_forces = [&](const Use& use, int, Vec6<double>& forces) {
    std::array<double, most_unknowns> residual;
    std::array<double, most_unknowns * most_unknowns> tangent;
    const int j = plan_.joint_of_element[use.element];
    const plan::JointPlan* joint = j < 0 ? nullptr : &plan_.joints[static_cast<std::size_t>(j)];
    plan::with_element(plan_.elements, plan_.directory[use.element], [&](const auto& e) {
      elements::evaluate(e, field, joint == nullptr ? nullptr : state.multipliers.data() + joint->multiplier_begin,
                         j < 0 ? 0.0 : state.turns[static_cast<std::size_t>(j)], residual.data(), tangent.data());
      elements::add_tangent_times(
          e, tangent.data(), 6 * use.part, 6, [&](int node) { return places.node_part(x, node); }, forces.v);
      if (joint == nullptr || joint->block < 0) return;
      const int n = elements::num_unknowns(e), first_row = n - elements::num_multipliers(e);
      for (std::size_t k = 0; k < joint->rows.size(); ++k)
        for (int i = 0; i < 6; ++i)
          forces[i] += tangent[static_cast<std::size_t>((6 * use.part + i) * n + first_row + joint->rows[k])] *
                       x[places.block_begin(joint->block) + static_cast<std::int64_t>(k)];
    });
  };
  double most = 0.0;
  for (std::size_t h = 0; h < plan_.held.size(); ++h) {
    std::array<double, 6> impulses;
    balance(h, Vec6<double>::zero(), add_forces, impulses.data());
    for (int i = 0; i < plan_.unknowns.count_of(static_cast<std::size_t>(plan_.held[h].node)); ++i)
      most = std::max(most, std::abs(impulses[static_cast<std::size_t>(i)]));
  }
  return most;
}

}  // namespace bough::step
