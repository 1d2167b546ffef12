#pragma once
/// Transfers the numbers of eight items between arrays and packs, one item in each lane. Internal to step.
#include <algorithm>

#include "bough/lanes/transpose.hpp"
#include "bough/step/state.hpp"
#include "element_parts.hpp"

namespace bough::step {

inline constexpr std::size_t nodes_in_lanes = 8;

/// Loads consecutive numbers of up to eight items, beginning with number `number` of each item.
template <int numbers, class Item>
void gather(const Item* items, std::size_t begin, std::size_t count, lanes::Pack<nodes_in_lanes>* to,
            std::size_t number = 0) {
  if (count == nodes_in_lanes) {  // addresses at fixed distances need no extra registers
    const double* from = reinterpret_cast<const double*>(items + begin) + number;
    return lanes::gather_rows<numbers, sizeof(Item) / sizeof(double)>(from, to);
  }
  const double* from[nodes_in_lanes];
  for (std::size_t l = 0; l < nodes_in_lanes; ++l)
    from[l] = reinterpret_cast<const double*>(items + begin + std::min(l, count - 1)) + number;
  lanes::gather_lanes(from, numbers, to);
}
/// Unused lanes hold the same values as the last item, so they may be written to it as well.
template <int numbers, class Item>
void scatter(const lanes::Pack<nodes_in_lanes>* from, Item* items, std::size_t begin, std::size_t count,
             std::size_t number = 0) {
  if (count == nodes_in_lanes) {
    double* to = reinterpret_cast<double*>(items + begin) + number;
    return lanes::scatter_rows<numbers, sizeof(Item) / sizeof(double)>(from, to);
  }
  double* to[nodes_in_lanes];
  for (std::size_t l = 0; l < nodes_in_lanes; ++l)
    to[l] = reinterpret_cast<double*>(items + begin + std::min(l, count - 1)) + number;
  lanes::scatter_lanes(from, numbers, to);
}

}  // namespace bough::step
