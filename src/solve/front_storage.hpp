#pragma once
/// Sizes of the parts of a front, and places of Schur complements in memory. Internal to solve.
#include <cstdint>
#include <vector>

#include "bough/tree/tree.hpp"

namespace bough::solve {

/// Leading dimensions and sizes [doubles] of the parts of a front, see FrontMatrix.
struct FrontShape {
  int lda = 0, ldu = 0, lds = 0;
  bool is_symmetric = false;
  std::int64_t a = 0, d = 0, u = 0, s = 0;
  FrontShape(int size, int full, bool is_symmetric);
  std::int64_t factor_size() const { return a + d + u; }
};

/// Places of Schur complements, by front: from `begin` on in the factor of the front `host`, or in a pool if that is
/// tree::none.
struct SchurPlaces {
  std::vector<std::int64_t> begin;
  std::vector<tree::FrontId> host;
  std::int64_t pool = 0;  ///< its size [doubles]
};

/// The memory of a Schur complement is reused after the parent has been eliminated. Until a front is assembled, the
/// memory of its factor holds Schur complements of its grandchildren, if there is room. The pool has separate regions
/// for fronts of even and odd depth, and a front uses the region of its grandchildren. Fronts of one leaf are
/// eliminated one after the other and share memory; sub-domains that may be visited at the same time never do.
/// in_lanes: by front, negative for fronts that need a place. is_symmetric: sizes of factors are those of symmetric
/// fronts, the smallest possible.
SchurPlaces plan_schur(const tree::Tree& tree, const std::vector<int>& in_lanes, bool is_symmetric);

}  // namespace bough::solve
