#pragma once
/// Inversion of the small matrices of rows by which joints hold a node.

namespace bough::plan {

/// a <- a^-1 of an n x n matrix, row-major, n <= 6, by elimination with full pivoting of rows scaled to size 1.
/// False, and `a` as it was, where a row is zero or not finite or a pivot is below least_pivot times the largest.
/// Pure, no allocation.
[[nodiscard]] bool invert_small(double* a, int n, double least_pivot);

}  // namespace bough::plan
