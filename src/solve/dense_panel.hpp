#pragma once
/// Common parts of the eliminations of a front: panels, the search of a column, chunks of columns for threads. Internal
/// to solve.
#include <algorithm>
#include <bit>
#include <cmath>
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

/// Eliminates pivots within columns [k, end) of a front, and updates only these. A column that the rule rejects goes to
/// the end and is tried again once others have changed it. Returns the new k; -1 if an entry is not finite.
/// kind.take_pivot(k, open, end, least) eliminates a pivot in place k, of rows among the candidates [k, open), and
/// returns its number of rows: 0 where there is none. kind.exchange(k, open) exchanges two unknowns.
template <class Kind>
int eliminate_panel(const FrontMatrix& f, const Kind& kind, const PivotRule& rule, int k, int end) {
  int open = end;  // columns [open, end) were rejected in this round
  bool progress = false;
  for (;;) {
    if (k == open) {
      if (open == end || !progress) return k;
      open = end;  // the rejected columns have changed: another round
      progress = false;
    }
    const double largest = find_largest(kind.parts.top(k), k, f.size);
    if (!std::isfinite(largest)) return -1;
    const int rows = kind.take_pivot(k, open, end, rule.least_beside(largest, f.columns[k]));
    k += rows;
    progress = progress || rows > 0;
    if (rows == 0) kind.exchange(k, --open);
  }
}

/// Eliminates all fully summed unknowns of a front that the rule accepts, panel by panel. kind.catch_up(begin, k,
/// first, last) updates columns [first, last), at most a chunk and all on one side of `full`, by the pivots [begin, k);
/// kind.flops: of an entry and a pivot. Returns the number of pivots, or -1 if an entry is not finite.
template <class Kind>
int eliminate_in_panels(const FrontMatrix& f, const Kind& kind, const PivotRule& rule, const tree::Walker* walker) {
  int k = 0, tried = 0;  // unknowns [k, tried) were rejected by earlier panels and are tried again with the next one
  while (tried < f.full) {
    const int begin = k, end = end_of_panel(tried, f.full, outer_panel);
    while (tried < end) {
      const int inner_begin = k, inner_end = end_of_panel(tried, end, inner_panel);
      k = eliminate_panel(f, kind, rule, k, inner_end);
      if (k < 0) return -1;
      for (int j = inner_end; k > inner_begin && j < end; j += tiles::chunk)
        kind.catch_up(inner_begin, k, j, std::min(end, j + tiles::chunk));
      tried = inner_end;
    }
    if (k == begin) continue;
    const auto update = [&](int first, int last) { kind.catch_up(begin, k, first, last); };
    for_chunks_of_columns(end, f.full, f.size, kind.flops * (k - begin) * (f.size - k), walker, update);
  }
  return k;
}

/// Symmetric: updates columns [first, last), at most a chunk and all on one side of `full`, by the pivots [begin, k),
/// whose D is d.
void catch_up_symmetric(const FrontParts& front, const double* d, int begin, int k, int first, int last);

/// move_negligible_last() of a symmetric front.
int move_negligible_last_symmetric(FrontMatrix& front, int pivots, const Negligible& negligible,
                                   const bool* is_candidate);

}  // namespace bough::solve
