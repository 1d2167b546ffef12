/// Laws of the tree: everything is in it once, in the right order, and the cost grows as it should.
#include <gtest/gtest.h>
#include <stdlib.h>

#include <algorithm>
#include <initializer_list>
#include <set>
#include <string>
#include <thread>

#include "bough/tree/tree.hpp"
#include "solve/random_scene.hpp"

namespace bough::test {
namespace {

using blocks::BlockKind;
std::size_t at(std::int64_t i) { return static_cast<std::size_t>(i); }

std::span<const int> blocks_of(const blocks::BlockGraph& g, int e) {
  return {g.element_blocks.data() + g.element_begin[at(e)], at(g.element_begin[at(e) + 1] - g.element_begin[at(e)])};
}

bool is_below(const tree::Tree& t, tree::FrontId low, tree::FrontId high) {
  while (low != tree::none && low < high) low = t.fronts[at(low)].parent;
  return low == high;
}

void expect_sound(const Scene& scene, const tree::TreeOptions& options) {
  const auto& g = scene.graph;
  const tree::Tree t = tree::make_tree(g, options);
  const std::string what =
      scene.name + " leaf " + std::to_string(options.leaf_size) + " depth " + std::to_string(options.depth);
  SCOPED_TRACE(what);

  // every element once, every block eliminated once
  std::vector<int> order = t.element_order;
  std::sort(order.begin(), order.end());
  ASSERT_EQ(order.size(), at(g.num_elements()));
  for (int e = 0; e < g.num_elements(); ++e) ASSERT_EQ(order[at(e)], e);
  std::vector<int> times(at(g.num_blocks()), 0);
  for (const tree::Front& f : t.fronts)
    for (int k = 0; k < f.num_eliminated_blocks; ++k) ++times[at(t.blocks(f)[at(k)])];
  for (int n : times) ASSERT_EQ(n, 1);

  for (tree::FrontId id = 0; id < t.num_fronts(); ++id) {
    const tree::Front& f = t.fronts[at(id)];
    int rows = 0, eliminated = 0;
    std::set<int> own;
    for (std::size_t k = 0; k < t.blocks(f).size(); ++k) {
      const int b = t.blocks(f)[k];
      ASSERT_TRUE(own.insert(b).second);
      rows += g.block_size[at(b)];
      if (static_cast<int>(k) < f.num_eliminated_blocks) {
        eliminated += g.block_size[at(b)];
        ASSERT_EQ(t.front_of_block[at(b)], id);
      } else {  // a boundary block waits for a front above
        ASSERT_TRUE(t.front_of_block[at(b)] > id && is_below(t, id, t.front_of_block[at(b)]));
      }
    }
    ASSERT_EQ(rows, f.size());
    ASSERT_EQ(eliminated, f.num_eliminated);
    if (id + 1 < t.num_fronts()) {
      ASSERT_GT(f.parent, id);
    } else {
      ASSERT_EQ(f.parent, tree::none);
      ASSERT_EQ(f.num_boundary, 0);
    }
    // scatter maps point at the block they mean
    const auto row_of = [&](const tree::Front& in, int block) {
      int row = 0;
      for (int b : t.blocks(in)) {
        if (b == block) return row;
        row += g.block_size[at(b)];
      }
      return -2;
    };
    for (int p = f.element_begin; p < f.element_end; ++p) {
      const auto blocks = blocks_of(g, t.element_order[at(p)]);
      for (std::size_t k = 0; k < blocks.size(); ++k)
        ASSERT_EQ(t.scatter[at(t.scatter_begin[at(p)]) + k], row_of(f, blocks[k]));
      ASSERT_EQ(t.leaf_of_element[at(t.element_order[at(p)])], f.subdomain);
    }
    for (tree::FrontId c : t.children(f)) {
      const tree::Front& child = t.fronts[at(c)];
      ASSERT_EQ(child.parent, id);
      for (auto k = child.block_begin + child.num_eliminated_blocks; k < child.block_end; ++k)
        ASSERT_EQ(t.parent_row[at(k)], row_of(f, t.front_blocks[at(k)]));
    }
  }

  // motion: eliminated once all its elements are assembled; multipliers: not before a motion block that they constrain
  for (int e = 0; e < g.num_elements(); ++e) {
    tree::FrontId assembled = tree::none;
    for (tree::FrontId id = 0; id < t.num_fronts(); ++id)
      for (int other : t.elements(t.fronts[at(id)]))
        if (other == e) assembled = id;
    for (int b : blocks_of(g, e)) {
      ASSERT_TRUE(is_below(t, assembled, t.front_of_block[at(b)]));
      if (g.block_kind[at(b)] == BlockKind::motion) continue;
      bool one = false;
      for (int other : blocks_of(g, e))
        one = one || (g.block_kind[at(other)] == BlockKind::motion &&
                      is_below(t, t.front_of_block[at(other)], t.front_of_block[at(b)]));
      ASSERT_TRUE(one);
    }
  }

  // sub-domains: postorder, contiguous fronts and elements, one top each, sizes as asked
  for (tree::SubdomainId id = 0; id < t.num_subdomains(); ++id) {
    const tree::Subdomain& s = t.subdomains[at(id)];
    ASSERT_LT(s.front_begin, s.front_end);
    for (tree::FrontId f = s.front_begin; f < s.front_end; ++f) ASSERT_EQ(t.fronts[at(f)].subdomain, id);
    for (tree::FrontId f = s.subtree_front_begin; f < s.front_end; ++f) ASSERT_TRUE(is_below(t, f, s.top()));
    if (s.is_leaf() && options.leaf_size > 0 && options.depth < 0) {
      ASSERT_LE(s.element_end - s.element_begin, options.leaf_size);
    }
    if (options.depth >= 0) {
      ASSERT_LE(s.level, options.depth);
    }
    for (tree::SubdomainId c : t.children(s)) ASSERT_EQ(t.subdomains[at(c)].parent, id);
    if (id < t.root()) {
      ASSERT_EQ(t.fronts[at(s.top())].parent, t.subdomains[at(s.parent)].top());
    }
  }
  ASSERT_EQ(t.subdomains.back().element_end - t.subdomains.back().element_begin, g.num_elements());
}

TEST(Tree, IsSoundForAllFamiliesLeafSizesAndDepths) {
  for (unsigned seed = 1; seed <= 3; ++seed)
    for (const Scene& scene : make_all_families(seed)) {
      for (int leaf : {0, 1, 2, 3, 7, 20, 1000}) expect_sound(scene, {.leaf_size = leaf});
      for (int depth : {0, 1, 2, 5}) expect_sound(scene, {.depth = depth});
      expect_sound(scene, {.in_lockstep = false});
    }
  expect_sound(SceneMaker(1).finish("empty"), {});
}

TEST(Tree, IsTheSameEveryTime) {
  const Scene scene = make_lattice(3, 9, 8);
  const tree::Tree a = tree::make_tree(scene.graph, {.leaf_size = 4}),
                   b = tree::make_tree(scene.graph, {.leaf_size = 4});
  EXPECT_EQ(a.element_order, b.element_order);
  EXPECT_EQ(a.front_blocks, b.front_blocks);
  EXPECT_EQ(a.scatter, b.scatter);
}

TEST(Tree, CostOfAChainIsLinearForEveryLeafSize) {
  for (int leaf : {1, 8, 64, 100000}) {
    const auto flops = [&](int links) {
      return tree::make_tree(make_chain(1, links, 4).graph, {.leaf_size = leaf}).subdomains.back().subtree_flops;
    };
    const double ratio = flops(256) / flops(64);
    EXPECT_GT(ratio, 3.5) << leaf;
    EXPECT_LT(ratio, 4.6) << leaf;
  }
}

TEST(Tree, ACutOfAChainIsOneNodeAndTheTreeIsShallow) {
  const Scene scene = make_chain(1, 128, 4);
  const tree::Tree t = tree::make_tree(scene.graph, {.leaf_size = 4});
  int deepest = 0;
  for (const tree::Subdomain& s : t.subdomains) {
    deepest = std::max(deepest, s.level);
    EXPECT_LE(t.fronts[at(s.top())].num_boundary, 24);  // two cuts, a node and at most its joint each
  }
  EXPECT_LE(deepest, 12);  // log2(640 / 4) = 7.3; cuts between two thirds and one third would give 12.5
}

TEST(Tree, AStarKeepsOneHubAtAllInterfaces) {
  const Scene scene = make_star(1, 16, 4);
  const tree::Tree t = tree::make_tree(scene.graph, {.leaf_size = 6});
  for (tree::SubdomainId s = 0; s < t.root(); ++s) EXPECT_LE(t.fronts[at(t.subdomains[at(s)].top())].num_boundary, 12);
}

/// A chain in a plane that hangs on the ground: links of four beams between hinges of two rows.
blocks::BlockGraph make_planar_chain(int links) {
  blocks::BlockGraph g;
  g.element_begin.assign(1, 0);
  const auto add_block = [&](int size, BlockKind kind) {
    g.block_size.push_back(size);
    g.block_kind.push_back(kind);
    return g.num_blocks() - 1;
  };
  const auto add_element = [&](std::initializer_list<int> of) {
    g.element_blocks.insert(g.element_blocks.end(), of);
    g.element_begin.push_back(static_cast<std::int64_t>(g.element_blocks.size()));
  };
  for (int l = 0, end = -1; l < links; ++l) {
    const int start = add_block(3, BlockKind::motion), hinge = add_block(2, BlockKind::multiplier);
    if (end < 0) add_element({start, hinge});
    if (end >= 0) add_element({end, start, hinge});
    end = start;
    for (int b = 0; b < 4; ++b) {
      const int next = add_block(3, BlockKind::motion);
      add_element({end, next});
      end = next;
    }
  }
  return g;
}

/// Partitioners may draw random numbers from a generator that all threads of the process share.
TEST(Tree, IsTheSameWhereSeveralThreadsMakeTreesAtOnce) {
  std::vector<Scene> scenes;
  for (unsigned seed = 1; seed <= 40; ++seed) {
    const int size = 5 + static_cast<int>(seed % 7);
    scenes.push_back(make_lattice(seed, size, size + 2));
  }
  std::vector<std::vector<int>> serial, together(scenes.size());
  for (const Scene& scene : scenes) serial.push_back(tree::make_tree(scene.graph, {}).element_order);
  {
    std::vector<std::jthread> threads;
    for (std::size_t first = 0; first < 4; ++first)
      threads.emplace_back([&, first] {
        for (std::size_t i = first; i < scenes.size(); i += 4)
          together[i] = tree::make_tree(scenes[i].graph, {}).element_order;
      });
  }
  for (std::size_t i = 0; i < scenes.size(); ++i) EXPECT_EQ(serial[i], together[i]) << i;
}

TEST(Tree, LeavesTheGeneratorOfTheHostAlone) {
  const Scene scene = make_lattice(1, 12, 12);
  srand(7);
  const int first = rand(), second = rand();
  srand(7);
  EXPECT_EQ(rand(), first);
  (void)tree::make_tree(scene.graph, {});
  EXPECT_EQ(rand(), second);
}

/// One leaf that is not like the others costs as much as eight that are. The first has one interface, the others two.
TEST(Tree, AllLeavesOfAChainEliminateTheSame) {
  const tree::Tree t = tree::make_tree(make_planar_chain(128), {});
  std::set<std::vector<int>> kinds;
  std::set<int> interfaces;
  for (const tree::Subdomain& s : t.subdomains) {
    if (!s.is_leaf()) continue;
    std::vector<int> sizes;
    for (tree::FrontId f = s.front_begin; f < s.front_end; ++f) sizes.push_back(t.fronts[at(f)].num_eliminated);
    kinds.insert(sizes);
    interfaces.insert(t.fronts[at(s.top())].num_boundary);
  }
  EXPECT_EQ(kinds.size(), 1u);
  EXPECT_EQ(interfaces, (std::set<int>{3, 6}));
}

/// Leaves that nothing is gained from are not made: a short chain is one of few fronts.
TEST(Tree, WithoutLockstepAShortChainIsOneLeaf) {
  const auto leaves = [](const tree::Tree& t) {
    return std::count_if(t.subdomains.begin(), t.subdomains.end(), [](const auto& s) { return s.is_leaf(); });
  };
  const tree::Tree one = tree::make_tree(make_planar_chain(8), {.in_lockstep = false}),
                   many = tree::make_tree(make_planar_chain(8), {});
  EXPECT_EQ(leaves(one), 1);
  EXPECT_GT(leaves(many), 4);
  EXPECT_LT(one.num_fronts(), many.num_fronts() / 2);
}

/// Beams between the neighbours in a cube of n x n x n nodes, one face held.
blocks::BlockGraph make_cube(int n) {
  blocks::BlockGraph g;
  g.block_size.assign(static_cast<std::size_t>(n * n * n), 6);
  g.block_kind.assign(g.block_size.size(), blocks::BlockKind::motion);
  g.element_begin.assign(1, 0);
  const auto add = [&](std::initializer_list<int> nodes) {
    g.element_blocks.insert(g.element_blocks.end(), nodes);
    g.element_begin.push_back(static_cast<std::int64_t>(g.element_blocks.size()));
  };
  for (int k = 0, v = 0; k < n; ++k)
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i, ++v) {
        if (i + 1 < n) add({v, v + 1});
        if (j + 1 < n) add({v, v + n});
        if (k + 1 < n) add({v, v + n * n});
        if (i == 0) add({v});
      }
  return g;
}

/// Whatever the seed: single separators differ by a factor of two here.
TEST(Tree, CutsOfACubeAreChosenByWhatTheyCost) {
  const blocks::BlockGraph cube = make_cube(12);
  double least = 0.0, most = 0.0;
  for (unsigned seed : {1u, 2u, 3u, 21u}) {
    const tree::Tree t = tree::make_tree(cube, {.seed = seed});
    if (t.method.find("METIS") == std::string::npos) GTEST_SKIP() << "without METIS there is nothing to choose from";
    const double flops = t.subdomains.back().subtree_flops;
    least = least > 0.0 ? std::min(least, flops) : flops;
    most = std::max(most, flops);
  }
  EXPECT_LT(most, 1.25 * least);
  // Straight planes: the middle one alone, and of the two halves one each that holds half as much, take this much
  // without all below.
  const auto eliminate = [](double e, double b) {  // sum of 2 m^2 + m over the rows m that are left
    const auto sum = [](double n) { return n * (n + 1.0) / 2.0 + n * (n + 1.0) * (2.0 * n + 1.0) / 3.0; };
    return sum(e + b - 1.0) - (b > 0.0 ? sum(b - 1.0) : 0.0);
  };
  EXPECT_LT(most, eliminate(6 * 144, 0.0) + 2.0 * eliminate(6 * 72, 6 * 144));
}

/// A chain of springs between nodes, and elements of what is held at both ends and in the middle of the list.
TEST(Tree, ElementsWithoutBlocksCutNothingAndAreAssembledOnce) {
  const auto make = [](bool with_idle) {
    blocks::BlockGraph g;
    g.element_begin.assign(1, 0);
    for (int e = 0; e < 40; ++e) {
      g.block_size.push_back(6);
      g.block_kind.push_back(BlockKind::motion);
      if (with_idle && (e == 0 || e == 17)) g.element_begin.push_back(g.element_begin.back());
      if (e > 0) g.element_blocks.push_back(e - 1);
      g.element_blocks.push_back(e);
      g.element_begin.push_back(static_cast<std::int64_t>(g.element_blocks.size()));
    }
    if (with_idle) g.element_begin.push_back(g.element_begin.back());
    return g;
  };
  const tree::Tree bare = tree::make_tree(make(false), {.leaf_size = 4}),
                   idle = tree::make_tree(make(true), {.leaf_size = 4});
  EXPECT_EQ(bare.num_fronts(), idle.num_fronts());
  EXPECT_EQ(bare.front_of_block, idle.front_of_block);
  EXPECT_EQ(bare.method, idle.method);
  std::vector<int> order = idle.element_order;
  std::sort(order.begin(), order.end());
  ASSERT_EQ(order.size(), 43u);
  for (int e = 0; e < 43; ++e) EXPECT_EQ(order[at(e)], e);
  for (int e : {0, 18, 42}) EXPECT_TRUE(idle.subdomains[at(idle.leaf_of_element[at(e)])].is_leaf());
  blocks::BlockGraph nothing_else;
  nothing_else.element_begin = {0, 0, 0};
  EXPECT_EQ(tree::make_tree(nothing_else).num_unknowns(), 0);
}

TEST(Tree, RefusesGraphsThatAreNotConsistent) {
  blocks::BlockGraph g;
  g.block_size = {6};
  g.block_kind = {BlockKind::motion};
  g.element_blocks = {0, 1};
  g.element_begin = {0, 2};
  EXPECT_THROW((void)tree::make_tree(g), std::invalid_argument);
  g.element_blocks = {0, 0};
  EXPECT_THROW((void)tree::make_tree(g), std::invalid_argument);
  g.element_blocks = {0};
  g.element_begin = {0, 1};
  g.block_size = {0};
  EXPECT_THROW((void)tree::make_tree(g), std::invalid_argument);
  EXPECT_THROW((void)tree::make_tree({}, {.leaf_size = -1}), std::invalid_argument);
}

}  // namespace
}  // namespace bough::test
