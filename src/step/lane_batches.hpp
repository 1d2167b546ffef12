#pragma once
/// Evaluation of eight elements of one kind at once, one in each lane of a pack. The batches follow those of the
/// solver, which factors equal sub-domains in lockstep, so that tangents are written directly to the solver's storage.
/// Internal to step.
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
#include "bough/step/visit_ranges.hpp"
#include "trimmed_elements.hpp"

namespace bough::step {

namespace detail {
template <class E>
struct OverLanes : elements::detail::OverLanes<E> {};
template <>
struct OverLanes<plan::NoElement> {
  using Type = plan::NoElement;
};
template <class Arrays>
struct LaneArraysOf;
template <class... E>
struct LaneArraysOf<std::tuple<std::vector<E>...>> {
  using Type = std::tuple<std::vector<typename OverLanes<E>::Type>...>;
};
}  // namespace detail

/// Destination of the results of elements.
struct ElementResults {
  double* parts;              ///< as ResidualSums::parts
  const std::int64_t* begin;  ///< by element: half the offset of its parts
  solve::AnySolver* solver;   ///< receives tangents; null: tangents are not computed

  bool want_tangents() const { return solver != nullptr; }
  double* parts_of(int element) const { return parts + 2 * begin[element]; }
  solve::ElementView tangent_of(int element) const { return solver->element(element); }
};

/// Batches of elements on the group G.
template <class G>
class LaneBatches {
 public:
  using Arrays = plan::ArraysOn<G>;
  using Field = elements::FieldOn<G, double>;

  /// Starts from the batches of the solver, divided into elements that differ only in the values of their data. Batches
  /// that are then not full are filled with such elements of nearby ones, if they belong to the same visit of the
  /// solver's walks or to one below that of the elements, whose work comes before. A batch is evaluated in lanes if it
  /// then holds at least `least_lanes` elements. Joints that hold nodes at rest are omitted, since the solver does not
  /// see them.
  void make(const plan::Plan& plan, std::span<const solve::ElementBatch> batches, const solve::SolverVisits& visits,
            const TrimmedElements* trimmed);

  /// Sets the motions of frames of prescribed motion, equal in all lanes. Needed only if the scene has such frames.
  void set_frames(const plan::FrameMotions& frames);

  std::span<const solve::ElementBatch> batches() const { return batches_; }
  const VisitRanges& by_visit() const { return by_visit_; }
  bool holds(std::size_t batch) const { return !slots_.empty() && slots_[batch].index >= 0; }

  /// Computes residuals, magnitudes and (if `to` has a solver) tangents of all elements of a batch. Does not allocate.
  void evaluate(std::size_t batch, const State& state, const Field& field, const ElementResults& to) const;

 private:
  struct Slot {
    int array = -1;   ///< of plan.elements
    int index = -1;   ///< in the lane elements of that array; -1: evaluated one by one
    int first = -1;   ///< first lane with an element; empty lanes repeat that element
    int present = 0;  ///< number of lanes with an element
    int num_laws = 0;
    int num_unknowns = 0;     ///< of one element
    int num_rows = 0;         ///< constraint rows of one element that have a multiplier
    std::size_t places = 0;   ///< offset in places_: nodes by port, then laws, multipliers, joints, each for all lanes
    bool is_trimmed = false;  ///< one of the elements is attached to a held node
  };
  /// A lane element made of eight elements with equal data. Further batches of the same elements share it, because the
  /// constants of a large structure would not fit into the caches.
  struct Uniform {
    int array, index;
    std::size_t element;  ///< one of the eight, in the plan's array
  };
  /// Whether two elements differ only in the values of their data.
  bool may_share(int a, int b) const;
  /// Separates the elements of a batch that may not share lanes: the solver puts together what has equal unknowns.
  void split_by_kind(std::vector<int>& visit_of_batch);
  /// Puts the elements of batches that are not full together.
  void fill_batches(const std::vector<int>& visit_of_batch, const solve::SolverVisits& visits);
  void place_rows(const solve::ElementBatch& batch, int num_rows, Slot& slot);
  /// Whether the solver sees nothing of an element.
  bool leaves_out(int element) const;
  /// Whether an element has unknowns beside its own, those of signals: it is evaluated alone.
  bool reads_signals(int element) const;
  template <std::size_t I>
  void add(const solve::ElementBatch& batch, Slot& slot);
  template <std::size_t I>
  void evaluate_as(const solve::ElementBatch& batch, const Slot& slot, const State& state, const Field& field,
                   const ElementResults& to) const;
  static constexpr std::size_t most_uniform = 64;  ///< number of lane elements that are searched for equal ones
  const plan::Plan* plan_ = nullptr;
  const TrimmedElements* trimmed_ = nullptr;
  std::vector<solve::ElementBatch> batches_;
  VisitRanges by_visit_;
  std::vector<Slot> slots_;
  std::vector<Uniform> uniform_;
  std::vector<int> places_;  ///< apart from the elements, which are large, so that they stay in the caches
  typename detail::LaneArraysOf<Arrays>::Type lanes_;
  std::vector<elements::CarrierLanes> carriers_;
  elements::CarrierLanes observer_;
};

}  // namespace bough::step
