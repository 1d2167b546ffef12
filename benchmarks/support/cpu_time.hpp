#pragma once
/// CPU time of the process.
#include <time.h>

namespace bough::bench {

/// CPU seconds of the process: other programs on the machine hardly change them.
inline double cpu_now() {
  timespec t;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

}  // namespace bough::bench
