#pragma once
/// Instantiates functions of elements for whole lists of types: the address of a function that is kept makes the
/// compiler emit it, for callers that see its declaration alone.
#include <tuple>

#include "bough/elements/evaluate.hpp"

namespace bough::elements::detail {

struct NothingToEmit {};
template <template <class> class Of, class... E>
constexpr auto emit_for(const std::tuple<E...>*) {
  return std::tuple{[] {
    if constexpr (exists<E>)
      return Of<E>::functions;
    else
      return NothingToEmit{};
  }()...};
}
/// All elements in space.
using AllInSpace = decltype(std::tuple_cat(std::tuple<Beam<2>, Beam<3>, Beam<4>, RigidBody, Spring, Bushing, PointLoad,
                                                      LineLoad<2>, LineLoad<3>, LineLoad<4>>{},
                                           CatalogueOn<motion::Se3>{}));

}  // namespace bough::elements::detail

/// functions: a variable template over elements, with the addresses of functions.
#define BOUGH_EMIT(functions_of, name, ...)                                                                    \
  namespace {                                                                                                  \
  template <class E>                                                                                           \
  struct name {                                                                                                \
    static constexpr auto functions = functions_of<E>;                                                         \
  };                                                                                                           \
  [[gnu::used]] constexpr auto name##_kept = detail::emit_for<name>(static_cast<const __VA_ARGS__*>(nullptr)); \
  }
#define BOUGH_EMIT_FOR_CATALOGUE(functions_of)                                 \
  BOUGH_EMIT(functions_of, EmitInSpace, CatalogueOn<motion::Se3>)              \
  BOUGH_EMIT(functions_of, EmitInPlane, CatalogueOn<motion::Se2>)              \
  BOUGH_EMIT(functions_of, EmitOfPlaces, CatalogueOn<motion::Translations<3>>) \
  BOUGH_EMIT(functions_of, EmitOnLine, CatalogueOn<motion::Translations<1>>)
#define BOUGH_EMIT_FOR_ALL(functions_of) BOUGH_EMIT(functions_of, EmitAllInSpace, detail::AllInSpace)
