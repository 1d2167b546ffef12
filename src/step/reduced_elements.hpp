#pragma once
/// Elements in space where a node has fewer than six unknowns: residuals P f and tangents P K P^T, P of each node
/// (plan::NodeUnknowns) and the rows of joints that are unknowns. Internal to step.
#include <array>
#include <cmath>
#include <vector>

#include "element_parts.hpp"

namespace bough::step {

/// Whether elements are in space while nodes have fewer than six unknowns.
inline bool are_elements_reduced(const plan::Plan& plan) { return !plan.unknowns.is_whole() && !plan.planar; }
/// Whether an element is a joint none of whose rows is an unknown, in a scene whose nodes do not turn: it neither
/// pushes nor pulls on its nodes.
inline bool is_idle_joint(const plan::Plan& plan, int joint) {
  return joint >= 0 && are_elements_reduced(plan) && plan.joints[static_cast<std::size_t>(joint)].rows.empty();
}

/// Calls node(n, begin) for every node of an element off the ground, its entries in six unknowns a node beginning at
/// `begin`, then row(k) for every entry k of a row of constraints that is an unknown. joint: of the element, or null.
template <class E, class Node, class Row>
void for_each_reduced(const E& e, const plan::JointPlan* joint, Node&& node, Row&& row) {
  int begin = 0;
  for (const elements::Port& port : e.ports) {
    if (port.node == elements::ground) continue;
    node(static_cast<std::size_t>(port.node), begin);
    begin += 6;
  }
  if (joint == nullptr) return;
  for (const int k : joint->rows) row(begin + k);
}

inline motion::Vec6<double> six_of(const double* from) {
  motion::Vec6<double> v;
  for (int i = 0; i < 6; ++i) v[i] = from[i];
  return v;
}

/// P f of an element's residual in six unknowns a node and all rows. Returns its size.
template <class E>
int reduce_vector(const plan::NodeUnknowns& unknowns, const E& e, const plan::JointPlan* joint, const double* from,
                  double* to) {
  double* const begin = to;
  for_each_reduced(
      e, joint,
      [&](std::size_t node, int at) {
        if (unknowns.basis.empty())
          for (int i = 0; i < unknowns.count; ++i) to[i] = from[at + unknowns.component[static_cast<std::size_t>(i)]];
        else
          unknowns.project(six_of(from + at), node, to);
        to += unknowns.count;
      },
      [&](int at) { *to++ = from[at]; });
  return static_cast<int>(to - begin);
}

/// |P| f of sizes: no smaller than the size of P f.
template <class E>
void reduce_sizes(const plan::NodeUnknowns& unknowns, const E& e, const plan::JointPlan* joint, const double* from,
                  double* to) {
  for_each_reduced(
      e, joint,
      [&](std::size_t node, int at) {
        for (int i = 0; i < unknowns.count; ++i) {
          const int component = unknowns.component[static_cast<std::size_t>(i)], part = component / 3 * 3;
          double sum = from[at + component];
          if (!unknowns.basis.empty()) {
            sum = 0.0;
            for (int k = 0; k < 3; ++k)
              sum += std::abs(unknowns.basis[node](k, component - part)) * from[at + part + k];
          }
          *to++ = sum;
        }
      },
      [&](int at) { *to++ = from[at]; });
}

/// P K P^T where P takes entries as they are, both row-major. Returns its size.
template <class E>
int select_matrix(const plan::NodeUnknowns& unknowns, const E& e, const plan::JointPlan* joint, const double* from,
                  double* to) {
  const int whole = elements::num_unknowns(e);
  std::array<int, most_unknowns> kept;
  int n = 0;
  for_each_reduced(
      e, joint,
      [&](std::size_t, int at) {
        for (int i = 0; i < unknowns.count; ++i)
          kept[static_cast<std::size_t>(n++)] = at + unknowns.component[static_cast<std::size_t>(i)];
      },
      [&](int at) { kept[static_cast<std::size_t>(n++)] = at; });
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      *to++ = from[kept[static_cast<std::size_t>(i)] * whole + kept[static_cast<std::size_t>(j)]];
  return n;
}

/// The same whatever P is.
template <class E>
int reduce_matrix(const plan::NodeUnknowns& unknowns, const E& e, const plan::JointPlan* joint, const double* from,
                  double* to) {
  const int whole = elements::num_unknowns(e);
  if (unknowns.basis.empty()) return select_matrix(unknowns, e, joint, from, to);
  std::array<double, most_unknowns * most_unknowns> columns;  // K P^T, column by column
  std::array<double, most_unknowns> reduced;
  int n = 0;
  for (int i = 0; i < whole; ++i) {
    n = reduce_vector(unknowns, e, joint, from + i * whole, reduced.data());
    for (int j = 0; j < n; ++j) columns[static_cast<std::size_t>(j * whole + i)] = reduced[static_cast<std::size_t>(j)];
  }
  for (int j = 0; j < n; ++j) {
    reduce_vector(unknowns, e, joint, columns.data() + j * whole, reduced.data());
    for (int i = 0; i < n; ++i) to[i * n + j] = reduced[static_cast<std::size_t>(i)];
  }
  return n;
}

}  // namespace bough::step
