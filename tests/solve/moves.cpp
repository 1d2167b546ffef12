/// Lists of moves and gaps: together they fill a front, whatever was in it before.
#include "../../src/solve/moves.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace {

using namespace bough::solve;
using RunOfRows = Run;  // testing::Test has another Run

/// A front of `size` unknowns in memory, column by column.
struct Entries {
  int size;
  std::vector<double> values;
  explicit Entries(int n, double value) : size(n), values(bough::at(n) * bough::at(n), value) {}
  double& operator()(int i, int j) { return values[bough::at(j) * bough::at(size) + bough::at(i)]; }
};

struct Contributor {
  std::vector<Run> runs;
  Entries entries{0, 0.0};
};

/// Blocks of one to three rows, none across the beginning of the boundary, of which contributors take some.
std::vector<Contributor> make_contributors(std::mt19937& random, int size, int eliminated) {
  std::vector<Run> blocks;
  for (int row = 0; row < size;) {
    const int end = row < eliminated ? eliminated : size;
    const int length = std::min<int>(1 + static_cast<int>(random() % 3), end - row);
    blocks.push_back({0, row, length});
    row += length;
  }
  std::vector<Contributor> contributors(random() % 5);
  for (Contributor& c : contributors) {
    int from = 0;
    for (const Run& block : blocks)
      if (random() % 3 == 0) {
        c.runs.push_back({from, block.to, block.length});
        from += block.length;
      }
    c.entries = Entries(from, 0.0);
    for (double& x : c.entries.values) x = static_cast<double>(random() % 1000);
  }
  return contributors;
}

class Moves : public testing::TestWithParam<bool> {};

TEST_P(Moves, AndGapsWriteEveryEntryOnceAndAddTheRest) {
  const bool is_symmetric = GetParam();
  std::mt19937 random(7);
  MovePlanner planner(is_symmetric);
  std::vector<std::vector<Contributor>> fronts;
  std::vector<Assembly> assemblies;
  std::vector<int> sizes, eliminated;
  for (int k = 0; k < 300; ++k) {
    sizes.push_back(static_cast<int>(random() % 20));
    eliminated.push_back(static_cast<int>(random() % (static_cast<unsigned>(sizes.back()) + 1)));
    fronts.push_back(make_contributors(random, sizes.back(), eliminated.back()));
    planner.begin(sizes.back(), eliminated.back());
    for (std::size_t c = 0; c < fronts.back().size(); ++c) planner.add(static_cast<int>(c), fronts.back()[c].runs);
    assemblies.push_back(planner.finish());
  }
  const MoveLists lists = planner.take();
  for (std::size_t k = 0; k < fronts.size(); ++k) {
    const int n = sizes[k];
    const double unwritten = std::numeric_limits<double>::quiet_NaN();
    Entries filled(n, unwritten), expected(n, 0.0);
    for (const Gap& gap : lists.gaps_of(assemblies[k])) {
      const bool is_cut = gap.row < eliminated[k] && gap.row + gap.rows > eliminated[k];
      EXPECT_FALSE(gap.column >= eliminated[k] && is_cut) << "U12 and the Schur complement are stored apart";
      for (int i = gap.row; i < gap.row + gap.rows; ++i) {
        EXPECT_TRUE(std::isnan(filled(i, gap.column)));
        filled(i, gap.column) = 0.0;
      }
    }
    for (const Move& move : lists.moves_of(assemblies[k])) {
      Contributor& from = fronts[k][bough::at(move.contributor)];
      for (int j = 0; j < move.columns; ++j)
        for (int i = move.is_triangle ? j : 0; i < move.rows; ++i) {
          double& to = filled(move.row + i, move.column + j);
          EXPECT_EQ(std::isnan(to), move.is_first);
          to = (move.is_first ? 0.0 : to) + from.entries(move.from_row + i, move.from_column + j);
        }
    }
    for (Contributor& c : fronts[k])
      for (const RunOfRows& q : c.runs)
        for (const RunOfRows& p : c.runs)
          for (int j = 0; j < q.length; ++j)
            for (int i = 0; i < p.length; ++i) expected(p.to + i, q.to + j) += c.entries(p.from + i, q.from + j);
    for (int j = 0; j < n; ++j)
      for (int i = is_symmetric ? j : 0; i < n; ++i) EXPECT_EQ(filled(i, j), expected(i, j)) << i << ' ' << j;
  }
}

TEST_P(Moves, ArePartsOfBlocksInColumns) {
  const bool is_symmetric = GetParam();
  std::mt19937 random(8);
  for (int k = 0; k < 100; ++k) {
    const int n = 1 + static_cast<int>(random() % 20), eliminated = n / 2;
    Entries whole(n, 0.0), parts(n, 0.0);
    for (Contributor& c : make_contributors(random, n, eliminated)) {
      const auto fill = [&](Entries& to, int first, int last) {
        for_blocks(0, c.runs, is_symmetric, first, last, [&](const Move& move) {
          for (int j = 0; j < move.columns; ++j)
            for (int i = move.is_triangle ? j : 0; i < move.rows; ++i)
              to(move.row + i, move.column + j) += c.entries(move.from_row + i, move.from_column + j);
        });
      };
      fill(whole, 0, n);
      for (int first = 0; first < n;) {
        const int last = std::min<int>(n, first + 1 + static_cast<int>(random() % 4));
        fill(parts, first, last);
        first = last;
      }
    }
    EXPECT_EQ(parts.values, whole.values);
  }
}

INSTANTIATE_TEST_SUITE_P(Symmetries, Moves, testing::Bool(),
                         [](const auto& info) { return info.param ? "Symmetric" : "General"; });

}  // namespace
