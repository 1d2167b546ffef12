#include "memory_limit.hpp"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <iostream>
#include <limits>

#include "bough/io/number_text.hpp"
#include "bough/run/estimate.hpp"

namespace bough::app {
namespace {

constexpr double unlimited = std::numeric_limits<double>::infinity();
constexpr double usable_part = 0.9;

/// A number in the first line of a file; `otherwise` where there is none ("max").
double number_in(const std::string& file, double otherwise) {
  std::ifstream in(file);
  double x = 0.0;
  return in >> x ? x : otherwise;
}

/// MemAvailable: what new programs get without swapping, caches that can be dropped included.
double machine_memory() {
  std::ifstream in("/proc/meminfo");
  std::string key, unit;
  for (double kilobytes = 0.0; in >> key >> kilobytes >> unit;)
    if (key == "MemAvailable:") return 1024.0 * kilobytes;
  return unlimited;
}

double group_memory() {
  const double v2 = number_in("/sys/fs/cgroup/memory.max", unlimited) - number_in("/sys/fs/cgroup/memory.current", 0.0);
  const double v1 = number_in("/sys/fs/cgroup/memory/memory.limit_in_bytes", unlimited) -
                    number_in("/sys/fs/cgroup/memory/memory.usage_in_bytes", 0.0);
  return std::max(0.0, std::min(v2, v1));
}

double address_space() {
  rlimit limit{};
  double least = unlimited;
  for (const auto which : {RLIMIT_AS, RLIMIT_DATA})
    if (getrlimit(which, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY)
      least = std::min(least, static_cast<double>(limit.rlim_cur));
  if (least == unlimited) return unlimited;
  const double used = number_in("/proc/self/statm", 0.0) * static_cast<double>(sysconf(_SC_PAGESIZE));
  return std::max(0.0, least - used);
}

}  // namespace

double available_memory() { return usable_part * std::min({machine_memory(), group_memory(), address_space()}); }

bool read_memory_size(const std::string& text, double& bytes) {
  double x = 0.0, unit = 1.0;
  std::string digits = text;
  const std::string units = "kMGT";
  if (const std::size_t at = digits.empty() ? std::string::npos : units.find(digits.back()); at != std::string::npos) {
    for (std::size_t k = 0; k <= at; ++k) unit *= 1024.0;
    digits.pop_back();
  }
  if (!io::read_number(digits, x) || !(x > 0.0) || !(x * unit < unlimited)) return false;
  bytes = x * unit;
  return true;
}

bool refuse_for_memory(const std::filesystem::path& file, const scene::Scene& scene, double limit) {
  const std::string why = run::refusal(scene, limit > 0.0 ? limit : available_memory());
  if (why.empty()) return false;
  std::cerr << file.string() << ": " << why << " [memory]\n";
  return true;
}

}  // namespace bough::app
