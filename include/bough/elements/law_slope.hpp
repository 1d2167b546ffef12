#pragma once
/// How an element's residual changes with one of the numbers that it takes from laws.
#include "bough/elements/evaluate.hpp"
#include "bough/elements/evaluate_lanes.hpp"

namespace bough::elements {

namespace detail {
/// Gives the laws of a copy of an element places of their own, as series of which one grows with rate 1.
struct Renumbering {
  const double* values;
  int growing;
  lanes::Taylor<double, 1> laws[max_laws];
  int count = 0;
  template <class X, class Y>
  void flag(const X& x, Y& y) const {
    y = x;
  }
  void law(int from, int& to) {
    if (from < 0) return;
    laws[count] = lanes::Taylor<double, 1>(values[from]);
    laws[count].c[1] = from == growing ? 1.0 : 0.0;
    to = count++;
  }
};
}  // namespace detail

/// d(residual)/d(law), in the unknowns of the nodes and the rows: the residual's own source in Taylor numbers, of nodes
/// at rest and a law that grows with rate 1. The residual has no products of laws with velocities.
template <class E>
void evaluate_law_slope(const E& e, const FieldOn<typename E::Group, double>& field, const double* multipliers,
                        double turns, int law, double* slope) {
  using G = typename E::Group;
  using T = lanes::Taylor<double, 1>;
  E copy = e;
  detail::Renumbering renumber{field.around.laws, law, {}};
  const KindOf<detail::Renumbering> visit(renumber);
  E::visit_data(e, copy, visit);
  NodeMotionOn<G, double> nodes[E::num_ports];
  for (int k = 0; k < E::num_ports; ++k) {
    if (copy.ports[k].node == ground) continue;
    nodes[k] = field.nodes[copy.ports[k].node];
    nodes[k].v = nodes[k].a = G::template Vector<double>::zero();
    copy.ports[k].node = k;
  }
  FieldOn<G, double> here = field;
  here.nodes = nodes;
  here.observer = nullptr;  // elements that read laws have no mass
  SurroundingsOn<G, T> around;
  for (int k = 0; k < around.gravity.size(); ++k) around.gravity[k] = T(field.around.gravity[k]);
  around.laws = renumber.laws;
  around.has_inertia = field.around.has_inertia;
  evaluate_rate(copy, here, around, multipliers, turns, nullptr, slope);
}

}  // namespace bough::elements
