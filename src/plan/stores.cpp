#include "bough/plan/stores.hpp"

namespace bough::plan {

namespace {

const SignalPlan* signal_at(const Plan& plan, int law) {
  const int s = law < 0 ? -1 : plan.signal_of_law[static_cast<std::size_t>(law)];
  return s < 0 ? nullptr : &plan.signals[static_cast<std::size_t>(s)];
}

}  // namespace

const elements::Joint& joint_element(const Plan& plan, int joint) {
  const int element = plan.joints[static_cast<std::size_t>(joint)].element;
  return array_of<elements::Joint>(
      plan.elements)[static_cast<std::size_t>(plan.directory[static_cast<std::size_t>(element)].index)];
}

std::vector<EnergyStore> energy_stores(const Plan& plan) {
  std::vector<EnergyStore> stores;
  if (plan.signals.empty()) return stores;
  for (int j = 0; j < static_cast<int>(plan.joints.size()); ++j) {
    const elements::Joint& joint = joint_element(plan, j);
    for (int k = 0; k < joint.num_efforts; ++k) {
      const elements::Effort& effort = joint.efforts[k];
      const SignalPlan* force = signal_at(plan, effort.law);
      if (force == nullptr || force->rule != SignalRule::function) continue;
      const SignalPlan* read = signal_at(plan, force->inputs.front());
      if (read != nullptr && read->rule == SignalRule::coordinate && read->joint == j &&
          read->reading.efforts[0].coordinate == effort.coordinate)
        stores.push_back({j, k, force->function.integral(effort.rest)});
    }
  }
  return stores;
}

}  // namespace bough::plan
