#pragma once
/// All elements of a model: one contiguous array per type, and the one place where code goes over the types.
#include <tuple>
#include <utility>
#include <vector>

#include "bough/elements/planar/evaluate.hpp"

namespace bough::plan {

using ElementArrays =
    std::tuple<std::vector<elements::Beam<2>>, std::vector<elements::Beam<3>>, std::vector<elements::Beam<4>>,
               std::vector<elements::RigidBody>, std::vector<elements::Joint>, std::vector<elements::Spring>,
               std::vector<elements::Bushing>, std::vector<elements::PointLoad>, std::vector<elements::LineLoad<2>>,
               std::vector<elements::LineLoad<3>>, std::vector<elements::LineLoad<4>>>;

/// The same types in the same order for motions in a plane.
using PlanarArrays = std::tuple<std::vector<elements::planar::Beam<2>>, std::vector<elements::planar::Beam<3>>,
                                std::vector<elements::planar::Beam<4>>, std::vector<elements::planar::RigidBody>,
                                std::vector<elements::planar::Joint>, std::vector<elements::planar::Spring>,
                                std::vector<elements::planar::Bushing>, std::vector<elements::planar::PointLoad>,
                                std::vector<elements::planar::LineLoad<2>>, std::vector<elements::planar::LineLoad<3>>,
                                std::vector<elements::planar::LineLoad<4>>>;
static_assert(std::tuple_size_v<PlanarArrays> == std::tuple_size_v<ElementArrays>);

template <class E>
std::vector<E>& array_of(ElementArrays& all) {
  return std::get<std::vector<E>>(all);
}
template <class E>
const std::vector<E>& array_of(const ElementArrays& all) {
  return std::get<std::vector<E>>(all);
}

/// Elements in one global order: array after array. `directory[id]` tells array and index.
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
