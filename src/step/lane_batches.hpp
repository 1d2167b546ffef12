#pragma once
/// Elements that the solver factors in lockstep, evaluated in lockstep as well: eight of one kind in the lanes of a
/// pack, their tangents written where the solver takes them. Internal to step.
#include <cstdint>
#include <span>
#include <tuple>
#include <vector>

#include "bough/elements/evaluate_lanes.hpp"
#include "bough/plan/elements_of.hpp"
#include "bough/plan/frames.hpp"
#include "bough/plan/plan.hpp"
#include "bough/solve/any_solver.hpp"
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

/// Where results of elements go.
struct ElementResults {
  double* parts;              ///< as System::parts_
  const std::int64_t* begin;  ///< by element: half of where its parts begin
  solve::AnySolver* solver;   ///< takes tangents; null: not wanted

  bool want_tangents() const { return solver != nullptr; }
  double* parts_of(int element) const { return parts + 2 * begin[element]; }
  solve::ElementView tangent_of(int element) const { return solver->element(element); }
};

/// Of elements that move on the group G.
template <class G>
class LaneBatches {
 public:
  using Arrays = plan::ArraysOn<G>;
  using Field = elements::FieldOn<G, double>;

  /// Batches of the solver; elements of those that are all but empty are put together with others near by of one
  /// kind, in the place of the first. A batch goes in lanes if it holds at least `least_lanes` elements and they
  /// differ in numbers only. Joints that hold nodes are in none: nothing of them is asked for.
  void make(const plan::Plan& plan, std::span<const solve::ElementBatch> batches,
            const std::vector<int>& joint_of_element, const HeldNodes* held);

  /// Frames of prescribed motion as they are now, the same for all lanes; needed only where there are some.
  void set_frames(const plan::FrameMotions& frames);

  std::span<const solve::ElementBatch> batches() const { return batches_; }
  bool holds(std::size_t batch) const { return !slots_.empty() && slots_[batch].index >= 0; }

  /// Residuals, magnitudes and (where wanted) tangents of all elements of a batch. No allocation.
  void evaluate(std::size_t batch, const State& state, const Field& field, const ElementResults& to) const;

 private:
  struct Slot {
    int array = -1;   ///< of plan.elements
    int index = -1;   ///< in that array's lane elements; -1: not in lanes
    int first = -1;   ///< lane that holds an element; lanes that hold none repeat it
    int present = 0;  ///< lanes that hold one
    int num_laws = 0;
    int num_unknowns = 0;  ///< of one element
    int num_rows = 0;      ///< of one element, those that have a multiplier
    std::size_t places =
        0;  ///< in places_: nodes port by port, laws and multipliers one by one, joints; of all lanes each
    bool is_trimmed = false;  ///< a node of one of them is held
  };
  /// A lane element of eight equal ones, which further batches of the same may use: constants of a large structure do
  /// not fit into the caches.
  struct Uniform {
    int array, index;
    std::size_t element;  ///< one of them, in the plan's array
  };
  void gather_singles();
  void place_rows(const solve::ElementBatch& batch, Slot& slot);
  template <std::size_t I>
  void add(const solve::ElementBatch& batch, Slot& slot);
  template <std::size_t I>
  void evaluate_as(const solve::ElementBatch& batch, const Slot& slot, const State& state, const Field& field,
                   const ElementResults& to) const;

  static constexpr std::size_t most_uniform = 64;  ///< that are compared with
  const plan::Plan* plan_ = nullptr;
  const HeldNodes* held_ = nullptr;
  std::vector<solve::ElementBatch> batches_;
  std::span<const int> joint_of_element_;
  std::vector<Slot> slots_;
  std::vector<Uniform> uniform_;
  std::vector<int> places_;  ///< here, since elements themselves are large and lie far apart
  typename detail::LaneArraysOf<Arrays>::Type lanes_;
  std::vector<elements::CarrierLanes> carriers_;
  elements::CarrierLanes observer_;
};

}  // namespace bough::step
