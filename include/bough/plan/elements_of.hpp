#pragma once
/// All elements of a model in one contiguous array per type, and the only place that iterates over the types.
#include <tuple>
#include <utility>
#include <vector>

#include "bough/elements/evaluate_lanes.hpp"

namespace bough::plan {

/// The arrays of elements on the group G.
template <class G>
using ArraysOn = std::tuple<
    std::vector<elements::BeamOn<G, 2>>, std::vector<elements::BeamOn<G, 3>>, std::vector<elements::BeamOn<G, 4>>,
    std::vector<elements::RigidBodyOn<G>>, std::vector<elements::JointOn<G>>, std::vector<elements::SpringOn<G>>,
    std::vector<elements::BushingOn<G>>, std::vector<elements::PointLoadOn<G>>, std::vector<elements::LineLoadOn<G, 2>>,
    std::vector<elements::LineLoadOn<G, 3>>, std::vector<elements::LineLoadOn<G, 4>>>;
using ElementArrays = ArraysOn<motion::Se3>;
using PlanarArrays = ArraysOn<motion::Se2>;

template <class E>
std::vector<E>& array_of(ElementArrays& all) {
  return std::get<std::vector<E>>(all);
}
template <class E>
const std::vector<E>& array_of(const ElementArrays& all) {
  return std::get<std::vector<E>>(all);
}

/// Elements have one global order, array after array. `directory[id]` gives the array and the index in it.
struct ElementPlace {
  std::uint8_t array = 0;
  std::int32_t index = 0;
};

/// Calls f(element) on the element at a place.
template <class Arrays, class F>
void with_element(const Arrays& all, ElementPlace place, F&& f) {
  const auto pick = [&]<std::size_t... I>(std::index_sequence<I...>) {
    static_cast<void>(
        ((place.array == I ? (f(std::get<I>(all)[static_cast<std::size_t>(place.index)]), true) : false) || ...));
  };
  pick(std::make_index_sequence<std::tuple_size_v<Arrays>>{});
}

/// Calls f(array) for every array, in order.
template <class F>
void for_each_array(const ElementArrays& all, F&& f) {
  std::apply([&](const auto&... arrays) { (f(arrays), ...); }, all);
}

}  // namespace bough::plan
