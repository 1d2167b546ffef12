#pragma once
/// The pivot test of all fronts, on the scalar path and in lanes. Internal to solve.
#include <algorithm>
#include <limits>

namespace bough::solve {

/// Conditions for accepting a pivot, in scaled variables. Elimination in lanes, which never exchanges rows, applies
/// them to eight fronts at once (lane_registers.hpp), without marks.
struct PivotRule {
  double threshold = 0.02;  ///< smallest ratio to the column's largest entry, boundary rows included
  double least = 1e-9;      ///< smallest magnitude
  /// By global unknown: those whose pivots must reach least_of_marked as well; null: none.
  const bool* marked = nullptr;
  double least_of_marked = 0.0;

  /// Smallest magnitude of a pivot of an unknown whose column's largest entry is `largest`.
  double least_beside(double largest, int unknown) const {
    const bool is_marked = marked != nullptr && marked[unknown];
    return std::max(
        {threshold * largest, least, is_marked ? least_of_marked : 0.0, std::numeric_limits<double>::min()});
  }
};

}  // namespace bough::solve
