#pragma once
/// Couplings of scenes that tests write: the element's own members beside a name and ends.
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "bough/elements/catalogue.hpp"
#include "bough/scene/scene.hpp"

namespace bough::support {

/// A coupling of the kind of E, the element in space. Directions and axes are in the ground; members that are laws are
/// not used, but `factors`.
template <elements::IsCatalogued E>
struct Given : E {
  std::string name;
  scene::Attachment first, second;
  std::vector<scene::Factor> factors;  ///< of the first of its laws and so on; those that are missing are not given

  operator scene::Coupling() const {
    scene::Coupling c{&elements::kind_of<E>, name, first, second, {}, factors};
    std::size_t laws = 0;
    const auto put = [&](const auto& datum) {
      [[maybe_unused]] const auto& from = static_cast<const E&>(*this).*datum.member;
      constexpr scene::CouplingFieldType type = std::decay_t<decltype(datum)>::type;
      if constexpr (type == scene::CouplingFieldType::number)
        c.values.push_back(from);
      else if constexpr (type == scene::CouplingFieldType::matrix)
        c.values.insert(c.values.end(), std::begin(from.m), std::end(from.m));
      else if constexpr (type != scene::CouplingFieldType::law)
        c.values.insert(c.values.end(), std::begin(from.v), std::end(from.v));
      laws += type == scene::CouplingFieldType::law ? 1 : 0;
    };
    std::apply([&](const auto&... data) { (put(data), ...); }, E::declared());
    c.factors.resize(laws);
    return c;
  }
};
using GivenSpring = Given<elements::Spring>;
using GivenBushing = Given<elements::Bushing>;

/// The numbers of a field of a coupling.
inline std::span<double> values_of(scene::Coupling& c, std::string_view name) {
  double* at = c.values.data();
  for (const scene::CouplingField& field : c.kind->fields) {
    if (field.name == name) return {at, field.count()};
    at += field.count();
  }
  throw std::runtime_error("values_of: no such field");
}

}  // namespace bough::support
