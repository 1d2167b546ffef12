/// Transfers of every block into the common fronts of a group, and the memory of their Schur complements.
#include <algorithm>

#include "lane_planner.hpp"

namespace bough::solve {

void LanePlanner::add_moves(LaneFront& f) {
  const int n = f.size(), e = f.eliminated, b = f.boundary;
  std::vector<char> reached(at(static_cast<std::int64_t>(n) * n), 0);
  f.move_begin = static_cast<int>(plan_.moves.size());
  f.gap_begin = static_cast<int>(plan_.gaps.size());
  const auto place = [&](LaneMove& move, int row, int column) {
    move.to_schur = row >= e && column >= e;
    if (column < e) {
      move.target = static_cast<std::int64_t>(column) * n + row;
      move.target_step = n;
    } else if (row < e) {
      move.target = static_cast<std::int64_t>(e) * n + static_cast<std::int64_t>(column - e) * e + row;
      move.target_step = e;
    } else {
      move.target = static_cast<std::int64_t>(column - e) * b + row - e;
      move.target_step = b;
    }
  };
  const auto has_place = [&](int i, int j) { return !is_symmetric_ || i >= j; };
  const auto fill_gaps = [&](int row, int column, int rows, int columns) {
    for (int j = column; j < column + columns; ++j)
      for (int i = row; i < row + rows;) {
        if (!has_place(i, j) || reached[at(static_cast<std::int64_t>(j) * n + i)] != 0) {
          ++i;
          continue;
        }
        LaneMove where;
        place(where, i, j);
        const bool above = i < e && j >= e;  // U12 and the Schur complement are not adjacent
        int count = 0;
        for (; i < row + rows && reached[at(static_cast<std::int64_t>(j) * n + i)] == 0 && !(above && i == e);
             ++i, ++count)
          reached[at(static_cast<std::int64_t>(j) * n + i)] = 1;
        plan_.gaps.push_back({where.target, count, where.to_schur});
      }
  };
  const auto add = [&](LaneMove move, int row, int column) {
    if (is_symmetric_ && row < column) return;  // blocks are equal or disjoint
    move.is_triangle = is_symmetric_ && row == column;
    place(move, row, column);
    int already = 0, places = 0;
    for (int j = column; j < column + move.columns; ++j)
      for (int i = row; i < row + move.rows; ++i)
        if (has_place(i, j)) {
          ++places;
          already += reached[at(static_cast<std::int64_t>(j) * n + i)];
        }
    move.is_first = already == 0;
    if (already > 0 && already < places) fill_gaps(row, column, move.rows, move.columns);
    for (int j = column; j < column + move.columns; ++j)
      for (int i = row; i < row + move.rows; ++i) reached[at(static_cast<std::int64_t>(j) * n + i)] = 1;
    plan_.moves.push_back(move);
  };
  for (int c = f.child_begin; c < f.child_end; ++c) {
    const LaneChild& child = plan_.children[at(c)];
    const LaneFront& from = plan_.fronts[at(child.front)];
    for (auto q = child.run_begin; q < child.run_end; ++q)
      for (auto p = child.run_begin; p < child.run_end; ++p) {
        const LaneRun &rows = plan_.runs[at(p)], &columns = plan_.runs[at(q)];
        add({.source = static_cast<std::int64_t>(columns.from - from.eliminated) * from.boundary + rows.from -
                       from.eliminated,
             .rows = rows.length,
             .columns = columns.length,
             .row_step = 1,
             .column_step = from.boundary,
             .child = c - f.child_begin},
            rows.to, columns.to);
      }
  }
  for (int i = f.element_begin; i < f.element_end; ++i) {
    const LaneElement& element = plan_.elements[at(i)];
    int row = 0;
    for (auto p = element.place_begin; p < element.place_end; ++p) {
      int column = 0;
      for (auto q = element.place_begin; q < element.place_end; ++q) {
        add({.source = element.values / lanes_wide - f.values + static_cast<std::int64_t>(row) * element.size + column,
             .rows = plan_.places[at(p)].length,
             .columns = plan_.places[at(q)].length,
             .row_step = element.size,
             .column_step = 1},
            plan_.places[at(p)].row, plan_.places[at(q)].row);
        column += plan_.places[at(q)].length;
      }
      row += plan_.places[at(p)].length;
    }
  }
  fill_gaps(0, 0, n, n);
  f.move_end = static_cast<int>(plan_.moves.size());
  f.gap_end = static_cast<int>(plan_.gaps.size());
  share_moves(f);
}

/// Uses the lists of one of the last fronts with new lists if they are equal.
void LanePlanner::share_moves(LaneFront& f) {
  constexpr std::size_t remembered = 32;
  const auto same = [](const auto& list, int begin_a, int end_a, int begin_b, int end_b) {
    return std::equal(list.begin() + begin_a, list.begin() + end_a, list.begin() + begin_b, list.begin() + end_b);
  };
  for (const MoveLists& known : move_lists_) {
    if (!same(plan_.moves, f.move_begin, f.move_end, known.move_begin, known.move_end) ||
        !same(plan_.gaps, f.gap_begin, f.gap_end, known.gap_begin, known.gap_end))
      continue;
    plan_.moves.resize(at(f.move_begin));
    plan_.gaps.resize(at(f.gap_begin));
    f.move_begin = known.move_begin;
    f.move_end = known.move_end;
    f.gap_begin = known.gap_begin;
    f.gap_end = known.gap_end;
    return;
  }
  if (move_lists_.size() == remembered) move_lists_.erase(move_lists_.begin());
  move_lists_.push_back({f.move_begin, f.move_end, f.gap_begin, f.gap_end});
}

void LanePlanner::place_work(LaneGroup& group) {
  struct Live {
    std::int64_t begin, end;
    int last;  ///< front that reads it
  };
  const int begin = group.front_begin, end = static_cast<int>(plan_.fronts.size());
  std::vector<int> reader(at(end - begin), end);
  for (int i = begin; i < end; ++i)
    for (int c = plan_.fronts[at(i)].child_begin; c < plan_.fronts[at(i)].child_end; ++c)
      if (plan_.children[at(c)].front >= begin) reader[at(plan_.children[at(c)].front - begin)] = i;
  std::vector<Live> live;  // by begin
  std::int64_t most = 0;
  for (int i = begin; i < end; ++i) {
    LaneFront& f = plan_.fronts[at(i)];
    const std::int64_t size = f.schur_size() + f.size();
    if (f.is_top) {
      f.schur = plan_.top_size;
      plan_.top_size += size;
      continue;
    }
    std::erase_if(live, [&](const Live& x) { return x.last < i; });
    std::int64_t place = 0;
    auto it = live.begin();
    for (; it != live.end() && it->begin < place + size; ++it) place = it->end;
    live.insert(it, {place, place + size, reader[at(i - begin)]});
    most = std::max(most, place + size);
    f.schur = place;
  }
  group.scratch = most;
}

}  // namespace bough::solve
