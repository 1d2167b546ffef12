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

/// Removes all "--NAME=VALUE" and "--NAME VALUE" and returns the values.
inline std::vector<std::string> take_options(std::vector<char*>& arguments, const std::string& name) {
  std::vector<std::string> values;
  const std::string flag = "--" + name;
  for (std::size_t k = 1; k < arguments.size();) {
    const std::string here = arguments[k];
    const bool has_value = here.starts_with(flag + "=");
    if (!has_value && (here != flag || k + 1 == arguments.size())) {
      ++k;
      continue;
    }
    values.push_back(has_value ? here.substr(flag.size() + 1) : arguments[k + 1]);
    arguments.erase(arguments.begin() + static_cast<std::ptrdiff_t>(k),
                    arguments.begin() + static_cast<std::ptrdiff_t>(k) + (has_value ? 1 : 2));
  }
  return values;
}

}  // namespace bough::bench
