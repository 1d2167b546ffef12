#pragma once
/// What the solver does not see of elements at nodes that joints hold at rest (Plan::held); the multipliers of
/// joints that hold nodes at rest, from the balance of the node. Internal to step.
#include <cstdint>
#include <span>
#include <vector>

#include "bough/plan/plan.hpp"
#include "bough/solve/element_view.hpp"
#include "bough/step/state.hpp"

namespace bough::step {

class System;

class HeldNodes {
 public:
  using Vec6List = std::vector<motion::Vec6<double>>;
  explicit HeldNodes(const plan::Plan& plan);

  /// Whether an element is a joint that holds a node: the solver sees nothing of it, and no residual of it is wanted.
  bool leaves_out(std::size_t element) const { return kind_[element] == Kind::holds; }
  /// Whether the solver sees a part of an element only.
  bool trims(std::size_t element) const { return kind_[element] != Kind::whole; }
  /// Unknowns of a trimmed element that the solver has, by their numbers in the element.
  std::span<const std::int8_t> kept(std::size_t element) const {
    return {kept_.data() + begin_[element], static_cast<std::size_t>(begin_[element + 1] - begin_[element])};
  }

  /// Multipliers of all joints that hold:  W multipliers = -(forces of all other elements on the node), in statics
  /// with what these lack to first order, f + K eta (State::unsettled). more: forces by node beside those of
  /// elements, or null. in_plane: elements in the scene's plane are asked, else those in space.
  void recover_multipliers(const System& system, State& state, const Vec6List* more, bool in_plane) const;
  /// Largest of W^-1 M eta, eta the increments of the nodes by a vector x of unknowns.
  double largest_impulse(const System& system, const State& state, const double* x) const;

 private:
  enum class Kind : std::uint8_t { whole, trimmed, holds };
  /// An element at a held node, and which of its nodes that is, those on the ground not counted.
  struct Use {
    std::size_t element;
    int part;
  };

  template <class AddForces>
  void balance(std::size_t held, motion::Vec6<double> forces, AddForces&& add_forces, double* multipliers) const;

  const plan::Plan& plan_;
  std::vector<Kind> kind_;              ///< by element
  std::vector<std::int64_t> begin_{0};  ///< by element: range in kept_
  std::vector<std::int8_t> kept_;
  std::vector<std::vector<Use>> uses_;  ///< by held node, in the order of elements; without the joints that hold it
};

/// Calls f(place, i) for every entry i of an element's n x n matrix, row-major, that the solver takes, and its place
/// there. held: may be null.
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

/// Writes an element's matrix of entries entry(i) where the solver takes it.
template <class Entry>
void write_matrix(const HeldNodes* held, std::size_t element, int n, Entry&& entry, const solve::ElementView& to) {
  for_each_kept(held, element, n, [&](std::int64_t place, int i) { to[place] = entry(i); });
}

}  // namespace bough::step
