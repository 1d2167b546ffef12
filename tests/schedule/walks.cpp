/// Orders that every walk keeps, for any number of threads.
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <memory>
#include <new>
#include <stdexcept>
#include <thread>
#include <vector>

#include "bough/schedule/serial.hpp"
#include "bough/schedule/threads.hpp"
#include "solve/random_scene.hpp"

namespace bough::test {
namespace {

void expect_orders(const tree::Tree& t, const tree::Walker& walker) {
  const auto n = static_cast<std::size_t>(t.num_subdomains());
  const std::unique_ptr<std::atomic<int>[]> done(new std::atomic<int>[n]);
  for (std::size_t i = 0; i < n; ++i) done[i] = 0;
  std::atomic<int> wrong{0};
  auto up = [&](tree::SubdomainId s) {
    for (tree::SubdomainId c : t.children(t.subdomains[static_cast<std::size_t>(s)]))
      wrong += done[static_cast<std::size_t>(c)] != 1;
    ++done[static_cast<std::size_t>(s)];
  };
  walker.walk_up(t, tree::make_visit(up));
  for (std::size_t i = 0; i < n; ++i) EXPECT_EQ(done[i], 1);
  auto down = [&](tree::SubdomainId s) {
    const auto parent = t.subdomains[static_cast<std::size_t>(s)].parent;
    if (parent != tree::none) wrong += done[static_cast<std::size_t>(parent)] != 2;
    ++done[static_cast<std::size_t>(s)];
  };
  walker.walk_down(t, tree::make_visit(down));
  for (std::size_t i = 0; i < n; ++i) EXPECT_EQ(done[i], 2);
  EXPECT_EQ(wrong, 0);
}

void expect_chunks(const tree::Walker& walker) {
  for (std::int64_t count : {0, 1, 7, 8, 9, 1000})
    for (std::int64_t grain : {1, 8, 64}) {
      const std::unique_ptr<std::atomic<int>[]> seen(new std::atomic<int>[static_cast<std::size_t>(count) + 1]);
      for (std::int64_t i = 0; i <= count; ++i) seen[static_cast<std::size_t>(i)] = 0;
      std::atomic<int> wrong{0};
      auto body = [&](std::int64_t begin, std::int64_t end) {
        wrong += begin % grain != 0 || end - begin > grain || (end - begin < grain && end != count);
        for (std::int64_t i = begin; i < end; ++i) ++seen[static_cast<std::size_t>(i)];
      };
      walker.for_each_chunk(count, grain, tree::make_chunk(body));
      for (std::int64_t i = 0; i < count; ++i) EXPECT_EQ(seen[static_cast<std::size_t>(i)], 1);
      EXPECT_EQ(wrong, 0);
    }
}

TEST(Walks, PassOnAnExceptionAndGoOnAfterwards) {
  const tree::Tree t = tree::make_tree(make_lattice(3, 8, 8).graph, {.leaf_size = 2});
  for (int count : {1, 2, 4}) {
    schedule::Threads threads(count, 0.0);
    const tree::Walker walker = threads.walker();
    for (tree::SubdomainId bad = 0; bad < t.num_subdomains(); bad += 3) {
      auto visit = [&](tree::SubdomainId s) {
        if (s == bad) throw std::bad_alloc();
      };
      EXPECT_THROW(walker.walk_up(t, tree::make_visit(visit)), std::bad_alloc) << count;
      EXPECT_THROW(walker.walk_down(t, tree::make_visit(visit)), std::bad_alloc) << count;
      auto chunk = [&](std::int64_t begin, std::int64_t) {
        if (begin == bad) throw std::bad_alloc();
      };
      EXPECT_THROW(walker.for_each_chunk(t.num_subdomains(), 1, tree::make_chunk(chunk)), std::bad_alloc) << count;
    }
    expect_orders(t, walker);
    expect_chunks(walker);
  }
}

thread_local int visits_at_hand = 0;

TEST(Walks, LetVisitsShareOutChunksAndTakeNoOtherVisitMeanwhile) {
  const tree::Tree t = tree::make_tree(make_lattice(3, 8, 8).graph, {.leaf_size = 2});
  for (int count : {1, 2, 4}) {
    schedule::Threads threads(count, 0.0);
    for (unsigned repetition = 0; repetition < 20; ++repetition) {
      threads.set_random_delay(30, repetition + 1);
      const tree::Walker walker = threads.walker();
      std::atomic<int> nested{0}, items{0};
      auto visit = [&](tree::SubdomainId) {
        nested += visits_at_hand++ != 0;
        auto body = [&](std::int64_t begin, std::int64_t end) { items += static_cast<int>(end - begin); };
        walker.for_each_chunk(5, 1, tree::make_chunk(body));
        --visits_at_hand;
      };
      walker.walk_up(t, tree::make_visit(visit));
      walker.walk_down(t, tree::make_visit(visit));
      EXPECT_EQ(nested, 0) << count;
      EXPECT_EQ(items, 10 * t.num_subdomains()) << count;
    }
  }
}

TEST(Walks, VisitChildrenFirstAndParentsFirst) {
  for (const Scene& scene : make_all_families(1)) {
    const tree::Tree t = tree::make_tree(scene.graph, {.leaf_size = 2});
    expect_orders(t, schedule::make_serial_walker());
    for (int count : {1, 2, 3, 8}) {
      schedule::Threads threads(count, 0.0);
      EXPECT_EQ(threads.count(), count);
      expect_orders(t, threads.walker());
      threads.set_random_delay(50, 7);
      expect_orders(t, threads.walker());
      schedule::Threads coarse(count, 1e12);
      expect_orders(t, coarse.walker());
    }
  }
}

TEST(Walks, ChunksCoverEverythingOnceAtTheSameCuts) {
  expect_chunks(schedule::make_serial_walker());
  for (int count : {1, 2, 5}) expect_chunks(schedule::Threads(count).walker());
}

TEST(Walks, KeepTheirOrdersWhereThreadsAreKeptTogether) {
  const tree::Tree t = tree::make_tree(make_lattice(3, 8, 8).graph, {.leaf_size = 2});
  for (int count : {1, 2, 3}) {
    const schedule::Threads threads(count, 0.0);
    int runs = 0;
    threads.keep_together([&] {
      ++runs;
      expect_orders(t, threads.walker());
      expect_chunks(threads.walker());
      threads.keep_together([&] { ++runs; });
    });
    EXPECT_EQ(runs, 2);
    EXPECT_THROW(threads.keep_together([] { throw std::runtime_error("out"); }), std::runtime_error);
    expect_orders(t, threads.walker());
  }
}

TEST(Walks, KeepTheirOrdersWhereHelpersHaveGoneToSleepBetweenThem) {
  const tree::Tree t = tree::make_tree(make_lattice(3, 8, 8).graph, {.leaf_size = 2});
  for (int count : {2, 4}) {
    const schedule::Threads threads(count, 0.0);
    threads.keep_together([&] {
      for (int k = 0; k < 10; ++k) {
        expect_orders(t, threads.walker());
        expect_chunks(threads.walker());
        std::this_thread::sleep_for(std::chrono::milliseconds(k));
      }
    });
  }
}

TEST(Walks, RefuseNoThreads) {
  EXPECT_THROW(schedule::Threads(0), std::invalid_argument);
  EXPECT_THROW(schedule::Threads(2, -1.0), std::invalid_argument);
}

TEST(Walks, AMovedObjectKeepsItsWalker) {
  schedule::Threads first(2, 0.0);
  const tree::Walker walker = first.walker();
  const schedule::Threads second = std::move(first);
  expect_orders(tree::make_tree(make_chain(1, 8, 2).graph, {.leaf_size = 2}), walker);
  EXPECT_EQ(second.count(), 2);
}

}  // namespace
}  // namespace bough::test
