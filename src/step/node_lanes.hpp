#pragma once
/// Transfers the numbers of eight items between arrays and packs, one item in each lane. Internal to step.
#include "bough/lanes/transpose.hpp"
#include "bough/step/node_order.hpp"
#include "element_parts.hpp"

namespace bough::step {

inline constexpr std::size_t nodes_in_lanes = 8;

/// Loads consecutive numbers of the items of eight nodes, beginning with number `number` of each item.
template <int numbers, class Item>
void gather(const Item* items, const NodeEight& eight, lanes::Pack<nodes_in_lanes>* to, std::size_t number = 0) {
  if (eight.is_run) {  // addresses at fixed distances need no extra registers
    const double* from = reinterpret_cast<const double*>(items + eight.node[0]) + number;
    return lanes::gather_rows<numbers, sizeof(Item) / sizeof(double)>(from, to);
  }
  const double* from[nodes_in_lanes];
  for (std::size_t l = 0; l < nodes_in_lanes; ++l)
    from[l] = reinterpret_cast<const double*>(items + eight.node[l]) + number;
  lanes::gather_lanes(from, numbers, to);
}
/// Lanes that repeat a node hold the same values, so they may be written to it as well.
template <int numbers, class Item>
void scatter(const lanes::Pack<nodes_in_lanes>* from, Item* items, const NodeEight& eight, std::size_t number = 0) {
  if (eight.is_run) {
    double* to = reinterpret_cast<double*>(items + eight.node[0]) + number;
    return lanes::scatter_rows<numbers, sizeof(Item) / sizeof(double)>(from, to);
  }
  double* to[nodes_in_lanes];
  for (std::size_t l = 0; l < nodes_in_lanes; ++l) to[l] = reinterpret_cast<double*>(items + eight.node[l]) + number;
  lanes::scatter_lanes(from, numbers, to);
}

}  // namespace bough::step
