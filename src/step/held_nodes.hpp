#pragma once
/// Nodes that joints hold at rest (Plan::held) have no unknowns. This class tells which rows and columns of elements at
/// such nodes the solver keeps, and recovers the multipliers of the holding joints from the balance of forces at the
/// node. Internal to step.
#include <cstdint>
#include <span>
#include <vector>

#include "bough/plan/plan.hpp"
#include "bough/solve/element_view.hpp"
#include "bough/step/instant.hpp"
#include "bough/step/unknown_places.hpp"
#include "bough/tree/walker.hpp"

namespace bough::step {

class HeldNodes {
 public:
  using Vec6List = std::vector<motion::Vec6<double>>;
  explicit HeldNodes(const plan::Plan& plan);

  /// Whether an element is a joint that holds a node. Such a joint has no entries in the linear system, and its
  /// residual is not evaluated.
  bool leaves_out(std::size_t element) const { return kind_[element] == Kind::holds; }
  /// Whether only some of the rows and columns of an element are in the linear system.
  bool trims(std::size_t element) const { return kind_[element] != Kind::whole; }
  /// The unknowns of a trimmed element that are in the linear system, by their local numbers in the element.
  std::span<const std::int8_t> kept(std::size_t element) const {
    return {kept_.data() + begin_[element], static_cast<std::size_t>(begin_[element + 1] - begin_[element])};
  }

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
  enum class Kind : std::uint8_t { whole, trimmed, holds };
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
  std::vector<Kind> kind_;              ///< by element
  std::vector<std::int64_t> begin_{0};  ///< by element: range in kept_
  std::vector<std::int8_t> kept_;
  std::vector<std::vector<Use>> uses_;  ///< by held node: attached elements, ascending, without its holding joints
};

/// Calls f(place, i) for every entry i of an element's row-major n x n matrix that is in the linear system; `place` is
/// its index in the solver's element matrix. held: may be null.
template <class F>
void for_each_kept(const HeldNodes* held, std::size_t element, int n, F&& f) {
  if (held == nullptr || !held->trims(element)) {
    for (int i = 0; i < n * n; ++i) f(i, i);
    return;
  }
  std::int64_t place = 0;
  const std::span<const std::int8_t> kept = held->kept(element);
  for (const int row : kept)
    for (const int column : kept) f(place++, row * n + column);
}

/// Writes the entries entry(i) of an element's matrix to the solver's storage.
template <class Entry>
void write_matrix(const HeldNodes* held, std::size_t element, int n, Entry&& entry, const solve::ElementView& to) {
  for_each_kept(held, element, n, [&](std::int64_t place, int i) { to[place] = entry(i); });
}

}  // namespace bough::step
