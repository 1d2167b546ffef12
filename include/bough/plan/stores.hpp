#pragma once
/// Efforts of joints that store their energy.
#include <vector>

#include "bough/plan/plan.hpp"

namespace bough::plan {

/// An effort of a joint that is a law f(q) of the coordinate q along which it acts, as a spring with a table is: a
/// signal of kind "function" of a signal that reads q. It has the energy
///   U(q) = -int_rest^q f(s) ds     [J], rest and f being those of the effort.
struct EnergyStore {
  int joint = -1;      ///< index in Plan::joints
  int effort = -1;     ///< index in the efforts of the joint's element
  laws::Law supplied;  ///< -U, over q; a formula's values are quadratures to round-off
};

/// All efforts of this kind, in the order of joints. Allocates.
std::vector<EnergyStore> energy_stores(const Plan& plan);

/// The joint's element in space.
const elements::Joint& joint_element(const Plan& plan, int joint);

}  // namespace bough::plan
