#pragma once
/// Common parts of the eliminations of a front: panels, the search of a column, chunks of columns for threads. Internal
/// to solve.
#include <algorithm>
#include <bit>
#include <cstdint>

#include "bough/tree/walker.hpp"
#include "dense.hpp"
#include "dense_tiles.hpp"

namespace bough::solve {

constexpr int outer_panel = 64;  ///< pivots of one update of all remaining columns
constexpr int inner_panel = 8;   ///< pivots that are eliminated one by one before the panel is updated

/// End of the panel that begins at `begin`, chosen so that no small last panel remains.
inline int end_of_panel(int begin, int end, int width) {
  return end - begin <= width + width / 2 ? end : begin + width;
}

/// Largest magnitude of rows [begin, end), compared as bits, in which infinity and NaN are above every finite number.
inline double find_largest(const double* column, int begin, int end) {
  constexpr std::uint64_t magnitude = ~std::uint64_t{0} >> 1;
  std::uint64_t largest = 0;
  for (int i = begin; i < end; ++i) largest = std::max(largest, std::bit_cast<std::uint64_t>(column[i]) & magnitude);
  return std::bit_cast<double>(largest);
}

/// Calls update(first, last) for chunks of the columns [begin, full) and [full, size), on the walker's threads if the
/// work is large enough. flops: of one column.
template <class Update>
void for_chunks_of_columns(int begin, int full, int size, double flops, const tree::Walker* walker,
                           const Update& update) {
  constexpr double least_flops = 4e6;  // some 100 microseconds
  constexpr int chunk = tiles::chunk;
  const int of_full = (full - begin + chunk - 1) / chunk, of_boundary = (size - full + chunk - 1) / chunk;
  auto run = [&](std::int64_t first, std::int64_t last) {
    for (auto c = static_cast<int>(first); c < last; ++c) {
      const int j = c < of_full ? begin + c * chunk : full + (c - of_full) * chunk;
      update(j, std::min(j + chunk, c < of_full ? full : size));
    }
  };
  const int count = of_full + of_boundary;
  if (walker == nullptr || walker->each == nullptr || flops * (size - begin) < least_flops) {
    run(0, count);
  } else {
    walker->for_each_chunk(count, 1, tree::make_chunk(run));
  }
}

/// Symmetric: updates columns [first, last), at most a chunk and all on one side of `full`, by the pivots [begin, k),
/// whose D is d.
void catch_up_symmetric(const FrontParts& front, const double* d, int begin, int k, int first, int last);

/// move_negligible_last() of a symmetric front.
int move_negligible_last_symmetric(FrontMatrix& front, int pivots, const Negligible& negligible,
                                   const bool* is_candidate);

}  // namespace bough::solve
