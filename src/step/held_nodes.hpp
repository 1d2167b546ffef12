#pragma once
/// Recovers the multipliers of joints that hold nodes at rest (Plan::held) from the balance of forces at these nodes.
/// Internal to step.
#include <vector>

#include "bough/plan/plan.hpp"
#include "bough/step/instant.hpp"
#include "bough/step/unknown_places.hpp"
#include "bough/tree/walker.hpp"
#include "trimmed_elements.hpp"

namespace bough::step {

class HeldNodes {
 public:
  using Vec6List = std::vector<motion::Vec6<double>>;
  HeldNodes(const plan::Plan& plan, const TrimmedElements& trimmed);

  /// Sets the multipliers of all joints that hold nodes, from W multipliers = -(forces of all other elements on the
  /// node). In statics these forces include the first-order correction f + K eta (State::unsettled). more: additional
  /// forces by node, or null. In time the elements are those on the group of the scene,
  /// in statics those in space.
  void recover_multipliers(const Instant& instant, const tree::Walker& walker, State& state,
                           const Vec6List* more) const;
  /// Largest entry of W^-1 M eta over all held nodes; eta are the increments of nodes in the vector x of unknowns.
  double largest_impulse(const Instant& instant, const UnknownPlaces& places, const State& state,
                         const double* x) const;

 private:
  /// An element attached to a held node. `part` is the index of that node among the element's nodes, ports on the
  /// ground not counted.
  struct Use {
    std::size_t element;
    int part;
  };

  template <class G>
  void recover_on(const elements::FieldOn<G, double>& field, const tree::Walker& walker, State& state,
                  const Vec6List* more) const;
  template <class AddForces>
  void balance(std::size_t held, motion::Vec6<double> forces, AddForces&& add_forces, double* multipliers) const;

  const plan::Plan& plan_;
  std::vector<std::vector<Use>> uses_;  ///< by held node: attached elements, ascending, without its holding joints
};

}  // namespace bough::step
