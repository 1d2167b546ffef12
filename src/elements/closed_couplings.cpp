/// The drivers of couplings that bring a tangent of their own, compiled as kernels are.
#include "lanes_impl.hpp"

namespace bough::elements {

template <class E>
constexpr auto closed_drivers = detail::emitted_if<E::has_closed_tangent>([]<class T = E>() {
  return both_drivers<T>;
});
BOUGH_EMIT_ON_EVERY_GROUP(closed_drivers, CatalogueOn)

}  // namespace bough::elements
