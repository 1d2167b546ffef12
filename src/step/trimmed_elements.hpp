#pragma once
/// Which rows and columns of elements the linear system contains. Nodes that joints hold at rest (Plan::held) have no
/// unknowns, and points (NodePlan::is_point) have no rotations, while an element computes its residual and its tangent
/// for all components of its nodes. Internal to step.
#include <cstdint>
#include <span>
#include <vector>

#include "bough/plan/plan.hpp"
#include "bough/solve/element_view.hpp"

namespace bough::step {

class TrimmedElements {
 public:
  explicit TrimmedElements(const plan::Plan& plan);
  /// Whether a plan has nodes with fewer unknowns than others.
  static bool are_in(const plan::Plan& plan) { return !plan.held.empty() || !plan.unknowns.is_point.empty(); }

  /// Whether an element is a joint that holds a node. Such a joint has no entries in the linear system, and its
  /// residual is not evaluated.
  bool leaves_out(std::size_t element) const { return kind_[element] == Kind::holds; }
  /// Whether only some of the rows and columns of an element are in the linear system.
  bool trims(std::size_t element) const { return kind_[element] != Kind::whole; }
  /// The unknowns of a trimmed element that are in the linear system, by their local numbers in the element.
  std::span<const std::int8_t> kept(std::size_t element) const {
    return {kept_.data() + begin_[element], static_cast<std::size_t>(begin_[element + 1] - begin_[element])};
  }

 private:
  enum class Kind : std::uint8_t { whole, trimmed, holds };
  std::vector<Kind> kind_;              ///< by element
  std::vector<std::int64_t> begin_{0};  ///< by element: range in kept_
  std::vector<std::int8_t> kept_;
};

/// Calls f(place, i) for every entry i of an element's row-major n x n matrix that is in the linear system; `place` is
/// its index in the solver's element matrix. trimmed: may be null.
template <class F>
void for_each_kept(const TrimmedElements* trimmed, std::size_t element, int n, F&& f) {
  if (trimmed == nullptr || !trimmed->trims(element)) {
    for (int i = 0; i < n * n; ++i) f(i, i);
    return;
  }
  std::int64_t place = 0;
  const std::span<const std::int8_t> kept = trimmed->kept(element);
  for (const int row : kept)
    for (const int column : kept) f(place++, row * n + column);
}

/// Writes the entries entry(i) of an element's matrix to the solver's storage.
template <class Entry>
void write_matrix(const TrimmedElements* trimmed, std::size_t element, int n, Entry&& entry,
                  const solve::ElementView& to) {
  for_each_kept(trimmed, element, n, [&](std::int64_t place, int i) { to[place] = entry(i); });
}

}  // namespace bough::step
