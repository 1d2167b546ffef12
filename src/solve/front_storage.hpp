#pragma once
/// How much memory the parts of a front take and where Schur complements stand. Internal to solve.
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

/// Where Schur complements stand, by front: from `begin` on, in the factor of the front `host` or, where that is
/// tree::none, in a pool.
struct SchurPlaces {
  std::vector<std::int64_t> begin;
  std::vector<tree::FrontId> host;
  std::int64_t pool = 0;  ///< its size [doubles]
};

/// Schur complements are given up when the parent has been eliminated. Until a front is assembled, the place of its
/// factor holds what its grandchildren left, as far as there is room. In the pool fronts of even and odd depth have
/// places of their own, and a front's place holds what its grandchildren left. Fronts of one leaf are eliminated one
/// after the other and share, sub-domains that may be visited at once never do. in_lanes: by front, negative for
/// those that have such a place. keep_all: nothing is shared. is_symmetric: of the smallest factors that there will
/// be.
SchurPlaces plan_schur(const tree::Tree& tree, const std::vector<int>& in_lanes, bool keep_all, bool is_symmetric);

}  // namespace bough::solve
