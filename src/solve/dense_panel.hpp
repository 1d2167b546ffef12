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

constexpr double least_shared_flops = 4e6;  ///< some 100 microseconds: less is not distributed to threads

/// Calls update(first, last) for chunks of the columns [begin, full) and [full, size), on the walker's threads if the
/// work is large enough. flops: of one column. parts: see tree::Chunk.
template <class Update>
void for_chunks_of_columns(int begin, int full, int size, double flops, const tree::Walker* walker,
                           const Update& update, int parts = 1) {
  constexpr int chunk = tiles::chunk;
  const int of_full = (full - begin + chunk - 1) / chunk, of_boundary = (size - full + chunk - 1) / chunk;
  auto run = [&](std::int64_t first, std::int64_t last) {
    for (auto c = static_cast<int>(first); c < last; ++c) {
      const int j = c < of_full ? begin + c * chunk : full + (c - of_full) * chunk;
      update(j, std::min(j + chunk, c < of_full ? full : size));
    }
  };
  const int count = of_full + of_boundary;
  if (walker == nullptr || walker->each == nullptr || flops * (size - begin) < least_shared_flops) {
    run(0, count);
  } else {
    walker->for_each_chunk(count, 1, tree::make_chunk(run, tree::Work::other, parts));
  }
}

/// Rows of a tile of an update that threads share out: a multiple of the rows of every register tile, and enough that
/// packing the columns once for each tile takes a few per cent.
constexpr int strip = 384;

/// The update of all columns from `end` on by the pivots [begin, k), whose rows precede `end`. A large one is cut into
/// tiles of `chunk` columns and `strip` rows, which the walker's threads share out; the bits are the same.
template <class Kind>
void update_remaining(const FrontMatrix& f, const Kind& kind, int begin, int k, int end, const tree::Walker* walker) {
  const auto whole = [&](int first, int last) { kind.catch_up(begin, k, first, last); };
  const double flops = kind.flops * (k - begin) * (f.size - k);  // of a column
  const int strips = (f.size - k + strip - 1) / strip;
  if (walker == nullptr || walker->each == nullptr || walker->threads == 1 ||
      flops * (f.size - end) < least_shared_flops)
    return for_chunks_of_columns(end, f.full, f.size, flops, walker, whole, strips);
  for_chunks_of_columns(end, f.full, f.size, flops, walker,
                        [&](int first, int last) { kind.prepare(begin, k, first, last); });
  constexpr int chunk = tiles::chunk;
  const int of_full = (f.full - end + chunk - 1) / chunk, of_boundary = (f.size - f.full + chunk - 1) / chunk;
  auto run = [&](std::int64_t from, std::int64_t to) {
    for (std::int64_t t = from; t < to; ++t) {
      const auto c = static_cast<int>(t / strips), row = k + static_cast<int>(t % strips) * strip;
      const int first = c < of_full ? end + c * chunk : f.full + (c - of_full) * chunk;
      const int last = std::min(first + chunk, c < of_full ? f.full : f.size);
      kind.update(begin, k, first, last, row, std::min(row + strip, f.size));
    }
  };
  walker->for_each_chunk(static_cast<std::int64_t>(of_full + of_boundary) * strips, 1, tree::make_chunk(run));
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

/// Eliminates a front panel by panel. A panel is halved until it is narrow enough for columns one by one; the pivots of
/// the left half then update the right half at once.
template <class Kind>
struct PanelElimination {
  const FrontMatrix& f;
  const Kind& kind;
  const PivotRule& rule;
  int k = 0;      ///< pivots
  int tried = 0;  ///< unknowns [k, tried) were rejected and are tried again with the next ones

  /// Tries the unknowns up to `end`; updates only their columns. False if an entry is not finite.
  bool run(int end) {
    if (end - tried <= inner_panel + inner_panel / 2) {
      k = eliminate_panel(f, kind, rule, k, end);
      tried = end;
      return k >= 0;
    }
    const int begin = k, half = (end - tried + 1) / 2;
    const int middle = tried + (half + inner_panel - 1) / inner_panel * inner_panel;
    if (!run(middle)) return false;
    for (int j = middle; k > begin && j < end; j += tiles::chunk)
      kind.catch_up(begin, k, j, std::min(end, j + tiles::chunk));
    return run(end);
  }
};

/// Eliminates all fully summed unknowns of a front that the rule accepts. kind.catch_up(begin, k, first, last) updates
/// columns [first, last), at most a chunk and all on one side of `full`, by the pivots [begin, k); the same in two
/// parts: kind.prepare(begin, k, first, last) computes their rows [begin, k), and kind.update(begin, k, first, last,
/// row, row_end) updates rows of them. kind.flops: of an entry and a pivot. Returns the number of pivots, or -1 if an
/// entry is not finite.
template <class Kind>
int eliminate_in_panels(const FrontMatrix& f, const Kind& kind, const PivotRule& rule, const tree::Walker* walker) {
  PanelElimination<Kind> panel{f, kind, rule};
  while (panel.tried < f.full) {
    const int begin = panel.k, end = end_of_panel(panel.tried, f.full, outer_panel);
    if (!panel.run(end)) return -1;
    if (panel.k > begin) update_remaining(f, kind, begin, panel.k, end, walker);
  }
  return panel.k;
}

/// move_negligible_last() of a symmetric front.
int move_negligible_last_symmetric(FrontMatrix& front, int pivots, const Negligible& negligible,
                                   const bool* is_candidate);

}  // namespace bough::solve
