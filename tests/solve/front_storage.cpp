/// Places of Schur complements: what is still to be read is never written over, in whatever order sub-domains are
/// visited.
#include "../../src/solve/front_storage.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <vector>

#include "bough/blocks/block_graph.hpp"
#include "bough/tree/tree.hpp"

namespace {

using namespace bough;
std::size_t at(std::int64_t i) { return static_cast<std::size_t>(i); }

/// n x n x depth nodes of six unknowns, neighbours joined.
blocks::BlockGraph make_lattice(int n, int depth) {
  blocks::BlockGraph graph;
  graph.block_size.assign(at(static_cast<std::int64_t>(n) * n * depth), 6);
  graph.block_kind.assign(graph.block_size.size(), blocks::BlockKind::motion);
  const auto join = [&graph](int a, int b) {
    graph.element_blocks.insert(graph.element_blocks.end(), {a, b});
    graph.element_begin.push_back(static_cast<std::int64_t>(graph.element_blocks.size()));
  };
  const auto id = [n](int i, int j, int k) { return (k * n + j) * n + i; };
  for (int k = 0; k < depth; ++k)
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i) {
        if (i + 1 < n) join(id(i, j, k), id(i + 1, j, k));
        if (j + 1 < n) join(id(i, j, k), id(i, j + 1, k));
        if (k + 1 < depth) join(id(i, j, k), id(i, j, k + 1));
      }
  return graph;
}

/// Numbers [begin, end) of one memory that holds the pool, then all factors.
struct Range {
  std::int64_t begin, end;
  bool meets(const Range& other) const { return begin < other.end && other.begin < end; }
};

class Places {
 public:
  Places(const tree::Tree& tree, bool is_symmetric)
      : tree_(tree),
        places_(solve::plan_schur(tree, std::vector<int>(tree.fronts.size(), -1), is_symmetric)),
        factor_(tree.fronts.size()) {
    std::int64_t end = places_.pool;
    for (std::size_t f = 0; f < factor_.size(); ++f) {
      const solve::FrontShape shape(tree.fronts[f].size(), tree.fronts[f].num_eliminated, is_symmetric);
      factor_[f] = {end, end + shape.factor_size()};
      end = factor_[f].end;
    }
  }
  Range factor(tree::FrontId f) const { return factor_[at(f)]; }
  Range schur(tree::FrontId f) const {
    const tree::Front& front = tree_.fronts[at(f)];
    const tree::FrontId host = places_.host[at(f)];
    const std::int64_t begin = places_.begin[at(f)] + (host == tree::none ? 0 : factor_[at(host)].begin);
    return {begin, begin + solve::FrontShape(front.size(), front.num_eliminated, false).s};
  }
  /// Whether f is always visited before g.
  bool is_before(tree::FrontId f, tree::FrontId g) const {
    const tree::SubdomainId of_f = tree_.fronts[at(f)].subdomain, of_g = tree_.fronts[at(g)].subdomain;
    if (of_f == of_g) return f < g;
    return tree_.subdomains[at(of_g)].subtree_begin <= of_f && of_f < of_g;
  }
  tree::FrontId host(tree::FrontId f) const { return places_.host[at(f)]; }
  /// What it is to stand in.
  Range home(tree::FrontId f) const { return host(f) == tree::none ? Range{0, places_.pool} : factor(host(f)); }

 private:
  const tree::Tree& tree_;
  solve::SchurPlaces places_;
  std::vector<Range> factor_;
};

void expect_sound(const tree::Tree& tree, bool is_symmetric) {
  const Places places(tree, is_symmetric);
  for (tree::FrontId f = 0; f + 1 < tree.num_fronts(); ++f) {
    const Range schur = places.schur(f);
    const tree::FrontId parent = tree.fronts[at(f)].parent;
    ASSERT_GE(schur.begin, places.home(f).begin);
    ASSERT_LE(schur.end, places.home(f).end) << f;
    EXPECT_FALSE(schur.meets(places.factor(f))) << f;
    for (tree::FrontId g = 0; g < tree.num_fronts(); ++g) {
      if (g == f) continue;
      // g may be visited while the parent of f has yet to read, or is the parent, which writes while it reads.
      if (!places.is_before(g, f) && (g == parent || !places.is_before(parent, g))) {
        EXPECT_FALSE(schur.meets(places.schur(g))) << f << " and the Schur complement of " << g;
        EXPECT_FALSE(schur.meets(places.factor(g))) << f << " and the factor of " << g;
      }
      // A factor stays once it is there.
      if (places.is_before(g, f)) {
        EXPECT_FALSE(schur.meets(places.factor(g))) << f << " over the factor of " << g;
      }
    }
  }
}

TEST(FrontStorage, NothingIsWrittenOverBeforeItIsRead) {
  for (const auto& graph : {make_lattice(7, 1), make_lattice(12, 1), make_lattice(4, 5)})
    for (const int depth : {0, 1, 3, -1})
      for (const bool is_symmetric : {false, true})
        expect_sound(tree::make_tree(graph, {.depth = depth}), is_symmetric);
}

/// No grandchild without children waits in the pool while the place of a factor has room for it.
TEST(FrontStorage, FactorsOfGrandparentsTakeWhatHasRoomInThem) {
  const auto graph = make_lattice(8, 8);
  const tree::Tree tree = tree::make_tree(graph, {});
  const Places places(tree, false);
  std::vector<std::int64_t> end(tree.fronts.size());
  for (std::size_t f = 0; f < end.size(); ++f) end[f] = places.factor(static_cast<tree::FrontId>(f)).begin;
  int hosted = 0;
  for (tree::FrontId f = 0; f < tree.num_fronts(); ++f) {
    if (places.host(f) == tree::none) continue;
    ++hosted;
    end[at(places.host(f))] = std::max(end[at(places.host(f))], places.schur(f).end);
  }
  EXPECT_GT(hosted, 0);
  for (tree::FrontId f = 0; f < tree.num_fronts(); ++f)
    for (const tree::FrontId c : tree.children(tree.fronts[at(f)]))
      for (const tree::FrontId g : tree.children(tree.fronts[at(c)])) {
        const Range schur = places.schur(g);
        if (places.host(g) != tree::none || !tree.children(tree.fronts[at(g)]).empty() || schur.begin == schur.end)
          continue;
        EXPECT_GT(end[at(f)] + schur.end - schur.begin, places.factor(f).end) << g;
      }
}

}  // namespace
