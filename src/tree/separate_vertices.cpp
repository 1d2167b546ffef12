#include <algorithm>
#include <cstddef>

#include "bisect.hpp"
#include "bough/blocks/at.hpp"
#ifdef BOUGH_HAS_METIS
#include <metis.h>
#include <stdlib.h>

#include <mutex>
#endif

namespace bough::tree {

namespace {

/// Breadth-first levels from a vertex; -1 where not reached. Returns the number of levels.
int find_levels(const std::vector<int>& row_begin, const std::vector<int>& columns, int start, std::vector<int>& level,
                int& last) {
  std::fill(level.begin(), level.end(), -1);
  std::vector<int> queue(1, start);
  level[at(start)] = 0;
  for (std::size_t k = 0; k < queue.size(); ++k) {
    const int v = queue[k];
    for (int c = row_begin[at(v)]; c < row_begin[at(v) + 1]; ++c) {
      const int w = columns[at(c)];
      if (level[at(w)] >= 0) continue;
      level[at(w)] = level[at(v)] + 1;
      queue.push_back(w);
    }
  }
  last = queue.back();
  return level[at(last)] + 1;
}

std::vector<int> separate_by_levels(const std::vector<int>& row_begin, const std::vector<int>& columns,
                                    const std::vector<int>& weights) {
  const int n = static_cast<int>(weights.size());
  std::vector<int> level(at(n)), part(at(n), 0);
  int far = 0, num_levels = 0;
  for (int start = 0, sweep = 0; sweep < 4; ++sweep) {  // towards a vertex of largest eccentricity
    const int found = find_levels(row_begin, columns, start, level, far);
    if (found <= num_levels) break;
    num_levels = found;
    start = far;
  }
  if (num_levels <
      3) {  // nearly complete: no level cuts it, the first vertex against the rest of the separator is all there is
    for (int v = 0; v < n; ++v) part[at(v)] = v == 0 ? 0 : 2;
    if (n > 1) part[at(n - 1)] = 1;
    return part;
  }
  std::vector<double> weight(at(num_levels), 0.0);
  double total = 0.0;
  for (int v = 0; v < n; ++v) {
    weight[at(std::max(level[at(v)], 0))] += weights[at(v)];
    total += weights[at(v)];
  }
  int best = 1;
  double best_score = 0.0, before = weight[0];
  for (int l = 1; l + 1 < num_levels; ++l) {
    const double after = total - before - weight[at(l)];
    const double score = weight[at(l)] / total + std::max(before, after) / total;
    if (l == 1 || score < best_score) {
      best = l;
      best_score = score;
    }
    before += weight[at(l)];
  }
  for (int v = 0; v < n; ++v) part[at(v)] = level[at(v)] < best ? 0 : level[at(v)] == best ? 2 : 1;
  // A separator vertex without a neighbour beyond is not needed.
  for (int v = 0; v < n; ++v) {
    if (part[at(v)] != 2) continue;
    bool beyond = false;
    for (int c = row_begin[at(v)]; c < row_begin[at(v) + 1]; ++c) beyond = beyond || part[at(columns[at(c)])] == 1;
    if (!beyond) part[at(v)] = 0;
  }
  return part;
}

#ifdef BOUGH_HAS_METIS
/// METIS draws from the process-wide generator of rand(). While this object lives, that generator has a state of its
/// own, and no other thread runs METIS: separators depend on the seed alone, and the state of the host's generator is
/// as it was afterwards.
class OwnRandomState {
 public:
  OwnRandomState() : lock_(in_use()), host_(initstate(1, state_, sizeof state_)) {}
  ~OwnRandomState() { setstate(host_); }
  OwnRandomState(const OwnRandomState&) = delete;
  OwnRandomState& operator=(const OwnRandomState&) = delete;

 private:
  static std::mutex& in_use() {
    static std::mutex mutex;
    return mutex;
  }
  std::lock_guard<std::mutex> lock_;
  char state_[128];
  char* host_;
};
#endif

}  // namespace

std::vector<int> separate_vertices(const VertexGraph& graph, unsigned seed) {
  (void)seed;
#ifdef BOUGH_HAS_METIS
  constexpr int least_for_metis = 16;  // below, METIS has nothing to coarsen and levels are as good
  if (static_cast<int>(graph.weights.size()) >= least_for_metis) {
    std::vector<idx_t> xadj(graph.row_begin.begin(), graph.row_begin.end()),
        adjncy(graph.columns.begin(), graph.columns.end()), vwgt(graph.weights.begin(), graph.weights.end());
    std::vector<idx_t> part(graph.weights.size(), 0);
    idx_t nvtxs = static_cast<idx_t>(graph.weights.size()), sepsize = 0;
    idx_t options[METIS_NOPTIONS];
    METIS_SetDefaultOptions(options);
    options[METIS_OPTION_SEED] = static_cast<idx_t>(seed);
    int status = METIS_ERROR;
    {
      const OwnRandomState own;
      status =
          METIS_ComputeVertexSeparator(&nvtxs, xadj.data(), adjncy.data(), vwgt.data(), options, &sepsize, part.data());
    }
    const auto filled = [&](idx_t p) { return std::find(part.begin(), part.end(), p) != part.end(); };
    if (status == METIS_OK && filled(0) && filled(1)) return {part.begin(), part.end()};
  }
#endif
  return separate_by_levels(graph.row_begin, graph.columns, graph.weights);
}

}  // namespace bough::tree
