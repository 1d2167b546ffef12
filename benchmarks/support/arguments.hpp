#pragma once
/// Options of a benchmark program itself, removed before Google Benchmark reads the others.
#include <string>
#include <vector>

namespace bough::bench {

/// Removes "--NAME=VALUE" from the arguments and returns VALUE, or the default.
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
