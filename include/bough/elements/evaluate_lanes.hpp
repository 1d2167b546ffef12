#pragma once
/// Evaluation of eight elements of one type in lockstep, one to a lane: the kernels and the driver of evaluate.hpp over
/// packs. A lane gives the bits of the same element evaluated alone, whatever the other lanes contain.
///
/// A solver that runs up to eight equal sub-domains in lockstep
///   1. once, for each element position: checks `may_share_lanes` and makes a `LaneElement` (make_lane_element),
///     whose ports and
///      laws carry the numbers of the sub-domain's own nodes and laws, the same in all lanes;
///   2. at each evaluation: fills one NodeLanes per node and one pack per law and multiplier; where frames
///      move, one CarrierLanes for each of them and for the observer (set_all_lanes), which are common to all lanes;
///   3. calls `evaluate_lanes` for each element; entry k of lane l of a result is out[k * num_lanes + l], k as in
///     `evaluate`.
/// Unused lanes repeat a valid element and its nodes, and their results are ignored. Nothing allocates. All arrays of
/// packs are aligned to 64 bytes.
#include "bough/elements/element_data.hpp"
#include "bough/elements/evaluate.hpp"
#include "bough/lanes/transpose.hpp"

namespace bough::elements {

inline constexpr int num_lanes = 8;
using LanePack = lanes::Pack<num_lanes>;
using NodeLanes = NodeMotionOf<LanePack>;
using CarrierLanes = CarrierMotionOf<LanePack>;
/// `nodes` are indexed by the ports of lane elements, `around.laws` by their laws; `slopes` are common to all lanes.
/// `carriers` have the indices of Field::carriers; they and the `observer` hold the same motion in all lanes.
using FieldLanes = FieldOf<LanePack>;

namespace detail {
template <class E>
struct OverLanes;
template <template <class, class> class E, class G>
struct OverLanes<E<G, double>> {
  using Type = E<G, LanePack>;
};
template <template <class, int, class> class E, class G, int N>
struct OverLanes<E<G, N, double>> {
  using Type = E<G, N, LanePack>;
};
}  // namespace detail
/// The element E with constants in lanes: Beam<2> gives Beam<2, LanePack>, and so on.
template <class E>
using LaneElement = typename detail::OverLanes<E>::Type;

/// Largest number of laws of one element: those of its rows, then those of its efforts.
constexpr int max_laws = max_rows + max_efforts;
template <class E>
int list_laws(const E& e, int* laws) {
  LawLister lister{laws};
  const KindOf visit(lister);
  E::visit_data(e, e, visit);
  return lister.count;
}

/// Whether two elements differ in numbers only. Equal are: which ports are on the ground and which have offsets, the
/// frames of prescribed motion that carry ports, and the terms that are present (mass, damping, rows, efforts, laws,
/// dead or follower loads).
template <class E>
bool may_share_lanes(const E& a, const E& b);
/// Whether two elements have equal constants as well: they differ in nodes and laws only.
template <class E>
bool has_same_numbers(const E& a, const E& b);

/// Constants of `count` elements, 1 <= count <= num_lanes, that may share lanes; the remaining lanes repeat the last
/// one.
///   nodes: for each port off the ground, the index its node will have in FieldLanes::nodes; first_law: the index of
///     the first of the
///   element's laws (list_laws) in FieldLanes::around.laws, the others follow.
template <class E>
LaneElement<E> make_lane_element(const E* const* elements, int count, const int* nodes, int first_law);

/// The motion of a node as a plain array of numbers, in the order of its members.
template <class G>
inline constexpr int numbers_of_node = sizeof(NodeMotionOn<G, double>) / sizeof(double);
template <class G, int numbers>
inline constexpr bool has_numbers_of_node = numbers_of_node<G> == numbers &&
                                            sizeof(NodeMotionOn<G, LanePack>) == numbers * sizeof(LanePack);
static_assert(has_numbers_of_node<motion::Se3, 36> && has_numbers_of_node<motion::Se2, 17>);
static_assert(has_numbers_of_node<motion::Translations<3>, 15> && has_numbers_of_node<motion::Translations<1>, 5>);
/// Numbers of its drift, of its pose, and of its pose, v and dv/dt: those that an array begins with.
template <class G>
inline constexpr int numbers_of_drift = G::turns ? G::translations : 0;
template <class G>
inline constexpr int numbers_of_pose = numbers_of_node<G> - numbers_of_drift<G> - 3 * G::dof;
template <class G>
inline constexpr int numbers_of_rates = numbers_of_pose<G> + 2 * G::dof;

/// Copies the motion of a frame of prescribed motion into all lanes.
inline void set_all_lanes(CarrierLanes& to, const CarrierMotion& from) {
  to.pose = {lanes::cast<LanePack>(from.pose.R), lanes::cast<LanePack>(from.pose.x)};
  to.twist = lanes::cast<LanePack>(from.twist);
  to.twist_rate = lanes::cast<LanePack>(from.twist_rate);
  to.twist_second = lanes::cast<LanePack>(from.twist_second);
}

/// Residual and, where asked for (not nullptr), its magnitude (eval_magnitude) and tangent, of num_unknowns(e) = n
/// entries, n, n x n row-major. `multipliers` (num_multipliers(e) packs) and `turns` are looked at by joints only.
template <class E>
void evaluate_lanes(const E& e, const FieldOn<typename E::Group, LanePack>& field, const LanePack* multipliers,
                    const LanePack& turns, LanePack* residual, LanePack* magnitude, LanePack* tangent);

}  // namespace bough::elements
