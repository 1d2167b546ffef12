#pragma once
/// Residuals of elements in space in the unknowns of a reduced model: P f, P of each node (plan::NodeUnknowns), and the
/// rows of joints that are unknowns. Internal to step.
#include "element_parts.hpp"

namespace bough::step {

/// Reduces the residual of an element, in six unknowns a node and all rows. joint: of the element, or null.
template <class E>
void reduce_vector(const plan::NodeUnknowns& unknowns, const E& e, const plan::JointPlan* joint, const double* from,
                   double* to) {
  for (const elements::Port& port : e.ports) {
    if (port.node == elements::ground) continue;
    motion::Vec6<double> wrench;
    for (int i = 0; i < 6; ++i) wrench[i] = *from++;
    unknowns.project(wrench, static_cast<std::size_t>(port.node), to);
    to += unknowns.count;
  }
  if (joint == nullptr) return;
  for (const int row : joint->rows) *to++ = from[row];
}

}  // namespace bough::step
