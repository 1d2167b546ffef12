#pragma once
/// All elements of a model in one contiguous array per type, and the only place that iterates over the types.
#include <cstddef>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

#include "bough/elements/evaluate_lanes.hpp"

namespace bough::plan {

/// In place of a type of elements that cannot live on a group.
struct NoElement {};
template <class E>
using ArrayOf = std::vector<std::conditional_t<elements::exists<E>, E, NoElement>>;
namespace detail {
template <class... E>
std::tuple<ArrayOf<E>...> arrays_of(std::tuple<E...>*);
}  // namespace detail
/// The arrays of elements on the group G, in the order of `elements::ElementsOn`.
template <class G>
using ArraysOn = decltype(detail::arrays_of(static_cast<elements::ElementsOn<G>*>(nullptr)));
using ElementArrays = ArraysOn<motion::Se3>;

namespace detail {
template <class E, class... Listed>
consteval std::size_t find_index(const std::tuple<std::vector<Listed>...>*) {
  const bool is_listed[] = {std::is_same_v<E, Listed>...};
  std::size_t i = 0;
  while (!is_listed[i]) ++i;  // a type that is not listed does not compile
  return i;
}
}  // namespace detail
/// Place of a type of elements in the list: nothing else may know it.
template <class E>
constexpr std::size_t index_of = detail::find_index<E>(static_cast<const ArraysOn<typename E::Group>*>(nullptr));

/// Calls f<N>() with the number of nodes of the elements of a beam of this order.
template <class F>
void with_nodes_of_order(int order, F&& f) {
  if (order == 1)
    f.template operator()<2>();
  else if (order == 2)
    f.template operator()<3>();
  else
    f.template operator()<4>();
}

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

/// Calls f<I>() with the number of an array as a constant, unless the array holds no elements on its group.
template <class Arrays, class F>
void with_array(int array, F&& f) {
  const auto call = [&]<std::size_t I>() {
    if constexpr (!std::is_same_v<typename std::tuple_element_t<I, Arrays>::value_type, NoElement>)
      f.template operator()<I>();
    return true;
  };
  const auto pick = [&]<std::size_t... I>(std::index_sequence<I...>) {
    static_cast<void>(((array == static_cast<int>(I) && call.template operator()<I>()) || ...));
  };
  pick(std::make_index_sequence<std::tuple_size_v<Arrays>>{});
}
/// Calls f(element) on the element at a place.
template <class Arrays, class F>
void with_element(const Arrays& all, ElementPlace place, F&& f) {
  with_array<Arrays>(place.array, [&]<std::size_t I>() { f(std::get<I>(all)[static_cast<std::size_t>(place.index)]); });
}

/// Calls f(array) for every array, in order.
template <class F>
void for_each_array(const ElementArrays& all, F&& f) {
  std::apply([&](const auto&... arrays) { (f(arrays), ...); }, all);
}

}  // namespace bough::plan
