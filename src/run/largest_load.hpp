#pragma once
#include <string>

#include "bough/plan/plan.hpp"

namespace bough::run {

/// "the largest load is 'push', 1e+09 N at 'tip'": of point loads, line loads over the length of their beam and the
/// weight of `mass` [kg], with their laws at a load factor; moments count over the size of the structure. Without any,
/// the first motion or drive that is prescribed. Empty where nothing acts.
std::string largest_load(const scene::Scene& scene, const plan::Plan& plan, double load_factor, double mass);

}  // namespace bough::run
