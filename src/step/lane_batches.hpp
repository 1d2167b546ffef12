#pragma once
/// Elements that the solver factors in lockstep, evaluated in lockstep as well: eight of one kind in the lanes of a pack, their tangents
/// written where the solver takes them. Internal to step.
#include <cstdint>
#include <span>
#include <tuple>
#include <vector>

#include "bough/elements/evaluate_lanes.hpp"
#include "bough/plan/elements_of.hpp"
#include "bough/plan/frames.hpp"
#include "bough/plan/plan.hpp"
#include "bough/solve/element_view.hpp"
#include "bough/step/state.hpp"
#include "held_nodes.hpp"

namespace bough::step {

namespace detail {
template <class Arrays>
struct LaneArraysOf;
template <class... E>
struct LaneArraysOf<std::tuple<std::vector<E>...>> {
  using Type = std::tuple<std::vector<typename elements::detail::OverLanes<E>::Type>...>;
};
}  // namespace detail

/// What differs between elements in space and those in a plane.
struct SpatialKernels {
  using Arrays = plan::ElementArrays;
  using Field = elements::Field;
  using NodeLanes = elements::NodeLanes;
  using FieldLanes = elements::FieldLanes;
  static constexpr int node_unknowns = 6, node_numbers = elements::numbers_of_node;
  template <class E>
  static constexpr int most_rows = E::num_multipliers;
  static const Arrays& arrays(const plan::Plan& plan) { return plan.elements; }
};
struct PlanarKernels {
  using Arrays = plan::PlanarArrays;
  using Field = elements::planar::Field;
  using NodeLanes = elements::planar::NodeLanes;
  using FieldLanes = elements::planar::FieldLanes;
  static constexpr int node_unknowns = 3, node_numbers = elements::planar::numbers_of_node;
  template <class E>
  static constexpr int most_rows = E::num_rows_at_most;
  static const Arrays& arrays(const plan::Plan& plan) { return plan.planar->elements; }
};

/// Where results of one element go.
struct ElementResult {
  double* residual;
  double* magnitude;
  solve::ElementView tangent;  ///< first == nullptr: not wanted
};

template <class Kernels>
class LaneBatches {
 public:
  using Field = typename Kernels::Field;

  /// Batches of the solver; elements of those that are all but empty are put together with others near by of one kind, in the place of the first.
  /// A batch goes in lanes if it holds at least `least_lanes` elements and they differ in numbers only.
  /// Joints that hold nodes are in none: nothing of them is asked for.
  void make(const plan::Plan& plan, std::span<const solve::ElementBatch> batches,
            const std::vector<int>& joint_of_element, const HeldNodes* held);

  /// Frames of prescribed motion as they are now, the same for all lanes; needed only where there are some.
  void set_frames(const plan::FrameMotions& frames);

  std::span<const solve::ElementBatch> batches() const { return batches_; }
  bool holds(std::size_t batch) const { return !slots_.empty() && slots_[batch].index >= 0; }

  /// Residuals, magnitudes and (where wanted) tangents of all elements of a batch. `result(id)` tells where they go. No allocation.
  template <class Result>
  void evaluate(std::size_t batch, const State& state, const Field& field, bool tangent, Result&& result) const;

 private:
  struct Slot {
    int array = -1;   ///< of plan.elements
    int index = -1;   ///< in that array's lane elements; -1: not in lanes
    int first = -1;   ///< lane that holds an element; lanes that hold none repeat it
    int present = 0;  ///< lanes that hold one
    int num_laws = 0;
    int num_unknowns = 0;     ///< of one element
    std::size_t places = 0;   ///< in places_: nodes of all lanes port by port, laws of all lanes one by one
    bool is_trimmed = false;  ///< a node of one of them is held
  };
  /// A lane element of eight equal ones, which further batches of the same may use: constants of a large structure do not fit into the caches.
  struct Uniform {
    int array, index;
    std::size_t element;  ///< one of them, in the plan's array
  };
  void gather_singles();
  template <std::size_t I>
  void add(const solve::ElementBatch& batch, Slot& slot);
  template <std::size_t I, class Result>
  void evaluate_as(const solve::ElementBatch& batch, const Slot& slot, const State& state, const Field& field,
                   bool tangent, Result& result) const;

