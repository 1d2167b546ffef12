#pragma once
/// Efforts of joints that store their energy.
#include <vector>

#include "bough/plan/plan.hpp"

namespace bough::plan {

/// All efforts of this kind, in the order of joints (Plan::energy_stores). Allocates.
std::vector<EnergyStore> energy_stores(const Plan& plan);

/// The joint's element in space.
const elements::Joint& joint_element(const Plan& plan, int joint);

}  // namespace bough::plan
