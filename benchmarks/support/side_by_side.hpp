#pragma once
/// What a second processor of a machine contributes: the same work by one thread alone and by two at the same time,
/// each on its own data.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <thread>
#include <vector>

namespace bough::bench {

/// Wall seconds of `rounds` rounds of work(k) on each of the threads k = 0, 1, ... They begin together, after a few
/// untimed rounds that distribute them over the processors and fill the caches, and wait for each other only at the
/// end.
template <class Work>
double eval_rounds(int threads, long rounds, Work& work) {
  using Clock = std::chrono::steady_clock;
  std::atomic<int> missing(threads);
  std::vector<Clock::time_point> begin(static_cast<std::size_t>(threads)), end(begin.size());
  const auto run = [&](int k) {
    for (long r = 0; r < rounds / 4 + 1; ++r) work(k);
    for (--missing; missing > 0;) std::this_thread::yield();  // a sleeping thread would begin late
    begin[static_cast<std::size_t>(k)] = Clock::now();
    for (long r = 0; r < rounds; ++r) work(k);
    end[static_cast<std::size_t>(k)] = Clock::now();
  };
  std::vector<std::thread> others;
  for (int k = 0; k < threads; ++k) others.emplace_back(run, k);
  for (std::thread& t : others) t.join();
  const auto wall = *std::max_element(end.begin(), end.end()) - *std::min_element(begin.begin(), begin.end());
  return std::chrono::duration<double>(wall).count();
}

/// One iteration is one round of two threads at the same time. Counters, milliseconds of a round: `alone` and
/// `side_by_side`, measured alternately; and the largest gain by a second thread, `bound` = 2 alone / side_by_side.
/// Caches may raise it: two threads that share one piece of work have twice as much cache for it.
struct SideBySide {
  double alone = 0.0, both = 0.0;

  /// Number of rounds, alone and side by side, in one batch of iterations.
  template <class Work>
  void add(benchmark::State& state, long rounds, Work& work) {
    alone += eval_rounds(1, rounds, work);
    const double seconds = eval_rounds(2, rounds, work);
    both += seconds;
    state.SetIterationTime(seconds);
  }
  void report(benchmark::State& state) const {
    const double milliseconds = 1e3 / static_cast<double>(state.iterations());
    state.counters["alone"] = alone * milliseconds;
    state.counters["side_by_side"] = both * milliseconds;
    state.counters["bound"] = 2.0 * alone / both;
  }
};

}  // namespace bough::bench
