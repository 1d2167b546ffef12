/// Permutations and elimination orders of the benchmark matrices.
#include <algorithm>
#include <numeric>

#include "bough/blocks/at.hpp"
#include "bough/tree/tree.hpp"
#include "problem.hpp"

#ifdef BOUGH_BENCH_HAS_AMD
#include <amd.h>
#endif
#ifdef BOUGH_BENCH_HAS_METIS
#include <metis.h>
#endif

namespace bough::bench {

namespace {

/// Neighbours of every motion block once multiplier blocks are merged into the first motion block of their element.
struct NodeGraph {
  std::vector<int> group_of;              ///< by block
  std::vector<std::vector<int>> members;  ///< blocks of each group, the motion block first
  std::vector<int> begin, neighbour;      ///< compressed, without the group itself
};

NodeGraph make_node_graph(const blocks::BlockGraph& g) {
  NodeGraph out;
  out.group_of.assign(at(g.num_blocks()), -1);
  for (int b = 0; b < g.num_blocks(); ++b)
    if (g.block_kind[at(b)] == blocks::BlockKind::motion) {
      out.group_of[at(b)] = static_cast<int>(out.members.size());
      out.members.push_back({b});
    }
  const auto blocks_of = [&](int e) {
    return std::pair{g.element_blocks.begin() + g.element_begin[at(e)],
                     g.element_blocks.begin() + g.element_begin[at(e) + 1]};
  };
  for (int e = 0; e < g.num_elements(); ++e) {
    const auto [first, last] = blocks_of(e);
    const auto host = std::find_if(first, last, [&](int b) { return out.group_of[at(b)] >= 0; });
    for (auto b = first; b != last; ++b) {
      if (out.group_of[at(*b)] >= 0) continue;
      if (host == last) {  // multipliers alone, in a matrix that is not of a scene
        out.group_of[at(*b)] = static_cast<int>(out.members.size());
        out.members.emplace_back();
      } else {
        out.group_of[at(*b)] = out.group_of[at(*host)];
      }
      out.members[at(out.group_of[at(*b)])].push_back(*b);
    }
  }
  std::vector<std::vector<int>> near(out.members.size());
  for (int e = 0; e < g.num_elements(); ++e) {
    const auto [first, last] = blocks_of(e);
    for (auto a = first; a != last; ++a)
      for (auto b = first; b != last; ++b)
        if (out.group_of[at(*a)] != out.group_of[at(*b)])
          near[at(out.group_of[at(*a)])].push_back(out.group_of[at(*b)]);
  }
  out.begin.assign(1, 0);
  for (std::vector<int>& list : near) {
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
    out.neighbour.insert(out.neighbour.end(), list.begin(), list.end());
    out.begin.push_back(static_cast<int>(out.neighbour.size()));
  }
  return out;
}

std::vector<int> order_groups([[maybe_unused]] NodeGraph& g, const std::string& method) {
  const int n = static_cast<int>(g.members.size());
  std::vector<int> order(at(n));
#ifdef BOUGH_BENCH_HAS_AMD
  if (method == "node amd")
    return amd_order(n, g.begin.data(), g.neighbour.data(), order.data(), nullptr, nullptr) < 0 ? std::vector<int>{}
                                                                                                : order;
#endif
#ifdef BOUGH_BENCH_HAS_METIS
  if (method == "node metis") {
    static_assert(sizeof(idx_t) == sizeof(int));
    std::vector<int> weight, inverse(at(n));
    for (const auto& m : g.members) weight.push_back(static_cast<int>(m.size()));
    idx_t options[METIS_NOPTIONS], count = n;
    METIS_SetDefaultOptions(options);
    options[METIS_OPTION_SEED] = 1;
    if (METIS_NodeND(&count, g.begin.data(), g.neighbour.data(), weight.data(), options, order.data(),
                     inverse.data()) == METIS_OK)
      return order;
  }
#endif
  static_cast<void>(method);
  return {};
}

}  // namespace

namespace {

std::vector<int> order_blocks(const Problem& problem, const std::string& method) {
  std::vector<int> blocks;
  if (method == "node bough") {
    const tree::Tree tree = tree::make_tree(problem.graph);
    for (const tree::Front& f : tree.fronts) {
      const auto first = tree.front_blocks.begin() + f.block_begin;
      blocks.insert(blocks.end(), first, first + f.num_eliminated_blocks);
    }
    return blocks;
  }
  NodeGraph g = make_node_graph(problem.graph);
  for (int group : order_groups(g, method))
    blocks.insert(blocks.end(), g.members[at(group)].begin(), g.members[at(group)].end());
  return blocks;
}

}  // namespace

std::vector<int> order_nodes(const Problem& problem, const std::string& method) {
  std::vector<int> unknown_at(problem.rhs.size());  // of the matrix, by its place in the graph
  for (std::size_t i = 0; i < unknown_at.size(); ++i)
    unknown_at[problem.place.empty() ? i : at(problem.place[i])] = static_cast<int>(i);
  std::vector<int> order;
  for (int b : order_blocks(problem, method))
    for (int u = problem.unknown_begin[at(b)]; u < problem.unknown_begin[at(b) + 1]; ++u)
      order.push_back(unknown_at[at(u)]);
  return order;
}

SparseMatrix lower_triangle(const SparseMatrix& a) {
  SparseMatrix out;
  out.n = a.n;
  out.column_begin.assign(1, 0);
  for (int j = 0; j < a.n; ++j) {
    for (int k = a.column_begin[at(j)]; k < a.column_begin[at(j) + 1]; ++k)
      if (a.row[at(k)] >= j) {
        out.row.push_back(a.row[at(k)]);
        out.value.push_back(a.value[at(k)]);
      }
    out.column_begin.push_back(out.num_entries());
  }
  return out;
}

SparseMatrix permute(const SparseMatrix& a, const std::vector<int>& order) {
  std::vector<int> place(at(a.n));
  for (int i = 0; i < a.n; ++i) place[at(order[at(i)])] = i;
  SparseMatrix out;
  out.n = a.n;
  out.column_begin.assign(1, 0);
  std::vector<std::pair<int, double>> column;
  for (int j = 0; j < a.n; ++j) {
    const std::size_t from = at(order[at(j)]);
    column.clear();
    for (int k = a.column_begin[from]; k < a.column_begin[from + 1]; ++k)
      column.emplace_back(place[at(a.row[at(k)])], a.value[at(k)]);
    std::sort(column.begin(), column.end());
    for (const auto& [row, value] : column) {
      out.row.push_back(row);
      out.value.push_back(value);
    }
    out.column_begin.push_back(out.num_entries());
  }
  return out;
}

}  // namespace bough::bench
