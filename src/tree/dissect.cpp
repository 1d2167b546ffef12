#include "dissect.hpp"

#include <algorithm>
#include <cmath>

#include "bisect.hpp"

namespace bough::tree {

namespace {

/// Below this many elements a cyclic leaf is ordered by minimum degree alone.
constexpr std::size_t terminal_elements = 48;

/// Where leaves are not alike, elements fill lanes within a leaf, and a larger one has fewer that are left over. With
/// 150 to 400 elements a leaf instead of 36, lattices in space take 0.85 to 0.9 of the time of a step on two threads.
/// Those in a plane take 0.97 with 600 instead of 290, which would leave too few leaves for many threads.
constexpr double more_in_loops = 5.5, largest_in_loops = 300.0, leaves_of_loops = 8.0;

/// Loops that the elements close: edges - vertices + 1 of the graph of elements and the blocks that several of them hold,
/// where it hangs together.
int count_loops(const blocks::BlockGraph& graph) {
  std::vector<int> holders(graph.block_size.size(), 0);
  for (int b : graph.element_blocks) ++holders[static_cast<std::size_t>(b)];
  int loops = 1 - graph.num_elements();
  for (int count : holders) loops += std::max(0, count - 1);
  return loops;
}
/// Those that constraints close through the ground, to which an element with multipliers and one other block belongs.
int count_loops_through_ground(const blocks::BlockGraph& graph) {
  int held = 0;
  for (std::size_t e = 0; e < static_cast<std::size_t>(graph.num_elements()); ++e) {
    int motions = 0, multipliers = 0;
    for (auto k = graph.element_begin[e]; k < graph.element_begin[e + 1]; ++k) {
      const int block = graph.element_blocks[static_cast<std::size_t>(k)];
      const bool is_motion = graph.block_kind[static_cast<std::size_t>(block)] == blocks::BlockKind::motion;
      ++(is_motion ? motions : multipliers);
    }
    held += motions == 1 && multipliers > 0 ? 1 : 0;
  }
  return std::max(0, held - 1);
}
/// More than one for every 16 elements, as in lattices: leaves between them are not alike.
bool are_many(int loops, const blocks::BlockGraph& graph) { return 16 * loops > graph.num_elements(); }

/// Elements of a leaf from the mean cost of an element's elimination: a beam element of n unknowns leaves a front of
/// 1.5 n with n/2 eliminated, about 1.6 n^3 flops.
std::size_t choose_leaf_size(const Adjacency& adjacency, const std::vector<int>& elements, const TreeOptions& options,
                             int loops) {
  const auto count = static_cast<double>(elements.size());
  double flops = 0.0;
  for (int e : elements) flops += 1.6 * std::pow(adjacency.unknowns_of(e), 3.0);
  const double mean = count > 0.0 ? std::max(1.0, flops / count) : 1.0;
  constexpr double least = 4.0, largest = 4096.0;
  if (are_many(loops, *adjacency.graph))
    return static_cast<std::size_t>(std::clamp(more_in_loops * options.target_leaf_flops / mean, least,
                                               std::clamp(count / leaves_of_loops, least, largest_in_loops)));
  // Leaves in lockstep: at least two groups of eight, if there are enough elements. Where no loop is cut, whose rows may
  // depend on others, there are eight groups, so that several threads have work of equal size, unless leaves would be
  // too small for a visit. (`bough profile` foretells half a percent more for a planar chain of 512 links on one thread
  // than with two groups.)
  constexpr double least_leaf_flops = 1.2e4, least_in_lockstep = 5.0;
  const double two_groups = std::max(count / 12.0, least_in_lockstep), eight_groups = count / 48.0,
               worth_a_visit = std::max(least_leaf_flops / mean, least_in_lockstep),
               in_lockstep = loops + count_loops_through_ground(*adjacency.graph) > 0
                                 ? two_groups
                                 : std::max(eight_groups, std::min(two_groups, worth_a_visit));
  const double most = options.in_lockstep ? std::min(in_lockstep, largest) : largest;
  return static_cast<std::size_t>(std::clamp(options.target_leaf_flops / mean, least, std::max(most, least)));
}

class Recursion {
 public:
  Recursion(const Adjacency& adjacency, const std::vector<int>& elements, const TreeOptions& options)
      : bisector_(adjacency, options.seed), depth_(options.depth) {
    if (options.leaf_size > 0) leaf_size_ = static_cast<std::size_t>(options.leaf_size);
    if (options.leaf_size > 0 || options.depth >= 0) return;
    const int loops = count_loops(*adjacency.graph);
    if (are_many(loops, *adjacency.graph) && options.loops_in_one)
      depth_ = 0;
    else
      leaf_size_ = choose_leaf_size(adjacency, elements, options, loops);
  }

  int run(std::vector<int> elements, int level, bool upper) {
    const bool cut_subdomain =
        upper && elements.size() > std::max<std::size_t>(leaf_size_, 1) && (depth_ < 0 || level < depth_);
    const bool is_forest = !cut_subdomain && bisector_.is_forest(elements);
    const bool cut_inside = !cut_subdomain && elements.size() > terminal_elements && !is_forest;
    Part part;
    part.level = level;
    part.is_subdomain = upper;
    part.is_forest = is_forest;
    if (cut_subdomain || cut_inside) {
      Cut cut = bisector_.cut(elements);
      elements = {};
      for (auto& side : cut.side) part.children.push_back(run(std::move(side), level + 1, cut_subdomain));
    } else {
      part.elements = std::move(elements);
    }
    const int id = static_cast<int>(dissection.parts.size());
    for (int c : part.children) dissection.parts[static_cast<std::size_t>(c)].parent = id;
    dissection.parts.push_back(std::move(part));
    return id;
  }

  bool used_separator() const { return bisector_.used_separator(); }
  Dissection dissection;

 private:
  Bisector bisector_;
  int depth_;
  std::size_t leaf_size_ = 1;
};

}  // namespace

Dissection dissect(const Adjacency& adjacency, const TreeOptions& options) {
  std::vector<int> all;
  for (int e = 0; e < adjacency.graph->num_elements(); ++e)
    if (!adjacency.blocks_of(e).empty()) all.push_back(e);
  Recursion recursion(adjacency, all, options);
  recursion.run(std::move(all), 0, true);
#ifdef BOUGH_HAS_METIS
  const char* general = "vertex separators (METIS)";
#else
  const char* general = "vertex separators (breadth-first levels)";
#endif
  recursion.dissection.method = recursion.used_separator() ? general : "exact tree cuts";
  return std::move(recursion.dissection);
}

}  // namespace bough::tree
