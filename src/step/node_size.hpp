#pragma once
/// Sizes of the force and the moment at a node, from the entries of its unknowns. Internal to step.
#include <algorithm>
#include <cmath>

#include "bough/plan/unknowns.hpp"

namespace bough::step {

inline double largest_of_three(const double* a) {
  return std::max(std::max(std::abs(a[0]), std::abs(a[1])), std::abs(a[2]));
}

struct NodeSize {
  double force, moment;
};
/// Largest entries of the force and the moment at a node.
inline NodeSize size_up(plan::Motions motions, const double* a) {
  switch (motions) {
    case plan::Motions::spatial:
      return {largest_of_three(a), largest_of_three(a + 3)};
    case plan::Motions::planar:
      return {std::max(std::abs(a[0]), std::abs(a[1])), std::abs(a[2])};
    case plan::Motions::translation:
      return {largest_of_three(a), 0.0};
    case plan::Motions::line:
      break;
  }
  return {std::abs(a[0]), 0.0};
}
/// The same for a certain node, which may be a point.
inline NodeSize size_up(const plan::NodeUnknowns& unknowns, std::size_t node, const double* a) {
  if (!unknowns.is_point_at(node)) return size_up(unknowns.motions, a);
  double most = 0.0;
  for (int i = 0; i < unknowns.translations(); ++i) most = std::max(most, std::abs(a[i]));
  return {most, 0.0};
}

}  // namespace bough::step
