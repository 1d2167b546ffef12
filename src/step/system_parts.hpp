#pragma once
/// Shared by the files of System.
#include <cstdint>
#include <ctime>

namespace bough::step {

/// CPU seconds of the whole process, all threads.
inline double cpu_now() {
  timespec t;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

struct PhaseTimer {
  double& sum;
  double start = cpu_now();
  ~PhaseTimer() { sum += cpu_now() - start; }
};

/// Items a task takes at once; chunks do not depend on the number of threads.
inline constexpr std::int64_t element_grain = 32, block_grain = 128;

}  // namespace bough::step
