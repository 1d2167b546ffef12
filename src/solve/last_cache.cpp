#include "last_cache.hpp"

#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <string>

namespace bough::solve {

namespace {

/// Bytes of the last cache of the first processor; 0: unknown. The system's files are read first, since sysconf may
/// return the sum of all such caches of a processor.
std::size_t find_last_cache() {
  std::size_t bytes = 0;
  for (int index = 0; index < 8; ++index) {
    std::ifstream file("/sys/devices/system/cpu/cpu0/cache/index" + std::to_string(index) + "/size");
    std::size_t number = 0;
    char unit = 0;
    if (!(file >> number)) continue;
    file >> unit;
    bytes = std::max(bytes, unit == 'K' ? number << 10 : unit == 'M' ? number << 20 : number);
  }
#ifdef _SC_LEVEL3_CACHE_SIZE
  if (bytes == 0) bytes = static_cast<std::size_t>(std::max(0l, sysconf(_SC_LEVEL3_CACHE_SIZE)));
#endif
  return bytes;
}

}  // namespace

bool exceeds_share_of_caches(std::size_t bytes) {
  constexpr std::size_t least = std::size_t{16} << 20;
  if (bytes <= least) return false;
  static const std::size_t last_cache = find_last_cache();
  return bytes > last_cache / 8;
}

}  // namespace bough::solve
