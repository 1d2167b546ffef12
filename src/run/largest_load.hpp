#pragma once
#include <string>

#include "bough/plan/plan.hpp"

namespace bough::run {

/// "the largest load is 'push', 1e+09 N at 'tip'". Compares point loads, line loads over the length of their beam, and
/// the weight of `mass` [kg], with their laws at a load factor; moments are divided by the size of the structure.
/// Without loads it names the first prescribed motion or drive. Empty if nothing acts.
std::string largest_load(const scene::Scene& scene, const plan::Plan& plan, double load_factor, double mass);

}  // namespace bough::run
