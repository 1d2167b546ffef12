#include "read_rate.hpp"

#include <algorithm>
#include <atomic>
#include <barrier>
#include <chrono>
#include <cstdint>
#include <thread>

namespace bough::study {

namespace {

using Clock = std::chrono::steady_clock;

/// Keeps the sums from being optimised away.
std::atomic<std::uint64_t> sink;

void read(const std::vector<std::uint64_t>& part, long rounds) {
  std::uint64_t sum = 0;
  for (long r = 0; r < rounds; ++r) {
    for (const std::uint64_t word : part) sum += word;
    std::atomic_signal_fence(std::memory_order_seq_cst);  // the next round reads again
  }
  sink.fetch_add(sum, std::memory_order_relaxed);
}

/// Seconds in which every thread reads its part `rounds` times.
double eval_seconds(std::vector<std::vector<std::uint64_t>>& parts, long rounds) {
  std::barrier gate(static_cast<std::ptrdiff_t>(parts.size()) + 1);
  std::vector<std::thread> others;
  for (auto& part : parts)
    others.emplace_back([&] {
      read(part, 1);  // into the cache of this processor
      gate.arrive_and_wait();
      read(part, rounds);
      gate.arrive_and_wait();
    });
  gate.arrive_and_wait();
  const Clock::time_point start = Clock::now();
  gate.arrive_and_wait();
  const double seconds = std::chrono::duration<double>(Clock::now() - start).count();
  for (std::thread& t : others) t.join();
  return seconds;
}

double measure_rate(std::size_t words, int threads) {
  constexpr double shortest = 3e-3;
  constexpr int trials = 5;
  const std::size_t each = std::max<std::size_t>(words / static_cast<std::size_t>(threads), 512);
  std::vector<std::vector<std::uint64_t>> parts(static_cast<std::size_t>(threads));
  for (auto& part : parts) part.assign(each, 1);
  const double bytes = static_cast<double>(sizeof(std::uint64_t) * each) * threads;
  long rounds = 1;
  double seconds = eval_seconds(parts, rounds);
  while (seconds < shortest) seconds = eval_seconds(parts, rounds *= 2);
  for (int k = 1; k < trials; ++k) seconds = std::min(seconds, eval_seconds(parts, rounds));
  return bytes * static_cast<double>(rounds) / seconds;
}

}  // namespace

std::vector<double> measure_read_rates(std::size_t bytes, const std::vector<int>& threads, int most_threads) {
  constexpr std::size_t most_bytes = std::size_t{256} << 20;
  const std::size_t words = std::min(bytes, most_bytes) / sizeof(std::uint64_t);
  std::vector<double> rates;
  double best = 0.0;
  for (int count : threads) {
    if (rates.empty() || count <= most_threads) best = std::max(best, measure_rate(words, count));
    rates.push_back(best);
  }
  return rates;
}

}  // namespace bough::study
