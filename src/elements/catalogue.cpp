/// The kinds of the catalogue as plain data, and the drivers of couplings whose tangent is their residual run on jets.
#include "bough/elements/catalogue.hpp"

#include <array>

#include "bough/elements/coupling_kinds.hpp"
#include "bough/scene/scene.hpp"
#include "lanes_impl.hpp"

namespace bough::elements {

template <IsCatalogued E>
Mat6<double> eval_stiffness_at_start(const scene::Coupling& given, const Frame<double>& first,
                                     const Frame<double>& second) {
  E e;
  take_data(e, given.values.data(), first.R);
  if constexpr (E::has_stiffness_matrix) return e.stiffness;
  NodeMotion nodes[2] = {};
  for (int k = 0; k < 2; ++k) {
    e.ports[k].node = k;
    nodes[k].R = first.R;
    nodes[k].x = motion::Vec3Pair::from(k == 0 ? first.x : second.x);
    nodes[k].v = nodes[k].a = nodes[k].dq = Vec6<double>::zero();
  }
  if (E::start == scene::CouplingStart::apart) {
    e.ports[1].has_offset = true;
    e.ports[1].offset.R = lanes::transpose_times(first.R, second.R);
  }
  Field field;
  field.nodes = nodes;
  field.around.gravity = Vec3<double>::zero();
  field.around.has_inertia = false;
  double residual[12], tangent[144];
  evaluate(e, field, nullptr, 0.0, residual, tangent);
  Mat6<double> K;
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j) K(i, j) = tangent[(6 + i) * 12 + 6 + j];
  return K;
}

namespace {

template <class... E>
constexpr std::array<const scene::CouplingKind*, sizeof...(E)> kinds_of(std::tuple<E...>*) {
  return {&kind_of<E>...};
}
constexpr auto kinds = kinds_of(static_cast<CatalogueOn<motion::Se3>*>(nullptr));

}  // namespace

template <class E>
constexpr auto jet_drivers = detail::emitted_if<!E::has_closed_tangent>([]<class T = E>() { return both_drivers<T>; });
BOUGH_EMIT_ON_EVERY_GROUP(jet_drivers, CatalogueOn)

std::span<const scene::CouplingKind* const> coupling_kinds() { return kinds; }

}  // namespace bough::elements
