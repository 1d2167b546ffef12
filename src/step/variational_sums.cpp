/// Momenta and forces of a state, summed by node, and its constraint rows.
#include <cmath>

#include "element_parts.hpp"
#include "variational_on.hpp"

namespace bough::step {

template <class G>
MomentumSums<G>::MomentumSums(const plan::Plan& plan) {
  const std::size_t num_nodes = plan.nodes.size();
  std::vector<std::vector<std::int64_t>> uses(num_nodes);
  begin_.assign(1, 0);
  for (const plan::ElementPlace place : plan.directory) {
    std::int64_t at = begin_.back();
    plan::with_element(plan.elements, place, [&](const auto& e) {
      for (const elements::Port& port : e.ports) {
        if (port.node == elements::ground) continue;
        uses[static_cast<std::size_t>(port.node)].push_back(at);
        at += G::dof;
      }
    });
    begin_.push_back(at);
  }
  use_begin_.assign(1, 0);
  for (const auto& list : uses) {
    uses_.insert(uses_.end(), list.begin(), list.end());
    use_begin_.push_back(static_cast<std::int64_t>(uses_.size()));
  }
  momenta_.assign(static_cast<std::size_t>(begin_.back()), 0.0);
  forces_ = momenta_;
  momentum_.assign(num_nodes, Vector::zero());
  force_ = force_size_ = momentum_;
}

template <class G>
std::optional<Trouble> MomentumSums<G>::evaluate(const System& system, const elements::FieldOn<G, double>& field,
                                                 const std::vector<double>& turns, double elastic_inertia, Want want) {
  const plan::Plan& plan = system.plan();
  const bool with_forces = want == Want::forces;
  const tree::Tree& tree = system.linear().tree();
  auto by_element = [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t k = begin; k < end; ++k) {
      const auto id = static_cast<std::size_t>(tree.element_order[static_cast<std::size_t>(k)]);
      if (id >= plan.directory.size()) continue;  // the equation of a signal
      const int joint = system.plan().joint_of_element[static_cast<std::size_t>(id)];
      const auto at = static_cast<std::size_t>(begin_[id]);
      plan::with_element(plan::arrays_on<G>(plan), plan.directory[id], [&](const auto& e) {
        elements::evaluate_momentum(e, field, joint < 0 ? 0.0 : turns[static_cast<std::size_t>(joint)], elastic_inertia,
                                    momenta_.data() + at, with_forces ? forces_.data() + at : nullptr);
      });
    }
  };
  system.walker().for_each_chunk(static_cast<std::int64_t>(tree.element_order.size()), element_grain,
                                 tree::make_chunk(by_element));
  auto by_node = [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t n = begin; n < end; ++n) {
      const auto node = static_cast<std::size_t>(n);
      Vector P = Vector::zero(), F = P, size = P;
      for (std::int64_t u = use_begin_[node]; u < use_begin_[node + 1]; ++u) {
        const auto at = static_cast<std::size_t>(uses_[static_cast<std::size_t>(u)]);
        for (int i = 0; i < G::dof; ++i) P[i] += momenta_[at + static_cast<std::size_t>(i)];
        for (int i = 0; i < G::dof && with_forces; ++i) {
          F[i] += forces_[at + static_cast<std::size_t>(i)];
          size[i] += std::abs(forces_[at + static_cast<std::size_t>(i)]);
        }
      }
      momentum_[node] = P;
      if (!with_forces) continue;
      force_[node] = F;
      force_size_[node] = size;
    }
  };
  system.walker().for_each_chunk(static_cast<std::int64_t>(plan.nodes.size()), block_grain, tree::make_chunk(by_node));
  for (std::size_t n = 0; n < plan.nodes.size(); ++n)
    for (int i = 0; i < G::dof; ++i)
      if (!std::isfinite(momentum_[n][i]) || (with_forces && !std::isfinite(force_[n][i])))
        return Trouble{"the forces at '" + plan.nodes[n].name + "' are not finite"};
  return std::nullopt;
}

template <class G>
ConstraintRows<G>::ConstraintRows(const plan::Plan& plan) {
  std::size_t at = 0, values = 0;
  place_of_element_.assign(plan.directory.size(), -1);
  for (const plan::JointPlan& j : plan.joints) {
    if (j.block < 0) continue;
    place_of_element_[static_cast<std::size_t>(j.element)] = static_cast<int>(places_.size());
    Place p;
    p.element = j.element;
    p.plan = &j;
    p.gradient_begin = at;
    p.value_begin = values;
    p.joint = &std::get<std::vector<elements::JointOn<G>>>(
        plan::arrays_on<G>(plan))[static_cast<std::size_t>(plan.directory[static_cast<std::size_t>(j.element)].index)];
    for (const auto& port : p.joint->ports)
      if (port.node != elements::ground) p.nodes[p.num_nodes++] = port.node;
    at += static_cast<std::size_t>(G::dof * p.num_nodes * p.joint->num_rows);
    values += static_cast<std::size_t>(p.joint->num_rows);
    places_.push_back(p);
  }
  values_.assign(values, 0.0);
  gradients_.assign(at, 0.0);
}

template <class G>
void ConstraintRows<G>::evaluate(const System& system, const elements::FieldOn<G, double>& field,
                                 const std::vector<double>& turns) {
  auto by_joint = [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t k = begin; k < end; ++k) {
      const Place& p = places_[static_cast<std::size_t>(k)];
      const int joint = system.plan().joint_of_element[static_cast<std::size_t>(p.element)];
      elements::evaluate_rows(*p.joint, field, turns[static_cast<std::size_t>(joint)], values_.data() + p.value_begin,
                              gradients_.data() + p.gradient_begin);
    }
  };
  system.walker().for_each_chunk(static_cast<std::int64_t>(places_.size()), element_grain, tree::make_chunk(by_joint));
}

template <class G>
void ConstraintRows<G>::add_forces(const double* multipliers, double factor,
                                   std::vector<typename G::template Vector<double>>& to) const {
  for (const Place& p : places_)
    for (int k = 0; k < p.joint->num_rows; ++k) {
      const double size = factor * multipliers[p.multiplier(k)];
      const double* g = gradient(p, k);
      for (int n = 0; n < p.num_nodes; ++n)
        for (int i = 0; i < G::dof; ++i) to[static_cast<std::size_t>(p.nodes[n])][i] += size * g[G::dof * n + i];
    }
}

#define BOUGH_INSTANTIATE(G)      \
  template class MomentumSums<G>; \
  template class ConstraintRows<G>;
BOUGH_FOR_EVERY_GROUP(BOUGH_INSTANTIATE)
#undef BOUGH_INSTANTIATE

}  // namespace bough::step
