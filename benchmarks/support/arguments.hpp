#pragma once
/// Own options of a benchmark program, taken out before Google Benchmark sees the rest.
#include <string>
#include <vector>

namespace bough::bench {

/// Takes "--NAME=VALUE" out of the arguments.
inline std::string take_option(std::vector<char*>& arguments, const std::string& name, const std::string& otherwise) {
  std::string value = otherwise;
  const std::string start = "--" + name + "=";
  std::erase_if(arguments, [&](const char* a) {
    if (!std::string(a).starts_with(start)) return false;
    value = std::string(a).substr(start.size());
    return true;
  });
  return value;
}

}  // namespace bough::bench
