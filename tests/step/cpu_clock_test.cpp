/// The clock of phases against the kernel's own.
#include "bough/step/cpu_clock.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <ctime>
#include <thread>
#include <vector>

namespace bough::step {
namespace {

double cpu_of(clockid_t clock) {
  timespec t;
  clock_gettime(clock, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

void work_until(clockid_t clock, double end) {
  while (cpu_of(clock) < end) {
  }
}

// A reading is too large by 0.2 ms of waiting at most; the rest is for what the readings themselves take.
constexpr double slack = 0.4e-3;

/// Seconds of the tested clock and of the kernel's. A thread may have to wait between two readings, so the kernel's
/// clock is read on both sides.
class Comparison {
 public:
  explicit Comparison(CpuClock& clock) : clock_(clock) {
    first_ = cpu_of(CLOCK_THREAD_CPUTIME_ID);
    start_ = clock_.now();
    second_ = cpu_of(CLOCK_THREAD_CPUTIME_ID);
  }

  /// That the seconds since agree.
  void check() const {
    const double before = cpu_of(CLOCK_THREAD_CPUTIME_ID), told = clock_.now() - start_,
                 after = cpu_of(CLOCK_THREAD_CPUTIME_ID);
    EXPECT_GE(told, before - second_ - slack);
    EXPECT_LE(told, after - first_ + slack);
  }

 private:
  CpuClock& clock_;
  double first_, start_, second_;
};

TEST(CpuClock, tells_the_seconds_of_its_thread) {
  CpuClock clock(true);
  const double start = cpu_of(CLOCK_THREAD_CPUTIME_ID);
  const Comparison comparison(clock);
  for (int k = 1; k <= 20; ++k) {
    work_until(CLOCK_THREAD_CPUTIME_ID, start + 1e-3 * k);
    comparison.check();
  }
}

TEST(CpuClock, does_not_count_what_a_thread_waits) {
  CpuClock clock(true);
  const Comparison comparison(clock);
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  comparison.check();
}

TEST(CpuClock, does_not_count_other_threads_where_the_run_has_one) {
  CpuClock clock(true);
  const Comparison comparison(clock);
  double other_seconds = 0.0;
  std::thread other([&other_seconds] {
    work_until(CLOCK_THREAD_CPUTIME_ID, 10e-3);
    other_seconds = cpu_of(CLOCK_THREAD_CPUTIME_ID);
  });
  other.join();
  comparison.check();
  EXPECT_GE(other_seconds, 10e-3);
}

TEST(CpuClock, counts_all_threads_where_the_run_has_several) {
  CpuClock clock(false);
  const double start = clock.now();
  std::vector<std::thread> threads;
  for (int k = 0; k < 2; ++k) threads.emplace_back([] { work_until(CLOCK_THREAD_CPUTIME_ID, 5e-3); });
  for (std::thread& t : threads) t.join();
  EXPECT_GE(clock.now() - start, 10e-3);
}

TEST(PhaseTimer, adds_up_short_phases) {
  CpuClock clock(true);
  const Comparison comparison(clock);
  const double start = clock.now();
  double sum = 0.0, apart = 0.0;
  for (int k = 0; k < 2000; ++k) {
    {
      const PhaseTimer timer(clock, sum);
      work_until(CLOCK_THREAD_CPUTIME_ID, cpu_of(CLOCK_THREAD_CPUTIME_ID) + 3e-6);
    }
    const PhaseTimer timer(clock, apart);
  }
  const double whole = clock.now() - start;
  comparison.check();
  EXPECT_LE(sum + apart, whole + 1e-9);
  EXPECT_GT(sum, apart) << "phases that hold the work are told to";
}

TEST(PhaseTimer, leaves_out_phases_within_it) {
  CpuClock clock(true);
  double outer = 0.0, inner = 0.0;
  const double start = clock.now();
  {
    const PhaseTimer around(clock, outer);
    const PhaseTimer within(clock, inner);
    work_until(CLOCK_THREAD_CPUTIME_ID, cpu_of(CLOCK_THREAD_CPUTIME_ID) + 2e-3);
  }
  const double whole = clock.now() - start;
  EXPECT_GE(inner, 2e-3 - slack);
  EXPECT_LE(outer, slack);
  EXPECT_LE(outer + inner, whole + 1e-9);
}

TEST(PhaseChain, has_no_time_between_phases) {
  CpuClock clock(true);
  double sum = 0.0, other = 0.0;
  const double start = clock.now();
  {
    const PhaseChain chain(clock);
    { const PhaseTimer timer(clock, sum); }
    work_until(CLOCK_THREAD_CPUTIME_ID, cpu_of(CLOCK_THREAD_CPUTIME_ID) + 2e-3);
    { const PhaseTimer timer(clock, other); }
  }
  const double whole = clock.now() - start;
  EXPECT_GE(sum, 2e-3 - slack) << "work after the phase counts as its own until the next one begins";
  EXPECT_LE(sum + other, whole + 1e-9);
  const double before = sum + other;
  work_until(CLOCK_THREAD_CPUTIME_ID, cpu_of(CLOCK_THREAD_CPUTIME_ID) + 2e-3);
  { const PhaseTimer timer(clock, sum); }
  EXPECT_LE(sum + other - before, slack) << "after the chain nothing is counted";
}

}  // namespace
}  // namespace bough::step
