#pragma once
/// For tests of single decisions of a plan.
#include <stdexcept>
#include <string>

#include "bough/plan/plan.hpp"

namespace bough::test {

inline const plan::Decision& decision_of(const plan::Plan& p, const std::string& name) {
  for (const plan::Decision& d : p.decisions)
    if (d.name == name) return d;
  throw std::runtime_error("no decision '" + name + "'");
}

inline scene::Joint joint_to_ground(scene::JointKind kind, const std::string& node) {
  scene::Joint j;
  j.name = "to ground of " + node;
  j.kind = kind;
  j.second.to = node;
  return j;
}

}  // namespace bough::test
