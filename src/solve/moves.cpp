#include "moves.hpp"

#include <algorithm>

namespace bough::solve {

void MovePlanner::begin(int size, int eliminated) {
  size_ = size;
  eliminated_ = eliminated;
  reached_.assign(at(size) * at(size), 0);
  assembly_.move_begin = static_cast<int>(lists_.moves.size());
  assembly_.gap_begin = static_cast<int>(lists_.gaps.size());
}

void MovePlanner::add(int contributor, std::span<const Run> runs) {
  for_blocks(contributor, runs, is_symmetric_, 0, size_, [&](const Move& move) { add_move(move); });
}

void MovePlanner::add_move(Move move) {
  int places = 0, already = 0;
  const auto for_places = [&](auto&& body) {
    for (int j = move.column; j < move.column + move.columns; ++j)
      for (int i = move.row; i < move.row + move.rows; ++i)
        if (has_place(i, j)) body(reached(i, j));
  };
  for_places([&](char known) {
    ++places;
    already += known;
  });
  move.is_first = already == 0;
  if (already > 0 && already < places)
    fill_gaps(move.row, move.row + move.rows, move.column, move.column + move.columns);
  for_places([](char& known) { known = 1; });
  lists_.moves.push_back(move);
}

void MovePlanner::fill_gaps(int row, int row_end, int column, int column_end) {
  const auto is_gap = [&](int i, int j) { return i < row_end && has_place(i, j) && reached(i, j) == 0; };
  for (int j = column; j < column_end; ++j)
    for (int i = row; i < row_end; ++i) {
      if (!is_gap(i, j)) continue;
      Gap gap{i, j, 0};
      const bool is_above = i < eliminated_ && j >= eliminated_;  // the boundary is stored elsewhere
      for (; is_gap(i, j) && !(is_above && i == eliminated_); ++i, ++gap.rows) reached(i, j) = 1;
      lists_.gaps.push_back(gap);
      --i;
    }
}

Assembly MovePlanner::finish() {
  fill_gaps(0, size_, 0, size_);
  assembly_.move_end = static_cast<int>(lists_.moves.size());
  assembly_.gap_end = static_cast<int>(lists_.gaps.size());
  return assembly_;
}

}  // namespace bough::solve
