/// A watched walk visits what the walk alone visits, and its times add up.
#include "bough/schedule/timed_walker.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <numeric>

#include "bough/schedule/serial.hpp"
#include "bough/schedule/threads.hpp"

namespace bough::test {
namespace {

using schedule::TimedWalker;
using schedule::WalkTimes;
using schedule::WorkTimes;
using tree::Stage;
using tree::Work;

/// A complete binary tree of `levels` levels; every node costs `flops`.
tree::Tree make_binary(int levels, double flops) {
  tree::Tree t;
  const auto add = [&t, flops](auto&& self, int level, int depth) -> tree::SubdomainId {
    tree::Subdomain s;
    s.level = level;
    s.subtree_begin = t.num_subdomains();
    s.subtree_flops = s.flops = flops;
    std::vector<tree::SubdomainId> children;
    for (int k = 0; k < 2 && level + 1 < depth; ++k) children.push_back(self(self, level + 1, depth));
    const tree::SubdomainId id = t.num_subdomains();
    s.child_begin = static_cast<std::int32_t>(t.subdomain_children.size());
    for (tree::SubdomainId c : children) {
      t.subdomains[static_cast<std::size_t>(c)].parent = id;
      s.subtree_flops += t.subdomains[static_cast<std::size_t>(c)].subtree_flops;
      t.subdomain_children.push_back(c);
    }
    s.child_end = static_cast<std::int32_t>(t.subdomain_children.size());
    t.subdomains.push_back(s);
    return id;
  };
  add(add, 0, levels);
  return t;
}

void spin(int microseconds) {
  const auto until = std::chrono::steady_clock::now() + std::chrono::microseconds(microseconds);
  while (std::chrono::steady_clock::now() < until) {
  }
}

double sum(const std::vector<float>& values) { return std::accumulate(values.begin(), values.end(), 0.0); }

TEST(TimedWalker, every_visit_is_passed_on_once_and_timed) {
  const tree::Tree t = make_binary(4, 1e6);
  for (int threads : {1, 2, 3}) {
    const schedule::Threads pool(threads);
    TimedWalker watch(pool.walker());
    watch.keep_events(true);
    const tree::Walker walker = watch.walker();
    std::vector<std::atomic<int>> seen(static_cast<std::size_t>(t.num_subdomains()));
    auto visit = [&](tree::SubdomainId s) {
      ++seen[static_cast<std::size_t>(s)];
      spin(200);
    };
    walker.walk_up(t, tree::make_visit(visit, Work::factor));
    walker.walk_down(t, tree::make_visit(visit, Work::backward));
    walker.walk_up(t, tree::make_visit(visit));  // has no name: not watched
    for (const auto& n : seen) EXPECT_EQ(n, 3);
    const WalkTimes times = watch.times();
    ASSERT_EQ(times.trees.size(), 1u);
    ASSERT_EQ(times.trees[0].num_visits, 15);
    for (Work w : {Work::factor, Work::backward}) {
      const WorkTimes& work = times.trees[0].work[static_cast<std::size_t>(w)];
      EXPECT_EQ(work.walks, 1);
      ASSERT_EQ(work.visit.size(), 15u);
      for (float seconds : work.visit) EXPECT_GE(seconds, 190e-6f);  // 5 % for the ratio of the two clocks
      // All visits lie within the walk, on at most so many threads.
      EXPECT_LE(sum(work.visit), threads * work.wall_sum * 1.0001);
      EXPECT_GE(work.wall_sum, sum(work.visit) / threads * 0.9999);
    }
    EXPECT_EQ(times.trees[0].work[static_cast<std::size_t>(Work::factor)].wait.size(), 15u);
    EXPECT_EQ(times.events.size(), 30u);
    EXPECT_EQ(times.events_left_out, 0);
    EXPECT_LE(static_cast<int>(times.thread_busy.size()), threads);
    double busy = 0.0, in_events = 0.0;
    for (double b : times.thread_busy) busy += b;
    for (const schedule::TimedEvent& e : times.events) in_events += static_cast<double>(e.seconds);
    EXPECT_NEAR(busy, in_events, 1e-5 * busy);  // events are kept in single precision
  }
}

TEST(TimedWalker, stages_share_a_visit) {
  const tree::Tree t = make_binary(1, 1.0);
  TimedWalker watch(schedule::make_serial_walker());
  const tree::Walker walker = watch.walker();
  auto visit = [&](tree::SubdomainId) {
    spin(300);
    walker.mark(Stage::assemble);
    spin(900);
    walker.mark(Stage::eliminate);
    spin(300);
    walker.mark(Stage::assemble);
    spin(100);
  };
  walker.walk_up(t, tree::make_visit(visit, Work::factor));
  walker.mark(Stage::assemble);  // outside of a visit: nothing happens
  const WalkTimes times = watch.times();
  const WorkTimes& work = times.trees[0].work[static_cast<std::size_t>(Work::factor)];
  const float assemble = work.stage[static_cast<std::size_t>(Stage::assemble)][0];
  const float eliminate = work.stage[static_cast<std::size_t>(Stage::eliminate)][0];
  EXPECT_GE(assemble, 570e-6f);
  EXPECT_GE(eliminate, 855e-6f);
  EXPECT_GE(work.visit[0], assemble + eliminate + 95e-6f);
  EXPECT_EQ(work.stage[static_cast<std::size_t>(Stage::forward)][0], 0.0f);
}

TEST(TimedWalker, what_is_kept_is_bounded) {
  const tree::Tree t = make_binary(3, 1.0);
  TimedWalker watch(schedule::make_serial_walker(), {.most_samples = 7 * 8, .most_events = 20});
  watch.keep_events(true);
  auto visit = [](tree::SubdomainId) {};
  for (int k = 0; k < 1000; ++k) watch.walker().walk_up(t, tree::make_visit(visit, Work::factor));
  const WalkTimes times = watch.times();
  const WorkTimes& work = times.trees[0].work[static_cast<std::size_t>(Work::factor)];
  EXPECT_EQ(work.walks, 1000);
  EXPECT_LE(work.visit.size(), 7u * 8u);
  EXPECT_GE(work.visit.size(), 7u * 4u);
  EXPECT_EQ(work.visit.size(), 7u * work.wall.size());
  EXPECT_EQ(work.visit.size(), work.wait.size());
  EXPECT_EQ(times.events.size(), 20u);
  EXPECT_EQ(times.events_left_out, 7 * 1000 - 20);
}

TEST(TimedWalker, chunks_of_a_visit_belong_to_the_visit) {
  const tree::Tree t = make_binary(4, 1e9);
  const schedule::Threads pool(2, 0.0);
  TimedWalker watch(pool.walker());
  std::atomic<std::int64_t> items{0};
  for (const Work work : {Work::factor, Work::other}) {
    auto visit = [&](tree::SubdomainId) {
      auto body = [&](std::int64_t begin, std::int64_t end) { items += end - begin; };
      watch.walker().for_each_chunk(10, 3, tree::make_chunk(body));
    };
    watch.walker().walk_up(t, tree::make_visit(visit, work));
  }
  EXPECT_EQ(items, 2 * 10 * t.num_subdomains());
  for (const schedule::ChunkTimes& chunks : watch.times().chunks) EXPECT_EQ(chunks.count, 0);
}

TEST(TimedWalker, chunks_are_passed_on_and_summed) {
  const schedule::Threads pool(2);
  TimedWalker watch(pool.walker());
  std::atomic<std::int64_t> items{0};
  auto body = [&](std::int64_t begin, std::int64_t end) {
    items += end - begin;
    spin(100);
  };
  for (int k = 0; k < 3; ++k) watch.walker().for_each_chunk(100, 8, tree::make_chunk(body, Work::evaluate));
  watch.walker().for_each_chunk(0, 8, tree::make_chunk(body, Work::evaluate));
  EXPECT_EQ(items, 300);
  const schedule::ChunkTimes chunks = watch.times().chunks[static_cast<std::size_t>(Work::evaluate)];
  EXPECT_EQ(chunks.count, 3);
  ASSERT_EQ(chunks.chunk.size(), 13u);
  double all = 0.0;
  for (double c : chunks.chunk) {
    EXPECT_GE(c, 3 * 95e-6);
    all += c;
  }
  EXPECT_NEAR(all, chunks.work_sum, 1e-9 * all);
}

}  // namespace
}  // namespace bough::test
