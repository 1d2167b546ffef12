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

// A reading is wrong by 0.2 ms of waiting at most; the readings themselves take the rest.
constexpr double slack = 0.5e-3;

TEST(CpuClock, tells_the_seconds_of_its_thread) {
  CpuClock clock(true);
  const double start = clock.now(), cpu_start = cpu_of(CLOCK_THREAD_CPUTIME_ID);
  for (int k = 1; k <= 20; ++k) {
    work_until(CLOCK_THREAD_CPUTIME_ID, cpu_start + 1e-3 * k);
    EXPECT_NEAR(clock.now() - start, cpu_of(CLOCK_THREAD_CPUTIME_ID) - cpu_start, slack);
  }
}

TEST(CpuClock, does_not_count_what_a_thread_waits) {
  CpuClock clock(true);
  const double start = clock.now();
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  EXPECT_LT(clock.now() - start, slack);
}

TEST(CpuClock, does_not_count_other_threads_where_the_run_has_one) {
  CpuClock clock(true);
  const double start = clock.now();
  std::thread other([] { work_until(CLOCK_THREAD_CPUTIME_ID, 10e-3); });
  other.join();
  EXPECT_LT(clock.now() - start, slack);
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
  const double cpu_start = cpu_of(CLOCK_THREAD_CPUTIME_ID);
  double sum = 0.0, apart = 0.0;
  for (int k = 0; k < 2000; ++k) {
    {
      const PhaseTimer timer(clock, sum);
      work_until(CLOCK_THREAD_CPUTIME_ID, cpu_of(CLOCK_THREAD_CPUTIME_ID) + 3e-6);
    }
    const PhaseTimer timer(clock, apart);
  }
  const double cpu = cpu_of(CLOCK_THREAD_CPUTIME_ID) - cpu_start;
  EXPECT_NEAR(sum + apart, cpu, 0.2 * cpu);
  EXPECT_GT(sum, 0.7 * cpu) << "phases that hold the work are told to";
}

}  // namespace
}  // namespace bough::step