  static constexpr std::size_t most_uniform = 64;  ///< that are compared with
  const plan::Plan* plan_ = nullptr;
  const HeldNodes* held_ = nullptr;
  std::vector<solve::ElementBatch> batches_;
  std::span<const int> joint_of_element_;
  std::vector<Slot> slots_;
  std::vector<Uniform> uniform_;
  std::vector<int> places_;  ///< here, since elements themselves are large and lie far apart
  typename detail::LaneArraysOf<typename Kernels::Arrays>::Type lanes_;
  std::vector<elements::CarrierLanes> carriers_;
  elements::CarrierLanes observer_;
};

template <class Kernels>
template <class Result>
void LaneBatches<Kernels>::evaluate(std::size_t batch, const State& state, const Field& field, bool tangent,
                                    Result&& result) const {
  const Slot slot = slots_[batch];
  const auto pick = [&]<std::size_t... I>(std::index_sequence<I...>) {
    static_cast<void>(((slot.array == static_cast<int>(I)
                            ? (evaluate_as<I>(batches_[batch], slot, state, field, tangent, result), true)
                            : false) ||
                       ...));
  };
  pick(std::make_index_sequence<std::tuple_size_v<typename Kernels::Arrays>>{});
}

template <class Kernels>
template <std::size_t I, class Result>
void LaneBatches<Kernels>::evaluate_as(const solve::ElementBatch& batch, const Slot& slot, const State& state,
                                       const Field& field, bool tangent, Result& result) const {
  using Pack = elements::LanePack;
  using E = typename std::tuple_element_t<I, typename Kernels::Arrays>::value_type;
  constexpr int rows = Kernels::template most_rows<E>, wide = elements::num_lanes,
                most = Kernels::node_unknowns * E::num_ports + rows;
  const auto& lane_element = std::get<I>(lanes_)[static_cast<std::size_t>(slot.index)];
  int ids[wide];
  for (int l = 0; l < wide; ++l) ids[l] = batch.element[static_cast<std::size_t>(l)];
  const int n = slot.num_unknowns;
  typename Kernels::NodeLanes nodes[E::num_ports];
  Pack laws[elements::max_laws], multipliers[rows > 0 ? rows : 1], turns(0.0);
  const double* from[E::num_ports][wide] = {};
  const int* place = places_.data() + slot.places;
  for (int p = 0; p < E::num_ports; ++p)
    for (int l = 0; l < wide; ++l, ++place)
      if (*place != elements::ground)
        from[p][l] = reinterpret_cast<const double*>(&field.nodes[static_cast<std::size_t>(*place)]);
  for (int k = 0; k < slot.num_laws; ++k)
    for (int l = 0; l < wide; ++l, ++place) laws[k].set(l, field.around.laws[*place]);
  if constexpr (rows > 0) {
    for (int l = 0; l < wide; ++l) {
      const int j = joint_of_element_[static_cast<std::size_t>(ids[l] >= 0 ? ids[l] : ids[slot.first])];
      if (j < 0) continue;
      const plan::JointPlan& joint = plan_->joints[static_cast<std::size_t>(j)];
      for (std::size_t r = 0; r < joint.rows.size(); ++r)
        multipliers[r].set(l, state.multipliers[static_cast<std::size_t>(joint.multiplier_begin + joint.rows[r])]);
      turns.set(l, state.turns[static_cast<std::size_t>(j)]);
    }
  }
  for (int p = 0; p < E::num_ports; ++p)
    if (from[p][0] != nullptr) lanes::gather_lanes(from[p], Kernels::node_numbers, reinterpret_cast<Pack*>(&nodes[p]));
  typename Kernels::FieldLanes around;
  around.nodes = nodes;
  around.slopes = field.slopes;
  if constexpr (requires { field.carriers; }) {
    if (field.carriers != nullptr) around.carriers = carriers_.data();
    if (field.observer != nullptr) around.observer = &observer_;
  }
  for (int i = 0; i < field.around.gravity.size(); ++i) around.around.gravity[i] = Pack(field.around.gravity[i]);
  around.around.laws = laws;
  around.around.has_inertia = field.around.has_inertia;
  Pack residual[most], magnitude[most], spare[most * most];
  const bool is_direct =  // else the empty lanes must stay empty
      tangent && slot.present == wide && batch.stride == wide && !slot.is_trimmed;
  Pack* matrix = nullptr;
  if (is_direct) matrix = reinterpret_cast<Pack*>(result(ids[0]).tangent.first);
  if (tangent && !is_direct) matrix = spare;
  evaluate_lanes(lane_element, around, multipliers, turns, residual, magnitude, matrix);
  double nowhere[most], *to_residual[wide], *to_magnitude[wide];
  for (int l = 0; l < wide; ++l) {
    to_residual[l] = to_magnitude[l] = nowhere;
    if (ids[l] < 0) continue;
    const ElementResult to = result(ids[l]);
    to_residual[l] = to.residual;
    to_magnitude[l] = to.magnitude;
    if (tangent && !is_direct)
      write_matrix(
          held_, static_cast<std::size_t>(ids[l]), n, [&](int i) { return spare[i][l]; }, to.tangent);
  }
  lanes::scatter_lanes(residual, n, to_residual);
  lanes::scatter_lanes(magnitude, n, to_magnitude);
}

}  // namespace bough::step
