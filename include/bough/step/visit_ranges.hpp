#pragma once
/// Items in the order of the visits of the solver's walks (solve::SolverVisits).
#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "bough/tree/walker.hpp"

namespace bough::step {

/// Numbers of items that a task takes at once: nodes and pairs of nodes, by eights.
inline constexpr std::int64_t eight_grain = 8, pair_grain = 16;

/// Items that are numbered visit after visit.
class VisitRanges {
 public:
  VisitRanges() = default;
  /// of_item: the visit of each item, ascending.
  VisitRanges(const std::vector<int>& of_item, int num_visits) {
    for (int v = 0; v <= num_visits; ++v)
      begin_.push_back(std::lower_bound(of_item.begin(), of_item.end(), v) - of_item.begin());
  }

  std::int64_t begin(int visit) const { return begin_[static_cast<std::size_t>(visit)]; }
  std::int64_t end(int visit) const { return begin(visit + 1); }
  bool is_empty(int visit) const { return begin(visit) == end(visit); }
  std::int64_t count() const { return begin_.empty() ? 0 : begin_.back(); }

  /// Calls f(begin, end) for the items of a visit: at once, or in chunks of `grain` items on several threads where the
  /// visit has a large part of all items, so that other visits cannot occupy the threads. Results must not depend on
  /// the division. No allocation.
  template <class F>
  void for_each(const tree::Walker& walker, int visit, std::int64_t grain, F&& f) const {
    const std::int64_t first = begin(visit), size = end(visit) - first;
    if (size == 0) return;
    if (walker.threads == 1 || size <= grain || 2 * size * walker.threads <= count()) return f(first, first + size);
    auto chunk = [&f, first](std::int64_t from, std::int64_t to) { f(first + from, first + to); };
    walker.for_each_chunk(size, grain, tree::make_chunk(chunk));
  }

 private:
  std::vector<std::int64_t> begin_;
};

}  // namespace bough::step
