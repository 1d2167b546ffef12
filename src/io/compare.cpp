#include "bough/io/compare.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "bough/io/columns.hpp"

namespace bough::io {
namespace {

constexpr std::size_t absent = std::numeric_limits<std::size_t>::max();

std::size_t index_of(const std::vector<std::string>& names, const std::string& name) {
  const auto found = std::find(names.begin(), names.end(), name);
  return found == names.end() ? absent : static_cast<std::size_t>(found - names.begin());
}

struct Bounds {
  double range = 0.0, magnitude = 0.0;
};

template <class ValueOf>
Bounds bounds_of(const History& history, const ValueOf& value_of) {
  double low = std::numeric_limits<double>::max(), high = -low;
  for (const records::HistoryRow& row : history.rows) {
    const double value = value_of(row);
    if (!std::isfinite(value)) continue;
    low = std::min(low, value);
    high = std::max(high, value);
  }
  if (low > high) return {};
  return {high - low, std::max(std::abs(low), std::abs(high))};
}

bool runs_forward(const History& history) {
  return std::adjacent_find(history.rows.begin(), history.rows.end(),
                            [](const auto& x, const auto& y) { return !(x.time < y.time); }) == history.rows.end();
}

using RowPairs = std::vector<std::pair<const records::HistoryRow*, const records::HistoryRow*>>;
/// Rows at equal times. Where times do not grow, as on a path past a limit point, rows are counted.
RowPairs pair_rows(const History& a, const History& b) {
  constexpr double equal = 1e-9;  // of the last time
  RowPairs pairs;
  if (a.rows.empty() || b.rows.empty()) return pairs;
  if (a.rows.size() == b.rows.size() || !runs_forward(a) || !runs_forward(b)) {
    for (std::size_t k = 0; k < std::min(a.rows.size(), b.rows.size()); ++k) pairs.emplace_back(&a.rows[k], &b.rows[k]);
    return pairs;
  }
  const double apart = equal * std::max(std::abs(a.rows.back().time), std::abs(b.rows.back().time));
  for (auto i = a.rows.begin(), j = b.rows.begin(); i != a.rows.end() && j != b.rows.end();) {
    if (std::abs(i->time - j->time) <= apart)
      pairs.emplace_back(&*i++, &*j++);
    else if (i->time < j->time)
      ++i;
    else
      ++j;
  }
  return pairs;
}

template <class ValueA, class ValueB>
ColumnDifference compare_column(const std::string& name, const RowPairs& rows, const Bounds& bounds,
                                const CompareOptions& options, const ValueA& in_a, const ValueB& in_b) {
  ColumnDifference difference;
  difference.name = name;
  difference.scale = bounds.range > 0.0 ? bounds.range : bounds.magnitude;
  for (const auto& [a, b] : rows) {
    const double value_a = in_a(*a), value_b = in_b(*b);
    if (!std::isfinite(value_a) || !std::isfinite(value_b)) {
      if (!difference.has_non_finite) difference.time = a->time;
      difference.has_non_finite = true;
    } else if (!difference.has_non_finite && std::abs(value_a - value_b) > difference.absolute) {
      difference.absolute = std::abs(value_a - value_b);
      difference.time = a->time;
    }
  }
  if (difference.absolute > 0.0) {
    difference.relative =
        difference.scale > 0.0 ? difference.absolute / difference.scale : std::numeric_limits<double>::infinity();
  }
  difference.holds = !difference.has_non_finite &&
                     (difference.absolute <= options.absolute || difference.relative <= options.relative);
  return difference;
}

std::vector<Bounds> bounds_by_group(const History& a) {
  std::vector<Bounds> bounds(a.header.columns.size());
  for (const ColumnGroup& group : group_columns(a.header.columns)) {
    Bounds widest;
    for (const std::size_t c : group.columns) {
      const Bounds own = bounds_of(a, [c](const records::HistoryRow& row) { return row.values[c]; });
      widest.range = std::max(widest.range, own.range);
      widest.magnitude = std::max(widest.magnitude, own.magnitude);
    }
    for (const std::size_t c : group.columns) bounds[c] = widest;
  }
  return bounds;
}

}  // namespace

Comparison compare_histories(const History& a, const History& b, const CompareOptions& options) {
  Comparison comparison;
  const RowPairs rows = pair_rows(a, b);
  if (a.rows.size() != b.rows.size())
    comparison.problems.push_back("A has " + std::to_string(a.rows.size()) + " rows, B has " +
                                  std::to_string(b.rows.size()) + ": compared are " + std::to_string(rows.size()) +
                                  (runs_forward(a) && runs_forward(b) ? " at equal times" : " from the first on"));
  if (a.rows.empty() || b.rows.empty()) comparison.problems.emplace_back("a history without rows");
  const auto compare_fixed = [&](const char* name, bool is_judged, const auto& value_of) {
    comparison.columns.push_back(compare_column(name, rows, bounds_of(a, value_of), options, value_of, value_of));
    comparison.columns.back().is_judged = is_judged;
  };
  compare_fixed("time", true, [](const records::HistoryRow& row) { return row.time; });
  compare_fixed("step_size", false, [](const records::HistoryRow& row) { return row.step_size; });
  compare_fixed("iterations", false,
                [](const records::HistoryRow& row) { return static_cast<double>(row.iterations); });

  const std::vector<Bounds> bounds = bounds_by_group(a);
  for (std::size_t c = 0; c < a.header.columns.size(); ++c) {
    const std::string& name = a.header.columns[c];
    const std::size_t d = index_of(b.header.columns, name);
    if (d == absent) {
      comparison.problems.push_back("column " + name + " is only in A");
      continue;
    }
    comparison.columns.push_back(compare_column(
        name, rows, bounds[c], options, [c](const records::HistoryRow& row) { return row.values[c]; },
        [d](const records::HistoryRow& row) { return row.values[d]; }));
  }
  for (const std::string& name : b.header.columns)
    if (index_of(a.header.columns, name) == absent) comparison.problems.push_back("column " + name + " is only in B");
  comparison.equal = comparison.problems.empty() &&
                     std::all_of(comparison.columns.begin(), comparison.columns.end(),
                                 [](const ColumnDifference& column) { return column.holds || !column.is_judged; });
  return comparison;
}

}  // namespace bough::io
