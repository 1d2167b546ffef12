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

/// Every round has a sum of its own, which no compiler derives from another one.
void read(const std::vector<std::uint64_t>& part, long rounds) {
  std::uint64_t sum = 0;
  for (long r = 0; r < rounds; ++r)
    for (const std::uint64_t word : part) sum += word ^ static_cast<std::uint64_t>(r);
  sink.fetch_add(sum, std::memory_order_relaxed);
}

/// Seconds in which every thread reads its part `rounds` times: from the first beginning to the last end, as the
/// threads themselves see them, since the one that waits for them may get no processor meanwhile.
double eval_seconds(std::vector<std::vector<std::uint64_t>>& parts, long rounds) {
  const std::size_t count = parts.size();
  std::barrier gate(static_cast<std::ptrdiff_t>(count));
  std::vector<Clock::time_point> begin(count), end(count);
  std::vector<std::thread> threads;
  for (std::size_t k = 0; k < count; ++k)
    threads.emplace_back([&, k] {
      read(parts[k], 1);  // into the cache of this processor
      gate.arrive_and_wait();
      begin[k] = Clock::now();
      read(parts[k], rounds);
      end[k] = Clock::now();
    });
  for (std::thread& t : threads) t.join();
  return std::chrono::duration<double>(*std::max_element(end.begin(), end.end()) -
                                       *std::min_element(begin.begin(), begin.end()))
      .count();
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
