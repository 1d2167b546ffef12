#pragma once
/// Assembly of fronts: the blocks of elements and of children's Schur complements, and their places. An entry is a
/// number on the scalar path and a pack in lanes, where lists of the blocks are made once. Internal to solve.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "bough/blocks/at.hpp"
#include "dense.hpp"

namespace bough::solve {

/// Adjacent rows of an element, or of the boundary of a child, that go to adjacent rows of a front, on one side of the
/// beginning of its boundary.
struct Run {
  int from;  ///< first row of the element or of the child's boundary
  int to;    ///< first row of the front, before room is made for delayed pivots
  int length;
  bool operator==(const Run&) const = default;
};

/// The transfer of one block into a front.
struct Move {
  int contributor;            ///< i: the i-th child of the front; ~i: its i-th element
  int from_row, from_column;  ///< in the element, or in the child's Schur complement
  int row, column, rows, columns;
  bool is_triangle = false;  ///< a block on the diagonal of a symmetric front: entries above the diagonal are omitted
  bool is_first = false;     ///< the first at its target: written, not added
};

/// The first entry of a block in memory, and the distances of its rows and columns in entries.
struct Source {
  const double* first;
  std::ptrdiff_t row_step, column_step;
  /// In lanes, of a child's Schur complement, column by column: its lane from_lane[l] goes to lane l, or zero if that
  /// is negative. Null: all lanes stay.
  const std::int8_t* from_lane = nullptr;
};

/// A block of a front in memory.
struct Target {
  double* first;
  std::ptrdiff_t step;  ///< doubles between columns
};

/// Where entry (row, column) of a front is, each of whose entries is `wide` doubles. Leading dimensions of `to` are in
/// doubles.
template <int wide>
Target target_of(const FrontParts& to, int row, int column) {
  const std::ptrdiff_t i = row, j = column, full = to.full;
  if (j < full) return {to.a + j * to.lda + i * wide, to.lda};
  if (i < full) return {to.u + (j - full) * to.ldu + i * wide, to.ldu};
  return {to.s + (j - full) * to.lds + (i - full) * wide, to.lds};
}

/// Calls body(move) for what a block has in columns [first, last) of the front.
template <class Body>
void in_columns(Move move, int first, int last, Body&& body) {
  const int begin = std::max(0, first - move.column), end = std::min(move.columns, last - move.column);
  if (begin >= end) return;
  const int above = move.is_triangle ? begin : 0;
  move.from_row += above;
  move.from_column += begin;
  move.row += above;
  move.rows -= above;
  move.column += begin;
  move.columns = end - begin;
  body(move);
}

/// Calls body(move) for what the blocks of a contributor have in columns [first, last) of the front, all to be added;
/// symmetric: for those on and below the diagonal. Precondition: if symmetric, runs to the same rows are equal.
template <class Body>
void for_blocks(int contributor, std::span<const Run> runs, bool is_symmetric, int first, int last, Body&& body) {
  for (const Run& column : runs) {
    if (column.to >= last || column.to + column.length <= first) continue;
    for (const Run& row : runs)
      if (!is_symmetric || row.to >= column.to)
        in_columns({.contributor = contributor,
                    .from_row = row.from,
                    .from_column = column.from,
                    .row = row.to,
                    .column = column.to,
                    .rows = row.length,
                    .columns = column.length,
                    .is_triangle = is_symmetric && row.to == column.to},
                   first, last, body);
  }
}

/// Entries of a column of a front to which nothing contributes.
struct Gap {
  int row, column, rows;
};

/// The lists of one front.
struct Assembly {
  int move_begin = 0, move_end = 0;
  int gap_begin = 0, gap_end = 0;
};

struct MoveLists {
  std::vector<Move> moves;
  std::vector<Gap> gaps;
  std::span<const Move> moves_of(const Assembly& a) const {
    return std::span(moves).subspan(at(a.move_begin), at(a.move_end - a.move_begin));
  }
  std::span<const Gap> gaps_of(const Assembly& a) const {
    return std::span(gaps).subspan(at(a.gap_begin), at(a.gap_end - a.gap_begin));
  }
};

/// Makes the lists of fronts, one after the other. The first move to a target is written, later ones are added, and the
/// rest is a gap, so that no front is cleared as a whole.
class MovePlanner {
 public:
  explicit MovePlanner(bool is_symmetric = false) : is_symmetric_(is_symmetric) {}
  /// Begins the lists of a front of `size` unknowns, `eliminated` of which are eliminated there.
  void begin(int size, int eliminated);
  /// Adds the blocks of its next contributor, numbered as in Move.
  void add(int contributor, std::span<const Run> runs);
  Assembly finish();
  MoveLists take() { return std::move(lists_); }

 private:
  void add_move(Move move);
  /// Lists what nothing has reached of rows [row, row_end) and columns [column, column_end).
  void fill_gaps(int row, int row_end, int column, int column_end);
  bool has_place(int row, int column) const { return !is_symmetric_ || row >= column; }
  char& reached(int row, int column) { return reached_[at(column) * at(size_) + at(row)]; }

  bool is_symmetric_;
  MoveLists lists_;
  int size_ = 0, eliminated_ = 0;
  Assembly assembly_;
  std::vector<char> reached_;  ///< by entry of the front
};

}  // namespace bough::solve
