#pragma once
/// From planar nodes to residuals and tangents in three unknowns a node, alone and eight at a time: as evaluate.hpp and
/// evaluate_lanes.hpp, tangents of beams in closed form, of all else from the residual's own source run on jets.
#include "bough/elements/evaluate_lanes.hpp"
#include "bough/elements/planar/kernels.hpp"

namespace bough::elements::planar {

template <class E>
int num_multipliers(const E& e) {
  if constexpr (E::num_rows_at_most > 0)
    return e.num_rows;
  else
    return 0;
}
/// Three for each port off the ground, then the rows.
template <class E>
int num_unknowns(const E& e) {
  int n = num_multipliers(e);
  for (const auto& port : e.ports) n += port.node == ground ? 0 : 3;
  return n;
}

/// Residual, its magnitude (as eval_magnitude) and, where asked for, the tangent, row-major. No allocation.
template <class E>
void evaluate(const E& e, const Field& field, const double* multipliers, double turns, double* residual,
              double* magnitude, double* tangent);

using NodeLanes = NodeOf<LanePack>;
using FieldLanes = FieldOf<LanePack>;
inline constexpr int numbers_of_node = 15;
static_assert(sizeof(Node) == numbers_of_node * sizeof(double));
static_assert(sizeof(NodeLanes) == numbers_of_node * sizeof(LanePack));

template <class E>
using LaneElement = typename elements::detail::OverLanes<E>::Type;

int list_laws(const Joint& e, int* laws);
int list_laws(const PointLoad& e, int* laws);
template <int N>
int list_laws(const LineLoad<N>& e, int* laws) {
  laws[0] = e.law;
  return 1;
}
template <class E>
int list_laws(const E&, int*) {
  return 0;
}

template <class E>
bool may_share_lanes(const E& a, const E& b);
/// Whether they do not even differ in these: all but nodes and laws are the same.
template <class E>
bool has_same_numbers(const E& a, const E& b);
template <class E>
LaneElement<E> make_lane_element(const E* const* elements, int count, const int* nodes, int first_law);
template <class E>
void evaluate_lanes(const E& e, const FieldLanes& field, const LanePack* multipliers, const LanePack& turns,
                    LanePack* residual, LanePack* magnitude, LanePack* tangent);

}  // namespace bough::elements::planar
