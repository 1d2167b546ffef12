#pragma once
/// The catalogue: the one list of the couplings that are declared whole in a header.
#include <tuple>

#include "bough/elements/couplings/bushing.hpp"
#include "bough/elements/couplings/contact.hpp"
#include "bough/elements/couplings/spring.hpp"
#include "bough/elements/couplings/torsion_spring.hpp"

namespace bough::elements {

/// The elements of the catalogue on the group G.
template <class G>
using CatalogueOn = std::tuple<SpringOn<G>, BushingOn<G>, ContactOn<G>, TorsionSpringOn<G>>;

/// Calls f.template operator()<E>() for the type in space of every kind.
template <class F>
void for_each_catalogued(F&& f) {
  [&]<class... E>(std::tuple<E...>*) {
    (f.template operator()<E>(), ...);
  }(static_cast<CatalogueOn<motion::Se3>*>(nullptr));
}

}  // namespace bough::elements
