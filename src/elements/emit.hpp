#pragma once
/// Instantiates functions of elements for whole lists of types: the address of a function that is kept makes the
/// compiler emit it, for callers that see its declaration alone.
#include <tuple>

#include "bough/elements/evaluate.hpp"

namespace bough::elements::detail {

struct NothingToEmit {};
/// What f returns, which is not called, nor compiled, if it is not wanted. f: a template without parameters.
template <bool is_wanted, class F>
constexpr auto emitted_if(F&& f) {
  if constexpr (is_wanted)
    return f();
  else
    return NothingToEmit{};
}
template <template <class> class Of, class... E>
constexpr auto emit_for(const std::tuple<E...>*) {
  return std::tuple{emitted_if<exists<E>>([]<class T = E>() { return Of<T>::functions; })...};
}

}  // namespace bough::elements::detail

/// functions_of: a variable template over elements, with the addresses of functions, of a name of its own.
#define BOUGH_EMIT(functions_of, where, ...)                                           \
  namespace {                                                                          \
  template <class E>                                                                   \
  struct functions_of##where {                                                         \
    static constexpr auto functions = functions_of<E>;                                 \
  };                                                                                   \
  [[gnu::used]] constexpr auto functions_of##where##_kept =                            \
      detail::emit_for<functions_of##where>(static_cast<const __VA_ARGS__*>(nullptr)); \
  }
/// ListOn: a template of such lists over groups.
#define BOUGH_EMIT_ON_EVERY_GROUP(functions_of, ListOn)                 \
  BOUGH_EMIT(functions_of, _in_space, ListOn<motion::Se3>)              \
  BOUGH_EMIT(functions_of, _in_plane, ListOn<motion::Se2>)              \
  BOUGH_EMIT(functions_of, _of_places, ListOn<motion::Translations<3>>) \
  BOUGH_EMIT(functions_of, _on_line, ListOn<motion::Translations<1>>)
